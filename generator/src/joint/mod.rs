//! The joints of elements, a file for each kind.
//!
//! An element is connected to its carrier by a ball joint, whose orientation is absolute, or by degrees of freedom one
//! after the other, from the carrier outwards, without mass between them. R and d are the rotation and the displacement
//! of the outer side of a degree of freedom: R relative to the axes of the carrier, d relative to the place of the
//! joint on the carrier. The arrows below add one degree of freedom to R and d. With θ = q + zero,
//!
//! | file | joint | does |
//! |---|---|---|
//! | `hinge` | turns about its axis a | R ← R Rot(a, θ) |
//! | `slider` | slides along its axis | d ← d + R a θ |
//! | `screw` | slides along its axis, and turns about it | d ← d + R a h θ,   R ← R Rot(a, θ) |
//! | `weld` | has no degree of freedom | |
//! | `list` | has several degrees of freedom; `universal`, `cylinder`, `planar`, `translation`, `free` | one after the other |
//! | `follows` | a degree of freedom that follows another | q = ratio · q of the leader + offset |
//! | `ball` | turns freely; in the plane a hinge about y | A from coordinates of its own |
//! | `free` | a reference joint that moves freely | p = x |
//! | `prescribed` | a reference joint that is at rest, has a prescribed motion, or rides on a vehicle | p = x(t) |
//!
//! An axis `a` is given in the frame of the carrier, with all degrees of freedom at 0. The coordinates q are relative
//! to the carrier, and v = q̇.
//!
//! Every joint with one degree of freedom about a fixed axis is a screw: per unit of its coordinate it turns by 1 (or
//! 0, for a slider), and slides by its advance h (0 for a hinge). A [`Kind`] gives only these two facts; the following
//! files derive everything else from them:
//!
//! | file | |
//! |---|---|
//! | `twist` | motion and columns H, with Ḣ v, in the equations |
//! | `placement` | place and columns H in plain numbers |
//! | `equations` | names and units of coordinates and velocities, and their values at the start |
//! | `coordinate` | the kind of a coordinate, an angle or a length: its units, and those of related quantities |
//! | `written` | how a joint is read from its keys |
//!
//! # A further kind of degree of freedom
//!
//! To add a kind, write a file such as `screw.rs`, and add its `mod` and its line in `kinds!` here. No other code asks
//! for the kind of a degree of freedom. The description language takes the keys from the file, and the model its
//! numbers; the equations, the frames of links and the pictures use its turn and its advance. Without these three lines
//! and file there are no screws, and their keys are unknown. Pages and tests must be extended besides:
//! `docs/reference.md`, `docs/joints.md`, `generator/tests/it/joints.rs`, `dynamics/link/tests.rs`.

pub(crate) mod ball;
mod coordinate;
pub(crate) mod equations;
mod follows;
pub(crate) mod free;
pub mod hinge;
mod list;
pub mod placement;
pub(crate) mod prescribed;
pub mod screw;
pub mod slider;
pub(crate) mod twist;
mod weld;
pub(crate) mod written;

pub use coordinate::Coordinate;
pub use follows::Follows;
pub(crate) use follows::{couple, start_followers};
pub(crate) use list::{freedoms_at_start, joint_of};

use crate::model::Number;
use serde::Serialize;
use std::fmt;
use std::ops::{Deref, DerefMut};
use written::{Spelling, Word};

/// The motion of a degree of freedom about and along its axis.
pub trait Kind: fmt::Debug {
    /// The kind of its coordinate.
    fn coordinate(&self) -> Coordinate;

    /// The distance that it slides along its axis per unit of its coordinate: \[m/rad\] for an angle, 1 for a length;
    /// `None` if it does not slide.
    fn advance(&self) -> Option<Number>;

    /// The numbers of this kind, such as a pitch.
    fn numbers_mut(&mut self) -> Vec<&mut Number> {
        Vec::new()
    }

    /// True if it turns about its axis, by its coordinate.
    fn turns(&self) -> bool {
        self.coordinate() == Coordinate::Angle
    }

    /// True if it slides along its axis.
    fn slides(&self) -> bool {
        self.advance().is_some()
    }
}

/// Registers the kinds of degrees of freedom, each a struct in a file of its own: the variants of [`FreedomKind`].
macro_rules! kinds {
    ($($(#[$meta:meta])* $file:ident::$kind:ident,)*) => {
        /// What a degree of freedom does along or about its axis.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        pub enum FreedomKind {
            $($(#[$meta])* $kind($file::$kind),)*
        }

        $(impl From<$file::$kind> for FreedomKind {
            fn from(kind: $file::$kind) -> Self {
                FreedomKind::$kind(kind)
            }
        })*

        impl Deref for FreedomKind {
            type Target = dyn Kind;
            fn deref(&self) -> &Self::Target {
                match self {
                    $(FreedomKind::$kind(kind) => kind,)*
                }
            }
        }

        impl DerefMut for FreedomKind {
            fn deref_mut(&mut self) -> &mut Self::Target {
                match self {
                    $(FreedomKind::$kind(kind) => kind,)*
                }
            }
        }

        /// The keys of a joint that stand for degrees of freedom, in the order of the reference page.
        pub(crate) const SPELLINGS: &[Spelling] =
            &[$($file::SPELLING,)* list::UNIVERSAL, list::CYLINDER, list::PLANAR];
    };
}

kinds! {
    /// A hinge, which turns.
    hinge::Hinge,
    /// A slider.
    slider::Slider,
    /// A screw, which turns and slides.
    screw::Screw,
}

/// The words for joints that need no keys.
pub(crate) const WORDS: &[Word] = &[
    ball::WORD,
    hinge::WORD,
    weld::WORD,
    list::TRANSLATION,
    list::FREE,
];

/// The motion that the joint of an element allows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub enum Joint {
    /// Free rotation about the joint: a ball in space, a hinge about y in the plane. The orientation is absolute.
    Ball,
    /// Degrees of freedom, from the carrier outwards. A weld has none.
    Freedoms(Vec<Freedom>),
}

/// One degree of freedom.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Freedom {
    /// Name, unique in its joint; with underscores in place of dashes, a Rust identifier.
    pub name: String,
    /// The kind of motion.
    pub kind: FreedomKind,
    /// The axis: a unit vector in the frame of the carrier, with all degrees of freedom of the joint at 0.
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
    /// The degrees of freedom; none for a ball joint, whose orientation is absolute.
    pub fn freedoms(&self) -> &[Freedom] {
        match self {
            Joint::Ball => &[],
            Joint::Freedoms(freedoms) => freedoms,
        }
    }

    /// The degrees of freedom, mutable.
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
