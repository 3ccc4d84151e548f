//! Fields: a uniform acceleration, and the elements that feel it.

use super::keys::Field as Written;
use crate::description::place::At;
use crate::diagnostic::{quoted, suggestion};
use crate::model::resolve::Resolver;
use crate::model::{ElementId, FieldComponent};
use serde::Serialize;

/// Uniform acceleration field: a force m·a at the centre of gravity of every element of `on`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Field {
    /// Elements that feel the field.
    pub on: Vec<ElementId>,
    /// Components along the absolute axes \[m/s²\].
    pub acceleration: [FieldComponent; 3],
}

/// The checked form of a field.
pub(crate) fn field(resolver: &mut Resolver<'_>, written: &Written, at: At<'_>) -> Option<Field> {
    let acceleration = resolver.components(&written.acceleration, at.key("acceleration"));
    Some(Field {
        on: elements_of(resolver, written.on.as_deref(), at.key("on"))?,
        acceleration,
    })
}

/// The elements that are named, one by one or as all elements of a system; all elements if nothing is named.
fn elements_of(
    resolver: &Resolver<'_>,
    names: Option<&[String]>,
    at: At<'_>,
) -> Option<Vec<ElementId>> {
    let of_system = |system: usize| {
        (0..resolver.systems[system].elements.len())
            .map(move |element| ElementId { system, element })
    };
    let Some(names) = names else {
        return Some((0..resolver.systems.len()).flat_map(of_system).collect());
    };
    let mut chosen = Vec::new();
    let before = resolver.problems.count();
    for (index, name) in names.iter().enumerate() {
        let here = at.item(index);
        let added: Vec<ElementId> = match resolver.systems.iter().position(|s| s.name == *name) {
            Some(system) => of_system(system).collect(),
            None if name.contains('/') => resolver.element_id(name, here).into_iter().collect(),
            None => {
                let systems = resolver.systems.iter().map(|s| s.name.as_str());
                let inside = resolver
                    .paths
                    .iter()
                    .find(|p| p.rsplit('/').next() == Some(name));
                resolver.problems.add(here.problem(
                    format!("there is no system {}", quoted(name)),
                    match inside {
                        Some(path) => format!("did you mean the element {}?", quoted(path)),
                        None => suggestion(name, systems, "the model has no systems"),
                    },
                ));
                continue;
            }
        };
        if let Some(&twice) = added.iter().find(|id| chosen.contains(*id)) {
            resolver.problems.add(here.problem(
                format!(
                    "the element {} feels this field twice",
                    quoted(&resolver.path(twice))
                ),
                "name a system, or some of its elements, and each once",
            ));
        }
        chosen.extend(added);
    }
    if names.is_empty() {
        resolver.problems.add(at.problem(
            "the field acts on nothing",
            "name systems or elements, or leave `on` out for all",
        ));
    }
    chosen.sort_unstable();
    chosen.dedup();
    (resolver.problems.count() == before).then_some(chosen)
}
