//! The graph of expressions. Its constructors fold: `x + 0 = x`, `x · 1 = x`, `b − a = −(a − b)`,
//! `(−a) · b = −(a · b)`, and so on.
//!
//! Two rules make common subexpressions coincide up to sign, so that sharing needs no pass of its own. First, the
//! operands of a node are never negated where the negation can move outwards (products, quotients, sums of two
//! negatives). Second, of `a − b` and `b − a` only the one whose first operand is older exists; the other is its
//! negation. For the same reason constants in products are positive.
//!
//! Operands of a node are older than the node, so the order of creation is a topological order. Nothing else decides
//! this order, so the same model gives the same graph on every run and every machine.

use super::node::{Function, Node, NodeId, Symbol};
use rustc_hash::{FxHashMap, FxHasher};
use std::cell::{Ref, RefCell};
use std::hash::{Hash, Hasher};
use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::Arc;

/// The graph. Nodes are only added, unless all are cleared. It is cheap to share by reference.
#[derive(Clone, Default)]
pub struct Graph {
    inner: RefCell<Inner>,
}

#[derive(Clone, Default)]
struct Inner {
    nodes: Vec<Node>,
    index: Index,
    /// The section that created each node.
    section_of: Vec<u32>,
    /// Shared by all graphs that passes derive from this one.
    sections: Arc<Sections>,
    current: u32,
    names: FxHashMap<NodeId, String>,
}

/// The names of sections, and the index of each name.
#[derive(Clone, Default)]
struct Sections {
    names: Vec<String>,
    places: FxHashMap<String, u32>,
}

/// Finds equal nodes: a hash table with open addressing. A slot has the index of a node plus 1, or 0 if it is free. The
/// length is a power of two, and at most half of the slots are in use. The nodes themselves are stored in the graph
/// alone.
#[derive(Clone, Default)]
struct Index {
    slots: Vec<u32>,
    used: usize,
}

impl Index {
    /// Length of the smallest table.
    const SMALLEST: usize = 256;

    /// The index of an equal node, or the free slot for a new one. The table must have a free slot.
    #[inline]
    fn find(&self, nodes: &[Node], node: &Node) -> Result<NodeId, usize> {
        let mask = self.slots.len() - 1;
        let mut at = hash(node) & mask;
        loop {
            match self.slots[at] {
                0 => return Err(at),
                number if nodes[number as usize - 1] == *node => return Ok(NodeId(number - 1)),
                _ => at = (at + 1) & mask,
            }
        }
    }

    /// Makes room for one more node.
    #[inline]
    fn reserve(&mut self, nodes: &[Node]) {
        if 2 * (self.used + 1) > self.slots.len() {
            self.grow(nodes);
        }
    }

    fn grow(&mut self, nodes: &[Node]) {
        self.lengthen((2 * self.slots.len()).max(Self::SMALLEST), nodes);
    }

    fn lengthen(&mut self, length: usize, nodes: &[Node]) {
        let before = std::mem::replace(&mut self.slots, vec![0; length]);
        for number in before.into_iter().filter(|number| *number != 0) {
            let mut at = hash(&nodes[number as usize - 1]) & (length - 1);
            while self.slots[at] != 0 {
                at = (at + 1) & (length - 1);
            }
            self.slots[at] = number;
        }
    }

    /// Forgets all nodes. A table much longer than these nodes needed is shortened, so that clearing it again takes
    /// less time.
    fn clear(&mut self) {
        let needed = (8 * self.used).next_power_of_two().max(Self::SMALLEST);
        self.slots.truncate(needed);
        self.slots.fill(0);
        self.used = 0;
    }
}

