//! Sums and products with any number of operands, seen through the binary nodes: a + b − (c − d) is the list a, b, −c, d.
//!
//! A sum goes into the list of the sum that uses it, if nothing else uses it; so does a product into a product. What is used
//! more than once is an operand like any other. A sign belongs to the operand, never to a node of its own.
//!
//! A sum of one element does not go into that of another: it is what one passes on to the other, and one value. Its terms would be as many.

use crate::expression::graph::Graph;
use crate::expression::live::Live;
use crate::expression::node::{Node, NodeId};

/// Index of an operand: a node, or, beyond the nodes, a pair found later.
pub(super) type Element = u32;

/// A list of operands with signs.
pub(super) type Signed = Vec<(bool, Element)>;

/// What a live node is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// Not needed, a sign, or part of the list of its only user.
    Within,
    /// Index into the sums.
    Sum(u32),
    /// Index into the products.
    Product(u32),
    /// Index into the products; a term of one sum and nothing else.
    Term(u32),
    /// Anything else.
    Other,
}

/// The lists.
pub(super) struct Flat {
    /// By node.
    pub role: Vec<Role>,
    /// Terms, ordered.
    pub sums: Vec<Signed>,
    /// Factors, ordered, their signs being in `negative`.
    pub products: Vec<Signed>,
    /// By product: true where it is the negative of its factors.
    pub negative: Vec<bool>,
}

/// The node behind the signs of `id`.
pub(super) fn unsigned(nodes: &[Node], id: NodeId) -> (bool, NodeId) {
    let (mut negative, mut id) = (false, id);
    while let Node::Neg(a) = nodes[id.0 as usize] {
        (negative, id) = (!negative, a);
    }
    (negative, id)
}

pub(super) fn flatten(graph: &Graph, live: &Live) -> Flat {
    let nodes = graph.nodes();
    let users = Users::of(&nodes, live);
    let owners = graph.owners();
    let sections = graph.sections();
    let element = |id: NodeId| {
        let section = graph.section_of(id);
        sections[section]
            .starts_with("element ")
            .then(|| owners[section])
    };
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
    // Lists of nodes that are part of a list still to come.
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
                    // The longer list stays where it is: appending it each time would take quadratic time.
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

/// Ordered, and without a and −a.
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

/// Who uses each node, signs being looked through.
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

    /// The only user, if there is one and it is a node.
    fn only(&self, id: NodeId) -> Option<NodeId> {
        match self.count[id.0 as usize] {
            1 => self.last[id.0 as usize],
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::Symbol;

    #[test]
    fn sums_are_lists_with_signs() {
        let graph = Graph::new();
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let product = a * d;
        let total = a + b - (c - d) - product;
        let flat = flatten(&graph, &Live::new(&graph, &[total.id()]));
        let base = unsigned(&graph.nodes(), total.id()).1;
        assert!(matches!(flat.role[base.0 as usize], Role::Sum(0)));
        assert_eq!(flat.role[product.id().0 as usize], Role::Term(0));
        let expected = [
            (false, a),
            (false, b),
            (true, c),
            (false, d),
            (true, product),
        ];
        let flipped = unsigned(&graph.nodes(), total.id()).0;
        let expected: Signed = expected.map(|(sign, e)| (sign ^ flipped, e.id().0)).into();
        assert_eq!(flat.sums, [expected]);
    }

    #[test]
    fn what_is_shared_is_an_operand() {
        let graph = Graph::new();
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let shared = a * b;
        let (left, right) = (shared * c, shared * d);
        let flat = flatten(&graph, &Live::new(&graph, &[left.id(), right.id()]));
        let list = |x: [NodeId; 2]| Signed::from([(false, x[0].0), (false, x[1].0)]);
        assert_eq!(
            flat.products,
            [
                list([a.id(), b.id()]),
                list([c.id(), shared.id()]),
                list([d.id(), shared.id()])
            ]
        );
    }
}
