//! Over double-doubles, every method of every bundled model has the bits of the generated Rust.

use super::common::{self, Single};
use bryant_runtime::{DoubleDouble, Model};

/// Compares one model.
fn check<M: Model<f64>>(name: &str) {
    common::check::<M, DoubleDouble, Single>(name);
}

models!(check);
