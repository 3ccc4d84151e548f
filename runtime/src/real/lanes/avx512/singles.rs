//! Sixteen singles in a register of AVX-512.

use super::Avx512;
use crate::real::lanes::register::{Instructions, MOST_LANES, Register, Singles};
use crate::real::{Base, Task};
use core::arch::x86_64::*;

/// Sixteen singles.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Avx512Singles(__m512);

impl Instructions for Avx512Singles {
    #[inline(always)]
    fn is_available() -> bool {
        Avx512::is_available()
    }

    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        Avx512::dispatch(task)
    }
}

impl Register for Avx512Singles {
    type One = f32;
    type Mask = __mmask16;
    type Order = __m512i;
    const LANES: usize = 16;
    const BASE: Base = Base::SingleLane;
    const EPSILON: f64 = f32::EPSILON as f64;

    instruction!(add(other) = _mm512_add_ps);
    instruction!(sub(other) = _mm512_sub_ps);
    instruction!(mul(other) = _mm512_mul_ps);
    instruction!(div(other) = _mm512_div_ps);
    instruction!(mul_add(a, b) = _mm512_fmadd_ps);
    instruction!(sqrt() = _mm512_sqrt_ps);
    instruction!(abs() = _mm512_abs_ps);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        Avx512Singles(unsafe { _mm512_set1_ps(value as f32) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn load(values: &[f32]) -> Self {
        let first: &[f32; 16] = values.first_chunk().unwrap_or(&[f32::NAN; 16]);
        // SAFETY: sixteen singles are there to be read, at any alignment.
        Avx512Singles(unsafe { _mm512_loadu_ps(first.as_ptr()) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn store(self, values: &mut [f32]) {
        if let Some(first) = values.first_chunk_mut::<16>() {
            // SAFETY: sixteen singles are there to be written, at any alignment.
            unsafe { _mm512_storeu_ps(first.as_mut_ptr(), self.0) }
        }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn neg(self) -> Self {
        // SAFETY: as above.
        Avx512Singles(unsafe { _mm512_xor_ps(self.0, _mm512_set1_ps(-0.0)) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx512Singles(unsafe { _mm512_max_ps(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx512Singles(unsafe { _mm512_min_ps(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn lt(self, other: Self) -> __mmask16 {
        // SAFETY: as above.
        unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn select(mask: __mmask16, then: Self, otherwise: Self) -> Self {
        // SAFETY: as above.
        Avx512Singles(unsafe { _mm512_mask_blend_ps(mask, otherwise.0, then.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn order(lanes: &[u8; MOST_LANES]) -> __m512i {
        let wide: [i32; 16] = lanes.map(i32::from);
        // SAFETY: sixteen numbers are there to be read, at any alignment.
        unsafe { _mm512_loadu_si512(wide.as_ptr().cast()) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX-512")]
    fn ordered(self, order: __m512i) -> Self {
        // SAFETY: as above.
        Avx512Singles(unsafe { _mm512_permutexvar_ps(order, self.0) })
    }

    #[inline(always)]
    fn lanes_of(mask: __mmask16) -> u32 {
        u32::from(mask)
    }

    #[inline(always)]
    fn mask_of(lanes: u32) -> __mmask16 {
        lanes as u16
    }

    #[inline(always)]
    fn and(a: __mmask16, b: __mmask16) -> __mmask16 {
        a & b
    }

    #[inline(always)]
    fn or(a: __mmask16, b: __mmask16) -> __mmask16 {
        a | b
    }

    #[inline(always)]
    fn not(a: __mmask16) -> __mmask16 {
        !a
    }
}

impl Singles for Avx512Singles {
    type Wide = [Avx512; 2];

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of AVX-512")]
    fn widened(self) -> [Avx512; 2] {
        // SAFETY: as above.
        let (low, high) = unsafe {
            let low = _mm512_castps512_ps256(self.0);
            let high = _mm512_extractf32x8_ps::<1>(self.0);
            (_mm512_cvtps_pd(low), _mm512_cvtps_pd(high))
        };
        [Avx512(low), Avx512(high)]
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of AVX-512")]
    fn narrowed([low, high]: [Avx512; 2]) -> Self {
        // SAFETY: as above.
        Avx512Singles(unsafe {
            let (low, high) = (_mm512_cvtpd_ps(low.0), _mm512_cvtpd_ps(high.0));
            _mm512_insertf32x8::<1>(_mm512_castps256_ps512(low), high)
        })
    }
}
