//! The search for frames in which the equations of a tree have the fewest operations: descent on the count, choice by
//! choice.
//!
//! Every trial derives the equations in a graph of its own and counts their operations; those that depend on parameters
//! alone are free. Only a part of the tree is derived again: the links near the one whose choice is tried, with
//! unknowns in place of the others. The number of trials depends on the tree alone, so the same model has the same
//! frames on every machine.

mod candidates;
mod part;
mod shape;

use super::elimination;
use super::frames::{Choice, Framed, LinkChoice, Matrix, ReferenceTurn, can_align, natural_axes};
use super::motion::Reference;
use super::tree::{Link, LinkJoint, Tree};
use crate::expression::liveness::{Dependence, Live};
use crate::expression::{Expr, Graph, Node, NodeId, Symbol};
use candidates::reach;
use part::{Part, matrices, needed};
use rustc_hash::FxHashMap;
use shape::{Exact, shape};
use std::cell::{Cell, RefCell};
use std::sync::{Arc, LazyLock, Mutex};

/// Number of sweeps over all links.
const SWEEPS: usize = 2;

/// Number of units of length that are tried.
const UNITS: usize = 8;

/// The smallest number of links in a part of a tree, if the tree has as many.
const NEAR: usize = 8;

/// From so many links on a part goes no further inwards, even where a link keeps its axes and is turned together with
/// its carrier: else the part of a chain of parallel axes reaches to the root, and the time for a choice grows with the
/// square of its length.
const FAR: usize = 16;

/// Number of trees whose choice is stored.
const KEPT: usize = 64;

/// The equations that should take the fewest operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Aim {
    /// The accelerations by the articulated-body algorithm.
    Elimination,
    /// S and r_s.
    Matrices,
    /// The accelerations by S and the forces in a reference motion.
    Factorization,
    /// The forces that given accelerations need.
    InverseDynamics,
}

/// The choices for earlier trees, by their [signature](Search::signature). Many effects and parameters do not change
/// the tree.
static KNOWN: Mutex<Vec<(Vec<u64>, Choice)>> = Mutex::new(Vec::new());

/// The operations of the parts of earlier trees: trees that differ in one link have most parts in common. They are
/// found by shape and numbers, on which alone they depend, so it does not matter which are here.
static COUNTED: LazyLock<Mutex<Arc<Counted>>> = LazyLock::new(Mutex::default);

type Counted = FxHashMap<(Aim, Exact), usize>;

/// All these counts are forgotten where there are more.
const MOST_COUNTED: usize = 1 << 18;

/// The best choice that the search finds.
pub fn choice(tree: &Tree<'_>, aim: Aim) -> Choice {
    let mut search = Search::new(tree, aim);
    search.others = COUNTED
        .lock()
        .map(|counted| counted.clone())
        .unwrap_or_default();
    let signature = search.signature();
    if let Ok(known) = KNOWN.lock()
        && let Some((_, choice)) = known.iter().find(|(of, _)| *of == signature)
    {
        return choice.clone();
    }
    search.sweep();
    if let Ok(mut known) = KNOWN.lock() {
        if known.len() >= KEPT {
            known.remove(0);
        }
        known.push((signature, search.best.clone()));
    }
    if let Ok(mut counted) = COUNTED.lock() {
        let counted = Arc::make_mut(&mut counted);
        if counted.len() > MOST_COUNTED {
            counted.clear();
        }
        counted.extend(search.anew.take());
    }
    search.best
}

/// The number of links that a search brings into frames, and of those whose equations it derives, trial by trial.
pub fn work(tree: &Tree<'_>, aim: Aim) -> [usize; 2] {
    let mut search = Search::new(tree, aim);
    search.sweep();
    search.work.get()
}

/// Frames of links drawn at random from those that a search tries. `draw` returns a number below its argument.
pub fn drawn(tree: &Tree<'_>, aim: Aim, draw: &mut dyn FnMut(usize) -> usize) -> Choice {
    let mut search = Search::new(tree, aim);
    for k in (0..tree.links.len()).rev() {
        // the frame of a ball is that of its element
        if !tree.links[k].joint.is_ball() {
            let frames = search.frames(k);
            let link = &mut search.best.links[k];
            (link.turn, link.place) = frames[draw(frames.len())];
        }
    }
    search.best
}

struct Search<'t, 'g> {
    tree: &'t Tree<'g>,
    aim: Aim,
    /// For each node of the tree's graph that the tree has: whether it changes with the state, and its number as a
    /// symbol.
    inputs: Vec<Option<(bool, u32)>>,
    /// The number of these nodes.
    symbols: u32,
    natural: Vec<(Matrix, f64)>,
    /// The largest distance of the origin of a link from its joint \[m\].
    reach: f64,
    best: Choice,
    /// For each link, those that it carries.
    children: Vec<Vec<usize>>,
    /// For each link, the number of its velocities and of those of all links that it carries.
    columns: Vec<usize>,
    /// The operations of all parts that were tried, by their choice.
    counted: RefCell<FxHashMap<Vec<u64>, usize>>,
    /// The operations of all parts that were derived, by their shape.
    shapes: RefCell<FxHashMap<u128, usize>>,
    /// Those of earlier trees.
    others: Arc<Counted>,
    /// Those that earlier trees did not have.
    anew: RefCell<Counted>,
    /// The number of links that were brought into frames, and of those whose equations were derived.
    work: Cell<[usize; 2]>,
    /// The graph of the trials, one after the other.
    graph: Graph,
}

