//! Joint torque: a separate law about each relative rotation θ_i.   \[MADYMO 1980, force model 1\]
//!
//! Q_i = −elastic(θ_i − neutral) − damping · θ̇_i + coulomb(limit, θ̇_i, tolerance)
//!
//! In the plane θ = φ_child − φ_parent and the moment is Q e_y. In space θ are the Bryant angles of A_parentᵀ A_child with
//! axes e₁ = x of the parent, e₃ = z of the child, e₂ along e₃ × e₁. They are not orthogonal: the moment that does the work
//! Q·θ̇, and so stores what the elastic curves store, is
//!
//! M = Σ Q_i n_i,   n₂ = (e₃ × e₁)/c,   n₁ = (e₁ − s e₃)/c²,   n₃ = (e₃ − s e₁)/c²,   s = sin θ₂ = e₁·e₃,   c² = 1 − s²
//!
//! and by the same vectors θ̇_i = n_i · (ω_child − ω_parent). At θ₂ = ±90° the angles are undefined; c² is kept ≥ 1e-12, so
//! that forces stay finite there.

use super::switch::Gate;
use super::{JointMeasures, Loads, Motion, Product};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph, sum};
use crate::formalism::numbers::{curve, number};
use crate::model::{Body, Dimension, ElementId, JointTorque, Model};

/// Below this, cos² θ₂ is taken for it.
const SMALLEST_COSINE_SQUARED: f64 = 1e-12;

#[expect(clippy::too_many_arguments, reason = "as all laws, and its own two")]
pub fn apply<'g>(
    graph: &'g Graph,
    model: &Model,
    motion: &Motion<'g>,
    loads: &mut Loads<'g>,
    name: &str,
    gate: Gate<'g>,
    child: ElementId,
    about: &[JointTorque; 3],
) -> [Option<JointMeasures<'g>>; 3] {
    let parent = match model.systems[child.system].elements[child.element].parent {
        Some(element) => Body::Element(ElementId {
            system: child.system,
            element,
        }),
        None => Body::Frame,
    };
    let mut measures = [None; 3];
    let mut moment = Vec3::zero(graph);
    for i in 0..3 {
        let used = about[i] != JointTorque::default();
        if !used || (model.dimension == Dimension::Plane && i != 1) {
            continue;
        }
        let (angle, rate, direction) = match model.dimension {
            Dimension::Plane => in_plane(graph, motion, child, parent),
            Dimension::Space => in_space(graph, motion, child, parent, i),
        };
        let terms: Vec<_> = torques(graph, &about[i], angle, rate)
            .into_iter()
            .map(|(term, torque)| (term, gate.of(torque)))
            .collect();
        let torque = sum(graph, terms.iter().map(|(_, torque)| *torque));
        for (term, torque) in terms {
            let work = format!("joint {name}: {term}");
            loads.work(work, Product::Scalars(torque, rate));
        }
        moment = moment + torque * direction;
        measures[i] = Some(JointMeasures {
            torque,
            angle,
            rate,
        });
    }
    loads.turn(Body::Element(child), moment);
    loads.turn(parent, -moment);
    measures
}

/// The terms of Q of one relative rotation, by name.
fn torques<'g>(
    graph: &'g Graph,
    law: &JointTorque,
    angle: Expr<'g>,
    rate: Expr<'g>,
) -> Vec<(&'static str, Expr<'g>)> {
    let mut torques = Vec::new();
    if let Some(elastic) = &law.elastic {
        let neutral = law
            .neutral
            .as_ref()
            .map_or(graph.constant(0.0), |n| number(graph, n));
        torques.push(("elastic", -curve(graph, elastic, angle - neutral)));
    }
    if let Some(damping) = &law.damping {
        torques.push(("damping", -(number(graph, damping) * rate)));
    }
    if let Some(friction) = &law.friction {
        let (limit, tolerance) = (
            number(graph, &friction.limit),
            number(graph, &friction.tolerance),
        );
        let friction = graph.call(Function::Coulomb, &[limit, rate, tolerance]);
        torques.push(("friction", friction));
    }
    torques
}

/// θ, θ̇ and the direction e_y.
fn in_plane<'g>(
    graph: &'g Graph,
    motion: &Motion<'g>,
    child: ElementId,
    parent: Body,
) -> (Expr<'g>, Expr<'g>, Vec3<'g>) {
    let (inboard, outboard) = (motion.body(parent), motion.element(child));
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let rate = outboard.omega - inboard.omega;
    (
        outboard.angle - inboard.angle,
        rate.0[1],
        Vec3([zero, one, zero]),
    )
}

/// θ_i, θ̇_i and n_i.
fn in_space<'g>(
    graph: &'g Graph,
    motion: &Motion<'g>,
    child: ElementId,
    parent: Body,
    i: usize,
) -> (Expr<'g>, Expr<'g>, Vec3<'g>) {
    let (inboard, outboard) = (motion.body(parent), motion.element(child));
    let (first, third) = (inboard.rotation.column(0), outboard.rotation.column(2));
    let sine = first.dot(third);
    let cosine_squared =
        (graph.constant(1.0) - sine.squared()).max(graph.constant(SMALLEST_COSINE_SQUARED));
    let (angle, direction) = match i {
        0 => {
            let y = inboard.rotation.column(1).dot(third);
            let z = inboard.rotation.column(2).dot(third);
            (
                (-y).atan2(z),
                cosine_squared.recip() * (first - sine * third),
            )
        }
        1 => {
            let cosine = cosine_squared.sqrt();
            (sine.atan2(cosine), cosine.recip() * third.cross(first))
        }
        _ => {
            let x = first.dot(outboard.rotation.column(0));
            let y = first.dot(outboard.rotation.column(1));
            (
                (-y).atan2(x),
                cosine_squared.recip() * (third - sine * first),
            )
        }
    };
    (
        angle,
        direction.dot(outboard.omega - inboard.omega),
        direction,
    )
}
