//! A single number as a register: for one scenario, for `f64` and `f32` alone, and for processors without wide
//! registers.

use super::elementary::Elementary;
use super::register::{Doubles, Instructions, MOST_LANES, Register, Singles};
use crate::real::{Base, Plain, Task};
use core::fmt::Debug;
use core::marker::PhantomData;

/// How a product and a sum are rounded, and by what.
pub trait Rounding: Copy + Debug + Send + Sync + 'static {
    /// Whether they are rounded once.
    const FUSED: bool;
}

/// Rounded one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Apart;

/// Rounded once: by an instruction on x86-64 and 64-bit ARM, by a function on other processors.
#[derive(Clone, Copy, Debug)]
pub struct Fused;

/// Rounded once, by a function: for x86-64 processors that lack the instruction. It is slow, but gives the same bits.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy, Debug)]
pub struct Emulated;
/// [`Fused`], as every processor but x86-64 has it.
#[cfg(not(target_arch = "x86_64"))]
pub type Emulated = Fused;

impl Rounding for Apart {
    const FUSED: bool = false;
}

impl Rounding for Fused {
    const FUSED: bool = true;
}

#[cfg(target_arch = "x86_64")]
impl Rounding for Emulated {
    const FUSED: bool = true;
}

/// One double or single.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Alone<F, R>(F, PhantomData<R>);

impl<F, R> Alone<F, R> {
    #[inline(always)]
    pub(in crate::real) fn of(number: F) -> Self {
        Alone(number, PhantomData)
    }

    #[inline(always)]
    pub(in crate::real) fn number(self) -> F {
        self.0
    }
}

/// 1.5 · 2⁵²: adding and subtracting it rounds to the nearest whole number.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// From here on every double is a whole number.
const WHOLE: f64 = 4_503_599_627_370_496.0;

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "fma,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn compiled_for_fused<W: Task>(task: W) -> W::Output {
    task.run()
}

impl<F> Instructions for Alone<F, Fused> {
    /// On x86-64, true if there are registers of four lanes, of which this is one lane.
    #[inline(always)]
    fn is_available() -> bool {
        #[cfg(target_arch = "x86_64")]
        return <super::avx2::Avx2 as Instructions>::is_available();
        #[cfg(not(target_arch = "x86_64"))]
        return true;
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    #[expect(unsafe_code, reason = "the instructions of a certain processor")]
    fn dispatch<W: Task>(task: W) -> W::Output {
        // SAFETY: the code that makes the first register has called `there`; the type cannot be named outside of this
        // crate.
        unsafe { compiled_for_fused(task) }
    }

    #[cfg(not(target_arch = "x86_64"))]
    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        plain(task)
    }
}

/// Implements [`Instructions`] for numbers that every processor has.
macro_rules! everywhere {
    ($rounding:ty) => {
        impl<F> Instructions for Alone<F, $rounding> {
            #[inline(always)]
            fn is_available() -> bool {
                true
            }

            #[inline(always)]
            fn dispatch<W: Task>(task: W) -> W::Output {
                plain(task)
            }
        }
    };
}

everywhere!(Apart);
#[cfg(target_arch = "x86_64")]
everywhere!(Emulated);

/// A function of its own, as for the other registers.
#[inline(never)]
fn plain<W: Task>(task: W) -> W::Output {
    task.run()
}

/// A method that is an operator.
macro_rules! operator {
    ($name:ident = $operator:tt) => {
        #[inline(always)]
        fn $name(self, other: Self) -> Self {
            Alone::of(self.0 $operator other.0)
        }
    };
}

/// A function of bits.
macro_rules! of_bits {
    ($name:ident = $a:ident $b:ident $result:expr) => {
        #[inline(always)]
        fn $name($a: u64, $b: u64) -> u64 {
            $result
        }
    };
}

