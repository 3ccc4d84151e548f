//! Pictures of a study: every response over every parameter, and the parameters that its variance comes from.

pub mod scatter;
pub mod tornado;
