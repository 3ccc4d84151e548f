//! Straight-line programs, independent of any language. Every target prints, interprets or encodes them.
//!
//! The passes work on graphs, one after the other, independently of the target language:
//!
//! | file | content |
//! |---|---|
//! | `plan` | a graph for each method of the table in `method`; values that depend on parameters alone (`hoist`) |
//! | `prepare` | the passes over each graph: known values become inputs, common factors are taken out, operations are fused |
//! | `order`, `inline`, `schedule` | the operations of a graph as statements, in order |
//! | `split` | cuts of long methods |
//! | `formula` | the operations of a statement, independent of the written form |
//! | `lower`, `assemble` | statements as a [`List`], methods as [`Lists`] |
//! | `join` | several lists evaluated together |
//! | `facts`, `breakpoints` | facts that need no evaluation |
//! | `form` | whether another build has the same form of lists |
//!
//! A [`List`] is one method of a model as a list of operations, in the order of their evaluation. It is made from the
//! same schedule as the Rust text and has exactly the same operations, so that all targets give the same bits.
//! [`Lists`] are all methods of a model, with everything else needed to evaluate it;
//! [`Config::lists`](crate::Config::lists) makes them.

mod assemble;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod breakpoints;
mod facts;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod form;
pub(crate) mod formula;
pub(crate) mod hoist;
mod inline;
mod join;
mod list;
mod lists;
mod lower;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod order;
pub(crate) mod plan;
mod prepare;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod schedule;
pub(crate) mod split;

use crate::equations::Equations;
use crate::expression::count::{Count, Table};
use crate::expression::liveness::Live;
use crate::model::Model;
use plan::Plan;
use std::borrow::Cow;

pub use crate::method::{Method, Start};
pub(crate) use assemble::neighbours;
pub use assemble::{counted_lists, lists};
pub use facts::{Adjustable, Column, Facts, StateKind, Watched};
pub use form::FORM;
pub use join::Methods;
pub use list::{Input, List, Operation, Value};
pub use lists::{Curve, Function, Lists, Routine};

/// Options of the generated program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Whether to generate the methods `mass_matrix`, `velocity_forces` and `applied_forces`, which need the runtime's
    /// feature `nalgebra`.
    pub matrices: bool,
    /// Largest number of statements of one function, not counting those that read inputs. Longer functions are cut into
    /// pieces, which release builds merge again unless there are too many.
    pub statements: usize,
    /// Largest number of statements of a method that is compiled as one function. That makes the code faster, by 3 %
    /// with `f64` and by 5 to 15 % with eight lanes, but compile time grows more than proportionally, and the code may
    /// exceed the processor's caches. In longer methods, each piece becomes a function.
    pub merged: usize,
}

impl Options {
    /// The default options.
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

/// The operations of methods, each with the method's name.
pub type Costs = Vec<(Cow<'static, str>, Table)>;

/// The operations of each method of a model after all passes, by section.
pub fn costs(model: &Model, equations: &Equations, options: &Options) -> Costs {
    costs_of(model, equations, options, None)
}

/// The same for the methods named in `only`; for all if it is `None`.
pub fn costs_of(
    model: &Model,
    equations: &Equations,
    options: &Options,
    only: Option<&[&str]>,
) -> Costs {
    Plan::new(model, equations, options, only).costs()
}

/// By method: the operations that depend on parameters alone, and so are needlessly repeated at every call. Only `new`
/// and `initial_conditions` may have such operations, because computing them is their purpose.
pub fn repeated(
    model: &Model,
    equations: &Equations,
    options: &Options,
) -> Vec<(Cow<'static, str>, Count)> {
    let Plan { inputs, procedures } = Plan::new(model, equations, options, None);
    let of = |procedure: &plan::Procedure| {
        let live = Live::new(&procedure.graph, &procedure.roots);
        let alone = hoist::alone(&procedure.graph, &live, &inputs);
        let nodes = live.nodes().iter().copied();
        let nodes: Vec<_> = nodes.filter(|id| alone[id.0 as usize]).collect();
        let mut count = Count::of_nodes(&procedure.graph, &nodes);
        // A sign does not count as an operation.
        count.neg = 0;
        (procedure.method.name.clone(), count)
    };
    procedures.iter().map(of).collect()
}
