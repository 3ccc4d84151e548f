//! Signals of tests and simulations in a common form, so that they can be compared.
//!
//! | module | what |
//! |---|---|
//! | [`signal`](Signal) | numbers at equal intervals of time |
//! | [`filter`] | the channel frequency classes CFC 60, 180, 600, 1000 |
//! | [`rating`] | how well two signals agree: ISO 18571 |
//! | [`recording`](Recording) | several channels of one test or run |
//! | [`table`] | recordings as CSV |
//! | [`mme`] | recordings as ISO-MME (ISO/TS 13499) |
//! | [`unit`](mod@unit) | units of channels, as they are spelled |
//!
//! This crate knows no model and no run.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod filter;
pub mod mme;
pub mod rating;
mod recording;
mod signal;
pub mod table;
pub mod unit;

pub use bryant_table::mme::NoChannel;
pub use recording::{Channel, Damaged, ReadError, Recording};
pub use signal::Signal;
