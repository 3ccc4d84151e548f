//! The engine as its users call it, in one program, so that it is linked once.

mod accelerations;
mod batch;
mod bits;
mod c;
mod corner;
mod engine_file;
mod fixed_steps;
mod joint_laws;
mod joints;
mod lists;
mod memory_slopes;
mod mirror;
mod onset;
mod outputs;
mod repeated_rows;
#[path = "../../../tests/suite/share.rs"]
mod share;
mod shared_code;
mod stops;
mod switched_hysteresis;
mod turning_vehicles;
mod user;
