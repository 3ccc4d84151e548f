//! Derivatives of the searches of ellipsoids: where two overlap most, and how far one of a higher degree reaches.
//!
//! A search has found the unit vector n at which P r = 0, with the names of `force::approach::space` of the runtime:
//! u_i = Q_i n/h_i, r = u₁ + u₂ − d, P = 1 − n nᵀ, M = K₁ + K₂ − φ P. With the changes Q̇ and ḋ of its arguments, n
//! moves so that P r stays 0:
//!
//! u̇_i = Q̇_i n/h_i − u_i (nᵀ Q̇_i n)/(2 h_i²)   at fixed n
//! M ṅ = −P (u̇₁ + u̇₂ − ḋ),   n·ṅ = 0
//! φ̇ = Σ nᵀ Q̇_i n/(2 h_i) − n·ḋ   (φ is smallest at n, so ṅ has no part in it)
//!
//! The runtime's dual numbers have the same derivatives, by one more step of Newton's method.

use super::NotDifferentiable;
use crate::expression::graph::{Expr, Graph, choose};
use crate::expression::node::{ApproachCall, Function, NodeId};
use crate::expression::vector::{Sym3, Vec3};

/// The smallest part of its reach that counts in the runtime's `force::ellipsoid::support`.
const SMALLEST: f64 = 1e-200;

/// The derivative of one result of a search for the direction of least overlap, from those of its arguments.
///
/// A search that may end early has any separating plane as its result while the bodies are apart. Then n has no
/// derivative, and is taken to stand still.
pub(super) fn of_approach<'g>(
    graph: &'g Graph,
    call: ApproachCall,
    arguments: &[NodeId],
    d: impl Fn(NodeId) -> Expr<'g>,
) -> Expr<'g> {
    let given: Vec<Expr<'g>> = arguments.iter().map(|id| graph.expr(*id)).collect();
    let changes: Vec<Expr<'g>> = arguments.iter().map(|id| d(*id)).collect();
    let [own, change] = [&given, &changes].map(|values| Pair::of(graph, call, values));
    let part = |part: usize| {
        let part = ApproachCall {
            part: part as u8,
            ..call
        };
        graph.call(Function::Approach(part), &given)
    };
    let count = call.components();
    let parts = |from: usize| vector(graph, call, |k| part(from + k));
    let (n, depth) = (parts(0), part(count));

    let (mut gap, mut deeper) = (-change.between, -n.dot(change.between));
    let bodies = [0, 1].map(|i| Furthest::of(&own.shapes[i], &change.shapes[i], n));
    for body in &bodies {
        gap = gap + body.moved;
        deeper = deeper + body.grown;
    }
    let [first, second] = &bodies;
    let stiffness = Sym3::from_fn(|i, j| {
        let unit = graph.constant(if i == j { 1.0 } else { 0.0 });
        let across = unit - n.0[i] * n.0[j];
        first.curvature.entry(i, j) + second.curvature.entry(i, j) - depth * across
    });
    let turn = turn(call, &stiffness, gap, n, depth);
    let index = usize::from(call.part);
    match index.checked_sub(count) {
        None => turn.0[axes(call)[index]],
        Some(0) => deeper,
        Some(k) => {
            let half = graph.constant(0.5);
            let middle = first.moved + first.curvature.times(turn)
                - half * (deeper * n)
                - half * (depth * turn);
            middle.0[axes(call)[k - 1]]
        }
    }
}

/// The point of a body that is furthest along n, as the body changes.
struct Furthest<'g> {
    /// The change of u at fixed n.
    moved: Vec3<'g>,
    /// The change of h at fixed n.
    grown: Expr<'g>,
    /// K = ∂u/∂n
    curvature: Sym3<'g>,
}

impl<'g> Furthest<'g> {
    fn of(shape: &Sym3<'g>, change: &Sym3<'g>, n: Vec3<'g>) -> Self {
        let stretched = shape.times(n);
        let reach = n.dot(stretched).sqrt();
        let u = reach.recip() * stretched;
        let turned = change.times(n);
        let grown = n.dot(turned) / (2.0 * reach);
        Furthest {
            moved: reach.recip() * (turned - grown * u),
            grown,
            curvature: Sym3::from_fn(|i, j| (shape.entry(i, j) - u.0[i] * u.0[j]) / reach),
        }
    }
}

