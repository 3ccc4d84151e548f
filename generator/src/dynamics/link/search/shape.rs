//! What the number of operations of a part depends on: parts of equal shape are counted once.
//!
//! Equations treat all numbers alike except 0, 1, −1 and those that are equal or opposite, because a sign costs
//! nothing; and all inputs alike except parameters. So a number counts as 0, as ±1, or as plus or minus the first,
//! second, … number of the part; and an input as the first, second, … input. In a chain of unlike bodies most parts
//! have the shape of a part before. A sum of unlike numbers that happens to vanish is not seen: then the count is that
//! of a part without such luck.

use super::part::Part;
use crate::dynamics::link::body::Body;
use crate::dynamics::link::frames::{Framed, FramedLink, MadeOf};
use crate::dynamics::link::tree::{Carried, Link, LinkJoint};
use crate::dynamics::link::turn::Turn;
use crate::dynamics::spatial::Wrench;
use crate::expression::{Expr, Graph, Node, NodeId, Symbol};
use rustc_hash::{FxHashMap, FxHasher};
use std::hash::{Hash, Hasher};

/// The shape of a part, and its shape together with its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Exact {
    /// The shape as a number that other shapes do not have, by all that is likely.
    pub shape: u128,
    /// The same for all digits of the numbers.
    numbers: u128,
}

/// The shape of a part.
pub fn shape(graph: &Graph, part: &Part<'_>, framed: &Framed<'_>, needs_axes: bool) -> Exact {
    let mut shape = Shape {
        halves: [0; 2],
        digits: [0; 2],
        graph,
        seen: vec![0; graph.len()],
        count: 0,
        numbers: FxHashMap::default(),
    };
    let (tree, choice) = (&part.tree, &part.choice);
    shape.number(choice.unit);
    shape.word(u64::from(tree.free));
    shape.word(tree.base.map_or(0, |base| 1 + base as u64));
    for &direction in tree.directions {
        shape.word(direction as u64);
    }
    if tree.free && tree.carrier.is_none() {
        for b in choice.base {
            shape.number(b);
        }
    }
    let ground = &tree.ground;
    for v in [ground.omega, ground.alpha, ground.acceleration] {
        shape.values(&v.0);
    }
    shape.values(ground.axes.0.as_flattened());
    shape.value(ground.angle);
    for v in tree.carrier.iter().flatten() {
        shape.values(&v.0);
    }
    let frames = framed.links.iter().zip(&framed.made_of);
    for (k, (link, (frame, made_of))) in tree.links.iter().zip(frames).enumerate() {
        shape.word(choice.links[k].flags());
        shape.word(link.parent.map_or(0, |p| 1 + p as u64));
        if link.joint.is_coupled() {
            let first = tree.links.iter().position(|other| other.row == link.row);
            shape.word(first.unwrap_or(k) as u64);
        }
        shape.link(link);
        shape.frame(frame, made_of);
        if needs_axes {
            shape.values(frame.axes.0.as_flattened());
            shape.values(&frame.origin.0);
        }
    }
    let whole = |[low, high]: [u64; 2]| u128::from(high) << 64 | u128::from(low);
    Exact {
        shape: whole(shape.halves),
        numbers: whole(shape.digits),
    }
}

/// The number of last digits that do not count, of 52 \[bit\].
const ROUNDED: u32 = 12;

/// Makes both halves depend on one more word.
fn mix([low, high]: &mut [u64; 2], word: u64) {
    // odd numbers without a pattern: of the golden ratio and of √2
    *low = (low.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    *high = (high.rotate_left(23) ^ word).wrapping_mul(0x6a09_e667_f3bc_c909);
    *high ^= *high >> 29;
}

struct Shape<'h> {
    halves: [u64; 2],
    /// The same of the digits of numbers.
    digits: [u64; 2],
    graph: &'h Graph,
    /// For each node, its number among those that were met, from 1; 0 if it was not.
    seen: Vec<u32>,
    count: u32,
    /// The sizes of the numbers that were met, each with its place among them and whether the first of this size was
    /// negative.
    numbers: FxHashMap<u64, (u64, bool)>,
}

