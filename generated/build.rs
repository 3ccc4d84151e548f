//! Compiles every bundled model.

fn main() {}
