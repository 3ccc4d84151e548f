//! Tests of the whole line.

mod compiled;
mod equations;
mod figure5;
mod motion;
mod prescribed;
mod tree2d;
