//! The equations of motion of one particular tree of rigid elements, written out as specialised Rust.

pub mod curve;
pub mod picture;
pub mod pose;
pub mod table;
