//! A bag that gas fills.

pub(crate) mod check;
pub mod checked;
pub(crate) mod force;

pub use checked::*;
