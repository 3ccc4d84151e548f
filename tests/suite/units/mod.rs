//! The parts of the command by themselves: the tests of `src/PATH.rs` are in `units/PATH.rs`.

mod accuracy;
mod animation;
mod balance;
mod build_on_demand;
mod bundled;
mod command;
mod criteria;
mod files;
mod modes;
mod orientation;
mod parallel;
mod picture;
mod pose;
mod report;
mod scene;
mod settling;
mod signature;
mod simulation;
mod stability;
mod sweep;
mod table;
