//! The visible parts of a law. Pictures, reports and animations use nothing else of it.

use super::body::Attachment;
use super::law::{Law, OfLaw};
use super::quantity::{Component, Projection, Quantity};
use super::surface::{Plane, Round, Shown};

/// A visible part of a law.
#[derive(Clone, Debug)]
pub enum Look<'a> {
    /// An ellipsoid.
    Round(Round<'a>),
    /// A bag: its shape when full, and the output for the volume of its gas.
    Bag(Round<'a>, Box<dyn OfLaw>),
    /// A plane, and the ellipsoid that meets it, if there is one.
    Plane(&'a Plane, Option<Round<'a>>),
    /// The force on the body of an ellipsoid. It acts at the deepest point of the ellipsoid behind the plane or,
    /// without a plane, in the direction against the force.
    Push(Round<'a>, Option<&'a Plane>),
    /// Straight lines from point to point, along which a force acts.
    Line(Line<'a>, Vec<&'a Attachment>),
}

/// The kind of law that pulls along a line.
#[derive(Clone, Copy, Debug)]
pub enum Line<'a> {
    /// A belt, with its law.
    Belt(&'a dyn Law),
    /// A spring.
    Spring,
    /// A bushing, from the origin of one frame to that of the other.
    Bushing,
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

impl Shown {
    /// The shape as part of a picture; `None` for a mesh, which no law has.
    pub fn look(&self) -> Option<Look<'_>> {
        match self {
            Shown::Round(ellipsoid, degree) => Some(Look::Round(Round {
                degree: *degree,
                ..ellipsoid.round()
            })),
            Shown::Plane(plane) => Some(Look::Plane(plane, None)),
            Shown::Mesh(_) => None,
        }
    }

    /// True if the shape is the same as this part of a law.
    pub(crate) fn is_in(&self, look: &Look<'_>) -> bool {
        match (self, look) {
            (Shown::Round(ellipsoid, _), Look::Round(round) | Look::Bag(round, _)) => {
                let own = ellipsoid.round();
                let shape = |round: &Round<'_>| (round.center.clone(), round.semi_axes.clone());
                shape(&own) == shape(round) && own.axes == round.axes
            }
            (Shown::Plane(plane), Look::Plane(other, _)) => plane == *other,
            _ => false,
        }
    }
}
