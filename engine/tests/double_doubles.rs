//! Over double-doubles, every method of every bundled model has the bits of the generated Rust.

mod common;

use bryant_runtime::{DoubleDouble, Model};
use common::Single;

/// Compares one model.
fn check<M: Model<f64>>(name: &str) {
    common::check::<M, DoubleDouble, Single>(name);
}

models!(check);
