//! The same scene with nothing left out: the equations that a general program, written for every scene, would evaluate.
//!
//! Every force that the text mentions acts, switched off or not. A planar motion becomes one in space, with
//! quaternions, and all elements have three principal moments in axes of their own. Every number of the model, zeros
//! included, is a run-time parameter, so that nothing folds. Every term of a law is there, with the coefficient 0 where
//! the scene does not have it. Joints have a law about each rotation. A field acts on every element by itself. A fixed
//! reference joint is one with the prescribed acceleration 0. At the default parameters the motion is that of the scene
//! with its forces switched on.
//!
//! Not generalised are: terms that a law can only have with a coefficient that is not 0 (hysteresis, stops, locks,
//! reels and limiters of belts, damping that fades in), switches, motions of vehicles, the tree, which joints and
//! bodies have forces at all, the points of curves, free reference joints, and Bryant angles if the text asks for them.
//! Outputs are left out.

use super::planar;

use crate::law::ForceKind;
use crate::model::part::{Field as Of, Fresh, Part};
use crate::model::{Dimension, Force, Given, Model, Reference, Translation};

/// The scene with nothing left out. `written` is the model with everything that its text mentions.
pub fn general(written: &Model) -> Model {
    let mut model = written.clone();
    model.outputs.clear();
    if model.dimension == Dimension::Plane {
        planar::embedded(&mut model);
    }
    for system in &mut model.systems {
        if system.reference == Reference::Fixed {
            system.reference = Reference::Prescribed(Translation {
                given: Given::Acceleration,
                curves: [None, None, None],
                stops: None,
            });
        }
    }
    let forces = std::mem::take(&mut model.forces);
    model.forces = forces.into_iter().flat_map(by_element).collect();

    let old = std::mem::take(&mut model.parameters);
    let defaults: Vec<f64> = old.iter().map(|p| p.default).collect();
    let mut curves = std::mem::take(&mut model.curves);
    let mut parameters = Vec::new();
    let mut fresh = Fresh {
        parameters: &mut parameters,
        curves: &mut curves,
        line: None,
    };
    for number in model.numbers_mut() {
        *number = fresh.number(number.value(&defaults));
    }
    for system in &mut model.systems {
        if let Reference::Prescribed(translation) = &mut system.reference {
            let curves = translation.curves.iter_mut();
            curves.for_each(|curve| curve.put_in(&mut fresh));
        }
    }
    for force in &mut model.forces {
        for field in force.law.fields(Dimension::Space) {
            if let Of::Term(term, part) = field
                && !term.as_written
            {
                part.put_in(&mut fresh);
            }
        }
    }
    model.curves = curves;
    model.parameters = parameters;
    model.normalize();
    model
}

/// Splits a field into one field for each element; returns any other force unchanged.
fn by_element(force: Force) -> Vec<Force> {
    match ForceKind::of(&force) {
        ForceKind::Field(field) => {
            let each = field.on.iter().enumerate().map(|(index, &id)| Force {
                name: format!("{}-{}", force.name, index + 1),
                active: force.active,
                law: Box::new(crate::law::types::Field {
                    on: vec![id],
                    acceleration: field.acceleration.clone(),
                }),
            });
            each.collect()
        }
        _ => vec![force],
    }
}