impl<'t, 'g> Search<'t, 'g> {
    fn new(tree: &'t Tree<'g>, aim: Aim) -> Self {
        let mut nodes = Vec::new();
        let scratch = Graph::new();
        let zero = scratch.constant(0.0);
        tree.map(&scratch, |e| {
            nodes.push(unsigned(e).1);
            zero
        });
        let live = Live::new(tree.graph, &nodes);
        let (mut inputs, mut symbols) = (vec![None; tree.graph.len()], 0);
        for id in nodes {
            let input = &mut inputs[id.0 as usize];
            if input.is_none() {
                let varies = !live.dependence(id).within(Dependence::PARAMETERS);
                *input = Some((varies, symbols));
                symbols += 1;
            }
        }
        let links = &tree.links;
        let mut children = vec![Vec::new(); links.len()];
        let mut columns: Vec<usize> = links
            .iter()
            .map(|l| if l.joint.is_ball() { 3 } else { 1 })
            .collect();
        for (k, link) in links.iter().enumerate().rev() {
            if let Some(parent) = link.parent {
                children[parent].insert(0, k);
                columns[parent] += columns[k];
            }
        }
        Search {
            tree,
            aim,
            inputs,
            symbols,
            natural: natural_axes(tree),
            reach: reach(tree),
            best: Choice::plain(links.len()),
            children,
            columns,
            counted: RefCell::default(),
            shapes: RefCell::default(),
            others: Arc::default(),
            anew: RefCell::default(),
            work: Cell::default(),
            graph: Graph::new(),
        }
    }

    /// Tries the choices for all links, several times.
    fn sweep(&mut self) {
        for _ in 0..SWEEPS {
            let before = self.best.clone();
            self.bases();
            for k in (0..self.tree.links.len()).rev() {
                self.link(k);
            }
            self.units();
            if self.best == before {
                break;
            }
        }
    }

    /// All data that the choice depends on.
    fn signature(&self) -> Vec<u64> {
        let links = self.tree.links.len() as u64;
        let mut signature = vec![self.aim as u64, u64::from(self.tree.free), links];
        for link in &self.tree.links {
            signature.push(link.parent.map_or(u64::MAX, |p| p as u64));
            if let LinkJoint::Axis {
                axis,
                turn,
                coupled,
                absolute,
                ..
            } = &link.joint
            {
                signature.extend(axis.map(f64::to_bits));
                let flags = [*coupled, *absolute].map(u64::from);
                signature.extend([turn.to_bits(), flags[0], flags[1], link.row as u64]);
            }
        }
        let scratch = Graph::new();
        let zero = scratch.constant(0.0);
        self.tree.map(&scratch, |e| {
            match e.as_constant() {
                Some(constant) => signature.extend([0, constant.to_bits()]),
                None => {
                    let (negative, id) = unsigned(e);
                    let (varies, number) =
                        self.inputs[id.0 as usize].expect("the tree has this node");
                    let flags = 1 + 2 * u64::from(negative) + 4 * u64::from(varies);
                    signature.extend([flags, u64::from(number)]);
                }
            }
            zero
        });
        signature
    }

    /// The number of operations of the equations around a link, or of all of them; each is derived once.
    fn count(&self, choice: &Choice, around: Option<usize>) -> usize {
        let key = self.key(choice, around);
        if let Some(count) = self.counted.borrow().get(&key) {
            return *count;
        }
        let count = self.counted_anew(choice, around);
        self.counted.borrow_mut().insert(key, count);
        count
    }

    /// All of a choice that the equations around a link depend on, or all of them.
    fn key(&self, choice: &Choice, around: Option<usize>) -> Vec<u64> {
        let (links, top) = match around {
            Some(k) => self.near(k, choice),
            None => ((0..self.tree.links.len()).collect(), 0),
        };
        let mut key = vec![around.map_or(u64::MAX, |k| k as u64), choice.unit.to_bits()];
        key.extend(choice.base.map(f64::to_bits));
        for link in self.tree.links[top].parent.into_iter().chain(links) {
            key.push(link as u64);
            key.extend(choice.links[link].words());
        }
        key
    }

