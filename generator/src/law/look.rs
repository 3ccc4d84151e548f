//! What is seen of a law. Pictures, reports and animations are made of this alone.

use super::Asked;
use super::types::{Belt, Ellipsoid, Plane};
use crate::model::{Attachment, Component, Number, Projection, Quantity};

/// A part of a law that is seen.
#[derive(Clone, Debug)]
pub enum Look<'a> {
    /// An ellipsoid.
    Round(Round<'a>),
    /// A bag with the shape that it has when full, and the volume of its gas.
    Bag(Round<'a>, Asked),
    /// A plane, and the ellipsoid that meets it, if one does.
    Plane(&'a Plane, Option<Round<'a>>),
    /// The force on the body of an ellipsoid, at its deepest point behind a plane, or against the force.
    Push(Round<'a>, Option<&'a Plane>),
    /// Straight lines from point to point, along which a force acts.
    Line(Line<'a>, Vec<&'a Attachment>),
}

/// An ellipsoid of a body.
#[derive(Clone, Copy, Debug)]
pub struct Round<'a> {
    /// Its centre.
    pub center: &'a Attachment,
    /// Its semi-axes \[m\].
    pub semi_axes: &'a [Number; 3],
    /// Bryant angles of its axes relative to the body's frame \[rad\].
    pub axes: &'a [Number; 3],
    /// n of Σ |x_i/a_i|ⁿ = 1
    pub degree: u32,
}

/// What pulls along a line.
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
    /// As it is seen.
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
    /// What a picture with forces has to know of it at each time, of a force with this index: of a line the force of each segment on what is before it, of a push
    /// the force, each along x, y and z; of a bag the volume.
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
