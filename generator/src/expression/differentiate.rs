//! Derivatives of expressions, as expressions of the same graph: forward mode, node by node, each node once.
//!
//! ```text
//! (a b)' = a' b + a b'     (a/b)' = (a' − (a/b) b') / b     √a' = a' / (2 √a)
//! atan2(y, x)' = (x y' − y x') / (x² + y²)
//! ```
//!
//! The derivative is along a direction: with ẋ for the symbols x, ḟ = Σ ∂f/∂x ẋ. A derivative with respect to one
//! symbol has the direction (0 … 1 … 0). A time derivative has the direction ṫ = 1, q̇ = the coordinate rates, v̇ = the
//! accelerations.
//!
//! The derivative of a curve is its slope, which is differentiable except at the points. The larger of two values is
//! differentiable here only if both have the same derivative, because a derivative that is correct on one side alone
//! would be a trap, unless it is asked for ([`differentiate_almost_everywhere`]). The same holds for force laws with
//! branches. With dual numbers, all of these can be differentiated at run time.

use super::graph::{Expr, Graph, choose};
use super::node::{Function, Node, NodeId, Symbol};
use super::passes::needed;
use rustc_hash::FxHashMap;

/// A node that cannot be differentiated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} is not differentiable in symbols; evaluate it over dual numbers instead")]
pub struct NotDifferentiable {
    /// The node that cannot be differentiated.
    pub node: NodeId,
    /// Name of the function.
    pub what: &'static str,
}

/// ∂(roots)/∂(symbol), in the order of the roots.
pub fn differentiate(
    graph: &Graph,
    roots: &[NodeId],
    symbol: Symbol,
) -> Result<Vec<NodeId>, NotDifferentiable> {
    differentiate_along(graph, roots, |s| {
        graph.constant(if s == symbol { 1.0 } else { 0.0 })
    })
}

/// ∂(roots)/∂(symbols), with a row for each root and a column for each symbol.
pub fn jacobian(
    graph: &Graph,
    roots: &[NodeId],
    symbols: &[Symbol],
) -> Result<Vec<Vec<NodeId>>, NotDifferentiable> {
    let mut rows = vec![Vec::with_capacity(symbols.len()); roots.len()];
    for &symbol in symbols {
        for (row, entry) in rows.iter_mut().zip(differentiate(graph, roots, symbol)?) {
            row.push(entry);
        }
    }
    Ok(rows)
}

/// Σ ∂(roots)/∂(symbol) · direction(symbol), in the order of the roots. The components of the direction may be any
/// expressions.
pub fn differentiate_along<'g>(
    graph: &'g Graph,
    roots: &[NodeId],
    direction: impl Fn(Symbol) -> Expr<'g>,
) -> Result<Vec<NodeId>, NotDifferentiable> {
    along(graph, roots, Kinks::Refused, &Known::default(), direction)
}

/// Derivatives that are known, by node.
pub type Known<'g> = FxHashMap<NodeId, Expr<'g>>;

/// The same as [`differentiate_along`] with the derivatives of some nodes known, and almost everywhere: where values
/// are chosen by a condition, their derivatives are chosen by the same condition. So at a kink the derivative is that
/// of the side whose value is taken, as with dual numbers.
pub fn differentiate_almost_everywhere<'g>(
    graph: &'g Graph,
    roots: &[NodeId],
    known: &Known<'g>,
    direction: impl Fn(Symbol) -> Expr<'g>,
) -> Result<Vec<NodeId>, NotDifferentiable> {
    along(graph, roots, Kinks::BySide, known, direction)
}

/// What the derivative is where two values are compared.
#[derive(Clone, Copy, PartialEq)]
enum Kinks {
    /// There is none.
    Refused,
    /// That of the side that is taken.
    BySide,
}

fn along<'g>(
    graph: &'g Graph,
    roots: &[NodeId],
    kinks: Kinks,
    known: &Known<'g>,
    direction: impl Fn(Symbol) -> Expr<'g>,
) -> Result<Vec<NodeId>, NotDifferentiable> {
    // holds only derivatives that are not 0, because few nodes depend on a single symbol
    let mut derivative: Known<'g> = FxHashMap::default();
    for id in needed(graph, roots, known) {
        let node = graph.node(id);
        if let Some(own) = known.get(&id) {
            if !own.is_zero() {
                derivative.insert(id, *own);
            }
        } else if let Node::Symbol(symbol) = node {
            let own = direction(symbol);
            if !own.is_zero() {
                derivative.insert(id, own);
            }
        } else if node.operands().any(|a| derivative.contains_key(&a)) {
            let d = |a: NodeId| {
                let zero = || graph.constant(0.0);
                derivative.get(&a).copied().unwrap_or_else(zero)
            };
            let own = match (kinks, by_side(graph, id, node, &d)) {
                (Kinks::BySide, Some(own)) => own,
                _ => rule(graph, id, node, d)?,
            };
            if !own.is_zero() {
                derivative.insert(id, own);
            }
        }
    }
    let zero = graph.constant(0.0);
    let of = |root: &NodeId| derivative.get(root).unwrap_or(&zero).id();
    Ok(roots.iter().map(of).collect())
}

