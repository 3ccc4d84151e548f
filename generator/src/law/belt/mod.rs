//! A belt between two points, straight or through rings, with its devices.

pub(crate) mod check;
pub(crate) mod force;
pub mod webbing;

pub use webbing::*;
