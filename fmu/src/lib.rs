//! Models as functional mock-up units (FMI 2.0 and 3.0, co-simulation): what an FMU contains, and an instance of one.
//!
//! An FMU has the model as a resource, and the shared library of `bryant-fmi`, which is the same for all models. An
//! instance is integrated as `bryant run` does, with its error control and its events.
//!
//! | module | what |
//! |---|---|
//! | `setting` | how an FMU is integrated: a resource beside the model |
//! | `variables` | the variables of a model, with their value references |
//! | `description` | `modelDescription.xml` |
//! | `instance` | an instance: values before a run, inputs and outputs of it |
//! | `running` | a run with everything that it refers to |
//!
//! Source: Functional Mock-up Interface, versions 2.0.5 and 3.0.2, <https://fmi-standard.org>.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

mod description;
mod instance;
mod owned_run;
mod setting;
mod variables;

pub use description::{Version, description};
pub use instance::{ENGINE, Instance, Message, SETTING};
pub use setting::Setting;
