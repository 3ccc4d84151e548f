//! Formulas as Rust: operators, precedence, signs.
//!
//! What is printed evaluates to the very bits that the graph means: operands change sides only where the operation
//! commutes exactly, and brackets are left out only where Rust associates the same way.

use super::inputs::{Input, Inputs};
use super::library::Library;
use super::program::Program;
use crate::expression::{Function, Node, NodeId};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use std::cell::Cell;

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
    tokens: TokenStream,
    level: Level,
}

impl Text {
    fn new(tokens: TokenStream, level: Level) -> Self {
        Self { tokens, level }
    }

    /// In brackets, unless it holds together as tightly as this.
    fn at(self, level: Level) -> TokenStream {
        let tokens = self.tokens;
        if self.level >= level {
            tokens
        } else {
            quote!((#tokens))
        }
    }
}

/// Prints the expressions of one program.
pub(super) struct Printer<'a> {
    program: &'a Program,
    inputs: &'a Inputs,
    library: &'a Library,
    /// Where the parameters are: `parameters` or `self.parameters`.
    parameters: TokenStream,
    numbers: Cell<bool>,
}

impl<'a> Printer<'a> {
    pub(super) fn new(
        program: &'a Program,
        inputs: &'a Inputs,
        library: &'a Library,
        parameters: TokenStream,
    ) -> Self {
        Self {
            program,
            inputs,
            library,
            parameters,
            numbers: Cell::new(false),
        }
    }

    /// True where a number was printed, and so `num` is needed.
    pub(super) fn prints_numbers(&self) -> bool {
        self.numbers.get()
    }

