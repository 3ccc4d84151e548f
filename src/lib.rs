//! Bryant.
