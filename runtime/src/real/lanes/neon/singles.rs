//! Four singles in a register of NEON.

use super::Neon;
use crate::real::lanes::register::{Instructions, MOST_LANES, Register, Singles};
use crate::real::{Base, Task};
use core::arch::aarch64::*;

/// Four singles.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct NeonSingles(float32x4_t);

impl Instructions for NeonSingles {
    #[inline(always)]
    fn is_available() -> bool {
        Neon::is_available()
    }

    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        Neon::dispatch(task)
    }
}

impl Register for NeonSingles {
    type One = f32;
    type Mask = uint32x4_t;
    type Order = uint8x16_t;
    const LANES: usize = 4;
    const BASE: Base = Base::SingleLane;
    const EPSILON: f64 = f32::EPSILON as f64;

    instruction!(add(other) = vaddq_f32);
    instruction!(sub(other) = vsubq_f32);
    instruction!(mul(other) = vmulq_f32);
    instruction!(div(other) = vdivq_f32);
    instruction!(sqrt() = vsqrtq_f32);
    instruction!(abs() = vabsq_f32);
    instruction!(neg() = vnegq_f32);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn mul_add(self, a: Self, b: Self) -> Self {
        // SAFETY: every 64-bit ARM has it. The instruction adds to its first operand.
        NeonSingles(unsafe { vfmaq_f32(b.0, self.0, a.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        NeonSingles(unsafe { vdupq_n_f32(value as f32) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn load(values: &[f32]) -> Self {
        let first: &[f32; 4] = values.first_chunk().unwrap_or(&[f32::NAN; 4]);
        // SAFETY: four singles are there to be read.
        NeonSingles(unsafe { vld1q_f32(first.as_ptr()) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn store(self, values: &mut [f32]) {
        if let Some(first) = values.first_chunk_mut::<4>() {
            // SAFETY: four singles are there to be written.
            unsafe { vst1q_f32(first.as_mut_ptr(), self.0) }
        }
    }

    /// The instruction for this propagates NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }

    /// The instruction for this propagates NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn lt(self, other: Self) -> uint32x4_t {
        // SAFETY: as above.
        unsafe { vcltq_f32(self.0, other.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn select(mask: uint32x4_t, then: Self, otherwise: Self) -> Self {
        // SAFETY: as above.
        NeonSingles(unsafe { vbslq_f32(mask, then.0, otherwise.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn order(lanes: &[u8; MOST_LANES]) -> uint8x16_t {
        // the bytes of each single
        let bytes: [u8; 16] = core::array::from_fn(|i| 4 * (lanes[i / 4] & 3) + i as u8 % 4);
        // SAFETY: sixteen bytes are there to be read.
        unsafe { vld1q_u8(bytes.as_ptr()) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn ordered(self, order: uint8x16_t) -> Self {
        // SAFETY: as above.
        unsafe {
            let bytes = vqtbl1q_u8(vreinterpretq_u8_f32(self.0), order);
            NeonSingles(vreinterpretq_f32_u8(bytes))
        }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of NEON")]
    fn lanes_of(mask: uint32x4_t) -> u32 {
        // SAFETY: as above.
        unsafe { vaddvq_u32(vandq_u32(mask, bits())) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of NEON")]
    fn mask_of(lanes: u32) -> uint32x4_t {
        // SAFETY: as above.
        unsafe { vtstq_u32(vdupq_n_u32(lanes), bits()) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn and(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t {
        // SAFETY: as above.
        unsafe { vandq_u32(a, b) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn or(a: uint32x4_t, b: uint32x4_t) -> uint32x4_t {
        // SAFETY: as above.
        unsafe { vorrq_u32(a, b) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn not(a: uint32x4_t) -> uint32x4_t {
        // SAFETY: as above.
        unsafe { vmvnq_u32(a) }
    }
}

/// The bit of each lane.
#[inline(always)]
#[expect(unsafe_code, reason = "a register as memory")]
fn bits() -> uint32x4_t {
    // SAFETY: four words are there to be read.
    unsafe { vld1q_u32([1, 2, 4, 8].as_ptr()) }
}

impl Singles for NeonSingles {
    type Wide = [Neon; 2];

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of NEON")]
    fn widened(self) -> [Neon; 2] {
        // SAFETY: as above.
        let (low, high) = unsafe {
            (
                vcvt_f64_f32(vget_low_f32(self.0)),
                vcvt_high_f64_f32(self.0),
            )
        };
        [Neon(low), Neon(high)]
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of NEON")]
    fn narrowed([low, high]: [Neon; 2]) -> Self {
        // SAFETY: as above.
        NeonSingles(unsafe { vcvt_high_f32_f64(vcvt_f32_f64(low.0), high.0) })
    }
}
