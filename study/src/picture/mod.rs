//! Pictures of a study: every response over every parameter, and the shares of the parameters in its variance.

pub mod scatter;
pub mod tornado;
