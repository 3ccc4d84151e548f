//! Straight-line programs of no language: what every target prints, interprets or encodes.
//!
//! A [`List`] is one method of a model as a list of operations in the order in which they are done. It is made of the same scheduled
//! program that the Rust text is printed from, and it has the text's very operations, so that all targets give the same bits.
//! [`Lists`] are all methods of a model, with all else that is needed to evaluate it: [`Config::lists`](crate::Config::lists) makes them.

mod facts;
mod join;
mod list;
mod lists;

pub use facts::{Adjustable, Column, Facts, Kind, Watched};
pub use join::Combination;
pub use list::{Input, List, Operation, Value};
pub use lists::{Curve, Lists, Method, Routine, Start};
