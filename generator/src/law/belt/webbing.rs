//! Webbing that a belt pays out and takes in.

use crate::model::{Attachment, Number, ScaledCurve};

/// Shortest untensioned length, also that which a pretensioner leaves at least \[m\].
pub const SHORTEST: f64 = 1e-6;

/// Untensioned length of a segment at which its webbing has run out: no more slips from it \[m\]. Between this and twice this
/// length the slip slows down.
pub const RUN_OUT: f64 = 5e-3;

/// Resistance of a ring, and of webbing that tightens on a reel, where none is given \[N s/m\].
pub const RESISTANCE: f64 = 50.0;

/// What is required of a belt whose length at the start follows from where its ends are, in words.
pub fn must_have_length(belt: &str) -> String {
    format!("the ends of belt \"{belt}\" must not coincide at the start")
}

/// A reel that pays out and takes in webbing under a constant tension until it locks.
#[derive(Clone, Debug, PartialEq)]
pub struct Retractor {
    /// Index into [`Model::switches`](crate::model::Model::switches).
    pub lock: usize,
    /// Tension until then \[N\], not negative.
    pub spool: Number,
}

/// A ring that a belt slips through.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// Unique in its belt.
    pub name: String,
    /// Where it is.
    pub on: Attachment,
    /// Coefficient of friction μ: webbing slips where the tensions differ by more than the factor e^(μ θ).
    pub friction: Option<Number>,
    /// By what the tensions exceed that, per rate of slip \[N s/m\], positive.
    pub resistance: Number,
}

/// A device that takes webbing in.
#[derive(Clone, Debug, PartialEq)]
pub struct Pretensioner {
    /// Index into [`Model::switches`](crate::model::Model::switches).
    pub fire: usize,
    /// Time from then until it begins \[s\], not negative.
    pub delay: Option<Number>,
    /// Length taken in against the time since it began \[s\] → \[m\], from (0, 0) on.
    pub retract: ScaledCurve,
}
