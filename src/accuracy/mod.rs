//! What accuracy costs in time.

pub mod closed_form;
mod elliptic;
pub mod front;
pub mod hic;
pub mod norm;
pub mod reading;
pub mod trajectory;
