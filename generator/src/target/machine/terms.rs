//! Steps on numbers together with their slopes.
//!
//! A term is a number and, if code is made for dual numbers, its slope. The slope has as many lanes as the number, with
//! a direction in each lane. The steps follow the runtime for dual numbers (`runtime/src/real/dual.rs`) operation by
//! operation, so slopes have the same bits, including the sign of zeros. The slope of a constant is the constant 0. A
//! product with this 0 stays, because it decides the sign of a zero, and is NaN if the other factor is not finite. But
//! no addition or subtraction that cannot change a bit is emitted.

use super::numbers::Signed;
use super::operation::Binary;
use super::steps::Lowering;

/// A number and, if slopes are computed, its slope.
#[derive(Clone, Copy)]
pub(crate) struct Term {
    pub value: Signed,
    pub slope: Option<Signed>,
}

impl Term {
    /// The term with the opposite sign.
    pub fn negated(self) -> Term {
        Term {
            value: self.value.negated(),
            slope: self.slope.map(Signed::negated),
        }
    }
}

/// The slopes of several terms; `None` if slopes are not computed.
fn slopes<const N: usize>(of: [Term; N]) -> Option<[Signed; N]> {
    let mut slopes = of.map(|term| term.value);
    for (slope, term) in slopes.iter_mut().zip(of) {
        *slope = term.slope?;
    }
    Some(slopes)
}

impl Lowering<'_> {
    /// A constant, whose slope is 0.
    pub fn number(&mut self, number: f64) -> Term {
        let value = self.numbers.number(number);
        let slope = self.slopes.then(|| self.numbers.number(0.0));
        Term { value, slope }
    }

    /// a + b
    pub fn sum(&mut self, a: Term, b: Term) -> Term {
        let slope = slopes([a, b]).map(|[f, g]| self.numbers.sum_of_slopes(f, g));
        let value = self.numbers.sum(a.value, b.value);
        Term { value, slope }
    }

    /// A product: (a b)′ = a′ b + a b′.
    pub fn product(&mut self, a: Term, b: Term) -> Term {
        let value = self.numbers.scaled(Binary::Mul, a.value, b.value);
        let slope = slopes([a, b]).map(|[f, g]| {
            let second = self.numbers.scaled(Binary::Mul, a.value, g);
            self.numbers.mul_add(f, b.value, second)
        });
        Term { value, slope }
    }

    /// A quotient: (a/b)′ = (a′ − (a/b) b′)/b.
    pub fn quotient(&mut self, a: Term, b: Term) -> Term {
        let value = self.numbers.scaled(Binary::Div, a.value, b.value);
        let slope = slopes([a, b]).map(|[f, g]| {
            let above = self.numbers.mul_add(value.negated(), g, f);
            self.numbers.scaled(Binary::Div, above, b.value)
        });
        Term { value, slope }
    }

    /// a b + c, rounded once if the target has fused operations: (a b + c)′ = a′ b + (a b′ + c′).
    pub fn mul_add(&mut self, a: Term, b: Term, c: Term) -> Term {
        let value = self.numbers.mul_add(a.value, b.value, c.value);
        let slope = slopes([a, b, c]).map(|[f, g, h]| {
            let rest = self.numbers.mul_add(a.value, g, h);
            self.numbers.mul_add(f, b.value, rest)
        });
        Term { value, slope }
    }

    /// √a. Its slope is a′/(2√a), and 0 where both a and a′ are 0.
    pub fn root(&mut self, a: Term) -> Term {
        let value = self.numbers.root(a.value);
        let slope = a.slope.map(|motion| {
            let twice = self.numbers.sum(value, value);
            let below = self.away_from_zero(twice, motion);
            self.numbers.scaled(Binary::Div, motion, below)
        });
        Term { value, slope }
    }

    /// The argument, which must not be negative; 1 if both the argument and the motion are 0.
    pub fn away_from_zero(&mut self, argument: Signed, motion: Signed) -> Signed {
        let numbers = &mut self.numbers;
        let (zero, one) = (numbers.number(0.0), numbers.number(1.0));
        let size = numbers.extreme(Binary::Max, motion, motion.negated());
        let at_zero = numbers.select([zero, size], argument, one);
        numbers.select([zero, argument], argument, at_zero)
    }

    /// The larger term, with its slope; `a` if either is NaN.
    pub fn larger(&mut self, a: Term, b: Term) -> Term {
        let value = self.numbers.extreme(Binary::Max, a.value, b.value);
        let slope = slopes([a, b]).map(|[f, g]| self.numbers.slope_where([a.value, b.value], g, f));
        Term { value, slope }
    }

    /// The smaller term, with its slope; `a` if either is NaN.
    pub fn smaller(&mut self, a: Term, b: Term) -> Term {
        let value = self.numbers.extreme(Binary::Min, a.value, b.value);
        let slope = slopes([a, b]).map(|[f, g]| self.numbers.slope_where([b.value, a.value], g, f));
        Term { value, slope }
    }

    /// `then` where a < b, `otherwise` elsewhere.
    pub fn select(&mut self, a: Term, b: Term, then: Term, otherwise: Term) -> Term {
        let compared = [a.value, b.value];
        let value = self.numbers.select(compared, then.value, otherwise.value);
        let slope = slopes([then, otherwise])
            .map(|[then, otherwise]| self.numbers.slope_where(compared, then, otherwise));
        Term { value, slope }
    }
}
