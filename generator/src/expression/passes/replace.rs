//! Replaces values that are already known by inputs. The nodes below them are then not needed.

use super::rebuild::{Copier, Rewritten};
use crate::expression::graph::Graph;
use crate::expression::node::{Node, NodeId, Symbol};
use rustc_hash::FxHashMap;

/// The graph with each replaced node turned into the input, or into its negative if the flag is set. Nodes that only
/// replaced nodes need are left out.
pub fn replace(
    graph: &Graph,
    roots: &[NodeId],
    by: &FxHashMap<NodeId, (Symbol, bool)>,
) -> Rewritten {
    let mut copy = Copier::new(graph);
    for id in needed(graph, roots, by) {
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

/// The nodes that the roots need, in order of creation, without those below replaced nodes.
fn needed(graph: &Graph, roots: &[NodeId], by: &FxHashMap<NodeId, (Symbol, bool)>) -> Vec<NodeId> {
    let nodes = graph.nodes();
    let mut needed = vec![false; nodes.len()];
    for root in roots {
        needed[root.0 as usize] = true;
    }
    for id in (0..nodes.len() as u32).rev().map(NodeId) {
        if needed[id.0 as usize] && !by.contains_key(&id) {
            for operand in nodes[id.0 as usize].operands() {
                needed[operand.0 as usize] = true;
            }
        }
    }
    (0..nodes.len() as u32)
        .map(NodeId)
        .filter(|id| needed[id.0 as usize])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_below_a_replaced_value_is_left() {
        let graph = Graph::new();
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let known = (x * y).sqrt();
        let value = known / y;
        let by = FxHashMap::from_iter([(known.id(), (Symbol::Parameter(7), false))]);
        let new = replace(&graph, &[value.id(), known.id()], &by);
        let p = new.graph.symbol(Symbol::Parameter(7)).id();
        let y = new.graph.symbol(Symbol::Coordinate(1)).id();
        assert_eq!(new.graph.node(new.roots[0]), Node::Div(p, y));
        assert_eq!(new.roots[1], p);
        assert_eq!(new.graph.len(), 3);
    }

    #[test]
    fn the_sign_goes_along() {
        let graph = Graph::new();
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let known = x * y;
        let by = FxHashMap::from_iter([(known.id(), (Symbol::Parameter(7), true))]);
        let new = replace(&graph, &[known.id()], &by);
        let p = new.graph.symbol(Symbol::Parameter(7)).id();
        assert_eq!(new.graph.node(new.roots[0]), Node::Neg(p));
    }
}
