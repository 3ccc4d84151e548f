//! The table of hard cases: for a terminal, for a page, for programs.

mod cells;
pub mod json;
pub mod markdown;
pub mod text;
