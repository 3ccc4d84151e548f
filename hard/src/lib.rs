//! Hard cases: small scenes, each with a law that it must obey, and a theoretical bound of the error.
//!
//! A [`Case`] runs scenes and makes measurements; a [`Check`] is one result: a number and its bound, with the reason
//! for the bound in words. Bounds follow from theory (order of the method × tolerance × growth of errors, c·κ·ε of the
//! arithmetic), never from measured results. Scenes are YAML files (`scenes/`), or are made by a function if there are
//! many. An [`Engine`] runs them in the same way as a user's models: generated, compiled, simulated. Cases without
//! motion are evaluated on the graph of the equations.
//!
//! Each group has a file, in the order of the table that `bryant stability` prints.

pub mod balance;
pub mod bench;
pub mod case;
pub mod case_model;
pub mod chain;
pub mod error;
pub mod evaluate;
pub mod meeting;
pub mod random;
pub mod rounding;
pub mod survey;
pub mod symmetric_matrix;

mod blow_up;
mod chains;
mod drift;
mod garbage;
mod hinges;
mod jobs;
mod length;
mod mass_and_shape;
mod measure;
mod non_smoothness;
mod orientation;
mod precision;
mod short_events;
mod stiff_chains;
mod stiffness;
mod tree;

pub use bench::{Bench, Call, Engine, Run, Trouble};
pub use case::{Bound, Case, Check, Found, Group};
pub use case_model::CaseModel;

/// All cases, group by group.
pub fn cases() -> Vec<Case> {
    [
        orientation::CASES,
        mass_and_shape::CASES,
        hinges::CASES,
        stiffness::CASES,
        stiff_chains::CASES,
        non_smoothness::CASES,
        short_events::CASES,
        meeting::CASES,
        precision::CASES,
        length::CASES,
        drift::CASES,
        chains::CASES,
        garbage::CASES,
        blow_up::CASES,
    ]
    .concat()
}
