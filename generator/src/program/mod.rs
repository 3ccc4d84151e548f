//! Straight-line programs of no language: what every target prints, interprets or encodes.
//!
//! A [`List`] is one method of a model as a list of operations in the order in which they are done. It is made of the same scheduled
//! program that the Rust text is printed from, and it has the text's very operations, so that all targets give the same bits.
//! [`Lists`] are all methods of a model, with all else that is needed to evaluate it: [`Config::lists`](crate::Config::lists) makes them.

pub(crate) mod assemble;
pub(crate) mod breakpoints;
pub(crate) mod carry;
mod facts;
pub(crate) mod formula;
pub(crate) mod hoist;
mod inline;
mod join;
pub(crate) mod like;
mod list;
mod lists;
mod lower;
pub(crate) mod order;
pub(crate) mod plan;
mod prepare;
pub(crate) mod schedule;
pub(crate) mod split;

use crate::equations::Equations;
use crate::expression::count::{Count, Table};
use crate::expression::live::Live;
use crate::method::inputs::Inputs;
use crate::model::Model;
use crate::target::rust::method::Request;

pub use assemble::{Costs, counted_lists, lists};
pub use facts::{Adjustable, Column, Facts, Kind, Watched};
pub use join::Combination;
pub use list::{Input, List, Operation, Value};
pub use lists::{Curve, Lists, Method, Routine, Start};

/// What to emit, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// The methods `mass_matrix`, `velocity_forces` and `applied_forces`, which need the runtime's feature `nalgebra`.
    pub matrices: bool,
    /// Statements that one function may have, besides those that read inputs; longer ones are cut into pieces, which release builds merge
    /// again unless there are too many. What like elements share, and what is left beside it, is not cut.
    pub statements: usize,
    /// Statements up to which a method is one function when it is compiled, which makes the faster code, by 3 % over one double and by
    /// 5 to 15 % over eight, but takes more than proportionally long, and more than the caches of a processor hold. Of longer ones
    /// like elements share functions; where few are like each other, each piece is a function.
    pub merged: usize,
}

impl Options {
    /// What is emitted unless something else is asked for.
    pub const DEFAULT: Options = Options {
        matrices: true,
        statements: 900,
        merged: 3000,
    };
}

impl Default for Options {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// What each method of a model's module costs, by section: the operations after all passes, before long methods are joined, or repeat some
/// instead of keeping their results.
pub fn costs(
    model: &Model,
    equations: &Equations,
    options: &Options,
) -> Vec<(&'static str, Table)> {
    costs_of(model, equations, options, None)
}

/// The same of some methods, and of `new`, which has what these need of parameters alone.
pub fn costs_of(
    model: &Model,
    equations: &Equations,
    options: &Options,
    only: Option<&[&str]>,
) -> Vec<(&'static str, Table)> {
    let mut inputs = Inputs::new(model, equations);
    let derived = plan::derived(model, equations, options, only, &mut inputs);
    let requests = plan::requests(model, equations, options, derived, &inputs, only);
    requests
        .iter()
        .map(|request| (request.name, Table::of(&request.graph, &request.roots)))
        .collect()
}

/// By method: the operations that depend on parameters alone, and so are done at every call though nothing changes. There
/// are none but in `new` and `initial_conditions`, which is what they are for.
pub fn repeated(
    model: &Model,
    equations: &Equations,
    options: &Options,
) -> Vec<(&'static str, Count)> {
    let mut inputs = Inputs::new(model, equations);
    let derived = plan::derived(model, equations, options, None, &mut inputs);
    let requests = plan::requests(model, equations, options, derived, &inputs, None);
    let of = |request: &Request<'_>| {
        let live = Live::new(&request.graph, &request.roots);
        let alone = hoist::alone(&request.graph, &live, &inputs);
        let nodes = live.nodes().iter().copied();
        let nodes: Vec<_> = nodes.filter(|id| alone[id.0 as usize]).collect();
        let mut count = Count::of_nodes(&request.graph, &nodes);
        // A sign is no operation.
        count.neg = 0;
        (request.name, count)
    };
    requests.iter().map(of).collect()
}
