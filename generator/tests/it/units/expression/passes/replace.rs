use bryant_generator::expression::passes::{replace, restore};
use bryant_generator::expression::{Graph, Node, Symbol};
use rustc_hash::FxHashMap;

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
fn a_restored_value_is_that_of_the_other_graph() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let known = (x * y).sqrt();
    let value = known / y + x * y;
    let stand_in = Symbol::Parameter(7);
    let by = FxHashMap::from_iter([(known.id(), (stand_in, false))]);
    let without = replace(&graph, &[value.id()], &by);
    let by = FxHashMap::from_iter([(stand_in, known.id())]);
    let again = restore(without, &graph, &by);
    assert_eq!(again.graph.len(), graph.len());
    let Node::Add(product, quotient) = again.graph.node(again.roots[0]) else {
        panic!("it is a sum, of older terms first");
    };
    let Node::Div(root, _) = again.graph.node(quotient) else {
        panic!("of a quotient");
    };
    assert_eq!(again.graph.node(root), Node::Sqrt(product));
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
