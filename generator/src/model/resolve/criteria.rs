//! The criteria by which a run is judged: the outputs at the places of a dummy. This module does not know which
//! regulations and dummies exist.

use super::Resolver;
use super::channel::{self, Wanted};
use super::output::output;
use crate::description::criteria::{Criteria as Written, FilterStandard};
use crate::description::output::{Component as WrittenComponent, Output as WrittenOutput};
use crate::description::place::At;
use crate::description::short_forms::Each;
use crate::diagnostic::{quoted, suggestion};
use crate::model::{Component, Criteria};

/// Places for which an element may be named; its acceleration is measured at its centre of gravity.
const ELEMENTS: [&str; 2] = ["head", "chest"];
/// The place for which the element of the head is named, whose joint is the upper neck.
const NECK: &str = "neck";

/// The checked criteria. If they name elements, outputs at these are added to those of the model, and their headings to
/// `headings`. Every output that they name becomes a channel of the standard.
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
        let found = resolver.outputs.iter().position(|one| one.name == text);
        match found {
            Some(index) if key != NECK => {
                name_channel(resolver, index, key, at.key(key));
                places.push((place, text.to_owned()));
            }
            _ if (ELEMENTS.contains(&key) || key == NECK) && text.contains('/') => {
                places.extend(added(resolver, text, key, at.key(key), headings));
            }
            _ => no_output(resolver, text, key, at.key(key)),
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

/// Reports a place that names neither an output nor an element.
fn no_output(resolver: &Resolver<'_>, text: &str, key: &str, at: At<'_>) {
    if key == NECK {
        resolver.problems.add(at.problem(
            format!("{} is no head", quoted(text)),
            "name the element of the head as `system/element`; single outputs belong under `neck_fx`, `neck_fz` and `neck_my`",
        ));
        return;
    }
    let names: Vec<&str> = resolver.outputs.iter().map(|o| o.name.as_str()).collect();
    resolver.problems.add(at.problem(
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

/// The direction of the standard along which a place measures.
fn direction(key: &str) -> Component {
    match key {
        "head" | "chest" => Component::Resultant,
        "femur_left" | "femur_right" => Component::Z,
        _ => match key.bytes().next_back() {
            Some(b'y') => Component::Y,
            Some(b'z') => Component::Z,
            // also for excursions, deflections and pulses
            _ => Component::X,
        },
    }
}

/// Makes an output that the criteria name a channel of the standard, unless its code has done so.
fn name_channel(resolver: &mut Resolver<'_>, index: usize, key: &str, at: At<'_>) {
    let output = &resolver.outputs[index];
    let (direction, by) = (direction(key), format!("the place {key}"));
    let of_lower_neck =
        |code: &&str| code.get(2..6) == Some("NECK") && !channel::is_upper_neck(code);
    if let Some(code) = output.code.as_deref().filter(of_lower_neck)
        && key.starts_with(NECK)
    {
        resolver.problems.add(at.problem(
            format!("{by} is the upper neck, and the code {code} of the output is not"),
            "name an output of the upper neck; there is no Nij of the lower one",
        ));
        return;
    }
    // the judging program reports an output that is a vector's magnitude in place of a component, or the reverse
    let whole = direction == Component::Resultant;
    if output.channel.is_some() || whole != output.quantity.is_resultant() {
        return;
    }
    let wanted = Wanted {
        direction,
        upper_neck: key.starts_with(NECK),
        says_axes: true,
        by: &by,
        at,
    };
    // the user chooses the place and axes of an excursion, of what slides, or of a pulse
    let own = [
        "head_excursion",
        "chest_deflection",
        "knee_left",
        "knee_right",
        "pulse",
    ];
    if own.contains(&key) {
        return;
    }
    if let Some((quantity, channel)) = channel::channel(resolver, output.quantity.clone(), wanted) {
        let output = &mut resolver.outputs[index];
        output.quantity = quantity;
        output.channel = Some(channel);
    }
}

/// Outputs at an element, along its own axes; in the plane without those that are 0 there. For a head or a chest:
/// accelerometers at the centre of gravity, whose reading excludes fields, so that the pulse of a sled may be a field.
/// For a neck: the loads in the joint of the head.
fn added(
    resolver: &mut Resolver<'_>,
    element: &str,
    key: &str,
    at: At<'_>,
    headings: &mut Vec<String>,
) -> Vec<(String, String)> {
    use WrittenComponent::{X, Y, Z};
    if resolver.element_id(element, at).is_none() {
        return Vec::new();
    }
    let joint = format!("joint {element}");
    let all: &[(&str, &str, &str, WrittenComponent)] = match key {
        NECK => &[
            ("neck_fx", &joint, "force", X),
            ("neck_fz", &joint, "force", Z),
            ("neck_my", &joint, "moment", Y),
        ],
        "head" => &[
            ("head_x", element, "accelerometer", X),
            ("head_y", element, "accelerometer", Y),
            ("head_z", element, "accelerometer", Z),
        ],
        _ => &[
            ("chest_x", element, "accelerometer", X),
            ("chest_y", element, "accelerometer", Y),
            ("chest_z", element, "accelerometer", Z),
        ],
    };
    let planar = resolver.planar;
    let there = all
        .iter()
        .filter(|(_, _, what, component)| !planar || *component != Y || *what == "moment");
    let mut places = Vec::new();
    for (place, of, what, component) in there {
        let name = place.replace('_', "-");
        let asked = asked(&name, of, what, *component);
        let Some(mut output) = output(resolver, &asked, at, headings) else {
            continue;
        };
        let wanted = Wanted {
            direction: direction(place),
            upper_neck: key == NECK,
            says_axes: false,
            by: &format!("the place {key}"),
            at,
        };
        if let Some((quantity, channel)) =
            channel::channel(resolver, output.quantity.clone(), wanted)
        {
            (output.quantity, output.channel) = (quantity, Some(channel));
            resolver.outputs.push(output);
            places.push((name.clone(), name));
        } else {
            break;
        }
    }
    places
}

/// An output along the axes of its own body.
fn asked(name: &str, of: &str, what: &str, component: WrittenComponent) -> WrittenOutput {
    WrittenOutput {
        name: name.to_owned(),
        enabled: None,
        of: Each(of.to_owned()),
        what: what.to_owned(),
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
        unit: None,
        mirror: None,
    }
}
