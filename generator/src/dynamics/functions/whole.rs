//! The whole of all systems: centre of mass, centroidal momentum, energies.
//!
//! The column (s, e) of a velocity of element k gives its bodies outboard the momentum f = M s + e × h_r and, about the
//! origin of k, n = h × s + J e + Σ h_c × (e × d_c). M and h are the mass and the first moment of everything outboard. h_r
//! and J are those of what turns with k; what is carried by a ball joint at d_c, with the first moment h_c about it, does
//! not turn and counts there as a point mass. \[Orin, Goswami, Lee 2013\]

use super::Known;
use super::frame::{both, by_rows};
use crate::dynamics::augmented::{own_inertia, rotated};
use crate::dynamics::energy;
use crate::dynamics::outputs::Scene;
use crate::dynamics::spatial::Spatial;
use crate::expression::vector::{Sym3, Vec3};
use crate::expression::{Expr, sum};
use crate::model::{Element, ElementId};
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

/// Σ m v and Σ ((r − c) × m v + I ω)
pub fn centroidal_momentum<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let scene = known.scene;
    let (graph, all) = (scene.graph, center_of_all(scene));
    let (mut linear, mut angular) = (Vec3::zero(graph), Vec3::zero(graph));
    for (id, element) in elements(scene) {
        let motion = scene.motion.element(id);
        let offset = motion.rotation.times(vector(graph, &element.cg));
        let momentum = number(graph, &element.mass) * motion.velocity_at(offset);
        let inertia = own_inertia(graph, scene.model.dimension, element);
        let inertia = rotated(graph, &motion.rotation, &inertia);
        linear = linear + momentum;
        angular = angular
            + (motion.position + offset - all).cross(momentum)
            + inertia.times(motion.omega);
    }
    both(linear, angular)
}

pub fn centroidal_matrix<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let Scene { graph, layout, .. } = *known.scene;
    let (none, all) = (Vec3::zero(graph), center_of_all(known.scene));
    let mut columns = vec![[none; 2]; known.size()];
    for spatial in known.systems {
        let composites = composites(spatial);
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

fn composites<'g>(spatial: &Spatial<'g, '_>) -> Vec<Composite<'g>> {
    let bodies = spatial.bodies().into_iter();
    let mut all: Vec<Composite<'g>> = bodies
        .map(|body| Composite {
            mass: body.mass,
            first: body.first_moment,
            turning: body.first_moment,
            inertia: body.inertia,
            carried: Vec::new(),
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

fn elements<'a>(scene: &Scene<'_, 'a>) -> impl Iterator<Item = (ElementId, &'a Element)> {
    let systems = scene.model.systems.iter().enumerate();
    systems.flat_map(|(system, of)| {
        let elements = of.elements.iter().enumerate();
        elements.map(move |(element, of)| (ElementId { system, element }, of))
    })
}

/// The centre of gravity of an element.
fn center<'g>(scene: &Scene<'g, '_>, id: ElementId, element: &Element) -> Vec3<'g> {
    let motion = scene.motion.element(id);
    motion.position + motion.rotation.times(vector(scene.graph, &element.cg))
}

/// The centre of mass of all systems.
fn center_of_all<'g>(scene: &Scene<'g, '_>) -> Vec3<'g> {
    let graph = scene.graph;
    let (mut mass, mut moment) = (graph.constant(0.0), Vec3::zero(graph));
    for (id, element) in elements(scene) {
        let own = number(graph, &element.mass);
        mass = mass + own;
        moment = moment + own * center(scene, id, element);
    }
    mass.recip() * moment
}
