//! Input that is not a model, NaN and infinite numbers, and models that no user would write.
//!
//! Random inputs have fixed seeds, so that failures are reproducible. A check reports the input that caused a fault.

mod arithmetic;
mod curve;
mod equations;
mod number;
mod panics;
mod run;
mod sample;
mod start;
mod text;
mod tree;

use crate::case::Case;

/// The cases of this group.
pub const CASES: &[Case] = &[
    number::IN_THE_TEXT,
    number::AT_RUN_TIME,
    curve::CURVES,
    text::MODELS,
    text::TABLES,
    arithmetic::QUANTITIES,
    run::SETTINGS,
    run::PARAMETERS,
    equations::RANDOM_MODELS,
];
