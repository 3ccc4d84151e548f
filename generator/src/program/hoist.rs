//! Finds values that depend on parameters alone and that the passes have created: k₁·x + k₂·x = (k₁ + k₂)·x saves an
//! operation per evaluation only if k₁ + k₂ is computed once for all.
//!
//! Such a value is found in the graph of a method and copied with its operands into the graph of the equations, where
//! it becomes one more value stored in the mechanism.

use crate::expression::liveness::Live;
use crate::expression::passes::{Rewritten, replace};
use crate::expression::{Graph, Node, NodeId, Symbol};
use crate::method::inputs::{Input, Inputs};
use rustc_hash::FxHashMap;

/// The values of a method that depend on parameters alone, and that are roots or operands of operations that depend on
/// more: each node of the method with its copy in the equations.
pub(crate) fn found(
    equations: &Graph,
    method: &Graph,
    roots: &[NodeId],
    derived: &[NodeId],
    inputs: &Inputs,
) -> Vec<(NodeId, NodeId)> {
    let live = Live::new(method, roots);
    let alone = alone(method, &live, inputs);
    let mut wanted = vec![false; method.len()];
    let unsigned = |id: NodeId| match method.node(id) {
        Node::Neg(operand) => operand,
        _ => id,
    };
    let changing = live.nodes().iter().filter(|id| !alone[id.0 as usize]);
    let operands = changing.flat_map(|&id| method.node(id).operands());
    for id in operands.chain(roots.iter().copied()) {
        wanted[unsigned(id).0 as usize] = true;
    }
    // For a list of arguments, its members are wanted. Lists come after their members, so this goes backwards.
    for &id in live.nodes().iter().rev() {
        if let Node::Arguments(members) = method.node(id)
            && wanted[id.0 as usize]
        {
            for member in members {
                wanted[unsigned(member).0 as usize] = true;
            }
        }
    }
    let mut carried: FxHashMap<NodeId, NodeId> = FxHashMap::default();
    let mut found = Vec::new();
    let (sections, mut section) = (method.sections(), usize::MAX);
    for id in live
        .nodes()
        .iter()
        .copied()
        .filter(|id| alone[id.0 as usize])
    {
        let new = match method.node(id) {
            Node::Symbol(symbol) => match inputs.input(symbol) {
                Input::Derived(index) => derived[index],
                _ => equations.symbol(symbol).id(),
            },
            node => {
                let of = method.section_of(id);
                if of != section {
                    section = of;
                    equations.section(sections[of].clone());
                }
                equations
                    .intern(node.map_operands(|operand| carried[&operand]))
                    .id()
            }
        };
        carried.insert(id, new);
        if wanted[id.0 as usize]
            && !matches!(
                method.node(id),
                Node::Constant(_) | Node::Symbol(_) | Node::Arguments(_)
            )
        {
            found.push((id, new));
        }
    }
    found
}

/// By node: true if the node is live and depends on parameters alone. Event functions from which a method starts do not
/// count: they change from call to call, although they are numbered as parameters.
pub(crate) fn alone(method: &Graph, live: &Live, inputs: &Inputs) -> Vec<bool> {
    let mut alone = vec![false; method.len()];
    for &id in live.nodes() {
        let node = method.node(id);
        let own = match node {
            Node::Symbol(symbol) => {
                matches!(
                    inputs.input(symbol),
                    Input::Parameter(_) | Input::Derived(_)
                )
            }
            _ => true,
        };
        alone[id.0 as usize] = own && node.operands().all(|operand| alone[operand.0 as usize]);
    }
    alone
}

/// The method in which such values are read from the mechanism, if the mechanism stores them.
pub(crate) fn hoisted(
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