    fn counted_anew(&self, choice: &Choice, around: Option<usize>) -> usize {
        // the graph of a whole tree is large, and would have to be cleared each time
        let own = Graph::new();
        let graph = if around.is_some() { &self.graph } else { &own };
        graph.clear();
        let part = match around {
            Some(k) => self.around(graph, k, choice),
            None => Part {
                tree: self.opened(graph),
                natural: self.natural.clone(),
                choice: choice.clone(),
                of: (0..self.tree.links.len()).map(Some).collect(),
            },
        };
        let framed = Framed::in_trial(&part.tree, &part.natural, &part.choice);
        let links = part.tree.links.len();
        let [in_frames, derived] = self.work.get();
        self.work.set([in_frames + links, derived]);
        let exact = shape(graph, &part, &framed, part.tree.needs_axes());
        if let Some(count) = self.shapes.borrow().get(&exact.shape) {
            return *count;
        }
        if let Some(count) = self.others.get(&(self.aim, exact)) {
            self.shapes.borrow_mut().insert(exact.shape, *count);
            return *count;
        }
        self.work.set([in_frames + links, derived + links]);
        let roots = match self.aim {
            Aim::Elimination => {
                let name = |_: &Link<'_>| String::new();
                let solved = elimination::accelerations(&part.tree, &framed, &part.choice, &name);
                let each = solved.iter();
                each.flat_map(|s| s.rotation.0.into_iter().chain(s.base.0))
                    .collect()
            }
            Aim::Matrices => matrices(&part, &framed, Reference::Rest),
            Aim::Factorization => matrices(&part, &framed, Reference::ChosenOfAxes),
            Aim::InverseDynamics => needed(&part, &framed),
        };
        let count = operations(graph, &roots);
        self.shapes.borrow_mut().insert(exact.shape, count);
        self.anew.borrow_mut().insert((self.aim, exact), count);
        count
    }

    /// Tries choices and keeps the one with the fewest operations around a link, or of all.
    fn attempt(&mut self, around: Option<usize>, changes: Vec<Choice>) {
        let mut least = None;
        for choice in changes {
            if choice == self.best {
                continue;
            }
            let now = *least.get_or_insert_with(|| self.count(&self.best, around));
            let count = self.count(&choice, around);
            if count < now {
                (self.best, least) = (choice, Some(count));
            }
        }
    }

    /// Tries changes of the choice of one link, and keeps the one with the fewest operations around it.
    fn vary(&mut self, k: usize, changes: Vec<LinkChoice>) {
        let mut least = None;
        for link in changes {
            if link == self.best.links[k] {
                continue;
            }
            let now = least.unwrap_or_else(|| self.count(&self.best, Some(k)));
            let before = std::mem::replace(&mut self.best.links[k], link);
            let count = self.count(&self.best, Some(k));
            if count >= now {
                self.best.links[k] = before;
            }
            least = Some(count.min(now));
        }
    }

    /// Tries the choices for one link.
    fn link(&mut self, k: usize) {
        if self.children[k].len() > 1 {
            let link = &self.best.links[k];
            let with = |order| LinkChoice {
                order,
                ..link.clone()
            };
            self.vary(k, ORDERS.map(with).to_vec());
        }
        self.align(k);
        if self.tree.links[k].joint.is_ball() {
            self.toggle(k, |c| c.by_inertia ^= true);
            self.keeps(k);
            return;
        }
        if matches!(self.aim, Aim::Elimination | Aim::Factorization) {
            self.references(k);
        }
        let link = self.best.links[k].clone();
        let with = |(turn, place)| LinkChoice {
            turn,
            place,
            ..link.clone()
        };
        self.vary(k, self.frames(k).into_iter().map(with).collect());
        self.align(k);
        self.toggle(k, |c| c.by_inertia ^= true);
        self.keeps(k);
        if self.aim == Aim::Elimination {
            self.toggle(k, |c| c.scales_bias ^= true);
            self.toggle(k, |c| c.scales_rate ^= true);
        }
    }

    /// Tries the reference accelerations of one link.
    fn references(&mut self, k: usize) {
        let link = &self.best.links[k];
        let references = [
            ReferenceTurn::Zero,
            ReferenceTurn::Rest,
            ReferenceTurn::Product,
            ReferenceTurn::NegativeProduct,
        ];
        let with = |reference| LinkChoice {
            reference,
            ..link.clone()
        };
        self.vary(k, references.map(with).to_vec());
    }

    /// Tries which child of a link keeps which component.
    fn keeps(&mut self, k: usize) {
        let links = &self.tree.links;
        let link = &self.best.links[k];
        let mut changes = vec![LinkChoice {
            keep: None,
            ..link.clone()
        }];
        for &child in &self.children[k] {
            let keep = |axis| LinkChoice {
                keep: Some((child, axis)),
                ..link.clone()
            };
            let axes = if links[child].joint.is_hinge() { 3 } else { 0 };
            changes.extend((0..axes).map(keep));
        }
        self.vary(k, changes);
    }

    fn toggle(&mut self, k: usize, change: impl FnOnce(&mut LinkChoice)) {
        let mut link = self.best.links[k].clone();
        change(&mut link);
        self.vary(k, vec![link]);
    }

    fn align(&mut self, k: usize) {
        if can_align(self.tree, &self.natural, k) {
            self.toggle(k, |c| c.aligned ^= true);
        }
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

/// Whether an expression is a negative, and its operand.
fn unsigned(e: Expr<'_>) -> (bool, NodeId) {
    match e.node() {
        Node::Neg(a) => (true, a),
        _ => (false, e.id()),
    }
}

/// The number of operations that depend on more than parameters.
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
