//! Contact between an ellipsoid and a plane.   \[MADYMO 1980, force model 3\]
//!
//! With the plane's normal n, the ellipsoid reaches h from its centre towards the plane, and its deepest point is p
//! ([support]); the penetration is δ = h − n·(centre − plane). v is the velocity of the ellipsoid's material at p relative to
//! the plane's there; then
//!
//! δ̇ = −n·v,   N = normal_force(δ, elastic(δ), damping · min(δ/depth, 1) · δ̇),   F = N n + friction
//!
//! F acts on the ellipsoid at p, −F on the plane's body.

mod friction;
mod support;

use super::fade::faded;
use super::hysteresis;
use super::switch::Gate;
use super::{ContactMeasures, Loads, Motion, Product, choose, point_on};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph};
use crate::formalism::numbers::{curve, number, vector};
use crate::model::{Contact, Dimension};
use friction::{Rubbing, friction};
use support::support;

/// Where and how two bodies touch, absolute axes.
struct Touch<'g> {
    /// δ \[m\]
    penetration: Expr<'g>,
    /// Unit vector from the second body to the first.
    normal: Vec3<'g>,
    /// Where forces act, from the joint of the first body.
    offset: Vec3<'g>,
    /// And from that of the second.
    offset_on_second: Vec3<'g>,
    /// Velocity of the first body's material there relative to the second's \[m/s\].
    velocity: Vec3<'g>,
    /// δ̇ \[m/s\]
    approach: Expr<'g>,
    /// In space, where something needs them: axes fixed in the second body, either two along the plane, or three.
    tangents: Vec<Vec3<'g>>,
}

impl<'g> Touch<'g> {
    /// The one tangent of the plane x–z.
    fn planar_tangent(&self) -> Vec3<'g> {
        let zero = self.penetration.graph().constant(0.0);
        Vec3([self.normal.0[2], zero, -self.normal.0[0]])
    }

    /// Sliding velocity, in the tangent plane.
    fn slip(&self) -> Vec3<'g> {
        self.velocity + self.approach * self.normal
    }
}

/// Applies a contact.
pub fn apply<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    motion: &Motion<'g>,
    loads: &mut Loads<'g>,
    name: &str,
    gate: Gate<'g>,
    contact: &Contact,
) -> ContactMeasures<'g> {
    let touch = on_plane(graph, dimension, motion, contact);
    let owner = format!("contact {name}");
    let (pressure, permanent_set) = pressure(graph, loads, &owner, contact, &touch);
    let pressure = gate.of(pressure);

    loads.work(
        format!("{owner}: normal force"),
        Product::Scalars(-pressure, touch.approach),
    );
    let rubbing = match &contact.friction {
        Some(law) => friction(
            loads,
            dimension,
            &owner,
            law,
            contact.bristle.as_ref().map(|b| &b.displacement),
            pressure,
            &touch,
        ),
        None => Rubbing {
            force: Vec3::zero(graph),
            magnitude: graph.constant(0.0),
        },
    };
    let force = pressure * touch.normal + rubbing.force;
    loads.apply(contact.ellipsoid.on, touch.offset, force);
    loads.apply(contact.plane.on, touch.offset_on_second, -force);
    ContactMeasures {
        normal: pressure,
        friction: rubbing.magnitude,
        penetration: touch.penetration,
        permanent_set,
    }
}

/// The normal force, and the penetration at which unloading would end.
fn pressure<'g>(
    graph: &'g Graph,
    loads: &mut Loads<'g>,
    owner: &str,
    contact: &Contact,
    touch: &Touch<'g>,
) -> (Expr<'g>, Expr<'g>) {
    let (zero, penetration, approach) = (graph.constant(0.0), touch.penetration, touch.approach);
    // what is remembered must be finite, and a curve need not be defined while apart
    let depth = match contact.hysteresis {
        Some(_) => penetration.max(zero),
        None => penetration,
    };
    let loading = contact
        .elastic
        .as_ref()
        .map_or(zero, |c| curve(graph, c, depth));
    let (elastic, permanent_set) = match &contact.hysteresis {
        Some(law) => hysteresis::apply(loads, owner, "m", law, depth, loading, approach),
        None => (loading, zero),
    };
    let viscous = contact.damping.as_ref().map_or(zero, |c| {
        number(graph, c) * faded(graph, penetration, contact.damping_depth.as_ref()) * approach
    });
    let force = graph.call(
        Function::ContactNormalForce,
        &[penetration, elastic, viscous],
    );
    if contact.damping.is_some() {
        // the force ends while still penetrated where damping would pull
        let pushes = choose(zero, penetration, elastic + viscous, penetration);
        loads.guard(format!("{owner}: pushes"), pushes);
    }
    (force, permanent_set)
}

/// The touch of an ellipsoid and a plane.
fn on_plane<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    motion: &Motion<'g>,
    contact: &Contact,
) -> Touch<'g> {
    let (ellipsoid, plane) = (
        motion.body(contact.ellipsoid.on),
        motion.body(contact.plane.on),
    );
    let centre = motion.attachment(graph, &contact.ellipsoid);
    let on_plane = motion.attachment(graph, &contact.plane);
    let local_normal = vector(graph, &contact.normal);
    let normal = plane.rotation.times(local_normal);

    let (reach, deepest) = support(graph, dimension, motion, contact, normal);
    let penetration = reach - normal.dot(centre.position - on_plane.position);
    let offset = centre.offset - deepest;
    let point = centre.position - deepest;
    let (offset_on_second, plane_velocity) = point_on(plane, point);
    let velocity = ellipsoid.velocity_at(offset) - plane_velocity;
    let tangents = match dimension {
        Dimension::Space if contact.bristle.is_some() => {
            let first = vector(graph, &contact.tangent);
            let local = [first, local_normal.cross(first)];
            local.map(|axis| plane.rotation.times(axis)).to_vec()
        }
        _ => Vec::new(),
    };
    Touch {
        penetration,
        normal,
        offset,
        offset_on_second,
        velocity,
        approach: -normal.dot(velocity),
        tangents,
    }
}
