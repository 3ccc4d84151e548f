//! The space in which a model moves, and the coordinates that describe orientation.

use serde::Serialize;

/// Number of space dimensions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Dimension {
    /// Motion in the x–z plane, one angle about +y per element (local x axis = (cos φ, −sin φ) in (x, z)).
    Plane,
    /// Motion in space.
    Space,
}

/// The coordinates that describe orientation in space. In the plane there is one angle either way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Coordinates {
    /// A unit quaternion (w, x, y, z), local to absolute; the velocity is ω in absolute axes. No singularity.
    Quaternion,
    /// Absolute Bryant angles, A = Rx(φ₁) Ry(φ₂) Rz(φ₃); the velocity is φ̇. Singular at cos φ₂ = 0: near there a run
    /// changes to the angles of another chart.
    Bryant,
}