/// A number alone as a register.
macro_rules! register {
    ($float:ident, $base:ident) => {
        impl<R: Rounding> Register for Alone<$float, R>
        where
            Self: Instructions + Elementary,
        {
            type One = $float;
            type Mask = bool;
            type Order = ();
            const LANES: usize = 1;
            const BASE: Base = Base::$base;
            const EPSILON: f64 = $float::EPSILON as f64;

            operator!(add = +);
            operator!(sub = -);
            operator!(mul = *);
            operator!(div = /);

            #[inline(always)]
            fn splat(value: f64) -> Self {
                Alone::of(value as $float)
            }

            #[inline(always)]
            fn load(values: &[$float]) -> Self {
                Alone::of(values.first().copied().unwrap_or($float::NAN))
            }

            #[inline(always)]
            fn store(self, values: &mut [$float]) {
                if let Some(first) = values.first_mut() {
                    *first = self.0;
                }
            }

            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                if R::FUSED {
                    Alone::of(self.0.fused(a.0, b.0))
                } else {
                    Alone::of(self.0 * a.0 + b.0)
                }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                Alone::of(self.0.root())
            }

            #[inline(always)]
            fn abs(self) -> Self {
                Alone::of(self.0.abs())
            }

            #[inline(always)]
            fn neg(self) -> Self {
                Alone::of(-self.0)
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                if self.0 < other.0 { other } else { self }
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                if other.0 < self.0 { other } else { self }
            }

            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self.0 < other.0
            }

            #[inline(always)]
            fn select(mask: bool, then: Self, otherwise: Self) -> Self {
                if mask { then } else { otherwise }
            }

            #[inline(always)]
            fn order(_: &[u8; MOST_LANES]) {}

            #[inline(always)]
            fn ordered(self, (): ()) -> Self {
                self
            }

            #[inline(always)]
            fn lanes_of(mask: bool) -> u32 {
                u32::from(mask)
            }

            #[inline(always)]
            fn mask_of(lanes: u32) -> bool {
                lanes & 1 != 0
            }

            #[inline(always)]
            fn and(a: bool, b: bool) -> bool {
                a & b
            }

            #[inline(always)]
            fn or(a: bool, b: bool) -> bool {
                a | b
            }

            #[inline(always)]
            fn not(a: bool) -> bool {
                !a
            }
        }
    };
}

register!(f64, Lane);
register!(f32, SingleLane);

impl<R: Rounding> Doubles for Alone<f64, R>
where
    Self: Instructions,
{
    type Bits = u64;

    of_bits!(bits_and = a b a & b);
    of_bits!(bits_or = a b a | b);
    of_bits!(bits_xor = a b a ^ b);
    of_bits!(bits_add = a b a.wrapping_add(b));
    of_bits!(bits_sub = a b a.wrapping_sub(b));

    #[inline(always)]
    fn round(self) -> Self {
        // restores the sign, as the instruction of wide registers does
        let magnitude = self.0.abs();
        let whole = match magnitude < WHOLE {
            true => magnitude + ROUND - ROUND,
            false => magnitude,
        };
        Alone::of(whole.copysign(self.0))
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.0.to_bits()
    }

    #[inline(always)]
    fn from_bits(bits: u64) -> Self {
        Alone::of(f64::from_bits(bits))
    }

    #[inline(always)]
    fn splat_bits(value: u64) -> u64 {
        value
    }

    #[inline(always)]
    fn bits_shl<const N: u32>(a: u64) -> u64 {
        a << N
    }

    #[inline(always)]
    fn bits_shr<const N: u32>(a: u64) -> u64 {
        a >> N
    }

    #[inline(always)]
    fn bits_nonzero(a: u64) -> bool {
        a != 0
    }
}

impl<R: Rounding> Singles for Alone<f32, R>
where
    Self: Instructions + Elementary,
    Alone<f64, R>: Doubles,
{
    type Wide = Alone<f64, R>;

    #[inline(always)]
    fn widened(self) -> Self::Wide {
        Alone::of(f64::from(self.0))
    }

    #[inline(always)]
    fn narrowed(wide: Self::Wide) -> Self {
        Alone::of(wide.0 as f32)
    }
}
