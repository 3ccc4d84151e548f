//! Replaces known values by inputs, so that the nodes below them are not needed; and replaces inputs by values that
//! another graph computes.

use super::rebuild::{Copier, Rewritten};
use crate::expression::graph::Graph;
use crate::expression::liveness::Live;
use crate::expression::node::{Node, NodeId, Symbol};
use rustc_hash::FxHashMap;

/// The graph with each node of `by` replaced by its input, or by the negative of the input if the flag is set. Nodes
/// that only replaced nodes need are left out.
pub fn replace(
    graph: &Graph,
    roots: &[NodeId],
    by: &FxHashMap<NodeId, (Symbol, bool)>,
) -> Rewritten {
    let needed = needed(graph, roots, by);
    let mut copy = Copier::new(graph, needed.len());
    for id in needed {
        if let Some(&(symbol, negative)) = by.get(&id) {
            let symbol = copy.graph().symbol(symbol).id();
            let new = if negative {
                copy.graph().intern(Node::Neg(symbol)).id()
            } else {
                symbol
            };
            copy.set(id, new);
        } else {
            copy.keep(id);
        }
    }
    copy.finish(roots)
}

/// The graph with each of these inputs turned into a value of `other`, and with the nodes that compute it. The opposite
/// of [`replace`].
pub fn restore(rewritten: Rewritten, other: &Graph, by: &FxHashMap<Symbol, NodeId>) -> Rewritten {
    let Rewritten { graph, roots } = &rewritten;
    let live = Live::new(graph, roots);
    let value = |id: NodeId| match graph.node(id) {
        Node::Symbol(symbol) => by.get(&symbol).copied(),
        _ => None,
    };
    let values: Vec<NodeId> = live.nodes().iter().filter_map(|&id| value(id)).collect();
    if values.is_empty() {
        return rewritten;
    }
    let needed = Live::new(other, &values);
    let mut copy = Copier::new(other, needed.nodes().len() + live.nodes().len());
    for &id in needed.nodes() {
        copy.keep(id);
    }
    let Rewritten {
        graph: new,
        roots: values,
    } = copy.finish(&values);
    let mut values = values.into_iter();
    let mut copy = Copier::onto(new, graph);
    for &id in live.nodes() {
        match value(id).and_then(|_| values.next()) {
            Some(value) => copy.set(id, value),
            None => copy.keep(id),
        }
    }
    copy.finish(roots)
}

/// The nodes that the roots need, in order of creation, without nodes that only replaced nodes need.
pub fn needed<T>(graph: &Graph, roots: &[NodeId], by: &FxHashMap<NodeId, T>) -> Vec<NodeId> {
    let nodes = graph.nodes();
    let mut needed = vec![false; nodes.len()];
    for root in roots {
        needed[root.0 as usize] = true;
    }
    let mut known = vec![false; nodes.len()];
    for id in by.keys() {
        known[id.0 as usize] = true;
    }
    for at in (0..nodes.len()).rev() {
        if needed[at] && !known[at] {
            for operand in nodes[at].operands() {
                needed[operand.0 as usize] = true;
            }
        }
    }
    (0..nodes.len() as u32)
        .map(NodeId)
        .filter(|id| needed[id.0 as usize])
        .collect()
}
