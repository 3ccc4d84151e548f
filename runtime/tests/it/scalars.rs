//! A scalar of two lanes for the tests only. It shows that the trait carries several scenarios at once.

use bryant_runtime::real::{Mask, Real};
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// Two scenarios side by side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair(pub [f64; 2]);

/// Truth of each lane of a [`Pair`].
#[derive(Clone, Copy, Debug)]
pub struct PairMask([bool; 2]);

impl Mask for PairMask {
    fn any(self) -> bool {
        self.0[0] || self.0[1]
    }
    fn all(self) -> bool {
        self.0[0] && self.0[1]
    }
    fn and(self, other: Self) -> Self {
        PairMask([self.0[0] && other.0[0], self.0[1] && other.0[1]])
    }
    fn or(self, other: Self) -> Self {
        PairMask([self.0[0] || other.0[0], self.0[1] || other.0[1]])
    }
    fn not(self) -> Self {
        PairMask(self.0.map(|lane| !lane))
    }
    fn lanes(self) -> u32 {
        u32::from(self.0[0]) | u32::from(self.0[1]) << 1
    }
    fn of_lanes(lanes: u32) -> Self {
        PairMask([lanes & 1 != 0, lanes & 2 != 0])
    }
}

/// An operator, lane by lane.
macro_rules! operator {
    ($trait:ident, $method:ident) => {
        impl $trait for Pair {
            type Output = Pair;
            fn $method(self, other: Pair) -> Pair {
                Pair([self.0[0].$method(other.0[0]), self.0[1].$method(other.0[1])])
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl Neg for Pair {
    type Output = Pair;
    fn neg(self) -> Pair {
        Pair([-self.0[0], -self.0[1]])
    }
}

impl AddAssign for Pair {
    fn add_assign(&mut self, other: Pair) {
        *self = *self + other;
    }
}

impl Real for Pair {
    type Mask = PairMask;
    type Value = Self;

    fn value(self) -> Self {
        self
    }
    fn of_value(value: Self) -> Self {
        value
    }

    fn from_f64(value: f64) -> Self {
        Pair([value; 2])
    }
    fn to_f64(self) -> f64 {
        self.0[0].max(self.0[1])
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        Pair([0, 1].map(|i| Real::mul_add(self.0[i], a.0[i], b.0[i])))
    }
    fn sqrt(self) -> Self {
        Pair(self.0.map(Real::sqrt))
    }
    fn sin_cos(self) -> (Self, Self) {
        let both = self.0.map(Real::sin_cos);
        (Pair(both.map(|b| b.0)), Pair(both.map(|b| b.1)))
    }
    fn atan2(self, x: Self) -> Self {
        Pair([0, 1].map(|i| Real::atan2(self.0[i], x.0[i])))
    }
    fn powf(self, power: Self) -> Self {
        Pair([0, 1].map(|i| Real::powf(self.0[i], power.0[i])))
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
