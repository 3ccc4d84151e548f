//! Elements as written.

use super::joint::Joint;
use super::quantity::{OneOrThree, Quantity};
use super::shape::record;

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
        /// Whether it has a mirror image.
        mirror: Option<bool>,
    }
}
