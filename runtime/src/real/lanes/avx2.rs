//! Four doubles in a register of AVX2.
//!
//! Every operation is one or two instructions, if it is inlined into a function that is compiled for AVX2 and fused
//! multiply-adds ([`Avx2::dispatch`](super::Instructions::dispatch)). Elsewhere it is a call: slow, but correct.

use super::register::{Doubles, Instructions, MOST_LANES, Register};
use crate::real::{Base, Task};
use core::arch::x86_64::*;

/// Four doubles.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Avx2(__m256d);

#[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
fn compiled_for_avx2<W: Task>(task: W) -> W::Output {
    super::register::aligned_frame();
    task.run()
}

impl Instructions for Avx2 {
    #[inline(always)]
    fn is_available() -> bool {
        #[cfg(any(feature = "std", test))]
        return is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        // without the standard library, the features that the program is compiled for decide
        #[cfg(not(any(feature = "std", test)))]
        return cfg!(all(
            target_feature = "avx2",
            target_feature = "fma",
            target_feature = "bmi1",
            target_feature = "bmi2",
            target_feature = "lzcnt",
            target_feature = "popcnt",
        ));
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "the instructions of a certain processor")]
    fn dispatch<W: Task>(task: W) -> W::Output {
        // SAFETY: the code that makes the first register has called `there`; the type cannot be named outside of this
        // crate.
        unsafe { compiled_for_avx2(task) }
    }
}

/// A method that is one instruction of registers.
macro_rules! instruction {
    ($name:ident($($argument:ident),*) = $intrinsic:ident) => {
        #[inline(always)]
        #[expect(unsafe_code, reason = "an instruction of AVX2")]
        fn $name(self $(, $argument: Self)*) -> Self {
            // SAFETY: a register is made only where AVX2 exists.
            Self(unsafe { $intrinsic(self.0 $(, $argument.0)*) })
        }
    };
}

/// A function of bits that is one instruction.
macro_rules! of_bits {
    ($name:ident = $intrinsic:ident) => {
        #[inline(always)]
        #[expect(unsafe_code, reason = "an instruction of AVX2")]
        fn $name(a: __m256i, b: __m256i) -> __m256i {
            // SAFETY: as above.
            unsafe { $intrinsic(a, b) }
        }
    };
}

/// A function of masks that is one instruction.
macro_rules! of_masks {
    ($name:ident = $intrinsic:ident) => {
        #[inline(always)]
        #[expect(unsafe_code, reason = "an instruction of AVX2")]
        fn $name(a: __m256d, b: __m256d) -> __m256d {
            // SAFETY: as above.
            unsafe { $intrinsic(a, b) }
        }
    };
}

mod singles;

pub use singles::Avx2Singles;

impl Register for Avx2 {
    type One = f64;
    type Mask = __m256d;
    type Order = __m256i;
    const LANES: usize = 4;
    const BASE: Base = Base::Lane;
    const EPSILON: f64 = f64::EPSILON;

    instruction!(add(other) = _mm256_add_pd);
    instruction!(sub(other) = _mm256_sub_pd);
    instruction!(mul(other) = _mm256_mul_pd);
    instruction!(div(other) = _mm256_div_pd);
    instruction!(mul_add(a, b) = _mm256_fmadd_pd);
    instruction!(sqrt() = _mm256_sqrt_pd);
    of_masks!(and = _mm256_and_pd);
    of_masks!(or = _mm256_or_pd);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        Avx2(unsafe { _mm256_set1_pd(value) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn load(values: &[f64]) -> Self {
        let first: &[f64; 4] = values.first_chunk().unwrap_or(&[f64::NAN; 4]);
        // SAFETY: four doubles are there to be read, at any alignment.
        Avx2(unsafe { _mm256_loadu_pd(first.as_ptr()) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn store(self, values: &mut [f64]) {
        if let Some(first) = values.first_chunk_mut::<4>() {
            // SAFETY: four doubles are there to be written, at any alignment.
            unsafe { _mm256_storeu_pd(first.as_mut_ptr(), self.0) }
        }
    }

    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_bits(Self::bits_xor(self.bits(), Self::splat_bits(1 << 63)))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::from_bits(Self::bits_and(self.bits(), Self::splat_bits(u64::MAX >> 1)))
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx2(unsafe { _mm256_max_pd(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx2(unsafe { _mm256_min_pd(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn lt(self, other: Self) -> __m256d {
        // SAFETY: as above.
        unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn select(mask: __m256d, then: Self, otherwise: Self) -> Self {
        // SAFETY: as above.
        Avx2(unsafe { _mm256_blendv_pd(otherwise.0, then.0, mask) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn order(lanes: &[u8; MOST_LANES]) -> __m256i {
        // both halves of each double
        let [a, b, c, d, ..] = lanes.map(|lane| 2 * i32::from(lane & 3));
        // SAFETY: as above.
        unsafe { _mm256_setr_epi32(a, a + 1, b, b + 1, c, c + 1, d, d + 1) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn ordered(self, order: __m256i) -> Self {
        // SAFETY: as above.
        let halves = unsafe { _mm256_permutevar8x32_epi32(_mm256_castpd_si256(self.0), order) };
        Self::from_bits(halves)
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn lanes_of(mask: __m256d) -> u32 {
        // SAFETY: as above.
        unsafe { _mm256_movemask_pd(mask).cast_unsigned() }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn mask_of(lanes: u32) -> __m256d {
        let lane = |i: u32| i64::from(lanes >> i & 1).wrapping_neg();
        // SAFETY: as above.
        unsafe { _mm256_castsi256_pd(_mm256_setr_epi64x(lane(0), lane(1), lane(2), lane(3))) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn not(a: __m256d) -> __m256d {
        // SAFETY: as above.
        unsafe { _mm256_xor_pd(a, _mm256_castsi256_pd(_mm256_set1_epi64x(-1))) }
    }
}

impl Doubles for Avx2 {
    type Bits = __m256i;

    of_bits!(bits_and = _mm256_and_si256);
    of_bits!(bits_or = _mm256_or_si256);
    of_bits!(bits_xor = _mm256_xor_si256);
    of_bits!(bits_add = _mm256_add_epi64);
    of_bits!(bits_sub = _mm256_sub_epi64);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn round(self) -> Self {
        // SAFETY: as above.
        Avx2(unsafe {
            _mm256_round_pd::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0)
        })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "the same register under another name")]
    fn bits(self) -> __m256i {
        // SAFETY: as above.
        unsafe { _mm256_castpd_si256(self.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "the same register under another name")]
    fn from_bits(bits: __m256i) -> Self {
        // SAFETY: as above.
        Avx2(unsafe { _mm256_castsi256_pd(bits) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn splat_bits(value: u64) -> __m256i {
        // SAFETY: as above.
        unsafe { _mm256_set1_epi64x(value.cast_signed()) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn bits_shl<const N: u32>(a: __m256i) -> __m256i {
        // SAFETY: as above.
        unsafe { _mm256_sll_epi64(a, _mm_cvtsi32_si128(N.cast_signed())) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn bits_shr<const N: u32>(a: __m256i) -> __m256i {
        // SAFETY: as above.
        unsafe { _mm256_srl_epi64(a, _mm_cvtsi32_si128(N.cast_signed())) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn bits_nonzero(a: __m256i) -> __m256d {
        // SAFETY: as above.
        let zero = unsafe { _mm256_cmpeq_epi64(a, _mm256_setzero_si256()) };
        Self::not(Self::from_bits(zero).0)
    }
}
