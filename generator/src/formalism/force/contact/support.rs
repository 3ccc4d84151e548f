//! How far an ellipsoid reaches, and where.
//!
//! With the direction n seen in the ellipsoid's axes as n' and the semi-axes a: h = √(Σ a_i² n'_i²), and the vector from the
//! deepest point to the centre is R (a_i² n'_i)/h.

use super::Motion;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::formalism::kinematics::constant_rotation;
use crate::formalism::numbers::vector;
use crate::model::{Contact, Dimension};

/// h, and the vector from the deepest point to the centre.
pub fn support<'g>(
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
