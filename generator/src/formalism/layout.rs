//! Which coordinates and velocities a model has, in which order, and how the one follow from the other.
//!
//! System by system: the reference joint's coordinates (where it is free), then each element's orientation. q̇ = v except for
//! quaternions, where q̇ = ½ ω ∘ q. Bryant angles are in one of two [charts](super::chart), which is the first of the memory.

use super::chart;
use super::kinematics::State;
use super::numbers::{number, quaternion_of_bryant, vector};
use crate::equations::Variable;
use crate::expression::{Expr, Graph};
use crate::model::{Coordinates, Dimension, ElementId, Model, Number, Reference};
use std::ops::Range;

/// How one element's orientation is described.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// One angle about +y.
    Angle,
    /// Unit quaternion (w, x, y, z), velocity ω.
    Quaternion,
    /// Three Bryant angles, velocity φ̇.
    Bryant,
}

impl Orientation {
    /// Number of coordinates.
    pub fn coordinates(self) -> usize {
        match self {
            Orientation::Angle => 1,
            Orientation::Quaternion => 4,
            Orientation::Bryant => 3,
        }
    }

    /// Number of velocities.
    pub fn velocities(self) -> usize {
        match self {
            Orientation::Angle => 1,
            Orientation::Quaternion | Orientation::Bryant => 3,
        }
    }
}

/// Positions of everything in q and v.
#[derive(Clone, Debug)]
pub struct Layout {
    /// q, in order.
    pub coordinates: Vec<Variable>,
    /// v, in order.
    pub velocities: Vec<Variable>,
    /// How orientation is described, of all elements.
    pub orientation: Orientation,
    /// Absolute axes along which a free reference joint moves: (0, 2) in the plane, (0, 1, 2) in space.
    pub directions: &'static [usize],
    systems: Vec<SystemLayout>,
}

#[derive(Clone, Debug)]
struct SystemLayout {
    /// First index in q and in v of a free reference joint.
    reference: Option<(usize, usize)>,
    /// First index in q and in v of each element.
    elements: Vec<(usize, usize)>,
    /// Number of elements of the systems before.
    before: usize,
}