/// A hash whose low bits depend on the whole node.
#[inline]
fn hash(node: &Node) -> usize {
    // 2⁶⁴ over the golden ratio
    const SPREAD: u64 = 0x9e37_79b9_7f4a_7c15;
    let mixed = |kind: u64, value: u64| {
        let product = (value ^ kind << 58).wrapping_mul(SPREAD);
        ((product ^ product >> 32).wrapping_mul(SPREAD) >> 32) as usize
    };
    let two = |kind, a: &NodeId, b: &NodeId| mixed(kind, u64::from(a.0) | u64::from(b.0) << 32);
    match node {
        Node::Constant(bits) => mixed(1, *bits),
        Node::Neg(a) => two(2, a, a),
        Node::Add(a, b) => two(3, a, b),
        Node::Sub(a, b) => two(4, a, b),
        Node::Mul(a, b) => two(5, a, b),
        Node::Div(a, b) => two(6, a, b),
        Node::Sin(a) => two(8, a, a),
        Node::Cos(a) => two(9, a, a),
        Node::Symbol(Symbol::Coordinate(i)) => mixed(10, u64::from(*i)),
        Node::Symbol(Symbol::Parameter(i)) => mixed(11, u64::from(*i)),
        other => {
            let mut hasher = FxHasher::default();
            other.hash(&mut hasher);
            mixed(7, hasher.finish())
        }
    }
}

impl Inner {
    fn push(&mut self, node: Node) -> NodeId {
        self.nodes.push(node);
        self.section_of.push(self.current);
        NodeId(self.nodes.len() as u32 - 1)
    }
}

/// The owner of a section, i.e. an element or a system: the words before the colon.
pub fn owner(section: &str) -> &str {
    section.split(": ").next().unwrap_or(section)
}

