//! What a program is written as: Rust, C, and machine code of processors, made without a compiler.
//!
//! C and machine code come from [lists](crate::program::List). Rust comes from the schedules that the lists are made of. A target executes nothing, so it
//! works on any host, and it knows no other target. What machine code of all processors has in common is `machine`.

pub mod aarch64;
pub mod c;
pub mod machine;
pub mod rust;
pub mod x86_64;
