//! Contact of an ellipsoid with a plane or another ellipsoid.

pub(crate) mod check;
pub(crate) mod force;
pub(crate) mod plane;
