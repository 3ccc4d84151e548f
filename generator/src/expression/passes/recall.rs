//! Replaces the functions of calls in one expression of a graph that continues to grow.

use super::rebuild::construct;
use crate::expression::graph::Expr;
use crate::expression::node::{Function, Node, NodeId};
use rustc_hash::{FxHashMap, FxHashSet};

/// The expression with each called function mapped by `of`. Nodes without a changed call are reused.
pub fn recall<'g>(expression: Expr<'g>, of: impl Fn(Function) -> Function) -> Expr<'g> {
    let (graph, root) = (expression.graph(), expression.id());
    let mut moved: FxHashMap<NodeId, NodeId> = FxHashMap::default();
    for id in below(expression) {
        let node = graph.node(id);
        let other = match node {
            Node::Call(function, operands) => Node::Call(of(function), operands),
            node => node,
        };
        if other == node && !node.operands().any(|operand| moved.contains_key(&operand)) {
            continue;
        }
        let operand = |id: NodeId| graph.expr(moved.get(&id).copied().unwrap_or(id));
        moved.insert(id, construct(graph, other, operand).id());
    }
    graph.expr(moved.get(&root).copied().unwrap_or(root))
}

/// The nodes that an expression needs, in order of creation. The time grows with their number, not with that of the
/// graph.
fn below(expression: Expr<'_>) -> Vec<NodeId> {
    let nodes = expression.graph().nodes();
    let mut found = FxHashSet::from_iter([expression.id()]);
    let mut open = vec![expression.id()];
    while let Some(id) = open.pop() {
        open.extend(
            nodes[id.0 as usize]
                .operands()
                .filter(|operand| found.insert(*operand)),
        );
    }
    let mut found: Vec<NodeId> = found.into_iter().collect();
    found.sort_unstable();
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Graph, Symbol};

    #[test]
    fn only_what_changes_is_made_anew() {
        let graph = Graph::new();
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let slope = |function: Function| match function {
            Function::Curve(i) => Function::CurveSlope(i),
            other => other,
        };
        let called = graph.call(Function::Curve(3), &[x + y]);
        let unchanged = (x * y).sqrt();
        let value = graph.call(Function::Coulomb, &[called, unchanged, x]) - unchanged;
        let new = recall(value, slope);
        let called = graph.call(Function::CurveSlope(3), &[x + y]);
        let expected = graph.call(Function::Coulomb, &[called, unchanged, x]) - unchanged;
        assert_eq!(new.id(), expected.id());
        assert_eq!(recall(unchanged, slope).id(), unchanged.id());
    }
}
