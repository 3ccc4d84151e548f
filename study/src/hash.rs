//! Random numbers that depend on their purpose, not on the order of requests: a hash of (seed, stream, index).
//!
//! Each stream is a SplitMix64 generator that jumps to its index: mix(z₀ + index · γ), z₀ = mix(mix(seed + γ) ^ stream)
//! \[Steele, Lea, Flood, OOPSLA 2014; the mix is Stafford's variant 13\].

/// 2⁶⁴ / golden ratio, odd.
const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// 64 random bits.
pub fn bits(seed: u64, stream: u64, index: u64) -> u64 {
    let start = mix(mix(seed.wrapping_add(GAMMA)) ^ stream.wrapping_mul(GAMMA));
    mix(start.wrapping_add(index.wrapping_add(1).wrapping_mul(GAMMA)))
}

/// A number in the open interval (0, 1).
pub fn uniform(seed: u64, stream: u64, index: u64) -> f64 {
    open_unit(bits(seed, stream, index))
}

/// The middle of one of 2⁵² equal parts of (0, 1): never 0 and never 1.
fn open_unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * (1.0 / (1u64 << 52) as f64)
}

/// A bijection of 64 bits: changing one bit flips half of them on average.
pub fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_stream_is_split_mix() {
        // the first outputs of SplitMix64 started at 0, from the reference implementation splitmix64.c of S. Vigna
        let published = [
            0xe220_a839_7b1d_cdaf,
            0x6e78_9e6a_a1b9_65f4,
            0x06c4_5d18_8009_454f,
        ];
        for (index, &expected) in published.iter().enumerate() {
            assert_eq!(mix((index as u64 + 1).wrapping_mul(GAMMA)), expected);
        }
    }

    #[test]
    fn the_ends_of_the_unit_interval_are_left_out() {
        assert!(open_unit(0) > 0.0 && open_unit(u64::MAX) < 1.0);
    }

    #[test]
    fn streams_are_uniform_and_uncorrelated() {
        // χ² of 64 bins has the mean 63 and the variance 126; the correlation of n pairs has the standard deviation 1/√n
        let n = 1 << 16;
        for (stream, other) in [(0, 1), (1, 2), (7, 1 << 40)] {
            let mut bins = [0u32; 64];
            let mut product = 0.0;
            for index in 0..n {
                let u = uniform(3, stream, index);
                bins[(u * 64.0) as usize] += 1;
                product += (u - 0.5) * (uniform(3, other, index) - 0.5);
            }
            let expected = n as f64 / 64.0;
            let square = |&count: &u32| (f64::from(count) - expected).powi(2) / expected;
            let chi: f64 = bins.iter().map(square).sum();
            assert!((chi - 63.0).abs() < 5.0 * 126f64.sqrt(), "χ² {chi}");
            let correlation = 12.0 * product / n as f64;
            assert!(correlation.abs() < 5.0 / (n as f64).sqrt(), "{correlation}");
        }
    }
}
