//! Hysteresis: loading and unloading along different curves; used by contacts, belts and joints.

use super::{Number, ScaledCurve};
use serde::Serialize;

/// The unloading law of a loading curve f: a steep line of slope s, whose foot p is remembered.
///
/// F(x; p) = clamp(s (x − p), u(x), f(x)). After an accepted step, p is such that the line passes through (x, F). In a
/// joint this holds on both sides of 0, where f is 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hysteresis {
    /// u, nowhere above the loading curve at the default parameters; the foot moves back when the line meets u. `None`
    /// for u = 0: the foot then only advances, and is the permanent set.
    pub unloading: Option<ScaledCurve>,
    /// s; at the default parameters it is at least the steepest slope of both curves.
    pub slope: Number,
    /// p before anything was loaded: the line then passes through (0, f(0)).
    pub foot: Number,
}
