//! The targets of a program: machine code for processors, made without a compiler, and C.
//!
//! A target turns [lists](crate::program::List) into bytes or text. It executes nothing, so it works on any host.

pub mod c;
pub mod x86_64;
