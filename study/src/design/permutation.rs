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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_is_taken_once() {
        for length in (1..200).chain([1 << 10, (1 << 10) + 1, 4097, 10_000]) {
            let permutation = Permutation::new(length, 7, 3);
            let mut seen = vec![false; length as usize];
            for index in 0..length {
                let place = permutation.of(index) as usize;
                assert!(!seen[place], "{place} of {length} comes twice");
                seen[place] = true;
            }
        }
    }

    #[test]
    fn places_of_neighbours_are_uncorrelated() {
        // the correlation of n pairs has the standard deviation 1/√n
        let n = 10_000u64;
        for stream in 0..4 {
            let permutation = Permutation::new(n, 1, stream);
            let centred = |index: u64| permutation.of(index % n) as f64 / n as f64 - 0.5;
            for shift in [1, 2, 100] {
                let sum: f64 = (0..n).map(|i| centred(i) * centred(i + shift)).sum();
                let correlation = 12.0 * sum / n as f64;
                assert!(
                    correlation.abs() < 5.0 / (n as f64).sqrt(),
                    "shift {shift}: {correlation}"
                );
            }
        }
    }
}
