//! Many runs of one model at once, a scenario in each lane of a register.
//!
//! The loop is compiled once for each scalar, in this crate. It meets models through [`Dynamics`](crate::Dynamics),
//! whose functions are compiled for the instructions of a register each.
//!
//! Every lane has its own time, step and error control, and takes the next scenario as soon as it has finished one. So
//! a run is the same to the last bit whatever lane it is in and whatever the others do, and no lane waits for the
//! slowest.
//!
//! | file | what |
//! |---|---|
//! | `settings` | how to run |
//! | `scenario` | what runs, and what became of it |
//! | `run` | the time loop |
//! | `reach` | how far the next step goes |
//! | `step` | a step of a Runge–Kutta method |
//! | `control` | the first step of each lane, and roots for the controller |
//! | `search` | event functions and kinks within the steps of all lanes |
//! | `event` | their values within steps |
//! | `sample` | outputs at the times of samples |
//! | `landing` | the end of accepted steps: events, memory, what the next steps begin with |
//! | `acceleration` | accelerations in the control of the step |
//! | `jump` | outputs on both sides of events |
//! | `bend` | joints that are bent through 180°, ellipsoids that sink through each other |
//! | `watch` | balances of energy and momentum, and the limit of stability, where steps are fixed |
//! | `place` | places of different lanes, packed into one register |
//! | `looked` | what is known of onsets at places within steps |
//! | `models` | the models that a batch works with, of a [`Family`](crate::Family) |
//! | `tolerance` | the error allowed in each entry of a state |
//! | [`rows`] | rows of a table in, responses out |

mod acceleration;
mod bend;
mod control;
mod event;
mod jump;
mod landing;
mod models;
mod onset;
mod onset_cache;
mod place;
mod reach;
pub mod rows;
mod run;
mod sample;
mod scenario;
mod search;
mod settings;
mod step;
mod tolerance;
mod watch;

#[doc(hidden)]
pub use models::{with_compiled, with_compiled_singles};
pub use run::{STEPS_BETWEEN, run};
pub use scenario::{Doubt, Ended, Scenarios, Series, Status};
pub use settings::{Fixed, LaneFormula, Pace, Settings};

/// A slice with `count` copies of a value. This is a function of its own because a batch has dozens of such slices:
/// inlined, they would be a seventh of the machine code of this crate.
#[inline(never)]
fn copies<S: Copy>(value: S, count: usize) -> Box<[S]> {
    vec![value; count].into_boxed_slice()
}

/// An array of such slices.
fn arrays<S: Copy, const N: usize>(value: S, count: usize) -> [Box<[S]>; N]
where
    [Box<[S]>; N]: Default,
{
    let mut all = <[Box<[S]>; N]>::default();
    for slice in &mut all {
        *slice = copies(value, count);
    }
    all
}
