//! A study for people and for programs: a table, CSV, JSON, a section of a page, a diagram.

pub mod csv;
pub mod diagram;
pub mod json;
pub mod markdown;
pub mod text;