/// A value in the graph. Its operators create nodes and fold.
#[derive(Clone, Copy)]
pub struct Expr<'g> {
    graph: &'g Graph,
    id: NodeId,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        let graph = Self::default();
        graph.section("");
        graph
    }

    /// From here on, new nodes belong to the section with this name ("element head: orientation"). A section is a block
    /// of the emitted text with its name as a comment, and a row of the operation count.
    pub fn section(&self, name: impl Into<String>) {
        let name = name.into();
        let mut inner = self.inner.borrow_mut();
        let known = inner.sections.places.get(&name).copied();
        inner.current = known.unwrap_or_else(|| {
            let sections = Arc::make_mut(&mut inner.sections);
            let place = sections.names.len() as u32;
            sections.names.push(name.clone());
            sections.places.insert(name, place);
            place
        });
    }

    /// An empty graph with the sections of another one, and with room for so many nodes.
    pub(crate) fn with_sections_of(other: &Graph, nodes: usize) -> Self {
        let sections = other.inner.borrow().sections.clone();
        let current = sections.names.len().saturating_sub(1) as u32;
        let mut inner = Inner {
            sections,
            current,
            nodes: Vec::with_capacity(nodes),
            section_of: Vec::with_capacity(nodes),
            ..Inner::default()
        };
        let slots = (2 * nodes + 2).next_power_of_two().max(Index::SMALLEST);
        inner.index.lengthen(slots, &[]);
        Graph {
            inner: RefCell::new(inner),
        }
    }

    /// Index of the section that new nodes belong to.
    pub(crate) fn current_section(&self) -> u32 {
        self.inner.borrow().current
    }

    /// From here on, new nodes belong to the section with this index.
    pub(crate) fn enter_section(&self, index: u32) {
        self.inner.borrow_mut().current = index;
    }

    /// All sections, by index.
    pub fn sections(&self) -> Ref<'_, [String]> {
        Ref::map(self.inner.borrow(), |i| i.sections.names.as_slice())
    }

    /// Index of the section that created a node.
    pub fn section_of(&self, id: NodeId) -> usize {
        self.inner.borrow().section_of[id.0 as usize] as usize
    }

    /// For each section, its owner: the first of the sections with the same words before the colon. Sections of one
    /// element have the same owner.
    pub fn owners(&self) -> Vec<usize> {
        let sections = self.sections();
        let mut first: FxHashMap<&str, usize> = FxHashMap::default();
        let owners = sections.iter().enumerate();
        let owners = owners.map(|(at, section)| *first.entry(owner(section)).or_insert(at));
        owners.collect()
    }

    /// Gives a node a name for the reader, an identifier. A node keeps its first name. Constants and inputs get none.
    ///
    /// A negative gets no name; its operand gets the name `minus_…` instead. If p is older than r, `r - p` is the
    /// negative −(p − r), and the definition `w = p - r` in the text would be wrong.
    pub fn name(&self, expr: Expr<'_>, name: impl Into<String>) {
        let mut inner = self.inner.borrow_mut();
        let mut name = name.into();
        let id = match inner.nodes[expr.id.0 as usize] {
            Node::Neg(a) => {
                name = opposite_name(&name);
                a
            }
            _ => expr.id,
        };
        if !inner.nodes[id.0 as usize].is_leaf() {
            inner.names.entry(id).or_insert(name);
        }
    }

    /// The name of a node, if it has one.
    pub fn name_of(&self, id: NodeId) -> Option<String> {
        self.inner.borrow().names.get(&id).cloned()
    }

    /// For each node, whether it has a name.
    pub(crate) fn named(&self) -> Vec<bool> {
        let inner = self.inner.borrow();
        let mut named = vec![false; inner.nodes.len()];
        for id in inner.names.keys() {
            named[id.0 as usize] = true;
        }
        named
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.inner.borrow().nodes.len()
    }

    /// Removes all nodes and their names, but keeps the memory. Expressions made before must not be used any more.
    pub(crate) fn clear(&self) {
        let mut inner = self.inner.borrow_mut();
        inner.nodes.clear();
        inner.index.clear();
        inner.section_of.clear();
        inner.names.clear();
    }

    /// True if there is no node.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The node at an index.
    #[inline]
    pub fn node(&self, id: NodeId) -> Node {
        self.inner.borrow().nodes[id.0 as usize]
    }

    /// The nodes of the two operands of an operation.
    #[inline]
    fn operands(&self, a: Expr<'_>, b: Expr<'_>) -> (Node, Node) {
        let inner = self.inner.borrow();
        (inner.nodes[a.id.0 as usize], inner.nodes[b.id.0 as usize])
    }

    /// All nodes, operands before their users.
    pub fn nodes(&self) -> Ref<'_, [Node]> {
        Ref::map(self.inner.borrow(), |i| i.nodes.as_slice())
    }

    /// The value of a node as an expression.
    #[inline]
    pub fn expr(&self, id: NodeId) -> Expr<'_> {
        Expr { graph: self, id }
    }

    /// The node of a number.
    #[inline]
    pub fn constant(&self, value: f64) -> Expr<'_> {
        // Adding zero turns −0 into 0: a product with zero must not depend on the sign.
        self.intern(Node::Constant((value + 0.0).to_bits()))
    }

    /// The node of an input.
    pub fn symbol(&self, symbol: Symbol) -> Expr<'_> {
        self.intern(Node::Symbol(symbol))
    }

    /// A call of a function with [`Function::arity`] arguments.
    ///
    /// # Panics
    /// If the number of arguments is wrong, which is an error of the caller and not of a model.
    pub fn call<'g>(&'g self, function: Function, arguments: &[Expr<'g>]) -> Expr<'g> {
        assert_eq!(
            arguments.len(),
            function.arity(),
            "arguments of {function:?}"
        );
        let ids = self.grouped(arguments.iter().map(|argument| argument.id).collect());
        self.intern(Node::Call(function, ids))
    }

    /// Packs arguments into three operands. If there are more than three, they go into lists, three to a list, filled
    /// from the left.
    fn grouped(&self, mut ids: Vec<NodeId>) -> [NodeId; 3] {
        while ids.len() > 3 {
            let lists = ids.chunks(3).map(|chunk| {
                let at = |i: usize| chunk[i.min(chunk.len() - 1)];
                match chunk.len() {
                    1 => chunk[0],
                    _ => self.intern(Node::Arguments([at(0), at(1), at(2)])).id,
                }
            });
            ids = lists.collect();
        }
        let first = ids[0];
        std::array::from_fn(|i| ids.get(i).copied().unwrap_or(first))
    }

    /// The arguments of a call, in order; empty for any other node.
    pub fn arguments(&self, id: NodeId) -> Vec<NodeId> {
        let nodes = self.nodes();
        match nodes[id.0 as usize] {
            Node::Call(function, operands) => {
                let mut found = Vec::with_capacity(function.arity());
                flatten(
                    function.arity(),
                    operands,
                    &|id| nodes[id.0 as usize],
                    &mut found,
                );
                found
            }
            _ => Vec::new(),
        }
    }

    /// The node as it is, without folding; an equal node is reused. For passes that rewrite a graph.
    #[inline]
    pub fn intern(&self, node: Node) -> Expr<'_> {
        let mut inner = self.inner.borrow_mut();
        let Inner { nodes, index, .. } = &mut *inner;
        index.reserve(nodes);
        let id = match index.find(nodes, &node) {
            Ok(id) => id,
            Err(slot) => {
                let id = inner.push(node);
                inner.index.slots[slot] = id.0 + 1;
                inner.index.used += 1;
                id
            }
        };
        Expr { graph: self, id }
    }

    #[inline]
    fn binary(&self, make: fn(NodeId, NodeId) -> Node, a: Expr<'_>, b: Expr<'_>) -> Expr<'_> {
        self.intern(make(a.id.min(b.id), a.id.max(b.id)))
    }
}

