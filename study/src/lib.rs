//! Studies: many runs of one model.

pub mod design;
pub mod digest;
pub mod distribution;
pub mod facts;
pub mod file;
pub mod hash;
pub mod normal;
pub mod quantity;
pub mod response;
pub mod study;
