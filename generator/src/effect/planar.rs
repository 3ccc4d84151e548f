//! Between space and the plane: a model of space seen from its side, and a planar model as one of space.

use crate::model::{
    Component, Coordinates, Dimension, FieldComponent, Force, JointLoadQuantity, Model, Number,
    Quantity, Reference, RotationQuantity, System, SystemQuantity,
};

/// The motion that is left of a model of space when y and the rotations about x and z are gone. `None` where an element could
/// then turn without inertia.
pub fn flattened(model: &Model) -> Option<Model> {
    let in_plane = |force: &Force| force.kind.exists_in_plane();
    if !model.systems.iter().all(System::has_balls_alone) || !model.forces.iter().all(in_plane) {
        return None;
    }
    let mut model = model.clone();
    model.dimension = Dimension::Plane;
    model.coordinates = Coordinates::Quaternion;
    for vehicle in &mut model.vehicles {
        for vector in [&mut vehicle.position, &mut vehicle.velocity] {
            vector[1] = Number::ZERO;
        }
        vehicle.translation.curves[1] = None;
        for axis in [0, 2] {
            vehicle.angles[axis] = FieldComponent::Constant(Number::ZERO);
            vehicle.angles_at_start[axis] = Number::ZERO;
        }
    }
    for system in &mut model.systems {
        for vector in [&mut system.position, &mut system.velocity] {
            vector[1] = Number::ZERO;
        }
        match &mut system.reference {
            Reference::Free | Reference::Fixed => {}
            Reference::Prescribed(translation) => translation.curves[1] = None,
            Reference::Riding { at, .. } => at[1] = Number::ZERO,
        }
        for element in &mut system.elements {
            for vector in [&mut element.at, &mut element.cg] {
                vector[1] = Number::ZERO;
            }
            element.axes = [Number::ZERO; 3];
            for vector in [
                &mut element.inertia,
                &mut element.angles,
                &mut element.angular_velocity,
            ] {
                (vector[0], vector[2]) = (Number::ZERO, Number::ZERO);
            }
        }
    }
    let mut keep = Vec::new();
    for force in &mut model.forces {
        keep.push(force.kind.flatten());
    }
    model.outputs.retain_mut(|output| {
        let there = match &mut output.quantity {
            Quantity::Point { at, projection, .. } => {
                at[1] = Number::ZERO;
                projection.lies_in_plane()
            }
            // the angle of the one turn has no sign in space
            Quantity::Rotation {
                what: RotationQuantity::Angle,
                projection,
                ..
            } => projection.component == Component::Y,
            Quantity::Rotation { projection, .. } => projection.is_about_y(),
            Quantity::JointLoad {
                what, projection, ..
            } => match what {
                JointLoadQuantity::Force => projection.lies_in_plane(),
                JointLoadQuantity::Moment => projection.is_about_y(),
            },
            Quantity::ForceOn { projection, .. } | Quantity::ForceOnPoints { projection, .. } => {
                projection.lies_in_plane()
            }
            Quantity::OfForce { what, .. } => what.exists_in_plane(),
            Quantity::Freedom { .. } | Quantity::Switch { .. } => true,
            Quantity::System {
                what: SystemQuantity::AngularMomentum,
                projection,
                ..
            } => projection.is_about_y(),
            Quantity::System { projection, .. } => projection.lies_in_plane(),
        };
        there && output.quantity.force_mut().is_none_or(|force| keep[*force])
    });
    model.keep_forces(&keep);
    model.is_regular().then_some(model)
}

/// Moments about x and z of a body of which that about y is known: three unequal ones, as a body may have them.
const OTHER_MOMENTS: [f64; 2] = [1.1, 0.8];

/// A planar model as one of space: the same motion, about and along y alone, by equations that do not know it.
pub fn embedded(model: &mut Model) {
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    model.dimension = Dimension::Space;
    model.coordinates = Coordinates::Quaternion;
    for element in model.systems.iter_mut().flat_map(|s| &mut s.elements) {
        let about_y = element.inertia[1].value(&defaults);
        // A point has moments of its own here, such as those of a rod of a tenth of a metre: what they are does not matter.
        let scale = if about_y > 0.0 {
            about_y
        } else {
            1e-2 * element.mass.value(&defaults)
        };
        element.inertia[0] = Number::Constant(OTHER_MOMENTS[0] * scale);
        element.inertia[2] = Number::Constant(OTHER_MOMENTS[1] * scale);
    }
    for force in &mut model.forces {
        force.kind.embed(&defaults);
    }
}
