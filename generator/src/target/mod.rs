//! The targets: a program is written as Rust, as C, or as machine code for a processor, made without a compiler.
//!
//! C and machine code come from [lists](crate::program::List). Rust comes from the schedules that the lists are made
//! of. A target executes nothing, so it works on any host, and it knows no other target. `machine` has the part of
//! making machine code that is common to all processors.

pub mod aarch64;
pub mod c;
pub mod machine;
pub mod rust;
pub(crate) mod summary;
pub mod x86_64;
