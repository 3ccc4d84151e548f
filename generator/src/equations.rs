//! The equations of motion of one model: S(q) q̈ = r_s(q, q̇) + r_k(t, q, q̇)   \[MADYMO 1980, eq. 2\]
//!
//! The one type between derivation and emission: a graph with named outputs. v stands for q̇ in the plane and in Bryant
//! coordinates; in space with quaternions v holds ẋ and ω, and S, r_s, r_k belong to v̇.

use crate::expression::{Graph, NodeId};
use crate::model::Rule;

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
    /// S, V×V, symmetric, by rows.
    pub mass_matrix: Vec<Vec<NodeId>>,
    /// r_s, V.
    pub velocity_forces: Vec<NodeId>,
    /// r_k, V.
    pub applied_forces: Vec<NodeId>,
    /// v̇, V, by the route that counts fewest operations.
    pub accelerations: Vec<NodeId>,
    /// Which route that is.
    pub route: Route,
    /// The states z that force laws add to q and v, integrated with them.
    pub auxiliaries: Vec<LawState>,
    /// The charts of Bryant angles, and what force laws remember, m: constant during a step, renewed from the state reached
    /// when a step is accepted.
    pub memory: Vec<LawState>,
    /// How many of m, the first, are charts: one for each element in Bryant angles, else none.
    pub charts: usize,
    /// q after a step that was accepted with a state: other angles where a chart changes, else q itself.
    pub renewed_coordinates: Vec<NodeId>,
    /// v after a step that was accepted with a state.
    pub renewed_velocities: Vec<NodeId>,
    /// Functions whose change of sign ends a step: where a force law changes its branch.
    pub event_functions: Vec<Named>,
    /// Functions whose change of sign is where a force law is not smooth, though no memory depends on it.
    pub kinks: Vec<Named>,
    /// When laws that do not act begin to, and behind them how far the corners of curves are.
    pub onsets: Vec<Onset>,
    /// How many of the onsets are corners, the last ones.
    pub corners: usize,
    /// The curves of the state, with their arguments.
    pub curves: Vec<CurveOfState>,
    /// What parameters must keep.
    pub conditions: Vec<Condition>,
    /// Pivots of the elimination that may vanish in some position, as shares of what stands in their place before; those of an
    /// element behind each other.
    pub pivots: Vec<Named>,
    /// T, the kinetic energy of all elements \[J\].
    pub kinetic_energy: NodeId,
    /// Power of each effect \[W\]: together the rate of the kinetic energy.
    pub powers: Vec<Named>,
    /// Linear \[N s\] and angular momentum about the origin \[N m s\] of all systems whose reference joint is free, absolute
    /// axes; nothing where there is none.
    pub momentum: Vec<NodeId>,
    /// The resultant \[N\] and the moment about the origin \[N m\] of what acts on them: the rate of the momentum.
    pub external_wrench: Vec<NodeId>,
    /// The model's outputs, in its order.
    pub outputs: Vec<NodeId>,
    /// Curves of time: the index of each, and the factor that makes its abscissa of time.
    pub curves_of_time: Vec<(usize, NodeId)>,
    /// Groups of coordinates (index ranges) that form unit quaternions.
    pub quaternions: Vec<std::ops::Range<usize>>,
}

/// When a law that does not act begins to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Onset {
    /// Which law, and what begins ("contact hit: touches").
    pub name: String,
    /// Positive while the law certainly does not act; of a corner how far it is, on one side positive, on the other negative.
    pub gap: NodeId,
    /// How fast the gap changes at most, in its unit per second, never negative.
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
    /// Of an auxiliary its rate, of a memory its value after an accepted step; functions of t, q, v, z, m.
    pub next: NodeId,
}

impl Equations {
    /// The curves of time that parameters stretch, each with its rate.
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

/// What stands for the bearing of a joint that is bent by less than 90° \[rad\], and for the direction of a contact that does not push.
pub const NO_BEARING: f64 = 10.0;
/// Least share of its volume that is left to the gas of an airbag.
pub const LEAST_VOLUME: f64 = 0.02;

/// A curve at an argument that depends on the state, or the bearing of a bent joint or the direction of a contact, which are watched like one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CurveOfState {
    /// Whose it is, for people: "joint man/head: elastic curve".
    pub name: String,
    /// What it is.
    pub what: Watched,
    /// Its argument, as the abscissa of its points; or the bearing \[rad\], or a component of the direction.
    pub argument: NodeId,
}

/// What is watched like the argument of a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watched {
    /// The argument of a curve, by its index in [`Model::curves`](crate::model::Model::curves).
    Curve(usize),
    /// To which side a joint is bent.
    Bearing,
    /// On which side of ±180° an angle is, where a torque jumps.
    HalfTurn,
    /// A component of the direction in which two ellipsoids push each other, or a bushing turns; all components of one follow each other.
    Direction(u8),
    /// The share of the volume of an airbag that what it meets takes.
    Volume,
    /// The push of a fading edge of a plane over the force of the plane.
    Edge,
}

/// What parameters must keep: a function of them, and what it may be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Condition {
    /// For people: "`mass` of man/head must be positive".
    pub name: String,
    /// The function.
    pub value: NodeId,
    /// What it may be.
    pub rule: Rule,
}

/// How accelerations are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// Elimination from the leaves to the root with 3×3 blocks; S is never assembled.
    Elimination,
    /// S assembled and factorised with its fixed pattern, S = LᵀDL.
    MassMatrix,
}