/// The arguments of a call with this arity, in order, from its operands: reverses the packing into lists.
pub(crate) fn flatten(
    arity: usize,
    operands: [NodeId; 3],
    node: &impl Fn(NodeId) -> Node,
    into: &mut Vec<NodeId>,
) {
    // each list of one level holds `size` arguments, except the last list
    let mut size = 1;
    while 3 * size < arity {
        size *= 3;
    }
    let mut left = arity;
    for operand in operands {
        if left == 0 {
            return;
        }
        let count = left.min(size);
        left -= count;
        match (count, node(operand)) {
            (2.., Node::Arguments(inner)) => flatten(count, inner, node, into),
            _ => into.push(operand),
        }
    }
}

impl<'g> Expr<'g> {
    /// Index of the node in its graph.
    pub fn id(self) -> NodeId {
        self.id
    }

    /// The graph it belongs to.
    pub fn graph(self) -> &'g Graph {
        self.graph
    }

    /// The operation or input at this node.
    #[inline]
    pub fn node(self) -> Node {
        self.graph.node(self.id)
    }

    /// The value if the node is a constant.
    #[inline]
    pub fn as_constant(self) -> Option<f64> {
        match self.node() {
            Node::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// True for the number 0.
    #[inline]
    pub fn is_zero(self) -> bool {
        self.as_constant() == Some(0.0)
    }

    /// True for the number 1.
    #[inline]
    pub fn is_one(self) -> bool {
        self.as_constant() == Some(1.0)
    }

    #[inline]
    fn negated(self) -> Option<Expr<'g>> {
        match self.node() {
            Node::Neg(a) => Some(self.graph.expr(a)),
            _ => None,
        }
    }

    /// Splits `c · x` with a constant c into (c, x); `node` is the node of this expression.
    #[inline]
    fn scaled(self, node: Node) -> (f64, Expr<'g>) {
        if let Node::Mul(a, b) = node {
            let (a, b) = (self.graph.expr(a), self.graph.expr(b));
            // The constant may be either operand, because operands are ordered by age.
            match self.graph.operands(a, b) {
                (Node::Constant(c), _) => return (f64::from_bits(c), b),
                (_, Node::Constant(c)) => return (f64::from_bits(c), a),
                _ => {}
            }
        }
        (1.0, self)
    }

    /// √x
    pub fn sqrt(self) -> Expr<'g> {
        match self.as_constant() {
            Some(c) => self.graph.constant(c.sqrt()),
            None => self.graph.intern(Node::Sqrt(self.id)),
        }
    }

    /// sin x
    pub fn sin(self) -> Expr<'g> {
        match (self.as_constant(), self.negated()) {
            (Some(c), _) => self.graph.constant(libm::sin(c)),
            (_, Some(a)) => -a.sin(),
            _ => self.graph.intern(Node::Sin(self.id)),
        }
    }

    /// cos x
    pub fn cos(self) -> Expr<'g> {
        match (self.as_constant(), self.negated()) {
            (Some(c), _) => self.graph.constant(libm::cos(c)),
            (_, Some(a)) => a.cos(),
            _ => self.graph.intern(Node::Cos(self.id)),
        }
    }

    /// Angle of the point (`x`, `self`) \[rad\].
    pub fn atan2(self, x: Expr<'g>) -> Expr<'g> {
        match (self.as_constant(), x.as_constant()) {
            (Some(a), Some(b)) => self.graph.constant(libm::atan2(a, b)),
            _ => self.graph.intern(Node::Atan2(self.id, x.id)),
        }
    }

    /// The larger of the two.
    pub fn max(self, other: Expr<'g>) -> Expr<'g> {
        match (self.as_constant(), other.as_constant()) {
            (Some(a), Some(b)) => self.graph.constant(a.max(b)),
            _ if self.id == other.id => self,
            // this order of operands is kept, because the maximum of the runtime passes on a NaN of its first operand
            _ => self.graph.intern(Node::Max(self.id, other.id)),
        }
    }

    /// The smaller of the two.
    pub fn min(self, other: Expr<'g>) -> Expr<'g> {
        match (self.as_constant(), other.as_constant()) {
            (Some(a), Some(b)) => self.graph.constant(a.min(b)),
            _ if self.id == other.id => self,
            _ => self.graph.intern(Node::Min(self.id, other.id)),
        }
    }

    /// x²
    pub fn squared(self) -> Expr<'g> {
        self * self
    }

    /// 1/x
    pub fn recip(self) -> Expr<'g> {
        self.graph.constant(1.0) / self
    }
}

