//! The parts of studies by themselves: the tests of `src/PATH.rs` are in `units/PATH.rs`.

mod criteria;
mod design;
mod distribution;
mod file;
mod hash;
mod normal;
mod quantity;
mod response;
mod results;
mod shard;
mod store;
mod summary;
mod table;
