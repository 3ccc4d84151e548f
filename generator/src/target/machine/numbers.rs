//! Steps on numbers and their negatives.
//!
//! A negation disappears if the next operation can absorb it without changing a bit: a sum becomes a difference, a
//! fused operation gets other signs, and a product or quotient passes the sign on. The sign of a sum is not moved,
//! because −(a + b) and (−a) + (−b) differ in the sign of zero.

use super::operation::{Binary, Bitwise, Signs};
use super::steps::{Origin, Step, StepKind, Steps};
use rustc_hash::FxHashMap;

/// A value, or its negative.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Signed {
    value: u32,
    negative: bool,
}

impl Signed {
    /// The value itself.
    pub fn plain(value: u32) -> Self {
        Signed {
            value,
            negative: false,
        }
    }

    /// The value with the opposite sign.
    pub fn negated(self) -> Self {
        Signed {
            negative: !self.negative,
            ..self
        }
    }
}

/// The steps so far, and known facts about their values.
pub(crate) struct Numbers {
    /// True if a · b + c is rounded once.
    fused: bool,
    /// For each value whose negative is already a value of its own, that negative.
    negatives: FxHashMap<u32, u32>,
    /// The value of each constant, by its bits.
    constants: FxHashMap<u64, u32>,
    pub steps: Steps,
}

impl Numbers {
    pub fn new(fused: bool) -> Self {
        Numbers {
            fused,
            negatives: FxHashMap::default(),
            constants: FxHashMap::default(),
            steps: Steps::default(),
        }
    }

    /// (±a) + (±b)
    pub fn sum(&mut self, a: Signed, b: Signed) -> Signed {
        let (kind, first, second) = match (a.negative, b.negative) {
            (false, false) => (Binary::Add, a.value, b.value),
            (false, true) => (Binary::Sub, a.value, b.value),
            (true, false) => (Binary::Sub, b.value, a.value),
            (true, true) => (Binary::Sub, self.negative(a.value), b.value),
        };
        self.step(StepKind::Binary(kind), [first, second, first, first])
    }

    /// (±a) + (±b). A constant −0 is not added, because it changes nothing.
    pub fn sum_of_slopes(&mut self, a: Signed, b: Signed) -> Signed {
        match (self.is_negative_zero(a), self.is_negative_zero(b)) {
            (true, _) => b,
            (_, true) => a,
            _ => self.sum(a, b),
        }
    }

    /// `then` where a < b, `otherwise` elsewhere. No step is added if `then` and `otherwise` are the same.
    pub fn slope_where(&mut self, ab: [Signed; 2], then: Signed, otherwise: Signed) -> Signed {
        match then == otherwise {
            true => then,
            false => self.select(ab, then, otherwise),
        }
    }

    fn is_negative_zero(&self, signed: Signed) -> bool {
        self.constant_of(signed)
            .is_some_and(|number| number == 0.0 && number.is_sign_negative())
    }

    /// The number that a value is, if it is a constant.
    pub fn constant_of(&self, signed: Signed) -> Option<f64> {
        match self.steps.origins[signed.value as usize] {
            Origin::Constant(number) if signed.negative => Some(-number),
            Origin::Constant(number) => Some(number),
            _ => None,
        }
    }

    /// A product or a quotient. A negation of an operand becomes a negation of the result.
    pub fn scaled(&mut self, kind: Binary, a: Signed, b: Signed) -> Signed {
        Signed {
            negative: a.negative != b.negative,
            ..self.step(StepKind::Binary(kind), [a.value, b.value, a.value, a.value])
        }
    }

    /// (±a) · (±b) + (±c), rounded once if the target has fused operations
    pub fn mul_add(&mut self, a: Signed, b: Signed, c: Signed) -> Signed {
        if self.fused {
            return self.fused(a, b, c);
        }
        let product = self.scaled(Binary::Mul, a, b);
        self.sum(product, c)
    }

    /// √(±a)
    pub fn root(&mut self, a: Signed) -> Signed {
        let a = self.with_sign(a);
        self.step(StepKind::Sqrt, [a; 4])
    }

