//! The keys of a field.

use crate::description::force::Acting;
use crate::description::measure::Acceleration;
use crate::description::place::At;
use crate::description::shape::Flat;
use crate::diagnostic::{quoted, suggestion};
use crate::model::declared::{
    DeclaredLaw, Kind, Names, PolarVector, Reader, Written, declare, declared_terms,
};
use crate::model::law::Terms;
use crate::model::part;
use crate::model::resolve::Resolver;
use crate::model::{Body, ElementId};

/// The keys of a field.
pub type FieldKeys = Written<Field>;

declare! {
    /// A uniform acceleration field: a force m·a at the centre of gravity of every element of `on`.
    Field as "a field" only written {
        /// name, unique among the fields
        field: String,
        /// when it acts
        acting: Flat<Acting>,
    } and kept {
        /// per absolute axis: a number, or a curve of time (s → m/s²)
        acceleration: PolarVector<Acceleration>,
        /// list of systems and elements that feel it
        on: Elements = "all elements",
    }
}

impl DeclaredLaw for Field {
    const KEY: &'static str = "field";
    const OBSERVABLE: bool = false;
}

impl Terms for Field {
    declared_terms!(flatten);
}

/// Elements that are named, one by one or as all elements of a system.
pub struct Elements;

impl Kind for Elements {
    type Written = Option<Vec<String>>;
    type Kept = Vec<ElementId>;

    fn keep(reader: &mut Reader<'_, '_, '_>, key: &'static str) -> Option<Vec<ElementId>> {
        let names: Self::Written = reader.written(key)?;
        elements_of(reader.resolver, names.as_deref(), reader.at.key(key))
    }

    fn add_fields<'a>(kept: &'a mut Vec<ElementId>, _: &Names<'_>, to: &mut Vec<part::Field<'a>>) {
        to.extend(kept.iter().map(|&id| part::Field::Body(Body::Element(id))));
    }
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
