//! What the passes make of parameters alone: k₁·x + k₂·x = (k₁ + k₂)·x is one operation less at every state only where
//! k₁ + k₂ is computed once.
//!
//! Such a value is found in the graph of a method and carried over, operand by operand, into the graph of the equations,
//! where it is one more value that the mechanism keeps.

use super::inputs::{Input, Inputs};
use crate::expression::live::{Dependence, Live};
use crate::expression::passes::{Rewritten, replace};
use crate::expression::{Graph, Node, NodeId, Symbol};
use rustc_hash::FxHashMap;

/// The values of a method that depend on parameters alone, each with the value of the equations that it is.
pub(super) fn found(
    equations: &Graph,
    method: &Graph,
    roots: &[NodeId],
    derived: &[NodeId],
    inputs: &Inputs,
) -> Vec<(NodeId, NodeId)> {
    let live = Live::new(method, roots);
    let hoistable = live.hoistable(method);
    if hoistable.is_empty() {
        return Vec::new();
    }
    let mut carried: FxHashMap<NodeId, NodeId> = FxHashMap::default();
    let alone = live.nodes().iter().copied();
    for id in alone.filter(|&id| live.dependence(id).within(Dependence::PARAMETERS)) {
        let new = match method.node(id) {
            Node::Symbol(symbol) => match inputs.input(symbol) {
                Input::Derived(index) => derived[index],
                _ => equations.symbol(symbol).id(),
            },
            node => {
                equations.section(method.sections()[method.section_of(id)].clone());
                equations
                    .intern(node.map_operands(|operand| carried[&operand]))
                    .id()
            }
        };
        carried.insert(id, new);
    }
    hoistable.into_iter().map(|id| (id, carried[&id])).collect()
}

/// A method that takes such values from the mechanism, as far as it keeps them.
pub(super) fn hoisted(
    equations: &Graph,
    method: Rewritten,
    derived: &[NodeId],
    inputs: &Inputs,
) -> Rewritten {
    let Rewritten { graph, roots } = method;
    let kept = found(equations, &graph, &roots, derived, inputs).into_iter();
    let kept = kept.filter_map(|(id, value)| {
        let index = derived.iter().position(|&d| d == value)?;
        Some((id, (inputs.symbol(Input::Derived(index)), false)))
    });
    let kept: FxHashMap<NodeId, (Symbol, bool)> = kept.collect();
    if kept.is_empty() {
        return Rewritten { graph, roots };
    }
    replace(&graph, &roots, &kept)
}
