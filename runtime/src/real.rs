//! The scalar that equations are evaluated over.
//!
//! No method of [`Real`] branches on a value: a comparison yields a [`Mask`], a choice is a [`select`](Real::select).
//! So one text serves `f64`, `f32`, registers of several scenarios (a mask per lane), dual numbers (the value is
//! compared, value and derivative are selected together), double-doubles, and a scalar that counts its operations.

/// The items of [`Real`] that a scalar without derivatives has.
macro_rules! without_slopes {
    () => {
        type Value = Self;

        #[inline(always)]
        fn value(self) -> Self {
            self
        }

        #[inline(always)]
        fn of_value(value: Self) -> Self {
            value
        }
    };
}

#[cfg(feature = "std")]
mod array;
#[cfg(any(feature = "std", feature = "libm", test))]
mod core_arithmetic;
mod double_double;
mod dual;
#[cfg(any(feature = "std", feature = "libm", test))]
mod fast_scalar;
#[cfg(any(feature = "std", feature = "libm", test))]
pub mod lanes;
#[cfg(feature = "std")]
mod layout;
#[cfg(not(bryant_equations))]
mod number;
mod words;

#[cfg(feature = "std")]
pub use array::{Array2, Array4, Array8};
#[cfg(any(feature = "std", feature = "libm", test))]
use core_arithmetic::Plain;
pub use double_double::DoubleDouble;
pub use dual::Dual;
#[cfg(any(feature = "std", feature = "libm", test))]
pub use fast_scalar::Fast;
#[cfg(feature = "std")]
pub use lanes::{Several, Width};
#[cfg(feature = "std")]
pub use layout::Layout;
#[cfg(not(bryant_equations))]
pub(crate) use number::Number;
pub use words::{Base, Form};

