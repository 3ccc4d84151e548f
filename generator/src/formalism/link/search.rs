//! The search for the frames in which the equations of a tree have fewest operations: descent on the count, choice by choice.
//!
//! The equations are made in a graph of their own for every trial, and their operations are counted; what depends on parameters alone is free. Only a
//! part of the tree is made again: the links near the one whose choice is tried, with unknowns for what is beyond. The number of trials depends on the tree alone, so
//! the same model has the same frames on every machine.

use super::elimination::{self, Articulated};
use super::frames::{Choice, Framed, LinkChoice, Matrix, ReferenceTurn, can_align, natural_axes};
use super::tree::{Link, LinkJoint, Tree};
use crate::expression::live::{Dependence, Live};
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph, Node, NodeId, Symbol};
use crate::formalism::spatial::Wrench;
use rustc_hash::FxHashMap;
use std::sync::Mutex;

/// Sweeps over all links.
const SWEEPS: usize = 2;

/// Units of length that are tried.
const UNITS: usize = 8;

/// Links of which the part of a tree is made, at least, if there are so many.
const NEAR: usize = 8;

/// Trees whose choice is kept.
const KEPT: usize = 64;

/// The choices of trees met before, by their [signature](Search::signature): many effects and parameters leave the tree as it is.
static KNOWN: Mutex<Vec<(Vec<u64>, Choice)>> = Mutex::new(Vec::new());

/// The best choice that is found.
pub fn choice(tree: &Tree<'_>) -> Choice {
    let mut search = Search::new(tree);
    let signature = search.signature();
    if let Ok(known) = KNOWN.lock()
        && let Some((_, choice)) = known.iter().find(|(of, _)| *of == signature)
    {
        return choice.clone();
    }
    for _ in 0..SWEEPS {
        let before = search.best.clone();
        search.bases();
        for k in (0..tree.links.len()).rev() {
            search.link(k);
        }
        search.units();
        if search.best == before {
            break;
        }
    }
    if let Ok(mut known) = KNOWN.lock() {
        if known.len() >= KEPT {
            known.remove(0);
        }
        known.push((signature, search.best.clone()));
    }
    search.best
}

struct Search<'t, 'g> {
    tree: &'t Tree<'g>,
    /// By node of the tree's graph: whether it changes with the state, and its number as a symbol.
    inputs: FxHashMap<NodeId, (bool, u32)>,
    natural: Vec<(Matrix, f64)>,
    /// How far from its joint the origin of a link may be \[m\].
    reach: f64,
    best: Choice,
}

/// A part of a tree, in which one link is tried.
struct Part<'h> {
    tree: Tree<'h>,
    natural: Vec<(Matrix, f64)>,
    choice: Choice,
    /// Which links of the whole these are; none is what stands for all that carries them.
    of: Vec<Option<usize>>,
}

