//! A bushing: springs and dampers in six directions between frames of two bodies.

pub(crate) mod check;
pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;
pub(crate) mod terms;

pub use check::*;
pub use outputs::*;
