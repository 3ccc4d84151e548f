//! Studies how much time accuracy costs, and computes runs of a requested or promised accuracy.
//!
//! ```text
//!                ┌─ reference: double-double, or a closed form ─┐
//! model ─ plan ─ settings ─ errors, then times ────────────── points ─ front ─ what each further digit costs
//! ```
//!
//! | module | what it holds |
//! |---|---|
//! | [`setting`], [`plan`], [`schedule`] | one way to compute a motion; all ways that are compared; the order in which they are run |
//! | [`mod@reference`], [`closed_form`] | the true motion; `elliptic`: functions of a closed form |
//! | [`norm`], [`reading`], [`hic`] | errors of the state, and of numbers that engineers read off |
//! | [`run`], [`trajectory`] | one run of a setting; its samples |
//! | [`point`], [`study`] | the result of one setting; the results of all of them |
//! | [`front`], [`conclusion`] | the best settings, and a sentence about them |
//! | [`fastest`] | the motion that limits the steps of explicit methods |
//! | [`report`] | a study as text, CSV, JSON and Markdown |
//! | [`target`] | a run of a requested accuracy |
//! | [`check`] | a run of the promised accuracy, checked by a second run |
//! | [`cause`] | why two runs do not agree |
//! | [`exchange`], [`operations`], [`environment`] | cubics in place of lines; the cost of an evaluation; what times depend on |

pub mod cause;
pub mod check;
pub mod closed_form;
pub mod conclusion;
pub mod conditioning;
mod elliptic;
pub mod environment;
pub mod exchange;
pub mod fastest;
pub mod front;
pub mod hic;
pub mod norm;
pub mod operations;
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
pub mod trajectory;
