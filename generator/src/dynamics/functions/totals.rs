//! The whole of all systems: centre of mass, centroidal momentum, energies.
//!
//! The column (s, e) of a velocity of element k gives its bodies outboard the momentum f = M s + e × h_r and, about the
//! origin of k, n = h × s + J e + Σ h_c × (e × d_c). M and h are the mass and the first moment of everything outboard.
//! h_r and J are those of what turns with k; what is carried by a ball joint at d_c, with the first moment h_c about
//! it, does not turn and counts there as a point mass. \[Orin, Goswami, Lee 2013\]

use super::Known;
use super::frame::{both, by_rows};
use crate::dynamics::augmented_body::{rotated, with_points};
use crate::dynamics::energy;
use crate::dynamics::outputs::ModelInMotion;
use crate::dynamics::spatial::Spatial;
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Expr, sum};
use crate::model::{Element, ElementId, Joint};
use crate::motion::numbers::{number, vector};

pub fn kinetic_energy<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    vec![energy::kinetic_energy(known.scene)]
}

/// −Σ m g · r
pub fn potential_energy<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let scene = known.scene;
    let energies = elements(scene).map(|(id, element)| {
        let moment = number(scene.graph, &element.mass) * center(scene, id, element);
        -scene.fields(id).dot(moment)
    });
    vec![sum(scene.graph, energies)]
}

pub fn center_of_mass<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    center_of_all(known.scene).0.into()
}

/// p = Σ m v + ω × h, and of l = p_k × p + h × v + J ω about the origin what is left about the centre of mass. v and J
/// are those of the origins p_k of bodies.
pub fn centroidal_momentum<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let scene = known.scene;
    let (graph, all) = (scene.graph, center_of_all(scene));
    let (mut linear, mut angular) = (Vec3::zero(graph), Vec3::zero(graph));
    for (s, _) in scene.model.systems.iter().enumerate() {
        for (motion, body) in scene.motion.systems[s].iter().zip(bodies(scene, s)) {
            let Some(Rigid {
                mass,
                first,
                inertia,
            }) = body
            else {
                continue;
            };
            let first = motion.rotation.times(first);
            let momentum = mass * motion.velocity + motion.omega.cross(first);
            let spin = inertia.times(motion.rotation.transposed_times(motion.omega));
            angular = angular
                + motion.position.cross(momentum)
                + first.cross(motion.velocity)
                + motion.rotation.times(spin);
            linear = linear + momentum;
        }
    }
    both(linear, angular - all.cross(linear))
}

pub fn centroidal_matrix<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let ModelInMotion { graph, layout, .. } = *known.scene;
    let (none, all) = (Vec3::zero(graph), center_of_all(known.scene));
    let mut columns = vec![[none; 2]; known.size()];
    for spatial in known.systems {
        let composites = composites(known.scene, spatial);
        for (k, composite) in composites.iter().enumerate() {
            let arm = spatial.motion_of(k).position - all;
            for column in spatial.columns(k) {
                let force = composite.mass * column.slide + column.axis.cross(composite.turning);
                let mut moment = composite.first.cross(column.slide)
                    + composite.inertia.times(column.axis)
                    + arm.cross(force);
                for &(at, first) in &composite.carried {
                    moment = moment + first.cross(column.axis.cross(at));
                }
                let [linear, angular] = &mut columns[column.row];
                (*linear, *angular) = (*linear + force, *angular + moment);
            }
        }
        if let Some(rows) = layout.reference_velocities(spatial.system) {
            let root = &composites[0];
            let arm = spatial.motion_of(0).position - all;
            for (row, &direction) in rows.zip(layout.directions) {
                let mut along = none;
                along.0[direction] = graph.constant(1.0);
                columns[row] = [
                    root.mass * along,
                    (root.first + root.mass * arm).cross(along),
                ];
            }
        }
    }
    by_rows(&columns)
}

/// Everything outboard of an element's joint, in absolute axes, about its origin.
struct Composite<'g> {
    /// M
    mass: Expr<'g>,
    /// h, the first moment of everything.
    first: Vec3<'g>,
    /// h_r, the first moment of what turns with the element, with what balls carry as point masses.
    turning: Vec3<'g>,
    /// J of the same.
    inertia: Sym3<'g>,
    /// For each ball joint that it carries its place, and the first moment about it of what is outboard.
    carried: Vec<(Vec3<'g>, Vec3<'g>)>,
}

