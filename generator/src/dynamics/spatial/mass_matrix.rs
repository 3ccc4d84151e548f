//! The mass matrix S by the composite-body algorithm. Column j follows from the wrench that the composite body of its
//! element needs for v̇_j = 1: its power per velocity of the element and of all elements that carry it.
//! \[Featherstone 2008, ch. 6\]
//!
//! The composite body of an element consists of the element and all elements that turn with it. Elements that it
//! carries on a ball joint count as a point mass.

use super::{Column, Spatial, Wrench};
use crate::dynamics::augmented_body::AugmentedBody;
use crate::expression::Expr;
use crate::expression::vector::{Sym3, Vec3};

/// Sets the entries of S of the system; entries that are not set are 0 in every state.
pub fn mass_matrix<'g>(spatial: &Spatial<'g, '_>, matrix: &mut [Vec<Option<Expr<'g>>>]) {
    // sums the terms of all columns that are shares of the same velocity
    let mut add = |i: usize, j: usize, value: Expr<'g>| {
        if !value.is_zero() {
            let sum = matrix[i][j].map_or(value, |entry| entry + value);
            matrix[i][j] = Some(sum);
            matrix[j][i] = Some(sum);
        }
    };
    let elements = &spatial.of_system().elements;
    let composite = composites(spatial);
    let reference = spatial.layout.reference_velocities(spatial.system);
    let directions = spatial.layout.directions;
    if let Some(rows) = &reference {
        for row in rows.clone() {
            add(row, row, composite[0].mass);
        }
    }
    for (k, body) in composite.iter().enumerate() {
        let columns = spatial.columns(k);
        for (number, column) in columns.iter().enumerate() {
            let j = column.row;
            spatial
                .graph
                .section(format!("S[·, {}]", spatial.layout.velocities[j].name));
            let mut wrench = Wrench {
                force: body.mass * column.slide + column.axis.cross(body.first_moment),
                moment: body.first_moment.cross(column.slide) + body.inertia.times(column.axis),
            };
            add(j, j, column.armature);
            add(j, j, column.power(&wrench));
            // on the diagonal, the cross term of two columns counts twice
            let mut beside = |other: &Column<'g>, wrench: &Wrench<'g>| {
                let together = other.power(wrench);
                match other.row == j {
                    true => add(j, j, 2.0 * together),
                    false => add(other.row, j, together),
                }
            };
            for other in &columns[..number] {
                beside(other, &wrench);
            }
            let mut element = k;
            while let Some(parent) = elements[element].parent {
                wrench = wrench.on_carrier(spatial.motion_of(element));
                for other in spatial.columns(parent) {
                    beside(&other, &wrench);
                }
                element = parent;
            }
            if let Some(rows) = &reference {
                for (i, &direction) in rows.clone().zip(directions) {
                    add(i, j, wrench.force.0[direction]);
                }
            }
        }
    }
}

/// The composite body of each element, about its origin.
fn composites<'g>(spatial: &Spatial<'g, '_>) -> Vec<AugmentedBody<'g>> {
    let mut bodies = spatial.bodies();
    let elements = &spatial.of_system().elements;
    for k in (0..elements.len()).rev() {
        let Some(parent) = elements[k].parent else {
            continue;
        };
        spatial
            .graph
            .section(format!("element {}: composite body", spatial.label(parent)));
        let (mass, own, inertia) = (bodies[k].mass, bodies[k].first_moment, bodies[k].inertia);
        let motion = spatial.motion_of(k);
        let u = motion.offset;
        let to = &mut bodies[parent];
        to.mass = to.mass + mass;
        to.first_moment = to.first_moment + mass * u;
        to.inertia = to.inertia + spread(u, mass * u);
        if motion.turns_with_carrier {
            to.first_moment = to.first_moment + own;
            to.inertia = to.inertia + inertia + spread(u, own) + spread(own, u);
        }
    }
    bodies
}

/// The symmetric part of (a · b) 1 − a bᵀ.
fn spread<'g>(a: Vec3<'g>, b: Vec3<'g>) -> Sym3<'g> {
    Sym3::from_fn(|i, j| {
        if i == j {
            let (k, l) = ((i + 1) % 3, (i + 2) % 3);
            a.0[k] * b.0[k] + a.0[l] * b.0[l]
        } else {
            -(0.5 * (a.0[i] * b.0[j] + a.0[j] * b.0[i]))
        }
    })
}
