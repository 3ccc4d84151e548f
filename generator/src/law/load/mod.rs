//! A given force and moment on an element.

pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;

pub use keys::Load;
