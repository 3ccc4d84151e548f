//! Studies: many runs of one model.

pub mod quantity;
