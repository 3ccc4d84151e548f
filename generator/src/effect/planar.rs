//! Conversion between space and the plane: a spatial model seen from its side, and a planar model as a spatial one.

use crate::model::{
    Component, Coordinates, Dimension, FieldComponent, Force, JointLoadQuantity, Model, Number,
    Quantity, Reference, RotationQuantity, System, SystemQuantity,
};

/// The planar part of a spatial model: without y and without rotations about x and z. `None` if an element could then
/// turn without inertia.
pub fn flattened(model: &Model) -> Option<Model> {
    let in_plane = |force: &Force| force.law.exists_in_plane();
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
        keep.push(force.law.flatten());
    }
    model.outputs.retain_mut(|output| {
        let mut leaves = output.quantity.leaves_mut().into_iter();
        leaves
            .all(|leaf| flatten_quantity(leaf) && leaf.force_mut().is_none_or(|force| keep[*force]))
    });
    model.keep_forces(&keep);
    model.is_regular().then_some(model)
}

/// Makes of a quantity in space what is left of it in the plane; false where that is nothing.
fn flatten_quantity(quantity: &mut Quantity) -> bool {
    match quantity {
        Quantity::Point { at, projection, .. } => {
            at[1] = Number::ZERO;
            projection.lies_in_plane()
        }
        // the sign of the angle of a single rotation is lost in space
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
        Quantity::Freedom { .. } | Quantity::Switch { .. } | Quantity::Formula(_) => true,
        Quantity::System {
            what: SystemQuantity::AngularMomentum,
            projection,
            ..
        } => projection.is_about_y(),
        Quantity::System { projection, .. } => projection.lies_in_plane(),
    }
}

/// Moments about x and z, relative to the known one about y. All three differ, as those of a real body may.
const OTHER_MOMENTS: [f64; 2] = [1.1, 0.8];

/// Turns a planar model into a spatial one with the same motion, along and about y only; the equations do not know that
/// it is planar.
pub fn embedded(model: &mut Model) {
    let defaults: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
    model.dimension = Dimension::Space;
    model.coordinates = Coordinates::Quaternion;
    for element in model.systems.iter_mut().flat_map(|s| &mut s.elements) {
        let about_y = element.inertia[1].value(&defaults);
        // A point gets moments of inertia, such as those of a rod of a tenth of a metre; their values do not matter.
        let scale = if about_y > 0.0 {
            about_y
        } else {
            1e-2 * element.mass.value(&defaults)
        };
        element.inertia[0] = Number::Constant(OTHER_MOMENTS[0] * scale);
        element.inertia[2] = Number::Constant(OTHER_MOMENTS[1] * scale);
    }
    for force in &mut model.forces {
        force.law.embed(&defaults);
    }
}
