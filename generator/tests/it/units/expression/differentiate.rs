use bryant_generator::expression::differentiate::{
    Known, NotDifferentiable, differentiate, differentiate_almost_everywhere, differentiate_along,
    jacobian,
};
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::expression::{Expr, Function, Graph, NodeId, Symbol};

const X: Symbol = Symbol::Coordinate(0);
const Y: Symbol = Symbol::Coordinate(1);

/// Checks that d/dx of `f`(x, y) is the node that `expected` makes.
fn check(
    f: impl for<'g> Fn(Expr<'g>, Expr<'g>) -> Expr<'g>,
    expected: impl for<'g> Fn(Expr<'g>, Expr<'g>) -> Expr<'g>,
) {
    let graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    let derivative = differentiate(&graph, &[f(x, y).id()], X);
    assert_eq!(derivative, Ok(vec![expected(x, y).id()]));
}

fn number<'g>(x: Expr<'g>, value: f64) -> Expr<'g> {
    x.graph().constant(value)
}

#[test]
fn a_choice_by_what_stays_is_differentiated_by_its_sides() {
    fn choice<'g>(then: Expr<'g>, otherwise: Expr<'g>) -> NodeId {
        let graph = then.graph();
        let (zero, memory) = (graph.constant(0.0), graph.symbol(Symbol::Memory(0)));
        graph
            .call(Function::Choose, &[zero, memory, then, otherwise])
            .id()
    }
    let graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    let derivative = differentiate(&graph, &[choice(x * x, x * y)], X);
    assert_eq!(derivative, Ok(vec![choice(2.0 * x, y)]));
    let by_x = graph.call(Function::Choose, &[x, y, y, x]).id();
    assert!(differentiate(&graph, &[by_x], X).is_err());
}

#[test]
fn rules_of_the_calculus() {
    check(|x, _| x, |x, _| number(x, 1.0));
    check(|_, y| y.sin(), |x, _| number(x, 0.0));
    check(|x, y| x * y + x, |x, y| y + number(x, 1.0));
    check(|x, y| y - x, |x, _| number(x, -1.0));
    check(|x, _| x * x, |x, _| 2.0 * x);
    check(|x, _| x.sin(), |x, _| x.cos());
    check(|x, _| (3.0 * x).cos(), |x, _| -3.0 * (3.0 * x).sin());
    check(|x, _| x.sqrt(), |x, _| number(x, 0.5) / x.sqrt());
    check(|x, y| x / y, |_, y| y.recip());
    check(|x, y| y / x, |x, y| -((y / x) / x));
    check(|x, y| y.atan2(x), |x, y| -(y / (x * x + y * y)));
    check(|x, y| x.atan2(y), |x, y| y / (x * x + y * y));
}

#[test]
fn curves_have_slopes_and_these_second_derivatives() {
    let curve = |function: Function, x: Expr<'_>| x.graph().call(function, &[x]).id();
    let graph = Graph::new();
    let x = graph.symbol(X);
    let roots = [
        curve(Function::Curve(2), 2.0 * x),
        curve(Function::CurveSlope(2), x),
        curve(Function::CurveInverse(2), x),
    ];
    let inverse = graph.expr(roots[2]);
    let expected = vec![
        (2.0 * graph.expr(curve(Function::CurveSlope(2), 2.0 * x))).id(),
        curve(Function::CurveSecondDerivative(2), x),
        graph
            .expr(curve(Function::CurveSlope(2), inverse))
            .recip()
            .id(),
    ];
    assert_eq!(differentiate(&graph, &roots, X), Ok(expected));
}

#[test]
fn what_branches_is_refused_by_name_unless_it_does_not_matter() {
    let graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    let law = graph.call(Function::Power, &[y, x]);
    for (value, what) in [
        (x.max(y), "max"),
        (x.min(y), "min"),
        (law, "force::power::power"),
    ] {
        let refused = differentiate(&graph, &[(value * x).id()], X);
        assert_eq!(
            refused,
            Err(NotDifferentiable {
                node: value.id(),
                what
            })
        );
    }
    let time = differentiate(&graph, &[(law * x.max(y)).id()], Symbol::Time);
    assert_eq!(time, Ok(vec![graph.constant(0.0).id()]));
    let parallel = (x + y.sin()).max(x - y.cos());
    assert_eq!(
        differentiate(&graph, &[parallel.id()], X),
        Ok(vec![graph.constant(1.0).id()])
    );
}

#[test]
fn almost_everywhere_the_side_that_is_taken_counts() {
    let graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    let given = x * x + y;
    let known = Known::from_iter([(given.id(), 7.0 * y)]);
    let roots = [
        x.max(2.0 * y),
        x.min(2.0 * y),
        graph.call(Function::Choose, &[x, y, x * y, 3.0 * x]),
        graph.call(Function::Power, &[x, graph.constant(2.5)]),
        graph.call(Function::Power, &[graph.constant(2.0), x]),
        x * given,
    ]
    .map(|root| root.id());
    let direction = |s| graph.constant(if s == X { 1.0 } else { 0.0 });
    let found = differentiate_almost_everywhere(&graph, &roots, &known, direction);
    let found = found.expect("derivatives");
    let at = |x: f64, y: f64| {
        let inputs = Inputs {
            time: 0.0,
            coordinates: &[x, y],
            velocities: &[],
            parameters: &[],
            auxiliaries: &[],
            memory: &[],
            accelerations: &[],
        };
        let call = |function: Function, a: &[f64]| match (function, a) {
            (Function::Power, &[x, y]) => libm::pow(x, y),
            (_, &[a, b, then, otherwise]) => {
                if a < b {
                    then
                } else {
                    otherwise
                }
            }
            _ => f64::NAN,
        };
        evaluate(&graph, &found, &inputs, &call)
    };
    let power = 16.0 * std::f64::consts::LN_2;
    assert_eq!(at(4.0, 1.0), [1.0, 0.0, 3.0, 20.0, power, 17.0 + 28.0]);
    assert_eq!(at(4.0, 5.0), [0.0, 1.0, 5.0, 20.0, power, 21.0 + 140.0]);
    let exponent = graph.call(Function::Power, &[y, x]).id();
    assert!(differentiate_almost_everywhere(&graph, &[exponent], &known, direction).is_err());
}

#[test]
fn a_direction_gives_the_time_derivative() {
    let graph = Graph::new();
    let (x, v) = (graph.symbol(X), graph.symbol(Symbol::Velocity(0)));
    let rate = differentiate_along(&graph, &[(x * x).id()], |symbol| match symbol {
        X => v,
        _ => graph.constant(0.0),
    });
    assert_eq!(rate, Ok(vec![(2.0 * (x * v)).id()]));
}

#[test]
fn columns_of_the_jacobian_are_derivatives() {
    let graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    let rows = jacobian(&graph, &[(x * y).id(), x.id()], &[X, Y]);
    let [zero, one] = [0.0, 1.0].map(|c| graph.constant(c).id());
    assert_eq!(rows, Ok(vec![vec![y.id(), x.id()], vec![one, zero]]));
}

#[test]
fn deep_expressions_do_not_overflow_the_stack() {
    let graph = Graph::new();
    let (x, y) = (graph.symbol(X), graph.symbol(Y));
    let deep = (0..200_000).fold(x, |sum, _| (sum + y) * y);
    assert!(differentiate(&graph, &[deep.id()], X).is_ok());
}
