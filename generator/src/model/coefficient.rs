//! Coefficients that several laws have, each of more than one number.

use super::curve::ScaledCurve;
use super::number::Number;
use serde::Serialize;

/// Coulomb friction with a linear ramp through zero speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Friction {
    /// Limit of friction. Joint: torque \[N m\]. Contact: coefficient μ.
    pub limit: Number,
    /// Speed up to which friction is proportional to speed \[rad/s\] or \[m/s\]; positive.
    pub tolerance: Number,
}

/// One component of an acceleration field or of a given load, or the torque of a motor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum FieldComponent {
    /// A constant.
    Constant(Number),
    /// A curve of time \[s\].
    Curve(ScaledCurve),
}

/// A bristle by which friction holds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bristle {
    /// Deflection at which friction reaches its limit \[m\]; \[rad\] in joints that turn.
    pub displacement: Number,
}

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
