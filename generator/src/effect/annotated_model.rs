//! The effects of a scene: those of its model, with the lines that call for them, and those that its text mentions
//! without effect.

use super::structure::idle_parameters;
use super::{Effect, Entry, Reason, of_model};
use crate::model::Force;
use crate::model::annotated_model::AnnotatedModel;
use crate::model::annotated_model::SourceLine;
use crate::model::part::Field;

/// The effects of a scene, in the order of the model. Switched-off effects stand after the others of their kind.
pub fn of_annotated_model(scene: &AnnotatedModel) -> Vec<Entry> {
    let model = &scene.model;
    let mut entries = of_model(model);
    let idle = idle_parameters(model);
    for entry in &mut entries {
        entry.place = place(scene, entry.effect);
        match entry.effect {
            Some(Effect::Parameter(index)) if idle[index] => {
                entry.why = "nothing that is computed depends on it".to_owned();
            }
            None => entry.place = scene.places.get("model", "dimension").cloned(),
            _ => {}
        }
    }
    for force in 0..scene.written.forces.len() {
        mentioned_in_vain(scene, force, &mut entries);
    }
    unused_parameters(scene, &mut entries);
    for name in scene.places.of_kind("output") {
        if !model.outputs.iter().any(|o| o.name == name) {
            let owner = format!("output {name}");
            let place = scene.places.get(&owner, "enabled").cloned();
            entries.push(Entry::switched_off(
                owner,
                "the output is switched off",
                place,
            ));
        }
    }
    entries
}

/// The first line that calls for an effect.
fn place(scene: &AnnotatedModel, effect: Option<Effect>) -> Option<SourceLine> {
    let effect = effect?;
    let owner = effect.owner(&scene.model);
    let keys = effect.keys(&scene.model);
    let found = keys.iter().find_map(|key| scene.places.get(&owner, key));
    found.cloned()
}

/// Adds the terms of a force that the text mentions but the model does not have.
fn mentioned_in_vain(scene: &AnnotatedModel, force: usize, entries: &mut Vec<Entry>) {
    let model = &scene.model;
    let written = &scene.written.forces[force];
    let name = Effect::Force { force }.name(&scene.written);
    let same = |f: &Force| f.name == written.name && f.law.key() == written.law.key();
    let is_in = model.forces.iter().any(same);
    let enabled = scene.places.get(&name, "enabled").cloned();
    let disabled = enabled.filter(|place| place.text.ends_with("false"));
    let mut off = Vec::new();
    let mut kind = written.law.clone();
    for field in kind.fields(model.dimension) {
        let Field::Term(term, part) = field else {
            continue;
        };
        let mut keys = term.keys.iter();
        let Some(place) = keys.find_map(|key| scene.places.get(&name, key)) else {
            continue;
        };
        let (why, place) = match &disabled {
            Some(disabled) if !is_in && part.is_in() => ("the force is switched off", disabled),
            _ if part.is_in() => (term.needs, place),
            _ => (part.zero(), place),
        };
        let entry = Entry::switched_off(format!("{name}: {}", term.name), why, Some(place.clone()));
        if !is_in {
            off.push(entry);
        } else if let Some(absent) = entries
            .iter_mut()
            .find(|e| e.reason == Reason::Absent && e.name == entry.name)
        {
            *absent = entry;
        }
    }
    if !is_in {
        let whole = match disabled {
            Some(place) => Entry::switched_off(name, "the force is switched off", Some(place)),
            None => {
                let place = scene.places.get(&name, "").cloned();
                Entry::switched_off(name, "none of its terms is in", place)
            }
        };
        let before = first(entries, |effect| {
            matches!(effect, Effect::Parameter(_) | Effect::Output(_))
        });
        entries.splice(before..before, std::iter::once(whole).chain(off));
    }
}

/// Index of the first such effect, or the number of entries if there is none.
fn first(entries: &[Entry], such: impl Fn(Effect) -> bool) -> usize {
    let found = entries.iter().position(|e| e.effect.is_some_and(&such));
    found.unwrap_or(entries.len())
}

/// Adds the parameters that the text declares but that nothing depends on.
fn unused_parameters(scene: &AnnotatedModel, entries: &mut Vec<Entry>) {
    let unused = scene.unused_parameters();
    let before = first(entries, |effect| matches!(effect, Effect::Output(_)));
    let unused = unused.into_iter().map(|(name, why)| {
        let name = format!("parameter {name}");
        let place = scene.places.get(&name, "").cloned();
        Entry::switched_off(name, why, place)
    });
    entries.splice(before..before, unused);
}

impl AnnotatedModel {
    /// The declared parameters that nothing depends on: names, and why.
    pub fn unused_parameters(&self) -> Vec<(String, String)> {
        let mut written = self.written.clone();
        let mut mentioned = vec![false; written.parameters.len()];
        for number in written.numbers_mut() {
            number.for_each_parameter(&mut |index| mentioned[index] = true);
        }
        let declared = self.written.parameters.iter().zip(mentioned);
        let unused = declared.filter(|(parameter, _)| {
            let mut kept = self.model.parameters.iter();
            !kept.any(|p| p.name == parameter.name)
        });
        let unused = unused.map(|(parameter, mentioned)| {
            let why = if mentioned {
                "everything that it is used for is out"
            } else {
                "nothing depends on it"
            };
            (parameter.name.clone(), why.to_owned())
        });
        unused.collect()
    }
}
