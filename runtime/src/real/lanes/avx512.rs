//! Eight doubles in a register of AVX-512.
//!
//! Every operation is one instruction, if it is inlined into a function that is compiled for AVX-512
//! ([`Avx512::dispatch`](super::Instructions::dispatch)). Elsewhere it is a call: slow, but correct.

use super::register::{Doubles, Instructions, MOST_LANES, Register};
use crate::real::{Base, Task};
use core::arch::x86_64::*;

/// Eight doubles.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Avx512(__m512d);

#[target_feature(
    enable = "avx512f,avx512dq,avx512vl,avx512bw,avx512cd,avx2,fma,bmi1,bmi2,lzcnt,popcnt"
)]
fn compiled_for_avx512<W: Task>(task: W) -> W::Output {
    super::register::aligned_frame();
    task.run()
}

impl Instructions for Avx512 {
    #[inline(always)]
    fn is_available() -> bool {
        #[cfg(any(feature = "std", test))]
        return is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512cd")
            && is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        // without the standard library, the features that the program is compiled for decide
        #[cfg(not(any(feature = "std", test)))]
        return cfg!(all(
            target_feature = "avx512f",
            target_feature = "avx512dq",
            target_feature = "avx512vl",
            target_feature = "avx512bw",
            target_feature = "avx512cd",
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
        unsafe { compiled_for_avx512(task) }
    }
}

/// A method that is one instruction of registers.
macro_rules! instruction {
    ($name:ident($($argument:ident),*) = $intrinsic:ident) => {
        #[inline(always)]
        #[expect(unsafe_code, reason = "an instruction of AVX-512")]
        fn $name(self $(, $argument: Self)*) -> Self {
            // SAFETY: a register is made only where AVX-512 exists.
            Self(unsafe { $intrinsic(self.0 $(, $argument.0)*) })
        }
    };
}

/// A function of bits that is one instruction.
macro_rules! of_bits {
    ($name:ident = $intrinsic:ident) => {
        #[inline(always)]
        #[expect(unsafe_code, reason = "an instruction of AVX-512")]
        fn $name(a: __m512i, b: __m512i) -> __m512i {
            // SAFETY: as above.
            unsafe { $intrinsic(a, b) }
        }
    };
}

mod singles;

pub use singles::Avx512Singles;

impl Register for Avx512 {
    type One = f64;
    type Mask = __mmask8;
    type Order = __m512i;
    const LANES: usize = 8;
    const BASE: Base = Base::Lane;
    const EPSILON: f64 = f64::EPSILON;

    instruction!(add(other) = _mm512_add_pd);
    instruction!(sub(other) = _mm512_sub_pd);
    instruction!(mul(other) = _mm512_mul_pd);
    instruction!(div(other) = _mm512_div_pd);
    instruction!(mul_add(a, b) = _mm512_fmadd_pd);
    instruction!(sqrt() = _mm512_sqrt_pd);
    instruction!(abs() = _mm512_abs_pd);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        Avx512(unsafe { _mm512_set1_pd(value) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn load(values: &[f64]) -> Self {
        let first: &[f64; 8] = values.first_chunk().unwrap_or(&[f64::NAN; 8]);
        // SAFETY: eight doubles are there to be read, at any alignment.
        Avx512(unsafe { _mm512_loadu_pd(first.as_ptr()) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn store(self, values: &mut [f64]) {
        if let Some(first) = values.first_chunk_mut::<8>() {
            // SAFETY: eight doubles are there to be written, at any alignment.
            unsafe { _mm512_storeu_pd(first.as_mut_ptr(), self.0) }
        }
    }

    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_bits(Self::bits_xor(self.bits(), Self::splat_bits(1 << 63)))
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx512(unsafe { _mm512_max_pd(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx512(unsafe { _mm512_min_pd(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn lt(self, other: Self) -> __mmask8 {
        // SAFETY: as above.
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn select(mask: __mmask8, then: Self, otherwise: Self) -> Self {
        // SAFETY: as above.
        Avx512(unsafe { _mm512_mask_blend_pd(mask, otherwise.0, then.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn order(lanes: &[u8; MOST_LANES]) -> __m512i {
        let [a, b, c, d, e, f, g, h, ..] = lanes.map(i64::from);
        // SAFETY: as above.
        unsafe { _mm512_setr_epi64(a, b, c, d, e, f, g, h) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn ordered(self, order: __m512i) -> Self {
        // SAFETY: as above.
        Avx512(unsafe { _mm512_permutexvar_pd(order, self.0) })
    }

    #[inline(always)]
    fn lanes_of(mask: __mmask8) -> u32 {
        u32::from(mask)
    }

    #[inline(always)]
    fn mask_of(lanes: u32) -> __mmask8 {
        lanes as u8
    }

    #[inline(always)]
    fn and(a: __mmask8, b: __mmask8) -> __mmask8 {
        a & b
    }

    #[inline(always)]
    fn or(a: __mmask8, b: __mmask8) -> __mmask8 {
        a | b
    }

    #[inline(always)]
    fn not(a: __mmask8) -> __mmask8 {
        !a
    }
}

impl Doubles for Avx512 {
    type Bits = __m512i;

    of_bits!(bits_and = _mm512_and_si512);
    of_bits!(bits_or = _mm512_or_si512);
    of_bits!(bits_xor = _mm512_xor_si512);
    of_bits!(bits_add = _mm512_add_epi64);
    of_bits!(bits_sub = _mm512_sub_epi64);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn round(self) -> Self {
        // SAFETY: as above.
        Avx512(unsafe {
            _mm512_roundscale_pd::<{ _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC }>(self.0)
        })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "the same register under another name")]
    fn bits(self) -> __m512i {
        // SAFETY: as above.
        unsafe { _mm512_castpd_si512(self.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "the same register under another name")]
    fn from_bits(bits: __m512i) -> Self {
        // SAFETY: as above.
        Avx512(unsafe { _mm512_castsi512_pd(bits) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn splat_bits(value: u64) -> __m512i {
        // SAFETY: as above.
        unsafe { _mm512_set1_epi64(value.cast_signed()) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn bits_shl<const N: u32>(a: __m512i) -> __m512i {
        // SAFETY: as above.
        unsafe { _mm512_slli_epi64::<N>(a) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn bits_shr<const N: u32>(a: __m512i) -> __m512i {
        // SAFETY: as above.
        unsafe { _mm512_srli_epi64::<N>(a) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn bits_nonzero(a: __m512i) -> __mmask8 {
        // SAFETY: as above.
        unsafe { _mm512_test_epi64_mask(a, a) }
    }
}
