//! Formulas as Rust: operators, precedence, signs.
//!
//! What is printed evaluates to the very bits that the graph means: operands change sides only where the operation
//! commutes exactly, and brackets are left out only where Rust associates the same way.

use super::inputs::{Input, Inputs};
use super::library::Library;
use super::program::{Program, Statement};
use super::syntax;
use crate::expression::{Function, Node, NodeId};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use std::cell::Cell;
use syn::{BinOp, Expr};

/// How tightly a printed expression holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Sign,
    /// A word, a call, anything a method can be called on.
    Word,
}

/// A printed expression.
struct Text {
    expr: Expr,
    level: Level,
}

impl Text {
    fn word(expr: Expr) -> Self {
        Self {
            expr,
            level: Level::Word,
        }
    }

    /// Both operands in brackets where they need them.
    fn binary(a: Text, op: BinOp, b: Text) -> Self {
        let (level, right) = match op {
            BinOp::Add(_) | BinOp::Sub(_) => (Level::Sum, Level::Product),
            // Not after a sign, though Rust would take it.
            _ => (Level::Product, Level::Word),
        };
        Self {
            expr: syntax::binary(a.at(level), op, b.at(right)),
            level,
        }
    }

    /// In brackets, unless it holds together as tightly as this.
    fn at(self, level: Level) -> Expr {
        if self.level >= level {
            self.expr
        } else {
            syntax::brackets(self.expr)
        }
    }
}

fn plus() -> BinOp {
    BinOp::Add(Default::default())
}

fn minus() -> BinOp {
    BinOp::Sub(Default::default())
}

fn times() -> BinOp {
    BinOp::Mul(Default::default())
}

fn over() -> BinOp {
    BinOp::Div(Default::default())
}

/// What named values, inputs and numbers are called where that is not by their own names.
pub(super) trait Words {
    fn value(&self, id: NodeId) -> Expr;
    fn number(&self, value: f64) -> Expr;
    /// The place among the results that something is put into a sink at.
    fn place(&self, place: usize) -> Expr;
}

/// Prints the expressions of one program.
pub(super) struct Printer<'a> {
    program: &'a Program,
    inputs: &'a Inputs,
    library: &'a Library,
    /// They are a field of the mechanism otherwise.
    parameters_are_argument: bool,
    numbers: Cell<bool>,
    words: Option<&'a dyn Words>,
}

impl<'a> Printer<'a> {
    pub(super) fn new(
        program: &'a Program,
        inputs: &'a Inputs,
        library: &'a Library,
        parameters_are_argument: bool,
    ) -> Self {
        let numbers = Cell::new(false);
        Self {
            program,
            inputs,
            library,
            parameters_are_argument,
            numbers,
            words: None,
        }
    }

    /// The same in other words.
    pub(super) fn in_words(
        program: &'a Program,
        inputs: &'a Inputs,
        library: &'a Library,
        words: &'a dyn Words,
    ) -> Self {
        Self {
            words: Some(words),
            ..Self::new(program, inputs, library, false)
        }
    }

    /// True where a number was printed, and so `num` is needed.
    pub(super) fn prints_numbers(&self) -> bool {
        self.numbers.get()
    }

    /// A number as a scalar.
    pub(super) fn number(&self, value: f64) -> Expr {
        self.numbers.set(true);
        match self.words {
            Some(words) => words.number(value),
            None => scalar(value),
        }
    }

    /// A value where it is used: its name, or its formula if it has none.
    pub(super) fn value(&self, id: NodeId) -> Expr {
        self.operand(id).expr
    }

    /// The formula of a value, whether it has a name or not.
    pub(super) fn formula(&self, id: NodeId) -> Expr {
        self.print(id).expr
    }

    /// The receiver of a method call.
    pub(super) fn receiver(&self, id: NodeId) -> Expr {
        self.operand(id).at(Level::Word)
    }

    /// What a statement computes: one value, a pair or a list.
    pub(super) fn statement(&self, statement: Statement) -> Expr {
        match statement {
            Statement::Value(id) => self.formula(id),
            Statement::SinCos { argument, .. } => {
                syntax::method(self.receiver(argument), "sin_cos", [])
            }
            Statement::Results(call) => {
                let any = self.program.results(call).iter().flatten().next();
                any.map_or_else(|| syntax::word("results"), |&id| self.whole_call(id))
            }
            Statement::Put(place) => {
                let index = match self.words {
                    Some(words) => words.place(place),
                    None => syntax::literal(Literal::usize_unsuffixed(place)),
                };
                let value = self.value(self.program.roots[place]);
                syntax::method(syntax::word("sink"), "put", [index, value])
            }
        }
    }

    fn operand(&self, id: NodeId) -> Text {
        match (self.program.name(id), self.words) {
            (Some(_), Some(words)) => Text::word(words.value(id)),
            (Some(name), None) => Text::word(syntax::place(name)),
            (None, _) => self.print(id),
        }
    }

