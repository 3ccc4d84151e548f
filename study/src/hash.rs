//! Random numbers that depend on their purpose, not on the order of requests: a hash of (seed, stream, index).
//!
//! Each stream is a SplitMix64 generator that jumps to its index: mix(z₀ + index · γ), z₀ = mix(mix(seed + γ) ^ stream)
//! \[Steele, Lea, Flood, OOPSLA 2014; the mix is Stafford's variant 13\].

/// 2⁶⁴ / golden ratio, odd.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

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
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn open_unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * (1.0 / (1u64 << 52) as f64)
}

/// A bijection of 64 bits: changing one bit flips half of them on average.
pub fn mix(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
