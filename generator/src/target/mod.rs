//! What a program is written as: machine code of processors, made without a compiler, and C.
//!
//! A target turns [lists](crate::program::List) into bytes or text. It runs nothing, so it works on any host.

pub mod c;
pub mod rust;
pub mod x86_64;
