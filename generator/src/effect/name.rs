//! The names of effects, and the keys that call for them.

use super::Effect;
use crate::model::{Body, Model};

const AXES: [&str; 3] = ["x", "y", "z"];

impl Effect {
    /// The name for people: "contact seat-back: friction".
    pub fn name(self, model: &Model) -> String {
        let owner = self.owner(model);
        let part = match self {
            Effect::OutOfPlane => {
                return "motion out of the x–z plane (along y, about x and z)".to_owned();
            }
            Effect::FreeTranslation { .. } => "free translation of the reference joint".to_owned(),
            Effect::PrescribedTranslation { axis, .. } => {
                format!(
                    "prescribed motion of the reference joint along {}",
                    AXES[axis]
                )
            }
            Effect::FirstMoment(_) => "first moment about its joint".to_owned(),
            Effect::GyroscopicMoment(_) => "gyroscopic moment".to_owned(),
            Effect::Armature(_) => "inertia of rotors on its joint".to_owned(),
            Effect::Coupling(_) => "coupling of its joint".to_owned(),
            Effect::Term { force, term } => {
                let terms = model.forces[force].law.terms(model.dimension);
                terms[term].0.name.clone()
            }
            Effect::FieldByElement { system, .. } => {
                format!("on each element of {}", model.systems[system].name)
            }
            Effect::Force { .. } | Effect::Parameter(_) | Effect::Output(_) => return owner,
        };
        format!("{owner}: {part}")
    }

    /// The owner of its keys in [`Places`](crate::model::annotated_model::SourceLines).
    pub fn owner(self, model: &Model) -> String {
        match self {
            Effect::OutOfPlane => "model".to_owned(),
            Effect::FreeTranslation { system } | Effect::PrescribedTranslation { system, .. } => {
                format!("system {}", model.systems[system].name)
            }
            Effect::FirstMoment(id)
            | Effect::GyroscopicMoment(id)
            | Effect::Armature(id)
            | Effect::Coupling(id) => {
                format!("element {}", model.name_of(Body::Element(id)))
            }
            Effect::Force { force }
            | Effect::Term { force, .. }
            | Effect::FieldByElement { force, .. } => {
                let force = &model.forces[force];
                format!("{} {}", force.law.key(), force.name)
            }
            Effect::Parameter(index) => format!("parameter {}", model.parameters[index].name),
            Effect::Output(index) => format!("output {}", model.outputs[index].name),
        }
    }

    /// Its keys below the owner. The first of them that exists calls for the effect.
    pub fn keys(self, model: &Model) -> Vec<String> {
        let key = match self {
            Effect::Term { force, term } => {
                let mut terms = model.forces[force].law.terms(model.dimension);
                let mut keys = terms.swap_remove(term).0.keys;
                keys.push(String::new());
                return keys;
            }
            Effect::OutOfPlane => "dimension".to_owned(),
            Effect::FreeTranslation { .. } => "reference".to_owned(),
            Effect::PrescribedTranslation { axis, .. } => {
                let planar = model.dimension == crate::model::Dimension::Plane;
                let index = if planar { axis / 2 } else { axis };
                format!("reference.acceleration[{index}]")
            }
            Effect::FirstMoment(_) => "cg".to_owned(),
            Effect::GyroscopicMoment(_) => "inertia".to_owned(),
            Effect::Armature(_) | Effect::Coupling(_) => "joint".to_owned(),
            Effect::FieldByElement { .. } => "on".to_owned(),
            Effect::Force { .. } | Effect::Parameter(_) | Effect::Output(_) => String::new(),
        };
        vec![key, String::new()]
    }
}
