//! The visible parts of a law. Pictures, reports and animations use nothing else of it.

use super::Asked;
use super::types::{Belt, Ellipsoid, Plane};
use crate::model::{Attachment, Component, Number, Projection, Quantity};

/// A visible part of a law.
#[derive(Clone, Debug)]
pub enum Look<'a> {
    /// An ellipsoid.
    Round(Round<'a>),
    /// A bag: its shape when full, and the output for the volume of its gas.
    Bag(Round<'a>, Asked),
    /// A plane, and the ellipsoid that meets it, if there is one.
    Plane(&'a Plane, Option<Round<'a>>),
    /// The force on the body of an ellipsoid. It acts at the deepest point of the ellipsoid behind the plane or,
    /// without a plane, in the direction against the force.
    Push(Round<'a>, Option<&'a Plane>),
    /// Straight lines from point to point, along which a force acts.
    Line(Line<'a>, Vec<&'a Attachment>),
}

/// An ellipsoid of a body.
#[derive(Clone, Copy, Debug)]
pub struct Round<'a> {
    /// The centre of the ellipsoid.
    pub center: &'a Attachment,
    /// The semi-axes \[m\].
    pub semi_axes: &'a [Number; 3],
    /// Bryant angles of the ellipsoid's axes relative to the body's frame \[rad\].
    pub axes: &'a [Number; 3],
    /// n of Σ |x_i/a_i|ⁿ = 1
    pub degree: u32,
}

/// The kind of law that pulls along a line.
#[derive(Clone, Copy, Debug)]
pub enum Line<'a> {
    /// A belt.
    Belt(&'a Belt),
    /// A spring.
    Spring,
    /// A bushing, from the origin of one frame to that of the other.
    Bushing,
}

impl Ellipsoid {
    /// The ellipsoid as a part of a picture.
    pub fn round(&self) -> Round<'_> {
        Round {
            center: &self.center,
            semi_axes: &self.semi_axes,
            axes: &self.axes,
            degree: 2,
        }
    }
}

impl Look<'_> {
    /// The quantities that a picture with forces needs at each time, for the force with this index: for a line, the
    /// force of each segment on the point before it; for a push, the force; each along x, y and z. For a bag, the
    /// volume.
    pub fn asks(&self, force: usize) -> Vec<Quantity> {
        let along = |quantity: &dyn Fn(Projection) -> Quantity| -> Vec<Quantity> {
            let axes = [Component::X, Component::Y, Component::Z];
            axes.map(|axis| quantity(Projection::absolute(axis))).into()
        };
        let on_first = |projection| Quantity::ForceOn {
            force,
            on_second: false,
            projection,
        };
        match self {
            Look::Round(_) | Look::Plane(..) => Vec::new(),
            Look::Bag(_, volume) => vec![Quantity::OfForce {
                force,
                what: volume.clone(),
            }],
            Look::Push(..) => along(&on_first),
            Look::Line(_, points) if points.len() == 2 => along(&on_first),
            Look::Line(_, points) => {
                let segments = (1..points.len()).flat_map(|segment| {
                    along(&|projection| Quantity::ForceOnPoints {
                        force,
                        points: (0..segment).collect(),
                        projection,
                    })
                });
                segments.collect()
            }
        }
    }
}
