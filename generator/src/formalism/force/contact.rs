//! Contact between an ellipsoid and a plane.   \[MADYMO 1980, force model 3\]
//!
//! With the plane's normal n, seen in the ellipsoid's axes as n', and the semi-axes a: the ellipsoid reaches
//! h = √(Σ a_i² n'_i²) from its centre towards the plane, and its deepest point is p = centre − R (a_i² n'_i)/h; the penetration
//! is δ = h − n·(centre − plane). v is the velocity of the ellipsoid's material at p relative to the plane's there; then
//!
//! δ̇ = −n·v,   N = normal_force(δ, elastic(δ), damping · min(δ/depth, 1) · δ̇),   F = N n − (friction) v_t
//!
//! with Coulomb friction μ N, proportional to |v_t| below the tolerance. F acts on the ellipsoid at p, −F on the plane's body.

use super::fade::faded;
use super::hysteresis;
use super::switch::Gate;
use super::{ContactMeasures, Loads, Motion, Product, choose, point_on};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph};
use crate::formalism::kinematics::constant_rotation;
use crate::formalism::numbers::{curve, number, vector};
use crate::model::{Contact, Dimension};

pub fn apply<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    motion: &Motion<'g>,
    loads: &mut Loads<'g>,
    name: &str,
    gate: Gate<'g>,
    contact: &Contact,
) -> ContactMeasures<'g> {
    let (ellipsoid, plane) = (
        motion.body(contact.ellipsoid.on),
        motion.body(contact.plane.on),
    );
    let centre = motion.attachment(graph, &contact.ellipsoid);
    let on_plane = motion.attachment(graph, &contact.plane);
    let normal = plane.rotation.times(vector(graph, &contact.normal));

    let (reach, deepest) = support(graph, dimension, motion, contact, normal);
    let penetration = reach - normal.dot(centre.position - on_plane.position);
    let offset = centre.offset - deepest;
    let point = centre.position - deepest;
    let (offset_on_plane, plane_velocity) = point_on(plane, point);
    let velocity = ellipsoid.velocity_at(offset) - plane_velocity;
    let approach = -normal.dot(velocity);

    let zero = graph.constant(0.0);
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
        Some(law) => {
            let owner = format!("contact {name}");
            hysteresis::apply(loads, &owner, "m", law, depth, loading, approach)
        }
        None => (loading, zero),
    };
    let viscous = contact.damping.as_ref().map_or(zero, |c| {
        number(graph, c) * faded(graph, penetration, contact.damping_depth.as_ref()) * approach
    });
    let pressure = graph.call(
        Function::ContactNormalForce,
        &[penetration, elastic, viscous],
    );
    let pressure = gate.of(pressure);

    loads.work(
        format!("contact {name}: normal force"),
        Product::Scalars(-pressure, approach),
    );
    let friction_work = format!("contact {name}: friction");
    if contact.damping.is_some() {
        // the force jumps at touch, and ends while still penetrated where damping would pull
        let pushes = choose(zero, penetration, elastic + viscous, penetration);
        loads.guard(format!("contact {name}: pushes"), pushes);
    }
    let mut force = pressure * normal;
    let mut friction_force = zero;
    if let Some(friction) = &contact.friction {
        let limit = number(graph, &friction.limit) * pressure;
        let tolerance = number(graph, &friction.tolerance);
        match dimension {
            Dimension::Plane => {
                let tangent = Vec3([normal.0[2], zero, -normal.0[0]]);
                friction_force = graph.call(
                    Function::Coulomb,
                    &[limit, tangent.dot(velocity), tolerance],
                );
                force = force + friction_force * tangent;
                let slip = tangent.dot(velocity);
                loads.work(friction_work, Product::Scalars(friction_force, slip));
            }
            Dimension::Space => {
                let slip = velocity + approach * normal;
                let squared = slip.squared();
                let scale = graph.call(Function::CoulombScale, &[limit, squared, tolerance]);
                friction_force = scale * squared.sqrt();
                force = force - scale * slip;
                loads.work(friction_work, Product::Scalars(-scale, squared));
            }
        }
    }
    loads.apply(contact.ellipsoid.on, offset, force);
    loads.apply(contact.plane.on, offset_on_plane, -force);
    ContactMeasures {
        normal: pressure,
        friction: friction_force,
        penetration,
        permanent_set,
    }
}

/// h, and the vector from the deepest point to the centre.
fn support<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    motion: &Motion<'g>,
    contact: &Contact,
    normal: Vec3<'g>,
) -> (Expr<'g>, Vec3<'g>) {
    let semi_axes = vector(graph, &contact.semi_axes).0;
    let used: &[usize] = match dimension {
        Dimension::Plane => &[0, 2],
        Dimension::Space => &[0, 1, 2],
    };
    if used.iter().all(|&i| semi_axes[i].id() == semi_axes[0].id()) {
        // a sphere reaches equally far to all sides
        return (semi_axes[0], semi_axes[0] * normal);
    }
    let body = &motion.body(contact.ellipsoid.on).rotation;
    let axes = constant_rotation(graph, &contact.axes);
    let local = axes.transposed_times(body.transposed_times(normal));
    let stretched = Vec3(std::array::from_fn(|i| semi_axes[i] * local.0[i]));
    let reach = stretched.squared().sqrt();
    let twice_stretched = Vec3(std::array::from_fn(|i| semi_axes[i] * stretched.0[i]));
    (
        reach,
        reach.recip() * body.times(axes.times(twice_stretched)),
    )
}
