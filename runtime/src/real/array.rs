//! Several doubles side by side, each of which behaves exactly as `f64`: products and sums are rounded one after the
//! other, not fused as in [`lanes`](super::lanes).
//!
//! As the scalar of [`Dual`](super::Dual) they hold a value, the same in every lane, and its derivatives in several
//! directions: columns of a Jacobian side by side. Each column has the bits that `Dual<f64>` gives. They need no
//! special instructions, and use wide ones where these exist. Machine code works on them in whole registers
//! ([`Layout`](super::Layout)).
//!
//! On x86-64, tasks over an array of four or eight are compiled for processors that hold it in one register, and for no
//! others: ask [`Array4::there`] and [`Array8::there`] before. Every processor runs tasks over two.

#[cfg(target_arch = "x86_64")]
use super::lanes::{Alone, Apart, Avx2, Avx512, Instructions};
use super::{Base, Form, Mask, Real, Task, by_index};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A truth value for each lane: its word has all bits set, or none, so that a choice is an operation on bits, for all
/// lanes at once.
#[derive(Clone, Copy, Debug)]
pub struct Words<const N: usize>([u64; N]);

impl<const N: usize> Words<N> {
    #[inline(always)]
    fn of(truth: impl Fn(usize) -> bool) -> Self {
        Words(by_index(0, |lane| {
            0u64.wrapping_sub(u64::from(truth(lane)))
        }))
    }
}

impl<const N: usize> Mask for Words<N> {
    #[inline(always)]
    fn any(self) -> bool {
        self.0.into_iter().fold(0, |all, lane| all | lane) != 0
    }

    #[inline(always)]
    fn all(self) -> bool {
        self.0.into_iter().fold(u64::MAX, |all, lane| all & lane) != 0
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        Words(by_index(0, |i| self.0[i] & other.0[i]))
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        Words(by_index(0, |i| self.0[i] | other.0[i]))
    }

    #[inline(always)]
    fn not(self) -> Self {
        Words(by_index(0, |i| !self.0[i]))
    }

    #[inline(always)]
    fn lanes(self) -> u32 {
        let bit = |lane: usize| ((self.0[lane] & 1) as u32) << lane;
        (0..N).fold(0, |bits, lane| bits | bit(lane))
    }

    #[inline(always)]
    fn of_lanes(lanes: u32) -> Self {
        Words::of(|lane| lanes >> lane & 1 != 0)
    }
}

/// Applies a function to each lane. If all lanes hold the same number, as values with different derivatives do, it is
/// computed once. This is compiled separately, because it needs no instructions of registers.
#[inline(never)]
fn each<const N: usize, const A: usize, R: Copy>(
    lanes: [[f64; N]; A],
    function: impl Fn([f64; A]) -> R,
) -> [R; N] {
    let of = |lane: usize| by_index(0.0, |i| lanes[i][lane]);
    let bits = |lane: usize| by_index::<u64, A>(0, |i| lanes[i][lane].to_bits());
    let first = bits(0);
    let result = function(of(0));
    if (1..N).all(|lane| bits(lane) == first) {
        return [result; N];
    }
    by_index(result, |lane| match lane {
        0 => result,
        _ => function(of(lane)),
    })
}

/// An operator of each lane.
macro_rules! operator {
    ($name:ident, $trait:ident, $method:ident) => {
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $name(by_index(0.0, |i| self.0[i].$method(other.0[i])))
            }
        }
    };
}

/// A scalar of several doubles, aligned like the register that holds it.
macro_rules! array {
    ($(#[$text:meta])* $name:ident, $lanes:literal, $align:literal, $instructions:ty) => {
        $(#[$text])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(C, align($align))]
        pub struct $name(pub [f64; $lanes]);

        operator!($name, Add, add);
        operator!($name, Sub, sub);
        operator!($name, Mul, mul);
        operator!($name, Div, div);

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                $name(by_index(0.0, |i| -self.0[i]))
            }
        }

        impl AddAssign for $name {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }

        impl $name {
            /// Whether this processor runs tasks over it: on x86-64, whether it has registers of this length.
            #[must_use]
            pub fn is_available() -> bool {
                #[cfg(target_arch = "x86_64")]
                return <$instructions>::is_available();
                #[cfg(not(target_arch = "x86_64"))]
                return true;
            }
        }

        impl Real for $name {
            type Mask = Words<$lanes>;
            without_slopes!();
            const FORM: Option<Form> = Some(Form::of(Base::Double).times($lanes));

            /// # Panics
            /// If this processor runs no tasks over it. A second copy of each task, for such processors, would take as
            /// long to compile as the first.
            #[inline(always)]
            fn dispatch<W: Task>(task: W) -> W::Output {
                assert!(Self::is_available(), "registers that this processor does not have");
                #[cfg(target_arch = "x86_64")]
                return <$instructions>::dispatch(task);
                #[cfg(not(target_arch = "x86_64"))]
                return task.run();
            }

            #[inline(always)]
            fn put(self, stride: usize, words: &mut [f64]) {
                for (lane, value) in self.0.into_iter().enumerate() {
                    words[lane * stride] = value;
                }
            }

            #[inline(always)]
            fn of_words(stride: usize, words: &[f64]) -> Self {
                $name(by_index(0.0, |lane| words[lane * stride]))
            }

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                $name([value; $lanes])
            }

            /// The largest lane.
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.0.into_iter().fold(f64::NEG_INFINITY, f64::max)
            }

            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                $name(by_index(0.0, |i| Real::mul_add(self.0[i], a.0[i], b.0[i])))
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                $name(by_index(0.0, |i| Real::sqrt(self.0[i])))
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let both = each([self.0], |[x]| Real::sin_cos(x));
                ($name(by_index(0.0, |i| both[i].0)), $name(by_index(0.0, |i| both[i].1)))
            }

            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                $name(each([self.0, x.0], |[y, x]| Real::atan2(y, x)))
            }

            #[inline(always)]
            fn exp(self) -> Self {
                $name(each([self.0], |[x]| Real::exp(x)))
            }

            #[inline(always)]
            fn ln(self) -> Self {
                $name(each([self.0], |[x]| Real::ln(x)))
            }

            #[inline(always)]
            fn powf(self, power: Self) -> Self {
                $name(each([self.0, power.0], |[x, power]| Real::powf(x, power)))
            }

            #[inline(always)]
            fn abs(self) -> Self {
                $name(by_index(0.0, |i| self.0[i].abs()))
            }

            #[inline(always)]
            fn lt(self, other: Self) -> Words<$lanes> {
                Words::of(|lane| self.0[lane] < other.0[lane])
            }

            #[inline(always)]
            fn select(mask: Words<$lanes>, then: Self, otherwise: Self) -> Self {
                let chosen = |lane: usize| {
                    let (then, otherwise) = (then.0[lane].to_bits(), otherwise.0[lane].to_bits());
                    f64::from_bits(then & mask.0[lane] | otherwise & !mask.0[lane])
                };
                $name(by_index(0.0, chosen))
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                self.0.into_iter().all(f64::is_finite)
            }
        }
    };
}

array!(
    /// Two doubles.
    Array2, 2, 16, Alone<f64, Apart>
);
array!(
    /// Four doubles.
    Array4, 4, 32, Avx2
);
array!(
    /// Eight doubles.
    Array8, 8, 64, Avx512
);
