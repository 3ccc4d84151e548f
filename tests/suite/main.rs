//! Tests of the whole line.

mod equations;
mod motion;
