//! Finds leaps: places where an angle or a direction that a law depends on jumps to another value, because it is not
//! defined there or passes ±180°.

use crate::model::{CurveInfo, CurveKind};

/// The components of a bearing or a direction; unused ones are 0.
pub(crate) type Turning = [f64; 3];

impl CurveKind {
    /// True if the argument of this kind has an interval that it may leave. Bearings and directions have none; they may
    /// leap instead.
    pub(crate) fn may_be_left(self) -> bool {
        matches!(self, CurveKind::Curve | CurveKind::Volume | CurveKind::Edge)
    }
}

impl CurveInfo<'_> {
    /// True if this entry belongs to the laws about x, y and z of a joint.
    pub(crate) fn is_of_angles(&self) -> bool {
        self.middle().is_some()
    }

    /// True if this [angle](CurveKind::HalfTurn) belongs to the same law as a [bearing](CurveKind::Bearing): the angle
    /// leaps where the bearing does, because it is not defined there. "bushing m about x" belongs to "bushing m",
    /// "joint man/head about x" to "joint man/head about x, y and z", "joint man/head torsion" to "joint man/head".
    pub(crate) fn leaps_with(&self, bearing: &CurveInfo<'_>) -> bool {
        fn owner(name: &str) -> Option<&str> {
            match name.strip_suffix(" torsion") {
                Some(owner) => Some(owner),
                None => name.rsplit_once(" about ").map(|(owner, _)| owner),
            }
        }
        let of_bearing = match bearing.is_of_angles() {
            true => owner(bearing.name),
            false => Some(bearing.name),
        };
        self.kind == CurveKind::HalfTurn
            && bearing.kind == CurveKind::Bearing
            && owner(self.name).is_some_and(|owner| of_bearing == Some(owner))
    }

    /// Number of pieces of a step in which a bearing or a direction is checked for a leap. Each piece is then halved
    /// [`CurveInfo::HALVINGS`] times, to a thousandth of the step.
    pub(crate) const PIECES: u32 = 4;
    pub(crate) const HALVINGS: u32 = 8;

    /// If a bearing or a direction begins at this entry, the number of its components. `None` for a curve and for the
    /// further components of a direction.
    pub(crate) const fn turning(&self, dimension: u8) -> Option<usize> {
        match self.kind {
            CurveKind::Bearing | CurveKind::HalfTurn => Some(1),
            CurveKind::Direction(0) => Some(dimension as usize),
            CurveKind::Curve | CurveKind::Volume | CurveKind::Edge | CurveKind::Direction(_) => {
                None
            }
        }
    }

    /// Whether a bearing or a direction leaps between two places of a step, given as (place, components): it turns by
    /// more than a quarter turn, or is not determined at one of them.
    pub(crate) fn leaps(&self, places: [(f64, Turning); 2]) -> bool {
        use core::f64::consts::{FRAC_PI_2, PI};
        let [a, b] = places.map(|(_, entries)| entries);
        let there = [a, b].map(|entries| entries[0] < self.last);
        if self.kind == CurveKind::Bearing {
            let turned = (a[0] - b[0]).max(b[0] - a[0]);
            return there == [true; 2] && turned.min(2.0 * PI - turned) > FRAC_PI_2;
        }
        match there {
            both if self.kind == CurveKind::HalfTurn => {
                both == [true; 2] && (a[0] < 0.0) != (b[0] < 0.0)
            }
            [true, true] => dot(a, b) <= 0.0,
            [true, false] => dot(a, a) < 0.5,
            [false, true] => dot(b, b) < 0.5,
            [false, false] => false,
        }
    }

    /// Whether a bearing or a direction may have leapt in a step with these components at its ends: it turned by more
    /// than a sixteenth of a turn, or is determined at only one of them.
    pub(crate) fn may_leap(&self, [a, b]: [Turning; 2]) -> bool {
        use core::f64::consts::PI;
        let there = [a[0] < self.last, b[0] < self.last];
        if there[0] != there[1] || !there[0] {
            return there[0] != there[1];
        }
        match self.kind {
            CurveKind::Bearing => {
                let turned = (a[0] - b[0]).max(b[0] - a[0]);
                turned.min(2.0 * PI - turned) > PI / 8.0
            }
            CurveKind::HalfTurn => (a[0] < 0.0) != (b[0] < 0.0),
            // cos π/8
            _ => dot(a, b) < 0.923_879_532_511_286_7,
        }
    }

    /// The half in which a bearing or a direction leaps, given that it leaps between `a` and `b`.
    pub(crate) fn half(
        &self,
        [a, b]: [(f64, Turning); 2],
        middle: (f64, Turning),
    ) -> [(f64, Turning); 2] {
        match self.leaps([a, middle]) {
            true => [a, middle],
            false => [middle, b],
        }
    }
}

fn dot(a: Turning, b: Turning) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
