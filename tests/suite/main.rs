//! Tests of the whole line.

mod compiled;
mod contacts;
mod energy;
mod equations;
mod figure5;
mod joints;
mod laws;
mod motion;
mod prescribed;
mod robustness;
mod snapshots;
mod switches;
mod tree2d;
mod webbing;
