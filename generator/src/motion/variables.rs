//! Facts about the joint of an element for the equations: its coordinates and velocities, and their values at the
//! start. The motion itself is in the file of each joint.

use super::ball::{self, Orientation};
use super::numbers::number;
use crate::expression::{Expr, Graph};
use crate::model::joint::axes_of_rotation;
use crate::model::{Dimension, Element};
use crate::model::{Freedom, Joint};

/// Names and SI units of the coordinates and velocities of a joint.
pub(crate) struct Variables {
    /// Names and units of q.
    pub coordinates: Vec<(String, &'static str)>,
    /// Names and units of v.
    pub velocities: Vec<(String, &'static str)>,
}

/// Coordinates and velocities of a joint at the start.
pub(crate) struct Start<'g> {
    /// q
    pub q: Vec<Expr<'g>>,
    /// v
    pub v: Vec<Expr<'g>>,
    /// The chart of Bryant angles; `None` for other coordinates.
    pub chart: Option<Expr<'g>>,
}

impl Joint {
    /// Names and units of the joint's coordinates and velocities. A freedom that follows another has none.
    pub(crate) fn variables(&self, orientation: Orientation) -> Variables {
        match self {
            Joint::Ball => ball::variables(orientation),
            Joint::Freedoms(freedoms) => {
                let own = || freedoms.iter().filter(|freedom| freedom.is_own());
                let units = |freedom: &Freedom| freedom.kind.coordinate().units();
                Variables {
                    coordinates: own().map(|f| (f.name.clone(), units(f)[0])).collect(),
                    velocities: own()
                        .map(|f| (format!("{}-rate", f.name), units(f)[1]))
                        .collect(),
                }
            }
        }
    }

    /// The number of the joint's velocities.
    pub fn velocities(&self, dimension: Dimension) -> usize {
        match self {
            Joint::Ball => axes_of_rotation(dimension == Dimension::Plane).len(),
            Joint::Freedoms(freedoms) => freedoms.iter().filter(|f| f.is_own()).count(),
        }
    }
}

/// q, v and the chart of an element at the start.
pub(crate) fn start<'g>(
    graph: &'g Graph,
    orientation: Orientation,
    element: &Element,
) -> Start<'g> {
    match &element.joint {
        Joint::Ball => ball::start(graph, orientation, element),
        Joint::Freedoms(freedoms) => {
            let own = || freedoms.iter().filter(|freedom| freedom.is_own());
            Start {
                q: own().map(|f| number(graph, &f.position)).collect(),
                v: own().map(|f| number(graph, &f.rate)).collect(),
                chart: None,
            }
        }
    }
}
