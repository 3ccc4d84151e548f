//! Pose, velocity, acceleration and Jacobian of a frame. Vectors are in absolute axes, linear parts come first.

use super::{Frame, Known};
use crate::dynamics::outputs::ModelInMotion;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::model::Body;
use crate::motion::kinematics::constant_rotation;
use crate::motion::numbers::vector;

/// The rotation from the axes of the frame to absolute axes, and beside it the origin.
pub fn pose<'g>(known: &Known<'g, '_>, frame: &Frame) -> Vec<Expr<'g>> {
    let graph = known.scene.graph;
    let motion = known.scene.motion.body(frame.body);
    let rotation = motion
        .rotation
        .product(&constant_rotation(graph, &frame.angles));
    let origin = motion.position + offset(known, frame);
    let rows = rotation.0.into_iter().zip(origin.0);
    rows.flat_map(|([x, y, z], origin)| [x, y, z, origin])
        .collect()
}

pub fn velocity<'g>(known: &Known<'g, '_>, frame: &Frame) -> Vec<Expr<'g>> {
    let motion = known.scene.motion.body(frame.body);
    both(motion.velocity_at(offset(known, frame)), motion.omega)
}

pub fn acceleration<'g>(known: &Known<'g, '_>, frame: &Frame) -> Vec<Expr<'g>> {
    accelerated(known, frame, &known.given)
}

pub fn bias_acceleration<'g>(known: &Known<'g, '_>, frame: &Frame) -> Vec<Expr<'g>> {
    let none = vec![known.scene.graph.constant(0.0); known.size()];
    accelerated(known, frame, &none)
}

/// The acceleration of the frame for these v̇.
fn accelerated<'g>(
    known: &Known<'g, '_>,
    frame: &Frame,
    accelerations: &[Expr<'g>],
) -> Vec<Expr<'g>> {
    let scene = ModelInMotion {
        accelerations,
        ..*known.scene
    };
    both(
        scene.body_acceleration(frame.body, offset(known, frame)),
        scene.body_angular_acceleration(frame.body),
    )
}

/// The columns (s + e × r, e) of the velocities on the path from the frame to the reference joint. Where the path
/// passes a ball joint, what is inboard of it moves its place and does not turn the frame.
pub fn jacobian<'g>(known: &Known<'g, '_>, frame: &Frame) -> Vec<Expr<'g>> {
    let ModelInMotion { graph, layout, .. } = *known.scene;
    let none = Vec3::zero(graph);
    let mut columns = vec![[none; 2]; known.size()];
    if let Body::Element(id) = frame.body {
        let spatial = &known.systems[id.system];
        let (mut element, mut arm, mut turns) = (id.element, offset(known, frame), true);
        loop {
            for column in spatial.columns(element) {
                let [linear, angular] = &mut columns[column.row];
                *linear = *linear + column.slide + column.axis.cross(arm);
                if turns {
                    *angular = *angular + column.axis;
                }
            }
            let motion = spatial.motion_of(element);
            turns &= motion.turns_with_carrier;
            arm = match motion.turns_with_carrier {
                true => arm + motion.offset,
                false => motion.offset,
            };
            match spatial.of_system().elements[element].parent {
                Some(parent) => element = parent,
                None => break,
            }
        }
        if let Some(rows) = layout.reference_velocities(id.system) {
            for (row, &direction) in rows.zip(layout.directions) {
                columns[row][0].0[direction] = graph.constant(1.0);
            }
        }
    }
    by_rows(&columns)
}

/// The origin of a frame from that of its body, in absolute axes.
fn offset<'g>(known: &Known<'g, '_>, frame: &Frame) -> Vec3<'g> {
    let motion = known.scene.motion.body(frame.body);
    motion.rotation.times(vector(known.scene.graph, &frame.at))
}

pub fn both<'g>(linear: Vec3<'g>, angular: Vec3<'g>) -> Vec<Expr<'g>> {
    linear.0.into_iter().chain(angular.0).collect()
}

/// A matrix of columns of a linear and an angular vector.
pub fn by_rows<'g>(columns: &[[Vec3<'g>; 2]]) -> Vec<Expr<'g>> {
    let entry = |row: usize| columns.iter().map(move |column| column[row / 3].0[row % 3]);
    (0..6).flat_map(entry).collect()
}
