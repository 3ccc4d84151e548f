//! What a register can do, lane by lane.
//!
//! Everything is arithmetic as IEEE 754 prescribes it, so that registers of all widths give the same bits. The elementary
//! functions are written once, over [`Doubles`].

use super::elementary::Elementary;
use crate::real::{Base, Real, Task};
use core::fmt::Debug;

/// Whether a processor has the instructions of a register, and how to use them.
pub trait Instructions {
    /// Whether the processor at hand has them.
    fn there() -> bool;
    /// Runs a task, compiled for them. They must be there.
    fn enable<W: Task>(task: W) -> W::Output;
}

/// A register of numbers, one per scenario.
pub trait Register: Instructions + Elementary + Copy + Debug + 'static {
    /// A number: a double or a single.
    type One: Real + PartialEq;
    /// One truth value per lane.
    type Mask: Copy;
    /// Which lane goes where.
    type Order: Copy;
    /// What a lane is.
    const BASE: Base;
    /// How many there are.
    const LANES: usize;
    /// What 1 and the next number differ by.
    const EPSILON: f64;

    /// The nearest number, in every lane.
    fn splat(value: f64) -> Self;
    /// The first numbers of a slice, one per lane; NaN where it is shorter than the register.
    fn load(values: &[Self::One]) -> Self;
    /// One number per lane, into the first places of a slice; nothing where it is shorter than the register.
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
    /// The larger one; `self` where either is no number.
    fn max(self, other: Self) -> Self;
    /// The smaller one; `self` where either is no number.
    fn min(self, other: Self) -> Self;
    /// False where either is no number.
    fn lt(self, other: Self) -> Self::Mask;
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self;
    /// Bit i: lane i.
    fn lanes_of(mask: Self::Mask) -> u32;
    /// Lane i: bit i.
    fn mask_of(lanes: u32) -> Self::Mask;
    fn and(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn or(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    fn not(a: Self::Mask) -> Self::Mask;
    /// The order that puts into each lane what is in the lane named there; of a narrower register the first count.
    fn order(lanes: &[u8; MOST_LANES]) -> Self::Order;
    /// The same numbers in other lanes.
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

    /// The same, with another number in one lane.
    #[inline(always)]
    fn with_lane(self, index: usize, value: Self::One) -> Self {
        let mut lanes = self.lanes();
        lanes[index % MOST_LANES] = value;
        Self::load(&lanes)
    }
}

/// A register of doubles, whose bits can be had.
pub trait Doubles: Register<One = f64> {
    /// 64 bits per lane.
    type Bits: Copy;

    /// To the nearest whole number, to the even one of two.
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
    /// Zeros come in from the left.
    fn bits_shr<const N: u32>(a: Self::Bits) -> Self::Bits;
    /// Where any bit is set.
    fn bits_nonzero(a: Self::Bits) -> Self::Mask;
}

/// A register of singles, which registers of doubles can hold.
pub trait Singles: Register<One = f32> {
    /// Registers of doubles.
    type Wide: Elementary;
    /// The same numbers as doubles.
    fn widened(self) -> Self::Wide;
    /// The nearest singles.
    fn narrowed(wide: Self::Wide) -> Self;
}

/// No register has more lanes.
pub const MOST_LANES: usize = 16;

/// Something in the frame of a function that lies where a cache line begins.
#[repr(align(64))]
struct Line(#[expect(dead_code, reason = "its place is what counts")] u8);

/// Makes the function that it is inlined into align its frame to cache lines. The compiler keeps in the frame what no register is
/// free for, and it decides too late to align the frame for that alone: without this a wide register crosses a line at every store and
/// load, which takes twice as long.
#[inline(always)]
pub(crate) fn aligned_frame() {
    let line = Line(0);
    core::hint::black_box(&line);
}