/// ṅ, for a `gap` that changes by this vector at fixed n.
fn turn<'g>(
    call: ApproachCall,
    stiffness: &Sym3<'g>,
    gap: Vec3<'g>,
    n: Vec3<'g>,
    depth: Expr<'g>,
) -> Vec3<'g> {
    let graph = depth.graph();
    let zero = graph.constant(0.0);
    // any number but 0 divides where n stands still
    let divisor = |divisor: Expr<'g>| match call.early {
        true => choose(depth, zero, graph.constant(1.0), divisor),
        false => divisor,
    };
    let turn = if call.planar {
        let across = Vec3([-n.0[2], zero, n.0[0]]);
        let bent = across.dot(stiffness.times(across));
        -(across.dot(gap) / divisor(bent)) * across
    } else {
        // the inverse of M in the tangent plane is (tr(M) P − M) over the product of its two other eigenvalues
        let slope = gap - n.dot(gap) * n;
        let minor = |i: usize, j: usize| {
            let across = stiffness.entry(i, j);
            stiffness.entry(i, i) * stiffness.entry(j, j) - across.squared()
        };
        let product = minor(0, 1) + minor(0, 2) + minor(1, 2);
        let [xx, yy, zz] = stiffness.diagonal;
        let turned = stiffness.times(slope) - (xx + yy + zz) * slope;
        divisor(product).recip() * turned
    };
    match call.early {
        true => Vec3(turn.0.map(|turn| choose(depth, zero, zero, turn))),
        false => turn,
    }
}

/// The derivative of one result of `force::ellipsoid::support(x, y, z, power)`.
///
/// The result h is how far the body reaches, the others are g_i = ∂h/∂s_i = ± (|s_i|/h)^(power−1). Where s_i is 0 the
/// surface is flat across it, and g_i is taken to stand still, as by dual numbers.
pub(super) fn of_support<'g>(
    graph: &'g Graph,
    id: NodeId,
    part: u8,
    arguments: &[NodeId],
    d: impl Fn(NodeId) -> Expr<'g>,
) -> Result<Expr<'g>, NotDifferentiable> {
    let [x, y, z, power] = arguments else {
        unreachable!("a support has four arguments");
    };
    if !d(*power).is_zero() {
        return Err(NotDifferentiable {
            node: id,
            what: "a degree of an ellipsoid",
        });
    }
    let power = graph.expr(*power);
    let given: Vec<Expr<'g>> = arguments.iter().map(|id| graph.expr(*id)).collect();
    let result = |part: u8| graph.call(Function::Support(part), &given);
    let changes = Vec3([x, y, z].map(|id| d(*id)));
    let further = Vec3([1, 2, 3].map(result)).dot(changes);
    let Some(axis) = part.checked_sub(1).map(usize::from) else {
        return Ok(further);
    };
    let (reach, s) = (result(0), given[axis]);
    let flat = graph.constant(SMALLEST) * reach;
    let size = s.max(-s);
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let own = changes.0[axis] / choose(size, flat, one, s);
    let own = choose(size, flat, zero, own);
    Ok((power - one) * result(part) * (own - further / reach))
}

/// The axes that the components of a vector belong to.
fn axes(call: ApproachCall) -> &'static [usize] {
    if call.planar { &[0, 2] } else { &[0, 1, 2] }
}

/// A vector from its components; in the plane that along y is 0.
fn vector<'g>(
    graph: &'g Graph,
    call: ApproachCall,
    component: impl Fn(usize) -> Expr<'g>,
) -> Vec3<'g> {
    let mut vector = Vec3::zero(graph);
    for (k, axis) in axes(call).iter().enumerate() {
        vector.0[*axis] = component(k);
    }
    vector
}

/// The arguments of a search, or their derivatives.
struct Pair<'g> {
    /// Q₁ and Q₂
    shapes: [Sym3<'g>; 2],
    /// d
    between: Vec3<'g>,
}

impl<'g> Pair<'g> {
    fn of(graph: &'g Graph, call: ApproachCall, values: &[Expr<'g>]) -> Self {
        let zero = graph.constant(0.0);
        // a matrix is xx, zz, xz in the plane, and xx, yy, zz, yz, xz, xy in space
        let size = if call.planar { 3 } else { 6 };
        let shape = |from: usize| match values[from..from + size] {
            [xx, zz, xz] => Sym3 {
                diagonal: [xx, zero, zz],
                off: [zero, xz, zero],
            },
            [xx, yy, zz, yz, xz, xy] => Sym3 {
                diagonal: [xx, yy, zz],
                off: [yz, xz, xy],
            },
            _ => unreachable!("a matrix has three or six entries"),
        };
        Pair {
            shapes: [shape(0), shape(size)],
            between: vector(graph, call, |k| values[2 * size + k]),
        }
    }
}
