//! The constitutive laws of the force interactions (MADYMO 1980, "Force interaction models"): scalars in, scalars out.
//!
//! The generator writes out the algebra of laws for each scene, with their branches by `min`, `max` and
//! [`switch::choose`]. Here are the few functions that are no algebra. Each chooses lane by lane. Each passes a NaN of
//! its arguments on to its result, because leaving a curve must stop the run and not vanish in a `max`. Each has finite
//! derivatives for finite arguments, so dual numbers pass through it.

pub mod approach;
pub mod ellipsoid;
pub mod power;
pub mod switch;
