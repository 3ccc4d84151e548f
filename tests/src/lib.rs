//! Shared parts of the tests: reference data, random trees, independent evaluation.

pub mod compiled_equations;
pub mod laws;
pub mod models;
pub mod reference;
pub mod runs;
pub mod trees;

pub use bryant_hard::rounding;
