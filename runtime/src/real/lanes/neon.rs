//! Two doubles in a register of Advanced SIMD (NEON), which every 64-bit ARM has.

use super::register::{Doubles, Instructions, MOST_LANES, Register};
use crate::real::{Base, Task};
use core::arch::aarch64::*;

/// Two doubles.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Neon(float64x2_t);

/// A function of its own, as for the other registers.
#[inline(never)]
fn compiled_for_neon<W: Task>(task: W) -> W::Output {
    task.run()
}

impl Instructions for Neon {
    #[inline(always)]
    fn is_available() -> bool {
        true
    }

    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        compiled_for_neon(task)
    }
}

/// A method that is one instruction of registers.
macro_rules! instruction {
    ($name:ident($($argument:ident),*) = $intrinsic:ident) => {
        #[inline(always)]
        #[expect(unsafe_code, reason = "an instruction of NEON")]
        fn $name(self $(, $argument: Self)*) -> Self {
            // SAFETY: every 64-bit ARM has it.
            Self(unsafe { $intrinsic(self.0 $(, $argument.0)*) })
        }
    };
}

/// A function of bits that is one instruction.
macro_rules! of_bits {
    ($name:ident = $intrinsic:ident) => {
        #[inline(always)]
        #[expect(unsafe_code, reason = "an instruction of NEON")]
        fn $name(a: uint64x2_t, b: uint64x2_t) -> uint64x2_t {
            // SAFETY: every 64-bit ARM has it.
            unsafe { $intrinsic(a, b) }
        }
    };
}

mod singles;

pub use singles::NeonSingles;

impl Register for Neon {
    type One = f64;
    type Mask = uint64x2_t;
    type Order = uint8x16_t;
    const LANES: usize = 2;
    const BASE: Base = Base::Lane;
    const EPSILON: f64 = f64::EPSILON;

    instruction!(add(other) = vaddq_f64);
    instruction!(sub(other) = vsubq_f64);
    instruction!(mul(other) = vmulq_f64);
    instruction!(div(other) = vdivq_f64);
    instruction!(sqrt() = vsqrtq_f64);
    instruction!(abs() = vabsq_f64);
    instruction!(neg() = vnegq_f64);
    of_bits!(and = vandq_u64);
    of_bits!(or = vorrq_u64);

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn mul_add(self, a: Self, b: Self) -> Self {
        // SAFETY: as above. The instruction adds to its first operand.
        Neon(unsafe { vfmaq_f64(b.0, self.0, a.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn splat(value: f64) -> Self {
        // SAFETY: as above.
        Neon(unsafe { vdupq_n_f64(value) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn load(values: &[f64]) -> Self {
        let first: &[f64; 2] = values.first_chunk().unwrap_or(&[f64::NAN; 2]);
        // SAFETY: two doubles are there to be read.
        Neon(unsafe { vld1q_f64(first.as_ptr()) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "a register as memory")]
    fn store(self, values: &mut [f64]) {
        if let Some(first) = values.first_chunk_mut::<2>() {
            // SAFETY: two doubles are there to be written.
            unsafe { vst1q_f64(first.as_mut_ptr(), self.0) }
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
    fn lt(self, other: Self) -> uint64x2_t {
        // SAFETY: as above.
        unsafe { vcltq_f64(self.0, other.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn select(mask: uint64x2_t, then: Self, otherwise: Self) -> Self {
        // SAFETY: as above.
        Neon(unsafe { vbslq_f64(mask, then.0, otherwise.0) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn order(lanes: &[u8; MOST_LANES]) -> uint8x16_t {
        // the bytes of each double
        let bytes: [u8; 16] = core::array::from_fn(|i| 8 * (lanes[i / 8] & 1) + i as u8 % 8);
        // SAFETY: sixteen bytes are there to be read.
        unsafe { vld1q_u8(bytes.as_ptr()) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn ordered(self, order: uint8x16_t) -> Self {
        // SAFETY: as above.
        unsafe {
            let bytes = vqtbl1q_u8(vreinterpretq_u8_f64(self.0), order);
            Neon(vreinterpretq_f64_u8(bytes))
        }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn lanes_of(mask: uint64x2_t) -> u32 {
        // SAFETY: as above.
        let [first, second] = unsafe { [vgetq_lane_u64::<0>(mask), vgetq_lane_u64::<1>(mask)] };
        (first & 1 | second & 2) as u32
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "instructions of NEON")]
    fn mask_of(lanes: u32) -> uint64x2_t {
        // SAFETY: as above.
        unsafe {
            let bits = vcombine_u64(vcreate_u64(1), vcreate_u64(2));
            vtstq_u64(vdupq_n_u64(lanes.into()), bits)
        }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn not(a: uint64x2_t) -> uint64x2_t {
        // SAFETY: as above.
        unsafe { veorq_u64(a, vdupq_n_u64(u64::MAX)) }
    }
}

impl Doubles for Neon {
    type Bits = uint64x2_t;

    instruction!(round() = vrndnq_f64);
    of_bits!(bits_and = vandq_u64);
    of_bits!(bits_or = vorrq_u64);
    of_bits!(bits_xor = veorq_u64);
    of_bits!(bits_add = vaddq_u64);
    of_bits!(bits_sub = vsubq_u64);

    #[inline(always)]
    #[expect(unsafe_code, reason = "the same register under another name")]
    fn bits(self) -> uint64x2_t {
        // SAFETY: as above.
        unsafe { vreinterpretq_u64_f64(self.0) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "the same register under another name")]
    fn from_bits(bits: uint64x2_t) -> Self {
        // SAFETY: as above.
        Neon(unsafe { vreinterpretq_f64_u64(bits) })
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn splat_bits(value: u64) -> uint64x2_t {
        // SAFETY: as above.
        unsafe { vdupq_n_u64(value) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn bits_shl<const N: u32>(a: uint64x2_t) -> uint64x2_t {
        // SAFETY: as above.
        unsafe { vshlq_u64(a, vdupq_n_s64(i64::from(N))) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn bits_shr<const N: u32>(a: uint64x2_t) -> uint64x2_t {
        // SAFETY: as above. A negative distance shifts right.
        unsafe { vshlq_u64(a, vdupq_n_s64(-i64::from(N))) }
    }

    #[inline(always)]
    #[expect(unsafe_code, reason = "an instruction of NEON")]
    fn bits_nonzero(a: uint64x2_t) -> uint64x2_t {
        // SAFETY: as above.
        unsafe { vtstq_u64(a, a) }
    }
}
