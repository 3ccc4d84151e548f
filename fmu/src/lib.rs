//! Models as functional mock-up units (FMI 2.0 and 3.0, co-simulation).
//!
//! As a shared library this crate is the binary of every FMU that `bryant export fmu` writes: it reads the model from the resources of its FMU and
//! integrates it as `bryant run` does, with its error control and its events. As a Rust library it says what an FMU contains.
//!
//! | module | what |
//! |---|---|
//! | `setting` | how an FMU is integrated: a resource beside the model |
//! | `variables` | the variables of a model, with their value references |
//! | `description` | `modelDescription.xml` |
//! | `instance` | an instance: values before a run, inputs and outputs of it |
//! | `running` | a run with everything that it refers to |
//! | `handle` | what both versions of the interface share: instances behind pointers, messages |
//! | `fmi2`, `fmi3` | the functions of the standard |
//!
//! Source: Functional Mock-up Interface, versions 2.0.5 and 3.0.2, <https://fmi-standard.org>.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod description;
mod fmi2;
mod fmi3;
mod handle;
mod instance;
mod running;
mod setting;
mod variables;

pub use description::{Version, description};
pub use instance::{ENGINE, SETTING};
pub use setting::Setting;
