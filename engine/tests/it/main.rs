//! The engine as its users call it, in one program, so that it is linked once.

mod accelerations;
mod batch;
mod bits;
mod c;
mod corner;
mod fixed_steps;
mod joint_laws;
mod joints;
mod kept;
mod lists;
mod memory_slopes;
mod mirror;
mod onset;
mod outputs;
mod riding;
mod rows_again;
#[path = "../../../tests/suite/share.rs"]
mod share;
mod shared_code;
mod stops;
mod user;
mod waiting;
