//! Elements as written.

use super::joint::Joint;
use super::mesh::Meshes;
use super::quantity::{OneOrThree, Quantity};
use super::shape::{record, words};

record! {
    /// A rigid element and the joint that carries it.
    Element as "an element" {
        /// Name, unique in its system.
        name: String,
        /// The element that carries it; none for the root.
        on: Option<String>,
        /// The joint, in the frame of the element that carries it \[m\].
        at: Option<Vec<Quantity>>,
        /// What the joint lets it do: a ball in space, a hinge in the plane where it is left out.
        joint: Option<Joint>,
        /// Mass \[kg\].
        mass: Quantity,
        /// Centre of gravity, local frame \[m\].
        cg: Vec<Quantity>,
        /// Moments of inertia about the centre of gravity \[kg m²\]: the one about y in the plane, three in space.
        inertia: OneOrThree,
        /// In space: Bryant angles of the principal axes relative to the local frame \[rad\].
        axes: Option<Vec<Quantity>>,
        /// Which of its axes are those of a body that stands upright, in place of those of its system.
        anatomy: Option<Anatomy>,
        /// Of a head that has the neck in it: what its joint is.
        neck: Option<Neck>,
        /// How it is shown, beside its surfaces.
        mesh: Option<Meshes>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
    }
}

record! {
    /// Directions of a body that stands upright, in the local frames of its elements.
    Anatomy as "an anatomy" {
        /// From back to front.
        forward: Option<Direction>,
        /// From the feet to the head.
        up: Option<Direction>,
    }
}

words! {
    /// A direction along an axis.
    Direction {
        /// Along x.
        X = "x",
        /// Against x.
        NotX = "-x",
        /// Along y.
        Y = "y",
        /// Against y.
        NotY = "-y",
        /// Along z.
        Z = "z",
        /// Against z.
        NotZ = "-z",
    }
}

impl Direction {
    /// As a vector.
    pub fn vector(self) -> [i8; 3] {
        match self {
            Direction::X => [1, 0, 0],
            Direction::NotX => [-1, 0, 0],
            Direction::Y => [0, 1, 0],
            Direction::NotY => [0, -1, 0],
            Direction::Z => [0, 0, 1],
            Direction::NotZ => [0, 0, -1],
        }
    }
}

words! {
    /// What the joint of a head is that has the neck in it: it lies at C7/T1.
    Neck {
        /// Of a dummy: the place of its lower load cell, and never of the upper one.
        Lower = "lower",
        /// Of a person, who has no load cells.
        Within = "within",
    }
}
