//! The coordinates and velocities of a model, their order, and how q̇ follows from v.
//!
//! The order is system by system. First come the reference joint's coordinates, if it is free, then those of each
//! element: the coordinates of its joint, or its orientation on a ball joint. q̇ = v except for quaternions, where q̇ =
//! ½ ω ∘ q. Bryant angles are in one of two [charts](super::chart), which come first in m.

use super::ball::Orientation;
use super::numbers::number;
use super::variables::{self, Start, Variables};
use super::{ball, free};
use crate::equations::Variable;
use crate::expression::{Expr, Graph, Symbol};
use crate::model::joint::directions;
use crate::model::{Dimension, ElementId, Model, Reference};
use crate::model::{Freedom, Joint};
use std::ops::Range;

/// The state q and v, as expressions.
pub struct State<'g> {
    /// q
    pub q: Vec<Expr<'g>>,
    /// v
    pub v: Vec<Expr<'g>>,
    /// The charts of all elements with Bryant angles, which come first in m; empty for other coordinates.
    pub charts: Vec<Expr<'g>>,
}

impl<'g> State<'g> {
    /// The state as inputs of the equations.
    pub fn symbols(graph: &'g Graph, layout: &Layout) -> Self {
        State {
            q: (0..layout.coordinates.len())
                .map(|i| graph.symbol(Symbol::Coordinate(i as u32)))
                .collect(),
            v: (0..layout.velocities.len())
                .map(|i| graph.symbol(Symbol::Velocity(i as u32)))
                .collect(),
            charts: (0..layout.charts())
                .map(|i| graph.symbol(Symbol::Memory(i as u32)))
                .collect(),
        }
    }

    /// The state as inputs of the equations, with all Bryant angles in chart 0.
    pub fn in_first_chart(graph: &'g Graph, layout: &Layout) -> Self {
        State {
            charts: vec![graph.constant(0.0); layout.charts()],
            ..State::symbols(graph, layout)
        }
    }
}

/// The positions of all coordinates and velocities in q and v.
#[derive(Clone, Debug)]
pub struct Layout {
    /// q, in order.
    pub coordinates: Vec<Variable>,
    /// v, in order.
    pub velocities: Vec<Variable>,
    /// The description of the orientation of all elements on ball joints.
    pub orientation: Orientation,
    /// Absolute axes along which a free reference joint moves: (0, 2) in the plane, (0, 1, 2) in space.
    pub directions: &'static [usize],
    systems: Vec<SystemLayout>,
}

#[derive(Clone, Debug)]
struct SystemLayout {
    /// First index in q and in v of a free reference joint.
    reference: Option<(usize, usize)>,
    elements: Vec<ElementLayout>,
}

/// The positions of the coordinates of an element.
#[derive(Clone, Debug)]
struct ElementLayout {
    /// Range in q.
    coordinates: Range<usize>,
    /// Range in v.
    velocities: Range<usize>,
    /// Index of the chart of its Bryant angles in m.
    chart: Option<usize>,
    /// Whether its coordinates are a quaternion.
    quaternion: bool,
}

/// A velocity of a joint as a share of one entry of v: q = ratio · q_i + offset, q̇ = ratio · v_j. A coordinate that
/// follows no other has the ratio 1 and the offset 0.
#[derive(Clone, Copy)]
pub struct Share<'g> {
    /// i; for a ball joint, its first coordinate.
    pub coordinate: usize,
    /// j
    pub velocity: usize,
    /// 1 if the velocity is an entry of v itself.
    pub ratio: Expr<'g>,
    /// 0 if the coordinate is an entry of q itself.
    pub offset: Expr<'g>,
}

impl Layout {
    /// The layout of a model.
    pub fn of(model: &Model) -> Self {
        let orientation = Orientation::of(model.dimension, model.coordinates);
        let directions = directions(model.dimension == Dimension::Plane);
        let (mut coordinates, mut velocities) = (Vec::new(), Vec::new());
        let mut systems = Vec::new();
        let mut charts = 0;
        for (s, system) in model.systems.iter().enumerate() {
            // appends the variables, and returns their ranges in q and in v
            let mut add = |owner: &str, element, variables: Variables| {
                let first = (coordinates.len(), velocities.len());
                let variable = |(name, unit)| Variable {
                    name: format!("{owner}.{name}"),
                    unit,
                    system: s,
                    element,
                };
                coordinates.extend(variables.coordinates.into_iter().map(variable));
                velocities.extend(variables.velocities.into_iter().map(variable));
                (first.0..coordinates.len(), first.1..velocities.len())
            };
            let reference = matches!(system.reference, Reference::Free).then(|| {
                let (q, v) = add(&system.name, None, free::variables(directions));
                (q.start, v.start)
            });
            let mut elements = Vec::new();
            for (k, element) in system.elements.iter().enumerate() {
                let path = format!("{}/{}", system.name, element.name);
                let (q, v) = add(&path, Some(k), element.joint.variables(orientation));
                let ball = element.joint == Joint::Ball;
                let charted = ball && orientation == Orientation::Bryant;
                elements.push(ElementLayout {
                    coordinates: q,
                    velocities: v,
                    chart: charted.then_some(charts),
                    quaternion: ball && orientation == Orientation::Quaternion,
                });
                charts += usize::from(charted);
            }
            systems.push(SystemLayout {
                reference,
                elements,
            });
        }
        Layout {
            coordinates,
            velocities,
            orientation,
            directions,
            systems,
        }
    }

