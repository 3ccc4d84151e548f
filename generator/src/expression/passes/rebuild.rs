//! Copies the nodes that some roots need into a new graph, one by one. Every pass uses this.
//!
//! Nodes that are not needed are left out, each node can pass the folding constructors again, and sections and names
//! are kept.

use crate::expression::graph::{Expr, Graph};
use crate::expression::liveness::Live;
use crate::expression::node::{Node, NodeId};

/// A graph that replaces another one.
pub struct Rewritten {
    /// The new graph. Its sections have the same indices as before.
    pub graph: Graph,
    /// The roots in the new graph, in the order given.
    pub roots: Vec<NodeId>,
}

/// The live part of the graph, folded once more.
pub fn rebuild(graph: &Graph, roots: &[NodeId]) -> Rewritten {
    let live = Live::new(graph, roots);
    let mut copy = Copier::new(graph, live.nodes().len());
    for &id in live.nodes() {
        copy.fold(id);
    }
    copy.finish(roots)
}

/// One graph with everything that several graphs compute; the roots of each graph follow those of the graph before.
/// Equal operations become one.
pub fn join(parts: &[(&Graph, &[NodeId])]) -> Rewritten {
    let mut joined = Rewritten {
        graph: Graph::new(),
        roots: Vec::new(),
    };
    for &(graph, roots) in parts {
        let mut copy = Copier::onto(joined.graph, graph);
        for &id in Live::new(graph, roots).nodes() {
            copy.keep(id);
        }
        let copied = copy.finish(roots);
        joined.graph = copied.graph;
        joined.roots.extend(copied.roots);
    }
    joined
}

/// A copy in progress. Nodes must be copied in order of creation.
pub(super) struct Copier<'a> {
    old: &'a Graph,
    new: Graph,
    /// For each old node, its new node.
    map: Vec<Option<NodeId>>,
    /// For each old node, whether it has a name.
    named: Vec<bool>,
    section: usize,
    /// For each section of the old graph, its index in the new one.
    sections: Vec<u32>,
}

impl<'a> Copier<'a> {
    /// A copy of about so many nodes.
    pub fn new(old: &'a Graph, nodes: usize) -> Self {
        let sections = old.sections().len();
        Copier {
            named: old.named(),
            sections: (0..sections as u32).collect(),
            map: vec![None; old.len()],
            section: sections - 1,
            old,
            new: Graph::with_sections_of(old, nodes),
        }
    }

    /// A copy into a graph that may already have nodes and sections.
    pub fn onto(new: Graph, old: &'a Graph) -> Self {
        // All sections are created at the start, so that in an empty graph each keeps its index.
        let sections = old.sections();
        let enter = |section: &String| {
            new.section(section.as_str());
            new.current_section()
        };
        let sections: Vec<u32> = sections.iter().map(enter).collect();
        Copier {
            sections,
            named: old.named(),
            map: vec![None; old.len()],
            section: old.sections().len() - 1,
            old,
            new,
        }
    }

    /// The new graph under construction.
    pub fn graph(&self) -> &Graph {
        &self.new
    }

    /// From here on, new nodes belong to the section of this old node.
    pub fn enter_section_of(&mut self, id: NodeId) {
        let section = self.old.section_of(id);
        if section != self.section {
            self.new.enter_section(self.sections[section]);
            self.section = section;
        }
    }

    /// The new node of an old node, if it was copied.
    pub fn get(&self, id: NodeId) -> Option<Expr<'_>> {
        self.map[id.0 as usize].map(|id| self.new.expr(id))
    }

    /// Sets the new node of an old node; the name is copied, too.
    pub fn set(&mut self, id: NodeId, new: NodeId) {
        self.map[id.0 as usize] = Some(new);
        if self.named[id.0 as usize]
            && let Some(name) = self.old.name_of(id)
        {
            self.new.name(self.new.expr(new), name);
        }
    }

    /// Copies a node by the folding constructors. Its operands must have been copied before.
    pub fn fold(&mut self, id: NodeId) {
        self.enter_section_of(id);
        let operand = |id: NodeId| self.new.expr(self.target(id));
        let new = construct(&self.new, self.old.node(id), operand).id();
        self.set(id, new);
    }

    /// Copies a node as it is. Its operands must have been copied before.
    pub fn keep(&mut self, id: NodeId) {
        self.enter_section_of(id);
        let node = self.old.node(id).map_operands(|id| self.target(id));
        let new = self.new.intern(node).id();
        self.set(id, new);
    }

    /// The new graph, with the roots in it.
    pub fn finish(self, roots: &[NodeId]) -> Rewritten {
        let roots = roots.iter().map(|&id| self.target(id)).collect();
        Rewritten {
            graph: self.new,
            roots,
        }
    }

    /// The new node of an old node. Operands and roots of live nodes are live and were copied before their users.
    fn target(&self, id: NodeId) -> NodeId {
        self.map[id.0 as usize].expect("nodes are copied in order of creation")
    }
}

/// The node with other operands, folded.
pub(super) fn construct<'g>(
    graph: &'g Graph,
    node: Node,
    operand: impl Fn(NodeId) -> Expr<'g>,
) -> Expr<'g> {
    match node {
        Node::Constant(_) | Node::Symbol(_) => graph.intern(node),
        Node::Neg(a) => -operand(a),
        Node::Add(a, b) => operand(a) + operand(b),
        Node::Sub(a, b) => operand(a) - operand(b),
        Node::Mul(a, b) => operand(a) * operand(b),
        Node::Div(a, b) => operand(a) / operand(b),
        Node::MulAdd(a, b, c) => mul_add(operand(a), operand(b), operand(c)),
        Node::Sqrt(a) => operand(a).sqrt(),
        Node::Sin(a) => operand(a).sin(),
        Node::Cos(a) => operand(a).cos(),
        Node::Atan2(a, b) => operand(a).atan2(operand(b)),
        Node::Max(a, b) => operand(a).max(operand(b)),
        Node::Min(a, b) => operand(a).min(operand(b)),
        // The packing of a call's operands is kept.
        Node::Call(function, arguments) => {
            graph.intern(Node::Call(function, arguments.map(|id| operand(id).id())))
        }
        Node::Arguments(arguments) => {
            graph.intern(Node::Arguments(arguments.map(|id| operand(id).id())))
        }
    }
}

/// a · b + c with one rounding; folded plain operations if there is only one rounding anyway.
pub(super) fn mul_add<'g>(a: Expr<'g>, b: Expr<'g>, c: Expr<'g>) -> Expr<'g> {
    let trivial = |x: Expr<'g>| x.is_zero() || x.is_one();
    if trivial(a) || trivial(b) || c.is_zero() {
        return a * b + c;
    }
    a.graph().intern(Node::MulAdd(a.id(), b.id(), c.id()))
}
