//! The posture of a body at the start of a run.

use super::body::Body;

/// Names of the joints with an angle. The trunk is measured from the vertical, all others from the element that carries
/// them. Both sides have the same angle.
pub const JOINTS: [&str; 8] = [
    "trunk",
    "head",
    "upper_arms",
    "forearms",
    "hands",
    "thighs",
    "shanks",
    "feet",
];

/// Angles about y \[rad\], in the order of [`JOINTS`]. Positive leans forward, bends a knee and moves an arm or a thigh
/// backward.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Posture([f64; JOINTS.len()]);

impl Posture {
    /// Standing upright, with hanging arms.
    pub const STANDING: Posture = Posture([0.0; JOINTS.len()]);

    /// Sitting: thighs forward, shanks down, forearms forward.
    pub fn seated() -> Posture {
        let degrees = [0.0, 0.0, -30.0, -60.0, 0.0, -90.0, 90.0, 0.0];
        Posture(degrees.map(f64::to_radians))
    }

    /// The posture with another angle \[rad\] of one of [`JOINTS`]; `None` if there is no joint with this name.
    pub fn with(mut self, joint: &str, angle: f64) -> Option<Posture> {
        let place = JOINTS.iter().position(|one| *one == joint)?;
        self.0[place] = angle;
        Some(self)
    }

    /// The angle of one of [`JOINTS`] \[rad\].
    pub fn angle(&self, joint: &str) -> f64 {
        let place = JOINTS.iter().position(|one| *one == joint);
        place.map_or(0.0, |place| self.0[place])
    }

    /// Height of the hips \[m\] at which the ankles are as high above z = 0 as with flat feet on the ground.
    pub fn hip_height(&self, body: &Body) -> f64 {
        let thigh = self.angle("trunk") + self.angle("thighs");
        let shank = thigh + self.angle("shanks");
        body.thigh * libm::cos(thigh) + body.shank * libm::cos(shank) + body.sole
    }
}
