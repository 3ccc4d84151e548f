//! The effects of a model in a few lines, for the top of its generated source.
//!
//! The lines depend on the model alone. So a text that mentions effects that are out gives the same lines as one that
//! does not.

use super::{Effect, Entry, Reason, of_model};
use crate::model::part::Field;
use crate::model::{Body, ElementId, Model};

/// The effects that are in, kind by kind; then those that vanish by structure, with the reason.
pub fn summary(model: &Model) -> Vec<String> {
    let entries = of_model(model);
    let mut lines = vec!["In:".to_owned()];
    let inertial = |of: fn(ElementId) -> Effect| -> Vec<String> {
        let here = entries.iter().filter(|e| e.is_in);
        let here = here.filter_map(|entry| match entry.effect? {
            effect @ (Effect::FirstMoment(id)
            | Effect::GyroscopicMoment(id)
            | Effect::Armature(id)
            | Effect::Coupling(id))
                if effect == of(id) =>
            {
                Some(model.name_of(Body::Element(id)))
            }
            _ => None,
        });
        here.collect()
    };
    for entry in &entries {
        let Some(effect) = entry.effect.filter(|_| entry.is_in) else {
            continue;
        };
        if let Effect::OutOfPlane
        | Effect::FreeTranslation { .. }
        | Effect::PrescribedTranslation { .. } = effect
        {
            lines.push(format!("  {}", entry.name));
        }
    }
    for (what, of) in [
        (
            "first moment about the joint",
            Effect::FirstMoment as fn(ElementId) -> Effect,
        ),
        ("gyroscopic moment", Effect::GyroscopicMoment),
        ("inertia of rotors", Effect::Armature),
        ("coupling of joints", Effect::Coupling),
    ] {
        let of = inertial(of);
        if !of.is_empty() {
            lines.push(format!("  {what}: {}", of.join(", ")));
        }
    }
    for force in 0..model.forces.len() {
        lines.push(format!("  {}", of_force(model, force)));
    }
    for (what, names) in [
        (
            "parameters",
            names(model.parameters.iter().map(|p| p.name.as_str())),
        ),
        (
            "outputs",
            names(model.outputs.iter().map(|o| o.name.as_str())),
        ),
    ] {
        if !names.is_empty() {
            lines.push(format!("  {what}: {names}"));
        }
    }
    if lines.len() == 1 {
        lines.push("  nothing".to_owned());
    }
    let mut vanished = by_reason(&entries);
    if !vanished.is_empty() {
        lines.push("Out, by the structure of the model:".to_owned());
        lines.append(&mut vanished);
    }
    lines
}

/// "contact seat-back (child/torso, frame): elastic, damping, friction"
fn of_force(model: &Model, force: usize) -> String {
    let mut kind = model.forces[force].law.clone();
    let (mut bodies, mut terms) = (Vec::new(), Vec::new());
    for field in kind.fields(model.dimension) {
        match field {
            Field::Body(body) => bodies.push(model.name_of(body)),
            Field::Number(..) => {}
            Field::Term(term, part) => {
                if part.is_in() {
                    terms.push(term.name);
                }
            }
        }
    }
    let elements: usize = model.systems.iter().map(|s| s.elements.len()).sum();
    let bodies = match (kind.key(), bodies.len()) {
        // Its name is that of the element.
        ("joint", _) => String::new(),
        ("field", count) if count == elements => " (all elements)".to_owned(),
        _ => format!(" ({})", bodies.join(", ")),
    };
    let terms = match terms.is_empty() {
        true => "nothing but what outputs look at".to_owned(),
        false => terms.join(", "),
    };
    format!("{}{bodies}: {terms}", Effect::Force { force }.name(model))
}

/// The effects that vanish, grouped by reason.
fn by_reason(entries: &[Entry]) -> Vec<String> {
    let mut reasons: Vec<(&str, &str, Vec<&str>)> = Vec::new();
    for entry in entries.iter().filter(|e| e.reason == Reason::Structure) {
        let (owner, part) = entry.name.split_once(": ").unwrap_or(("", &entry.name));
        let found = reasons
            .iter_mut()
            .find(|(p, why, _)| *p == part && *why == entry.why);
        match found {
            Some((_, _, owners)) => owners.push(owner),
            None => reasons.push((part, &entry.why, vec![owner])),
        }
    }
    let line = |(part, why, owners): (&str, &str, Vec<&str>)| match owners.join(", ") {
        owners if owners.is_empty() => format!("  {part}: {why}"),
        owners => format!("  {owners}: {part}: {why}"),
    };
    reasons.into_iter().map(line).collect()
}

fn names<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