/// The derivative of a value that is chosen by a comparison, from those of its operands; `None` for other nodes.
fn by_side<'g>(
    graph: &'g Graph,
    id: NodeId,
    node: Node,
    d: &impl Fn(NodeId) -> Expr<'g>,
) -> Option<Expr<'g>> {
    let e = |a: NodeId| graph.expr(a);
    match node {
        // the comparisons of the runtime
        Node::Max(a, b) => Some(choose(e(a), e(b), d(b), d(a))),
        Node::Min(a, b) => Some(choose(e(b), e(a), d(b), d(a))),
        Node::Call(Function::Choose, _) => match graph.arguments(id)[..] {
            [a, b, then, otherwise] => Some(choose(e(a), e(b), d(then), d(otherwise))),
            _ => None,
        },
        Node::Call(Function::Power, [base, exponent, _]) if d(exponent).is_zero() => {
            let less = e(exponent) - graph.constant(1.0);
            let power = graph.call(Function::Power, &[e(base), less]);
            Some(e(exponent) * power * d(base))
        }
        Node::Call(Function::Power, [base, exponent, _]) => match e(base).as_constant() {
            Some(number) if number > 0.0 => Some(libm::log(number) * e(id) * d(exponent)),
            _ => None,
        },
        _ => None,
    }
}

/// The derivative of a node, from those of its operands.
fn rule<'g>(
    graph: &'g Graph,
    id: NodeId,
    node: Node,
    d: impl Fn(NodeId) -> Expr<'g>,
) -> Result<Expr<'g>, NotDifferentiable> {
    let e = |a: NodeId| graph.expr(a);
    let refuse = |what| Err(NotDifferentiable { node: id, what });
    Ok(match node {
        Node::Constant(_) | Node::Symbol(_) => graph.constant(0.0),
        Node::Neg(a) => -d(a),
        Node::Add(a, b) => d(a) + d(b),
        Node::Sub(a, b) => d(a) - d(b),
        Node::Mul(a, b) => product(e(a), d(a), e(b), d(b)),
        Node::MulAdd(a, b, c) => product(e(a), d(a), e(b), d(b)) + d(c),
        Node::Div(a, b) => (d(a) - e(id) * d(b)) / e(b),
        Node::Sqrt(a) => 0.5 * d(a) / e(id),
        Node::Sin(a) => e(a).cos() * d(a),
        Node::Cos(a) => -(e(a).sin() * d(a)),
        Node::Atan2(y, x) => {
            let (radius, turn) = (e(x).squared() + e(y).squared(), e(x) * d(y) - e(y) * d(x));
            turn / radius
        }
        Node::Max(a, b) | Node::Min(a, b) if d(a).id() == d(b).id() => d(a),
        Node::Max(..) => return refuse("max"),
        Node::Min(..) => return refuse("min"),
        Node::Call(function, [a, ..]) => match function {
            Function::Curve(curve) => graph.call(Function::CurveSlope(curve), &[e(a)]) * d(a),
            Function::CurveSlope(curve) => {
                graph.call(Function::CurveSecondDerivative(curve), &[e(a)]) * d(a)
            }
            Function::CurveSecondDerivative(_) => return refuse("a second derivative of a curve"),
            Function::CurveBreakpoints(_) => return refuse("a breakpoint indicator"),
            Function::CurveStop(_) => return refuse("a stop"),
            Function::CurveIntegral(curve) => graph.call(Function::Curve(curve), &[e(a)]) * d(a),
            Function::CurveDoubleIntegral(curve) => {
                graph.call(Function::CurveIntegral(curve), &[e(a)]) * d(a)
            }
            Function::CurveInverse(curve) => {
                d(a) / graph.call(Function::CurveSlope(curve), &[e(id)])
            }
            Function::Power => return refuse("force::power::power"),
            Function::Choose => {
                let given = graph.arguments(id);
                match given[..] {
                    // a choice is differentiable (except at points, as a curve is) if its condition is constant or
                    // compares a curve of time
                    [a, b, then, otherwise]
                        if d(b).is_zero() && (d(a).is_zero() || is_curve_of_time(graph, a)) =>
                    {
                        let (then, otherwise) = (d(then), d(otherwise));
                        match then.id() == otherwise.id() {
                            true => then,
                            false => graph.call(function, &[e(a), e(b), then, otherwise]),
                        }
                    }
                    _ => return refuse("force::switch::choose"),
                }
            }
            Function::User(_) => return refuse("a function of the user's"),
            Function::Approach(call) => return refuse(call.path()),
            Function::Support(_) => return refuse("force::ellipsoid::support"),
        },
        // A list is not a value. The constant 1 only marks that one of its members has a derivative: the call is
        // refused, or asks for the derivatives of its arguments themselves.
        Node::Arguments(_) => graph.constant(1.0),
    })
}

/// True if the node is a curve whose argument is a multiple of time.
fn is_curve_of_time(graph: &Graph, id: NodeId) -> bool {
    let is_time = |id: NodeId| graph.node(id) == Node::Symbol(Symbol::Time);
    match graph.node(id) {
        Node::Call(Function::Curve(_), [argument, ..]) => match graph.node(argument) {
            Node::Mul(a, b) => is_time(a) || is_time(b),
            _ => is_time(argument),
        },
        _ => false,
    }
}

/// (a b)'; for a square, at half the cost.
fn product<'g>(a: Expr<'g>, da: Expr<'g>, b: Expr<'g>, db: Expr<'g>) -> Expr<'g> {
    if a.id() == b.id() {
        2.0 * (a * da)
    } else {
        da * b + a * db
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        use crate::expression::evaluate::{Inputs, evaluate};
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
}
