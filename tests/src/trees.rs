//! Random and regular trees.
