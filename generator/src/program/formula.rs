//! Writes formulas: decides on the operations and on the order of their operands, independently of the form in which
//! they are written.
//!
//! A written formula gives exactly the bits that the graph means: operands are exchanged only if the operation commutes
//! exactly, and signs are moved only if this changes nothing but the sign of a zero. The Rust text and the lists of
//! [`crate::program`] are both written by this module, so they have the same operations.

use super::schedule::Schedule;
use crate::expression::{Function, Node, NodeId, Symbol};

/// The precedence of a written formula: a higher level binds its operands more tightly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    Sum,
    Product,
    Sign,
    /// A name, a call, or any other formula on which a method can be called without brackets.
    Word,
}

/// A binary operator, which is written between its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operator {
    Plus,
    Minus,
    Times,
    Over,
}

/// An operation that is written as a method call on its first operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum MethodOperation {
    Sqrt,
    Atan2,
    Max,
    Min,
    MulAdd,
}

/// A form in which formulas are written.
pub(crate) trait Form {
    /// A written formula.
    type Term;
    /// A number.
    fn number(&self, value: f64) -> Self::Term;
    /// The name of a value that is bound by a statement.
    fn bound(&self, id: NodeId) -> Self::Term;
    /// An input that is not bound.
    fn input(&self, id: NodeId, symbol: Symbol) -> Self::Term;
    /// −a
    fn negative(&self, a: Self::Term) -> Self::Term;
    /// A binary operator with its operands.
    fn binary(&self, a: Self::Term, operator: Operator, b: Self::Term) -> Self::Term;
    /// A method call on the first operand.
    fn method<const N: usize>(
        &self,
        receiver: Self::Term,
        method: MethodOperation,
        others: [Self::Term; N],
    ) -> Self::Term;
    /// One result of the joint sine and cosine of an argument: sine (0) or cosine (1).
    fn half_of_pair(&self, argument: Self::Term, half: u32) -> Self::Term;
    /// A call; if the function has several results, the call with all of them.
    fn call(&self, function: Function, arguments: Vec<Self::Term>) -> Self::Term;
    /// A placeholder for a list of arguments, which is not a value itself.
    fn arguments(&self) -> Self::Term;
    /// The formula in brackets.
    fn brackets(&self, a: Self::Term) -> Self::Term;
}

/// A written formula with its precedence.
struct Text<X> {
    of: X,
    level: Level,
}

impl<X> Text<X> {
    fn word(of: X) -> Self {
        Text {
            of,
            level: Level::Word,
        }
    }
}

/// Writes the formulas of a schedule in a form.
pub(crate) struct Formulas<'a, F> {
    pub schedule: &'a Schedule,
    pub form: &'a F,
}

