//! The runtime as its users call it, in one program. What the library has compiled for its own scalars is not compiled
//! again.

#![cfg(feature = "std")]

mod batch;
mod curve;
mod failure;
mod force;
mod integrate;
mod model;
mod models;
mod program;
mod real;
mod response;
mod scalars;
mod simulate;
