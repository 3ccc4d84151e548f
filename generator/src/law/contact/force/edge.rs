//! The edges of a plane: a weight w on the normal force, which depends on where the deepest point projects.
//!
//! With ξ_i the coordinates of the deepest point along the plane's tangents t_i, and e_i the half-lengths:
//!
//! | rule | w |
//! |---|---|
//! | cut | 1 where every \|ξ_i\| < e_i, 0 elsewhere |
//! | fade | Π S((e_i − \|ξ_i\|)/width),   S(x) = x² (3 − 2x) for x in \[0, 1\], 0 below and 1 above |
//!
//! Because the weight depends on the place, the elastic force N = w f(δ) alone is not the gradient of the stored energy
//! w E(δ), E = ∫ f, which also changes with ξ. So a fading edge also pushes the ellipsoid outwards, by the force −E
//! ∂w/∂ξ_i along t_i, and energy is conserved. The deepest point is not fixed in the body: let u be the vector from it
//! to the centre, which turns as u̇ = ω × u − K (ω × n) relative to the plane (K is the second derivative of how far
//! the ellipsoid reaches). Then
//!
//! ξ̇_i = t_i·v_centre − m_i·ω,   m_i = u × t_i − n × K t_i,
//!
//! so the force acts at the centre, with a moment E ∂w/∂ξ_i m_i, which is 0 for a sphere.

use crate::expression::choose;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, sum};
use crate::force::{AppliedForces, Product};
use crate::model::{EdgeRule, Extent};
use crate::motion::numbers::number;

/// The weight on a contact's force, and where the deepest point is relative to the edges.
pub struct Weight<'g> {
    /// w
    pub weight: Expr<'g>,
    /// Positive if the deepest point is inside the edges, negative if it is outside \[m\].
    pub inside: Expr<'g>,
    /// For each tangent, the distance from the edge to the inside \[m\].
    pub from_edge: Vec<Expr<'g>>,
    /// ∂w/∂ξ_i \[1/m\]; empty if the edge cuts.
    pub slopes: Vec<Expr<'g>>,
}

/// The weight at a place on the plane, given by its coordinates along the tangents.
pub fn weight<'g>(extent: &Extent, place: &[Expr<'g>]) -> Weight<'g> {
    let graph = place[0].graph();
    let constant = |x: f64| graph.constant(x);
    let (zero, one) = (constant(0.0), constant(1.0));
    let from_edge: Vec<Expr<'g>> = place
        .iter()
        .zip(&extent.half_lengths)
        .map(|(x, half)| number(graph, half) - x.max(-*x))
        .collect();
    let inside = from_edge[1..]
        .iter()
        .fold(from_edge[0], |least, distance| least.min(*distance));
    match &extent.rule {
        EdgeRule::Cut => Weight {
            weight: choose(zero, inside, one, zero),
            inside,
            from_edge,
            slopes: Vec::new(),
        },
        EdgeRule::Fade(width) => {
            let width = number(graph, width);
            let shares: Vec<Expr<'g>> = from_edge
                .iter()
                .map(|distance| (*distance / width).max(zero).min(one))
                .collect();
            let smooth: Vec<Expr<'g>> = shares
                .iter()
                .map(|x| x.squared() * (constant(3.0) - 2.0 * *x))
                .collect();
            let slopes = (0..place.len()).map(|i| {
                let x = shares[i];
                let steep = 6.0 * (x * (one - x)) / width;
                let others = (0..place.len()).filter(|j| *j != i);
                let others = others.fold(one, |product, j| product * smooth[j]);
                choose(place[i], zero, steep, -steep) * others
            });
            let slopes = slopes.collect();
            Weight {
                weight: smooth.iter().fold(one, |product, x| product * *x),
                inside,
                from_edge,
                slopes,
            }
        }
    }
}

/// Adds the places where the weight is not smooth: the edge, and for a fading edge also the line where fading begins.
pub fn kinks<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    extent: &Extent,
    weight: &Weight<'g>,
) {
    match &extent.rule {
        EdgeRule::Cut => {
            let inside = weight.inside;
            applied.kink(format!("{owner}: crosses an edge"), move || inside);
        }
        EdgeRule::Fade(width) => {
            for (i, &distance) in weight.from_edge.iter().enumerate() {
                let (which, width) = (["", " 2"][i], width.clone());
                applied.kink(format!("{owner}: crosses an edge{which}"), move || distance);
                applied.kink(format!("{owner}: begins to fade{which}"), move || {
                    distance - number(distance.graph(), &width)
                });
            }
        }
    }
}

/// The push of a fading edge: a force at the centre of the ellipsoid and a moment on its body. The opposite of both
/// acts on the plane's body.
pub struct Push<'g> {
    /// \[N\]
    pub force: Vec3<'g>,
    /// \[N m\]
    pub moment: Vec3<'g>,
}

/// The push of an edge. `stored` is the energy E at full weight; `moving` has t_i and m_i. `centre` is the velocity of
/// the ellipsoid's centre and `omega` the angular velocity of its body, both relative to the plane's body.
pub fn push<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    weight: &Weight<'g>,
    stored: Expr<'g>,
    moving: &[[Vec3<'g>; 2]],
    [centre, omega]: [Vec3<'g>; 2],
) -> Push<'g> {
    let graph = stored.graph();
    let mut push = Push {
        force: Vec3::zero(graph),
        moment: Vec3::zero(graph),
    };
    let rates = moving
        .iter()
        .map(|[along, turning]| along.dot(centre) - turning.dot(omega));
    let rate = sum(
        graph,
        rates.zip(&weight.slopes).map(|(rate, slope)| rate * *slope),
    );
    applied.work(format!("{owner}: edge"), Product::Scalars(-stored, rate));
    for ([along, turning], slope) in moving.iter().zip(&weight.slopes) {
        let size = stored * *slope;
        push.force = push.force - size * *along;
        push.moment = push.moment + size * *turning;
    }
    push
}
