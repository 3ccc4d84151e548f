//! Tests of the whole line.

mod compiled;
mod equations;
mod motion;
