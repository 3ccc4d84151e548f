//! Over singles, every method of every bundled model has the bits of the generated Rust.

use super::common::{self, Single};
use bryant_runtime::Model;

/// Compares one model.
fn check<M: Model<f64>>(name: &str) {
    common::check::<M, f32, Single>(name);
}

models!(check);
