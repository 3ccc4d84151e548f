//! Which operations a formula is made of, in which order of operands, whatever it is written as.
//!
//! What is written evaluates to the very bits that the graph means: operands change sides only where the operation
//! commutes exactly, and signs move only where that changes nothing but the sign of a zero. The Rust text and the lists of
//! [`crate::program`] are both written from here, so they have the same operations.

use super::schedule::Schedule;
use crate::expression::{Function, Node, NodeId, Symbol};

/// How tightly a written formula holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Level {
    Sum,
    Product,
    Sign,
    /// A word, a call, anything a method can be called on.
    Word,
}

/// An operation of two operands that is written between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Operator {
    Plus,
    Minus,
    Times,
    Over,
}

/// An operation that is written as a method of its first operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Method {
    Sqrt,
    Atan2,
    Max,
    Min,
    MulAdd,
}

/// What formulas are written as.
pub(crate) trait Form {
    /// A written formula.
    type Term;
    /// A number.
    fn number(&self, value: f64) -> Self::Term;
    /// A value that is bound, by its name.
    fn bound(&self, id: NodeId) -> Self::Term;
    /// An input that has no name.
    fn input(&self, id: NodeId, symbol: Symbol) -> Self::Term;
    /// −a
    fn negative(&self, a: Self::Term) -> Self::Term;
    /// Two operands around an operator.
    fn binary(&self, a: Self::Term, operator: Operator, b: Self::Term) -> Self::Term;
    /// A method of the first of its operands.
    fn method<const N: usize>(
        &self,
        receiver: Self::Term,
        method: Method,
        others: [Self::Term; N],
    ) -> Self::Term;
    /// Sine (0) or cosine (1).
    fn half_of_pair(&self, argument: Self::Term, half: u32) -> Self::Term;
    /// A call, with all of its results where it has several.
    fn call(&self, function: Function, arguments: Vec<Self::Term>) -> Self::Term;
    /// What stands for a list of arguments, which is no value by itself.
    fn arguments(&self) -> Self::Term;
    /// The same in brackets.
    fn brackets(&self, a: Self::Term) -> Self::Term;
}

/// A written formula, and how tightly it holds together.
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

/// Writes the formulas of one schedule in one form.
pub(crate) struct Formulas<'a, F> {
    pub schedule: &'a Schedule,
    pub form: &'a F,
}

impl<F: Form> Formulas<'_, F> {
    /// A value where it is used: its name, or its formula if it has none.
    pub(crate) fn value(&self, id: NodeId) -> F::Term {
        self.operand(id).of
    }

    /// The formula of a value, whether it has a name or not.
    pub(crate) fn formula(&self, id: NodeId) -> F::Term {
        self.write(id).of
    }

    /// The receiver of a method call.
    pub(crate) fn receiver(&self, id: NodeId) -> F::Term {
        self.at(self.operand(id), Level::Word)
    }

    /// In brackets, unless it holds together as tightly as this.
    fn at(&self, text: Text<F::Term>, level: Level) -> F::Term {
        match text.level >= level {
            true => text.of,
            false => self.form.brackets(text.of),
        }
    }

    /// Both operands in brackets where they need them.
    fn binary(&self, a: Text<F::Term>, operator: Operator, b: Text<F::Term>) -> Text<F::Term> {
        let (level, right) = match operator {
            Operator::Plus | Operator::Minus => (Level::Sum, Level::Product),
            // Not after a sign, though Rust would take it.
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
            Node::Sqrt(a) => Text::word(self.form.method(self.receiver(a), Method::Sqrt, [])),
            // A sine is bound together with its cosine by one statement; this is for one that is written by itself.
            Node::Sin(a) => Text::word(self.form.half_of_pair(self.receiver(a), 0)),
            Node::Cos(a) => Text::word(self.form.half_of_pair(self.receiver(a), 1)),
            Node::Atan2(a, b) => self.method(a, Method::Atan2, b),
            Node::Max(a, b) => self.symmetric_method(a, Method::Max, b),
            Node::Min(a, b) => self.symmetric_method(a, Method::Min, b),
            Node::Call(function, _) => {
                let arguments = self.schedule.graph.arguments(id).into_iter();
                let arguments = arguments.map(|id| self.value(id)).collect();
                Text::word(self.form.call(function, arguments))
            }
            // Its members are written by the call that they belong to.
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

    /// The operand of a change of sign that is written here.
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
                    // The sign goes to the number, if there is one.
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
        // a + (−c) = a − c exactly.
        for (a, b) in [(a, b), (b, a)] {
            if let Some(c) = self.constant(b).filter(|&c| c < 0.0) {
                return self.binary(self.operand(a), Operator::Minus, self.number(-c));
            }
        }
        // a + b = b + a exactly: a number stands last, a sum first.
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
        // a · b = b · a exactly: a number stands first, then a product.
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
        Text::word(self.form.method(receiver, Method::MulAdd, others))
    }

    fn method(&self, receiver: NodeId, method: Method, other: NodeId) -> Text<F::Term> {
        let receiver = self.receiver(receiver);
        Text::word(self.form.method(receiver, method, [self.value(other)]))
    }

    fn symmetric_method(&self, a: NodeId, method: Method, b: NodeId) -> Text<F::Term> {
        // x.max(0) reads better than 0.max(x).
        match self.constant(a) {
            Some(_) => self.method(b, method, a),
            None => self.method(a, method, b),
        }
    }
}
