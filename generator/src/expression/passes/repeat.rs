//! Computes values a second time if that is less work than storing them.
//!
//! A long function goes through the elements from the leaves to the root and back again. On the way back it needs
//! values of an element that were computed on the first way, and have left the first-level cache by then. A value that
//! takes few operations on inputs alone, such as the axes of an element, is better computed again from the inputs.

use super::rebuild::{Copier, Rewritten};
use crate::expression::graph::Graph;
use crate::expression::node::{Node, NodeId};
use std::collections::BTreeSet;

/// Number of operations that take less time than writing a value that leaves the first-level cache and reading it
/// again. In a chain of 100 elements, 38 operations avoid storing 12 values. Measured: the evaluation of one state then
/// takes as long as before; that of eight states in registers takes a fifth less, on a processor that does one
/// operation on such registers per cycle.
const WORTH: usize = 4;

/// The same values, some of them computed twice. `blocks` are all operations that the roots need, in the order of their
/// evaluation; each block has the operations of one owner.
///
/// A value that a block reads from an earlier one is computed again in the last block of the same owner before or at
/// the reader, if it is made from inputs by sums and products of that owner alone, if no call has it as an argument,
/// and if that is worth it in this block.
pub fn repeat(graph: &Graph, roots: &[NodeId], blocks: &[Vec<NodeId>]) -> Rewritten {
    let repeated = repeated(graph, blocks);
    let mut copy = Copier::new(graph, graph.len());
    let operations = blocks.iter().flatten();
    let operands = operations.flat_map(|&id| graph.node(id).operands());
    let inputs: BTreeSet<NodeId> = operands
        .chain(roots.iter().copied())
        .filter(|&id| graph.node(id).is_leaf())
        .collect();
    for input in inputs {
        copy.keep(input);
    }
    for (block, repeated) in blocks.iter().zip(repeated) {
        // From here on, users get the new copies.
        for id in repeated {
            copy.repeat(id);
        }
        for &id in block {
            copy.keep(id);
        }
    }
    copy.finish(roots)
}

/// For each block, the operations that are repeated in it, in order.
fn repeated(graph: &Graph, blocks: &[Vec<NodeId>]) -> Vec<BTreeSet<NodeId>> {
    let owners = graph.owners();
    let owner = |id: NodeId| owners[graph.section_of(id)];
    let mut block_of: Vec<Option<usize>> = vec![None; graph.len()];
    let mut blocks_of: Vec<Vec<usize>> = vec![Vec::new(); owners.len()];
    for (number, block) in blocks.iter().enumerate() {
        for id in block {
            block_of[id.0 as usize] = Some(number);
        }
        if let Some(&first) = block.first() {
            blocks_of[owner(first)].push(number);
        }
    }

    // Operands of calls are not repeated: results of one call, and sine and cosine of one operand, are computed
    // together, so they must keep a common operand.
    let of_calls: BTreeSet<NodeId> = (blocks.iter().flatten())
        .map(|&id| graph.node(id))
        .filter(is_call)
        .flat_map(|node| node.operands())
        .collect();

    // values made from inputs by sums and products of one owner
    let mut cheap = vec![false; graph.len()];
    for &id in blocks.iter().flatten() {
        let node = graph.node(id);
        let own =
            |o: NodeId| graph.node(o).is_leaf() || cheap[o.0 as usize] && owner(o) == owner(id);
        let simple = matches!(
            node,
            Node::Neg(_) | Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::MulAdd(..)
        );
        cheap[id.0 as usize] = simple && !of_calls.contains(&id) && node.operands().all(own);
    }

    let mut wanted: Vec<BTreeSet<NodeId>> = vec![BTreeSet::new(); blocks.len()];
    for (reader, block) in blocks.iter().enumerate() {
        for id in block.iter().flat_map(|&id| graph.node(id).operands()) {
            let Some(made) = block_of[id.0 as usize].filter(|_| cheap[id.0 as usize]) else {
                continue;
            };
            let up_to_reader = |&&block: &&usize| block <= reader;
            let last = blocks_of[owner(id)].iter().rev().find(up_to_reader);
            if let Some(&last) = last.filter(|&&last| last > made) {
                wanted[last].insert(id);
            }
        }
    }
    wanted.iter().map(|values| worth(graph, values)).collect()
}

/// The operations that compute again those of the `values` for which that is worth it. The time is quadratic, but one
/// owner has few values.
fn worth(graph: &Graph, values: &BTreeSet<NodeId>) -> BTreeSet<NodeId> {
    let mut values = values.clone();
    // A value is stored if it takes many operations that the others do not need.
    for value in values.clone() {
        let with = cost(graph, &operations(graph, &values));
        values.remove(&value);
        let without = cost(graph, &operations(graph, &values));
        if with <= without + WORTH {
            values.insert(value);
        }
    }
    let operations = operations(graph, &values);
    match cost(graph, &operations) <= WORTH * values.len() {
        true => operations,
        false => BTreeSet::new(),
    }
}