impl<'g> Neg for Expr<'g> {
    type Output = Expr<'g>;
    fn neg(self) -> Expr<'g> {
        match self.node() {
            Node::Constant(bits) => self.graph.constant(-f64::from_bits(bits)),
            Node::Neg(a) => self.graph.expr(a),
            _ => self.graph.intern(Node::Neg(self.id)),
        }
    }
}

/// The bits of the numbers 0 and 1; −0 occurs in no graph.
const ZERO: u64 = 0;
const ONE: u64 = 1.0_f64.to_bits();

impl<'g> Add for Expr<'g> {
    type Output = Expr<'g>;
    fn add(self, other: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        let (first, second) = graph.operands(self, other);
        match (first, second) {
            (Node::Constant(ZERO), _) => return other,
            (_, Node::Constant(ZERO)) => return self,
            (Node::Constant(a), Node::Constant(b)) => {
                return graph.constant(f64::from_bits(a) + f64::from_bits(b));
            }
            (Node::Neg(a), Node::Neg(b)) => return -(graph.expr(a) + graph.expr(b)),
            (Node::Neg(a), _) => return other - graph.expr(a),
            (_, Node::Neg(b)) => return self - graph.expr(b),
            _ => {}
        }
        let ((c, x), (d, y)) = (self.scaled(first), other.scaled(second));
        if x.id == y.id {
            return graph.constant(c + d) * x;
        }
        graph.binary(Node::Add, self, other)
    }
}

impl<'g> Sub for Expr<'g> {
    type Output = Expr<'g>;
    fn sub(self, other: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        if self.id == other.id {
            return graph.constant(0.0);
        }
        let (first, second) = graph.operands(self, other);
        match (first, second) {
            (_, Node::Constant(ZERO)) => return self,
            (Node::Constant(ZERO), _) => return -other,
            (Node::Constant(a), Node::Constant(b)) => {
                return graph.constant(f64::from_bits(a) - f64::from_bits(b));
            }
            (Node::Neg(a), Node::Neg(b)) => return graph.expr(b) - graph.expr(a),
            (Node::Neg(a), _) => return -(graph.expr(a) + other),
            (_, Node::Neg(b)) => return self + graph.expr(b),
            _ => {}
        }
        let ((c, x), (d, y)) = (self.scaled(first), other.scaled(second));
        if x.id == y.id {
            return graph.constant(c - d) * x;
        }
        if self.id < other.id {
            graph.intern(Node::Sub(self.id, other.id))
        } else {
            -graph.intern(Node::Sub(other.id, self.id))
        }
    }
}

