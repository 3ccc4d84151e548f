//! Reduces operations without changing values: a·x + b·x = (a + b)·x and c·(d·x) = (c d)·x; common pairs of operands of
//! sums and products are computed once; a/d and b/d share one reciprocal.
//!
//! Sums and products are taken apart into lists (`flatten`). Parts that several lists have in common are shared
//! (`pairs`). Then the lists are put together again, with common factors outside. This is repeated until nothing is
//! gained. A node is taken apart only if it has a single user, so no value is computed twice that was computed once.
//! Operands that depend on parameters alone come first in a list, so that they form one part, which is computed once
//! per simulation. The others are ordered by age: an operand that is computed late is added last, so that the sum does
//! not wait for it.
//!
//! Values change only by rounding, as those of a + b + c do with the order. One reciprocal and k products replace k
//! quotients: one operation more, but a quotient takes as long as [`QUOTIENT`] products.

use super::flatten::{Element, Flat, Role, Signed, flatten, unsigned};
use super::pairs::{Pair, extract_pairs};
use super::rebuild::{Copier, Rewritten, construct, rebuild};
use crate::expression::count::Count;
use crate::expression::graph::{Expr, Graph};
use crate::expression::liveness::{Dependence, Live};
use crate::expression::node::{Node, NodeId};

/// Number of products that take as long as one quotient.
pub const QUOTIENT: usize = 4;

/// Largest number of rounds. Each takes time linear in the number of nodes; later ones seldom gain anything.
const ROUNDS: usize = 6;

/// The same roots with fewer operations.
pub fn factor(graph: &Graph, roots: &[NodeId]) -> Rewritten {
    let mut best = rebuild(graph, roots);
    let mut live = Live::new(&best.graph, &best.roots);
    let mut least = costs(&best.graph, &live);
    for _ in 0..ROUNDS {
        let next = round(&best.graph, &live);
        let next_live = Live::new(&next.graph, &next.roots);
        let now = costs(&next.graph, &next_live);
        if now >= least {
            break;
        }
        (best, live, least) = (next, next_live, now);
    }
    best
}

/// The cost that the pass reduces: operations, each quotient counted as [`QUOTIENT`].
pub fn cost(count: &Count) -> usize {
    count.total() + (QUOTIENT - 1) * count.div
}

/// The cost of nodes that depend on more than parameters, then the cost of all nodes.
fn costs(graph: &Graph, live: &Live) -> (usize, usize) {
    let nodes = graph.nodes();
    let [mut at_every_state, mut once] = [Count::default(), Count::default()];
    for &id in live.nodes() {
        let count = match live.dependence(id).within(Dependence::PARAMETERS) {
            true => &mut once,
            false => &mut at_every_state,
        };
        count.record(&nodes[id.0 as usize]);
    }
    let (at_every_state, once) = (cost(&at_every_state), cost(&once));
    (at_every_state, at_every_state + once)
}

fn round(graph: &Graph, live: &Live) -> Rewritten {
    let mut flat = flatten(graph, live);
    let mut lists = Lists::new(graph, live);
    lists.add(extract_pairs(&mut flat.products, lists.next()), true);
    lists.add(extract_pairs(&mut flat.sums, lists.next()), false);
    let divisions = divisions(graph, live);
    let nodes = graph.nodes();

    let mut copy = Copier::new(graph, live.nodes().len());
    let mut factors = Vec::new();
    for &id in live.nodes() {
        let at = id.0 as usize;
        let node = nodes[at];
        copy.enter_section_of(id);
        let new = match flat.role[at] {
            Role::Term(_) => continue,
            // A list stores the signs of its members.
            Role::Within => match node {
                Node::Neg(a) => match copy.get(a) {
                    Some(a) => (-a).id(),
                    None => continue,
                },
                _ => continue,
            },
            Role::Product(index) => {
                lists.make(&copy, &flat.products[index as usize]);
                factors.clear();
                factors.extend(flat.products[index as usize].iter().map(|f| f.1));
                let product = lists.product(&copy, &mut factors);
                signed(product, flat.negative[index as usize]).id()
            }
            Role::Sum(index) => {
                let terms = lists.terms(&copy, &flat, &flat.sums[index as usize]);
                lists.sum(&copy, terms).id()
            }
            Role::Other => {
                let operand = |id| copied(&copy, id);
                match node {
                    Node::Div(a, b) if divisions[unsigned(&nodes, b).1.0 as usize] > 1 => {
                        (operand(a) * operand(b).recip()).id()
                    }
                    _ => construct(copy.graph(), node, operand).id(),
                }
            }
        };
        copy.set(id, new);
    }
    copy.finish(live.roots())
}

