//! The equations of motion of one particular tree of rigid elements, written out as specialised Rust.
//!
//! S(q) v̇ = r_s(q, v) + r_k(t, q, v)   \[MADYMO 1980, eq. 2\]
//!
//! ```text
//! YAML ─generator→ equations ─engine→ model ─runtime→ motion ─table, picture→ reader
//!                     └─generator→ Rust source ─rustc→ model of a crate of your own
//! ```
//!
//! This crate contains all of bryant: the other crates under short names, and the parts of the command `bryant`. A
//! crate that needs only the equations of its own mechanism uses [`generator`] in its build script and [`runtime`] in
//! its program, and nothing of this crate.
//!
//! | module | what it holds |
//! |---|---|
//! | [`generator`] | model → equations → source |
//! | [`runtime`] | what generated source links against: scalars, force laws, integrators, runs |
//! | [`bundled`] | the models that come with the program |
//! | [`equations`] | the equations of a model, ready to be evaluated |
//! | [`build_on_demand`] | functions of user forces, compiled once and kept |
//! | [`simulation`] | one run, recorded |
//! | [`accuracy`] | the cost of accuracy in time: a study of one model |
//! | [`stability`] | runs hard cases, and reports whether they keep their bounds |
//! | [`sweep`] | studies: many runs of one model, in lanes |
//! | [`evaluation`] | S, r_s, r_k and v̇ at one state, by the engine |
//! | [`timing`] | the time of one evaluation |
//! | [`settling`] | a state of rest |
//! | [`scene`] | a motion as it is seen: shapes of bodies and forces |
//! | [`report`] | a run as one page of HTML |
//! | [`animation`] | the motion of a run in glTF |
//! | [`criteria`] | injury criteria of a recording beside the limits of regulations |
//! | [`table`], [`picture`], [`balance`] | output for people |
//! | [`pose`] | positions of all bodies at given coordinates |
//! | [`orientation`] | states in Bryant angles, converted to quaternions |
//! | [`notation`], [`quantity`] | names in printed equations, units on the command line |
//! | [`files`], `own` | writes files that are always complete; recognises files that this program wrote |
//! | [`parallel`] | the same work on many items |
//! | [`interrupt`] | Ctrl-C |
//! | [`process`] | signals and closed descriptors, reported as errors |
//! | [`command`] | the command line |
//!
//! A bundled model, run for 20 ms:
//!
//! ```
//! use bryant::runtime::program::Job;
//! use bryant::simulation;
//!
//! let bundled = bryant::bundled::find("child-seat").expect("a bundled model");
//! let model = bryant::bundled::model(bundled)?;
//! let engine = bryant::equations::of(&model)?;
//! let job = Job { duration: Some(0.02), ..Job::default() };
//! let recording = simulation::run(&engine, &job, &mut |_| {});
//! assert_eq!(recording.last_time(), 0.02);
//! print!("{}", recording.table.text(Default::default()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![warn(clippy::disallowed_methods)]

/// Version of the program, with the commit that it was built from.
pub const VERSION: &str = concat!(
    env!("CARGO_PKG_VERSION"),
    " (commit ",
    env!("BRYANT_COMMIT"),
    ")"
);

pub use bryant_generator as generator;
pub use bryant_runtime as runtime;
pub use bryant_study::quantity;

pub mod accuracy;
pub mod animation;
pub mod balance;
pub mod build_on_demand;
pub mod bundled;
pub mod command;
pub mod criteria;
pub mod equations;
pub mod evaluation;
pub mod files;
pub mod interrupt;
pub mod modes;
pub mod notation;
pub mod orientation;
pub mod parallel;
pub mod picture;
pub mod pose;
pub mod process;
pub mod report;
pub mod scene;
pub mod settling;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod signature;
pub mod simulation;
pub mod stability;
mod state_file;
pub mod sweep;
pub mod table;
pub mod timing;
mod units;
