//! What a program is written as: Rust, C, and machine code of processors, made without a compiler.
//!
//! C and machine code are made of [lists](crate::program::List), Rust of the schedules that the lists are made of, too. A target executes nothing, so it
//! works on any host, and it knows no other target.

pub mod c;
pub mod rust;
pub mod x86_64;
