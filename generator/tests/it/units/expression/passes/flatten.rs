use bryant_generator::expression::liveness::Live;
use bryant_generator::expression::passes::flatten::{Role, Signed, flatten, unsigned};
use bryant_generator::expression::{Graph, NodeId, Symbol};

#[test]
fn sums_are_lists_with_signs() {
    let graph = Graph::new();
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let product = a * d;
    let total = a + b - (c - d) - product;
    let flat = flatten(&graph, &Live::new(&graph, &[total.id()]));
    let base = unsigned(&graph.nodes(), total.id()).1;
    assert!(matches!(flat.role[base.0 as usize], Role::Sum(0)));
    assert_eq!(flat.role[product.id().0 as usize], Role::Term(0));
    let expected = [
        (false, a),
        (false, b),
        (true, c),
        (false, d),
        (true, product),
    ];
    let flipped = unsigned(&graph.nodes(), total.id()).0;
    let expected: Signed = expected.map(|(sign, e)| (sign ^ flipped, e.id().0)).into();
    assert_eq!(flat.sums, [expected]);
}

#[test]
fn what_is_shared_is_an_operand() {
    let graph = Graph::new();
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let shared = a * b;
    let (left, right) = (shared * c, shared * d);
    let flat = flatten(&graph, &Live::new(&graph, &[left.id(), right.id()]));
    let list = |x: [NodeId; 2]| Signed::from([(false, x[0].0), (false, x[1].0)]);
    assert_eq!(
        flat.products,
        [
            list([a.id(), b.id()]),
            list([c.id(), shared.id()]),
            list([d.id(), shared.id()])
        ]
    );
}
