//! Input that is no model, numbers that are none, models that nobody would write.
//!
//! Whatever is tried is made by a generator of numbers with a fixed seed, so that a test that fails fails again; the input that
//! broke something is part of what the check says.

mod arithmetic;
mod caught;
mod curve;
mod equations;
mod number;
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
