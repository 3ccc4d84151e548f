//! The search for the frames in which the equations of a tree have fewest operations: descent on the count, choice by choice.
//!
//! The equations are made in a graph of their own for every trial, and their operations are counted; what depends on parameters alone is free. Only a
//! part of the tree is made again: the links near the one whose choice is tried. The number of trials depends on the tree alone, so
//! the same model has the same frames on every machine.

use super::elimination;
use super::frames::{Choice, Framed, ReferenceTurn, natural_axes};
use super::tree::Tree;
use crate::expression::live::{Dependence, Live};
use crate::expression::{Expr, Graph, Node, NodeId, Symbol};
use rustc_hash::FxHashMap;

/// Sweeps over all links.
const SWEEPS: usize = 2;

/// The best choice that is found.
pub fn choice(tree: &Tree<'_>) -> Choice {
    let mut search = Search::new(tree);
    for _ in 0..SWEEPS {
        let before = search.least;
        search.units();
        search.bases();
        for k in (0..tree.links.len()).rev() {
            search.link(k);
        }
        if search.least == before {
            break;
        }
    }
    search.best
}

struct Search<'t, 'g> {
    tree: &'t Tree<'g>,
    /// By node of the tree's graph: whether it changes with the state, and its number as a symbol.
    inputs: FxHashMap<NodeId, (bool, u32)>,
    natural: Vec<([[f64; 3]; 3], f64)>,
    best: Choice,
    least: usize,
}

impl<'t, 'g> Search<'t, 'g> {
    fn new(tree: &'t Tree<'g>) -> Self {
        let mut nodes = Vec::new();
        let scratch = Graph::new();
        let zero = scratch.constant(0.0);
        tree.map(&scratch, |e| {
            nodes.push(unsigned(e).1);
            zero
        });
        let live = Live::new(tree.graph, &nodes);
        let mut inputs = FxHashMap::default();
        for id in nodes {
            let number = inputs.len() as u32;
            let varies = !live.dependence(id).within(Dependence::PARAMETERS);
            inputs.entry(id).or_insert((varies, number));
        }
        let natural = natural_axes(tree);
        let best = Choice::plain(tree.links.len());
        let mut search = Search {
            tree,
            inputs,
            natural,
            best,
            least: 0,
        };
        search.least = search.count(&search.best);
        search
    }

