//! How a body is placed at the start of a run.

use super::body::Body;

/// Names of what has an angle: the trunk against the vertical, all others against what carries them; both sides alike.
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

/// Angles about y \[rad\], in the order of [`JOINTS`]. Positive leans forward, bends a knee and moves an arm or a thigh backward.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Posture([f64; JOINTS.len()]);

impl Posture {
    /// Upright, arms hanging.
    pub const STANDING: Posture = Posture([0.0; JOINTS.len()]);

    /// Thighs forward, shanks down, forearms forward.
    pub fn seated() -> Posture {
        let degrees = [0.0, 0.0, -30.0, -60.0, 0.0, -90.0, 90.0, 0.0];
        Posture(degrees.map(f64::to_radians))
    }

    /// Another angle \[rad\] of one of [`JOINTS`]; `None` where none has this name.
    pub fn with(mut self, joint: &str, angle: f64) -> Option<Posture> {
        let place = JOINTS.iter().position(|one| *one == joint)?;
        self.0[place] = angle;
        Some(self)
    }

    /// Of one of [`JOINTS`] \[rad\].
    pub fn angle(&self, joint: &str) -> f64 {
        let place = JOINTS.iter().position(|one| *one == joint);
        place.map_or(0.0, |place| self.0[place])
    }

    /// Height of the hips at which the ankles are as high above z = 0 as with the feet flat on it \[m\].
    pub fn hip_height(&self, body: &Body) -> f64 {
        let thigh = self.angle("trunk") + self.angle("thighs");
        let shank = thigh + self.angle("shanks");
        body.thigh * thigh.cos() + body.shank * shank.cos() + body.sole
    }
}
