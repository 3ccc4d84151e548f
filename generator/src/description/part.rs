//! Parts among the included: a seat or a steering column by name, as the text of a file.

use super::person::{is_word, plain};
use super::place::At;
use super::quantity::Quantity;
use super::shape::Problems;
use super::shape::Shape as _;
use super::short_forms::{Part as Written, PartName};
use super::tree;
use crate::car_part::{CarPart, CarPartKind};
use crate::diagnostic::quoted;

/// The text of a part that stands at `at`; what is wrong is reported.
pub fn text(at: At<'_>, planar: bool, problems: &Problems) -> Option<String> {
    let written = Written::read(&at.node.value()).ok()?;
    let place = at.key("at");
    let wanted = if planar { 2 } else { 3 };
    if written.at.len() != wanted {
        let shape = if planar { "[x, z]" } else { "[x, y, z]" };
        problems.add(place.problem(
            format!(
                "a place has {wanted} coordinates here, not {}",
                written.at.len()
            ),
            format!("write {shape}"),
        ));
        return None;
    }
    let numbers = written.at.iter().enumerate();
    let numbers = numbers.map(|(index, number)| plain(number, "m", place.item(index), problems));
    let place: Vec<f64> = numbers.collect::<Option<_>>()?;
    let angle = match &written.angle {
        Some(angle) => Some(plain(angle, "rad", at.key("angle"), problems)?),
        None => None,
    };
    let times = match &written.times {
        None => "1".to_owned(),
        Some(Quantity::Number(number)) if number.is_finite() => number.to_string(),
        Some(Quantity::Text(name) | Quantity::Param(name)) if is_word(name, '_') => name.clone(),
        Some(_) => {
            problems.add(at.key("times").problem(
                "this is neither a number nor the name of a parameter",
                "write one of the two; an expression may be the value of a parameter",
            ));
            return None;
        }
    };
    let people = written.against.iter().flatten().enumerate();
    let people = people.map(|(index, person)| (at.key("against").item(index), person));
    let names = [(at.key("name"), &written.name), (at.key("on"), &written.on)];
    for (place, name) in names.into_iter().chain(people) {
        if !is_word(name, '-') {
            problems.add(place.problem(
                format!("{} is no name", quoted(name)),
                "write small letters, digits and dashes, a letter first, such as seat-2",
            ));
            return None;
        }
    }
    let part = CarPart {
        kind: match written.part {
            PartName::Cushion => CarPartKind::Cushion,
            PartName::Seat => CarPartKind::Seat,
            PartName::KneeBolster => CarPartKind::KneeBolster,
            PartName::SteeringColumn => CarPartKind::SteeringColumn,
        },
        name: written.name,
        on: written.on,
        at: match place[..] {
            [x, z] => [x, 0.0, z],
            _ => [place[0], place[1], place[2]],
        },
        angle,
        against: written.against.unwrap_or_default(),
        times,
        planar,
    };
    Some(part.yaml())
}

/// Whether an entry of `include` is a part.
pub fn is_part(at: At<'_>) -> bool {
    matches!(at.node.kind, tree::NodeKind::Map(_)) && at.node.get("part").is_some()
}
