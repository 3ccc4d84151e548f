//! Reports of a study: text, CSV, JSON, a section of a page, a diagram.

pub mod csv;
pub mod diagram;
pub mod json;
pub mod markdown;
pub mod text;
