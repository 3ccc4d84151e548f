//! The arithmetic of `f64` and `f32` that `core` lacks.
//!
//! Square roots and fused multiply-adds are correctly rounded everywhere, so they may come from the standard library or
//! from `libm`. The elementary functions are those of [`lanes`](super::lanes), with products and sums rounded one after
//! the other: the same bits on every processor and system. Those of the platform differ from one system to another.

use super::lanes::elementary::Elementary;
use super::lanes::{Alone, Apart};

/// The operations on `f64` and `f32` that `core` lacks.
pub trait Plain: Sized {
    fn root(self) -> Self;
    /// `self` · `a` + `b` with one rounding: one instruction in code that is compiled for it, a slow function
    /// elsewhere.
    fn fused(self, a: Self, b: Self) -> Self;
    fn sin_cos(self) -> (Self, Self);
    fn atan2(self, x: Self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn powf(self, power: Self) -> Self;
}

/// Returns the number unchanged, but hides its origin from the compiler.
///
/// For 64-bit ARM, LLVM compiles −(a b + c) to one instruction, FNMADD. But that computes −(a b) − c, which is 0
/// instead of −0 if a b and c cancel. So the compiler must not see that the operand of a negation is such a sum. This
/// takes no instruction.
#[cfg(target_arch = "aarch64")]
macro_rules! unknown {
    ($number:ident) => {{
        let mut number = $number;
        // SAFETY: there is no instruction, only a comment.
        #[allow(unsafe_code, reason = "the compiler must not know a number")]
        unsafe {
            core::arch::asm!(
                "/* {0:v} */",
                inout(vreg) number,
                options(pure, nomem, nostack, preserves_flags)
            );
        }
        number
    }};
}

/// Implements [`Plain`], given the names of functions of `libm`.
macro_rules! plain {
    ($float:ident, $sqrt:ident, $fma:ident) => {
        impl Plain for $float {
            #[inline(always)]
            fn root(self) -> Self {
                #[cfg(any(feature = "std", test))]
                return $float::sqrt(self);
                #[cfg(not(any(feature = "std", test)))]
                return libm::$sqrt(self);
            }

            #[inline(always)]
            #[allow(clippy::disallowed_methods, reason = "it is asked for by name")]
            fn fused(self, a: Self, b: Self) -> Self {
                #[cfg(any(feature = "std", test))]
                let sum = $float::mul_add(self, a, b);
                #[cfg(not(any(feature = "std", test)))]
                let sum = libm::$fma(self, a, b);
                #[cfg(target_arch = "aarch64")]
                let sum = unknown!(sum);
                sum
            }

            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                let (sine, cosine) = Elementary::sin_cos(Alone::<$float, Apart>::of(self));
                (sine.number(), cosine.number())
            }

            // these functions are long, and a law calls them often, so each is compiled once, as a function of its own

            #[inline(never)]
            fn atan2(self, x: Self) -> Self {
                let [y, x] = [self, x].map(Alone::<$float, Apart>::of);
                Elementary::atan2(y, x).number()
            }

            #[inline(never)]
            fn exp(self) -> Self {
                Elementary::exp(Alone::<$float, Apart>::of(self)).number()
            }

            #[inline(never)]
            fn ln(self) -> Self {
                Elementary::ln(Alone::<$float, Apart>::of(self)).number()
            }

            #[inline(never)]
            fn powf(self, power: Self) -> Self {
                let [base, power] = [self, power].map(Alone::<$float, Apart>::of);
                Elementary::powf(base, power).number()
            }
        }
    };
}

plain!(f64, sqrt, fma);
plain!(f32, sqrtf, fmaf);

#[cfg(test)]
mod tests {
    use crate::Real;

    /// The hash of Fowler, Noll and Vo, of 64 bits; all NaN are equal.
    fn add(hash: u64, number: f64) -> u64 {
        let bits = match number.is_nan() {
            true => u64::MAX,
            false => number.to_bits(),
        };
        let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        bits.to_le_bytes().into_iter().fold(hash, step)
    }

    /// Pairs of numbers: of any bits, angles, and small ones.
    fn pairs() -> impl Iterator<Item = (f64, f64)> {
        let mut state = 1_u64;
        let mut next = move || {
            // xorshift
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            state
        };
        let unit = |bits: u64| (bits >> 11) as f64 / (1_u64 << 53) as f64;
        (0..60_000).map(move |i| {
            let (a, b) = (next(), next());
            match i % 3 {
                0 => (f64::from_bits(a), f64::from_bits(b)),
                1 => (unit(a) * 20.0 - 10.0, unit(b) * 20.0 - 10.0),
                _ => (unit(a) * 2.0 - 1.0, unit(b) * 2.0 - 1.0),
            }
        })
    }

    fn digests<T: Real>() -> [u64; 7] {
        let mut hashes = [0xcbf2_9ce4_8422_2325_u64; 7];
        for (a, b) in pairs() {
            let (a, b) = (T::from_f64(a), T::from_f64(b));
            let (sine, cosine) = a.sin_cos();
            let results = [
                sine,
                cosine,
                a.atan2(b),
                a.exp(),
                a.abs().ln(),
                a.abs().powf(b),
                a.mul_add(b, a).sqrt(),
            ];
            for (hash, result) in hashes.iter_mut().zip(results) {
                *hash = add(*hash, result.to_f64());
            }
        }
        hashes
    }

    /// The digests are those of x86-64; the same program printed them on 64-bit ARM and as WebAssembly.
    #[test]
    fn the_bits_are_the_same_on_every_processor() {
        let doubles = [
            0xe79b_f818_2c66_b6e4,
            0x069b_e86a_9e7b_b561,
            0x74e0_3380_aee6_c711,
            0x4dbb_6aa0_f046_0e9a,
            0x6fe8_ff8e_5aa2_8be0,
            0xc952_c7ad_95b4_d914,
            0xd375_6fda_5ff6_9d6f,
        ];
        assert_eq!(digests::<f64>(), doubles);
        let singles = [
            0x934b_64b7_d278_e7c5,
            0xae0b_9db8_62b9_3e10,
            0x96ef_4f1f_001d_cc40,
            0x7c8e_3fa4_2ef2_4726,
            0xe836_2b9b_42cb_906f,
            0x779d_1a3a_f9ee_20ee,
            0x1965_e833_b7b9_6fb8,
        ];
        assert_eq!(digests::<f32>(), singles);
    }
}
