//! The effects of a scene: every term of the equations that may be in or out.
//!
//! S v̇ = r_s + r_k = Σ effects
//!
//! An effect that is out leaves no trace in the generated source. [`of_model`] lists the effects of a model. From the
//! same expressions as the equations it finds which effects vanish by the structure of the model.
//! [`of_annotated_model`] adds where the text calls for each effect, and what the text mentions without effect.
//! [`without`](fn@without) leaves one effect out; [`general`](fn@general) leaves out none.

mod annotated_model;
mod cost;
mod general_model;
mod name;
mod planar;
mod removal;
mod structure;
mod summary;

pub use annotated_model::of_annotated_model;
pub use cost::{Cost, cost, counted};
pub use general_model::general;
pub use removal::{Variant, without};
pub use summary::summary;

use crate::law::types::Field;
use crate::model::annotated_model::SourceLine;
use crate::model::{Dimension, ElementId, Model, Reference};
use structure::{Felt, Gyroscopic, Structure};

/// An effect that is in or out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// The dimension y: translation along y, rotation about x and z.
    OutOfPlane,
    /// The reference joint of a system is free to move.
    FreeTranslation {
        /// Index of the system.
        system: usize,
    },
    /// The reference joint of a system is accelerated along an axis.
    PrescribedTranslation {
        /// Index of the system.
        system: usize,
        /// The absolute axis.
        axis: usize,
    },
    /// The first moment w of an element together with the bodies that it carries: it couples rotation of the element
    /// and acceleration of its joint.
    FirstMoment(ElementId),
    /// The gyroscopic moment ω × Jω of an element together with the bodies that it carries.
    GyroscopicMoment(ElementId),
    /// The inertia of rotors on the joint of an element.
    Armature(ElementId),
    /// Freedoms of the joint of an element that follow others.
    Coupling(ElementId),
    /// A whole force with its geometry.
    Force {
        /// Index into [`Model::forces`].
        force: usize,
    },
    /// A term of a force.
    Term {
        /// Index into [`Model::forces`].
        force: usize,
        /// Index among the terms of its law.
        term: usize,
    },
    /// A field that is applied to elements one by one, instead of once to the reference joint.
    FieldByElement {
        /// Index into [`Model::forces`].
        force: usize,
        /// Index of the system.
        system: usize,
    },
    /// A number that stays adjustable.
    Parameter(usize),
    /// A column of the output table.
    Output(usize),
}

/// Why an effect is in or out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// In, because the text calls for it.
    Written,
    /// Out, because the text mentions it but says 0 or off.
    SwitchedOff,
    /// Out, because it vanishes by the structure of the model.
    Structure,
    /// Out, because the text does not mention it.
    Absent,
}

impl Reason {
    /// The reason as one word, for machines.
    pub fn word(self) -> &'static str {
        match self {
            Reason::Written => "written",
            Reason::SwitchedOff => "switched off",
            Reason::Structure => "structure",
            Reason::Absent => "not mentioned",
        }
    }
}

/// An effect, whether it is in or out, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// "contact seat-back: friction"
    pub name: String,
    /// Whether it is in.
    pub is_in: bool,
    /// The effect in terms of the model; `None` for an effect that only the text mentions.
    pub effect: Option<Effect>,
    /// Why it is in or out.
    pub reason: Reason,
    /// The reason in words; empty if the place says everything.
    pub why: String,
    /// The place in the text that calls for it or switches it off.
    pub place: Option<SourceLine>,
}

impl Entry {
    fn present(model: &Model, effect: Effect) -> Self {
        Entry {
            name: effect.name(model),
            is_in: true,
            effect: Some(effect),
            reason: Reason::Written,
            why: String::new(),
            place: None,
        }
    }

    fn vanished(model: &Model, effect: Effect, why: impl Into<String>) -> Self {
        Entry {
            is_in: false,
            reason: Reason::Structure,
            why: why.into(),
            ..Entry::present(model, effect)
        }
    }

    fn absent(model: &Model, effect: Effect) -> Self {
        Entry {
            is_in: false,
            reason: Reason::Absent,
            why: "not mentioned".to_owned(),
            ..Entry::present(model, effect)
        }
    }

    /// An entry for an effect that only the text mentions.
    fn switched_off(name: String, why: impl Into<String>, place: Option<SourceLine>) -> Self {
        Entry {
            name,
            is_in: false,
            effect: None,
            reason: Reason::SwitchedOff,
            why: why.into(),
            place,
        }
    }
}

/// The effects of a model: those that are in, those that vanish by its structure, and the terms that its forces do not
/// have.
pub fn of_model(model: &Model) -> Vec<Entry> {
    let structure = Structure::of(model);
    let mut entries = Vec::new();
    entries.push(match model.dimension {
        Dimension::Space => Entry::present(model, Effect::OutOfPlane),
        Dimension::Plane => Entry::vanished(model, Effect::OutOfPlane, "motion in the plane"),
    });
    for system in 0..model.systems.len() {
        translation(model, system, &mut entries);
    }
    inertia(model, &structure, &mut entries);
    for force in 0..model.forces.len() {
        of_force(model, &structure, force, &mut entries);
    }
    let parameters = 0..model.parameters.len();
    entries.extend(parameters.map(|index| Entry::present(model, Effect::Parameter(index))));
    let outputs = 0..model.outputs.len();
    entries.extend(outputs.map(|index| Entry::present(model, Effect::Output(index))));
    entries
}

