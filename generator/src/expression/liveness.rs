//! The live nodes, i.e. those that a set of results needs, how often each is used, and the inputs it depends on.
//!
//! d(node) = d(operand₁) ∪ d(operand₂) ∪ …, d(input) = the kind of the input.
//!
//! Dependence decides when a value is computed: once per simulation if it depends on parameters alone
//! ([`Live::hoistable`]), at every state otherwise.

use super::graph::Graph;
use super::node::{Function, Node, NodeId, Symbol};
use std::fmt;
use std::ops::BitOr;

/// The kinds of inputs that a value depends on: a set, ordered by inclusion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Dependence(u8);

impl Dependence {
    /// Depends on nothing: a constant.
    pub const CONSTANT: Self = Dependence(0);
    /// Depends on parameters.
    pub const PARAMETERS: Self = Dependence(1);
    /// Depends on time.
    pub const TIME: Self = Dependence(2);
    /// Depends on coordinates.
    pub const COORDINATES: Self = Dependence(4);
    /// Depends on velocities.
    pub const VELOCITIES: Self = Dependence(8);
    /// Depends on continuous or discrete states of force laws.
    pub const LAWS: Self = Dependence(16);
    /// Depends on given accelerations.
    pub const ACCELERATIONS: Self = Dependence(32);

    /// True if `limit` contains all kinds of inputs of this set.
    pub fn within(self, limit: Self) -> bool {
        self.0 & !limit.0 == 0
    }

    fn of_symbol(symbol: Symbol) -> Self {
        match symbol {
            Symbol::Time => Self::TIME,
            Symbol::Coordinate(_) => Self::COORDINATES,
            Symbol::Velocity(_) => Self::VELOCITIES,
            Symbol::Parameter(_) => Self::PARAMETERS,
            Symbol::Auxiliary(_) | Symbol::Memory(_) => Self::LAWS,
            Symbol::Acceleration(_) => Self::ACCELERATIONS,
        }
    }
}

impl BitOr for Dependence {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Dependence(self.0 | other.0)
    }
}

impl fmt::Display for Dependence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::CONSTANT {
            return f.write_str("nothing");
        }
        let kinds = [
            (Self::PARAMETERS, "parameters"),
            (Self::TIME, "time"),
            (Self::COORDINATES, "coordinates"),
            (Self::VELOCITIES, "velocities"),
            (Self::LAWS, "states of force laws"),
            (Self::ACCELERATIONS, "accelerations"),
        ];
        let mut separator = "";
        for (kind, name) in kinds {
            if kind.within(*self) {
                write!(f, "{separator}{name}")?;
                separator = ", ";
            }
        }
        Ok(())
    }
}

/// The nodes that some results need.
#[derive(Clone, Debug)]
pub struct Live {
    nodes: Vec<NodeId>,
    /// The number of uses of each node of the graph; 0 if it is not live.
    uses: Vec<u32>,
    /// The dependence of each node of the graph; valid for live nodes only.
    dependence: Vec<Dependence>,
    roots: Vec<NodeId>,
}

impl Live {
    /// The nodes that `roots` need. A root may be listed more than once.
    pub fn new(graph: &Graph, roots: &[NodeId]) -> Self {
        let all = graph.nodes();
        // Operands are older than their users, so no node younger than the youngest root is needed.
        let end = roots.iter().map(|r| r.0 as usize + 1).max().unwrap_or(0);
        let mut uses = vec![0; all.len()];
        for root in roots {
            uses[root.0 as usize] += 1;
        }
        for id in (0..end).rev() {
            if uses[id] > 0 {
                for operand in all[id].operands() {
                    uses[operand.0 as usize] += 1;
                }
            }
        }
        let mut dependence = vec![Dependence::CONSTANT; all.len()];
        let mut nodes = Vec::new();
        for id in (0..end).filter(|&id| uses[id] > 0) {
            nodes.push(NodeId(id as u32));
            dependence[id] = all[id].operands().fold(own_dependence(&all[id]), |d, o| {
                d | dependence[o.0 as usize]
            });
        }
        Live {
            nodes,
            uses,
            dependence,
            roots: roots.to_vec(),
        }
    }

    /// The live nodes in order of creation: operands before their users.
    pub fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    /// True if the node is live.
    pub fn contains(&self, id: NodeId) -> bool {
        self.uses(id) > 0
    }

    /// How often the node is used as an operand of live nodes (twice in x · x) or as a root; 0 if it is not live.
    pub fn uses(&self, id: NodeId) -> u32 {
        self.uses.get(id.0 as usize).copied().unwrap_or(0)
    }

    /// The kinds of inputs that a live node depends on.
    pub fn dependence(&self, id: NodeId) -> Dependence {
        self.dependence[id.0 as usize]
    }

    /// The roots, as given.
    pub fn roots(&self) -> &[NodeId] {
        &self.roots
    }

    /// The values to compute once per simulation: those [`maximal_within`](Self::maximal_within) the parameters.
    pub fn hoistable(&self, graph: &Graph) -> Vec<NodeId> {
        self.maximal_within(graph, Dependence::PARAMETERS)
    }

    /// The operations that depend on no kinds of inputs beyond `limit`, and that are roots or are used by a node that
    /// depends on more. They are in order of creation.
    ///
    /// Constants and inputs are left out, because they exist already. So are signs: for −a, the list has a.
    pub fn maximal_within(&self, graph: &Graph, limit: Dependence) -> Vec<NodeId> {
        let all = graph.nodes();
        let unsigned = |id: NodeId| match all[id.0 as usize] {
            Node::Neg(a) => a,
            _ => id,
        };
        let mut maximal = vec![false; all.len()];
        for &id in &self.nodes {
            if !self.dependence(id).within(limit) {
                for operand in all[id.0 as usize].operands() {
                    maximal[unsigned(operand).0 as usize] = true;
                }
            }
        }
        // for a list of arguments, its members; lists come after their members, so this goes backwards
        for &id in self.nodes.iter().rev() {
            if let Node::Arguments(members) = all[id.0 as usize]
                && maximal[id.0 as usize]
            {
                for member in members {
                    maximal[unsigned(member).0 as usize] = true;
                }
            }
        }
        for &root in &self.roots {
            maximal[unsigned(root).0 as usize] = true;
        }
        let wanted = |id: &NodeId| {
            let node = all[id.0 as usize];
            maximal[id.0 as usize]
                && self.dependence(*id).within(limit)
                && !matches!(
                    node,
                    Node::Constant(_) | Node::Symbol(_) | Node::Arguments(_)
                )
        };
        self.nodes.iter().copied().filter(wanted).collect()
    }
}

/// The dependence that a node has by itself, without that of its operands.
fn own_dependence(node: &Node) -> Dependence {
    match node {
        Node::Symbol(symbol) => Dependence::of_symbol(*symbol),
        // The points of a curve may be parameters.
        Node::Call(
            Function::Curve(_)
            | Function::CurveSlope(_)
            | Function::CurveSecondDerivative(_)
            | Function::CurveInverse(_)
            | Function::CurveIntegral(_)
            | Function::CurveDoubleIntegral(_)
            | Function::CurveBreakpoints(_)
            | Function::CurveStop(_),
            _,
        ) => Dependence::PARAMETERS,
        _ => Dependence::CONSTANT,
    }
}
