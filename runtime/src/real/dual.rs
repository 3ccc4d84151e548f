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

#[cfg(test)]
mod tests {
    use super::Dual;
    use crate::test_scalars::Pair;
    use crate::{DoubleDouble, Mask, Real};

    /// Name of a function, how a scalar computes it, and \[f, f′, f″\].
    type Function<T> = (&'static str, fn(T) -> T, [f64; 3]);

    /// Functions, at x > 0.
    fn functions<T: Real>(x: f64) -> Vec<Function<T>> {
        let (s, k) = x.sin_cos();
        let (e, l, r) = (x.exp(), x.ln(), x.sqrt());
        let q = 1.0 + x * x;
        vec![
            ("x + x x", |x| x + x * x, [x + x * x, 1.0 + 2.0 * x, 2.0]),
            (
                "3 − 1/x",
                |x| T::from_f64(3.0) - T::from_f64(1.0) / x,
                [3.0 - 1.0 / x, 1.0 / (x * x), -2.0 / (x * x * x)],
            ),
            (
                "x/(1 + x²)",
                |x| x / x.mul_add(x, T::from_f64(1.0)),
                [
                    x / q,
                    (1.0 - x * x) / (q * q),
                    2.0 * x * (x * x - 3.0) / (q * q * q),
                ],
            ),
            ("−√x", |x| -x.sqrt(), [-r, -0.5 / r, 0.25 / (x * r)]),
            ("sin", |x| x.sin_cos().0, [s, k, -s]),
            ("cos", |x| x.sin_cos().1, [k, -s, -k]),
            (
                "atan2(x, 1)",
                |x| x.atan2(T::from_f64(1.0)),
                [x.atan(), 1.0 / q, -2.0 * x / (q * q)],
            ),
            (
                "atan2(1, −x)",
                |x| T::from_f64(1.0).atan2(-x),
                [1.0_f64.atan2(-x), 1.0 / q, -2.0 * x / (q * q)],
            ),
            ("exp", |x| x.exp(), [e, e, e]),
            ("ln", |x| x.ln(), [l, 1.0 / x, -1.0 / (x * x)]),
            (
                "x^2.5",
                |x| x.powf(T::from_f64(2.5)),
                [x * x * r, 2.5 * x * r, 3.75 * r],
            ),
            ("2^x", |x| T::from_f64(2.0).powf(x), {
                let (two, l) = (2.0_f64.powf(x), 2.0_f64.ln());
                [two, two * l, two * l * l]
            }),
            ("x^x", |x| x.powf(x), {
                let p = x.powf(x);
                [p, p * (l + 1.0), p * ((l + 1.0) * (l + 1.0) + 1.0 / x)]
            }),
            (
                "|x − 2|³",
                |x| {
                    let d = (x - T::from_f64(2.0)).abs();
                    d * d * d
                },
                {
                    let d = (x - 2.0).abs();
                    [d * d * d, 3.0 * d * (x - 2.0), 6.0 * d]
                },
            ),
        ]
    }

    #[test]
    fn slopes_are_the_derivatives() {
        for i in 1..60 {
            let x = 0.07 * f64::from(i);
            for (name, of, [value, first, second]) in functions::<Dual<f64>>(x) {
                let ours = of(Dual::variable(x));
                // a few operations on numbers of this size
                let bound = 32.0 * f64::EPSILON * (1.0 + value.abs() + first.abs() + second.abs());
                assert!(
                    (ours.value - value).abs() <= bound,
                    "{name} at {x}: {ours:?}"
                );
                assert!(
                    (ours.slope - first).abs() <= bound,
                    "{name} at {x}: {ours:?}, not {first}"
                );
            }
            for (name, of, [value, first, second]) in functions::<Dual<Dual<f64>>>(x) {
                let ours = of(Dual::variable(Dual::variable(x)));
                let bound = 32.0 * f64::EPSILON * (1.0 + value.abs() + first.abs() + second.abs());
                assert!((ours.value.slope - first).abs() <= bound, "{name} at {x}");
                assert_eq!(ours.value.slope, ours.slope.value, "{name} at {x}");
                assert!(
                    (ours.slope.slope - second).abs() <= 4.0 * bound,
                    "{name} at {x}: {ours:?}, not {second}"
                );
            }
        }
    }

    #[test]
    fn values_are_those_of_the_scalar_below() {
        for i in 1..60 {
            let x = 0.07 * f64::from(i);
            for (dual, plain) in functions::<Dual<f64>>(x)
                .into_iter()
                .zip(functions::<f64>(x))
            {
                assert_eq!(
                    dual.1(Dual::variable(x)).value,
                    plain.1(x),
                    "{} at {x}",
                    plain.0
                );
            }
            let lanes = Pair([x, 2.0 * x]);
            for (dual, plain) in functions::<Dual<Pair>>(x)
                .into_iter()
                .zip(functions::<Dual<f64>>(x))
            {
                let both = dual.1(Dual::variable(lanes));
                // Pair has no exponential of its own
                if ["exp", "ln", "2^x", "x^x"].contains(&plain.0) {
                    continue;
                }
                for lane in 0..2 {
                    let alone = plain.1(Dual::variable(lanes.0[lane]));
                    let expected = (alone.value, alone.slope);
                    assert_eq!(
                        (both.value.0[lane], both.slope.0[lane]),
                        expected,
                        "{}",
                        plain.0
                    );
                }
            }
            for (dual, (name, _, [value, first, second])) in functions::<Dual<f32>>(x)
                .into_iter()
                .zip(functions::<f32>(x))
            {
                let ours = dual.1(Dual::variable(x as f32));
                let bound = 64.0
                    * f64::from(f32::EPSILON)
                    * (1.0 + value.abs() + first.abs() + second.abs());
                assert!(
                    (f64::from(ours.slope) - first).abs() <= bound,
                    "{name} at {x}: {ours:?}"
                );
            }
        }
    }

    #[test]
    fn slopes_have_all_digits_of_the_scalar_below() {
        // compared with a central difference in double-double: the error is h² = 10⁻²⁰ and the rounding 10⁻³⁰/h
        let h = DoubleDouble::from_f64(1e-10);
        for i in 1..20 {
            let x = DoubleDouble::from_f64(0.23 * f64::from(i));
            let plain = functions::<DoubleDouble>(x.to_f64());
            let twice = functions::<Dual<DoubleDouble>>(x.to_f64());
            for ((name, of, [value, first, second]), (_, dual, _)) in plain.into_iter().zip(twice) {
                let difference = (of(x + h) - of(x - h)) / (h + h);
                let slope = dual(Dual::variable(x)).slope;
                let off = (slope - difference).to_f64().abs();
                let size = 1.0 + value.abs() + first.abs() + second.abs();
                // third derivatives of these are below 100 times that
                assert!(off <= 1e-20 * 100.0 * size, "{name} at {x:?}: {off:e}");
            }
        }
    }

    #[test]
    fn fused_and_separate_operations_agree() {
        let dual = |value: f64, slope: f64| Dual { value, slope };
        let (a, b, c) = (dual(0.3, 1.7), dual(-2.1, 0.4), dual(5.0, -0.9));
        let (fused, separate) = (a.mul_add(b, c), a * b + c);
        assert!((fused.value - separate.value).abs() <= 8.0 * f64::EPSILON);
        assert!((fused.slope - separate.slope).abs() <= 8.0 * f64::EPSILON);
        let back = a / b * b;
        assert!((back.value - a.value).abs() <= 4.0 * f64::EPSILON);
        assert!((back.slope - a.slope).abs() <= 16.0 * f64::EPSILON);
    }

    #[test]
    fn where_there_is_no_derivative_what_stands_still_has_slope_0() {
        let (still, moving) = (Dual::constant(0.0_f64), Dual::variable(0.0_f64));
        let half = Dual::constant(0.5);
        assert_eq!(still.sqrt(), still);
        assert_eq!(moving.sqrt().slope, f64::INFINITY);
        assert!(!moving.sqrt().is_finite());
        assert_eq!(still.powf(half), still);
        assert_eq!(moving.powf(half).slope, f64::INFINITY);
        assert_eq!(moving.powf(Dual::constant(2.0)), still);
        assert_eq!(moving.powf(Dual::constant(1.0)), moving);
        assert_eq!(moving.powf(Dual::constant(0.0)), Dual::constant(1.0));
        // xᵖ ln x is 0 at 0
        assert_eq!(still.powf(Dual::variable(1.5)), still);
        assert_eq!(still.atan2(still), still);
        assert!(moving.atan2(still).slope.is_nan());
        assert_eq!(moving.atan2(Dual::constant(2.0)).slope, 0.5);
    }

    #[test]
    fn second_derivatives_pass_places_where_the_first_is_0() {
        // √(1 + x²) at 0: its argument stands still, but its second derivative is not 0
        let x = Dual::variable(Dual::variable(0.0_f64));
        let one = Dual::constant(Dual::constant(1.0));
        let root = x.mul_add(x, one).sqrt();
        assert_eq!(
            [root.value.value, root.slope.value, root.slope.slope],
            [1.0, 0.0, 1.0]
        );
        let square = x.powf(Dual::constant(Dual::constant(2.0)));
        assert_eq!([square.slope.value, square.slope.slope], [0.0, 2.0]);
    }

    #[test]
    fn choices_take_value_and_slope_together() {
        let dual = |value: f64, slope: f64| Dual { value, slope };
        let (a, b) = (dual(1.0, 3.0), dual(2.0, -4.0));
        assert_eq!([a.max(b), a.min(b), b.max(a), b.min(a)], [b, a, b, a]);
        // for equal arguments, the one on the left
        let other = dual(1.0, 7.0);
        assert_eq!([a.max(other), a.min(other), other.max(a)], [a, a, other]);
        assert_eq!(
            [dual(-2.0, 1.0).abs(), dual(0.0, 1.0).abs()],
            [dual(2.0, -1.0), dual(0.0, 1.0)]
        );
        assert!(a.lt(b).all() && !a.lt(other) && !other.lt(a));
        let nan = Dual::constant(f64::NAN);
        assert_eq!(Dual::select(true, a, nan), a);
        assert_eq!(a.to_f64(), 1.0);
    }

    #[test]
    fn what_is_no_number_shows() {
        let nan = Dual::variable(f64::NAN);
        let one = Dual::constant(1.0);
        for x in [
            nan.taint(),
            nan.sqrt(),
            nan.abs(),
            nan.max(one),
            nan.powf(one),
            nan.atan2(one),
            one.atan2(nan),
            nan.exp(),
            nan.ln(),
            nan.sin_cos().0,
            nan * one,
            one / nan,
        ] {
            assert!(x.value.is_nan() && !x.is_finite(), "{x:?}");
        }
        let steep = Dual {
            value: 1.0,
            slope: f64::INFINITY,
        };
        assert!(!steep.is_finite() && steep.taint().slope.is_nan());
        assert_eq!(Dual::variable(2.0).taint(), Dual::constant(0.0));
    }
}
