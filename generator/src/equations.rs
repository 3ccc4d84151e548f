//! The equations of motion of one model: S(q) q̈ = r_s(q, q̇) + r_k(t, q, q̇)   \[MADYMO 1980, eq. 2\]
//!
//! This type connects derivation and code generation: a graph with named results. v is q̇ in the plane and with Bryant
//! angles; in space with quaternions v holds ẋ and ω, and S v̇ = r_s + r_k.

use crate::expression::{Graph, NodeId};
use crate::method::argument::Argument;
use crate::method::{Method, Start};
use crate::model::Rule;
use serde::{Deserialize, Serialize};

/// Equations of motion over one graph.
pub struct Equations {
    /// All expressions.
    pub graph: Graph,
    /// The coordinates q, in order.
    pub coordinates: Vec<Variable>,
    /// The velocities v, in order.
    pub velocities: Vec<Variable>,
    /// q at the start of a run (functions of parameters).
    pub initial_coordinates: Vec<NodeId>,
    /// v at the start of a run (functions of parameters).
    pub initial_velocities: Vec<NodeId>,
    /// q̇ as functions of q and v.
    pub coordinate_rates: Vec<NodeId>,
    /// S, a symmetric matrix of the size of v, by rows.
    pub mass_matrix: Vec<Vec<NodeId>>,
    /// r_s, of the length of v.
    pub velocity_forces: Vec<NodeId>,
    /// r_k, of the length of v.
    pub applied_forces: Vec<NodeId>,
    /// v̇, by `route`.
    pub accelerations: Vec<NodeId>,
    /// The route by which v̇ is computed.
    pub route: Route,
    /// The states z that force laws add to q and v, integrated with them.
    pub auxiliaries: Vec<LawState>,
    /// m: the charts of Bryant angles, and the memories of force laws. They are constant during a step, and are renewed
    /// after an accepted step from the state that it has reached.
    pub memory: Vec<LawState>,
    /// Number of charts, the first entries of m: one for each element with Bryant angles.
    pub charts: usize,
    /// q after an accepted step: other angles if a chart changes, otherwise q itself.
    pub renewed_coordinates: Vec<NodeId>,
    /// v after an accepted step.
    pub renewed_velocities: Vec<NodeId>,
    /// Functions whose change of sign ends a step: where a force law changes its branch.
    pub event_functions: Vec<Named>,
    /// Functions that change sign where a force law is not smooth, but on which no memory depends.
    pub kinks: Vec<Named>,
    /// The onsets of laws that do not act, then the corners of curves.
    pub onsets: Vec<Onset>,
    /// Number of corners, the last ones of the onsets.
    pub corners: usize,
    /// The curves of the state, with their arguments.
    pub curves: Vec<CurveOfState>,
    /// The conditions that parameters must satisfy.
    pub conditions: Vec<Condition>,
    /// Pivots of the elimination that may vanish in some position, each divided by its diagonal entry of S; the pivots
    /// of an element follow one another.
    pub pivots: Vec<Named>,
    /// The sections that nothing else is made of.
    pub sections: Vec<Section>,
    /// The functions that are asked for, in the order of the requests.
    pub functions: Vec<Function>,
    /// The functions that are asked for and that the model cannot have.
    pub impossible: Vec<Impossible>,
    /// The model's outputs, in its order.
    pub outputs: Vec<NodeId>,
    /// Curves of time: for each its index, and the factor of time in its abscissa.
    pub curves_of_time: Vec<(usize, NodeId)>,
    /// Groups of coordinates (index ranges) that form unit quaternions.
    pub quaternions: Vec<std::ops::Range<usize>>,
}

/// The onset of a law, or a corner of a curve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Onset {
    /// The law and the event ("contact hit: touches").
    pub name: String,
    /// For a law: positive while it certainly does not act. For a corner: the distance of the abscissa from it,
    /// positive on one side and negative on the other.
    pub gap: NodeId,
    /// Upper bound of the rate of change of the gap, in the gap's unit per second; never negative.
    pub speed: NodeId,
}

