//! A uniform acceleration field.

pub(crate) mod force;
