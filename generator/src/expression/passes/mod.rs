//! Passes: a graph and its roots go in, a smaller or better one comes out. Sections and names are kept.

pub mod fuse;
pub mod rebuild;

pub use fuse::fuse;
pub use rebuild::{Rewritten, rebuild};
