use bryant_generator::expression::count::Count;
use bryant_generator::expression::liveness::Live;
use bryant_generator::expression::passes::fuse;
use bryant_generator::expression::{Expr, Graph, Node, NodeId, Symbol};

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
