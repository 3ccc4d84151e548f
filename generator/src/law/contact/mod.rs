//! Contact of an ellipsoid with a plane or another ellipsoid.

pub(crate) mod check;
pub(crate) mod force;
pub mod keys;
pub(crate) mod onset;
pub(crate) mod outputs;
pub(crate) mod terms;

pub use check::*;
pub use outputs::*;
