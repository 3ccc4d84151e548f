use bryant_generator::expression::liveness::{Dependence, Live};
use bryant_generator::expression::{Expr, Function, Graph, Symbol};

fn inputs(graph: &Graph) -> [Expr<'_>; 4] {
    [
        Symbol::Parameter(0),
        Symbol::Parameter(1),
        Symbol::Coordinate(0),
        Symbol::Time,
    ]
    .map(|s| graph.symbol(s))
}

#[test]
fn only_what_roots_need_is_live() {
    let graph = Graph::new();
    let [p, _, q, t] = inputs(&graph);
    let needed = p * q + p;
    let _unneeded = (q * t).sin();
    let live = Live::new(&graph, &[needed.id()]);
    assert_eq!(
        live.nodes(),
        [p.id(), q.id(), (p * q).id(), needed.id()].as_slice()
    );
    assert!(!live.contains(t.id()));
}

#[test]
fn uses_count_operand_places_and_roots() {
    let graph = Graph::new();
    let [p, _, q, _] = inputs(&graph);
    let square = q * q;
    let total = square + p;
    let live = Live::new(&graph, &[total.id(), square.id(), square.id()]);
    assert_eq!(live.uses(q.id()), 2);
    assert_eq!(live.uses(square.id()), 3);
    assert_eq!(live.uses(total.id()), 1);
    assert_eq!(live.uses(p.id()), 1);
}

#[test]
fn dependence_is_the_union_over_operands() {
    let graph = Graph::new();
    let [p, _, q, t] = inputs(&graph);
    let value = p * (q + t).sin();
    let live = Live::new(&graph, &[value.id()]);
    let all = Dependence::PARAMETERS | Dependence::COORDINATES | Dependence::TIME;
    assert_eq!(live.dependence(value.id()), all);
    assert_eq!(
        live.dependence(value.id()).to_string(),
        "parameters, time, coordinates"
    );
    assert!(Dependence::PARAMETERS.within(all));
    assert!(!all.within(Dependence::PARAMETERS));
    assert!(Dependence::CONSTANT.within(Dependence::CONSTANT));
}

#[test]
fn hoistable_values_are_the_largest_of_parameters_alone() {
    let graph = Graph::new();
    let [p, r, q, _] = inputs(&graph);
    let inner = p * r;
    let outer = (inner + p).sqrt();
    let alone = r.sin();
    let value = outer * q - p * q;
    let live = Live::new(&graph, &[value.id(), (-alone).id(), p.id()]);
    assert_eq!(live.hoistable(&graph), [outer.id(), alone.id()]);
}

#[test]
fn a_curve_at_a_number_is_computed_once() {
    let graph = Graph::new();
    let [_, _, q, _] = inputs(&graph);
    let call = graph.call(Function::Curve(0), &[graph.constant(0.5)]);
    let value = call * q;
    let live = Live::new(&graph, &[value.id()]);
    assert_eq!(live.hoistable(&graph), [call.id()]);
}
