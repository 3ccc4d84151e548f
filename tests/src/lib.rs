//! What the tests share: reference data, random trees, independent evaluation.

pub mod models;
pub mod reference;
pub mod trees;
