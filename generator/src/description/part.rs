//! Parts among the included: a seat or a steering column by name, as the text of a file.

use super::person::plain;
use super::place::At;
use super::quantity::Quantity;
use super::shape::Problems;
use super::short::{Part as Written, PartName};
use super::tree;
use crate::part::{Kind, Part};
use serde::de::Deserialize;

/// The text of a part that stands at `at`; what is wrong is reported.
pub fn text(at: At<'_>, planar: bool, problems: &Problems) -> Option<String> {
    let written = Written::deserialize(at.node.value()).ok()?;
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
        Some(Quantity::Number(number)) => number.to_string(),
        Some(Quantity::Text(text) | Quantity::Param(text)) => text.clone(),
    };
    let part = Part {
        kind: match written.part {
            PartName::Cushion => Kind::Cushion,
            PartName::Seat => Kind::Seat,
            PartName::KneeBolster => Kind::KneeBolster,
            PartName::SteeringColumn => Kind::SteeringColumn,
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
    matches!(at.node.kind, tree::Kind::Map(_)) && at.node.get("part").is_some()
}
