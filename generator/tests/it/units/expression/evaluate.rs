use bryant_generator::expression::evaluate::{Evaluator, Inputs, NoFunctions, evaluate};
use bryant_generator::expression::{Function, Graph, Node, Symbol};

const INPUTS: Inputs<'static, f64> = Inputs {
    time: 0.25,
    coordinates: &[3.0, 4.0],
    velocities: &[-2.0],
    parameters: &[10.0],
    auxiliaries: &[0.5],
    memory: &[-6.0],
    accelerations: &[],
};

#[test]
fn every_kind_of_node_has_its_value() {
    let graph = Graph::new();
    let [t, x, y, v, p] = [
        Symbol::Time,
        Symbol::Coordinate(0),
        Symbol::Coordinate(1),
        Symbol::Velocity(0),
        Symbol::Parameter(0),
    ]
    .map(|s| graph.symbol(s));
    let fused = graph.intern(Node::MulAdd(x.id(), y.id(), v.id()));
    let call = graph.call(Function::Power, &[x, y]);
    let cases = [
        (t, 0.25),
        (-t, -0.25),
        (x + v, 1.0),
        (y - p, -6.0),
        (x * p, 30.0),
        (x / y, 0.75),
        ((x * x + y * y).sqrt(), 5.0),
        (x.sin(), 3f64.sin()),
        (y.cos(), 4f64.cos()),
        (y.atan2(x), 4f64.atan2(3.0)),
        (v.atan2(v), -0.75 * std::f64::consts::PI),
        (x.max(y), 4.0),
        (x.min(v), -2.0),
        (fused, 10.0),
        (call, 3.0 + 40.0),
        (graph.call(Function::Choose, &[x, y, p, v]), 10.0),
        (graph.call(Function::Choose, &[y, x, p, v]), -2.0),
        (graph.symbol(Symbol::Auxiliary(0)), 0.5),
        (graph.symbol(Symbol::Memory(0)), -6.0),
        (graph.constant(7.0), 7.0),
    ];
    let roots = cases.map(|(e, _)| e.id());
    let functions = |function, a: &[f64]| match function {
        Function::Power => a[0] + 10.0 * a[1],
        Function::Choose if a[0] < a[1] => a[2],
        Function::Choose => a[3],
        _ => f64::NAN,
    };
    let values = evaluate(&graph, &roots, &INPUTS, &functions);
    assert_eq!(values, cases.map(|(_, value)| value));
}

#[test]
fn an_evaluator_forgets_the_state_before() {
    let graph = Graph::new();
    let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let mut evaluator = Evaluator::<f32>::new(&graph, &[(2.0 * x * y).id(), x.id()]);
    for state in [[3.0, 4.0], [5.0, -1.0]] {
        let inputs = Inputs {
            time: 0.0,
            coordinates: &state,
            velocities: &[],
            parameters: &[],
            auxiliaries: &[],
            memory: &[],
            accelerations: &[],
        };
        let [x, y] = state;
        assert_eq!(
            evaluator.evaluate(&inputs, &NoFunctions),
            [2.0 * x * y, x].as_slice()
        );
    }
}

#[test]
fn a_call_that_nobody_answers_is_not_a_number() {
    let graph = Graph::new();
    let call = graph.call(Function::Curve(0), &[graph.symbol(Symbol::Time)]);
    assert!(evaluate(&graph, &[call.id()], &INPUTS, &NoFunctions)[0].is_nan());
}