/// For each node, the number of quotients with the node or its negative as the denominator.
fn divisions(graph: &Graph, live: &Live) -> Vec<u32> {
    let nodes = graph.nodes();
    let mut divisions = vec![0; nodes.len()];
    for &id in live.nodes() {
        if let Node::Div(_, b) = nodes[id.0 as usize] {
            divisions[unsigned(&nodes, b).1.0 as usize] += 1;
        }
    }
    divisions
}

/// The copy of an operand that is not a member of a list. Operands are older than their users, so it exists already.
fn copied<'c>(copy: &'c Copier<'_>, id: NodeId) -> Expr<'c> {
    copy.get(id)
        .expect("operands are copied before their users")
}

fn signed(value: Expr<'_>, negative: bool) -> Expr<'_> {
    if negative { -value } else { value }
}

/// A term of a sum: a product that only this sum uses, or a single operand.
struct Term {
    negative: bool,
    factors: Factors,
}

/// Factors of a term; most terms have one, and need no memory of their own.
enum Factors {
    One([Element; 1]),
    Several(Vec<Element>),
}

impl Factors {
    fn get(&self) -> &[Element] {
        match self {
            Factors::One(one) => one,
            Factors::Several(several) => several,
        }
    }

    fn get_mut(&mut self) -> &mut [Element] {
        match self {
            Factors::One(one) => one,
            Factors::Several(several) => several,
        }
    }

    fn remove(&mut self, factor: Element) {
        if let Some(at) = self.get().iter().position(|&f| f == factor) {
            match self {
                Factors::One(_) => *self = Factors::Several(Vec::new()),
                Factors::Several(several) => {
                    several.swap_remove(at);
                }
            }
        }
    }
}

/// The lists while sums and products are put together again.
struct Lists {
    /// Number of old nodes; an element from this index on is a pair.
    nodes: usize,
    /// The pairs, each with true for a product and false for a sum.
    pairs: Vec<(Pair, bool)>,
    /// For each pair, its node in the new graph.
    made: Vec<Option<NodeId>>,
    /// For each operand, its sort key: parameters alone first, then by age.
    order: Vec<(bool, Element)>,
    /// For each node 1/d that is used once, d.
    reciprocal_of: Vec<Option<NodeId>>,
}

impl Lists {
    fn new(graph: &Graph, live: &Live) -> Self {
        let nodes = graph.nodes();
        let varies = |id| !live.dependence(id).within(Dependence::PARAMETERS);
        let one = Node::Constant(1f64.to_bits());
        let reciprocal = |id: NodeId| match nodes[id.0 as usize] {
            Node::Div(a, d) if nodes[a.0 as usize] == one && live.uses(id) == 1 => Some(d),
            _ => None,
        };
        let ids = || (0..graph.len() as Element).map(NodeId);
        Lists {
            nodes: graph.len(),
            reciprocal_of: ids().map(reciprocal).collect(),
            pairs: Vec::new(),
            made: Vec::new(),
            order: ids().map(|id| (varies(id), id.0)).collect(),
        }
    }

    fn next(&self) -> Element {
        self.order.len() as Element
    }

    fn add(&mut self, pairs: Vec<Pair>, product: bool) {
        for pair in pairs {
            let order = |e: Element| self.order[e as usize];
            let place = order(pair.first).max(order(pair.second));
            self.order.push(place);
            self.pairs.push((pair, product));
            self.made.push(None);
        }
    }

    /// Makes the nodes of the pairs in a list, and of the pairs inside them.
    fn make(&mut self, copy: &Copier<'_>, list: &Signed) {
        let mut wanted: Vec<Element> = list.iter().map(|&(_, e)| e).collect();
        while let Some(&element) = wanted.last() {
            let Some(index) = (element as usize).checked_sub(self.nodes) else {
                wanted.pop();
                continue;
            };
            if self.made[index].is_some() {
                wanted.pop();
                continue;
            }
            let (pair, product) = self.pairs[index];
            let missing = |e: Element| {
                let index = (e as usize).checked_sub(self.nodes);
                index.is_some_and(|index| self.made[index].is_none())
            };
            let parts = [pair.first, pair.second];
            if parts.into_iter().any(missing) {
                wanted.extend(parts.into_iter().filter(|&e| missing(e)));
                continue;
            }
            let [a, b] = parts.map(|e| self.value(copy, e));
            let value = match (product, pair.opposite) {
                (true, _) => a * b,
                (false, true) => a - b,
                (false, false) => a + b,
            };
            self.made[index] = Some(value.id());
            wanted.pop();
        }
    }

    /// The node of an operand in the new graph; a pair must have been made before.
    fn value<'c>(&self, copy: &'c Copier<'_>, element: Element) -> Expr<'c> {
        match (element as usize).checked_sub(self.nodes) {
            None => copied(copy, NodeId(element)),
            Some(index) => {
                let made = self.made[index].expect("pairs are made before their users");
                copy.graph().expr(made)
            }
        }
    }

    fn product<'c>(&self, copy: &'c Copier<'_>, factors: &mut [Element]) -> Expr<'c> {
        factors.sort_by_key(|&f| self.order[f as usize]);
        // A reciprocal with no other user becomes a quotient.
        let below = |f: &Element| self.reciprocal_of.get(*f as usize).copied().flatten();
        let one = copy.graph().constant(1.0);
        let above = factors.iter().filter(|&f| below(f).is_none());
        let product = above.fold(one, |product, &f| product * self.value(copy, f));
        let below = factors.iter().filter_map(below);
        below.fold(product, |product, d| product / copied(copy, d))
    }

    /// The terms of a sum. A term with no other user is split into its factors.
    fn terms(&mut self, copy: &Copier<'_>, flat: &Flat, list: &Signed) -> Vec<Term> {
        self.make(copy, list);
        let mut terms = Vec::with_capacity(list.len());
        for &(negative, element) in list {
            terms.push(match flat.role.get(element as usize) {
                Some(&Role::Term(index)) => {
                    let factors = &flat.products[index as usize];
                    self.make(copy, factors);
                    Term {
                        negative: negative != flat.negative[index as usize],
                        factors: Factors::Several(factors.iter().map(|&(_, f)| f).collect()),
                    }
                }
                _ => Term {
                    negative,
                    factors: Factors::One([element]),
                },
            });
        }
        terms
    }

    /// The sum with common factors taken out. Each level of recursion has one factor less.
    fn sum<'c>(&self, copy: &'c Copier<'_>, terms: Vec<Term>) -> Expr<'c> {
        let mut parts: Vec<((bool, Element), Expr<'c>)> = Vec::with_capacity(terms.len());
        let mut terms: Vec<Option<Term>> = terms.into_iter().map(Some).collect();
        for (factor, members) in common_factors(&terms) {
            let is_free = |at: &usize| terms[*at].is_some();
            let members: Vec<usize> = members.into_iter().filter(is_free).collect();
            let products = members.iter().flat_map(|&at| &terms[at]);
            if products.filter(|t| t.factors.get().len() > 1).count() < 2 {
                continue;
            }
            let mut inner: Vec<Term> = Vec::with_capacity(members.len());
            for mut term in members.into_iter().filter_map(|at| terms[at].take()) {
                term.factors.remove(factor);
                inner.push(term);
            }
            let places = inner.iter().map(|term| self.place(term));
            let place = places.max().unwrap_or_default();
            let place = place.max(self.order[factor as usize]);
            let value = self.value(copy, factor) * self.sum(copy, inner);
            parts.push((place, value));
        }
        for mut term in terms.into_iter().flatten() {
            let place = self.place(&term);
            let value = self.product(copy, term.factors.get_mut());
            parts.push((place, signed(value, term.negative)));
        }
        parts.sort_by_key(|(place, _)| *place);
        let zero = copy.graph().constant(0.0);
        parts.into_iter().fold(zero, |sum, (_, part)| sum + part)
    }

    fn place(&self, term: &Term) -> (bool, Element) {
        let places = term.factors.get().iter().map(|&f| self.order[f as usize]);
        places.max().unwrap_or_default()
    }
}

/// Factors that more than one term has, with these terms, the most frequent factor first; none where no two terms are
/// products.
fn common_factors(terms: &[Option<Term>]) -> Vec<(Element, Vec<usize>)> {
    let products = terms.iter().flatten();
    if products.filter(|term| term.factors.get().len() > 1).count() < 2 {
        // nothing would be gained
        return Vec::new();
    }
    let mut entries: Vec<(Element, usize)> = Vec::new();
    for (at, term) in terms.iter().enumerate() {
        let factors = term.iter().flat_map(|t| t.factors.get());
        entries.extend(factors.map(|&f| (f, at)));
    }
    entries.sort_unstable();
    entries.dedup();
    let groups = entries.chunk_by(|a, b| a.0 == b.0).filter(|g| g.len() > 1);
    let mut common: Vec<(Element, Vec<usize>)> = groups
        .map(|group| (group[0].0, group.iter().map(|e| e.1).collect()))
        .collect();
    common.sort_by_key(|(factor, members)| (std::cmp::Reverse(members.len()), *factor));
    common
}
