//! Tests of the whole line.

mod compiled;
mod contacts;
mod curves;
mod energy;
mod equations;
mod estimates;
mod figure5;
mod given;
mod identity;
mod invariance;
mod joints;
mod kinks;
mod laws;
mod momentum;
mod motion;
mod operations;
mod prescribed;
mod robustness;
mod scipy;
mod snapshots;
mod switches;
mod tree2d;
mod user;
mod users;
mod vehicles;
mod webbing;
