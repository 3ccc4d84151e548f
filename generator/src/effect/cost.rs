//! The cost of the equations of a variant: the number of operations of the emitted text, after all passes.

use super::Variant;
use crate::dynamics::{self, derive_without};
use crate::equations::Equations;
use crate::expression::NodeId;
use crate::expression::count::Count;
use crate::expression::liveness::Live;
use crate::program;
use crate::program::{Costs, Lists};
use std::collections::HashSet;

/// Operation counts of one evaluation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// Operations of `accelerations`, and of the rates of the continuous states of force laws.
    pub accelerations: Count,
    /// Operations of `outputs`. If it calls `accelerations`, those are not counted.
    pub outputs: Count,
}

/// The operation counts of a variant, and its lists: those of the rates and, if there are any, those of the outputs.
pub fn counted(variant: &Variant) -> (Cost, Lists) {
    let equations = derive_without(&variant.model, OPTIONS, variant.omitted);
    let rates = ["accelerations", "coordinate_rates", "auxiliary_rates"];
    let starts = [
        "initial_conditions",
        "initial_auxiliaries",
        "initial_memory",
    ];
    let mut only = [rates, starts].concat();
    if !variant.model.outputs.is_empty() {
        only.push("outputs");
    }
    let (lists, tables) = program::counted_lists(&variant.model, &equations, &EMITTED, Some(&only));
    (Cost::of(&equations, &tables), lists)
}

impl Cost {
    fn of(equations: &Equations, tables: &Costs) -> Self {
        let of = |method: &str| {
            let found = tables.iter().find(|(name, _)| *name == method);
            found.map_or_else(Count::default, |(_, table)| table.total.clone())
        };
        Cost {
            accelerations: of("accelerations") + &of_states(equations),
            outputs: of("outputs"),
        }
    }
}

/// Operations of the rates of continuous states, such as the gas of an airbag, that accelerations do not need. They are
/// counted before the passes of emission.
fn of_states(equations: &Equations) -> Count {
    let rates: Vec<NodeId> = equations
        .auxiliaries
        .iter()
        .map(|state| state.next)
        .collect();
    if rates.is_empty() {
        return Count::default();
    }
    let known = Live::new(&equations.graph, &equations.accelerations);
    let known: HashSet<&NodeId> = known.nodes().iter().collect();
    let more = Live::new(&equations.graph, &rates);
    let more: Vec<NodeId> = more
        .nodes()
        .iter()
        .copied()
        .filter(|id| !known.contains(id))
        .collect();
    Count::of_nodes(&equations.graph, &more)
}

/// The operation counts of a variant alone, in less time.
pub fn cost(variant: &Variant) -> Cost {
    let equations = derive_without(&variant.model, OPTIONS, variant.omitted);
    let only: &[&str] = match variant.model.outputs.is_empty() {
        true => &["accelerations"],
        false => &["accelerations", "outputs"],
    };
    let tables = program::costs_of(&variant.model, &equations, &EMITTED, Some(only));
    Cost::of(&equations, &tables)
}

const EMITTED: program::Options = program::Options {
    matrices: false,
    ..program::Options::DEFAULT
};

const OPTIONS: dynamics::Options = dynamics::Options {
    matrices: false,
    route: None,
};