    /// The tree in a graph of its own, its inputs symbols.
    fn opened<'h>(&self, graph: &'h Graph) -> Tree<'h> {
        self.tree.map(graph, |e| {
            if let Some(constant) = e.as_constant() {
                return graph.constant(constant);
            }
            let (negative, id) = unsigned(e);
            let symbol = match self.inputs[&id] {
                (true, number) => Symbol::Coordinate(number),
                (false, number) => Symbol::Parameter(number),
            };
            match negative {
                true => -graph.symbol(symbol),
                false => graph.symbol(symbol),
            }
        })
    }

    /// Operations of the accelerations.
    fn count(&self, choice: &Choice) -> usize {
        let graph = Graph::new();
        let tree = self.opened(&graph);
        let framed = Framed::of(&tree, &self.natural, choice);
        let solved = elimination::accelerations(&tree, &framed, choice, &|_| String::new());
        let mut roots = Vec::new();
        for solved in &solved {
            roots.extend(solved.rotation.0);
            roots.extend(solved.base.0);
        }
        operations(&graph, &roots)
    }

    /// Keeps a choice if it has fewer operations.
    fn attempt(&mut self, change: impl FnOnce(&mut Choice)) -> bool {
        let mut choice = self.best.clone();
        change(&mut choice);
        if choice == self.best {
            return false;
        }
        let count = self.count(&choice);
        let better = count < self.least;
        if better {
            (self.best, self.least) = (choice, count);
        }
        better
    }

    /// The choices of one link.
    fn link(&mut self, k: usize) {
        let children = self.tree.links.iter().filter(|l| l.parent == Some(k));
        if children.count() > 1 {
            for order in ORDERS {
                self.attempt(|c| c.links[k].order = order);
            }
        }
        self.attempt(|c| c.links[k].aligned ^= true);
        if self.tree.links[k].joint.is_ball() {
            self.attempt(|c| c.links[k].by_inertia ^= true);
            return;
        }
        for reference in [
            ReferenceTurn::Zero,
            ReferenceTurn::Rest,
            ReferenceTurn::Product,
            ReferenceTurn::NegativeProduct,
        ] {
            self.attempt(|c| c.links[k].reference = reference);
        }
        for (turn, place) in self.frames(k) {
            self.attempt(|c| (c.links[k].turn, c.links[k].place) = (turn, place));
        }
        self.attempt(|c| c.links[k].aligned ^= true);
        self.attempt(|c| c.links[k].by_inertia ^= true);
        self.attempt(|c| c.links[k].scales_bias ^= true);
        self.attempt(|c| c.links[k].scales_rate ^= true);
    }

    /// Units of length: the components of places.
    fn units(&mut self) {
        let graph = Graph::new();
        let tree = self.opened(&graph);
        let plain = Choice {
            unit: 1.0,
            ..self.best.clone()
        };
        let framed = Framed::of(&tree, &self.natural, &plain);
        let components = framed.links.iter().flat_map(|link| link.place.0);
        let mut units: Vec<f64> = components
            .filter_map(|e| e.as_constant())
            .map(f64::abs)
            .filter(|length| *length > 1e-6)
            .collect();
        units.sort_by(f64::total_cmp);
        units.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        for unit in units {
            self.attempt(|c| c.unit = unit);
        }
    }

    /// Places of the origin of a free base: in the joints of what it carries, or level with them.
    fn bases(&mut self) {
        if !self.tree.free {
            return;
        }
        let mut places = vec![[0.0; 3]];
        for link in self.tree.links.iter().filter(|l| l.parent == Some(0)) {
            let place = link.place.0.map(|e| e.as_constant().unwrap_or(0.0));
            for mask in 1..8 {
                let masked = [0, 1, 2].map(|i| if mask >> i & 1 == 1 { place[i] } else { 0.0 });
                if !places.contains(&masked) {
                    places.push(masked);
                }
            }
        }
        for base in places {
            self.attempt(|c| c.base = base);
        }
        for order in ORDERS {
            self.attempt(|c| c.links[0].order = order);
        }
    }

    /// Turns and places of a link's frame at which constants vanish.
    fn frames(&self, k: usize) -> Vec<(f64, f64)> {
        let mut choice = self.best.clone();
        choice.unit = 1.0;
        choice.links[k].aligned = false;
        (choice.links[k].turn, choice.links[k].place) = (0.0, 0.0);
        let constant = |e: Expr<'_>| e.as_constant().unwrap_or(0.0);
        let children: Vec<usize> = (0..self.tree.links.len())
            .filter(|&c| self.tree.links[c].parent == Some(k))
            .collect();
        let mut places = vec![0.0];
        {
            let graph = Graph::new();
            let tree = self.opened(&graph);
            let framed = Framed::of(&tree, &self.natural, &choice);
            let link = &framed.links[k];
            // the joint's place along the axis, seen from the link
            let along = (0..3).map(|i| link.against[i][2] * constant(link.place.0[i]));
            places.push(-along.sum::<f64>());
            places.extend(children.iter().map(|&c| constant(framed.links[c].place.0[2])));
            let (h, s) = (link.body.first.0.map(constant), &link.body.second);
            for (i, h) in h.into_iter().take(2).enumerate() {
                if h.abs() > 1e-12 {
                    places.push(constant(s.entry(i, 2)) / h);
                }
            }
        }
        let mut frames = Vec::new();
        let mut known: Vec<f64> = Vec::new();
        for place in places {
            if known.iter().any(|p: &f64| (p - place).abs() < 1e-13) {
                continue;
            }
            known.push(place);
            choice.links[k].place = place;
            let graph = Graph::new();
            let tree = self.opened(&graph);
            let framed = Framed::of(&tree, &self.natural, &choice);
            let link = &framed.links[k];
            let mut turns = vec![0.0];
            let mut towards = |x: f64, y: f64| {
                if x.hypot(y) > 1e-9 {
                    let quarter = std::f64::consts::FRAC_PI_2;
                    let angle = libm::atan2(y, x);
                    let turn = angle - (angle / quarter).round() * quarter;
                    if turns.iter().all(|t: &f64| (t - turn).abs() > 1e-14) {
                        turns.push(turn);
                    }
                }
            };
            let h = link.body.first.0.map(constant);
            let sigma = |i, j| constant(link.body.second.entry(i, j));
            towards(h[0], h[1]);
            towards(sigma(0, 2), sigma(1, 2));
            let principal = 0.5 * libm::atan2(2.0 * sigma(0, 1), sigma(0, 0) - sigma(1, 1));
            towards(libm::cos(principal), libm::sin(principal));
            // the turn that the joint has with its carrier
            towards(link.against[2][1], link.against[2][0]);
            for &c in &children {
                let child = &framed.links[c];
                towards(constant(child.place.0[0]), constant(child.place.0[1]));
                towards(child.against[0][2], child.against[1][2]);
            }
            frames.extend(turns.into_iter().map(|turn| (turn, place)));
        }
        frames
    }
}

const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];

/// Whether an expression is a negative, and of what.
fn unsigned(e: Expr<'_>) -> (bool, NodeId) {
    match e.node() {
        Node::Neg(a) => (true, a),
        _ => (false, e.id()),
    }
}

/// Operations that depend on more than parameters.
fn operations(graph: &Graph, roots: &[Expr<'_>]) -> usize {
    let nodes = graph.nodes();
    let mut live = vec![false; nodes.len()];
    for root in roots {
        live[root.id().0 as usize] = true;
    }
    for (i, node) in nodes.iter().enumerate().rev() {
        if live[i] {
            for operand in node.operands() {
                live[operand.0 as usize] = true;
            }
        }
    }
    let mut varies = vec![false; nodes.len()];
    let mut count = 0;
    for (i, node) in nodes.iter().enumerate() {
        if !live[i] {
            continue;
        }
        varies[i] = match node {
            Node::Symbol(symbol) => !matches!(symbol, Symbol::Parameter(_)),
            _ => node.operands().any(|o| varies[o.0 as usize]),
        };
        let counts = matches!(
            node,
            Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::Div(..)
        );
        count += usize::from(counts && varies[i]);
    }
    count
}
