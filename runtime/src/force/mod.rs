//! The constitutive laws of the force interactions (MADYMO 1980, "Force interaction models"): scalars in, scalars out.
//!
//! Where a force acts and in which direction is algebra, written out by the generator for each scene; what remains are
//! the few functions with a case distinction in them. Every one is a lane-wise choice, carries a NaN of its arguments
//! into its result (a curve that was left must stop the run, not vanish in a `max`), and has finite derivatives for
//! finite arguments, so dual numbers pass through it.

pub mod approach;
pub mod belt;
pub mod contact;
pub mod ellipsoid;
pub mod friction;
pub mod power;
pub mod switch;
