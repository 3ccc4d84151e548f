//! Duration and sampling of a run.

use super::Resolver;
use super::quantity::{Measure, describe};
use crate::description::measure::TIME;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::run::Run as Written;
use crate::model::Run;

/// Default length of a run \[s\].
const DURATION: f64 = 1.0;
/// Default time between samples \[s\].
const EVERY: f64 = 0.01;
/// Largest number of samples of a run.
const MAX_SAMPLES: f64 = 1e6;

/// The checked form of a run, with defaults for missing and wrong values.
pub(super) fn run(resolver: &Resolver<'_>, written: Option<&Written>, at: At<'_>) -> Run {
    let before = resolver.problems.count();
    let (duration, every) = match written {
        Some(run) => (
            time(
                resolver,
                run.duration.as_deref(),
                at.key("duration"),
                DURATION,
            ),
            time(resolver, run.every.as_deref(), at.key("every"), EVERY),
        ),
        None => (DURATION, EVERY),
    };
    if resolver.problems.count() == before {
        if every > duration {
            resolver.problems.add(at.key("every").problem(
                format!(
                    "the time between samples, {every} s, is longer than the run, {duration} s"
                ),
                "give a shorter time; a run of 150 ms sampled every 2 ms has 76 samples",
            ));
        } else if duration / every > MAX_SAMPLES {
            resolver.problems.add(at.key("every").problem(
                format!("the run has {:.1e} samples", duration / every),
                format!("at most {MAX_SAMPLES:e} samples are taken: give a longer `every` or a shorter `duration`"),
            ));
        }
    }
    Run { duration, every }
}

/// A positive time \[s\]; `default` if none is written.
pub(crate) fn time(
    resolver: &Resolver<'_>,
    quantity: Option<&Quantity>,
    at: At<'_>,
    default: f64,
) -> f64 {
    let Some(quantity) = quantity else {
        return default;
    };
    let Some((time, measure)) = resolver.constant(quantity, at, "the time of a run") else {
        return default;
    };
    if let Measure::Known(dimension) = measure
        && dimension != TIME.dimension
    {
        resolver.problems.add(at.problem(
            format!("a time is needed here, but this is {}", describe(dimension)),
            "give a time such as `150 ms`",
        ));
    } else if time <= 0.0 {
        resolver.problems.add(at.problem(
            format!("the time {time} s is not positive"),
            "give a time such as `150 ms`",
        ));
    }
    time
}
