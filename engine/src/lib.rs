//! Models that are known only at run time, as [`bryant_runtime::Dynamics`]. No compiler is called.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let yaml = include_str!("../../models/dummy15.yaml");
//! use bryant_engine::Engine;
//! use bryant_engine::batch::{Rows, Wanted};
//! use bryant_runtime::Dynamics;
//!
//! let engine = Engine::of_text("dummy15.yaml", yaml)?; // or Engine::load("dummy15.yaml"), or a URDF file
//! let dummy = engine.over::<f64>();
//! let mut y = vec![0.0; dummy.info().state_length()];
//! dummy.initial_state(&mut y);
//!
//! // accelerations at two states, in lanes, on one thread
//! let (q, v) = y.split_at(dummy.info().coordinates.len());
//! let (q, v) = ([q, q].concat(), [v, v].concat());
//! let mut accelerations = vec![0.0; v.len()];
//! let rows = Rows { coordinates: &q, velocities: &v, ..Rows::default() };
//! engine.batch(1).evaluate(Wanted::Accelerations, &rows, &mut accelerations)?;
//! # Ok(())
//! # }
//! ```
//!
//! | module | what |
//! |---|---|
//! | `model` | [`Engine`], made once from the lists of a model and shared; [`Machine`], the model over one scalar |
//! | [`batch`] | many states at once: rates, outputs, matrices, rollouts |
//! | `load` | engines of files and texts |
//! | `engine_file` | derived engines in files |
//! | `front` | runs, rows and gradients of a model, compiled here for all scalars |
//! | `execute` | [`Execute`], the interface of everything that evaluates lists |
//! | `interpret` | the interpreter, for any scalar |
//! | `sets` | code and lists of sets of methods, each made when it is first used |
//! | `evaluate` | machine code where that is possible, the interpreter elsewhere |
//! | `jacobian` | derivatives of the rates, several columns at once |
//! | `native` | machine code for this processor, for scalars that are numbers side by side; `--cfg bryant_interpret` leaves it out |
//! | `native::code`, `native::memory` | machine code in memory, with calls into it and out of it |
//! | `call` | the functions that lists call: curves, force laws, functions of the user |
//! | `user` | functions of the user, which take and return plain numbers |
//! | `info` | the facts of a model, in the form of the runtime |
#![warn(clippy::disallowed_methods)]

pub mod batch;
mod call;
mod engine_file;
mod evaluate;
mod execute;
mod front;
mod info;
#[doc(hidden)]
pub mod internals;
mod interpret;
mod jacobian;
mod load;
mod model;
#[cfg_attr(
    not(all(
        any(
            all(target_arch = "x86_64", any(unix, windows)),
            all(target_arch = "aarch64", any(target_os = "linux", target_os = "macos"))
        ),
        not(bryant_interpret)
    )),
    path = "no_native.rs"
)]
mod native;
mod sets;
mod user;

pub use batch::Batch;
pub use call::{functions, table};
pub use engine_file::KeptError;
pub use execute::{Execute, Given};
pub use interpret::Interpreter;
pub use load::LoadError;
pub use model::{Engine, Error, Evaluated, Interpreted, Machine, Varying};
pub use user::UserFunctions;
