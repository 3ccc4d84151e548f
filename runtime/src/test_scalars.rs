//! Scalars that only the tests need, to show that the trait carries more than `f64`: two lanes, and a dual number.

use crate::real::{Mask, Real};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Two scenarios side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair(pub [f64; 2]);

/// Truth of each lane of a [`Pair`].
#[derive(Clone, Copy, Debug)]
pub struct PairMask([bool; 2]);

/// A value and its derivative with respect to one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// f
    pub value: f64,
    /// f′
    pub slope: f64,
}

impl Mask for PairMask {
    fn any(self) -> bool {
        self.0[0] || self.0[1]
    }
    fn all(self) -> bool {
        self.0[0] && self.0[1]
    }
}

/// An operator of both test scalars: lane by lane, and by the rule of differentiation given.
macro_rules! operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident| $slope:expr) => {
        impl $trait for Pair {
            type Output = Pair;
            fn $method(self, other: Pair) -> Pair {
                Pair([self.0[0].$method(other.0[0]), self.0[1].$method(other.0[1])])
            }
        }
        impl $trait for Dual {
            type Output = Dual;
            fn $method(self, other: Dual) -> Dual {
                let ($a, $b) = (self, other);
                Dual {
                    value: self.value.$method(other.value),
                    slope: $slope,
                }
            }
        }
    };
}

operator!(Add, add, |a, b| a.slope + b.slope);
operator!(Sub, sub, |a, b| a.slope - b.slope);
operator!(Mul, mul, |a, b| a.slope * b.value + a.value * b.slope);
operator!(Div, div, |a, b| (a.slope - a.value / b.value * b.slope)
    / b.value);

impl Neg for Pair {
    type Output = Pair;
    fn neg(self) -> Pair {
        Pair([-self.0[0], -self.0[1]])
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual {
            value: -self.value,
            slope: -self.slope,
        }
    }
}

impl AddAssign for Pair {
    fn add_assign(&mut self, other: Pair) {
        *self = *self + other;
    }
}

impl AddAssign for Dual {
    fn add_assign(&mut self, other: Dual) {
        *self = *self + other;
    }
}

impl Real for Pair {
    type Mask = PairMask;

    fn from_f64(value: f64) -> Self {
        Pair([value; 2])
    }
    fn to_f64(self) -> f64 {
        self.0[0].max(self.0[1])
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn sqrt(self) -> Self {
        Pair(self.0.map(Real::sqrt))
    }
    fn sin_cos(self) -> (Self, Self) {
        let both = self.0.map(Real::sin_cos);
        (Pair(both.map(|b| b.0)), Pair(both.map(|b| b.1)))
    }
    fn atan2(self, x: Self) -> Self {
        Pair([self.0[0].atan2(x.0[0]), self.0[1].atan2(x.0[1])])
    }
    fn powf(self, power: Self) -> Self {
        Pair([self.0[0].powf(power.0[0]), self.0[1].powf(power.0[1])])
    }
    fn abs(self) -> Self {
        Pair(self.0.map(f64::abs))
    }
    fn lt(self, other: Self) -> PairMask {
        PairMask([self.0[0] < other.0[0], self.0[1] < other.0[1]])
    }
    fn select(mask: PairMask, then: Self, otherwise: Self) -> Self {
        let lane = |i: usize| if mask.0[i] { then.0[i] } else { otherwise.0[i] };
        Pair([lane(0), lane(1)])
    }
    fn is_finite(self) -> bool {
        self.0[0].is_finite() && self.0[1].is_finite()
    }
}

impl Real for Dual {
    type Mask = bool;

    fn from_f64(value: f64) -> Self {
        Dual { value, slope: 0.0 }
    }
    fn to_f64(self) -> f64 {
        self.value
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Dual {
            value: root,
            slope: 0.5 * self.slope / root,
        }
    }
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.value.sin_cos();
        (
            Dual {
                value: s,
                slope: c * self.slope,
            },
            Dual {
                value: c,
                slope: -s * self.slope,
            },
        )
    }
    fn atan2(self, x: Self) -> Self {
        let r2 = self.value * self.value + x.value * x.value;
        let slope = (x.value * self.slope - self.value * x.slope) / r2;
        Dual {
            value: self.value.atan2(x.value),
            slope,
        }
    }
    fn powf(self, power: Self) -> Self {
        let value = self.value.powf(power.value);
        let of_power = match power.slope == 0.0 {
            true => 0.0,
            false => value * self.value.ln() * power.slope,
        };
        Dual {
            value,
            slope: power.value * self.value.powf(power.value - 1.0) * self.slope + of_power,
        }
    }
    fn abs(self) -> Self {
        Dual {
            value: self.value.abs(),
            slope: self.slope * self.value.signum(),
        }
    }
    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }
    fn select(mask: bool, then: Self, otherwise: Self) -> Self {
        if mask { then } else { otherwise }
    }
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.slope.is_finite()
    }
}
