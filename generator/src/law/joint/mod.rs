//! Torques and forces in a joint.

pub(crate) mod check;
pub mod checked;
pub(crate) mod force;

pub use checked::*;
