//! The equations of motion of one particular tree of rigid elements, written out as specialised Rust.
pub mod build_on_demand;
pub mod bundled;
pub mod command;
pub mod curve;
pub mod evaluation;
pub mod files;
pub mod notation;
pub mod picture;
pub mod pose;
pub mod quantity;
pub mod simulation;
pub mod table;
