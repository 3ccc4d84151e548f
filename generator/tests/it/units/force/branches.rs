use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::expression::{Expr, Function, Graph, Symbol};
use bryant_generator::force::branches::{coulomb, coulomb_scale, one_sided};

/// A law of three numbers at three numbers.
fn at(law: for<'g> fn(Expr<'g>, Expr<'g>, Expr<'g>) -> Expr<'g>, numbers: [f64; 3]) -> f64 {
    let graph = Graph::new();
    let [a, b, c] = [0, 1, 2].map(|i| graph.symbol(Symbol::Coordinate(i)));
    let inputs = Inputs {
        time: 0.0,
        coordinates: &numbers,
        velocities: &[],
        parameters: &[],
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    // as `bryant_runtime::force::switch::choose`
    let taint = |x: f64| if x.is_finite() { 0.0 } else { f64::NAN };
    let choose = |function, a: &[f64]| match (function, a) {
        (Function::Choose, &[a, b, then, _]) if a < b => then,
        (Function::Choose, &[a, b, _, otherwise]) => otherwise + (taint(a) + taint(b)),
        _ => unreachable!("these laws call nothing else"),
    };
    evaluate(&graph, &[law(a, b, c).id()], &inputs, &choose)[0]
}

#[test]
fn friction_opposes_sliding_up_to_its_limit() {
    assert_eq!(at(coulomb, [5.0, 2.0, 0.1]), -5.0);
    assert_eq!(at(coulomb, [5.0, -2.0, 0.1]), 5.0);
    assert_eq!(at(coulomb, [5.0, 0.05, 0.1]), -2.5);
    assert_eq!(at(coulomb, [5.0, 0.0, 0.1]), 0.0);
    assert!(at(coulomb, [5.0, f64::NAN, 0.1]).is_nan());
}

#[test]
fn vector_friction_has_the_magnitude_of_its_limit() {
    let scale = at(coulomb_scale, [10.0, 25.0, 0.01]);
    assert_eq!((scale * 3.0).hypot(scale * -4.0), 10.0);
    assert_eq!(at(coulomb_scale, [10.0, 0.0, 0.5]), 20.0);
    assert!(at(coulomb_scale, [10.0, f64::NAN, 0.5]).is_nan());
    for speed in [0.0_f64, 0.03, 0.1, 0.7] {
        let vector = -at(coulomb_scale, [4.0, speed * speed, 0.1]) * speed;
        assert!((vector - at(coulomb, [4.0, speed, 0.1])).abs() <= 8.0 * f64::EPSILON);
    }
}

#[test]
fn what_only_pushes_is_0_while_apart_and_never_pulls() {
    assert_eq!(at(one_sided, [0.01, 500.0, 100.0]), 600.0);
    assert_eq!(at(one_sided, [0.01, 500.0, -600.0]), 0.0);
    assert_eq!(at(one_sided, [0.0, 500.0, 100.0]), 0.0);
    assert_eq!(at(one_sided, [-0.01, f64::NAN, f64::INFINITY]), 0.0);
    assert!(at(one_sided, [0.01, f64::NAN, 0.0]).is_nan());
    assert!(at(one_sided, [f64::NAN, 1.0, 0.0]).is_nan());
}
