//! A part of a tree for the trial of one link: the links near it, with unknowns in place of the others.

use super::{Aim, FAR, NEAR, Search, unsigned};
use crate::dynamics::link::articulated_inertia::Articulated;
use crate::dynamics::link::body::Body;
use crate::dynamics::link::frames::{Choice, Framed, Matrix, origin_of, turned_axes};
use crate::dynamics::link::motion::{Reference, motion};
use crate::dynamics::link::tree::{Carried, Link, LinkJoint, Tree, identity};
use crate::dynamics::link::wrench::Written;
use crate::dynamics::link::{forces, mass_matrix};
use crate::dynamics::spatial::Wrench;
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph, Symbol};

/// A part of a tree for the trial of one link.
pub struct Part<'h> {
    pub tree: Tree<'h>,
    pub natural: Vec<(Matrix, f64)>,
    pub choice: Choice,
    /// For each link of the part, its index in the whole tree; `None` for the link that stands for all links that
    /// carry the part.
    pub of: Vec<Option<usize>>,
}

impl<'h> Part<'h> {
    /// The part in its frames, the index of link k of the whole tree in the part, and the indices of its children
    /// there.
    pub fn framed(&self, k: usize) -> (Framed<'h>, usize, Vec<usize>) {
        let framed = Framed::in_trial(&self.tree, &self.natural, &self.choice);
        let at = self.of.iter().position(|of| *of == Some(k)).unwrap_or(0);
        let links = self.tree.links.iter().enumerate();
        let children = links.filter(|(_, link)| link.parent == Some(at));
        let children = children.map(|(c, _)| c).collect();
        (framed, at, children)
    }
}

impl<'g> Search<'_, 'g> {
    /// The whole tree in a graph of its own, with its inputs as symbols.
    pub fn opened<'h>(&self, graph: &'h Graph) -> Tree<'h> {
        self.tree.map(graph, |e| self.symbol(graph, e))
    }

    fn symbol<'h>(&self, graph: &'h Graph, e: Expr<'g>) -> Expr<'h> {
        if let Some(constant) = e.as_constant() {
            return graph.constant(constant);
        }
        let (negative, id) = unsigned(e);
        let (varies, number) = self.inputs[id.0 as usize].expect("the tree has this node");
        let symbol = match varies {
            true => Symbol::Coordinate(number),
            false => Symbol::Parameter(number),
        };
        match negative {
            true => -graph.symbol(symbol),
            false => graph.symbol(symbol),
        }
    }

    /// The links around k, in the order of the tree, and the one that carries the others.
    pub fn near(&self, k: usize, choice: &Choice) -> (Vec<usize>, usize) {
        let mut chosen = vec![k];
        chosen.extend(&self.children[k]);
        let mut next = 1;
        while chosen.len() < NEAR && next < chosen.len() {
            chosen.extend(&self.children[chosen[next]]);
            next += 1;
        }
        let mut top = k;
        while let Some(parent) = self.tree.links[top].parent
            // a link that keeps its axes is turned together with its carrier
            && (top == k
                || chosen.len() < NEAR
                || (chosen.len() < FAR && choice.links[parent].aligned))
        {
            top = parent;
            chosen.push(top);
        }
        chosen.sort_unstable();
        (chosen, top)
    }

    /// The links around k: its parent, its children and further links behind them, with unknowns in place of the
    /// others.
    pub fn around<'h>(&self, graph: &'h Graph, k: usize, choice: &Choice) -> Part<'h> {
        let links = &self.tree.links;
        let (chosen, top) = self.near(k, choice);
        // indices above those of all inputs
        let mut unknowns = self.symbols;
        let mut unknown = || {
            unknowns += 1;
            graph.symbol(Symbol::Coordinate(unknowns))
        };
        let mut part = Part {
            tree: Tree {
                graph,
                links: Vec::new(),
                ground: self.tree.ground.map(|e| self.symbol(graph, e)),
                free: self.tree.free,
                base: None,
                directions: self.tree.directions,
                carrier: None,
            },
            natural: Vec::new(),
            choice: Choice {
                links: Vec::new(),
                base: choice.base,
                unit: choice.unit,
            },
            of: Vec::new(),
        };
        let mut vector = || Vec3([unknown(), unknown(), unknown()]);
        if let Some(carrier) = links[top].parent {
            part.tree.links.push(unknown_link(graph, &mut vector));
            part.of.push(None);
            part.tree.free = true;
            part.tree.carrier = Some([vector(), vector(), vector()]);
            part.tree.ground.angle = vector().0[0];
            let (natural, _) = &self.natural[carrier];
            let turn = choice.links[carrier].turn;
            part.natural.push((turned_axes(natural, turn), 1.0));
            part.choice.links.extend(Choice::plain(1).links);
            part.choice.links[0].order = choice.links[carrier].order;
            // the origin of the carrier's frame
            part.choice.base = origin_of(self.tree, &self.natural, choice, carrier);
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
            let children = self.children[link].iter().copied();
            let left_out: Vec<usize> = children.filter(|c| !chosen.contains(c)).collect();
            if !left_out.is_empty() {
                own.carries = Some(match self.aim {
                    Aim::Elimination => unknown_articulated(&mut vector),
                    Aim::Matrices | Aim::Factorization | Aim::InverseDynamics => {
                        self.unknown_composite(&left_out, &mut vector)
                    }
                });
            }
            part.of.push(Some(link));
            part.tree.links.push(own);
            part.natural.push(self.natural[link]);
            let mut own = choice.links[link].clone();
            own.keep = own.keep.and_then(|(child, axis)| {
                let at = chosen.iter().position(|&c| c == child)?;
                Some((first + at, axis))
            });
            part.choice.links.push(own);
        }
        part
    }

    /// Unknowns for S and forces, in place of what the omitted links and the links that they carry pass on.
    fn unknown_composite<'h>(
        &self,
        left_out: &[usize],
        vector: &mut impl FnMut() -> Vec3<'h>,
    ) -> Carried<'h> {
        let links = &self.tree.links;
        let columns: usize = left_out.iter().map(|&c| self.columns[c]).sum();
        let (first, diagonal, off) = (vector(), vector().0, vector().0);
        let mut body = Body::none(first.0[0].graph());
        // a ball passes no moment, and a hinge no mass of regrouped bodies
        if left_out.iter().any(|&c| !links[c].joint.is_absolute()) {
            (body.first, body.second) = (first, Sym3 { diagonal, off });
        }
        if left_out
            .iter()
            .any(|&c| !links[c].joint.is_ball() && !links[c].joint.is_hinge())
        {
            body.mass = vector().0[0];
        }
        let mut wrench = || Wrench {
            force: vector(),
            moment: vector(),
        };
        Carried::Composite {
            body,
            needed: wrench(),
            columns: (0..columns).map(|_| wrench()).collect(),
        }
    }

    /// Some of the links, in a graph of their own.
    fn opened_part<'h>(&self, graph: &'h Graph, chosen: &[usize]) -> Tree<'h> {
        let part = Tree {
            graph: self.tree.graph,
            links: chosen.iter().map(|&k| self.tree.links[k].clone()).collect(),
            ground: self.tree.ground,
            free: self.tree.free,
            base: None,
            directions: self.tree.directions,
            carrier: None,
        };
        part.map(graph, |e| self.symbol(graph, e))
    }
}

