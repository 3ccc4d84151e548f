//! The operations of a register, lane by lane.
//!
//! All arithmetic is that of IEEE 754, so registers of all widths give the same bits. The elementary functions are
//! written once, over [`Doubles`].

use super::elementary::Elementary;
use crate::real::{Base, Real, Task};
use core::fmt::Debug;

/// Whether a processor has the instructions of a register, and how to use them.
pub trait Instructions {
    /// Whether this processor has them.
    fn is_available() -> bool;
    /// Runs a task that is compiled for them. The processor must have them.
    fn dispatch<W: Task>(task: W) -> W::Output;
}

/// A register of numbers, one per scenario.
pub trait Register: Send + Sync + Instructions + Elementary + Copy + Debug + 'static {
    /// The number in a lane: a double or a single.
    type One: Real + PartialEq;
    /// One truth value per lane.
    type Mask: Copy;
    /// A permutation of lanes.
    type Order: Copy;
    /// The kind of number in a lane.
    const BASE: Base;
    /// Number of lanes.
    const LANES: usize;
    /// The distance from 1 to the next number.
    const EPSILON: f64;

    /// The nearest number, in every lane.
    fn splat(value: f64) -> Self;
    /// The first numbers of a slice, one per lane; NaN if the slice is shorter than the register.
    fn load(values: &[Self::One]) -> Self;
    /// Writes one number per lane to the front of a slice; nothing if the slice is shorter than the register.
    fn store(self, values: &mut [Self::One]);
    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    /// self · a + b, rounded once where the register fuses.
    fn mul_add(self, a: Self, b: Self) -> Self;
    fn sqrt(self) -> Self;
    fn abs(self) -> Self;
    fn neg(self) -> Self;
    /// The larger one; `self` where either is NaN.
    fn max(self, other: Self) -> Self;
    /// The smaller one; `self` where either is NaN.
    fn min(self, other: Self) -> Self;
    /// `self < other`, per lane; false where either is NaN.
    fn lt(self, other: Self) -> Self::Mask;
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self;
    /// The mask as bits: bit i is lane i.
    fn lanes_of(mask: Self::Mask) -> u32;
    /// The mask from bits: lane i is bit i.
    fn mask_of(lanes: u32) -> Self::Mask;
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn not(a: Self::Mask) -> Self::Mask;
    /// The permutation that moves into each lane i the number of the lane `lanes[i]`. A narrower register uses the
    /// first entries.
    fn order(lanes: &[u8; MOST_LANES]) -> Self::Order;
    /// The numbers, permuted.
    fn ordered(self, order: Self::Order) -> Self;

    /// True in at least one lane.
    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        Self::lanes_of(mask) != 0
    }

    /// True in every lane.
    #[inline(always)]
    fn all(mask: Self::Mask) -> bool {
        Self::lanes_of(mask) == u32::MAX >> (32 - Self::LANES)
    }

    /// The numbers of all lanes, followed by zeros.
    #[inline(always)]
    fn lanes(self) -> [Self::One; MOST_LANES] {
        let mut lanes = [Self::One::from_f64(0.0); MOST_LANES];
        self.store(&mut lanes);
        lanes
    }

    /// The number in a lane.
    #[inline(always)]
    fn lane(self, index: usize) -> Self::One {
        self.lanes()[index % MOST_LANES]
    }

    /// The same register with another number in one lane.
    #[inline(always)]
    fn with_lane(self, index: usize, value: Self::One) -> Self {
        let mut lanes = self.lanes();
        lanes[index % MOST_LANES] = value;
        Self::load(&lanes)
    }
}

/// A register of doubles, with access to its bits.
pub trait Doubles: Register<One = f64> {
    /// 64 bits per lane.
    type Bits: Copy;

    /// Rounds to the nearest whole number, and to the even one of two.
    fn round(self) -> Self;
    fn bits(self) -> Self::Bits;
    fn from_bits(bits: Self::Bits) -> Self;
    fn splat_bits(value: u64) -> Self::Bits;
    fn bits_and(a: Self::Bits, b: Self::Bits) -> Self::Bits;
    fn bits_or(a: Self::Bits, b: Self::Bits) -> Self::Bits;
    fn bits_xor(a: Self::Bits, b: Self::Bits) -> Self::Bits;
    fn bits_add(a: Self::Bits, b: Self::Bits) -> Self::Bits;
    fn bits_sub(a: Self::Bits, b: Self::Bits) -> Self::Bits;
    fn bits_shl<const N: u32>(a: Self::Bits) -> Self::Bits;
    /// Shifts right; zeros come in from the left.
    fn bits_shr<const N: u32>(a: Self::Bits) -> Self::Bits;
    /// The lanes in which any bit is set.
    fn bits_nonzero(a: Self::Bits) -> Self::Mask;
}

/// A register of singles, whose numbers registers of doubles can hold.
pub trait Singles: Register<One = f32> {
    /// The registers of doubles that hold them.
    type Wide: Elementary;
    /// The same numbers as doubles.
    fn widened(self) -> Self::Wide;
    /// The nearest singles.
    fn narrowed(wide: Self::Wide) -> Self;
}

/// The largest number of lanes of a register.
pub const MOST_LANES: usize = 16;

/// A variable in the frame of a function that lies at the beginning of a cache line.
#[cfg(target_arch = "x86_64")]
#[repr(align(64))]
struct Line(#[expect(dead_code, reason = "its place is what counts")] u8);

/// Aligns to cache lines the stack frame of the function that this is inlined into. The compiler keeps in the frame
/// what does not fit into registers, but decides this too late to align the frame. In an unaligned frame a wide
/// register crosses a cache line at every store and load, which takes twice as long.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub(crate) fn aligned_frame() {
    let line = Line(0);
    core::hint::black_box(&line);
}