    /// A number as a scalar.
    pub(super) fn number(&self, value: f64) -> TokenStream {
        self.numbers.set(true);
        let value = number(value);
        quote!(num(#value))
    }

    /// A value where it is used: its name, or its formula if it has none.
    pub(super) fn value(&self, id: NodeId) -> TokenStream {
        self.operand(id).tokens
    }

    /// The formula of a value, whether it has a name or not.
    pub(super) fn formula(&self, id: NodeId) -> TokenStream {
        self.print(id).tokens
    }

    /// The receiver of a method call.
    pub(super) fn receiver(&self, id: NodeId) -> TokenStream {
        self.operand(id).at(Level::Word)
    }

    fn operand(&self, id: NodeId) -> Text {
        match self.program.name(id) {
            Some(name) => {
                let name = ident(name);
                Text::new(quote!(#name), Level::Word)
            }
            None => self.print(id),
        }
    }

    fn print(&self, id: NodeId) -> Text {
        let node = self.program.graph.node(id);
        match node {
            Node::Constant(bits) => Text::new(self.number(f64::from_bits(bits)), Level::Word),
            Node::Symbol(symbol) => self.symbol(self.inputs.input(symbol)),
            Node::Neg(a) => self.negative(a),
            Node::Add(a, b) => self.sum(a, b),
            Node::Sub(a, b) => self.difference(a, b),
            Node::Mul(a, b) => self.product(a, b),
            Node::Div(a, b) => {
                let (a, b) = (
                    self.operand(a).at(Level::Product),
                    self.operand(b).at(Level::Sign),
                );
                Text::new(quote!(#a / #b), Level::Product)
            }
            Node::MulAdd(a, b, c) => self.fused(a, b, c),
            Node::Sqrt(a) => self.method(a, "sqrt", &[]),
            // Both come from one call; whichever has no name of its own is printed alone.
            Node::Sin(a) => {
                let a = self.receiver(a);
                Text::new(quote!(#a.sin_cos().0), Level::Word)
            }
            Node::Cos(a) => {
                let a = self.receiver(a);
                Text::new(quote!(#a.sin_cos().1), Level::Word)
            }
            Node::Atan2(a, b) => self.method(a, "atan2", &[b]),
            Node::Max(a, b) => self.symmetric_method(a, b, "max"),
            Node::Min(a, b) => self.symmetric_method(a, b, "min"),
            Node::Call(function, _) => self.call(function, node.operands()),
        }
    }

    fn symbol(&self, input: Input) -> Text {
        let tokens = match input {
            Input::Parameter(i) => {
                let (parameters, field) = (&self.parameters, ident(&self.inputs.parameters[i]));
                quote!(#parameters.#field)
            }
            Input::Derived(i) => {
                let field = ident(&self.inputs.derived[i]);
                quote!(self.#field)
            }
            Input::Time => quote!(t),
            Input::Coordinate(i) => element("q", i),
            Input::Velocity(i) => element("v", i),
            Input::Acceleration(i) => element("a", i),
        };
        Text::new(tokens, Level::Word)
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
                            let (c, y) = (self.number(-c), self.operand(y).at(Level::Sign));
                            return Text::new(quote!(#c * #y), Level::Product);
                        }
                    }
                }
                Node::Div(x, y) => {
                    if let Some(c) = self.constant(x) {
                        let (c, y) = (self.number(-c), self.operand(y).at(Level::Sign));
                        return Text::new(quote!(#c / #y), Level::Product);
                    }
                }
                _ => {}
            }
        }
        let a = self.operand(a).at(Level::Word);
        Text::new(quote!(-#a), Level::Sign)
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
                let (a, c) = (self.operand(a).at(Level::Sum), self.number(-c));
                return Text::new(quote!(#a - #c), Level::Sum);
            }
        }
        // a + b = b + a exactly: a number stands last, a sum first.
        let (mut first, mut second) = (self.operand(a), self.operand(b));
        let number_first = self.constant(a).is_some() && self.constant(b).is_none();
        if number_first || (second.level == Level::Sum && first.level > Level::Sum) {
            std::mem::swap(&mut first, &mut second);
        }
        let (a, b) = (first.at(Level::Sum), second.at(Level::Product));
        Text::new(quote!(#a + #b), Level::Sum)
    }

    fn difference(&self, a: NodeId, b: NodeId) -> Text {
        if let Some(x) = self.negated(b) {
            return self.sum(a, x);
        }
        if let Some(c) = self.constant(b).filter(|&c| c < 0.0) {
            let (a, c) = (self.operand(a).at(Level::Sum), self.number(-c));
            return Text::new(quote!(#a + #c), Level::Sum);
        }
        let (a, b) = (
            self.operand(a).at(Level::Sum),
            self.operand(b).at(Level::Product),
        );
        Text::new(quote!(#a - #b), Level::Sum)
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
        let (a, b) = (first.at(Level::Product), second.at(Level::Word));
        Text::new(quote!(#a * #b), Level::Product)
    }

    fn fused(&self, a: NodeId, b: NodeId, c: NodeId) -> Text {
        let rank = |id: NodeId, text: &Text| (text.level, self.constant(id).is_none());
        let (mut receiver, mut factor) = (self.operand(a), self.operand(b));
        if rank(b, &factor) > rank(a, &receiver) {
            std::mem::swap(&mut receiver, &mut factor);
        }
        let (a, b, c) = (
            receiver.at(Level::Word),
            factor.tokens,
            self.operand(c).tokens,
        );
        Text::new(quote!(#a.mul_add(#b, #c)), Level::Word)
    }

    fn method(&self, receiver: NodeId, name: &str, arguments: &[NodeId]) -> Text {
        let (receiver, name) = (self.operand(receiver).at(Level::Word), ident(name));
        let arguments = arguments.iter().map(|&id| self.value(id));
        Text::new(quote!(#receiver.#name(#(#arguments),*)), Level::Word)
    }

    fn symmetric_method(&self, a: NodeId, b: NodeId, name: &str) -> Text {
        // x.max(0) reads better than 0.max(x).
        match self.constant(a) {
            Some(_) => self.method(b, name, &[a]),
            None => self.method(a, name, &[b]),
        }
    }

    fn call(&self, function: Function, arguments: impl Iterator<Item = NodeId>) -> Text {
        let arguments = arguments.map(|id| self.value(id));
        let path = self.library.path(function);
        Text::new(quote!(#path(#(#arguments),*)), Level::Word)
    }
}

/// A name as a token.
pub(super) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// A number with the fewest digits that read back as the same number.
pub(super) fn number(value: f64) -> TokenStream {
    if value.is_nan() {
        return quote!(f64::NAN);
    }
    if value.is_infinite() {
        return if value > 0.0 {
            quote!(f64::INFINITY)
        } else {
            quote!(f64::NEG_INFINITY)
        };
    }
    let text = format!("{:?}", value.abs());
    let literal: Literal = match text.parse() {
        Ok(literal) => literal,
        Err(_) => Literal::f64_unsuffixed(value.abs()),
    };
    if value < 0.0 {
        quote!(-#literal)
    } else {
        quote!(#literal)
    }
}

fn element(array: &str, index: usize) -> TokenStream {
    let (array, index) = (ident(array), Literal::usize_unsuffixed(index));
    quote!(#array[#index])
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
