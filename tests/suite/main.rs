//! Tests of the whole line.

mod compiled;
mod curves;
mod energy;
mod equations;
mod figure5;
mod given;
mod laws;
mod motion;
mod operations;
mod prescribed;
mod robustness;
mod snapshots;
mod tree2d;
mod vehicles;
