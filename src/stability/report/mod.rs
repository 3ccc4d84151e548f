//! The table of hard cases: as text, as pages, as JSON.

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod cells;
pub mod json;
pub mod markdown;
pub mod text;
