//! Webbing that a belt pays out and takes in.

use super::{Number, ScaledCurve};

/// Shortest untensioned length, also that which a pretensioner leaves at least \[m\].
pub const SHORTEST: f64 = 1e-6;

/// What is required of a belt whose length at the start follows from where its ends are, in words.
pub fn must_have_length(belt: &str) -> String {
    format!("the ends of belt \"{belt}\" must not coincide at the start")
}

/// A reel that pays out and takes in webbing under a constant tension until it locks.
#[derive(Clone, Debug, PartialEq)]
pub struct Retractor {
    /// Index into [`Model::switches`](super::Model::switches).
    pub lock: usize,
    /// Tension until then \[N\], not negative.
    pub spool: Number,
}

/// A device that takes webbing in.
#[derive(Clone, Debug, PartialEq)]
pub struct Pretensioner {
    /// Index into [`Model::switches`](super::Model::switches).
    pub fire: usize,
    /// Length taken in against the time since then \[s\] → \[m\], from (0, 0) on.
    pub retract: ScaledCurve,
}
