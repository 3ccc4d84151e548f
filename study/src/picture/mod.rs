//! Pictures of a study: every response over every parameter, and which parameters its variance comes from.

pub mod scatter;
pub mod tornado;