    /// `then` where a < b, `otherwise` elsewhere
    pub fn select(&mut self, [a, b]: [Signed; 2], then: Signed, otherwise: Signed) -> Signed {
        let operands = [a, b, then, otherwise].map(|value| self.with_sign(value));
        self.step(StepKind::Select, operands)
    }

    /// (±a) · (±b) + (±c), rounded once
    fn fused(&mut self, a: Signed, b: Signed, c: Signed) -> Signed {
        let signs = Signs {
            product: a.negative != b.negative,
            addend: c.negative,
        };
        self.step(StepKind::Fused(signs), [a.value, b.value, c.value, a.value])
    }

    /// The larger or the smaller of a and b; a if either is NaN. The instruction returns its second operand if either
    /// is NaN, so the operands are exchanged. The larger of two negatives is the negative of the smaller.
    pub fn extreme(&mut self, kind: Binary, a: Signed, b: Signed) -> Signed {
        let (first, second) = (b, a);
        if first.negative && second.negative {
            let other = match kind {
                Binary::Max => Binary::Min,
                _ => Binary::Max,
            };
            let operands = [first.value, second.value, first.value, first.value];
            return Signed {
                negative: true,
                ..self.step(StepKind::Binary(other), operands)
            };
        }
        let (first, second) = (self.with_sign(first), self.with_sign(second));
        self.step(StepKind::Binary(kind), [first, second, first, first])
    }

    /// a ∘ b, bit by bit
    pub fn bits(&mut self, kind: Bitwise, a: u32, b: u32) -> u32 {
        self.step(StepKind::Bits(kind), [a, b, a, a]).value
    }

    /// A value with the bits of a mask flipped.
    pub fn xor(&mut self, a: Signed, mask: u32) -> Signed {
        let a = self.with_sign(a);
        Signed::plain(self.bits(Bitwise::Xor, a, mask))
    }

    /// |a|
    pub fn size(&mut self, a: Signed) -> Signed {
        let all_but_sign = self.constant(f64::from_bits(!(1 << 63)));
        Signed::plain(self.bits(Bitwise::And, a.value, all_but_sign))
    }

    /// c₀ + c₁z + … by Horner's rule.
    pub fn horner<const N: usize>(&mut self, z: Signed, coefficients: [f64; N]) -> Signed {
        let mut sum = self.number(coefficients[N - 1]);
        for coefficient in coefficients[..N - 1].iter().rev() {
            let coefficient = self.number(*coefficient);
            sum = self.mul_add(sum, z, coefficient);
        }
        sum
    }

    /// The bits of a value, shifted left.
    pub fn shifted_left(&mut self, a: u32, places: u8) -> u32 {
        self.step(StepKind::ShiftLeft(places), [a; 4]).value
    }

    /// Adds a step.
    pub fn step(&mut self, kind: StepKind, operands: [u32; 4]) -> Signed {
        let value = self.value(Origin::Step);
        self.steps.steps.push(Step {
            kind,
            operands,
            defines: value,
        });
        Signed::plain(value)
    }

    /// Adds a value with this origin.
    pub fn value(&mut self, origin: Origin) -> u32 {
        self.steps.origins.push(origin);
        self.steps.origins.len() as u32 - 1
    }

    /// The value that holds a constant.
    pub fn constant(&mut self, number: f64) -> u32 {
        if let Some(value) = self.constants.get(&number.to_bits()) {
            return *value;
        }
        let value = self.value(Origin::Constant(number));
        self.constants.insert(number.to_bits(), value);
        value
    }

    /// A constant as a [`Signed`] value.
    pub fn number(&mut self, number: f64) -> Signed {
        Signed::plain(self.constant(number))
    }

    /// The value that a [`Signed`] stands for; a negation adds a step.
    pub fn with_sign(&mut self, signed: Signed) -> u32 {
        match signed.negative {
            true => self.negative(signed.value),
            false => signed.value,
        }
    }

    /// −value
    fn negative(&mut self, value: u32) -> u32 {
        if let Origin::Constant(number) = self.steps.origins[value as usize] {
            return self.constant(-number);
        }
        if let Some(negative) = self.negatives.get(&value) {
            return *negative;
        }
        let mask = self.constant(-0.0);
        let negative = self.bits(Bitwise::Xor, value, mask);
        self.negatives.insert(value, negative);
        negative
    }
}
