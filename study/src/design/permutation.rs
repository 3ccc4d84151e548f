//! A pseudo-random permutation of 0 … n−1 without a table: a Feistel network over the next power of four, which is
//! applied again until the result is below n (cycle walking) \[J. Black, P. Rogaway, CT-RSA 2002\].

use crate::hash;

/// Number of rounds; four suffice for a pseudo-random permutation if the functions are random, and more cost little.
const ROUNDS: u64 = 6;

/// A permutation that depends on a seed and a stream.
#[derive(Clone, Copy, Debug)]
pub struct Permutation {
    length: u64,
    /// Number of bits in each half.
    half: u32,
    seed: u64,
    stream: u64,
}

impl Permutation {
    /// A permutation of 0 … `length` − 1, at most 2⁶².
    pub fn new(length: u64, seed: u64, stream: u64) -> Permutation {
        let bits = u64::BITS - length.saturating_sub(1).leading_zeros();
        Permutation {
            length,
            half: bits.div_ceil(2).max(1),
            seed,
            stream,
        }
    }

    /// The image of `index` < `length`.
    pub fn of(&self, index: u64) -> u64 {
        let mut place = index;
        loop {
            place = self.round_trip(place);
            // the domain of the network has at most 4 n places, so the walk ends after a few steps
            if place < self.length {
                return place;
            }
        }
    }

    fn round_trip(&self, place: u64) -> u64 {
        let mask = (1u64 << self.half) - 1;
        let (mut left, mut right) = (place >> self.half, place & mask);
        for round in 0..ROUNDS {
            let key = hash::bits(self.seed, self.stream, round << 32 | right);
            (left, right) = (right, left ^ (key & mask));
        }
        left << self.half | right
    }
}
