//! The methods of a model after all passes, each with a graph of its own, and the values that depend on parameters
//! alone, which are computed once.

use super::prepare::{Factored, factored, finished};
use super::{Costs, Options, hoist};
use crate::equations::Equations;
use crate::expression::count::Table;
use crate::expression::liveness::Live;
use crate::expression::passes::{Rewritten, fuse, join};
use crate::expression::{Graph, NodeId};
use crate::method::Start;
use crate::method::inputs::{Argument, Inputs};
use crate::method::table::{self, Source, Specification};
use crate::model::Model;
use crate::names::{Names, snake};

/// The methods of a model, and the names of their inputs.
pub(crate) struct Plan {
    pub inputs: Inputs,
    pub procedures: Vec<Procedure>,
}

/// A method after all passes.
pub(crate) struct Procedure {
    /// The method; its arguments and its start are those that the passes have found to be needed.
    pub method: Specification,
    /// The graph of its operations.
    pub graph: Graph,
    /// Its results, as nodes of the graph.
    pub roots: Vec<NodeId>,
}

impl Procedure {
    fn new(method: Specification, Rewritten { graph, roots }: Rewritten) -> Self {
        Self {
            method,
            graph,
            roots,
        }
    }

    /// The operations of the method.
    pub(crate) fn cost(&self) -> Table {
        Table::of(&self.graph, &self.roots)
    }
}

impl Plan {
    /// The methods of a model. With `only`, the methods of these names and `new`.
    pub(crate) fn new(
        model: &Model,
        equations: &Equations,
        options: &Options,
        only: Option<&[&str]>,
    ) -> Self {
        let mut inputs = Inputs::new(model, equations);
        let source = Source {
            model,
            equations,
            inputs: &inputs,
            matrices: options.matrices,
        };
        let methods = table::methods(&source, only);
        let derived = derived(equations, &methods, &mut inputs);
        let new = fuse(&equations.graph, &derived.values);
        let new = Procedure::new(table::new(&inputs), new);
        let Derived {
            values,
            factored,
            known,
        } = derived;
        let finished = finished(equations, &methods, factored, &values, known, &inputs);
        let others = methods.into_iter().zip(finished);
        let others = others.map(|(mut method, (finished, from_accelerations))| {
            match (method.start, from_accelerations) {
                (Start::Accelerations, true) => method.arguments.push(Argument::Accelerations),
                (Start::Accelerations, false) => method.start = Start::State,
                _ => {}
            }
            Procedure::new(method, finished)
        });
        let procedures = std::iter::once(new).chain(others).collect();
        Self { inputs, procedures }
    }

    /// q̇ and v̇ as one method; `None` unless both have a method.
    pub(crate) fn motion(&self) -> Option<Procedure> {
        let named = |name: &str| self.procedures.iter().find(|of| of.method.name == name);
        let (rates, accelerations) = (named("coordinate_rates")?, named("accelerations")?);
        let joined = join(&[
            (&rates.graph, &rates.roots),
            (&accelerations.graph, &accelerations.roots),
        ]);
        let method = table::motion(&rates.method, &accelerations.method);
        Some(Procedure::new(method, joined))
    }

    /// The operations of each method, by its name.
    pub(crate) fn costs(&self) -> Costs {
        let procedures = self.procedures.iter();
        procedures
            .map(|of| (of.method.name.clone(), of.cost()))
            .collect()
    }
}

/// The values that depend on parameters alone and that other values need, stored in the mechanism; and the methods as
/// factored while these values were searched for.
struct Derived {
    /// The values, by nodes of the equations; named in [`Inputs`].
    values: Vec<NodeId>,
    factored: Vec<Factored>,
    /// Number of the values that were known when the methods were factored.
    known: usize,
}

/// Finds the values that depend on parameters alone, and names them in `inputs`.
fn derived(equations: &Equations, methods: &[Specification], inputs: &mut Inputs) -> Derived {
    let graph = &equations.graph;
    let of_state = |method: &&Specification| !method.arguments.is_empty();
    let changing = methods.iter().filter(of_state);
    let changing: Vec<NodeId> = changing.flat_map(|of| of.roots.iter().copied()).collect();
    let mut values = Live::new(graph, &changing).hoistable(graph);
    keep(graph, &values, inputs);
    let factored = factored(equations, methods, &values, inputs);
    let known = values.len();
    // Values that the passes create from parameters alone are known only after the passes.
    if !values.is_empty() || !inputs.parameters.is_empty() {
        let mut more = Vec::new();
        let behind_passes = methods.iter().zip(&factored);
        for (_, factored) in behind_passes.filter(|(method, _)| of_state(method)) {
            let (chosen, _) = factored.chosen(inputs);
            let found = hoist::found(graph, &chosen.graph, &chosen.roots, &values, inputs);
            for (_, value) in found {
                if !values.contains(&value) && !more.contains(&value) {
                    more.push(value);
                }
            }
        }
        keep(graph, &more, inputs);
        values.extend(more);
    }
    Derived {
        values,
        factored,
        known,
    }
}

/// Adds values to those stored in the mechanism, and names them.
fn keep(graph: &Graph, values: &[NodeId], inputs: &mut Inputs) {
    let mut names = Names::with(&["parameters"]);
    for name in &inputs.derived {
        names.take(name);
    }
    let nameless = |name: &&String| {
        let digits = name.strip_prefix('k');
        digits.is_some_and(|d| !d.is_empty() && d.bytes().all(|b| b.is_ascii_digit()))
    };
    let mut nameless = inputs.derived.iter().filter(nameless).count();
    for &id in values {
        let name = graph
            .name_of(id)
            .map(|name| snake(&name))
            .unwrap_or_else(|| {
                nameless += 1;
                format!("k{nameless}")
            });
        inputs.derived.push(names.take(&name));
        inputs
            .derived_in
            .push(graph.sections()[graph.section_of(id)].clone());
    }
}
