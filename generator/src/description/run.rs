//! A run as written.

use super::measure::{Positive, Time};
use super::quantity::Number;
use super::shape::record;

record! {
    /// Duration and sampling.
    Run as "a run" {
        /// length of a run
        duration: Option<Number<Positive<Time>>> = "1 s",
        /// time between two lines of the table; at most a million lines
        every: Option<Number<Positive<Time>>> = "10 ms",
    }
}
