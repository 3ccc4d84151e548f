//! Passes: each turns a graph and its roots into an equivalent one that is smaller or cheaper. Sections and names are
//! kept.
//!
//! [`rebuild()`] drops nodes that are not needed. [`join()`] merges several graphs. [`replace()`] replaces values that
//! are already known, and [`restore()`] puts values back. [`factor()`] reduces the number of operations. [`fuse()`]
//! selects fused multiply-adds and comes last. [`Recall`] works on expressions of a graph that continues to grow. The
//! roots should be those of one evaluation: a value that two functions use once each is not shared between them.

pub mod factor;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod flatten;
pub mod fuse;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod pairs;
pub mod rebuild;
pub mod recall;
pub mod replace;

pub use factor::factor;
pub use fuse::fuse;
pub use rebuild::{Rewritten, join, rebuild};
pub use recall::Recall;
pub use replace::{needed, replace, restore};
