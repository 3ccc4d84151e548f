//! Straight-line programs of no language: what every target prints, interprets or encodes.
//!
//! The passes work on graphs, one after the other, and know no language:
//!
//! | file | what |
//! |---|---|
//! | `plan` | a graph for each method of the table in `method`; values that depend on parameters alone (`hoist`) |
//! | `prepare` | the passes over each graph: what is known is an input, common factors go outside, operations are fused |
//! | `order`, `inline`, `schedule` | the operations of a graph in their order, as statements |
//! | `share` | what like elements do alike, as subroutines |
//! | `split` | where a long method is cut |
//! | `formula` | the operations of a statement, in whatever form they are written |
//! | `lower`, `assemble` | statements as a [`List`], methods as [`Lists`] |
//! | `join` | lists that are evaluated together |
//! | `facts`, `breakpoints`, `about` | what is known without evaluating anything |
//!
//! A [`List`] is one method of a model as a list of operations in the order in which they are done. It is made of the same schedule
//! that the Rust text is printed from, and it has the text's very operations, so that all targets give the same bits.
//! [`Lists`] are all methods of a model, with all else that is needed to evaluate it: [`Config::lists`](crate::Config::lists) makes them.

mod about;
mod assemble;
mod breakpoints;
mod facts;
pub(crate) mod formula;
pub(crate) mod hoist;
mod inline;
mod join;
mod list;
mod lists;
mod lower;
pub(crate) mod order;
pub(crate) mod plan;
mod prepare;
pub(crate) mod schedule;
pub(crate) mod share;
pub(crate) mod split;

use crate::equations::Equations;
use crate::expression::count::{Count, Table};
use crate::expression::live::Live;
use crate::model::Model;
use plan::Plan;

pub use crate::method::{Method, Start};
pub use about::about;
pub(crate) use assemble::neighbours;
pub use assemble::{counted_lists, lists};
pub use facts::{Adjustable, Column, Facts, Kind, Watched};
pub use join::Combination;
pub use list::{Input, List, Operation, Value};
pub use lists::{Curve, Lists, Routine};

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

/// The operations of methods, by their names.
pub type Costs = Vec<(&'static str, Table)>;

/// What each method of a model costs, by section: the operations after all passes.
pub fn costs(model: &Model, equations: &Equations, options: &Options) -> Costs {
    costs_of(model, equations, options, None)
}

/// The same of the methods of these names alone, if some are named.
pub fn costs_of(
    model: &Model,
    equations: &Equations,
    options: &Options,
    only: Option<&[&str]>,
) -> Costs {
    Plan::new(model, equations, options, only).costs()
}

/// By method: the operations that depend on parameters alone, and so are done at every call though nothing changes. There
/// are none but in `new` and `initial_conditions`, which is what they are for.
pub fn repeated(
    model: &Model,
    equations: &Equations,
    options: &Options,
) -> Vec<(&'static str, Count)> {
    let Plan { inputs, procedures } = Plan::new(model, equations, options, None);
    let of = |procedure: &plan::Procedure| {
        let live = Live::new(&procedure.graph, &procedure.roots);
        let alone = hoist::alone(&procedure.graph, &live, &inputs);
        let nodes = live.nodes().iter().copied();
        let nodes: Vec<_> = nodes.filter(|id| alone[id.0 as usize]).collect();
        let mut count = Count::of_nodes(&procedure.graph, &nodes);
        // A sign is no operation.
        count.neg = 0;
        (procedure.method.name, count)
    };
    procedures.iter().map(of).collect()
}
