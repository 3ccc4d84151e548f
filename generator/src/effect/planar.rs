//! Conversion between space and the plane: a spatial model seen from its side, and a planar model as a spatial one.

use crate::model::{
    Against, Component, Coordinates, Dimension, FieldComponent, ForceKind, JointLoadQuantity,
    JointTorque, Model, Number, Projection, Quantity, Reference, RotationQuantity, System,
    SystemQuantity, UserQuantity,
};

/// The planar part of a spatial model: without y and without rotations about x and z. `None` if an element could then turn
/// without inertia.
pub fn flattened(model: &Model) -> Option<Model> {
    let is_airbag = |force: &crate::model::Force| matches!(force.kind, ForceKind::Airbag(_));
    // a bag has no volume in the plane
    if !model.systems.iter().all(System::has_balls_alone) || model.forces.iter().any(is_airbag) {
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
        keep.push(flatten_force(&mut force.kind));
    }
    model.outputs.retain_mut(|output| {
        let there = match &mut output.quantity {
            Quantity::Point { at, projection, .. } => {
                at[1] = Number::ZERO;
                lies_in_plane(*projection)
            }
            // the sign of the angle of a single rotation is lost in space
            Quantity::Rotation {
                what: RotationQuantity::Angle,
                projection,
                ..
            } => projection.component == Component::Y,
            Quantity::Rotation { projection, .. } => is_about_y(*projection),
            Quantity::JointLoad {
                what, projection, ..
            } => match what {
                JointLoadQuantity::Force => lies_in_plane(*projection),
                JointLoadQuantity::Moment => is_about_y(*projection),
            },
            Quantity::ForceOn { projection, .. } | Quantity::ForceOnPoints { projection, .. } => {
                lies_in_plane(*projection)
            }
            Quantity::Joint { about, .. } => *about == 1,
            Quantity::Freedom { .. } => true,
            Quantity::Contact { .. }
            | Quantity::Belt { .. }
            | Quantity::Spring { .. }
            | Quantity::Airbag { .. }
            | Quantity::Switch { .. } => true,
            Quantity::User { what, .. } => match what {
                UserQuantity::Force(_, projection) => lies_in_plane(*projection),
                UserQuantity::Moment(_, projection) => is_about_y(*projection),
                UserQuantity::Torque(_, about)
                | UserQuantity::Angle(_, about)
                | UserQuantity::AngleRate(_, about) => *about == 1,
                _ => true,
            },
            Quantity::System {
                what: SystemQuantity::AngularMomentum,
                projection,
                ..
            } => is_about_y(*projection),
            Quantity::System { projection, .. } => lies_in_plane(*projection),
        };
        there && output.quantity.force_mut().is_none_or(|force| keep[*force])
    });
    model.keep_forces(&keep);
    model.is_regular().then_some(model)
}

/// Whether this component of a vector in the x–z plane is not 0 by itself.
fn lies_in_plane(projection: Projection) -> bool {
    projection.component != Component::Y
}

/// Whether this component of a vector along y is not 0 by itself.
fn is_about_y(projection: Projection) -> bool {
    matches!(projection.component, Component::Y | Component::Resultant)
}

/// Reduces a force to its planar part; returns false if nothing is left.
fn flatten_force(kind: &mut ForceKind) -> bool {
    match kind {
        ForceKind::Joint { about, .. } => {
            about[0] = JointTorque::default();
            about[2] = JointTorque::default();
            true
        }
        ForceKind::Freedom { .. } => true,
        ForceKind::Field { acceleration, .. } => {
            acceleration[1] = FieldComponent::Constant(Number::ZERO);
            true
        }
        ForceKind::Contact(contact) => {
            contact.ellipsoid.at[1] = Number::ZERO;
            contact.against.place_mut().at[1] = Number::ZERO;
            contact.semi_axes[1] = Number::ZERO;
            (contact.axes[0], contact.axes[2]) = (Number::ZERO, Number::ZERO);
            match &mut contact.against {
                Against::Plane(plane) => {
                    if let Some(extent) = &mut plane.extent {
                        // Of its two lengths, keep the one that is visible from the side.
                        let away = plane.tangent[1].constant().is_some_and(|y| y.abs() > 0.5);
                        extent.half_lengths.remove(usize::from(!away));
                    }
                    plane.normal[1] = Number::ZERO;
                    plane.tangent = [Number::ZERO; 3];
                    // Seen from the side, a plane with the normal y covers everything.
                    !plane.normal.iter().all(Number::is_zero)
                }
                Against::Ellipsoid(second) => {
                    second.semi_axes[1] = Number::ZERO;
                    (second.axes[0], second.axes[2]) = (Number::ZERO, Number::ZERO);
                    true
                }
            }
        }
        ForceKind::Belt(belt) => {
            belt.points_mut()
                .for_each(|point| point.at[1] = Number::ZERO);
            true
        }
        ForceKind::Airbag(_) => false,
        ForceKind::Spring(spring) => {
            spring.from.at[1] = Number::ZERO;
            spring.to.at[1] = Number::ZERO;
            true
        }
        ForceKind::Load(load) => {
            load.on.at[1] = Number::ZERO;
            load.force[1] = FieldComponent::Constant(Number::ZERO);
            for axis in [0, 2] {
                load.moment[axis] = FieldComponent::Constant(Number::ZERO);
            }
            true
        }
        // its function expects vectors of space
        ForceKind::User(user) => {
            for point in &mut user.points {
                point.value.at[1] = Number::ZERO;
            }
            for line in &mut user.lines {
                line.value.from.at[1] = Number::ZERO;
                line.value.to.at[1] = Number::ZERO;
            }
            true
        }
    }
}

/// Moments about x and z, relative to the known one about y. All three differ, as those of a real body may.
const OTHER_MOMENTS: [f64; 2] = [1.1, 0.8];

/// The width along y of a planar scene, from which nothing moves away \[m\].
const ENDLESS: f64 = 1e3;

/// Turns a planar model into a spatial one with the same motion, along and about y only; the equations do not know that it is
/// planar.
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
        if let ForceKind::Contact(contact) = &mut force.kind {
            let mean = |[x, _, z]: &[Number; 3]| {
                Number::Constant(0.5 * (x.value(&defaults) + z.value(&defaults)))
            };
            contact.semi_axes[1] = mean(&contact.semi_axes);
            match &mut contact.against {
                Against::Plane(plane) => {
                    let [x, _, z] = plane.normal.clone();
                    plane.tangent = [z, Number::ZERO, Number::negative(x)];
                    if let Some(extent) = &mut plane.extent {
                        extent.half_lengths.push(Number::Constant(ENDLESS));
                    }
                }
                Against::Ellipsoid(second) => second.semi_axes[1] = mean(&second.semi_axes),
            }
        }
    }
}
