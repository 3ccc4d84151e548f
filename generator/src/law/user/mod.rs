//! A force by a function of the user's.

// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod check;
pub(crate) mod force;
pub mod keys;
pub(crate) mod outputs;
pub(crate) mod terms;

pub use check::*;
pub use outputs::*;
