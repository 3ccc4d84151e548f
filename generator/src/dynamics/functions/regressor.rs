//! How inverse dynamics depends on the inertia of the elements, on which it depends linearly: τ = Y p.
//!
//! p has for each element the mass m, the first moment h = m c, and the inertia J about the origin, both in its axes,
//! in the order m, h_x, h_y, h_z, J_xx, J_xy, J_yy, J_xz, J_yz, J_zz, which is Pinocchio's. With the acceleration A of
//! the origin less the fields, they need the wrenches about it
//!
//! | | force | moment |
//! |---|---|---|
//! | m | A | 0 |
//! | h along e | α × e + ω × (ω × e) | e × A |
//! | J | 0 | J α + ω × J ω |

use super::Known;
use crate::dynamics::outputs::ModelInMotion;
use crate::dynamics::spatial::{Spatial, Wrench};
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::model::{Body, ElementId};

/// The entries of J in the order of p.
const INERTIA: [[usize; 2]; 6] = [[0, 0], [0, 1], [1, 1], [0, 2], [1, 2], [2, 2]];

pub fn regressor<'g>(known: &Known<'g, '_>) -> Vec<Expr<'g>> {
    let scene = ModelInMotion {
        accelerations: &known.given,
        ..*known.scene
    };
    let mut columns = Vec::new();
    for spatial in known.systems {
        for k in 0..spatial.of_system().elements.len() {
            for wrench in wrenches(&scene, spatial.id(k)) {
                columns.push(powers(spatial, k, wrench, known.size()));
            }
        }
    }
    let entry = |row: usize| {
        columns
            .iter()
            .map(move |column: &Vec<Expr<'g>>| column[row])
    };
    (0..known.size()).flat_map(entry).collect()
}

/// The wrench that each parameter of an element needs.
fn wrenches<'g>(scene: &ModelInMotion<'g, '_>, id: ElementId) -> Vec<Wrench<'g>> {
    let graph = scene.graph;
    let (none, body) = (Vec3::zero(graph), Body::Element(id));
    let motion = scene.motion.element(id);
    let (omega, alpha) = (motion.omega, scene.body_angular_acceleration(body));
    let origin = scene.body_acceleration(body, none) - scene.fields(id);
    let mut wrenches = vec![Wrench {
        force: origin,
        moment: none,
    }];
    for axis in 0..3 {
        let along = motion.rotation.column(axis);
        wrenches.push(Wrench {
            force: alpha.cross(along) + motion.centripetal(along),
            moment: along.cross(origin),
        });
    }
    let own = [omega, alpha].map(|v| motion.rotation.transposed_times(v));
    for [i, j] in INERTIA {
        // the matrix with 1 in this entry and in its mirror image
        let times = |v: Vec3<'g>| {
            let mut product = none;
            product.0[i] = v.0[j];
            product.0[j] = v.0[i];
            product
        };
        let [omega, alpha] = own;
        let moment = times(alpha) + omega.cross(times(omega));
        wrenches.push(Wrench {
            force: none,
            moment: motion.rotation.times(moment),
        });
    }
    wrenches
}

/// The power of a wrench on an element per velocity.
fn powers<'g>(
    spatial: &Spatial<'g, '_>,
    element: usize,
    mut wrench: Wrench<'g>,
    size: usize,
) -> Vec<Expr<'g>> {
    let mut powers = vec![spatial.graph.constant(0.0); size];
    let mut at = Some(element);
    while let Some(element) = at {
        for column in spatial.columns(element) {
            powers[column.row] = powers[column.row] + column.power(&wrench);
        }
        at = spatial.of_system().elements[element].parent;
        if at.is_some() {
            wrench = wrench.on_carrier(spatial.motion_of(element));
        }
    }
    if let Some(rows) = spatial.layout.reference_velocities(spatial.system) {
        for (row, &direction) in rows.zip(spatial.layout.directions) {
            powers[row] = wrench.force.0[direction];
        }
    }
    powers
}
