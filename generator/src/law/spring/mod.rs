//! A spring and a damper side by side between two points.

pub(crate) mod check;
pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;
pub(crate) mod terms;

pub use check::*;
pub use outputs::*;
