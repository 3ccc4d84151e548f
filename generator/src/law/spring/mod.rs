//! A spring and a damper side by side between two points.

pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;

pub use keys::Spring;
pub use outputs::*;
