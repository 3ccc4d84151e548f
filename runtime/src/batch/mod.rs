//! Many runs of one model at once, a scenario in each lane of a register.
//!
//! Every lane has a time, a step and a control of its error of its own, and takes the next scenario when it is done with one. So a run
//! is the same to the last bit in whatever lane it goes and whatever the others do, and no lane waits for the slowest.
//!
//! | file | what |
//! |---|---|
//! | `run` | the time loop |
//! | `step` | a step of Dormand & Prince's pair 5(4) |
//! | `control` | how long the next one is |
//! | `event` | guards and kinks within a step |
//! | `place` | places of different lanes, packed into one register |
//! | `ask` | the model, compiled for the instructions of a register |
//! | [`rows`] | rows of a table in, responses out |

mod ask;
mod control;
mod event;
mod place;
pub mod rows;
mod run;
mod step;
#[cfg(test)]
mod tests;

pub use run::{Ended, Pace, Scenarios, Series, Settings, Status, run};