/// S and the forces of a part of a tree.
pub fn matrices<'h>(part: &Part<'h>, framed: &Framed<'h>, reference: Reference) -> Vec<Expr<'h>> {
    let written = Written {
        tree: &part.tree,
        framed,
        choice: &part.choice,
    };
    let name = |_: usize| String::new();
    let composites = mass_matrix::composites(&written);
    let entries = mass_matrix::mass_matrix(&written, &composites, &name);
    let motions = motion(&part.tree, framed, &part.choice, reference);
    let needed = forces::needed(&written, &motions);
    let powers = forces::powers(&written, needed, &name);
    let mut roots: Vec<Expr<'h>> = entries.terms.iter().map(|(.., value)| *value).collect();
    roots.extend(powers.terms.iter().map(|(_, force)| *force));
    for wrench in entries.passed.iter().chain(&powers.passed) {
        roots.extend(wrench.force.0.iter().chain(&wrench.moment.0));
    }
    for (motion, link) in motions.iter().zip(&part.tree.links) {
        if reference != Reference::Rest && !link.joint.is_ball() {
            roots.push(motion.reference);
        }
    }
    if part.tree.carrier.is_some() {
        let Body { first, second, .. } = composites[0];
        roots.extend(first.0.into_iter().chain(second.diagonal).chain(second.off));
    }
    roots
}

/// The forces that a part of a tree needs.
pub fn needed<'h>(part: &Part<'h>, framed: &Framed<'h>) -> Vec<Expr<'h>> {
    let written = Written {
        tree: &part.tree,
        framed,
        choice: &part.choice,
    };
    let motions = motion(&part.tree, framed, &part.choice, Reference::Rest);
    let needed = forces::needed(&written, &motions);
    let powers = forces::powers(&written, needed, &|_| String::new());
    let mut roots: Vec<Expr<'h>> = powers.terms.iter().map(|(_, force)| *force).collect();
    for wrench in &powers.passed {
        roots.extend(wrench.force.0.iter().chain(&wrench.moment.0));
    }
    roots
}

/// Unknowns for accelerations, in place of what omitted links pass on.
fn unknown_articulated<'h>(vector: &mut impl FnMut() -> Vec3<'h>) -> Carried<'h> {
    let mut six = || Sym3 {
        diagonal: vector().0,
        off: vector().0,
    };
    let (mass, inertia) = (six(), six());
    Carried::Articulated(Articulated {
        mass,
        coupling: Mat3([vector().0, vector().0, vector().0]),
        inertia,
        bias: Wrench {
            force: vector(),
            moment: vector(),
        },
    })
}

/// The link that stands for all links that carry a part.
fn unknown_link<'h>(graph: &'h Graph, vector: &mut impl FnMut() -> Vec3<'h>) -> Link<'h> {
    Link {
        element: usize::MAX,
        row: 0,
        parent: None,
        joint: LinkJoint::Ball {
            omega: vector(),
            bias: Vec3::zero(graph),
            columns: identity(graph),
        },
        place: Vec3::zero(graph),
        body: Body::none(graph),
        rotation: Mat3([vector().0, vector().0, vector().0]),
        load: Wrench::none(graph),
        carries: None,
    }
}