impl<'g> Mul for Expr<'g> {
    type Output = Expr<'g>;
    fn mul(self, other: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        let (first, second) = graph.operands(self, other);
        match (first, second) {
            (Node::Constant(ZERO), _) | (_, Node::Constant(ONE)) => self,
            (_, Node::Constant(ZERO)) | (Node::Constant(ONE), _) => other,
            (Node::Constant(a), Node::Constant(b)) => {
                graph.constant(f64::from_bits(a) * f64::from_bits(b))
            }
            (Node::Constant(c), _) => other.times_number(second, f64::from_bits(c), self),
            (_, Node::Constant(c)) => self.times_number(first, f64::from_bits(c), other),
            (Node::Neg(a), Node::Neg(b)) => graph.expr(a) * graph.expr(b),
            (Node::Neg(a), _) => -(graph.expr(a) * other),
            (_, Node::Neg(b)) => -(self * graph.expr(b)),
            _ => graph.binary(Node::Mul, self, other),
        }
    }
}

impl<'g> Expr<'g> {
    /// The product of this expression, which is not a constant, and a constant c other than 0 and 1. `node` is the node
    /// of this expression, `number` that of c.
    fn times_number(self, node: Node, c: f64, number: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        if c < 0.0 {
            return -(graph.constant(-c) * self);
        }
        let (d, x) = self.scaled(node);
        if d != 1.0 {
            return graph.constant(c * d) * x;
        }
        match node {
            Node::Neg(a) => -(number * graph.expr(a)),
            _ => graph.binary(Node::Mul, number, self),
        }
    }
}

impl<'g> Div for Expr<'g> {
    type Output = Expr<'g>;
    fn div(self, other: Expr<'g>) -> Expr<'g> {
        let graph = self.graph;
        match graph.operands(self, other) {
            (Node::Constant(ZERO), _) | (_, Node::Constant(ONE)) => self,
            (Node::Constant(a), Node::Constant(c)) => {
                graph.constant(f64::from_bits(a) / f64::from_bits(c))
            }
            (_, Node::Constant(c)) => self * graph.constant(1.0 / f64::from_bits(c)),
            (Node::Neg(a), Node::Neg(b)) => graph.expr(a) / graph.expr(b),
            (Node::Neg(a), _) => -(graph.expr(a) / other),
            (_, Node::Neg(b)) => -(self / graph.expr(b)),
            (Node::Constant(c), _) if f64::from_bits(c) < 0.0 => {
                -(graph.constant(-f64::from_bits(c)) / other)
            }
            _ => graph.intern(Node::Div(self.id, other.id)),
        }
    }
}

impl<'g> Mul<Expr<'g>> for f64 {
    type Output = Expr<'g>;
    fn mul(self, other: Expr<'g>) -> Expr<'g> {
        other.graph.constant(self) * other
    }
}

/// The name of the negative of a value with this name.
pub(crate) fn opposite_name(name: &str) -> String {
    match name.strip_prefix("minus_") {
        Some(positive) => positive.to_string(),
        None => format!("minus_{name}"),
    }
}

/// The sum of several expressions, added from the left; the number 0 if there are none.
pub fn sum<'g>(graph: &'g Graph, terms: impl IntoIterator<Item = Expr<'g>>) -> Expr<'g> {
    terms.into_iter().fold(graph.constant(0.0), |a, b| a + b)
}

impl std::fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{}", self.id.0)
    }
}

/// `then` if a < b, otherwise `otherwise`. Both are always computed. If derivatives are wanted, neither may be infinite
/// or NaN even where it is not chosen.
pub fn choose<'g>(a: Expr<'g>, b: Expr<'g>, then: Expr<'g>, otherwise: Expr<'g>) -> Expr<'g> {
    match (a.as_constant(), b.as_constant()) {
        (Some(a), Some(b)) if a < b => then,
        (Some(_), Some(_)) => otherwise,
        _ if then.id() == otherwise.id() => then,
        _ => a.graph().call(Function::Choose, &[a, b, then, otherwise]),
    }
}
