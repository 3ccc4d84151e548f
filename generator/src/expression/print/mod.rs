//! Expressions for people to read: first definitions of values that are used more than once, then the results.
//!
//! ```text
//! # element head: orientation
//! t1 = sin(q1)*q2
//!
//! a = t1 + 2*q3
//! b = q2 - t1*t1
//! ```
//!
//! `listing` decides which values are written out, and where signs and parentheses are placed. [`text()`] and
//! [`latex()`] decide on the notation.

pub mod latex;
mod listing;
pub mod text;

use super::node::{Function, Symbol};
use std::cmp::Ordering;

pub use latex::latex;
pub use text::text;

/// The names of inputs and functions.
#[derive(Clone, Copy)]
pub struct Names<'a> {
    /// Name of an input.
    pub symbol: &'a dyn Fn(Symbol) -> String,
    /// Name of a function, an identifier.
    pub function: &'a dyn Fn(Function) -> String,
}

impl<'a> Names<'a> {
    /// Names inputs by this function, curves by their index, and force laws by their names.
    pub fn of_inputs(symbol: &'a dyn Fn(Symbol) -> String) -> Self {
        Names {
            symbol,
            function: &function_name,
        }
    }
}

/// `t`, `q1`, `v1`, `p1` …: names for expressions that belong to no model.
pub fn symbol_name(symbol: Symbol) -> String {
    match symbol {
        Symbol::Time => "t".to_string(),
        Symbol::Coordinate(i) => format!("q{}", i + 1),
        Symbol::Velocity(i) => format!("v{}", i + 1),
        Symbol::Parameter(i) => format!("p{}", i + 1),
        Symbol::Auxiliary(i) => format!("z{}", i + 1),
        Symbol::Memory(i) => format!("m{}", i + 1),
        Symbol::Acceleration(i) => format!("a{}", i + 1),
    }
}

/// `curve1`, `curve1_slope`, `choose` …
pub fn function_name(function: Function) -> String {
    match function {
        Function::Curve(i) => format!("curve{}", i + 1),
        Function::CurveSlope(i) => format!("curve{}_slope", i + 1),
        Function::CurveSecondDerivative(i) => format!("curve{}_second_derivative", i + 1),
        Function::CurveInverse(i) => format!("curve{}_inverse", i + 1),
        Function::CurveIntegral(i) => format!("curve{}_integral", i + 1),
        Function::CurveDoubleIntegral(i) => format!("curve{}_double_integral", i + 1),
        Function::CurveBreakpoints(i) => format!("curve{}_breakpoint_indicator", i + 1),
        Function::CurveStop(i) => format!("curve{}_stop", i + 1),
        Function::Choose => "choose".to_string(),
        Function::Power => "power".to_string(),
        Function::User(call) => format!("user{}_{}", call.force + 1, call.part + 1),
        Function::Approach(call) => {
            let (part, components) = (usize::from(call.part), call.components());
            match part.cmp(&components) {
                Ordering::Less => format!("overlap_direction{}", part + 1),
                Ordering::Equal => "overlap".to_string(),
                Ordering::Greater => format!("overlap_middle{}", part - components),
            }
        }
        Function::Support(0) => "reach".to_string(),
        Function::Support(part) => format!("reach_slope{part}"),
    }
}
