//! Tests of the whole line.

mod equations;
