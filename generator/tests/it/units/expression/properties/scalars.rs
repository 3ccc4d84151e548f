//! Scalars that know more than their value: a bound of its rounding error, or its derivative.

use super::program::Value;
use bryant_generator::expression::Function;
use bryant_generator::expression::evaluate::{Functions, Scalar};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and a bound of its error, to first order (running error analysis, Higham, *Accuracy and stability of
/// numerical algorithms*, § 3.3).
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    pub value: f64,
    pub error: f64,
}

/// Unit roundoff.
const U: f64 = f64::EPSILON / 2.0;

impl Bounded {
    pub fn exact(value: f64) -> Self {
        Bounded { value, error: 0.0 }
    }

    /// A result that is rounded once, plus the error inherited from the operands.
    fn rounded(value: f64, inherited: f64) -> Self {
        Bounded {
            value,
            error: inherited + U * value.abs() + f64::MIN_POSITIVE,
        }
    }

    /// True if the first order is sufficient and nothing has overflowed.
    pub fn is_trusted(self) -> bool {
        self.value.abs() < 1e100 && self.error < 1e-6 * (1.0 + self.value.abs())
    }
}

impl Add for Bounded {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::rounded(self.value + b.value, self.error + b.error)
    }
}

impl Sub for Bounded {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Neg for Bounded {
    type Output = Self;
    fn neg(self) -> Self {
        Bounded {
            value: -self.value,
            error: self.error,
        }
    }
}

impl Mul for Bounded {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self::rounded(self.value * b.value, self.product_error(b))
    }
}

impl Div for Bounded {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        let inherited = (self.error + value.abs() * b.error) / (b.value.abs() - b.error).max(0.0);
        Self::rounded(value, inherited)
    }
}

impl Bounded {
    fn product_error(self, b: Self) -> f64 {
        self.value.abs() * b.error + b.value.abs() * self.error + self.error * b.error
    }
}

impl Scalar for Bounded {
    fn from_f64(value: f64) -> Self {
        Self::exact(value)
    }
    fn sqrt(self) -> Self {
        let least = (self.value - self.error).max(0.0);
        Self::rounded(self.value.sqrt(), self.error / (2.0 * least.sqrt()))
    }
    // The error of library functions is at most one unit in the last place, which is two unit roundoffs.
    fn sin(self) -> Self {
        let value = self.value.sin();
        Self::rounded(value, self.error + U * value.abs())
    }
    fn cos(self) -> Self {
        let value = self.value.cos();
        Self::rounded(value, self.error + U * value.abs())
    }
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let turn = x.value.abs() * self.error + self.value.abs() * x.error;
        let radius = x.value * x.value + self.value * self.value;
        Self::rounded(value, turn / radius + U * value.abs())
    }
    fn max(self, b: Self) -> Self {
        Bounded {
            value: self.value.max(b.value),
            error: self.error.max(b.error),
        }
    }
    fn min(self, b: Self) -> Self {
        -Scalar::max(-self, -b)
    }
    fn mul_add(self, a: Self, b: Self) -> Self {
        let value = self.value.mul_add(a.value, b.value);
        Self::rounded(value, self.product_error(a) + b.error)
    }
}

impl Value for Bounded {
    fn number(self, value: f64) -> Self {
        Self::exact(value)
    }
    fn sqrt(self) -> Self {
        Scalar::sqrt(self)
    }
    fn sin(self) -> Self {
        Scalar::sin(self)
    }
    fn cos(self) -> Self {
        Scalar::cos(self)
    }
    fn atan2(self, x: Self) -> Self {
        Scalar::atan2(self, x)
    }
    fn max(self, other: Self) -> Self {
        Scalar::max(self, other)
    }
    fn min(self, other: Self) -> Self {
        Scalar::min(self, other)
    }
    fn curve(self) -> Self {
        Curves.call(Function::Curve(0), &[self])
    }
}

/// A value and its derivative.
#[derive(Clone, Copy, Debug)]
pub struct Dual {
    pub value: Bounded,
    pub derivative: Bounded,
}

impl Dual {
    pub fn constant(value: f64) -> Self {
        Dual {
            value: Bounded::exact(value),
            derivative: Bounded::exact(0.0),
        }
    }

    pub fn variable(value: f64) -> Self {
        Dual {
            value: Bounded::exact(value),
            derivative: Bounded::exact(1.0),
        }
    }
}

fn dual(value: Bounded, derivative: Bounded) -> Dual {
    Dual { value, derivative }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        dual(self.value + b.value, self.derivative + b.derivative)
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        dual(self.value - b.value, self.derivative - b.derivative)
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        dual(-self.value, -self.derivative)
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let derivative = self.derivative * b.value + self.value * b.derivative;
        dual(self.value * b.value, derivative)
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let above = self.derivative * b.value - self.value * b.derivative;
        dual(self.value / b.value, above / (b.value * b.value))
    }
}

impl Scalar for Dual {
    fn from_f64(value: f64) -> Self {
        Self::constant(value)
    }
    fn sqrt(self) -> Self {
        let root = Scalar::sqrt(self.value);
        dual(root, self.derivative / (root + root))
    }
    fn sin(self) -> Self {
        let slope = Scalar::cos(self.value);
        dual(Scalar::sin(self.value), slope * self.derivative)
    }
    fn cos(self) -> Self {
        let slope = -Scalar::sin(self.value);
        dual(Scalar::cos(self.value), slope * self.derivative)
    }
    fn atan2(self, x: Self) -> Self {
        let turn = self.derivative * x.value - self.value * x.derivative;
        let radius = self.value * self.value + x.value * x.value;
        dual(Scalar::atan2(self.value, x.value), turn / radius)
    }
    fn max(self, b: Self) -> Self {
        if self.value.value >= b.value.value {
            self
        } else {
            b
        }
    }
    fn min(self, b: Self) -> Self {
        if self.value.value <= b.value.value {
            self
        } else {
            b
        }
    }
}

/// One curve: f(x) = x³ − x, with its slope 3x² − 1 and the slope of that.
pub struct Curves;

impl Functions<Bounded> for Curves {
    fn call(&self, function: Function, arguments: &[Bounded]) -> Bounded {
        let x = arguments[0];
        match function {
            Function::Curve(_) => x * x * x - x,
            Function::CurveSlope(_) => Bounded::exact(3.0) * (x * x) - Bounded::exact(1.0),
            Function::CurveSecondDerivative(_) => Bounded::exact(6.0) * x,
            _ => Bounded::exact(f64::NAN),
        }
    }
}

impl Functions<Dual> for Curves {
    fn call(&self, function: Function, arguments: &[Dual]) -> Dual {
        let x = arguments[0];
        match function {
            Function::Curve(_) => x * x * x - x,
            Function::CurveSlope(_) => Dual::constant(3.0) * x * x - Dual::constant(1.0),
            Function::CurveSecondDerivative(_) => Dual::constant(6.0) * x,
            _ => Dual::constant(f64::NAN),
        }
    }
}
