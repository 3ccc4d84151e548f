//! The joints of elements, a file for each kind.
//!
//! An element is connected to its carrier by a ball joint, whose orientation is absolute, or by freedoms one
//! after the other, from the carrier outwards, without mass between them. R and d are the rotation and the displacement
//! of the outer side of a freedom: R relative to the axes of the carrier, d relative to the place of the
//! joint on the carrier. The arrows below add one freedom to R and d. With θ = q + zero,
//!
//! | file | joint | does |
//! |---|---|---|
//! | `hinge` | turns about its axis a | R ← R Rot(a, θ) |
//! | `slider` | slides along its axis | d ← d + R a θ |
//! | `screw` | slides along its axis, and turns about it | d ← d + R a h θ,   R ← R Rot(a, θ) |
//! | `weld` | has no freedom | |
//! | `list` | has several freedoms; `universal`, `cylinder`, `planar`, `translation`, `free` | one after the other |
//! | `ball` | turns freely; in the plane a hinge about y | A from coordinates of its own |
//! | `free` | a reference joint that moves freely | p = x |
//! | `prescribed` | a reference joint that is at rest, has a prescribed motion, or rides on a vehicle | p = x(t) |
//!
//! An axis `a` is given in the frame of the carrier, with all freedoms at 0. The coordinates q are relative
//! to the carrier, and v = q̇.
//!
//! Every joint with one freedom about a fixed axis is a screw: per unit of its coordinate it turns by 1 (or
//! 0, for a slider), and slides by its advance h (0 for a hinge). A kind gives only these two facts, as a
//! [`FreedomKind`](crate::model::FreedomKind); everything else is derived from them:
//!
//! | file | |
//! |---|---|
//! | `twist` | motion and columns H, with Ḣ v, in the equations |
//! | `equations` | names and units of coordinates and velocities, and their values at the start |
//! | `model/placement` | place and columns H in plain numbers |
//! | `model/resolve/joint` | a joint made from its keys |
//! | `model/resolve/follows` | freedoms that follow others |
//!
//! # A further kind of freedom
//!
//! To add a kind, write a file such as `screw.rs`, and add its `mod` and its line in `SPELLINGS` here. No other code
//! asks for the kind of a freedom. The description language takes the keys from the file, and the model its two facts;
//! the equations, the frames of links and the pictures use its turn and its advance. Without these three lines and file
//! there are no screws, and their keys are unknown. Pages and tests must be extended besides: `docs/reference.md`,
//! `docs/joints.md`, `generator/tests/it/joints.rs`, `generator/tests/it/link.rs`.

mod ball;
mod hinge;
mod list;
mod screw;
mod slider;
mod weld;

use crate::description::joint::{JointKey, JointWord};
use crate::model::resolve::joint::{Spelling, Word};

/// The keys of a joint that stand for freedoms, in the order of the reference page.
pub(crate) const SPELLINGS: &[Spelling] = &[
    hinge::SPELLING,
    slider::SPELLING,
    screw::SPELLING,
    list::UNIVERSAL,
    list::CYLINDER,
    list::PLANAR,
];

/// The words for joints that need no keys.
pub(crate) const WORDS: &[Word] = &[
    ball::WORD,
    hinge::WORD,
    weld::WORD,
    list::TRANSLATION,
    list::FREE,
];

/// [`SPELLINGS`] as written.
pub(crate) const KEYS: &[JointKey] = &{
    let mut keys = [SPELLINGS[0].written; SPELLINGS.len()];
    let mut i = 0;
    while i < keys.len() {
        keys[i] = SPELLINGS[i].written;
        i += 1;
    }
    keys
};

/// [`WORDS`] as written.
pub(crate) const WRITTEN_WORDS: &[JointWord] = &{
    let mut words = [WORDS[0].written; WORDS.len()];
    let mut i = 0;
    while i < words.len() {
        words[i] = WORDS[i].written;
        i += 1;
    }
    words
};