impl Layout {
    /// The layout of a model.
    pub fn of(model: &Model) -> Self {
        let (orientation, directions): (_, &'static [usize]) =
            match (model.dimension, model.coordinates) {
                (Dimension::Plane, _) => (Orientation::Angle, &[0, 2]),
                (Dimension::Space, Coordinates::Quaternion) => {
                    (Orientation::Quaternion, &[0, 1, 2])
                }
                (Dimension::Space, Coordinates::Bryant) => (Orientation::Bryant, &[0, 1, 2]),
            };
        let (mut coordinates, mut velocities) = (Vec::new(), Vec::new());
        let mut systems = Vec::new();
        let mut before = 0;
        for (s, system) in model.systems.iter().enumerate() {
            let variable = |name: String, unit, element| Variable {
                name,
                unit,
                system: s,
                element,
            };
            let reference = matches!(system.reference, Reference::Free)
                .then_some((coordinates.len(), velocities.len()));
            if reference.is_some() {
                for axis in directions.iter().map(|&d| ["x", "y", "z"][d]) {
                    coordinates.push(variable(format!("{}.{axis}", system.name), "m", None));
                    velocities.push(variable(format!("{}.v{axis}", system.name), "m/s", None));
                }
            }
            let mut elements = Vec::new();
            for (k, element) in system.elements.iter().enumerate() {
                elements.push((coordinates.len(), velocities.len()));
                let path = format!("{}/{}", system.name, element.name);
                let (q, unit, v): (&[&str], _, &[&str]) = match orientation {
                    Orientation::Angle => (&["phi"], "rad", &["omega"]),
                    Orientation::Quaternion => (&["qw", "qx", "qy", "qz"], "", &["wx", "wy", "wz"]),
                    Orientation::Bryant => (
                        &["phi1", "phi2", "phi3"],
                        "rad",
                        &["dphi1", "dphi2", "dphi3"],
                    ),
                };
                coordinates.extend(
                    q.iter()
                        .map(|c| variable(format!("{path}.{c}"), unit, Some(k))),
                );
                velocities.extend(
                    v.iter()
                        .map(|c| variable(format!("{path}.{c}"), "rad/s", Some(k))),
                );
            }
            systems.push(SystemLayout {
                reference,
                elements,
                before,
            });
            before += system.elements.len();
        }
        Layout {
            coordinates,
            velocities,
            orientation,
            directions,
            systems,
        }
    }

    /// Indices in v of a free reference joint.
    pub fn reference_velocities(&self, system: usize) -> Option<Range<usize>> {
        self.systems[system]
            .reference
            .map(|(_, v)| v..v + self.directions.len())
    }

    /// Indices in q of a free reference joint.
    pub fn reference_coordinates(&self, system: usize) -> Option<Range<usize>> {
        self.systems[system]
            .reference
            .map(|(q, _)| q..q + self.directions.len())
    }

    /// Indices in v of an element's rotation.
    pub fn element_velocities(&self, id: ElementId) -> Range<usize> {
        let v = self.systems[id.system].elements[id.element].1;
        v..v + self.orientation.velocities()
    }

    /// Indices in q of an element's orientation.
    pub fn element_coordinates(&self, id: ElementId) -> Range<usize> {
        let q = self.systems[id.system].elements[id.element].0;
        q..q + self.orientation.coordinates()
    }

    /// Index in m of the chart that an element's Bryant angles are in; `None` in other coordinates.
    pub fn element_chart(&self, id: ElementId) -> Option<usize> {
        (self.orientation == Orientation::Bryant)
            .then(|| self.systems[id.system].before + id.element)
    }

    /// Number of charts, which are the first of m.
    pub fn charts(&self) -> usize {
        match self.orientation {
            Orientation::Bryant => self.systems.iter().map(|s| s.elements.len()).sum(),
            Orientation::Angle | Orientation::Quaternion => 0,
        }
    }

    /// Indices in q that form unit quaternions.
    pub fn quaternions(&self) -> Vec<Range<usize>> {
        if self.orientation != Orientation::Quaternion {
            return Vec::new();
        }
        self.systems
            .iter()
            .flat_map(|s| s.elements.iter().map(|&(q, _)| q..q + 4))
            .collect()
    }

    /// q, v and charts where a run starts.
    pub fn start<'g>(&self, graph: &'g Graph, model: &Model) -> State<'g> {
        graph.section("initial state");
        let (mut q, mut v, mut charts) = (Vec::new(), Vec::new(), Vec::new());
        let of = |n: &Number| number(graph, n);
        for (s, system) in model.systems.iter().enumerate() {
            if self.systems[s].reference.is_some() {
                q.extend(self.directions.iter().map(|&d| of(&system.position[d])));
                v.extend(self.directions.iter().map(|&d| of(&system.velocity[d])));
            }
            for element in &system.elements {
                let angles = vector(graph, &element.angles).0;
                let omega = vector(graph, &element.angular_velocity);
                match self.orientation {
                    Orientation::Angle => {
                        q.push(angles[1]);
                        v.push(omega.0[1]);
                    }
                    Orientation::Quaternion => {
                        q.extend(quaternion_of_bryant(angles));
                        v.extend(omega.0);
                    }
                    Orientation::Bryant => {
                        let charted = chart::start(graph, angles, omega);
                        q.extend(charted.angles);
                        v.extend(charted.rates);
                        charts.push(charted.chart);
                    }
                }
            }
        }
        State { q, v, charts }
    }

    /// q̇.
    pub fn coordinate_rates<'g>(
        &self,
        graph: &'g Graph,
        model: &Model,
        state: &State<'g>,
    ) -> Vec<Expr<'g>> {
        let mut rates = Vec::with_capacity(self.coordinates.len());
        for (s, system) in model.systems.iter().enumerate() {
            if let Some(range) = self.reference_velocities(s) {
                rates.extend_from_slice(&state.v[range]);
            }
            for (k, element) in system.elements.iter().enumerate() {
                let id = ElementId {
                    system: s,
                    element: k,
                };
                let v = &state.v[self.element_velocities(id)];
                if self.orientation == Orientation::Quaternion {
                    graph.section(format!("element {}: rate of orientation", element.name));
                    let &[w, x, y, z] = &state.q[self.element_coordinates(id)] else {
                        unreachable!("an element has four coordinates of orientation here")
                    };
                    let &[a, b, c] = v else {
                        unreachable!("an element turns with three velocities in space")
                    };
                    let (a, b, c) = (0.5 * a, 0.5 * b, 0.5 * c);
                    rates.push(-(a * x + b * y + c * z));
                    rates.push(a * w + b * z - c * y);
                    rates.push(b * w + c * x - a * z);
                    rates.push(c * w + a * y - b * x);
                } else {
                    rates.extend_from_slice(v);
                }
            }
        }
        rates
    }
}
