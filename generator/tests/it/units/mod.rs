//! The parts of the generator by themselves: the tests of `src/PATH.rs` are in `units/PATH.rs`.

mod config;
mod description;
mod diagnostic;
mod dynamics;
mod expression;
mod force;
mod human;
mod law;
mod model;
mod names;
mod program;
mod rotation;
mod target;
mod urdf;