impl<F: Form> Formulas<'_, F> {
    /// A value at a place where it is used: its name, or its formula if it has no name.
    pub(crate) fn value(&self, id: NodeId) -> F::Term {
        self.operand(id).of
    }

    /// The formula of a value, even if the value has a name.
    pub(crate) fn formula(&self, id: NodeId) -> F::Term {
        self.write(id).of
    }

    /// The value in a form on which a method can be called.
    pub(crate) fn receiver(&self, id: NodeId) -> F::Term {
        self.at(self.operand(id), Level::Word)
    }

    /// The formula, in brackets if its precedence is below `level`.
    fn at(&self, text: Text<F::Term>, level: Level) -> F::Term {
        match text.level >= level {
            true => text.of,
            false => self.form.brackets(text.of),
        }
    }

    /// A binary operation; operands get brackets if they need them.
    fn binary(&self, a: Text<F::Term>, operator: Operator, b: Text<F::Term>) -> Text<F::Term> {
        let (level, right) = match operator {
            Operator::Plus | Operator::Minus => (Level::Sum, Level::Product),
            // No sign on the right of · or /, though Rust would allow it.
            Operator::Times | Operator::Over => (Level::Product, Level::Word),
        };
        let (a, b) = (self.at(a, level), self.at(b, right));
        Text {
            of: self.form.binary(a, operator, b),
            level,
        }
    }

    fn operand(&self, id: NodeId) -> Text<F::Term> {
        match self.schedule.is_bound(id) {
            true => Text::word(self.form.bound(id)),
            false => self.write(id),
        }
    }

    fn write(&self, id: NodeId) -> Text<F::Term> {
        let node = self.schedule.graph.node(id);
        match node {
            Node::Constant(bits) => self.number(f64::from_bits(bits)),
            Node::Symbol(symbol) => Text::word(self.form.input(id, symbol)),
            Node::Neg(a) => self.negative(a),
            Node::Add(a, b) => self.sum(a, b),
            Node::Sub(a, b) => self.difference(a, b),
            Node::Mul(a, b) => self.product(a, b),
            Node::Div(a, b) => self.binary(self.operand(a), Operator::Over, self.operand(b)),
            Node::MulAdd(a, b, c) => self.fused(a, b, c),
            Node::Sqrt(a) => Text::word(self.form.method(
                self.receiver(a),
                MethodOperation::Sqrt,
                [],
            )),
            // Sine and cosine of one argument are usually bound together by one statement; this writes a single one.
            Node::Sin(a) => Text::word(self.form.half_of_pair(self.receiver(a), 0)),
            Node::Cos(a) => Text::word(self.form.half_of_pair(self.receiver(a), 1)),
            Node::Atan2(a, b) => self.method(a, MethodOperation::Atan2, b),
            Node::Max(a, b) => self.symmetric_method(a, MethodOperation::Max, b),
            Node::Min(a, b) => self.symmetric_method(a, MethodOperation::Min, b),
            Node::Call(function, _) => {
                let arguments = self.schedule.graph.arguments(id).into_iter();
                let arguments = arguments.map(|id| self.value(id)).collect();
                Text::word(self.form.call(function, arguments))
            }
            // The call writes the members of its list itself.
            Node::Arguments(_) => Text::word(self.form.arguments()),
        }
    }

    fn number(&self, value: f64) -> Text<F::Term> {
        Text::word(self.form.number(value))
    }

    fn constant(&self, id: NodeId) -> Option<f64> {
        match self.schedule.graph.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The operand of a negation that is written in place, i.e. not bound to a name.
    fn negated(&self, id: NodeId) -> Option<NodeId> {
        match self.schedule.graph.node(id) {
            Node::Neg(a) if !self.schedule.is_bound(id) => Some(a),
            _ => None,
        }
    }

    fn negative(&self, a: NodeId) -> Text<F::Term> {
        if !self.schedule.is_bound(a) {
            match self.schedule.graph.node(a) {
                Node::Sub(x, y) => return self.difference(y, x),
                Node::Mul(x, y) => {
                    // The sign is moved to a constant factor, if there is one.
                    for (x, y) in [(x, y), (y, x)] {
                        if let Some(c) = self.constant(x) {
                            let number = self.number(-c);
                            return self.binary(number, Operator::Times, self.operand(y));
                        }
                    }
                }
                Node::Div(x, y) => {
                    if let Some(c) = self.constant(x) {
                        let number = self.number(-c);
                        return self.binary(number, Operator::Over, self.operand(y));
                    }
                }
                _ => {}
            }
        }
        Text {
            of: self.form.negative(self.receiver(a)),
            level: Level::Sign,
        }
    }

    fn sum(&self, a: NodeId, b: NodeId) -> Text<F::Term> {
        if let Some(x) = self.negated(b) {
            return self.difference(a, x);
        }
        if let Some(x) = self.negated(a) {
            return self.difference(b, x);
        }
        // a + (−c) = a − c exactly, for a constant −c.
        for (a, b) in [(a, b), (b, a)] {
            if let Some(c) = self.constant(b).filter(|&c| c < 0.0) {
                return self.binary(self.operand(a), Operator::Minus, self.number(-c));
            }
        }
        // a + b = b + a exactly: a number is written last, a sum first.
        let (mut first, mut second) = (self.operand(a), self.operand(b));
        let number_first = self.constant(a).is_some() && self.constant(b).is_none();
        if number_first || (second.level == Level::Sum && first.level > Level::Sum) {
            std::mem::swap(&mut first, &mut second);
        }
        self.binary(first, Operator::Plus, second)
    }

    fn difference(&self, a: NodeId, b: NodeId) -> Text<F::Term> {
        if let Some(x) = self.negated(b) {
            return self.sum(a, x);
        }
        if let Some(c) = self.constant(b).filter(|&c| c < 0.0) {
            return self.binary(self.operand(a), Operator::Plus, self.number(-c));
        }
        self.binary(self.operand(a), Operator::Minus, self.operand(b))
    }

    fn product(&self, a: NodeId, b: NodeId) -> Text<F::Term> {
        // a · b = b · a exactly: a number is written first, then a product.
        let (mut first, mut second) = (self.operand(a), self.operand(b));
        let number_last = self.constant(b).is_some() && self.constant(a).is_none();
        let loose = |text: &Text<F::Term>| text.level == Level::Product;
        let sign = second.level == Level::Sign && first.level > Level::Sign;
        if number_last || sign || (loose(&second) && !loose(&first) && self.constant(a).is_none()) {
            std::mem::swap(&mut first, &mut second);
        }
        self.binary(first, Operator::Times, second)
    }

    fn fused(&self, a: NodeId, b: NodeId, c: NodeId) -> Text<F::Term> {
        let rank = |id: NodeId, text: &Text<F::Term>| (text.level, self.constant(id).is_none());
        let (mut receiver, mut factor) = (self.operand(a), self.operand(b));
        if rank(b, &factor) > rank(a, &receiver) {
            std::mem::swap(&mut receiver, &mut factor);
        }
        let others = [factor.of, self.operand(c).of];
        let receiver = self.at(receiver, Level::Word);
        Text::word(self.form.method(receiver, MethodOperation::MulAdd, others))
    }

    fn method(&self, receiver: NodeId, method: MethodOperation, other: NodeId) -> Text<F::Term> {
        let receiver = self.receiver(receiver);
        Text::word(self.form.method(receiver, method, [self.value(other)]))
    }

    fn symmetric_method(&self, a: NodeId, method: MethodOperation, b: NodeId) -> Text<F::Term> {
        // x.max(0) reads better than 0.max(x).
        match self.constant(a) {
            Some(_) => self.method(b, method, a),
            None => self.method(a, method, b),
        }
    }
}
