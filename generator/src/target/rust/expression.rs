//! Prints formulas as Rust. Their operations and brackets are decided by `program::formula`.

use super::library::Library;
use super::naming::Naming;
use super::syntax;
use crate::expression::{Function, NodeId, Symbol};
use crate::method::inputs::{Input, Inputs};
use crate::program::formula::{Form, Formulas, MethodOperation, Operator};
use crate::program::schedule::{Schedule, Statement};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use std::cell::Cell;
use syn::{BinOp, Expr};

/// Prints the expressions of one schedule.
pub(crate) struct Printer<'a> {
    schedule: &'a Schedule,
    names: &'a Naming,
    inputs: &'a Inputs,
    library: &'a Library,
    /// True if parameters are an argument; false if they are a field of the mechanism.
    parameters_are_argument: bool,
    numbers: Cell<bool>,
}

impl<'a> Printer<'a> {
    pub(crate) fn new(
        schedule: &'a Schedule,
        names: &'a Naming,
        inputs: &'a Inputs,
        library: &'a Library,
        parameters_are_argument: bool,
    ) -> Self {
        let numbers = Cell::new(false);
        Self {
            schedule,
            names,
            inputs,
            library,
            parameters_are_argument,
            numbers,
        }
    }

    /// True if a number has been printed, so that the function `num` is needed.
    pub(crate) fn prints_numbers(&self) -> bool {
        self.numbers.get()
    }

    /// A number as a scalar.
    pub(crate) fn number(&self, value: f64) -> Expr {
        self.numbers.set(true);
        scalar(value)
    }

    fn formulas(&self) -> Formulas<'_, Self> {
        Formulas {
            schedule: self.schedule,
            form: self,
        }
    }

    /// A value as it is written in a formula: its name, or its own formula if it has no name.
    pub(crate) fn value(&self, id: NodeId) -> Expr {
        self.formulas().value(id)
    }

    /// The right-hand side of a statement: one value, a pair or a list.
    pub(crate) fn statement(&self, statement: Statement) -> Expr {
        match statement {
            Statement::Value(id) => self.formulas().formula(id),
            Statement::SinCos { argument, .. } => {
                syntax::method(self.formulas().receiver(argument), "sin_cos", [])
            }
            Statement::Results(call) => {
                let any = self.schedule.results(call).iter().flatten().next();
                any.map_or_else(
                    || syntax::word("results"),
                    |&id| self.formulas().formula(id),
                )
            }
            Statement::Put(place) => {
                let index = syntax::literal(Literal::usize_unsuffixed(place));
                let value = self.value(self.schedule.roots[place]);
                syntax::method(syntax::word("writer"), "put", [index, value])
            }
        }
    }

    /// An input by its own name.
    pub(crate) fn symbol(&self, input: Input) -> Expr {
        match input {
            Input::Parameter(i) => {
                let parameters = match self.parameters_are_argument {
                    true => syntax::word("parameters"),
                    false => syntax::field(syntax::word("self"), "parameters"),
                };
                syntax::field(parameters, &self.inputs.parameters[i])
            }
            Input::Derived(i) => syntax::field(syntax::word("self"), &self.inputs.derived[i]),
            // Arguments that are arrays are destructured, so that their elements have names.
            Input::Time => syntax::word("t"),
            Input::Coordinate(i) => syntax::element("q", i),
            Input::Velocity(i) => syntax::element("v", i),
            Input::Auxiliary(i) => syntax::element("z", i),
            Input::Memory(i) => syntax::element("m", i),
            Input::Acceleration(i) => syntax::element("a", i),
            Input::EventFunction(i) => syntax::element("g", i),
        }
    }
}

impl Form for Printer<'_> {
    type Term = Expr;

    fn number(&self, value: f64) -> Expr {
        Printer::number(self, value)
    }

    fn bound(&self, id: NodeId) -> Expr {
        syntax::place(self.names.of(id).unwrap_or("unnamed"))
    }

    fn input(&self, id: NodeId, symbol: Symbol) -> Expr {
        match self.names.of(id) {
            Some(name) => syntax::place(name),
            None => self.symbol(self.inputs.input(symbol)),
        }
    }

    fn negative(&self, a: Expr) -> Expr {
        syntax::negative(a)
    }

    fn binary(&self, a: Expr, operator: Operator, b: Expr) -> Expr {
        let operator = match operator {
            Operator::Plus => BinOp::Add(Default::default()),
            Operator::Minus => BinOp::Sub(Default::default()),
            Operator::Times => BinOp::Mul(Default::default()),
            Operator::Over => BinOp::Div(Default::default()),
        };
        syntax::binary(a, operator, b)
    }

    fn method<const N: usize>(
        &self,
        receiver: Expr,
        method: MethodOperation,
        others: [Expr; N],
    ) -> Expr {
        let name = match method {
            MethodOperation::Sqrt => "sqrt",
            MethodOperation::Atan2 => "atan2",
            MethodOperation::Max => "max",
            MethodOperation::Min => "min",
            MethodOperation::MulAdd => "mul_add",
        };
        syntax::method(receiver, name, others)
    }

    fn half_of_pair(&self, argument: Expr, half: u32) -> Expr {
        syntax::tuple_field(syntax::method(argument, "sin_cos", []), half)
    }

    fn call(&self, function: Function, arguments: Vec<Expr>) -> Expr {
        match self.library.callee(function) {
            Callee::Method { of, name } => syntax::method(syntax::word(of), name, arguments),
            Callee::Function(path) => syntax::call(syntax::word(path), arguments),
            Callee::Adapter(path) => syntax::call(syntax::word(path), [syntax::array(arguments)]),
        }
    }

    fn arguments(&self) -> Expr {
        syntax::word("arguments")
    }

    fn brackets(&self, a: Expr) -> Expr {
        syntax::brackets(a)
    }
}

/// The function that a call in the graph refers to.
pub(crate) enum Callee<'a> {
    /// A method of a constant, such as a curve.
    Method { of: &'a str, name: &'static str },
    /// A function by its path.
    Function(&'static str),
    /// A function of one array, by its path.
    Adapter(&'a str),
}

/// A number as a scalar, by the function `num`.
pub(crate) fn scalar(value: f64) -> Expr {
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

/// A name as an identifier token.
pub(crate) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// A number with the fewest digits that read back as the same number.
pub fn number(value: f64) -> TokenStream {
    match digits(value) {
        Some(digits) if value < 0.0 => quote!(-#digits),
        Some(digits) => quote!(#digits),
        None => {
            let name = syntax::path(unusual(value));
            quote!(#name)
        }
    }
}

/// The digits of the absolute value of a finite number; `None` for any other number.
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
