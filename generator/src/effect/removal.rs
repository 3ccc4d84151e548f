//! A model without one of its effects, as if the text had never mentioned it.

use super::{Effect, planar};
use crate::dynamics::augmented_body::Omitted;
use crate::law::types::Field as FieldLaw;
use crate::model::Joint;
use crate::model::part::{Field, Part};
use crate::model::{Model, Number, Reference};

/// A model, and an effect that is left out of its equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    /// The model, in its normal form.
    pub model: Model,
    /// A gyroscopic moment to leave out; no model can be without it.
    pub omitted: Option<Omitted>,
}

impl Variant {
    /// The model with all its effects.
    pub fn of(model: &Model) -> Self {
        Variant {
            model: model.clone(),
            omitted: None,
        }
    }

    /// The variant without outputs, and without forces that only outputs use: what remains is needed for accelerations.
    pub fn without_outputs(mut self) -> Self {
        self.model.outputs.clear();
        self.model.normalize();
        self
    }
}

/// The model without an effect; `None` if the remaining motion would not be determined.
// Long: one `match`, an arm for each kind of effect.
pub fn without(model: &Model, effect: Effect) -> Option<Variant> {
    let mut variant = Variant::of(model);
    let model = &mut variant.model;
    let dimension = model.dimension;
    match effect {
        Effect::OutOfPlane => *model = planar::flattened(model)?,
        Effect::FreeTranslation { system } => {
            let system = &mut model.systems[system];
            system.reference = Reference::Fixed;
            system.velocity = [Number::ZERO; 3];
        }
        Effect::PrescribedTranslation { system, axis } => {
            if let Reference::Prescribed(translation) = &mut model.systems[system].reference {
                translation.curves[axis].leave_out();
            }
        }
        Effect::FirstMoment(id) => {
            let elements = &mut model.systems[id.system].elements;
            // With joints further out no place of the centre of gravity makes w exactly 0; without inertia nothing
            // remains.
            let carries = elements.iter().any(|e| e.parent == Some(id.element));
            let element = &mut elements[id.element];
            element.cg = [Number::ZERO; 3];
            if carries || !model.is_regular() {
                return None;
            }
        }
        Effect::GyroscopicMoment(id) => {
            // in the frames of links bodies are regrouped, so no body has a gyroscopic moment of its own
            if !model.systems[id.system].has_balls_alone() {
                return None;
            }
            variant.omitted = Some(Omitted(id));
        }
        Effect::Armature(id) | Effect::Coupling(id) => {
            let elements = &mut model.systems[id.system].elements;
            if let Joint::Freedoms(freedoms) = &mut elements[id.element].joint {
                for freedom in freedoms {
                    match effect {
                        Effect::Armature(_) => freedom.armature = Number::ZERO,
                        _ => freedom.follows = None,
                    }
                }
            }
            if !model.is_regular() {
                return None;
            }
        }
        Effect::Force { force } => {
            model
                .outputs
                .retain_mut(|output| output.quantity.force_mut().is_none_or(|f| *f != force));
            let keep: Vec<bool> = (0..model.forces.len()).map(|f| f != force).collect();
            model.keep_forces(&keep);
        }
        Effect::Term { force, term } => {
            let fields = model.forces[force].law.fields(dimension).into_iter();
            let mut terms = fields.filter_map(|field| match field {
                Field::Term(_, part) => Some(part),
                Field::Body(_) | Field::Number(..) => None,
            });
            if let Some(part) = terms.nth(term) {
                part.leave_out();
            }
        }
        Effect::FieldByElement { force, system } => {
            if let Some(field) = model.forces[force].law.get_mut::<FieldLaw>() {
                field.on.retain(|id| id.system != system);
            }
        }
        Effect::Parameter(parameter) => {
            let value = model.parameters[parameter].default;
            let by = |index| match index == parameter {
                true => Number::Constant(value),
                false => Number::Parameter(index),
            };
            for number in model.numbers_mut() {
                *number = number.with_parameters(&by);
            }
        }
        Effect::Output(output) => {
            model.outputs.remove(output);
        }
    }
    variant.model.normalize();
    Some(variant)
}