/// The translation of a reference joint.
fn translation(model: &Model, system: usize, entries: &mut Vec<Entry>) {
    let free = Effect::FreeTranslation { system };
    let prescribed = |axis| Effect::PrescribedTranslation { system, axis };
    match &model.systems[system].reference {
        Reference::Free => entries.push(Entry::present(model, free)),
        Reference::Fixed => {
            entries.push(Entry::vanished(model, free, "the reference joint is fixed"));
        }
        Reference::Riding { .. } => {
            let why = "the reference joint moves with a vehicle";
            entries.push(Entry::vanished(model, free, why));
        }
        Reference::Prescribed(translation) => {
            entries.push(Entry::vanished(
                model,
                free,
                "the reference joint moves as prescribed",
            ));
            for (axis, curve) in translation.curves.iter().enumerate() {
                if curve.is_some() {
                    entries.push(Entry::present(model, prescribed(axis)));
                } else if model.dimension == Dimension::Space || axis != 1 {
                    let why = "no motion is prescribed along this axis";
                    entries.push(Entry::vanished(model, prescribed(axis), why));
                }
            }
        }
    }
}

/// Effects of inertia, element by element.
fn inertia(model: &Model, structure: &Structure, entries: &mut Vec<Entry>) {
    for (system, of_system) in model.systems.iter().enumerate() {
        for element in 0..of_system.elements.len() {
            let id = ElementId { system, element };
            let carries = of_system.elements.iter().any(|e| e.parent == Some(element));
            let body = if carries && of_system.has_balls_alone() {
                " of it and what it carries"
            } else {
                ""
            };
            let effect = Effect::FirstMoment(id);
            entries.push(if structure.first_moment[system][element] {
                Entry::present(model, effect)
            } else {
                let why = format!("the joint is at the centre of gravity{body}");
                Entry::vanished(model, effect, why)
            });
            let freedoms = of_system.elements[element].joint.freedoms();
            if freedoms.iter().any(|f| !f.armature.is_zero()) {
                entries.push(Entry::present(model, Effect::Armature(id)));
            }
            if freedoms.iter().any(|f| !f.is_own()) {
                entries.push(Entry::present(model, Effect::Coupling(id)));
            }
            let effect = Effect::GyroscopicMoment(id);
            match &structure.gyroscopic[system][element] {
                Gyroscopic::Plane => {}
                Gyroscopic::Spherical => {
                    let why = format!("Ix = Iy = Iz about the joint{body}");
                    entries.push(Entry::vanished(model, effect, why));
                }
                Gyroscopic::FixedAxis => {
                    let why = "it turns about one of its principal axes alone";
                    entries.push(Entry::vanished(model, effect, why));
                }
                Gyroscopic::Axisymmetric(which) => entries.push(Entry {
                    why: format!("axisymmetric: {which}"),
                    ..Entry::present(model, effect)
                }),
                Gyroscopic::Triaxial => entries.push(Entry::present(model, effect)),
            }
        }
    }
    if model.dimension == Dimension::Plane {
        entries.push(Entry {
            name: "gyroscopic moments".to_owned(),
            is_in: false,
            effect: None,
            reason: Reason::Structure,
            why: "motion in the plane: ω and Jω are parallel".to_owned(),
            place: None,
        });
    }
}

/// The effects of a force: the whole force if more than one term is in, its terms, and how a field enters.
fn of_force(model: &Model, structure: &Structure, force: usize, entries: &mut Vec<Entry>) {
    let kind = &model.forces[force].law;
    let terms = kind.terms(model.dimension);
    let count = terms.iter().filter(|(_, is_in)| *is_in).count();
    if count > 1 {
        entries.push(Entry::present(model, Effect::Force { force }));
    }
    if count == 0 {
        entries.push(Entry {
            why: "none of its terms is in, but outputs look at it".to_owned(),
            ..Entry::present(model, Effect::Force { force })
        });
    }
    for (term, (_, is_in)) in terms.iter().enumerate() {
        let effect = Effect::Term { force, term };
        entries.push(if *is_in {
            Entry::present(model, effect)
        } else {
            Entry::absent(model, effect)
        });
    }
    if kind.get::<Field>().is_some() {
        for (system, felt) in structure.felt[force].iter().enumerate() {
            let effect = Effect::FieldByElement { force, system };
            match felt {
                Felt::None => {}
                Felt::All(count) => {
                    let all = match count {
                        1 => "its only element feels".to_owned(),
                        count => format!("all {count} elements share"),
                    };
                    let why = format!("{all} the field: it enters once, at the reference joint");
                    entries.push(Entry::vanished(model, effect, why));
                }
                Felt::Some => entries.push(Entry::present(model, effect)),
            }
        }
    }
}
