//! The joints of elements, a file for each kind.
//!
//! An element hangs on its carrier by a ball joint, which leaves its orientation absolute, or by freedoms one after the other, from the carrier
//! outwards, with no mass between. A freedom turns about an axis, slides along it, or both: one formula for the motion of all of them is in [`twist`],
//! and a kind says the numbers that it takes. With the rotation R and the displacement d of what is outboard against the axes and the joint's
//! place on the carrier, both as left by the freedoms before, and θ = q + zero,
//!
//! | file | joint | does |
//! |---|---|---|
//! | `hinge` | turns about its axis a | R ← R Rot(a, θ) |
//! | `slider` | slides along its axis | d ← d + R a θ |
//! | `screw` | of advance h: slides, and turns | d ← d + R a h θ,   R ← R Rot(a, θ) |
//! | `list` | several of these, `universal`, `cylinder`, `planar` and `translation` among them | one after the other |
//! | `follows` | a freedom that follows another | q = ratio · q of the leader + offset |
//! | `weld` | none | |
//! | `ball` | turns at will; in the plane a hinge about y | A has coordinates of its own |
//! | `twist` | what these have in common, in the equations | H, Ḣ v |
//! | `placement` | and in plain numbers | H |
//! | `coordinate` | angle or length | units |
//! | `written` | how joints are written | |
//!
//! An axis `a` is given in the frame of the carrier, where all freedoms are at 0. Coordinates are relative to the carrier, and v = q̇.
//!
//! # A further kind of freedom
//!
//! It takes a file such as `screw.rs`, and here its `mod` and its line in `kinds!`. Nothing else asks which kind a freedom is: the language takes
//! its keys, the model its numbers, equations, link frames and pictures its turn and its advance from the file. Pages and tests are beside that:
//! `docs/reference.md`, `docs/joints.md` and `generator/tests/joints.rs`.

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
pub(crate) const WORDS: &[Word] = &[ball::WORD, hinge::WORD, weld::WORD, list::TRANSLATION];

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
