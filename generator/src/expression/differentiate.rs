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
//! branches, and for the searches of ellipsoids. With dual numbers, all of these can be differentiated at run time.

mod ellipsoid;

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
            let by_side = match kinks {
                Kinks::BySide => by_side(graph, id, node, &d)?,
                Kinks::Refused => None,
            };
            let own = match by_side {
                Some(own) => own,
                None => rule(graph, id, node, d)?,
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

/// The derivative of a value that is chosen by a comparison, or found by a search that compares, from those of its
/// operands; `None` for other nodes.
fn by_side<'g>(
    graph: &'g Graph,
    id: NodeId,
    node: Node,
    d: &impl Fn(NodeId) -> Expr<'g>,
) -> Result<Option<Expr<'g>>, NotDifferentiable> {
    let e = |a: NodeId| graph.expr(a);
    Ok(match node {
        // the comparisons of the runtime
        Node::Max(a, b) => Some(choose(e(a), e(b), d(b), d(a))),
        Node::Min(a, b) => Some(choose(e(b), e(a), d(b), d(a))),
        Node::Call(Function::Choose, _) => match graph.arguments(id)[..] {
            [a, b, then, otherwise] => Some(choose(e(a), e(b), d(then), d(otherwise))),
            _ => None,
        },
        Node::Sqrt(a) => Some(0.5 * d(a) / standing(e(id), d(a))),
        Node::Atan2(y, x) => {
            let (turn, radius) = turn([e(y), e(x)], [d(y), d(x)]);
            let motion = magnitude(d(y)) + magnitude(d(x));
            Some(turn / standing(radius, motion))
        }
        Node::Call(Function::Power, [base, exponent, _]) if d(exponent).is_zero() => {
            let less = e(exponent) - graph.constant(1.0);
            let motion = e(exponent) * d(base);
            let power = graph.call(Function::Power, &[standing(e(base), motion), less]);
            Some(motion * power)
        }
        Node::Call(Function::Power, [base, exponent, _]) => match e(base).as_constant() {
            Some(number) if number > 0.0 => Some(libm::log(number) * e(id) * d(exponent)),
            _ => None,
        },
        Node::Call(Function::Approach(call), _) => {
            let arguments = graph.arguments(id);
            Some(ellipsoid::of_approach(graph, call, &arguments, d))
        }
        Node::Call(Function::Support(part), _) => {
            let arguments = graph.arguments(id);
            Some(ellipsoid::of_support(graph, id, part, &arguments, d)?)
        }
        _ => None,
    })
}

/// A divisor that is not negative, or 1 where it and the motion are 0: what stands still there has the derivative 0 and
/// not 0/0, as by dual numbers.
fn standing<'g>(divisor: Expr<'g>, motion: Expr<'g>) -> Expr<'g> {
    let graph = divisor.graph();
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let at_zero = choose(zero, magnitude(motion), divisor, one);
    choose(zero, divisor, divisor, at_zero)
}

/// |a|
fn magnitude(a: Expr<'_>) -> Expr<'_> {
    a.max(-a)
}

/// x ẏ − y ẋ and x² + y²
fn turn<'g>([y, x]: [Expr<'g>; 2], [dy, dx]: [Expr<'g>; 2]) -> (Expr<'g>, Expr<'g>) {
    (x * dy - y * dx, x.squared() + y.squared())
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
            let (turn, radius) = turn([e(y), e(x)], [d(y), d(x)]);
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
