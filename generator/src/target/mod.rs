//! Machine code of processors, made without a compiler.
//!
//! A target turns a [`List`](crate::program::List) into bytes. It runs nothing, so it works on any host.

pub mod x86_64;
