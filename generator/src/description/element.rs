//! Elements as written.

use super::joint::Joint;
use super::measure::{Angle, Inertia, Length, Mass, Positive};
use super::mesh::Meshes;
use super::quantity::{Number, OneOrThree};
use super::shape::{record, words};

record! {
    /// A rigid element and the joint that carries it.
    Element as "an element" {
        /// name, unique in its system
        name: String,
        /// the element that carries this one; exactly one element of a system has no `on`
        on: Option<String> = "none: the root",
        /// required with `on`: the joint, in the local frame of the element that carries this one
        at: Option<Vec<Number<Length>>> = "none for the root",
        /// what the [joint](#a-joint) lets the element do
        joint: Option<Joint> = "a ball in space, a hinge in the plane",
        /// mass
        mass: Number<Positive<Mass>>,
        /// centre of gravity, local frame
        cg: Vec<Number<Length>>,
        /// about the centre of gravity: the moment about y in the plane; in space the three principal moments, each at
        /// most the sum of the other two, or the tensor as six numbers `[xx, yy, zz, xy, xz, yz]`, in the axes of the
        /// element, without `axes`
        inertia: OneOrThree<Number<Inertia>>,
        /// in space: Bryant angles of the principal axes relative to the local frame
        axes: Option<Vec<Number<Angle>>> = "those of the frame",
        /// which of its axes are [forward and up](#an-anatomy)
        anatomy: Option<Anatomy> = "that of the system",
        /// of a head that has the neck in it, with its joint at C7/T1: `lower` of a dummy, whose lower load cell is
        /// there, so that [codes of the upper one](criteria.md#head-and-neck-in-one) are refused; `within` of a person,
        /// who has no load cells
        neck: Option<Neck>,
        /// the [meshes](#a-mesh) that it is shown with
        mesh: Option<Meshes>,
        /// [points](#a-point) of it that have names, as frames for [functions](functions.md)
        points: Option<Vec<NamedPoint>>,
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    }
}

record! {
    /// A point of an element, with axes of its own: a frame.
    NamedPoint as "a point" {
        /// name, unique among the elements and points of its system
        name: String,
        /// where it is, local frame
        at: Option<Vec<Number<Length>>> = "the joint",
        /// Bryant angles of its axes relative to the local frame; in the plane one angle
        angles: Option<OneOrThree<Number<Angle>>> = "0",
    }
}

record! {
    /// Directions of a body that stands upright, in the local frames of its elements.
    Anatomy as "an anatomy" {
        /// from back to front: `x`, `y` or `z`, or one of them with `-`
        forward: Option<Direction> = "`x`",
        /// from the feet to the head, at right angles to `forward`
        up: Option<Direction> = "`z`",
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
