//! A given force and moment on an element.

pub(crate) mod check;
pub(crate) mod force;
