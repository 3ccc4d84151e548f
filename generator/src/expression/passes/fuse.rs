//! Selects fused multiply-adds: a·b + c, a·b − c, c − a·b and −a·b − c, each with one rounding.
//!
//! A product is fused with the sum that uses it, unless it has other users: a fused product is not available to them,
//! and computing it twice would save nothing. Signs are moved to the operands, where they cost nothing: c − a·b =
//! (−a)·b + c, −(a·b + c) = (−a)·b + (−c). A sum of products becomes a chain: a·b + c·d + e·f = fma(e, f, fma(c, d,
//! a·b)).
//!
//! A product that depends on parameters alone is not fused if its user depends on more, because it is computed once per
//! simulation.

use super::rebuild::{Copier, Rewritten, mul_add};
use crate::expression::graph::{Expr, Graph, opposite_name};
use crate::expression::liveness::{Dependence, Live};
use crate::expression::node::{Node, NodeId};

/// The graph with fused multiply-adds. All roots must belong to one evaluation, because a product that another root
/// uses, too, is not fused.
pub fn fuse(graph: &Graph, roots: &[NodeId]) -> Rewritten {
    let live = Live::new(graph, roots);
    let fused = select(graph, &live);
    let mut copy = Copier::new(graph, live.nodes().len());
    for &id in live.nodes() {
        match fused[id.0 as usize] {
            Choice::Keep => copy.keep(id),
            Choice::Absorbed => {}
            Choice::Fuse(product) => {
                copy.enter_section_of(id);
                let new = fused_sum(graph, &copy, graph.node(id), product, false);
                copy.set(id, new);
            }
            Choice::FuseNegative(sum, product) => {
                copy.enter_section_of(id);
                let new = fused_sum(graph, &copy, graph.node(sum), product, true);
                copy.set(id, new);
                if let Some(name) = graph.name_of(sum) {
                    copy.graph()
                        .name(copy.graph().expr(new), opposite_name(&name));
                }
            }
        }
    }
    copy.finish(roots)
}

/// How a node is translated.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Choice {
    Keep,
    /// A product or a negated sum, which is computed within its only user.
    Absorbed,
    /// A sum or difference that is fused with this product, one of its operands.
    Fuse(NodeId),
    /// The negative of this sum, fused with this product.
    FuseNegative(NodeId, NodeId),
}

fn select(graph: &Graph, live: &Live) -> Vec<Choice> {
    let nodes = graph.nodes();
    let mut choice = vec![Choice::Keep; nodes.len()];
    let mut latency = vec![0u32; nodes.len()];
    for &id in live.nodes() {
        let at = id.0 as usize;
        let node = nodes[at];
        let ready = |id: NodeId| latency[id.0 as usize];
        if let Node::Add(a, b) | Node::Sub(a, b) = node {
            let free = |operand: &NodeId| {
                let dependence = live.dependence(*operand);
                matches!(nodes[operand.0 as usize], Node::Mul(..))
                    && live.uses(*operand) == 1
                    && (!dependence.within(Dependence::PARAMETERS)
                        || live.dependence(id).within(Dependence::PARAMETERS))
            };
            // Of two products, the one that is ready later is fused; the other one is computed in the meantime.
            let product = [a, b]
                .into_iter()
                .filter(free)
                .max_by_key(|&p| (ready(p), p));
            if let Some(product) = product {
                choice[at] = Choice::Fuse(product);
                choice[product.0 as usize] = Choice::Absorbed;
                let addend = if product == a { b } else { a };
                // Without fusion, the product alone would take as long as the fused operation.
                latency[at] = ready(product).max(ready(addend) + cost(&node));
                continue;
            }
        }
        if let Node::Neg(sum) = node
            && let Choice::Fuse(product) = choice[sum.0 as usize]
            && live.uses(sum) == 1
        {
            choice[at] = Choice::FuseNegative(sum, product);
            choice[sum.0 as usize] = Choice::Absorbed;
            latency[at] = ready(sum);
            continue;
        }
        latency[at] = node.operands().map(ready).max().unwrap_or(0) + cost(&node);
    }
    choice
}

/// ±(± a · b ± c), for a sum or difference that has the product a · b as an operand.
fn fused_sum(graph: &Graph, copy: &Copier<'_>, sum: Node, product: NodeId, negate: bool) -> NodeId {
    let [x, y] = match sum {
        Node::Add(x, y) | Node::Sub(x, y) => [x, y],
        other => unreachable!("only sums are chosen, not {other:?}"),
    };
    let first = x == product;
    let minus_y = matches!(sum, Node::Sub(..));
    let mut factors = graph.node(product).operands().map(|id| copied(copy, id));
    let (Some(mut a), Some(mut b)) = (factors.next(), factors.next()) else {
        unreachable!("a product has two factors")
    };
    let mut addend = copied(copy, if first { y } else { x });
    if negate != (minus_y && !first) {
        // The sign of a constant costs nothing.
        match b.as_constant() {
            Some(_) => b = -b,
            None => a = -a,
        }
    }
    if negate != (minus_y && first) {
        addend = -addend;
    }
    mul_add(a, b, addend).id()
}

/// The copy of an operand that was not absorbed. Operands are older than their users, so it exists already.
fn copied<'c>(copy: &'c Copier<'_>, id: NodeId) -> Expr<'c> {
    copy.get(id)
        .expect("operands are copied before their users")
}

/// The approximate latency in cycles of current processors. It only decides which of two products is fused.
fn cost(node: &Node) -> u32 {
    match node {
        Node::Constant(_) | Node::Symbol(_) => 0,
        Node::Neg(_) => 1,
        Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::MulAdd(..) => 4,
        Node::Max(..) | Node::Min(..) => 4,
        Node::Div(..) => 14,
        Node::Sqrt(_) => 18,
        Node::Sin(_) | Node::Cos(_) | Node::Atan2(..) | Node::Call(..) => 40,
        Node::Arguments(_) => 0,
    }
}