impl<'h> Part<'h> {
    /// The part in its frames, where a link of the whole is in it, and where its children are.
    fn framed(&self, k: usize) -> (Framed<'h>, usize, Vec<usize>) {
        let framed = Framed::of(&self.tree, &self.natural, &self.choice);
        let at = self.of.iter().position(|of| *of == Some(k)).unwrap_or(0);
        let links = self.tree.links.iter().enumerate();
        let children = links.filter(|(_, link)| link.parent == Some(at));
        let children = children.map(|(c, _)| c).collect();
        (framed, at, children)
    }
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
        Search {
            tree,
            inputs,
            natural: natural_axes(tree),
            reach: reach(tree),
            best: Choice::plain(tree.links.len()),
        }
    }

    /// All that the choice depends on.
    fn signature(&self) -> Vec<u64> {
        let mut signature = vec![u64::from(self.tree.free), self.tree.links.len() as u64];
        for link in &self.tree.links {
            signature.push(link.parent.map_or(u64::MAX, |p| p as u64));
            if let LinkJoint::Axis { axis, turn, .. } = &link.joint {
                signature.extend(axis.map(f64::to_bits));
                signature.push(turn.to_bits());
            }
        }
        let scratch = Graph::new();
        let zero = scratch.constant(0.0);
        self.tree.map(&scratch, |e| {
            match e.as_constant() {
                Some(constant) => signature.extend([0, constant.to_bits()]),
                None => {
                    let (negative, id) = unsigned(e);
                    let (varies, number) = self.inputs[&id];
                    let flags = 1 + 2 * u64::from(negative) + 4 * u64::from(varies);
                    signature.extend([flags, u64::from(number)]);
                }
            }
            zero
        });
        signature
    }

    /// The whole tree in a graph of its own, its inputs symbols.
    fn opened<'h>(&self, graph: &'h Graph) -> Tree<'h> {
        self.tree.map(graph, |e| self.symbol(graph, e))
    }

    fn symbol<'h>(&self, graph: &'h Graph, e: Expr<'g>) -> Expr<'h> {
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
    }

    /// The links around k: its parent, its children and those behind them, with unknowns for what is beyond.
    fn around<'h>(&self, graph: &'h Graph, k: usize, choice: &Choice) -> Part<'h> {
        let links = &self.tree.links;
        let children = |k: usize| (k + 1..links.len()).filter(move |&c| links[c].parent == Some(k));
        let mut chosen = vec![k];
        chosen.extend(children(k));
        let mut next = 1;
        while chosen.len() < NEAR && next < chosen.len() {
            chosen.extend(children(chosen[next]));
            next += 1;
        }
        let mut top = k;
        while let Some(parent) = links[top].parent
            // what keeps its axes is turned together with what carries it
            && (top == k || chosen.len() < NEAR || choice.links[parent].aligned)
        {
            top = parent;
            chosen.push(top);
        }
        chosen.sort_unstable();
        // indices above all inputs
        let mut unknowns = self.inputs.len() as u32;
        let mut unknown = || {
            unknowns += 1;
            graph.symbol(Symbol::Coordinate(unknowns))
        };
        let mut part = Part {
            tree: Tree {
                graph,
                links: Vec::new(),
                ground: Vec3(self.tree.ground.0.map(|e| self.symbol(graph, e))),
                ground_axes: self.opened_part(graph, &[]).ground_axes,
                free: self.tree.free,
                carrier: None,
            },
            natural: Vec::new(),
            choice: Choice {
                links: Vec::new(),
                ..choice.clone()
            },
            of: Vec::new(),
        };
        let mut vector = || Vec3([unknown(), unknown(), unknown()]);
        if let Some(carrier) = links[top].parent {
            part.tree.links.push(Link {
                element: usize::MAX,
                row: 0,
                parent: None,
                joint: LinkJoint::Ball { omega: vector() },
                place: Vec3::zero(graph),
                body: super::body::Body::none(graph),
                rotation: Mat3([vector().0, vector().0, vector().0]),
                load: Wrench::none(graph),
                carries: None,
            });
            part.of.push(None);
            part.tree.free = true;
            part.tree.carrier = Some([vector(), vector(), vector()]);
            let (natural, _) = &self.natural[carrier];
            let turn = choice.links[carrier].turn;
            part.natural
                .push((super::frames::turned_axes(natural, turn), 1.0));
            part.choice.links.extend(Choice::plain(1).links);
            part.choice.links[0].order = choice.links[carrier].order;
            // the origin of the carrier's frame
            part.choice.base = super::frames::origin_of(self.tree, &self.natural, choice, carrier);
        }
        let first = part.tree.links.len();
        let opened = self.opened_part(graph, &chosen).links;
        for (i, (&link, mut own)) in chosen.iter().zip(opened).enumerate() {
            own.parent = match i {
                0 => (first > 0).then_some(0),
                _ => links[link]
                    .parent
                    .and_then(|p| chosen.iter().position(|&c| c == p).map(|at| first + at)),
            };
            let left_out = (link + 1..links.len())
                .any(|c| links[c].parent == Some(link) && !chosen.contains(&c));
            if left_out {
                let mut six = || Sym3 {
                    diagonal: vector().0,
                    off: vector().0,
                };
                let (mass, inertia) = (six(), six());
                own.carries = Some(Articulated {
                    mass,
                    coupling: Mat3([vector().0, vector().0, vector().0]),
                    inertia,
                    bias: Wrench {
                        force: vector(),
                        moment: vector(),
                    },
                });
            }
            part.of.push(Some(link));
            part.tree.links.push(own);
            part.natural.push(self.natural[link]);
            part.choice.links.push(choice.links[link].clone());
        }
        part
    }

    /// Some of the links, in a graph of their own.
    fn opened_part<'h>(&self, graph: &'h Graph, chosen: &[usize]) -> Tree<'h> {
        let part = Tree {
            graph: self.tree.graph,
            links: chosen.iter().map(|&k| self.tree.links[k].clone()).collect(),
            ground: self.tree.ground,
            ground_axes: self.tree.ground_axes,
            free: self.tree.free,
            carrier: None,
        };
        part.map(graph, |e| self.symbol(graph, e))
    }

    /// Operations of the accelerations around a link, or of all.
    fn count(&self, choice: &Choice, around: Option<usize>) -> usize {
        let graph = Graph::new();
        let part = match around {
            Some(k) => self.around(&graph, k, choice),
            None => Part {
                tree: self.opened(&graph),
                natural: self.natural.clone(),
                choice: choice.clone(),
                of: (0..self.tree.links.len()).map(Some).collect(),
            },
        };
        let framed = Framed::of(&part.tree, &part.natural, &part.choice);
        let name = |_: &Link<'_>| String::new();
        let solved = elimination::accelerations(&part.tree, &framed, &part.choice, &name);
        let mut roots = Vec::new();
        for solved in &solved {
            roots.extend(solved.rotation.0);
            roots.extend(solved.base.0);
        }
        operations(&graph, &roots)
    }

    /// Keeps those choices that have fewer operations around a link, or in all.
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

    /// Tries changes of the choice of one link.
    fn vary(&mut self, k: usize, changes: Vec<LinkChoice>) {
        let of = |link| {
            let mut choice = self.best.clone();
            choice.links[k] = link;
            choice
        };
        let changes = changes.into_iter().map(of).collect();
        self.attempt(Some(k), changes);
    }

    /// The choices of one link.
    fn link(&mut self, k: usize) {
        let children = self.tree.links.iter().filter(|l| l.parent == Some(k));
        if children.count() > 1 {
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
            return;
        }
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
        let link = self.best.links[k].clone();
        let with = |(turn, place)| LinkChoice {
            turn,
            place,
            ..link.clone()
        };
        self.vary(k, self.frames(k).into_iter().map(with).collect());
        self.align(k);
        self.toggle(k, |c| c.by_inertia ^= true);
        self.toggle(k, |c| c.scales_bias ^= true);
        self.toggle(k, |c| c.scales_rate ^= true);
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

    /// Units of length: the components of places that occur most.
    fn units(&mut self) {
        let graph = Graph::new();
        let tree = self.opened(&graph);
        let plain = Choice {
            unit: 1.0,
            ..self.best.clone()
        };
        let framed = Framed::of(&tree, &self.natural, &plain);
        let components = framed.links.iter().flat_map(|link| link.place.0);
        let mut lengths: Vec<f64> = components
            .filter_map(|e| e.as_constant())
            .map(f64::abs)
            .filter(|length| *length > 1e-6)
            .collect();
        lengths.sort_by(f64::total_cmp);
        let mut units: Vec<(usize, f64)> = Vec::new();
        for length in lengths {
            match units.last_mut() {
                Some((count, unit)) if (length - *unit).abs() < 1e-12 => *count += 1,
                _ => units.push((1, length)),
            }
        }
        units.sort_by(|(a, x), (b, y)| b.cmp(a).then(y.total_cmp(x)));
        units.truncate(UNITS);
        let with = |(_, unit)| Choice {
            unit,
            ..self.best.clone()
        };
        self.attempt(None, units.into_iter().map(with).collect());
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
        let with = |base| Choice {
            base,
            ..self.best.clone()
        };
        self.attempt(Some(0), places.into_iter().map(with).collect());
    }

    /// Turns and places of a link's frame at which constants vanish.
    fn frames(&self, k: usize) -> Vec<(f64, f64)> {
        let mut choice = self.best.clone();
        choice.unit = 1.0;
        choice.links[k].aligned = false;
        (choice.links[k].turn, choice.links[k].place) = (0.0, 0.0);
        let constant = |e: Expr<'_>| e.as_constant().unwrap_or(0.0);
        let mut places = vec![0.0];
        {
            let graph = Graph::new();
            let part = self.around(&graph, k, &choice);
            let (framed, at, children) = part.framed(k);
            let link = &framed.links[at];
            // the joint's place along the axis, seen from the link
            let along = (0..3).map(|i| link.against[i][2] * constant(link.place.0[i]));
            places.push(-along.sum::<f64>());
            places.extend(
                children
                    .iter()
                    .map(|&c| constant(framed.links[c].place.0[2])),
            );
            let (h, s) = (link.body.first.0.map(constant), &link.body.second);
            for (i, h) in h.into_iter().take(2).enumerate() {
                let level = constant(s.entry(i, 2)) / h;
                // h that is almost 0 would move the origin far away, and that loses the digits of the inertia
                if level.abs() <= self.reach {
                    places.push(level);
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
            let part = self.around(&graph, k, &choice);
            let (framed, at, children) = part.framed(k);
            let link = &framed.links[at];
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

/// How far from its joint the origin of a link may be \[m\]: four times the largest distance in the tree, between joints, or of a centre of mass
/// from its joint. An inertia about an origin that is s such distances away is s² times as large, which loses that factor of its digits: 16 is little.
fn reach(tree: &Tree<'_>) -> f64 {
    let constant = |e: Expr<'_>| e.as_constant().unwrap_or(0.0);
    let norm = |v: Vec3<'_>| v.0.map(constant).iter().map(|c| c * c).sum::<f64>().sqrt();
    let masses = || tree.links.iter().map(|link| constant(link.body.mass).abs());
    let heaviest = masses().fold(0.0, f64::max);
    let links = tree.links.iter().zip(masses());
    let distances = links.map(|(link, mass)| match mass > 1e-3 * heaviest {
        true => norm(link.place).max(norm(link.body.first) / mass),
        false => norm(link.place),
    });
    4.0 * distances.fold(0.0, f64::max)
}

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