    fn print(&self, id: NodeId) -> Text {
        let node = self.program.graph.node(id);
        match node {
            Node::Constant(bits) => Text::word(self.number(f64::from_bits(bits))),
            Node::Symbol(symbol) => Text::word(match self.words {
                Some(words) => words.value(id),
                None => self.symbol(self.inputs.input(symbol)),
            }),
            Node::Neg(a) => self.negative(a),
            Node::Add(a, b) => self.sum(a, b),
            Node::Sub(a, b) => self.difference(a, b),
            Node::Mul(a, b) => self.product(a, b),
            Node::Div(a, b) => Text::binary(self.operand(a), over(), self.operand(b)),
            Node::MulAdd(a, b, c) => self.fused(a, b, c),
            Node::Sqrt(a) => self.method(a, "sqrt", &[]),
            // A sine is bound together with its cosine by one `let`; this is for one that is written by itself.
            Node::Sin(a) => Text::word(self.half_of_pair(a, 0)),
            Node::Cos(a) => Text::word(self.half_of_pair(a, 1)),
            Node::Atan2(a, b) => self.method(a, "atan2", &[b]),
            Node::Max(a, b) => self.symmetric_method(a, b, "max"),
            Node::Min(a, b) => self.symmetric_method(a, b, "min"),
            Node::Call(function, _) => {
                self.call(function, self.program.graph.arguments(id).into_iter())
            }
            // Its members are written by the call that they belong to.
            Node::Arguments(_) => Text::word(syntax::word("arguments")),
        }
    }

    fn half_of_pair(&self, argument: NodeId, half: u32) -> Expr {
        let pair = syntax::method(self.receiver(argument), "sin_cos", []);
        syntax::tuple_field(pair, half)
    }

    /// An input by its own name.
    pub(super) fn symbol(&self, input: Input) -> Expr {
        match input {
            Input::Parameter(i) => {
                let parameters = match self.parameters_are_argument {
                    true => syntax::word("parameters"),
                    false => syntax::field(syntax::word("self"), "parameters"),
                };
                syntax::field(parameters, &self.inputs.parameters[i])
            }
            Input::Derived(i) => syntax::field(syntax::word("self"), &self.inputs.derived[i]),
            // Arguments are taken apart, so that their elements have names.
            Input::Time => syntax::word("t"),
            Input::Coordinate(i) => syntax::element("q", i),
            Input::Velocity(i) => syntax::element("v", i),
            Input::Auxiliary(i) => syntax::element("z", i),
            Input::Memory(i) => syntax::element("m", i),
            Input::Acceleration(i) => syntax::element("a", i),
            Input::Guard(i) => syntax::element("g", i),
        }
    }

    fn is_inline(&self, id: NodeId) -> bool {
        self.program.name(id).is_none()
    }

