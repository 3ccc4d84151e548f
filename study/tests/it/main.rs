//! Studies as their users run them, in one program, so that it is linked once.

mod common;
mod interruptions;
mod reference;
mod study_runs;
mod summary;
mod units;