fn composites<'g>(scene: &ModelInMotion<'g, '_>, spatial: &Spatial<'g, '_>) -> Vec<Composite<'g>> {
    let graph = scene.graph;
    let zero = graph.constant(0.0);
    let bodies = bodies(scene, spatial.system).into_iter().enumerate();
    let mut all: Vec<Composite<'g>> = bodies
        .map(|(k, body)| {
            let rotation = &spatial.motion_of(k).rotation;
            let first = body.as_ref().map(|body| rotation.times(body.first));
            let first = first.unwrap_or_else(|| Vec3::zero(graph));
            let inertia = body
                .as_ref()
                .map(|of| rotated(graph, rotation, &of.inertia));
            Composite {
                mass: body.map_or(zero, |body| body.mass),
                first,
                turning: first,
                inertia: inertia.unwrap_or_else(|| Sym3::zero(graph)),
                carried: Vec::new(),
            }
        })
        .collect();
    for k in (1..all.len()).rev() {
        let Some(parent) = spatial.of_system().elements[k].parent else {
            continue;
        };
        let motion = spatial.motion_of(k);
        let (inboard, outboard) = all.split_at_mut(k);
        let (to, of, at) = (&mut inboard[parent], &outboard[0], motion.offset);
        let point = of.mass * at;
        to.mass = to.mass + of.mass;
        to.first = to.first + of.first + point;
        to.turning = to.turning + point;
        to.inertia = to.inertia + moved(Vec3::zero(spatial.graph), of.mass, at);
        match motion.turns_with_carrier {
            true => {
                to.turning = to.turning + of.turning;
                let own = moved(of.turning, spatial.graph.constant(0.0), at);
                to.inertia = to.inertia + of.inertia + own;
                let carried = of.carried.iter().map(|&(of, first)| (of + at, first));
                to.carried.extend(carried);
            }
            false => to.carried.push((at, of.first)),
        }
    }
    all
}

/// What the inertia of a body with this first moment and mass grows by, if it is taken about the point −u instead:
/// 2 (h · u) 1 − h uᵀ − u hᵀ + m (u² 1 − u uᵀ).
fn moved<'g>(first: Vec3<'g>, mass: Expr<'g>, u: Vec3<'g>) -> Sym3<'g> {
    let (h, mu) = (first.0, (mass * u).0);
    let product = |i: usize, j: usize| h[i] * u.0[j] + u.0[i] * (h[j] + mu[j]);
    Sym3::from_fn(|i, j| match i == j {
        true => {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            product(a, a) + product(b, b)
        }
        false => -product(i, j),
    })
}

fn elements<'a>(scene: &ModelInMotion<'_, 'a>) -> impl Iterator<Item = (ElementId, &'a Element)> {
    let systems = scene.model.systems.iter().enumerate();
    systems.flat_map(|(system, of)| {
        let elements = of.elements.iter().enumerate();
        elements.map(move |(element, of)| (ElementId { system, element }, of))
    })
}

/// The centre of gravity of an element.
fn center<'g>(scene: &ModelInMotion<'g, '_>, id: ElementId, element: &Element) -> Vec3<'g> {
    let motion = scene.motion.element(id);
    motion.position + motion.rotation.times(vector(scene.graph, &element.cg))
}

/// The centre of mass of all systems.
fn center_of_all<'g>(scene: &ModelInMotion<'g, '_>) -> Vec3<'g> {
    let graph = scene.graph;
    let (mut mass, mut moment) = (graph.constant(0.0), Vec3::zero(graph));
    for (s, _) in scene.model.systems.iter().enumerate() {
        for (motion, body) in scene.motion.systems[s].iter().zip(bodies(scene, s)) {
            if let Some(body) = body {
                let own = body.mass * motion.position + motion.rotation.times(body.first);
                (mass, moment) = (mass + body.mass, moment + own);
            }
        }
    }
    mass.recip() * moment
}

/// A rigid body: m, h and J about the origin of its element, in its axes.
struct Rigid<'g> {
    mass: Expr<'g>,
    first: Vec3<'g>,
    inertia: Sym3<'g>,
}

/// The body of each element of a system, with all that is welded to it; `None` for what is welded to another.
fn bodies<'g>(scene: &ModelInMotion<'g, '_>, system: usize) -> Vec<Option<Rigid<'g>>> {
    let ModelInMotion { graph, model, .. } = *scene;
    let elements = &model.systems[system].elements;
    let none = Vec3::zero(graph);
    let mut bodies: Vec<Option<Rigid<'g>>> = Vec::new();
    // for each element the one that it is welded to, itself if it is not, and its place there
    let mut seats: Vec<(usize, Vec3<'g>)> = Vec::new();
    for (k, element) in elements.iter().enumerate() {
        let is_welded = element.joint != Joint::Ball && element.joint.freedoms().is_empty();
        let (seat, at) = match element.parent.filter(|_| is_welded) {
            Some(parent) => (
                seats[parent].0,
                seats[parent].1 + vector(graph, &element.at),
            ),
            None => (k, none),
        };
        let (mass, first, inertia) = with_points(graph, model.dimension, element, none, &[]);
        let own = Rigid {
            mass,
            first: first + mass * at,
            inertia: inertia + moved(first, mass, at),
        };
        bodies.push(None);
        bodies[seat] = Some(match bodies[seat].take() {
            None => own,
            Some(body) => Rigid {
                mass: body.mass + own.mass,
                first: body.first + own.first,
                inertia: body.inertia + own.inertia,
            },
        });
        seats.push((seat, at));
    }
    bodies
}
