//! Loading and unloading along different curves: a law that contacts, belts and joints share.

use super::{Number, ScaledCurve};
use serde::Serialize;

/// What unloading adds to the curve of loading f: a steep line of slope s whose foot p is remembered.
///
/// F(x; p) = clamp(s (x − p), u(x), f(x)), and after an accepted step p is such that the line passes through (x, F). In a joint it is so on
/// both sides of 0, where f is 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Hysteresis {
    /// u, nowhere above the curve of loading at the default parameters: the foot is drawn back where the line meets it.
    /// Without it u = 0 and the foot only ever advances: it is the permanent set.
    pub unloading: Option<ScaledCurve>,
    /// s, at the default parameters at least the steepest slope of both curves.
    pub slope: Number,
    /// p where nothing was loaded yet: the line then passes through (0, f(0)).
    pub foot: Number,
}
