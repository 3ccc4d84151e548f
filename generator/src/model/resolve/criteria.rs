//! By what a run is judged: the outputs of the places of a dummy. Whether there is such a regulation and such a dummy, whoever judges knows.

use super::Resolver;
use super::output::output;
use crate::description::criteria::{Criteria as Written, FilterStandard};
use crate::description::output::{Component, Output as WrittenOutput};
use crate::description::place::At;
use crate::description::short::Each;
use crate::diagnostic::{quoted, suggestion};
use crate::model::Criteria;

/// Places that may be an element, whose acceleration is measured at its centre of gravity.
const ELEMENTS: [&str; 2] = ["head", "chest"];

/// The criteria; outputs of elements that they need are added to those of the model, headings to `headings`.
pub(super) fn criteria(
    resolver: &mut Resolver<'_>,
    written: Option<&Written>,
    at: At<'_>,
    headings: &mut Vec<String>,
) -> Option<Criteria> {
    let written = written?;
    let mut places = Vec::new();
    for (key, text) in written.places() {
        let place = key.replace('_', "-");
        if resolver.outputs.iter().any(|output| output.name == text) {
            places.push((place, text.to_owned()));
        } else if ELEMENTS.contains(&key) && text.contains('/') {
            places.extend(components_of(resolver, text, &place, at.key(key), headings));
        } else {
            let names: Vec<&str> = resolver.outputs.iter().map(|o| o.name.as_str()).collect();
            resolver.problems.add(at.key(key).problem(
                format!("there is no output {}", quoted(text)),
                suggestion(
                    text,
                    names.iter().copied(),
                    match ELEMENTS.contains(&key) {
                        true => "name an output, or an element as `system/element`",
                        false => "name an output of the model",
                    },
                ),
            ));
        }
    }
    Some(Criteria {
        standard: written.standard.trim().to_owned(),
        dummy: written.dummy.trim().to_owned(),
        sae: written.filter_standard == Some(FilterStandard::SaeJ211),
        occupant: written.occupant.as_ref().map(|said| said.trim().to_owned()),
        places,
    })
}

/// Outputs of accelerometers at the centre of gravity of an element, along its own axes: in the plane along x and z. Fields do not act on what they read, so
/// that the pulse of a sled may be a field.
fn components_of(
    resolver: &mut Resolver<'_>,
    element: &str,
    place: &str,
    at: At<'_>,
    headings: &mut Vec<String>,
) -> Vec<(String, String)> {
    if resolver.element_id(element, at).is_none() {
        return Vec::new();
    }
    let axes = [
        ("x", Component::X),
        ("y", Component::Y),
        ("z", Component::Z),
    ];
    let planar = resolver.planar;
    let there = axes.into_iter().filter(|(axis, _)| !planar || *axis != "y");
    let mut places = Vec::new();
    for (axis, component) in there {
        let name = format!("{place}-{axis}");
        let asked = WrittenOutput {
            name: name.clone(),
            enabled: None,
            of: Each(element.to_owned()),
            what: "accelerometer".to_owned(),
            at: None,
            component: Some(Each(component)),
            axes: Some("local".to_owned()),
            relative_to: None,
            on: None,
            segment: None,
            ring: None,
            about: None,
            freedom: None,
            code: None,
            filter: None,
            mirror: None,
        };
        let output = output(resolver, &asked, at, headings);
        resolver.outputs.extend(output);
        places.push((name.clone(), name));
    }
    places
}