    fn constant(&self, id: NodeId) -> Option<f64> {
        match self.program.graph.node(id) {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The operand of a change of sign that is written here.
    fn negated(&self, id: NodeId) -> Option<NodeId> {
        match self.program.graph.node(id) {
            Node::Neg(a) if self.is_inline(id) => Some(a),
            _ => None,
        }
    }

    fn negative(&self, a: NodeId) -> Text {
        if self.is_inline(a) {
            match self.program.graph.node(a) {
                Node::Sub(x, y) => return self.difference(y, x),
                Node::Mul(x, y) => {
                    // The sign goes to the number, if there is one.
                    for (x, y) in [(x, y), (y, x)] {
                        if let Some(c) = self.constant(x) {
                            return Text::binary(
                                Text::word(self.number(-c)),
                                times(),
                                self.operand(y),
                            );
                        }
                    }
                }
                Node::Div(x, y) => {
                    if let Some(c) = self.constant(x) {
                        return Text::binary(Text::word(self.number(-c)), over(), self.operand(y));
                    }
                }
                _ => {}
            }
        }
        Text {
            expr: syntax::negative(self.operand(a).at(Level::Word)),
            level: Level::Sign,
        }
    }

    fn sum(&self, a: NodeId, b: NodeId) -> Text {
        if let Some(x) = self.negated(b) {
            return self.difference(a, x);
        }
        if let Some(x) = self.negated(a) {
            return self.difference(b, x);
        }
        // a + (−c) = a − c exactly.
        for (a, b) in [(a, b), (b, a)] {
            if let Some(c) = self.constant(b).filter(|&c| c < 0.0) {
                return Text::binary(self.operand(a), minus(), Text::word(self.number(-c)));
            }
        }
        // a + b = b + a exactly: a number stands last, a sum first.
        let (mut first, mut second) = (self.operand(a), self.operand(b));
        let number_first = self.constant(a).is_some() && self.constant(b).is_none();
        if number_first || (second.level == Level::Sum && first.level > Level::Sum) {
            std::mem::swap(&mut first, &mut second);
        }
        Text::binary(first, plus(), second)
    }

    fn difference(&self, a: NodeId, b: NodeId) -> Text {
        if let Some(x) = self.negated(b) {
            return self.sum(a, x);
        }
        if let Some(c) = self.constant(b).filter(|&c| c < 0.0) {
            return Text::binary(self.operand(a), plus(), Text::word(self.number(-c)));
        }
        Text::binary(self.operand(a), minus(), self.operand(b))
    }

    fn product(&self, a: NodeId, b: NodeId) -> Text {
        // a · b = b · a exactly: a number stands first, then a product.
        let (mut first, mut second) = (self.operand(a), self.operand(b));
        let number_last = self.constant(b).is_some() && self.constant(a).is_none();
        let loose = |text: &Text| text.level == Level::Product;
        let sign = second.level == Level::Sign && first.level > Level::Sign;
        if number_last || sign || (loose(&second) && !loose(&first) && self.constant(a).is_none()) {
            std::mem::swap(&mut first, &mut second);
        }
        Text::binary(first, times(), second)
    }

    fn fused(&self, a: NodeId, b: NodeId, c: NodeId) -> Text {
        let rank = |id: NodeId, text: &Text| (text.level, self.constant(id).is_none());
        let (mut receiver, mut factor) = (self.operand(a), self.operand(b));
        if rank(b, &factor) > rank(a, &receiver) {
            std::mem::swap(&mut receiver, &mut factor);
        }
        let arguments = [factor.expr, self.operand(c).expr];
        Text::word(syntax::method(
            receiver.at(Level::Word),
            "mul_add",
            arguments,
        ))
    }

    fn method(&self, receiver: NodeId, name: &str, arguments: &[NodeId]) -> Text {
        let arguments = arguments.iter().map(|&id| self.value(id));
        Text::word(syntax::method(self.receiver(receiver), name, arguments))
    }

    fn symmetric_method(&self, a: NodeId, b: NodeId, name: &str) -> Text {
        // x.max(0) reads better than 0.max(x).
        match self.constant(a) {
            Some(_) => self.method(b, name, &[a]),
            None => self.method(a, name, &[b]),
        }
    }

    /// A call with several results, by any of them.
    pub(super) fn whole_call(&self, id: NodeId) -> Expr {
        self.print(id).expr
    }

    fn call(&self, function: Function, arguments: impl Iterator<Item = NodeId>) -> Text {
        let arguments = arguments.map(|id| self.value(id));
        Text::word(match self.library.callee(function) {
            Callee::Method { of, name } => syntax::method(syntax::word(of), name, arguments),
            Callee::Function(path) => syntax::call(syntax::word(path), arguments),
            Callee::Adapter(path) => syntax::call(syntax::word(path), [syntax::array(arguments)]),
        })
    }
}

/// What is called.
pub(super) enum Callee<'a> {
    /// A method of a constant.
    Method { of: &'a str, name: &'static str },
    /// A function by its path.
    Function(&'static str),
    /// The same, of one array.
    Adapter(&'a str),
}

/// A number as a scalar, by the function `num`.
pub(super) fn scalar(value: f64) -> Expr {
    let literal = match digits(value) {
        Some(digits) => syntax::literal(digits),
        None => syntax::word(unusual(value)),
    };
    let value = if value < 0.0 && value.is_finite() {
        syntax::negative(literal)
    } else {
        literal
    };
    syntax::call(syntax::word("num"), [value])
}

/// A name as a token.
pub(super) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// A number with the fewest digits that read back as the same number.
pub(super) fn number(value: f64) -> TokenStream {
    match digits(value) {
        Some(digits) if value < 0.0 => quote!(-#digits),
        Some(digits) => quote!(#digits),
        None => {
            let name = syntax::path(unusual(value));
            quote!(#name)
        }
    }
}

/// The size of a finite number.
fn digits(value: f64) -> Option<Literal> {
    // `Literal::f64_unsuffixed` writes 1e300 with all its zeros; `{:?}` does not.
    let text = format!("{:?}", value.abs());
    value.is_finite().then(|| {
        text.parse()
            .unwrap_or_else(|_| Literal::f64_unsuffixed(value.abs()))
    })
}

/// The name of a number that is not finite.
fn unusual(value: f64) -> &'static str {
    match value {
        f64::INFINITY => "f64::INFINITY",
        f64::NEG_INFINITY => "f64::NEG_INFINITY",
        _ => "f64::NAN",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_exactly() {
        for value in [
            0.0,
            0.1,
            -9.81,
            1e-7,
            1e21,
            1.0 / 3.0,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324,
        ] {
            let text = number(value).to_string().replace(' ', "");
            assert_eq!(text.parse::<f64>().ok(), Some(value), "{text}");
        }
    }

    #[test]
    fn what_is_no_number_has_a_name() {
        assert_eq!(number(f64::NEG_INFINITY).to_string(), "f64 :: NEG_INFINITY");
        assert_eq!(number(f64::NAN).to_string(), "f64 :: NAN");
    }
}
