//! The units in which outputs are shown, as a model gives them.

use super::Resolver;
use crate::description::place::At;
use crate::description::unit::{Dimension, product, unit};
use crate::diagnostic::quoted;
use crate::model::units::Unit;

/// The name of standard gravity as a unit of acceleration.
const GRAVITY: &str = "g";

/// Enters the unit of an output, whose SI unit is `si`; reports an unknown unit, or one of another quantity.
pub(super) fn unit_shown(
    resolver: &mut Resolver<'_>,
    written: &str,
    si: &str,
    output: &str,
    at: At<'_>,
) {
    let text = written.trim().replace('\u{b0}', "deg");
    let of_output = product(si).map_or(Dimension::ONE, |unit| unit.dimension);
    let acceleration = Dimension::new(1, 0, -2, 0);
    // for an acceleration, `g` is standard gravity, not the gram
    let found = match text.as_str() {
        GRAVITY | "gn" if of_output == acceleration => unit("gn"),
        text => product(text),
    };
    let help = match si {
        "" => "give `%`, or leave the key `unit` out: the output is a pure number".to_owned(),
        si => format!("the output is in {si}: give a multiple of that, as in `unit: mm`"),
    };
    let Some(found) = found else {
        let problem = at.problem(format!("{} is no unit", quoted(written)), help);
        resolver.problems.add(problem);
        return;
    };
    // For a rotation, readers might take 1/s or Hz for turns or for radians.
    if found.dimension != of_output || found.dimension.radians() != of_output.radians() {
        let message = format!("the output cannot be shown in {}", quoted(written));
        resolver.problems.add(at.problem(message, help));
        return;
    }
    let name = match text.as_str() {
        "gn" => GRAVITY.to_owned(),
        _ => text,
    };
    let size = found.factor;
    resolver
        .units
        .push((output.to_owned(), Unit { name, size }));
}
