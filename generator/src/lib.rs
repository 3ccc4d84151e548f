//! Reads the description of a tree of rigid elements and writes its equations of motion as Rust source.
//!
//! ## From a build script
//!
//! `Cargo.toml` has this crate among the `[build-dependencies]` and `bryant-runtime` among the `[dependencies]`. In the
//! `main` of `build.rs`,
//!
//! ```no_run
//! bryant_generator::Config::new().model("models/arm.yaml").generate_or_report();
//! ```
//!
//! and in the crate `mod arm { bryant_runtime::include_model!("arm"); }`. Problems of a model are errors of the build,
//! with their places in the YAML. [`Config`] has the other options: whole directories, coordinates, no matrices for
//! `no_std`.
//!
//! The module has a struct `Mechanism` with its `Parameters`, methods such as `accelerations`, constants for the index
//! of each coordinate, velocity and output, and `INFO` with names and units. The first page of `bryant_runtime` shows
//! how to use it.
//!
//! ## As a function
//!
//! [`Config::generate_str`] is text in, text out, without files:
//!
//! ```
//! let yaml = "
//! model: pendulum
//! dimension: 2
//! systems:
//!   - name: arm
//!     reference: fixed
//!     elements: [{ name: rod, mass: 1 kg, cg: [0, -0.5], inertia: 0.1 }]
//! forces: [{ field: gravity, acceleration: [0, -9.81] }]
//! ";
//! let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
//! let generated = bryant_generator::Config::new().generate_str("pendulum.yaml", yaml, &no_files)?;
//! assert!(generated.source.contains("pub fn accelerations("));
//! # Ok::<(), bryant_generator::Diagnostics>(())
//! ```
//!
//! The steps in between are functions, too: [`read()`] checks a description, [`dynamics::derive`] makes its
//! equations, [`target::rust::module`] writes them.
#![warn(clippy::disallowed_methods)]

pub mod car_part;
pub mod config;
pub mod description;
pub mod diagnostic;
pub mod dynamics;
pub mod effect;
pub mod equations;
pub mod expression;
pub mod force;
pub mod human;
pub mod joint;
pub mod law;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod method;
pub mod model;
pub mod model_text;
pub mod motion;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod names;
pub mod program;
pub mod read;
#[doc(hidden)]
pub mod rotation;
pub mod target;
pub mod urdf;

pub use config::{Config, Error, Generated};
pub use diagnostic::{Diagnostic, Diagnostics};
pub use read::{read, read_annotated, read_annotated_str, read_str, read_without_sources};
