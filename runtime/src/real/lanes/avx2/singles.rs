//! Eight singles in a register of AVX2.

use super::Avx2;
use crate::real::lanes::register::{Instructions, MOST_LANES, Register, Singles};
use crate::real::{Base, Task};
use core::arch::x86_64::*;

/// Eight singles.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Avx2Singles(__m256);

impl Instructions for Avx2Singles {
    #[inline(always)]
    fn is_available() -> bool {
        Avx2::is_available()
    }

    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        Avx2::dispatch(task)
    }
}

impl Register for Avx2Singles {
    type One = f32;
    type Mask = __m256;
    type Order = __m256i;
    const LANES: usize = 8;
    const BASE: Base = Base::SingleLane;
    const EPSILON: f64 = f32::EPSILON as f64;

    instruction!(add(other) = _mm256_add_ps);
    instruction!(sub(other) = _mm256_sub_ps);
    instruction!(mul(other) = _mm256_mul_ps);
    instruction!(div(other) = _mm256_div_ps);
    instruction!(mul_add(a, b) = _mm256_fmadd_ps);
    instruction!(sqrt() = _mm256_sqrt_ps);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        Avx2Singles(unsafe { _mm256_set1_ps(value as f32) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn load(values: &[f32]) -> Self {
        let first: &[f32; 8] = values.first_chunk().unwrap_or(&[f32::NAN; 8]);
        // SAFETY: eight singles are there to be read, at any alignment.
        Avx2Singles(unsafe { _mm256_loadu_ps(first.as_ptr()) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn store(self, values: &mut [f32]) {
        if let Some(first) = values.first_chunk_mut::<8>() {
            // SAFETY: eight singles are there to be written, at any alignment.
            unsafe { _mm256_storeu_ps(first.as_mut_ptr(), self.0) }
        }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn neg(self) -> Self {
        // SAFETY: as above.
        Avx2Singles(unsafe { _mm256_xor_ps(self.0, _mm256_set1_ps(-0.0)) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn abs(self) -> Self {
        // SAFETY: as above.
        Avx2Singles(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn max(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx2Singles(unsafe { _mm256_max_ps(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn min(self, other: Self) -> Self {
        // SAFETY: as above. The instruction returns its second operand where either is NaN.
        Avx2Singles(unsafe { _mm256_min_ps(other.0, self.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn lt(self, other: Self) -> __m256 {
        // SAFETY: as above.
        unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn select(mask: __m256, then: Self, otherwise: Self) -> Self {
        // SAFETY: as above.
        Avx2Singles(unsafe { _mm256_blendv_ps(otherwise.0, then.0, mask) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn order(lanes: &[u8; MOST_LANES]) -> __m256i {
        let [a, b, c, d, e, f, g, h, ..] = lanes.map(i32::from);
        // SAFETY: as above.
        unsafe { _mm256_setr_epi32(a, b, c, d, e, f, g, h) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn ordered(self, order: __m256i) -> Self {
        // SAFETY: as above.
        Avx2Singles(unsafe { _mm256_permutevar8x32_ps(self.0, order) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn lanes_of(mask: __m256) -> u32 {
        // SAFETY: as above.
        unsafe { _mm256_movemask_ps(mask).cast_unsigned() }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of AVX2")]
    fn mask_of(lanes: u32) -> __m256 {
        // SAFETY: as above.
        unsafe {
            let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let set = _mm256_and_si256(_mm256_set1_epi32(lanes.cast_signed()), bits);
            _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, bits))
        }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn and(a: __m256, b: __m256) -> __m256 {
        // SAFETY: as above.
        unsafe { _mm256_and_ps(a, b) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn or(a: __m256, b: __m256) -> __m256 {
        // SAFETY: as above.
        unsafe { _mm256_or_ps(a, b) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of AVX2")]
    fn not(a: __m256) -> __m256 {
        // SAFETY: as above.
        unsafe { _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1))) }
    }
}

impl Singles for Avx2Singles {
    type Wide = [Avx2; 2];

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of AVX2")]
    fn widened(self) -> [Avx2; 2] {
        // SAFETY: as above.
        let (low, high) = unsafe {
            let low = _mm256_castps256_ps128(self.0);
            let high = _mm256_extractf128_ps::<1>(self.0);
            (_mm256_cvtps_pd(low), _mm256_cvtps_pd(high))
        };
        [Avx2(low), Avx2(high)]
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of AVX2")]
    fn narrowed([low, high]: [Avx2; 2]) -> Self {
        // SAFETY: as above.
        Avx2Singles(unsafe {
            let (low, high) = (_mm256_cvtpd_ps(low.0), _mm256_cvtpd_ps(high.0));
            _mm256_set_m128(high, low)
        })
    }
}
