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
use crate::expression::live::{Dependence, Live};
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::{Symbol, count::Count};

    fn inputs(graph: &Graph) -> [Expr<'_>; 6] {
        [0, 1, 2, 3, 4, 5].map(|i| graph.symbol(Symbol::Coordinate(i)))
    }

    /// The single root after fusing, as nested text.
    fn fused(graph: &Graph, root: Expr<'_>) -> String {
        let new = fuse(graph, &[root.id()]);
        write(&new.graph, new.roots[0])
    }

    fn write(graph: &Graph, id: NodeId) -> String {
        let w = |id| write(graph, id);
        match graph.node(id) {
            Node::Symbol(Symbol::Coordinate(i)) => "abcdef"[i as usize..][..1].to_string(),
            Node::Constant(bits) => f64::from_bits(bits).to_string(),
            Node::Neg(a) => format!("-{}", w(a)),
            Node::MulAdd(a, b, c) => format!("fma({}, {}, {})", w(a), w(b), w(c)),
            Node::Add(a, b) => format!("({} + {})", w(a), w(b)),
            Node::Sub(a, b) => format!("({} - {})", w(a), w(b)),
            Node::Mul(a, b) => format!("({} * {})", w(a), w(b)),
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn all_four_signs() {
        let graph = Graph::new();
        let [a, b, c, ..] = inputs(&graph);
        assert_eq!(fused(&graph, a * b + c), "fma(a, b, c)");
        assert_eq!(fused(&graph, c - a * b), "fma(-a, b, c)");
        // In the graph a·b − c is −(c − a·b), because older operands come first.
        assert_eq!(fused(&graph, a * b - c), "fma(a, b, -c)");
        assert_eq!(fused(&graph, -(a * b) - c), "fma(-a, b, -c)");
        let product = a * b;
        let newer = c + a;
        assert_eq!(fused(&graph, product - newer), "fma(a, b, -(a + c))");
        assert_eq!(fused(&graph, newer - product), "fma(-a, b, (a + c))");
    }

    #[test]
    fn numbers_take_the_sign() {
        let graph = Graph::new();
        let [a, b, ..] = inputs(&graph);
        assert_eq!(fused(&graph, b - 3.0 * a), "fma(a, -3, b)");
        assert_eq!(fused(&graph, a * b - graph.constant(3.0)), "fma(a, b, -3)");
    }

    #[test]
    fn a_sum_of_products_becomes_a_chain() {
        let graph = Graph::new();
        let [a, b, c, d, e, f] = inputs(&graph);
        assert_eq!(
            fused(&graph, a * b + c * d + e * f),
            "fma(e, f, fma(c, d, (a * b)))"
        );
    }

    #[test]
    fn of_two_products_the_later_is_fused() {
        let graph = Graph::new();
        let [a, b, c, d, ..] = inputs(&graph);
        let late = (a + b) * c;
        let early = a * d;
        assert_eq!(fused(&graph, late + early), "fma(c, (a + b), (a * d))");
    }

    #[test]
    fn a_product_that_is_needed_elsewhere_stays() {
        let graph = Graph::new();
        let [a, b, c, d, ..] = inputs(&graph);
        let product = a * b;
        let roots = [(product + c).id(), (product + d).id()];
        assert_eq!(
            Count::of(&graph, &roots),
            Count::of(&fuse(&graph, &roots).graph, &fuse(&graph, &roots).roots)
        );
        let itself = [product.id(), (product + c).id()];
        assert_eq!(
            fuse(&graph, &itself).graph.len(),
            Live::new(&graph, &itself).nodes().len()
        );
    }

    #[test]
    fn what_is_computed_once_stays_whole() {
        let graph = Graph::new();
        let [a, ..] = inputs(&graph);
        let [p, r] = [0, 1].map(|i| graph.symbol(Symbol::Parameter(i)));
        let product = p * r;
        let roots = [(product + a).id()];
        let new = fuse(&graph, &roots);
        assert_eq!(Count::of(&new.graph, &new.roots).fused, 0);
        let constant_sum = [(product + p).id()];
        let new = fuse(&graph, &constant_sum);
        assert_eq!(Count::of(&new.graph, &new.roots).fused, 1);
    }

    #[test]
    fn names_return_to_what_they_were_given_to() {
        let graph = Graph::new();
        let [a, b, c, ..] = inputs(&graph);
        // In the graph this is −(c − a·b).
        let value = a * b - c;
        graph.name(value, "w");
        let new = fuse(&graph, &[value.id()]);
        assert_eq!(new.graph.name_of(new.roots[0]).as_deref(), Some("w"));
    }

    #[test]
    fn fused_operations_cost_what_they_replace() {
        let graph = Graph::new();
        let [a, b, c, d, e, f] = inputs(&graph);
        let root = (a * b - c * d) * e + f * (a - b * e);
        let before = Count::of(&graph, &[root.id()]);
        let new = fuse(&graph, &[root.id()]);
        let after = Count::of(&new.graph, &new.roots);
        assert_eq!(after.total(), before.total());
        assert_eq!(after.fused, 3);
    }
}
