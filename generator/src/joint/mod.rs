//! The joints of elements, a file for each kind.
//!
//! An element hangs on its carrier by a ball joint, which leaves its orientation absolute, or by freedoms one after the other, from the carrier
//! outwards, with no mass between. R and d are the rotation and the displacement of what is outboard against the axes of the carrier and the joint's
//! place on it, as left by the freedoms before. With θ = q + zero,
//!
//! | file | joint | does |
//! |---|---|---|
//! | `hinge` | turns about its axis a | R ← R Rot(a, θ) |
//! | `slider` | slides along its axis | d ← d + R a θ |
//! | `screw` | slides along its axis, and turns about it | d ← d + R a h θ,   R ← R Rot(a, θ) |
//! | `weld` | has no freedom | |
//! | `list` | has several freedoms; `universal`, `cylinder`, `planar`, `translation`, `free` | one after the other |
//! | `follows` | a freedom that follows another | q = ratio · q of the leader + offset |
//! | `ball` | turns at will; in the plane a hinge about y | A from coordinates of its own |
//! | `free` | a reference joint that moves at will | p = x |
//! | `prescribed` | a reference joint that rests, is moved as given, or rides on a vehicle | p = x(t) |
//!
//! An axis `a` is given in the frame of the carrier, where all freedoms are at 0. The coordinates of freedoms are relative to the carrier, and v = q̇.
//!
//! What has one freedom about a fixed axis is a screw: it turns by θ or not, and slides by its advance h per θ, which is 0 of a hinge. So a
//! [`Kind`] says no more than that, and all kinds share what follows from it:
//!
//! | file | |
//! |---|---|
//! | `twist` | motion and columns H, with Ḣ v, in the equations |
//! | `placement` | place and columns H in plain numbers |
//! | `equations` | names and units of coordinates and velocities, and where they start |
//! | `coordinate` | what an angle or a length is: its units, and those of what belongs to it |
//! | `written` | how a joint is read from its keys |
//!
//! # A further kind of freedom
//!
//! It takes a file such as `screw.rs`, and here its `mod` and its line in `kinds!`. Nothing else asks which kind a freedom is. The language takes
//! its keys from the file, the model its numbers, the equations, the frames of links and the pictures its turn and its advance. Without these three,
//! there are no screws, and their keys are unknown. Pages and tests are beside that: `docs/reference.md`, `docs/joints.md`,
//! `generator/tests/joints.rs`, `dynamics/link/tests.rs`.

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

use crate::model::Number;
use std::fmt;
use std::ops::{Deref, DerefMut};
use written::{Spelling, Word};

/// What a freedom does about and along its axis.
pub trait Kind: fmt::Debug {
    /// What its coordinate is.
    fn coordinate(&self) -> Coordinate;

    /// By how much it slides along its axis per unit of its coordinate: \[m/rad\] of an angle, 1 of a length; none where it does not slide.
    fn advance(&self) -> Option<Number>;

    /// The numbers that are its own.
    fn numbers_mut(&mut self) -> Vec<&mut Number> {
        Vec::new()
    }

    /// Whether it turns about its axis, by its coordinate.
    fn turns(&self) -> bool {
        self.coordinate() == Coordinate::Angle
    }

    /// Whether it slides along its axis.
    fn slides(&self) -> bool {
        self.advance().is_some()
    }
}

/// Registers the kinds of freedoms, each a struct in a file: what [`FreedomKind`] can be.
macro_rules! kinds {
    ($($(#[$meta:meta])* $file:ident::$kind:ident,)*) => {
        /// What a freedom does along or about its axis.
        #[derive(Clone, PartialEq)]
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

        /// The keys of a joint that stand for freedoms, in the order of the reference page.
        pub(crate) const SPELLINGS: &[Spelling] =
            &[$($file::SPELLING,)* list::UNIVERSAL, list::CYLINDER, list::PLANAR];
    };
}

kinds! {
    /// It turns.
    hinge::Hinge,
    /// It slides.
    slider::Slider,
    /// It turns and slides.
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

/// The digest of a model is made of this: the kind as its file has it.
impl fmt::Debug for FreedomKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

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

impl Freedom {
    /// Whether it has a coordinate of its own.
    pub fn is_own(&self) -> bool {
        self.follows.is_none()
    }

    /// Whether it moves the origin of its element along its axis.
    pub fn slides(&self) -> bool {
        self.kind.slides()
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

    /// The same, to be changed.
    pub fn freedoms_mut(&mut self) -> &mut [Freedom] {
        match self {
            Joint::Ball => &mut [],
            Joint::Freedoms(freedoms) => freedoms,
        }
    }

    /// Whether the element turns with what carries it.
    pub fn turns_with_carrier(&self) -> bool {
        matches!(self, Joint::Freedoms(_))
    }
}