#[cfg(not(bryant_equations))]
use crate::simulate::{Observer, Receiver, Run};
#[cfg(not(bryant_equations))]
use crate::{Failure, Report};
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A real scalar, or several side by side.
///
/// Generated code and force laws are generic over it. `f64` and `f32` implement it with the feature `std`, or with
/// `libm` for targets without a standard library.
///
/// NaN must survive, because it tells that the argument of a curve left it. Arithmetic passes it on, and
/// [`max`](Real::max) and [`min`](Real::min) keep it in their left argument.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no scalar of `bryant_runtime`",
    note = "`f64` and `f32` are scalars with the feature `std` of bryant-runtime or, without a standard library, with its feature `libm`"
)]
pub trait Real:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    /// Result of a comparison, one truth value per lane.
    type Mask: Mask;
    /// The scalar of its value without derivatives, which may have derivatives of its own: `T` for a dual number over
    /// `T`. For any other scalar it is the scalar itself.
    type Value: Real<Mask = Self::Mask>;
    /// Whether it has derivatives.
    const SLOPES: bool = false;
    /// The value.
    fn value(self) -> Self::Value;
    /// A constant with this value.
    fn of_value(value: Self::Value) -> Self;

    /// Its parts, for functions that are compiled apart; `None` if they are not compiled for it.
    const FORM: Option<Form> = None;
    /// Writes the scalar as plain numbers, [`Form::words`] for each lane. The numbers of lane i begin at i · `stride`.
    /// A scalar without a form writes nothing.
    #[inline(always)]
    fn put(self, _stride: usize, _words: &mut [f64]) {}
    /// Reads the numbers that [`put`](Real::put) wrote; NaN for a scalar without a form.
    #[inline(always)]
    fn of_words(_stride: usize, _words: &[f64]) -> Self {
        Self::from_f64(f64::NAN)
    }

    /// Runs a task that is compiled for the instructions that this scalar needs. Instructions that not every processor
    /// has are function calls unless they are inlined into a function that is compiled for them. So each evaluation of
    /// a model is a task, and all of it is inlined. Every other scalar just runs the task.
    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        task.run()
    }
    /// [`Real::dispatch`] in a function of its own, for a part of a task that is too long to be compiled as one.
    #[inline(never)]
    fn dispatch_apart<W: Task>(task: W) -> W::Output {
        Self::dispatch(task)
    }
    /// Runs the time loop over this scalar to its end, or until it is stopped. For `f64` the time loop is compiled with
    /// this crate, and crates that use it only call it.
    #[cfg(not(bryant_equations))]
    #[doc(hidden)]
    fn march<'a>(
        run: &mut Run<'a, '_, Self>,
        sink: &mut Receiver<'_, Self>,
        observer: Option<&mut Observer<'_>>,
    ) -> Result<Report, Failure<'a>> {
        run.go(sink, observer)
    }
    /// The value without its derivatives, if it has any.
    #[inline(always)]
    fn frozen(self) -> Self {
        self
    }

    /// The same value with the derivatives of `other`, if it has any. An iteration that has found a value uses it to
    /// take one more step for the derivatives.
    #[inline(always)]
    fn moving_as(self, other: Self) -> Self {
        let _ = other;
        self
    }

    /// The nearest scalar to a constant, in every lane.
    fn from_f64(value: f64) -> Self;
    /// The nearest scalar to the product of two constants: a step times a coefficient.
    #[inline(always)]
    fn from_product(a: f64, b: f64) -> Self {
        Self::from_f64(a * b)
    }
    /// The value that decides in step size control: the largest lane; the value of a dual number.
    fn to_f64(self) -> f64;
    /// `self · a + b`: the product is rounded and then the sum, except in scalars that are said to fuse both into one
    /// rounding, such as lanes.
    fn mul_add(self, a: Self, b: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// (sin, cos).
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`) \[rad\], in \[−π, π\].
    fn atan2(self, x: Self) -> Self;
    /// `self` to the power `power`; `self` is not negative.
    fn powf(self, power: Self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `self < other`, per lane; false for NaN.
    fn lt(self, other: Self) -> Self::Mask;
    /// `then` where the mask is true, `otherwise` elsewhere. Both are evaluated. The one that is not chosen has no
    /// effect, even if it is NaN.
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self;
    /// True where every lane is finite; for dual numbers, value and derivatives.
    fn is_finite(self) -> bool;

    /// The larger one; `self` where either is NaN, so that a NaN in `self` survives (one `maxsd` on x86-64).
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.lt(other), other, self)
    }

    /// The smaller one; `self` where either is NaN, so that a NaN in `self` survives.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.lt(self), other, self)
    }

    /// eˣ. The default, for scalars without an exponential of their own, uses arithmetic alone: e^y − 1 for y = |x|/2¹⁰
    /// by its Taylor polynomial, doubled ten times by e²ʸ − 1 = (e^y − 1)(e^y + 1), and the reciprocal where x < 0. The
    /// relative error is at most (4 + 20|x|) ε. Where the result would leave the range of numbers, it is constant.
    #[inline(always)]
    fn exp(self) -> Self {
        let num = Self::from_f64;
        // the largest double is above e⁷⁰⁹, the largest single above e⁸⁸
        let largest = match num(1e300).to_f64().is_finite() {
            true => 709.0,
            false => 88.0,
        };
        let y = self.abs().min(num(largest)) * num(1.0 / 1024.0);
        // y < 0.7: the first term left out, y¹⁸/18!, is below ε/100 of the sum
        let mut sum = num(1.0 / 17.0);
        let mut n = 16.0;
        while n > 1.5 {
            sum = (sum * y + num(1.0)) * num(1.0 / n);
            n -= 1.0;
        }
        let mut less_one = (sum * y + num(1.0)) * y;
        let mut doublings = 0;
        while doublings < 10 {
            less_one = less_one * (less_one + num(2.0));
            doublings += 1;
        }
        let result = less_one + num(1.0);
        Self::select(self.lt(num(0.0)), num(1.0) / result, result)
    }

    /// Natural logarithm of `self`, which is not negative; −∞ for 0. The default, for scalars without a logarithm of
    /// their own, uses t = x^(1/2¹⁰): ln x = 2¹⁰ ln t = 2¹¹ artanh((t − 1)/(t + 1)), by nine terms of the series and
    /// one correction by Halley's step. The absolute error is at most (8 + 40|ln x|) ε for normal numbers.
    #[inline(always)]
    fn ln(self) -> Self {
        let num = Self::from_f64;
        let (zero, one, two) = (num(0.0), num(1.0), num(2.0));
        let t = self.powf(num(1.0 / 1024.0));
        // |z| < 0.34: the first term left out, z¹⁹/19, makes an error of 10⁻⁷, of which the step leaves the third power
        let z = (t - one) / (t + one);
        let z2 = z * z;
        let mut sum = num(1.0 / 17.0);
        let mut n = 15.0;
        while n > 0.5 {
            sum = sum * z2 + num(1.0 / n);
            n -= 2.0;
        }
        let y = num(2048.0) * z * sum;
        let back = y.exp();
        let y = y + two * (self - back) / (self + back);
        // arithmetic does not handle 0 and ∞
        let y = Self::select(self.lt(num(f64::INFINITY)), y, self);
        let at_zero = num(f64::NEG_INFINITY) + self.taint();
        let below = Self::select(self.lt(zero), num(f64::NAN), at_zero);
        Self::select(zero.lt(self), y, below)
    }

    /// Zero, or NaN where `self` is not finite. Added to a result that does not depend on `self`, it still makes the
    /// result NaN if `self` was not finite.
    #[inline(always)]
    fn taint(self) -> Self {
        let same = self;
        self - same
    }
}

/// Work that uses the instructions of a scalar: [`Real::dispatch`]. It is no closure, because a closure cannot be
/// marked to be inlined.
pub trait Task {
    /// Its result.
    type Output;
    /// Does the work. Mark it `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// An array of what a function gives for each index, from the first to the last; `blank` stands in each place before.
/// It is a plain loop, which is compiled for each function; behind [`core::array::from_fn`] are ten functions more.
#[inline(always)]
pub(crate) fn by_index<R: Copy, const N: usize>(
    blank: R,
    mut of: impl FnMut(usize) -> R,
) -> [R; N] {
    let mut all = [blank; N];
    let mut i = 0;
    while i < N {
        all[i] = of(i);
        i += 1;
    }
    all
}

/// An array of what a small function gives for each entry, from the first to the last: a plain loop, as [`by_index`].
/// It calls the function at two places, so a long one would not be inlined.
#[inline(always)]
pub(crate) fn mapped<A: Copy, R: Copy, const N: usize>(
    entries: [A; N],
    mut of: impl FnMut(A) -> R,
) -> [R; N] {
    const { assert!(N > 0) };
    let mut all = [of(entries[0]); N];
    let mut i = 1;
    while i < N {
        all[i] = of(entries[i]);
        i += 1;
    }
    all
}

/// Truth values, one per lane.
pub trait Mask: Copy {
    /// True in at least one lane.
    fn any(self) -> bool;
    /// True in every lane.
    fn all(self) -> bool;
    /// The lanes in which both are true.
    fn and(self, other: Self) -> Self;
    /// The lanes in which at least one is true.
    fn or(self, other: Self) -> Self;
    /// The lanes in which this mask is false.
    fn not(self) -> Self;
    /// The mask as bits: bit i is lane i.
    fn lanes(self) -> u32;
    /// The mask from bits: lane i is bit i.
    fn of_lanes(lanes: u32) -> Self;
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }

    #[inline(always)]
    fn all(self) -> bool {
        self
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self & other
    }

    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self | other
    }

    #[inline(always)]
    fn not(self) -> Self {
        !self
    }

    #[inline(always)]
    fn lanes(self) -> u32 {
        u32::from(self)
    }

    #[inline(always)]
    fn of_lanes(lanes: u32) -> Self {
        lanes & 1 != 0
    }
}

