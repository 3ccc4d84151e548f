//! Passes: a graph and its roots go in, a smaller or better one comes out. Sections and names are kept.
//!
//! [`rebuild()`] drops what is not needed, [`join()`] makes one graph of several, [`replace()`] drops what is known already, [`factor()`]
//! lowers the number of operations, [`fuse()`] selects fused multiply-adds and comes last. [`repeat()`] then undoes some sharing of what is
//! evaluated in a certain order. [`recall()`] alone works on an expression of a graph that goes on to grow. The roots should be those of one evaluation: what is used once by each of two functions is not shared
//! between them.

pub mod factor;
mod flatten;
pub mod fuse;
mod pairs;
pub mod rebuild;
pub mod recall;
pub mod repeat;
pub mod replace;

pub use factor::factor;
pub use fuse::fuse;
pub use rebuild::{Rewritten, join, rebuild};
pub use recall::recall;
pub use repeat::repeat;
pub use replace::replace;
