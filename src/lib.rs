//! The equations of motion of one particular tree of rigid elements, written out as specialised Rust.
//!
//! S(q) v̇ = r_s(q, v) + r_k(t, q, v)   \[MADYMO 1980, eq. 2\]
//!
//! ```text
//! YAML ─generator→ equations ─engine→ model ─runtime→ motion ─table, picture→ reader
//!                     └─generator→ Rust source ─rustc→ model of a crate of your own
//! ```
//!
//! This crate is the whole of it: the parts that can be used alone, under short names, and what the command `bryant` is
//! made of. A crate that wants the equations of its own mechanism needs [`generator`] in its build script and [`runtime`]
//! in its program, and nothing of this one.
//!
//! | module | what it holds |
//! |---|---|
//! | [`generator`] | model → equations → source |
//! | [`runtime`] | what generated source links against: scalars, force laws, integrators, runs |
//! | [`bundled`] | the models that come with the program |
//! | [`equations`] | those of a model, ready to be evaluated |
//! | [`build_on_demand`] | functions of user forces, compiled once and kept |
//! | [`simulation`] | one run, recorded |
//! | [`accuracy`] | what accuracy costs in time: a study of one model |
//! | [`stability`] | hard cases, and how far from their bounds they stay |
//! | [`sweep`] | studies: many runs of one model, in lanes |
//! | [`evaluation`] | S, r_s, r_k and v̇ at one state without compiling |
//! | [`timing`] | what one evaluation takes |
//! | [`settling`] | a state of rest |
//! | [`report`] | a run as one page of HTML |
//! | [`animation`] | the motion of a run in glTF |
//! | [`criteria`] | injury criteria of a recording beside the limits of regulations |
//! | [`table`], [`picture`], [`balance`] | what a person reads |
//! | [`pose`] | the model at plain numbers: positions |
//! | [`orientation`] | states in Bryant angles, said in quaternions |
//! | [`notation`], [`quantity`] | names in printed equations, units on the command line |
//! | [`files`] | files that are whole or not there |
//! | [`parallel`] | the same work on many items |
//! | [`interrupt`] | Ctrl-C |
//! | [`process`] | what the system does to a process without a word |
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
pub mod notation;
pub mod orientation;
pub mod parallel;
pub mod picture;
pub mod pose;
pub mod process;
pub mod report;
pub mod settling;
pub mod simulation;
pub mod stability;
mod state_file;
pub mod sweep;
pub mod table;
pub mod timing;
