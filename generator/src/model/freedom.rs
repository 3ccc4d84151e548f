//! How an element hangs on what carries it: the joint, freedom by freedom.
//!
//! The freedoms of a joint come one after the other, from the carrier outwards, with no mass between. With the rotation R and the
//! displacement d of what is outboard against the axes and the joint's place on the carrier, both as left by the freedoms before,
//!
//! | freedom | does, with θ = q + zero |
//! |---|---|
//! | hinge | R ← R Rot(a, θ) |
//! | slider | d ← d + R a θ |
//! | screw of advance h | d ← d + R a h θ,   R ← R Rot(a, θ) |
//!
//! An axis `a` is given in the frame of the carrier, where all freedoms are at 0. Coordinates are relative to the carrier, and v = q̇.

use super::Number;

/// What the joint of an element lets it do.
#[derive(Clone, Debug, PartialEq)]
pub enum Joint {
    /// Turn about the joint at will: a ball in space, a hinge about y in the plane. The orientation is absolute.
    Ball,
    /// These freedoms, from the carrier outwards; none is a weld.
    Freedoms(Vec<Freedom>),
}

/// One freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct Freedom {
    /// Name, unique in its joint; a Rust identifier once dashes are underscores.
    pub name: String,
    /// What it does.
    pub kind: FreedomKind,
    /// Unit vector, frame of the carrier where all freedoms of the joint are at 0.
    pub axis: [Number; 3],
    /// What is added to the coordinate \[rad\] or \[m\].
    pub zero: Number,
    /// The coordinate at the start of a run \[rad\] or \[m\].
    pub position: Number,
    /// Its rate at the start of a run \[rad/s\] or \[m/s\].
    pub rate: Number,
    /// Inertia of what its rate alone moves, as the rotor of a motor behind a gear: it adds ½ armature q̇² to the kinetic energy
    /// \[kg m²\] or \[kg\].
    pub armature: Number,
    /// The freedom whose coordinate gives its own; none has one of its own.
    pub follows: Option<Follows>,
}

/// How a freedom follows another: q = ratio · q of the leader + offset. It has no coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Follows {
    /// The element of the leader, in the same system.
    pub element: usize,
    /// The leader among the freedoms of that element's joint; it follows none.
    pub freedom: usize,
    /// dq/dq of the leader \[rad/rad, m/m, m/rad or rad/m\].
    pub ratio: Number,
    /// q where that of the leader is 0 \[rad\] or \[m\].
    pub offset: Number,
}

/// What a freedom does along or about its axis.
#[derive(Clone, Debug, PartialEq)]
pub enum FreedomKind {
    /// It turns.
    Hinge,
    /// It slides.
    Slider,
    /// It turns and slides, by this much per angle \[m/rad\].
    Screw(Number),
}

impl Freedom {
    /// Whether it has a coordinate of its own.
    pub fn is_own(&self) -> bool {
        self.follows.is_none()
    }

    /// Whether it moves the origin of its element along its axis.
    pub fn slides(&self) -> bool {
        !matches!(self.kind, FreedomKind::Hinge)
    }
}

impl FreedomKind {
    /// Whether its coordinate is an angle.
    pub fn turns(&self) -> bool {
        !matches!(self, FreedomKind::Slider)
    }

    /// SI unit of its coordinate.
    pub fn unit(&self) -> &'static str {
        match self.turns() {
            true => "rad",
            false => "m",
        }
    }
}

impl Joint {
    /// Its freedoms; none on a ball joint, whose orientation is absolute.
    pub fn freedoms(&self) -> &[Freedom] {
        match self {
            Joint::Ball => &[],
            Joint::Freedoms(freedoms) => freedoms,
        }
    }

    /// Whether the element turns with what carries it.
    pub fn turns_with_carrier(&self) -> bool {
        matches!(self, Joint::Freedoms(_))
    }
}
