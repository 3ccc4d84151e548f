//! A ball joint: the element turns freely about it, and its orientation A (local frame → absolute frame) has
//! coordinates of its own. In the plane it is a hinge about y. The joint transmits forces to the carrier, but no
//! moments except those of joint laws.
//!
//! ω = Σ e_j v_j,   H = (0, e_j),   Ḣ v: ε = Σ ė_j v_j
//!
//! | [orientation](Orientation) | q | v | A | axes e_j | ε | q̇ |
//! |---|---|---|---|---|---|---|
//! | angle | φ | φ̇ | Ry(φ) | e_y | 0 | v |
//! | quaternion | (w, x, y, z) | ω | A(q) | e_x, e_y, e_z | 0 | ½ (0, ω) ∘ q |
//! | Bryant | φ₁, φ₂, φ₃ | φ̇ | Rx(φ₁) Ry(φ₂) Rz(φ₃) P | e_x, Rx e_y, Rx Ry e_z | v₁v₂ e₁ × e₂ + v₃ (v₁e₁ + v₂e₂) × e₃ | v |
//!
//! P is the constant matrix of the [chart] in which the angles are.   \[MADYMO 1980\]

use super::chart;
use super::element::ElementMotion;
use super::numbers::{bryant, quaternion_of_bryant, rotation_of_quaternion, vector};
use super::variables::{Start, Variables};
use crate::description::joint::Coordinate;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
use crate::model::{Coordinates, Dimension, Element};

/// The description of the orientation of an element on a ball joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// One angle about +y.
    Angle,
    /// A unit quaternion (w, x, y, z), with the velocity ω.
    Quaternion,
    /// Three Bryant angles, with the velocity φ̇.
    Bryant,
}

impl Orientation {
    /// The orientation that a model uses.
    pub fn of(dimension: Dimension, coordinates: Coordinates) -> Self {
        match (dimension, coordinates) {
            (Dimension::Plane, _) => Orientation::Angle,
            (Dimension::Space, Coordinates::Quaternion) => Orientation::Quaternion,
            (Dimension::Space, Coordinates::Bryant) => Orientation::Bryant,
        }
    }
}

/// Names and units of q and v for an orientation.
pub(crate) fn variables(orientation: Orientation) -> Variables {
    let [angle, rate] = Coordinate::Angle.units();
    let (coordinates, unit, velocities): (&[&str], _, &[&str]) = match orientation {
        Orientation::Angle => (&["phi"], angle, &["omega"]),
        Orientation::Quaternion => (&["qw", "qx", "qy", "qz"], "", &["wx", "wy", "wz"]),
        Orientation::Bryant => (
            &["phi1", "phi2", "phi3"],
            angle,
            &["dphi1", "dphi2", "dphi3"],
        ),
    };
    let of = |names: &[&str], unit| {
        let named = names.iter().map(|name| ((*name).to_owned(), unit));
        named.collect()
    };
    Variables {
        coordinates: of(coordinates, unit),
        velocities: of(velocities, rate),
    }
}

/// q, v and the chart of an element at the start.
pub(crate) fn start<'g>(
    graph: &'g Graph,
    orientation: Orientation,
    element: &Element,
) -> Start<'g> {
    let angles = vector(graph, &element.angles).0;
    let omega = vector(graph, &element.angular_velocity);
    let (q, v, chart) = match orientation {
        Orientation::Angle => (vec![angles[1]], vec![omega.0[1]], None),
        Orientation::Quaternion => (
            quaternion_of_bryant(angles).to_vec(),
            omega.0.to_vec(),
            None,
        ),
        Orientation::Bryant => {
            let charted = chart::start(graph, angles, omega);
            let (q, v) = (charted.angles.to_vec(), charted.rates.to_vec());
            (q, v, Some(charted.chart))
        }
    };
    Start { q, v, chart }
}

/// q̇ of a quaternion that turns with the angular velocity ω: ½ (0, ω) ∘ q.
pub(crate) fn quaternion_rates<'g>(q: &[Expr<'g>], v: &[Expr<'g>]) -> [Expr<'g>; 4] {
    let &[w, x, y, z] = q else {
        unreachable!("an element has four coordinates of orientation here")
    };
    let &[a, b, c] = v else {
        unreachable!("an element turns with three velocities in space")
    };
    let (a, b, c) = (0.5 * a, 0.5 * b, 0.5 * c);
    [
        -(a * x + b * y + c * z),
        a * w + b * z - c * y,
        b * w + c * x - a * z,
        c * w + a * y - b * x,
    ]
}

/// Rotation, axes, ω and ε of an element, from its own coordinates and velocities.
pub(crate) fn motion<'g>(
    graph: &'g Graph,
    orientation: Orientation,
    q: &[Expr<'g>],
    v: &[Expr<'g>],
    chart: Option<Expr<'g>>,
) -> ElementMotion<'g> {
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let unit = |i: usize| Vec3(std::array::from_fn(|j| if i == j { one } else { zero }));
    let mut motion = ElementMotion::frame(graph);
    match orientation {
        Orientation::Angle => {
            let (s, c) = (q[0].sin(), q[0].cos());
            motion.rotation = Mat3([[c, zero, s], [zero, one, zero], [-s, zero, c]]);
            motion.angle = q[0];
            motion.axes = vec![unit(1)];
            motion.omega = Vec3([zero, v[0], zero]);
        }
        Orientation::Quaternion => {
            motion.rotation = rotation_of_quaternion(graph, [q[0], q[1], q[2], q[3]]);
            motion.axes = (0..3).map(unit).collect();
            motion.omega = Vec3([v[0], v[1], v[2]]);
        }
        Orientation::Bryant => {
            let (rotation, axes) = bryant(graph, [q[0], q[1], q[2]]);
            motion.rotation = chart.map_or(rotation, |chart| chart::rotation(&rotation, chart));
            motion.axes = axes.to_vec();
            // ω is the sum of three terms. Each axis turns with the rotations before it, so ė₂ = v₁ e₁ × e₂ and
            // ė₃ = (v₁ e₁ + v₂ e₂) × e₃.
            let before_third = v[0] * axes[0] + v[1] * axes[1];
            motion.omega = before_third + v[2] * axes[2];
            motion.bias =
                (v[0] * v[1]) * axes[0].cross(axes[1]) + v[2] * before_third.cross(axes[2]);
        }
    }
    motion.turns(motion.omega);
    motion
}