    /// Range in v of a free reference joint; `None` if it is not free.
    pub fn reference_velocities(&self, system: usize) -> Option<Range<usize>> {
        self.systems[system]
            .reference
            .map(|(_, v)| v..v + self.directions.len())
    }

    /// Range in q of a free reference joint; `None` if it is not free.
    pub fn reference_coordinates(&self, system: usize) -> Option<Range<usize>> {
        self.systems[system]
            .reference
            .map(|(q, _)| q..q + self.directions.len())
    }

    /// Range in v of a system.
    pub fn system_velocities(&self, system: usize) -> Range<usize> {
        let of = |s: &SystemLayout| {
            let first = s.reference.map(|(_, v)| v);
            let elements = (s.elements.first(), s.elements.last());
            let (Some(root), Some(last)) = elements else {
                return 0..0;
            };
            first.unwrap_or(root.velocities.start)..last.velocities.end
        };
        of(&self.systems[system])
    }

    /// Range in v of the joint of an element.
    pub fn element_velocities(&self, id: ElementId) -> Range<usize> {
        self.element(id).velocities.clone()
    }

    /// Range in q of the joint of an element.
    pub fn element_coordinates(&self, id: ElementId) -> Range<usize> {
        self.element(id).coordinates.clone()
    }

    /// The velocities of an element's joint, each as a share of an entry of v. A freedom that follows another
    /// has no entry of its own; it is a share of the leader's entry.
    pub fn shares<'g>(&self, graph: &'g Graph, model: &Model, id: ElementId) -> Vec<Share<'g>> {
        let whole = |(coordinate, velocity)| Share {
            coordinate,
            velocity,
            ratio: graph.constant(1.0),
            offset: graph.constant(0.0),
        };
        let mut own = self
            .element_coordinates(id)
            .zip(self.element_velocities(id))
            .map(whole);
        let system = &model.systems[id.system];
        let Joint::Freedoms(freedoms) = &system.elements[id.element].joint else {
            // a ball joint may have more coordinates than velocities
            let first = self.element_coordinates(id).start;
            return self
                .element_velocities(id)
                .map(|velocity| whole((first, velocity)))
                .collect();
        };
        let share = |freedom: &Freedom| match &freedom.follows {
            None => own.next(),
            Some(follows) => {
                let leader = ElementId {
                    element: follows.element,
                    ..id
                };
                let before = follows.coordinate(&system.elements);
                Some(Share {
                    coordinate: self.element_coordinates(leader).start + before,
                    velocity: self.element_velocities(leader).start + before,
                    ratio: number(graph, &follows.ratio),
                    offset: number(graph, &follows.offset),
                })
            }
        };
        freedoms.iter().filter_map(share).collect()
    }

    /// Index in m of the chart of an element's Bryant angles; `None` for other coordinates.
    pub fn element_chart(&self, id: ElementId) -> Option<usize> {
        self.element(id).chart
    }

    /// Number of charts, which come first in m.
    pub fn charts(&self) -> usize {
        self.elements().filter(|e| e.chart.is_some()).count()
    }

    /// Ranges in q that form unit quaternions.
    pub fn quaternions(&self) -> Vec<Range<usize>> {
        let quaternions = self.elements().filter(|e| e.quaternion);
        quaternions.map(|e| e.coordinates.clone()).collect()
    }

    fn elements(&self) -> impl Iterator<Item = &ElementLayout> {
        self.systems.iter().flat_map(|s| &s.elements)
    }

    fn element(&self, id: ElementId) -> &ElementLayout {
        &self.systems[id.system].elements[id.element]
    }

    /// q, v and charts at the start of a run.
    pub fn start<'g>(&self, graph: &'g Graph, model: &Model) -> State<'g> {
        graph.section("initial state");
        let (mut q, mut v, mut charts) = (Vec::new(), Vec::new(), Vec::new());
        let mut add = |start: Start<'g>| {
            q.extend(start.q);
            v.extend(start.v);
            charts.extend(start.chart);
        };
        for (s, system) in model.systems.iter().enumerate() {
            if self.systems[s].reference.is_some() {
                add(free::start(graph, self.directions, system));
            }
            for element in &system.elements {
                add(variables::start(graph, self.orientation, element));
            }
        }
        State { q, v, charts }
    }

    /// q̇ as a function of q and v.
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
                if self.element(id).quaternion {
                    graph.section(format!("element {}: rate of orientation", element.name));
                    let q = &state.q[self.element_coordinates(id)];
                    rates.extend(ball::quaternion_rates(q, v));
                } else {
                    rates.extend_from_slice(v);
                }
            }
        }
        rates
    }
}