/// One coordinate or velocity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variable {
    /// Name for people: "man.x", "man/head.angle", "man/head.qw", "man/head.wx".
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// Index of the system.
    pub system: usize,
    /// Index of the element in the system; `None` for the reference joint.
    pub element: Option<usize>,
}

/// A state that a force law keeps besides q and v.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LawState {
    /// Name for people: "contact seat: permanent set".
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// Value at the start of a run (a function of parameters).
    pub initial: NodeId,
    /// For an auxiliary state its rate, for a memory its value after an accepted step; functions of t, q, v, z, m.
    pub next: NodeId,
}

/// A section: values at a time and a state, which a method of its own computes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// Its method.
    pub method: Method,
    /// The values with their names; a single value has none.
    pub values: Vec<Named>,
    /// The values from which the method may start.
    pub start: Start,
}

/// A [function](crate::dynamics::functions) that is asked for: a matrix of values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Function {
    /// Its name, with its argument: "jacobian(arm/hand)".
    pub name: String,
    /// What it computes.
    pub sentence: &'static str,
    /// The arguments that it always has.
    pub arguments: &'static [Argument],
    /// The names of its rows; a single row may have none.
    pub rows: Vec<String>,
    /// The names of its columns; a single column has none.
    pub columns: Vec<String>,
    /// The values, by rows.
    pub values: Vec<NodeId>,
}

/// A function that a model cannot have, because one of its laws cannot be differentiated in symbols.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Impossible {
    /// The name of the function.
    pub function: String,
    /// What cannot be differentiated.
    pub what: &'static str,
}

impl Equations {
    /// The values of a section; none if the model does not have it.
    pub fn section(&self, method: Method) -> &[Named] {
        let found = self
            .sections
            .iter()
            .find(|section| section.method == method);
        found.map_or(&[], |section| &section.values)
    }

    /// The curves of time whose rate depends on parameters, each with its rate.
    pub fn stretched_curves_of_time(&self) -> impl Iterator<Item = (usize, NodeId)> + '_ {
        let curves = self.curves_of_time.iter().copied();
        curves.filter(|(_, rate)| self.graph.expr(*rate).as_constant().is_none())
    }
}

/// A value with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named {
    /// Name for people.
    pub name: String,
    /// The value.
    pub value: NodeId,
}

/// The value in place of the bearing of a joint that is bent by less than 90° \[rad\], and of the direction of a
/// contact that does not push.
pub const NO_BEARING: f64 = 10.0;
/// Smallest share of its volume that is left to the gas of an airbag.
pub const LEAST_VOLUME: f64 = 0.02;

/// A curve whose argument depends on the state, or another quantity that is watched like such an argument.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveOfState {
    /// Owner and curve, for people: "joint man/head: elastic curve".
    pub name: String,
    /// The kind of quantity.
    pub what: Watched,
    /// The argument of a curve, as an abscissa of its points; otherwise the watched quantity itself.
    pub argument: NodeId,
}

/// A quantity that is watched during a run: the argument of a curve, or one that is treated like it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Watched {
    /// The argument of a curve, by its index in [`Model::curves`](crate::model::Model::curves), and its SI unit; "" for
    /// a pure number, and in [facts](crate::program::Watched), which have the unit themselves.
    Curve(usize, #[serde(skip)] &'static str),
    /// The side to which a joint is bent, as an angle.
    Bearing,
    /// The distance of an angle from ±180°, with its sign; a torque jumps there.
    HalfTurn,
    /// A component of the direction in which two ellipsoids push each other, or about which a bushing turns; the
    /// components of a direction follow one another.
    Direction(u8),
    /// The share of an airbag's volume that penetrating bodies take up.
    Volume,
    /// The ratio of the push of a fading edge to the force of its plane.
    Edge,
}

/// A condition on parameters: a function of them, and its allowed values.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// For people: "`mass` of man/head must be positive".
    pub name: String,
    /// The function.
    pub value: NodeId,
    /// The values that the function may have.
    pub rule: Rule,
}

/// The route by which accelerations are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// Elimination from the leaves to the root with 3×3 blocks; S is never assembled.
    Elimination,
    /// S assembled and factorised with its fixed pattern, S = LᵀDL.
    MassMatrix,
}
