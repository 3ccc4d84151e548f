//! A spring and a damper side by side between two points.

pub(crate) mod check;
pub(crate) mod force;
