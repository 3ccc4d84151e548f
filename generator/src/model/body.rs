//! Bodies, and points fixed in them.

use super::number::Number;
use serde::Serialize;

/// Identifies an element: index of the system, and of the element in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct ElementId {
    /// Index into [`Model::systems`](super::Model::systems).
    pub system: usize,
    /// Index into [`System::elements`](super::System::elements).
    pub element: usize,
}

/// A body that a point or a plane is attached to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Body {
    /// The absolute frame.
    Frame,
    /// An element.
    Element(ElementId),
    /// A vehicle: index into [`Model::vehicles`](super::Model::vehicles).
    Vehicle(usize),
}

/// A point fixed in a body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Attachment {
    /// The body.
    pub on: Body,
    /// Position in the body's local frame \[m\].
    pub at: [Number; 3],
}
