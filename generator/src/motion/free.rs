//! A free reference joint: the origin of the root moves freely along the axes of the absolute frame.
//!
//! p = x,   H = (e_x, e_y, e_z; 0),   Ḣ v = 0,   q̇ = v,   work of a wrench (f, n): f
//!
//! In the plane the origin moves along x and z.

use super::numbers::number;
use super::variables::{Start, Variables};
use crate::description::joint::Coordinate;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::model::{Number, System};

/// Names and units of x and ẋ.
pub(crate) fn variables(directions: &[usize]) -> Variables {
    let [length, speed] = Coordinate::Length.units();
    let axes = || directions.iter().map(|&d| ["x", "y", "z"][d]);
    Variables {
        coordinates: axes().map(|axis| (axis.to_owned(), length)).collect(),
        velocities: axes().map(|axis| (format!("v{axis}"), speed)).collect(),
    }
}

/// x and ẋ at the start.
pub(crate) fn start<'g>(graph: &'g Graph, directions: &[usize], system: &System) -> Start<'g> {
    let along = |vector: &[Number; 3]| {
        let components = directions.iter().map(|&d| number(graph, &vector[d]));
        components.collect()
    };
    Start {
        q: along(&system.position),
        v: along(&system.velocity),
        chart: None,
    }
}

/// The vector with these components along the directions; the other components are 0.
pub(crate) fn vector<'g>(
    graph: &'g Graph,
    directions: &[usize],
    components: &[Expr<'g>],
) -> Vec3<'g> {
    let mut vector = Vec3::zero(graph);
    for (&direction, &component) in directions.iter().zip(components) {
        vector.0[direction] = component;
    }
    vector
}
