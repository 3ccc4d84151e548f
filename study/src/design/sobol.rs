//! Scrambled Sobol' sequences.
//!
//! Point i is x = ⊕ v_k over the ones k of the Gray code of i, with the direction numbers v of [`directions`]. Then
//! each bit of x is flipped or not, depending on a hash of the bits above it. This is Owen's nested uniform scrambling,
//! which keeps the balance of the sequence and makes each point uniform \[A. B. Owen, 1995; P. Bratley, B. L. Fox, ACM
//! TOMS 14, 88 (1988)\].

use super::directions::{self, DIRECTIONS};
use crate::hash;

/// Number of bits of a coordinate; a sequence has 2^`BITS` points.
const BITS: usize = 32;

/// A Sobol' sequence.
#[derive(Clone, Debug)]
pub struct Sobol {
    /// Direction numbers of each dimension, starting with the highest bit.
    directions: Vec<[u32; BITS]>,
}

impl Sobol {
    /// Number of points: 2³².
    pub const POINTS: u64 = 1 << BITS;
    /// Largest number of dimensions.
    pub const DIMENSIONS: usize = directions::DIMENSIONS;

    /// The sequence; `None` if there are more dimensions than direction numbers.
    pub fn new(dimensions: usize) -> Option<Sobol> {
        let first = std::array::from_fn(|bit| 1 << (BITS - 1 - bit));
        let others = DIRECTIONS.iter().map(|(p, m)| numbers(*p, m));
        let directions: Vec<_> = std::iter::once(first)
            .chain(others)
            .take(dimensions)
            .collect();
        (directions.len() == dimensions).then_some(Sobol { directions })
    }

    /// The bits of a coordinate of point `index` < 2³², before scrambling: its value times 2³².
    pub fn bits(&self, index: u64, dimension: usize) -> u32 {
        let mut gray = index ^ (index >> 1);
        let mut x = 0;
        while gray != 0 {
            x ^= self.directions[dimension][gray.trailing_zeros() as usize];
            gray &= gray - 1;
        }
        x
    }

    /// A coordinate of a point, scrambled by the seed, in (0, 1).
    pub fn coordinate(&self, seed: u64, index: u64, dimension: usize) -> f64 {
        let x = scrambled(self.bits(index, dimension), seed, dimension as u64);
        (f64::from(x) + 0.5) / Self::POINTS as f64
    }
}

/// Direction numbers of a primitive polynomial of degree s, with bits a_0 … a_s, and m_1 … m_s:
/// v_k = a_1 v_(k−1) ⊕ … ⊕ a_s v_(k−s) ⊕ v_(k−s)/2^s.
fn numbers(polynomial: u32, initial: &[u32]) -> [u32; BITS] {
    let degree = initial.len();
    let mut v = [0; BITS];
    for k in 0..BITS {
        v[k] = if k < degree {
            initial[k] << (BITS - 1 - k)
        } else {
            let terms = (1..=degree).filter(|j| polynomial >> (degree - j) & 1 == 1);
            terms.fold(v[k - degree] >> degree, |sum, j| sum ^ v[k - j])
        };
    }
    v
}

/// Owen's scrambling: a bit is flipped by a hash of the bits above it.
fn scrambled(x: u32, seed: u64, dimension: u64) -> u32 {
    let mut flips = 0;
    for bit in (0..BITS as u32).rev() {
        // the bits above this one, with a leading one in front so that their number counts, too
        let above = (1u64 << BITS | u64::from(x)) >> (bit + 1);
        flips |= ((hash::bits(seed, dimension, above) >> 63) as u32) << bit;
    }
    x ^ flips
}