/// All operations that compute these values from inputs.
fn operations(graph: &Graph, values: &BTreeSet<NodeId>) -> BTreeSet<NodeId> {
    let mut found = values.clone();
    let mut left: Vec<NodeId> = values.iter().copied().collect();
    while let Some(id) = left.pop() {
        for operand in graph.node(id).operands() {
            if !graph.node(operand).is_leaf() && found.insert(operand) {
                left.push(operand);
            }
        }
    }
    found
}

/// The number of operations; a sign does not count.
fn cost(graph: &Graph, operations: &BTreeSet<NodeId>) -> usize {
    let signs = |id: &&NodeId| matches!(graph.node(**id), Node::Neg(_));
    operations.len() - operations.iter().filter(signs).count()
}

fn is_call(node: &Node) -> bool {
    matches!(
        node,
        Node::Sin(_) | Node::Cos(_) | Node::Call(..) | Node::Arguments(_)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::graph::Expr;
    use crate::expression::live::Live;
    use crate::expression::node::Symbol;

    /// Blocks in order of creation: a new one begins whenever the owner changes.
    fn in_order(graph: &Graph, roots: &[NodeId]) -> Vec<Vec<NodeId>> {
        let owners = graph.owners();
        let live = Live::new(graph, roots);
        let operations: Vec<NodeId> = (live.nodes().iter().copied())
            .filter(|&id| !graph.node(id).is_leaf())
            .collect();
        let owner = |id: &NodeId| owners[graph.section_of(*id)];
        let blocks = operations.chunk_by(|a, b| owner(a) == owner(b));
        blocks.map(<[NodeId]>::to_vec).collect()
    }

    fn needed(graph: &Graph, roots: &[NodeId]) -> usize {
        Live::new(graph, roots).nodes().len()
    }

    /// A value of the leaf, used through the root and back at the leaf, where `again` is used, too.
    fn there_and_back<'g>(graph: &'g Graph, again: Expr<'g>) -> Expr<'g> {
        let x = graph.symbol(Symbol::Coordinate(0));
        graph.section("element leaf: force");
        let there = again.sqrt();
        graph.section("element root: elimination");
        let root = there / x;
        graph.section("element leaf: acceleration");
        root * again
    }

    #[test]
    fn what_is_made_of_inputs_is_made_again_on_the_way_back() {
        let graph = Graph::new();
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        graph.section("element leaf: axes");
        let axis = x * y + x;
        graph.name(axis, "axis");
        let back = there_and_back(&graph, axis);
        let roots = [back.id()];
        let new = repeat(&graph, &roots, &in_order(&graph, &roots));
        // a product and a sum
        assert_eq!(new.graph.len(), needed(&graph, &roots) + 2);
        let named = (0..new.graph.len() as u32).map(NodeId);
        let named: Vec<NodeId> = named
            .filter(|&id| new.graph.name_of(id).as_deref() == Some("axis"))
            .collect();
        let [first, second] = named[..] else {
            panic!("the axis is there twice: {named:?}");
        };
        assert_ne!(first, second);
        assert_eq!(new.graph.section_of(first), new.graph.section_of(second));
        let read: Vec<NodeId> = new.graph.node(new.roots[0]).operands().collect();
        assert!(read.contains(&second) && !read.contains(&first), "{read:?}");
    }

    #[test]
    fn what_is_much_work_or_made_by_others_is_kept() {
        // more operations than a value is worth
        let much = |graph: &Graph| {
            let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
            graph.section("element leaf: axes");
            let mut value = x * y;
            for _ in 0..WORTH {
                value = value * x + y;
            }
            there_and_back(graph, value).id()
        };
        // neither sum nor product
        let root = |graph: &Graph| {
            let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
            graph.section("element leaf: axes");
            there_and_back(graph, (x + y).sqrt()).id()
        };
        // made by another element
        let other = |graph: &Graph| {
            let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
            graph.section("element other: axes");
            let of_other = x * y;
            graph.section("element leaf: axes");
            there_and_back(graph, of_other + x).id()
        };
        // one sine and cosine of it
        let argument = |graph: &Graph| {
            let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
            graph.section("element leaf: axes");
            let angle = x + y;
            let there = angle.sin();
            graph.section("element root: elimination");
            let root = there.sqrt();
            graph.section("element leaf: acceleration");
            (root * angle.cos() * angle).id()
        };
        for make in [&much as &dyn Fn(&Graph) -> NodeId, &root, &other, &argument] {
            let graph = Graph::new();
            let roots = [make(&graph)];
            let new = repeat(&graph, &roots, &in_order(&graph, &roots));
            assert_eq!(new.graph.len(), needed(&graph, &roots));
        }
    }

    #[test]
    fn few_values_pay_for_each_other() {
        // three values that share five operations: repeating one of them alone would not be worth it
        let graph = Graph::new();
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        graph.section("element leaf: axes");
        let common = ((x * y + x) * y + x) * y;
        let axes = [common + x, common + y, common - x];
        graph.section("element leaf: force");
        let there = (axes[0] + axes[1] + axes[2]).sqrt();
        graph.section("element root: elimination");
        let root = there / x;
        graph.section("element leaf: acceleration");
        let roots = axes.map(|axis| (root * axis).id());
        let new = repeat(&graph, &roots, &in_order(&graph, &roots));
        assert_eq!(new.graph.len(), needed(&graph, &roots) + 8);
    }
}
