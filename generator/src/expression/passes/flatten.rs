//! Sums and products with any number of operands, read from the binary nodes: a + b − (c − d) is the list a, b, −c, d.
//!
//! A sum with a single user that is a sum, too, becomes part of the list of that sum. The same holds for products. A
//! node that is used more than once is an operand like any other. A sign belongs to the operand and is never a node of
//! its own.
//!
//! A sum of one element does not become part of a sum of another element: it is a single value that one element passes
//! to the other, while its terms would be many.

use crate::expression::graph::Graph;
use crate::expression::liveness::Live;
use crate::expression::node::{Node, NodeId};

/// Index of an operand: a node or, from the number of nodes on, a pair that was found later.
pub type Element = u32;

/// A list of operands with signs.
pub type Signed = Vec<(bool, Element)>;

/// The role of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Not live, or a sign, or a member of the list of its only user.
    Within,
    /// A sum: its index in `sums`.
    Sum(u32),
    /// A product: its index in `products`.
    Product(u32),
    /// A product that is a term of one sum and nothing else: its index in `products`.
    Term(u32),
    /// Anything else.
    Other,
}

/// The lists of sums and products.
pub struct Flat {
    /// The role of each node.
    pub role: Vec<Role>,
    /// Terms, ordered.
    pub sums: Vec<Signed>,
    /// Factors, ordered. The sign of the product is in `negative`.
    pub products: Vec<Signed>,
    /// For each product, true if it is the negative of its factors.
    pub negative: Vec<bool>,
}

/// The node without its signs, and whether the sign is negative.
pub fn unsigned(nodes: &[Node], id: NodeId) -> (bool, NodeId) {
    let (mut negative, mut id) = (false, id);
    while let Node::Neg(a) = nodes[id.0 as usize] {
        (negative, id) = (!negative, a);
    }
    (negative, id)
}

/// The sums and products of the nodes that are live.
// Long: one pass over the nodes, whose steps share the lists that are open.
pub fn flatten(graph: &Graph, live: &Live) -> Flat {
    let nodes = graph.nodes();
    let users = Users::of(&nodes, live);
    let owners = graph.owners();
    let sections = graph.sections();
    let sections = owners.iter().zip(&*sections);
    let elements = sections.map(|(owner, name)| name.starts_with("element ").then_some(*owner));
    let elements: Vec<Option<usize>> = elements.collect();
    let element = |id: NodeId| elements[graph.section_of(id)];
    let passed_on = |id: NodeId, user: NodeId| {
        let sums = is_sum(&nodes[user.0 as usize]) && is_sum(&nodes[id.0 as usize]);
        let of = element(id).zip(element(user));
        sums && of.is_some_and(|(own, other)| own != other)
    };
    let mut flat = Flat {
        role: vec![Role::Within; nodes.len()],
        sums: Vec::new(),
        products: Vec::new(),
        negative: Vec::new(),
    };
    // Lists that will become part of the list of a later node.
    let mut open: Vec<Signed> = vec![Vec::new(); nodes.len()];
    for &id in live.nodes() {
        let at = id.0 as usize;
        let node = nodes[at];
        let user = users.only(id).filter(|&user| !passed_on(id, user));
        let user = user.map(|user| nodes[user.0 as usize]);
        let operands = |minus_second: bool| {
            let operands = node.operands().enumerate();
            operands.map(move |(i, a)| (minus_second && i == 1, a))
        };
        let mut list = |minus_second: bool, same: fn(&Node) -> bool| {
            let mut list = Signed::new();
            for (minus, operand) in operands(minus_second) {
                let (sign, base) = unsigned(&nodes, operand);
                let negative = minus != sign;
                let joins = users.only(base) == Some(id) && !passed_on(base, id);
                if same(&nodes[base.0 as usize]) && joins {
                    let mut inner = std::mem::take(&mut open[base.0 as usize]);
                    for (sign, _) in &mut inner {
                        *sign ^= negative;
                    }
                    // The shorter list is appended to the longer one; otherwise the time would be quadratic.
                    if inner.len() > list.len() {
                        std::mem::swap(&mut inner, &mut list);
                    }
                    list.append(&mut inner);
                } else {
                    list.push((negative, base.0));
                }
            }
            list
        };
        flat.role[at] = match node {
            Node::Neg(_) => Role::Within,
            Node::Add(..) | Node::Sub(..) => {
                let terms = list(matches!(node, Node::Sub(..)), is_sum);
                if user.as_ref().is_some_and(is_sum) {
                    open[at] = terms;
                    Role::Within
                } else {
                    flat.sums.push(without_opposites(terms));
                    Role::Sum(flat.sums.len() as u32 - 1)
                }
            }
            Node::Mul(..) => {
                let factors = list(false, is_product);
                if user.as_ref().is_some_and(is_product) {
                    open[at] = factors;
                    Role::Within
                } else {
                    flat.push_product(factors);
                    let index = flat.products.len() as u32 - 1;
                    match user.as_ref().is_some_and(is_sum) {
                        true => Role::Term(index),
                        false => Role::Product(index),
                    }
                }
            }
            _ => Role::Other,
        };
    }
    flat
}

impl Flat {
    fn push_product(&mut self, mut factors: Signed) {
        let negative = factors.iter().fold(false, |sign, (s, _)| sign ^ s);
        for (sign, _) in &mut factors {
            *sign = false;
        }
        factors.sort_unstable_by_key(|&(_, factor)| factor);
        self.products.push(factors);
        self.negative.push(negative);
    }
}

fn is_sum(node: &Node) -> bool {
    matches!(node, Node::Add(..) | Node::Sub(..))
}

fn is_product(node: &Node) -> bool {
    matches!(node, Node::Mul(..))
}

/// The terms in order, without pairs of opposite terms a and −a.
fn without_opposites(mut terms: Signed) -> Signed {
    terms.sort_unstable_by_key(|&(sign, term)| (term, sign));
    let mut kept = Signed::with_capacity(terms.len());
    for (sign, term) in terms {
        match kept.last() {
            Some(&(other, same)) if same == term && other != sign => {
                kept.pop();
            }
            _ => kept.push((sign, term)),
        }
    }
    kept
}

/// The users of each node. Signs are skipped: a user of −a counts as a user of a.
struct Users {
    count: Vec<u32>,
    last: Vec<Option<NodeId>>,
}

impl Users {
    fn of(nodes: &[Node], live: &Live) -> Self {
        let mut users = Users {
            count: vec![0; nodes.len()],
            last: vec![None; nodes.len()],
        };
        for &id in live.nodes() {
            let node = nodes[id.0 as usize];
            if !matches!(node, Node::Neg(_)) {
                for operand in node.operands() {
                    users.add(nodes, operand, Some(id));
                }
            }
        }
        for &root in live.roots() {
            users.add(nodes, root, None);
        }
        users
    }

    fn add(&mut self, nodes: &[Node], operand: NodeId, user: Option<NodeId>) {
        let base = unsigned(nodes, operand).1.0 as usize;
        self.count[base] += 1;
        self.last[base] = user;
    }

    /// The only user, if there is exactly one and it is a node.
    fn only(&self, id: NodeId) -> Option<NodeId> {
        match self.count[id.0 as usize] {
            1 => self.last[id.0 as usize],
            _ => None,
        }
    }
}
