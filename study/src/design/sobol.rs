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

#[cfg(test)]
mod tests {
    use super::*;

    fn value(index: u64, dimension: usize) -> f64 {
        let sobol = Sobol::new(Sobol::DIMENSIONS).unwrap();
        f64::from(sobol.bits(index, dimension)) / Sobol::POINTS as f64
    }

    #[test]
    fn points_are_those_of_scipy() {
        // scipy 1.17: qmc.Sobol(64, scramble=False, bits=32), dimensions 0, 1, 2, 7, 33, 63
        let dimensions = [0, 1, 2, 7, 33, 63];
        let table: [(u64, [f64; 6]); 7] = [
            (1, [0.5; 6]),
            (2, [0.75, 0.25, 0.25, 0.75, 0.75, 0.75]),
            (3, [0.25, 0.75, 0.75, 0.25, 0.25, 0.25]),
            (4, [0.375, 0.375, 0.625, 0.875, 0.875, 0.125]),
            (5, [0.875, 0.875, 0.125, 0.375, 0.375, 0.625]),
            (
                1234,
                [
                    0.86474609375,
                    0.41943359375,
                    0.82666015625,
                    0.52880859375,
                    0.78173828125,
                    0.76708984375,
                ],
            ),
            (
                1999,
                [
                    0.07861328125,
                    0.61181640625,
                    0.13427734375,
                    0.48486328125,
                    0.75341796875,
                    0.56689453125,
                ],
            ),
        ];
        for (index, expected) in table {
            assert_eq!(
                dimensions.map(|d| value(index, d)),
                expected,
                "point {index}"
            );
        }
        // qmc.Sobol(256, …).fast_forward(123456789): coordinates times 2³²
        let sobol = Sobol::new(256).unwrap();
        let far = [0, 1, 63, 255].map(|d| sobol.bits(123_456_789, d));
        assert_eq!(
            far,
            [4_191_448_864, 3_403_469_216, 1_087_637_792, 563_653_600]
        );
        assert!(Sobol::new(257).is_none());
    }

    #[test]
    fn scrambled_points_have_one_in_each_elementary_interval() {
        // a (0, 2)-sequence: among 2^m points, each interval 2^-a × 2^-(m−a) of the first two dimensions has exactly one
        let (m, seed) = (8, 11);
        let sobol = Sobol::new(2).unwrap();
        for a in 0..=m {
            let mut seen = vec![0; 1 << m];
            for index in 0..1 << m {
                let cell = |dimension: usize, bits: u32| {
                    (sobol.coordinate(seed, index, dimension) * f64::from(1 << bits)) as usize
                };
                seen[cell(0, a) << (m - a) | cell(1, m - a)] += 1;
            }
            assert!(seen.iter().all(|&count| count == 1), "2^-{a} in the first");
        }
    }

    #[test]
    fn each_dimension_has_one_point_in_each_part() {
        let n = 512u64;
        let sobol = Sobol::new(Sobol::DIMENSIONS).unwrap();
        for dimension in 0..Sobol::DIMENSIONS {
            let mut seen = vec![false; n as usize];
            for index in 0..n {
                let u = sobol.coordinate(5, index, dimension);
                assert!(u > 0.0 && u < 1.0);
                seen[(u * n as f64) as usize] = true;
            }
            assert!(seen.iter().all(|&s| s), "dimension {dimension}");
        }
    }

    #[test]
    fn one_scrambled_point_is_uniform_over_the_seeds() {
        // the mean of n uniform numbers is ½ with the standard deviation 1/√(12 n)
        let sobol = Sobol::new(3).unwrap();
        let n = 4096;
        for index in [0, 1, 1000] {
            let sum: f64 = (0..n).map(|seed| sobol.coordinate(seed, index, 2)).sum();
            let mean = sum / n as f64;
            assert!(
                (mean - 0.5).abs() < 5.0 / (12.0 * n as f64).sqrt(),
                "point {index}: {mean}"
            );
        }
    }
}