/// Implements [`Real`] for a primitive type, with [`Real::march`] if that is to be compiled here.
#[cfg(any(feature = "std", feature = "libm", test))]
macro_rules! primitive {
    ($float:ident, $base:ident $(, $run:item)?) => {
        impl Real for $float {
            type Mask = bool;
            without_slopes!();
            const FORM: Option<Form> = Some(Form::of(Base::$base));

            #[inline(always)]
            fn put(self, _: usize, words: &mut [f64]) {
                words[0] = f64::from(self);
            }

            #[inline(always)]
            fn of_words(_: usize, words: &[f64]) -> Self {
                words[0] as $float
            }

            #[inline(always)]
            fn mul_add(self, a: Self, b: Self) -> Self {
                self * a + b
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                Plain::root(self)
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                Plain::sin_cos(self)
            }

            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                Plain::atan2(self, x)
            }

            #[inline(always)]
            fn exp(self) -> Self {
                Plain::exp(self)
            }

            #[inline(always)]
            fn ln(self) -> Self {
                Plain::ln(self)
            }

            #[inline(always)]
            fn powf(self, power: Self) -> Self {
                Plain::powf(self, power)
            }

            $($run)?

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn abs(self) -> Self {
                $float::abs(self)
            }

            #[inline(always)]
            fn lt(self, other: Self) -> bool {
                self < other
            }

            #[inline(always)]
            fn select(mask: bool, then: Self, otherwise: Self) -> Self {
                if mask { then } else { otherwise }
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
        }
    };
}

#[cfg(any(feature = "std", feature = "libm", test))]
primitive!(
    f64,
    Double,
    // a function without type parameters of its own, so that it is compiled in this crate and nowhere else
    #[cfg(not(bryant_equations))]
    #[inline(never)]
    fn march<'a>(
        run: &mut Run<'a, '_, Self>,
        sink: &mut Receiver<'_, Self>,
        observer: Option<&mut Observer<'_>>,
    ) -> Result<Report, Failure<'a>> {
        run.go(sink, observer)
    }
);
#[cfg(any(feature = "std", feature = "libm", test))]
primitive!(f32, Single);
