//! A value and its derivative with respect to one variable: f + f′ε with ε² = 0.
//!
//! Equations evaluated over dual numbers yield derivatives exact to rounding, one column of a Jacobian at a time. The
//! values have the bits of the scalar below. The scalar below may be a dual number itself, which gives second
//! derivatives.
//!
//! Where a function has no derivative, the slope is chosen as follows. "Stands still" means that the slope of the
//! argument is 0.
//!
//! | where | slope |
//! |---|---|
//! | [`abs`](Real::abs) at 0 | that to the right, as for a curve at its points |
//! | [`max`](Real::max), [`min`](Real::min) of equals, [`select`](Real::select) | that of the argument taken |
//! | [`sqrt`](Real::sqrt) at 0, [`powf`](Real::powf) of 0 with an exponent below 1 | infinite, but 0 where the argument stands still |
//! | [`atan2`](Real::atan2) at the origin | NaN, but 0 where the point stands still |
//!
//! A standing argument is treated in the argument (0/1 in place of 0/0), not in the result, so the rule holds for
//! second derivatives, too. Laws that pass such places at speed guard their argument themselves.

use super::{Form, Real, Task};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A value and its derivative with respect to one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Dual<T> {
    /// f
    pub value: T,
    /// f′
    pub slope: T,
}

/// Number of words of a lane of a scalar; 0 where it has no form.
const fn words_of<T: Real>() -> usize {
    match T::FORM {
        Some(form) => form.words(),
        None => 0,
    }
}

impl<T: Real> Dual<T> {
    /// A number that does not depend on the variable.
    #[inline(always)]
    pub fn constant(value: T) -> Self {
        Dual {
            value,
            slope: T::from_f64(0.0),
        }
    }

    /// The variable itself.
    #[inline(always)]
    pub fn variable(value: T) -> Self {
        Dual {
            value,
            slope: T::from_f64(1.0),
        }
    }
}

impl<T: Real> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Dual {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl<T: Real> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Dual {
            value: self.value - other.value,
            slope: self.slope - other.slope,
        }
    }
}

impl<T: Real> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Dual {
            value: self.value * other.value,
            slope: self.slope.mul_add(other.value, self.value * other.slope),
        }
    }
}

impl<T: Real> Div for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Dual {
            value,
            slope: (-value).mul_add(other.slope, self.slope) / other.value,
        }
    }
}

impl<T: Real> Neg for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dual {
            value: -self.value,
            slope: -self.slope,
        }
    }
}

impl<T: Real> AddAssign for Dual<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// Returns `argument`, which must not be negative, or 1 where both `argument` and `motion` are 0.
#[inline(always)]
fn guarded<T: Real>(argument: T, motion: T) -> T {
    let zero = T::from_f64(0.0);
    let at_zero = T::select(zero.lt(motion.abs()), argument, T::from_f64(1.0));
    T::select(zero.lt(argument), argument, at_zero)
}

impl<T: Real> Real for Dual<T> {
    type Mask = T::Mask;
    type Value = T;
    const SLOPES: bool = true;
    const FORM: Option<Form> = match T::FORM {
        Some(form) => Some(form.dual()),
        None => None,
    };

    #[inline(always)]
    fn value(self) -> T {
        self.value
    }

    #[inline(always)]
    fn of_value(value: T) -> Self {
        Self::constant(value)
    }

    #[inline(always)]
    fn put(self, stride: usize, words: &mut [f64]) {
        self.value.put(stride, words);
        self.slope.put(stride, &mut words[words_of::<T>()..]);
    }

    #[inline(always)]
    fn of_words(stride: usize, words: &[f64]) -> Self {
        Dual {
            value: T::of_words(stride, words),
            slope: T::of_words(stride, &words[words_of::<T>()..]),
        }
    }

    #[inline(always)]
    fn dispatch<W: Task>(task: W) -> W::Output {
        T::dispatch(task)
    }

    #[inline(always)]
    fn frozen(self) -> Self {
        Dual::constant(self.value)
    }

    #[inline(always)]
    fn moving_as(self, other: Self) -> Self {
        Dual {
            value: self.value.moving_as(other.value),
            slope: other.slope,
        }
    }

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::constant(T::from_f64(value))
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }

    #[inline(always)]
    fn mul_add(self, a: Self, b: Self) -> Self {
        Dual {
            value: self.value.mul_add(a.value, b.value),
            slope: self
                .slope
                .mul_add(a.value, self.value.mul_add(a.slope, b.slope)),
        }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Dual {
            value: root,
            slope: self.slope / guarded(root + root, self.slope),
        }
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = self.value.sin_cos();
        let of_sine = Dual {
            value: sine,
            slope: cosine * self.slope,
        };
        let of_cosine = Dual {
            value: cosine,
            slope: -(sine * self.slope),
        };
        (of_sine, of_cosine)
    }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        let squared = x.value.mul_add(x.value, self.value * self.value);
        let across = x.value.mul_add(self.slope, -(self.value * x.slope));
        let motion = self.slope.abs() + x.slope.abs();
        Dual {
            value: self.value.atan2(x.value),
            slope: across / guarded(squared, motion),
        }
    }

    #[inline(always)]
    fn exp(self) -> Self {
        let value = self.value.exp();
        Dual {
            value,
            slope: value * self.slope,
        }
    }

    #[inline(always)]
    fn ln(self) -> Self {
        Dual {
            value: self.value.ln(),
            slope: self.slope / self.value,
        }
    }

    #[inline(always)]
    fn powf(self, power: Self) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let value = self.value.powf(power.value);
        let motion = power.value * self.slope;
        let below = guarded(self.value, motion).powf(power.value - one);
        // xᵖ ln x → 0 as x → 0 for p > 0
        let logarithm = T::select(zero.lt(self.value), self.value, one).ln();
        Dual {
            value,
            slope: motion.mul_add(below, value * logarithm * power.slope),
        }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        let falls = self.value.lt(T::from_f64(0.0));
        Dual {
            value: self.value.abs(),
            slope: T::select(falls, -self.slope, self.slope),
        }
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        self.value.lt(other.value)
    }

    #[inline(always)]
    fn select(mask: Self::Mask, then: Self, otherwise: Self) -> Self {
        Dual {
            value: T::select(mask, then.value, otherwise.value),
            slope: T::select(mask, then.slope, otherwise.slope),
        }
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }
}
