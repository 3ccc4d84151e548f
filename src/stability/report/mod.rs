//! The table of hard cases: as text, as pages, as JSON.

mod cells;
pub mod json;
pub mod markdown;
pub mod text;
