//! The equations of motion of one model: S(q) q̈ = r_s(q, q̇) + r_k(t, q, q̇)   \[MADYMO 1980, eq. 2\]
//!
//! The one type between derivation and emission: a graph with named outputs. v stands for q̇ in the plane and in Bryant
//! coordinates; in space with quaternions v holds ẋ and ω, and S, r_s, r_k belong to v̇.

use crate::expression::{Graph, NodeId};

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
    pub system_matrix: Vec<Vec<NodeId>>,
    /// r_s, V.
    pub velocity_forces: Vec<NodeId>,
    /// r_k, V.
    pub applied_forces: Vec<NodeId>,
    /// v̇, V, by the route that counts fewest operations.
    pub accelerations: Vec<NodeId>,
    /// Which route that is.
    pub route: Route,
    /// The model's outputs, in its order.
    pub outputs: Vec<NodeId>,
    /// Groups of coordinates (index ranges) that form unit quaternions.
    pub quaternions: Vec<std::ops::Range<usize>>,
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

/// How accelerations are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Route {
    /// Elimination from the leaves to the root with 3×3 blocks; S is never assembled.
    Elimination,
    /// S assembled and factorised with its fixed pattern, S = LᵀDL.
    SystemMatrix,
}
