//! Studies how much time accuracy costs, and computes runs of a requested or promised accuracy.
//!
//! ```text
//!                ┌─ reference: double-double ─┐
//! model ─ plan ─ settings ─ errors, then times ─ points ─ front ─ what each further digit costs
//! ```
//!
//! | module | what it holds |
//! |---|---|
//! | [`setting`], [`plan`], [`schedule`] | one way to compute a motion; all ways that are compared; the order in which they are run |
//! | [`mod@reference`] | the motion that all others are compared with |
//! | [`norm`], [`reading`] | errors of the state, and of numbers that engineers read off |
//! | [`run`] | one run of a setting, and its states |
//! | [`point`], [`study`] | the result of one setting; the results of all of them |
//! | [`front`], [`conclusion`] | the best settings, and a sentence about them |
//! | [`fastest_motion`] | the motion that limits the steps of explicit methods |
//! | [`report`] | a study as a table, a page, CSV, JSON and a diagram |
//! | [`target`] | a run of a requested accuracy |
//! | [`check`] | a run of the promised accuracy, checked by a second run |
//! | [`difference`], [`comparison`] | how far two runs are apart; what of it counts, and how much sharper the next one is |
//! | [`conditioning`], [`cause`] | how precisely an output can be known; why two runs do not agree |

pub mod cause;
pub mod check;
pub mod comparison;
pub mod conclusion;
pub mod conditioning;
pub mod difference;
pub mod fastest_motion;
pub mod front;
pub mod norm;
pub mod plan;
pub mod point;
pub mod reading;
pub mod reference;
pub mod report;
pub mod run;
pub mod schedule;
pub mod setting;
pub mod study;
pub mod target;
