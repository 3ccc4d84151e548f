use bryant_generator::expression::{Expr, Function, Graph, NodeId, Symbol, UserCall};

fn inputs(graph: &Graph) -> (Expr<'_>, Expr<'_>, Expr<'_>) {
    let q = |i| graph.symbol(Symbol::Coordinate(i));
    (q(0), q(1), q(2))
}

#[test]
fn zeros_and_ones_vanish() {
    let graph = Graph::new();
    let (x, _, _) = inputs(&graph);
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    assert_eq!((x + zero).id(), x.id());
    assert_eq!((x - zero).id(), x.id());
    assert_eq!((x * one).id(), x.id());
    assert_eq!((x / one).id(), x.id());
    assert!((x * zero).is_zero());
    assert!((x - x).is_zero());
    assert!((zero / x).is_zero());
    assert!(graph.constant(-0.0).is_zero());
    assert_eq!(graph.constant(-0.0).id(), zero.id());
}

#[test]
fn differences_are_shared_up_to_sign() {
    let graph = Graph::new();
    let (x, y, z) = inputs(&graph);
    assert_eq!((y - x).id(), (-(x - y)).id());
    assert_eq!(((y - x) * z).id(), (-(z * (x - y))).id());
    assert_eq!((x + (-y)).id(), (x - y).id());
    assert_eq!(((-x) - y).id(), (-(y + x)).id());
    assert_eq!(((-x) / (-y)).id(), (x / y).id());
    assert_eq!(((-x).sin()).id(), (-(x.sin())).id());
    assert_eq!(((-x).cos()).id(), x.cos().id());
}

#[test]
fn constants_collect() {
    let graph = Graph::new();
    let (x, _, _) = inputs(&graph);
    assert_eq!((2.0 * (3.0 * x)).id(), (6.0 * x).id());
    assert_eq!((2.0 * x + 3.0 * x).id(), (5.0 * x).id());
    assert_eq!((x + x).id(), (2.0 * x).id());
    assert_eq!((-2.0 * x).id(), (-(2.0 * x)).id());
    assert!((2.0 * x - 2.0 * x).is_zero());
}

#[test]
fn names_go_with_signs() {
    let graph = Graph::new();
    let (x, y, _) = inputs(&graph);
    graph.name(y - x, "w");
    assert_eq!(graph.name_of((x - y).id()).as_deref(), Some("minus_w"));
    graph.name(-(x * y), "minus_p");
    assert_eq!(graph.name_of((x * y).id()).as_deref(), Some("p"));
}

#[test]
fn arguments_come_back_in_order_however_many_there_are() {
    for arity in 1..=40 {
        let graph = Graph::new();
        let given: Vec<Expr> = (0..arity)
            // with some equal nodes, also next to each other
            .map(|i| graph.symbol(Symbol::Coordinate(u32::from(i) / 2 % 5)))
            .collect();
        let function = Function::User(UserCall {
            force: 0,
            arguments: arity,
            part: 0,
            parts: 1,
        });
        let found = graph.arguments(graph.call(function, &given).id());
        let given: Vec<NodeId> = given.iter().map(|argument| argument.id()).collect();
        assert_eq!(found, given, "{arity} arguments");
    }
}

#[test]
fn equal_nodes_are_one_node() {
    let graph = Graph::new();
    let (x, y, _) = inputs(&graph);
    let (a, count) = ((x + y) * (y + x), graph.len());
    assert_eq!((x + y).squared().id(), a.id());
    assert_eq!(graph.len(), count);
}
