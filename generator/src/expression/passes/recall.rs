//! Replaces functions that are called, in expressions of a graph that continues to grow.

use super::rebuild::construct;
use crate::expression::graph::{Expr, Graph};
use crate::expression::node::{Function, Node, NodeId};
use rustc_hash::{FxHashMap, FxHashSet};

/// Expressions of one graph with each called function replaced by `of` of it. What several expressions have in common
/// is looked at once.
pub struct Recall<'g, F> {
    graph: &'g Graph,
    of: F,
    /// The number of nodes that were searched for calls that change.
    searched: usize,
    /// The oldest call that changes: what is older stays as it is.
    first: Option<usize>,
    /// The nodes that were looked at.
    known: FxHashSet<NodeId>,
    /// The new nodes of those that changed.
    moved: FxHashMap<NodeId, NodeId>,
}

impl<'g, F: Fn(Function) -> Function> Recall<'g, F> {
    /// No expression yet.
    pub fn new(graph: &'g Graph, of: F) -> Self {
        Recall {
            graph,
            of,
            searched: 0,
            first: None,
            known: FxHashSet::default(),
            moved: FxHashMap::default(),
        }
    }

    /// The expression with other functions. Nodes that call no replaced function stay as they are.
    pub fn expression(&mut self, expression: Expr<'g>) -> Expr<'g> {
        let (graph, root) = (self.graph, expression.id());
        for id in self.anew(root) {
            let node = graph.node(id);
            let other = match node {
                Node::Call(function, operands) => Node::Call((self.of)(function), operands),
                node => node,
            };
            let moved = &self.moved;
            if other == node && !node.operands().any(|operand| moved.contains_key(&operand)) {
                continue;
            }
            let operand = |id: NodeId| graph.expr(moved.get(&id).copied().unwrap_or(id));
            let new = construct(graph, other, operand).id();
            self.moved.insert(id, new);
        }
        graph.expr(self.moved.get(&root).copied().unwrap_or(root))
    }

    /// The nodes that an expression needs, that may change, and that were not looked at, in order of creation.
    fn anew(&mut self, root: NodeId) -> Vec<NodeId> {
        let graph = self.graph;
        let nodes = graph.nodes();
        let changes = |node: &Node| matches!(node, Node::Call(function, _) if (self.of)(*function) != *function);
        if self.first.is_none() {
            let found = nodes[self.searched..].iter().position(changes);
            self.first = found.map(|at| self.searched + at);
            self.searched = nodes.len();
        }
        let Some(first) = self.first else {
            return Vec::new();
        };
        let mut found = Vec::new();
        let mut open = vec![root];
        while let Some(id) = open.pop() {
            if id.0 as usize >= first && self.known.insert(id) {
                found.push(id);
                open.extend(nodes[id.0 as usize].operands());
            }
        }
        found.sort_unstable();
        found
    }
}
