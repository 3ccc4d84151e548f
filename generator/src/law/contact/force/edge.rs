//! Where a plane ends: a weight w on the normal force by where the deepest point projects.
//!
//! With ξ_i the coordinates of that point along the plane's tangents t_i and e_i the half-lengths:
//!
//! | rule | w |
//! |---|---|
//! | cut | 1 where every \|ξ_i\| < e_i, 0 elsewhere |
//! | fade | Π S((e_i − \|ξ_i\|)/width),   S(x) = x² (3 − 2x) for x in \[0, 1\], 0 below and 1 above |
//!
//! A weight that depends on the place makes the elastic force N = w f(δ) no gradient: what is stored, w E(δ) with
//! E = ∫ f, also changes with ξ. So a fading edge pushes the ellipsoid outwards as well, by the force −E ∂w/∂ξ_i along t_i, and
//! energy closes. The deepest point is no point of the body's material: with u the vector from it to the centre, which
//! turns as u̇ = ω × u − K (ω × n) relative to the plane (K the second derivative of how far the ellipsoid reaches),
//!
//! ξ̇_i = t_i·v_centre − m_i·ω,   m_i = u × t_i − n × K t_i,
//!
//! whence the force acts at the centre, with a moment E ∂w/∂ξ_i m_i, which of a sphere is 0.

use crate::dynamics::force::choose;
use crate::dynamics::force::{AppliedForces, Product};
use crate::dynamics::numbers::number;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, sum};
use crate::model::{EdgeRule, Extent};

/// How much of a contact's force there is.
pub struct Weight<'g> {
    /// w
    pub weight: Expr<'g>,
    /// Positive inside, negative outside \[m\].
    pub inside: Expr<'g>,
    /// By tangent: how far inside \[m\].
    pub from_edge: Vec<Expr<'g>>,
    /// ∂w/∂ξ_i \[1/m\]; none where the edge cuts.
    pub slopes: Vec<Expr<'g>>,
}

/// The weight at a place on the plane, by its coordinates along the tangents.
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

/// Tells where the weight is not smooth: it ends at the edge; a fading one begins where it is fully inside.
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

/// What a fading edge pushes: a force at the centre of the ellipsoid and a moment on its body, the opposite of both on the
/// plane's.
pub struct Push<'g> {
    /// \[N\]
    pub force: Vec3<'g>,
    /// \[N m\]
    pub moment: Vec3<'g>,
}

/// The push of an edge, of the energy E stored at full weight; `moving` are t_i and m_i. `centre` is the velocity of the
/// ellipsoid's centre and `omega` the angular velocity of its body, both relative to the plane's.
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
