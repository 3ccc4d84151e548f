//! Force laws.

mod ellipsoid;
mod power;
mod switch;
