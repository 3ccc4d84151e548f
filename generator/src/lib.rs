//! Reads the description of a tree of rigid elements and writes its equations of motion as Rust source.

pub mod emit;
pub mod equations;
pub mod expression;
pub mod formalism;
pub mod model;

/// Placeholder until the diagnostics land.
#[derive(Debug)]
pub struct Error;
