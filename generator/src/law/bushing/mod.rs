//! A bushing: springs and dampers in six directions between frames of two bodies.

pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;

pub use keys::{Bushing, Direction, Mount};
pub use outputs::*;
