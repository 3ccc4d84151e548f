//! What the equations written by `bryant-generator` link against: scalars, curves, force laws, integrators, simulation.
#![cfg_attr(not(feature = "std"), no_std)]

pub mod model;
pub mod real;

pub use model::{Info, Model, OutputInfo, ParameterInfo, ParameterSet, Vector};
pub use real::{Mask, Real};