impl Shape<'_> {
    fn word(&mut self, word: u64) {
        mix(&mut self.halves, word);
    }

    fn number(&mut self, number: f64) {
        mix(&mut self.digits, number.to_bits());
        let (size, negative) = (number.abs(), number < 0.0);
        let (class, opposite) = match size {
            0.0 => (0, false),
            1.0 => (1, negative),
            _ => {
                let next = 2 + self.numbers.len() as u64;
                // what differs in the last digits alone is equal but for rounding
                let digits = (size.to_bits() + (1 << (ROUNDED - 1))) >> ROUNDED;
                let entry = self.numbers.entry(digits);
                let (class, first) = *entry.or_insert((next, negative));
                (class, negative != first)
            }
        };
        self.word(4 * class + u64::from(opposite));
    }

    fn value(&mut self, value: Expr<'_>) {
        self.node(value.id());
    }

    fn node(&mut self, id: NodeId) {
        let node = self.graph.node(id);
        if let Node::Constant(bits) = node {
            return self.number(f64::from_bits(bits));
        }
        let at = id.0 as usize;
        if self.seen[at] > 0 {
            return self.word(4 * u64::from(self.seen[at]) + 2);
        }
        self.count += 1;
        self.seen[at] = self.count;
        let kind = match node {
            Node::Symbol(Symbol::Parameter(_)) => 0,
            Node::Symbol(_) => 1,
            Node::Neg(_) => 2,
            Node::Add(..) => 3,
            Node::Sub(..) => 4,
            Node::Mul(..) => 5,
            Node::Div(..) => 6,
            Node::Sqrt(_) => 7,
            Node::Sin(_) => 8,
            Node::Cos(_) => 9,
            // frames have no others; one would be equal to itself alone
            _ => {
                let mut hasher = FxHasher::default();
                node.hash(&mut hasher);
                hasher.finish() | 16
            }
        };
        self.word(4 * kind + 3);
        for operand in node.operands() {
            self.node(operand);
        }
    }

    fn values(&mut self, values: &[Expr<'_>]) {
        for &value in values {
            self.value(value);
        }
    }

    fn body(&mut self, body: &Body<'_>) {
        self.value(body.mass);
        self.values(&body.first.0);
        self.values(&body.second.diagonal);
        self.values(&body.second.off);
    }

    fn wrench(&mut self, wrench: &Wrench<'_>) {
        self.values(&wrench.force.0);
        self.values(&wrench.moment.0);
    }

    /// What the equations read of a link beside its frame.
    fn link(&mut self, link: &Link<'_>) {
        match &link.joint {
            LinkJoint::Ball {
                omega,
                bias,
                columns,
            } => {
                self.word(0);
                self.values(&omega.0);
                self.values(&bias.0);
                self.values(columns.0.as_flattened());
                self.values(link.rotation.0.as_flattened());
            }
            LinkJoint::Axis {
                axis: _,
                turn,
                slide,
                position,
                rate,
                acting,
                ratio,
                armature,
                acceleration,
                coupled,
                absolute,
            } => {
                self.word(1 + 2 * u64::from(*coupled) + 4 * u64::from(*absolute));
                self.number(*turn);
                self.values(&[*slide, *position, *rate, *acting, *ratio, *armature]);
                self.value(*acceleration);
            }
        }
        self.wrench(&link.load);
        match &link.carries {
            None => self.word(0),
            Some(Carried::Articulated(carried)) => {
                self.word(1);
                self.values(&carried.mass.diagonal);
                self.values(&carried.mass.off);
                self.values(carried.coupling.0.as_flattened());
                self.values(&carried.inertia.diagonal);
                self.values(&carried.inertia.off);
                self.wrench(&carried.bias);
            }
            Some(Carried::Composite {
                body,
                needed,
                columns,
            }) => {
                self.word(2 + columns.len() as u64);
                self.body(body);
                self.wrench(needed);
                for column in columns {
                    self.wrench(column);
                }
            }
        }
    }

    /// A link in its frame: the numbers that it is made of, and where they go. What the angles of aligned links make of
    /// these numbers is the same for all, but for signs.
    fn frame(&mut self, frame: &FramedLink<'_>, made_of: &MadeOf<'_>) {
        self.word(frame.turns.len() as u64);
        for turn in &frame.turns {
            match turn {
                Turn::Quarters(axis, quarters) => {
                    self.word(3 * u64::from(*quarters) + *axis as u64);
                }
                Turn::About { axis, sine, cosine } => match sine.as_constant() {
                    Some(_) => {
                        self.word(16 + *axis as u64);
                        self.values(&[*sine, *cosine]);
                    }
                    None => self.word(20 + *axis as u64),
                },
                Turn::Matrix(matrix) => {
                    self.word(32);
                    self.values(matrix.0.as_flattened());
                }
            }
        }
        let (quarters, rest) = made_of.offset;
        self.word(u64::from(quarters));
        self.number(rest);
        self.values(&made_of.constant.place.0);
        self.body(&made_of.constant.body);
        self.body(&made_of.in_reference);
        self.word(u64::from(frame.aligned));
        self.number(frame.sign);
        for entry in frame.against.as_flattened() {
            self.number(*entry);
        }
    }
}
