//! Reports of a study: everything as CSV and JSON, the front as a table and as a page, a diagram.

pub mod diagram;
pub mod front;
pub mod record;
