//! The directions from which a model is seen: the directions of space that are to the right and upwards in a picture.
//! There is no perspective.

use super::figure::Point;
use crate::pose::{Vec3, dot};

/// The direction from which a model is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// From the right, along +y: x to the right, z upwards. The view of planar models.
    #[default]
    Side,
    /// From the front, along −x: y to the right, z upwards.
    Front,
    /// From above, along −z: x to the right, y upwards.
    Top,
    /// From the right, the front and above: x mostly to the right.
    Oblique,
}

/// The oblique view: how far it is turned to the front and lifted, as sine and cosine of 30° and of 20°.
const TURNED: [f64; 2] = [0.5, 0.866_025_403_784_438_6];
const LIFTED: [f64; 2] = [0.342_020_143_325_668_8, 0.939_692_620_785_908_4];

impl View {
    /// All of them.
    pub const ALL: [View; 4] = [View::Side, View::Front, View::Top, View::Oblique];

    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            View::Side => "side",
            View::Front => "front",
            View::Top => "top",
            View::Oblique => "oblique",
        }
    }

    /// The view of this name.
    pub fn named(name: &str) -> Option<View> {
        View::ALL.into_iter().find(|view| view.name() == name)
    }

    /// Unit vectors to the right and upwards in the picture.
    // Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn axes(self) -> [Vec3; 2] {
        let ([s, c], [lift, flat]) = (TURNED, LIFTED);
        match self {
            View::Side => [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            View::Front => [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            View::Top => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            View::Oblique => [[c, s, 0.0], [-s * lift, c * lift, flat]],
        }
    }

    /// The place of a point or a direction in the picture.
    pub(crate) fn seen(self, point: Vec3) -> Point {
        self.axes().map(|axis| dot(axis, point))
    }

    /// The names of the axes of the picture.
    pub(super) fn names(self) -> [&'static str; 2] {
        match self {
            View::Side => ["x [m]", "z [m]"],
            View::Front => ["y [m]", "z [m]"],
            View::Top => ["x [m]", "y [m]"],
            View::Oblique => ["across [m]", "up [m]"],
        }
    }

    /// The view in words, if it needs to be said.
    pub(super) fn words(self, planar: bool) -> Option<String> {
        let words = match self {
            _ if planar => return None,
            View::Side => "seen from the right, along +y",
            View::Front => "seen from the front, along −x",
            View::Top => "seen from above, along −z",
            View::Oblique => "seen from the right, 30° to the front and 20° from above",
        };
        Some(words.to_owned())
    }
}
