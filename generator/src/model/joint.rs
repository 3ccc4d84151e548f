//! The joint of an element: its freedoms, and how they move it.

use super::number::Number;
use crate::description::joint::Coordinate;
use serde::Serialize;

/// The motion that the joint of an element allows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Joint {
    /// Free rotation about the joint: a ball in space, a hinge about y in the plane. The orientation is absolute.
    Ball,
    /// Freedoms, from the carrier outwards. A weld has none.
    Freedoms(Vec<Freedom>),
}

/// One freedom.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Freedom {
    /// Name, unique in its joint; with underscores in place of dashes, a Rust identifier.
    pub name: String,
    /// The motion about and along the axis.
    pub kind: FreedomKind,
    /// The axis: a unit vector in the frame of the carrier, with all freedoms of the joint at 0.
    pub axis: [Number; 3],
    /// The constant that is added to the coordinate \[rad\] or \[m\].
    pub zero: Number,
    /// The coordinate at the start of a run \[rad\] or \[m\].
    pub position: Number,
    /// Rate of the coordinate at the start of a run \[rad/s\] or \[m/s\].
    pub rate: Number,
    /// The inertia of a body that moves only with this rate, such as the rotor of a motor behind a gear \[kg m²\] or
    /// \[kg\]. It adds ½ armature q̇² to the kinetic energy.
    pub armature: Number,
    /// The leader that determines its coordinate; `None` if it has a coordinate of its own.
    pub follows: Option<Follows>,
}

impl Freedom {
    /// True if it has a coordinate of its own.
    pub fn is_own(&self) -> bool {
        self.follows.is_none()
    }

    /// True if it moves the origin of its element along its axis.
    pub fn slides(&self) -> bool {
        self.kind.slides()
    }
}

impl Joint {
    /// The freedoms; none for a ball joint, whose orientation is absolute.
    pub fn freedoms(&self) -> &[Freedom] {
        match self {
            Joint::Ball => &[],
            Joint::Freedoms(freedoms) => freedoms,
        }
    }

    /// The freedoms, mutable.
    pub fn freedoms_mut(&mut self) -> &mut [Freedom] {
        match self {
            Joint::Ball => &mut [],
            Joint::Freedoms(freedoms) => freedoms,
        }
    }

    /// True if the element turns with its carrier.
    pub fn turns_with_carrier(&self) -> bool {
        matches!(self, Joint::Freedoms(_))
    }
}

/// The motion of a freedom about and along its axis: a screw. Per unit of its coordinate it turns by 1, or by
/// 0 if it is a slider, and slides by its advance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FreedomKind {
    /// True if it turns about its axis, by its coordinate, which is then an angle.
    turns: bool,
    /// The distance that it slides along its axis per unit of its coordinate: \[m/rad\] for an angle, 1 for a length;
    /// `None` if it does not slide.
    advance: Option<Number>,
}

impl FreedomKind {
    /// A hinge: it turns.
    pub const HINGE: Self = FreedomKind {
        turns: true,
        advance: None,
    };

    /// A slider.
    pub const SLIDER: Self = FreedomKind {
        turns: false,
        advance: Some(Number::Constant(1.0)),
    };

    /// A screw, which turns, and slides by this distance per angle \[m/rad\].
    pub fn screw(advance: Number) -> Self {
        FreedomKind {
            turns: true,
            advance: Some(advance),
        }
    }

    /// The kind of the coordinate.
    pub fn coordinate(&self) -> Coordinate {
        match self.turns {
            true => Coordinate::Angle,
            false => Coordinate::Length,
        }
    }

    /// The distance that it slides along its axis per unit of its coordinate: \[m/rad\] for an angle, 1 for a length;
    /// `None` if it does not slide.
    pub fn advance(&self) -> Option<&Number> {
        self.advance.as_ref()
    }

    /// True if it turns about its axis, by its coordinate.
    pub fn turns(&self) -> bool {
        self.turns
    }

    /// True if it slides along its axis.
    pub fn slides(&self) -> bool {
        self.advance.is_some()
    }

    /// The numbers of this kind: the advance of a screw.
    pub(crate) fn number_mut(&mut self) -> Option<&mut Number> {
        self.advance.as_mut().filter(|_| self.turns)
    }
}

/// The relation of a freedom to its leader: q = ratio · q of the leader + offset. The follower has no
/// coordinate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Follows {
    /// The element of the leader, in the same system.
    pub element: usize,
    /// Index of the leader among the freedoms of that element's joint. The leader itself follows no other.
    pub freedom: usize,
    /// dq/dq of the leader \[rad/rad, m/m, m/rad or rad/m\].
    pub ratio: Number,
    /// q of the follower when the coordinate of the leader is 0 \[rad\] or \[m\].
    pub offset: Number,
}

impl Follows {
    /// The relation of a freedom that follows this follower (q = ratio · q of this follower + offset) to this
    /// follower's leader.
    pub(crate) fn followed(self, ratio: Number, offset: Number) -> Self {
        let shift = Number::product(ratio.clone(), self.offset);
        Follows {
            ratio: Number::product(ratio, self.ratio),
            offset: Number::sum(shift, offset),
            ..self
        }
    }
}

/// The axes of the frame about which an element on a ball joint can turn: in the plane only y.
pub(crate) fn axes_of_rotation(planar: bool) -> &'static [usize] {
    if planar { &[1] } else { &[0, 1, 2] }
}

/// The absolute axes along which the origin of a root on a free reference joint moves.
pub(crate) fn directions(planar: bool) -> &'static [usize] {
    if planar { &[0, 2] } else { &[0, 1, 2] }
}
