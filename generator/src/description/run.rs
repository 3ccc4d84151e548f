//! A run as written.

use super::quantity::Quantity;
use super::shape::record;

record! {
    /// Duration and sampling.
    Run as "a run" {
        /// Length of a run \[s\].
        duration: Option<Quantity>,
        /// Time between two lines of the table \[s\].
        every: Option<Quantity>,
    }
}
