//! The articulated-body algorithm in the frames of links, at a reference motion.   \[Featherstone 2008, ch. 7\]
//!
//! What is outboard of a joint answers accelerations Δ beyond the reference motion by f = K Δa + Bᵀ Δα + f₀, n = B Δa + J Δα + n₀. With the
//! column (z s, z t) of a joint,
//!
//! | leaves to root | |
//! |---|---|
//! | U = (K z s + Bᵀ z t,  B z s + J z t) | D = s U_fz + t U_nz,  u = τ − s f_z − t n_z |
//! | (K, B, J) ← (K, B, J) − U Uᵀ / D | (f₀, n₀) ← (f₀, n₀) + U u / D |
//! | turned by X; moved by r: B' = B + r̂ K,  J' = J − B r̂ + r̂ B'ᵀ | n₀' = n₀ + r × f₀ |
//!
//! Of a hinge row and column of z vanish in J and B, of a slider those of K and B: 15 entries are left of 21. Root to leaves,
//! Δa = Xᵀ (Δa_p + Δα_p × r), Δα = Xᵀ Δα_p, and q̈ = q̈ref + (u − U · (Δa, Δα)) / D.

use super::frames::{Choice, Framed, FramedLink, LinkChoice};
use super::motion::{LinkMotion, motion, slide, steps};
use super::tree::{Link, LinkJoint, Tree};
use super::turn::{Turn, back_through, through};
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph};
use crate::formalism::factorization::Ldl;
use crate::formalism::spatial::Wrench;

/// What is outboard of a joint.
#[derive(Clone, Copy)]
pub struct Articulated<'g> {
    /// K
    pub mass: Sym3<'g>,
    /// B
    pub coupling: Mat3<'g>,
    /// J
    pub inertia: Sym3<'g>,
    /// (f₀, n₀)
    pub bias: Wrench<'g>,
}

/// What the way outwards needs of a joint.
enum Eliminated<'g> {
    Axis(Axis<'g>),
    Ball {
        factors: Ldl<'g>,
        /// D⁻¹ L⁻¹ B, by rows
        coupling: Vec<Vec3<'g>>,
        /// −D⁻¹ L⁻¹ n₀
        bias: Vec<Expr<'g>>,
    },
    Base,
}

#[derive(Clone, Copy)]
struct Axis<'g> {
    /// t and s
    turn: f64,
    slide: Expr<'g>,
    /// U
    needed: Wrench<'g>,
    /// 1/D
    inverse: Expr<'g>,
    /// U/D
    gain: Wrench<'g>,
    /// u
    left: Expr<'g>,
}

/// What moves in a link.
#[derive(Clone, Copy)]
pub struct Solved<'g> {
    /// Of a ball α, absolute axes; of an axis q̈ in the first place.
    pub rotation: Vec3<'g>,
    /// Of a free base: the acceleration of its origin less the field, absolute axes.
    pub base: Vec3<'g>,
}

/// What is on its way to a parent.
#[derive(Clone, Copy)]
struct Passed<'g> {
    place: Vec3<'g>,
    what: Articulated<'g>,
}

/// The accelerations of all links.
pub fn accelerations<'g>(
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    choice: &Choice,
    name: &dyn Fn(&Link<'g>) -> String,
) -> Vec<Solved<'g>> {
    let graph = tree.graph;
    for link in &tree.links {
        graph.section(format!("element {}: reference motion", name(link)));
    }
    let motions = motion(tree, framed, choice);
    let mut outboard: Vec<Articulated<'g>> = (0..tree.links.len())
        .map(|k| {
            graph.section(format!("element {}: forces", name(&tree.links[k])));
            own(tree, framed, choice, &motions[k], k)
        })
        .collect();
    let mut waiting: Vec<Vec<Passed<'g>>> = vec![Vec::new(); tree.links.len()];
    let mut eliminated: Vec<Eliminated<'g>> = Vec::new();
    for k in (0..tree.links.len()).rev() {
        let (link, chosen) = (&tree.links[k], &choice.links[k]);
        graph.section(format!("element {}: elimination", name(link)));
        if let Some(carried) = &link.carries {
            outboard[k] = outboard[k].plus(carried);
        }
        give_constants(graph, k, tree, framed, &mut outboard);
        let group = std::mem::take(&mut waiting[k]);
        if !group.is_empty() {
            let order = match framed.links[k].aligned {
                true => None,
                false => Some(chosen.order),
            };
            outboard[k] = outboard[k].plus(&together(group, order));
        }
        if link.parent.is_none() && tree.free {
            eliminated.push(Eliminated::Base);
            continue;
        }
        let (done, mut rest) = match &link.joint {
            LinkJoint::Axis { .. } => {
                outboard[k].without_axis(link, &framed.links[k], choice, chosen)
            }
            LinkJoint::Ball { .. } => outboard[k].without_ball(),
        };
        eliminated.push(done);
        if let Some(parent) = link.parent {
            let frame = &framed.links[k];
            give_rest(graph, k, tree, framed, &mut rest, &mut outboard[parent]);
            if let Some((d, _)) = slide(&link.joint, choice.unit, frame.sign) {
                let mut along = Vec3::zero(graph);
                along.0[2] = d;
                rest = rest.moved(along);
            }
            waiting[parent].push(Passed {
                place: frame.place,
                what: rest.turned(&frame.turns),
            });
        }
    }
    eliminated.reverse();
    outwards(tree, framed, choice, &motions, &outboard, &eliminated, name)
}

/// Root to leaves.
fn outwards<'g>(
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    choice: &Choice,
    motions: &[LinkMotion<'g>],
    outboard: &[Articulated<'g>],
    eliminated: &[Eliminated<'g>],
    name: &dyn Fn(&Link<'g>) -> String,
) -> Vec<Solved<'g>> {
    let graph = tree.graph;
    let none = Vec3::zero(graph);
    let mut moves: Vec<(Vec3<'g>, Vec3<'g>)> = Vec::new();
    let mut solved = Vec::new();
    for (k, link) in tree.links.iter().enumerate() {
        graph.section(format!("element {}: accelerations", name(link)));
        let frame = &framed.links[k];
        let (mut a, mut alpha) = match link.parent {
            None => (none, none),
            Some(p) => {
                let (a, alpha) = moves[p];
                let places = match framed.links[p].aligned {
                    true => vec![frame.place],
                    false => steps(frame.place, choice.links[p].order),
                };
                let at = places.into_iter().rev().fold(a, |a, r| a + alpha.cross(r));
                (
                    back_through(&frame.turns, at),
                    back_through(&frame.turns, alpha),
                )
            }
        };
        let absolute = |v: Vec3<'g>| match frame.aligned {
            true => v,
            false => link.rotation.times(v),
        };
        let mut result = Solved {
            rotation: none,
            base: none,
        };
        match &eliminated[k] {
            Eliminated::Base => {
                (a, alpha) = outboard[k].floating(graph);
                // of the joint, where the origin is not
                let back = Vec3(choice.base.map(|b| graph.constant(-b / choice.unit)));
                let turned = LinkMotion {
                    alpha,
                    ..motions[k]
                };
                let at_joint = choice.unit * (a + turned.gamma(back));
                result.rotation = absolute(alpha);
                result.base = absolute(at_joint);
            }
            Eliminated::Ball {
                factors,
                coupling,
                bias,
            } => {
                let rest = bias.iter().zip(coupling).map(|(b, row)| *b - row.dot(a));
                let rates = factors.backward(rest.collect());
                alpha = Vec3([rates[0], rates[1], rates[2]]);
                result.rotation = absolute(alpha);
            }
            Eliminated::Axis(axis) => {
                if let Some((d, _)) = slide(&link.joint, choice.unit, frame.sign) {
                    let mut along = none;
                    along.0[2] = d;
                    a = a + alpha.cross(along);
                }
                let rate = axis.rate(a, alpha, choice.links[k].scales_rate);
                let along = |v: Vec3<'g>, by: Expr<'g>| Vec3([v.0[0], v.0[1], v.0[2] + by]);
                alpha = along(alpha, axis.turn * rate);
                a = along(a, axis.slide * rate);
                let unit = if axis.turn == 0.0 { choice.unit } else { 1.0 };
                let sign = frame.sign * unit;
                result.rotation.0[0] = sign * (rate + motions[k].reference);
            }
        }
        moves.push((a, alpha));
        solved.push(result);
    }
    solved
}

/// What a link's own body needs, less what acts on it.
fn own<'g>(
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    choice: &Choice,
    motion: &LinkMotion<'g>,
    k: usize,
) -> Articulated<'g> {
    let graph = tree.graph;
    let (link, frame, chosen) = (&tree.links[k], &framed.links[k], &choice.links[k]);
    let body = &frame.body;
    let zero = graph.constant(0.0);
    let [x, y, z] = body.first.0;
    let mut mass = Sym3::zero(graph);
    mass.diagonal = [body.mass; 3];
    let needed = motion.inertia(body, chosen.by_inertia);
    let load = frame.load(link, choice, k == 0 && tree.free);
    Articulated {
        mass,
        coupling: Mat3([[zero, -z, y], [z, zero, -x], [-y, x, zero]]),
        inertia: body.inertia(),
        bias: Wrench {
            force: needed.force - load.force,
            moment: needed.moment - load.moment,
        },
    }
}

impl<'g> FramedLink<'g> {
    /// What acts on a link, about the origin of its frame and in its axes, in the unit of length.
    fn load(&self, link: &Link<'g>, choice: &Choice, base: bool) -> Wrench<'g> {
        let force = choice.unit * self.axes.transposed_times(link.load.force);
        let moment = self.axes.transposed_times(link.load.moment);
        let shift = match base {
            true => Vec3(
                choice
                    .base
                    .map(|b| force.0[0].graph().constant(b / choice.unit)),
            ),
            false => self.origin,
        };
        Wrench {
            force,
            moment: moment - shift.cross(force),
        }
    }
}

/// What passes through a turn about z unchanged and is not felt by it, as numbers: K diag(k, k, k'), J diag(j, j, 0),
/// B [[b, −t, 0], [t, b, 0], 0].
fn invariant<'g>(graph: &'g Graph, of: &Articulated<'g>, third: bool) -> Option<Articulated<'g>> {
    let constant = |e: Expr<'g>| e.as_constant().is_some();
    let zero = graph.constant(0.0);
    let (k, j) = (of.mass.diagonal[1], of.inertia.diagonal[1]);
    let (b, t) = (of.coupling.0[1][1], of.coupling.0[1][0]);
    if ![k, j, b, t].into_iter().all(constant) {
        return None;
    }
    let k3 = of.mass.diagonal[2];
    let k3 = if third && constant(k3) { k3 } else { zero };
    let mut part = Articulated {
        mass: Sym3::zero(graph),
        coupling: Mat3([[b, -t, zero], [t, b, zero], [zero; 3]]),
        inertia: Sym3::zero(graph),
        bias: Wrench::none(graph),
    };
    part.mass.diagonal = [k, k, k3];
    part.inertia.diagonal = [j, j, zero];
    let nothing = [k, j, b, t, k3].into_iter().all(|e| e.is_zero());
    (!nothing).then_some(part)
}

/// Whether a link turns about z alone against a parent, neither of which keeps other axes.
fn is_plain_hinge(k: usize, tree: &Tree<'_>, framed: &Framed<'_>) -> Option<usize> {
    let parent = tree.links[k].parent?;
    (tree.links[k].joint.is_hinge() && !framed.links[k].aligned && !framed.links[parent].aligned)
        .then_some(parent)
}

/// Gives the parent the invariant part of a link's own inertia.
fn give_constants<'g>(
    graph: &'g Graph,
    k: usize,
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    outboard: &mut [Articulated<'g>],
) {
    let Some(parent) = is_plain_hinge(k, tree, framed) else {
        return;
    };
    if let Some(part) = invariant(graph, &outboard[k], true) {
        // h_z = 0 and m = 0 of hinges: only J is left
        outboard[k] = outboard[k].minus(&part);
        outboard[parent] = outboard[parent].plus(&part.by_constants(&framed.links[k]));
    }
}

/// Gives the parent the invariant part of what is left, where that is constant.
fn give_rest<'g>(
    graph: &'g Graph,
    k: usize,
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    rest: &mut Articulated<'g>,
    parent: &mut Articulated<'g>,
) {
    if is_plain_hinge(k, tree, framed).is_none() {
        return;
    }
    let constant = |e: Expr<'g>| e.as_constant().is_some();
    let all = [
        rest.mass.diagonal[0],
        rest.mass.off[2],
        rest.inertia.diagonal[0],
        rest.coupling.0[0][0],
        rest.coupling.0[0][1],
    ];
    if !all.into_iter().all(constant) {
        return;
    }
    if let Some(part) = invariant(graph, rest, true) {
        *rest = rest.minus(&part);
        *parent = parent.plus(&part.by_constants(&framed.links[k]));
    }
}

/// What several links pass on, moved to the origin of their parent: axis by axis, those with the same rest of the way together.
fn together<'g>(mut group: Vec<Passed<'g>>, order: Option<[usize; 3]>) -> Articulated<'g> {
    let graph = group[0].place.0[0].graph();
    let axes: Vec<Option<usize>> = match order {
        Some(order) => order.map(Some).to_vec(),
        None => vec![None],
    };
    for axis in axes {
        let mut next: Vec<Passed<'g>> = Vec::new();
        for passed in group {
            let (mut step, mut rest) = (passed.place, Vec3::zero(graph));
            if let Some(axis) = axis {
                (step, rest) = (rest, step);
                step.0[axis] = rest.0[axis];
                rest.0[axis] = graph.constant(0.0);
            }
            let what = passed.what.moved(step);
            let same =
                |other: &&mut Passed<'g>| (0..3).all(|i| other.place.0[i].id() == rest.0[i].id());
            match next.iter_mut().find(same) {
                Some(other) => other.what = other.what.plus(&what),
                None => next.push(Passed { place: rest, what }),
            }
        }
        group = next;
    }
    let mut sums = group.into_iter().map(|passed| passed.what);
    let first = sums.next();
    sums.fold(first.unwrap_or_else(|| Articulated::none(graph)), |a, b| {
        a.plus(&b)
    })
}

impl<'g> Axis<'g> {
    /// q̈ beyond the reference motion.
    fn rate(&self, a: Vec3<'g>, alpha: Vec3<'g>, scales_rate: bool) -> Expr<'g> {
        let zero = self.left.graph().constant(0.0);
        // of a pure hinge α_z meets D/D = 1, of a slider a_z
        let hinge = self.turn != 0.0 && self.slide.is_zero();
        let slider = self.turn == 0.0;
        let plain = match (hinge, slider) {
            (true, _) => alpha.0[2],
            (_, true) => a.0[2],
            _ => zero,
        };
        let (mut a, mut alpha) = (a, alpha);
        if hinge {
            alpha.0[2] = zero;
        }
        if slider {
            a.0[2] = zero;
        }
        let rate = match scales_rate {
            true => {
                let gain = &self.gain;
                self.left * self.inverse - gain.moment.dot(alpha) - gain.force.dot(a)
            }
            false => {
                let needed = &self.needed;
                (self.left - needed.moment.dot(alpha) - needed.force.dot(a)) * self.inverse
            }
        };
        rate - plain
    }
}

impl<'g> Articulated<'g> {
    fn none(graph: &'g Graph) -> Self {
        let zero = graph.constant(0.0);
        Articulated {
            mass: Sym3::zero(graph),
            coupling: Mat3([[zero; 3]; 3]),
            inertia: Sym3::zero(graph),
            bias: Wrench::none(graph),
        }
    }

    fn combined(&self, other: &Self, of: impl Fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> Self {
        let symmetric =
            |a: &Sym3<'g>, b: &Sym3<'g>| Sym3::from_fn(|i, j| of(a.entry(i, j), b.entry(i, j)));
        let vector = |a: Vec3<'g>, b: Vec3<'g>| Vec3([0, 1, 2].map(|i| of(a.0[i], b.0[i])));
        Articulated {
            mass: symmetric(&self.mass, &other.mass),
            coupling: Mat3(
                [0, 1, 2]
                    .map(|i| [0, 1, 2].map(|j| of(self.coupling.0[i][j], other.coupling.0[i][j]))),
            ),
            inertia: symmetric(&self.inertia, &other.inertia),
            bias: Wrench {
                force: vector(self.bias.force, other.bias.force),
                moment: vector(self.bias.moment, other.bias.moment),
            },
        }
    }

    fn plus(&self, other: &Self) -> Self {
        self.combined(other, |a, b| a + b)
    }

    fn minus(&self, other: &Self) -> Self {
        self.combined(other, |a, b| a - b)
    }

    /// In the parent's axes.
    fn turned(&self, turns: &[Turn<'g>]) -> Self {
        let mut turned = *self;
        for turn in turns {
            turned.mass = turn.symmetric(turned.mass);
            turned.inertia = turn.symmetric(turned.inertia);
            turned.coupling = turn.general(turned.coupling);
        }
        turned.bias = Wrench {
            force: through(turns, self.bias.force),
            moment: through(turns, self.bias.moment),
        };
        turned
    }

    /// Through the constant part of a link's joint to the parent's origin.
    fn by_constants(&self, frame: &FramedLink<'g>) -> Self {
        let graph = self.mass.diagonal[0].graph();
        let matrix = Mat3(frame.against.map(|row| row.map(|a| graph.constant(a))));
        let congruent = |m: Mat3<'g>| matrix.product(&m).product(&matrix.transposed());
        let full = |m: &Sym3<'g>| Mat3([0, 1, 2].map(|i| [0, 1, 2].map(|j| m.entry(i, j))));
        let symmetric = |m: &Sym3<'g>| {
            let turned = congruent(full(m));
            Sym3::from_fn(|i, j| turned.0[i][j])
        };
        let turned = Articulated {
            mass: symmetric(&self.mass),
            coupling: congruent(self.coupling),
            inertia: symmetric(&self.inertia),
            bias: self.bias,
        };
        turned.cleaned().moved(frame.place)
    }

    /// Constants without what only rounding has left.
    fn cleaned(&self) -> Self {
        let entries = |m: &Mat3<'g>| m.0.iter().flatten().copied().collect::<Vec<_>>();
        let full = |m: &Sym3<'g>| m.diagonal.iter().chain(&m.off).copied().collect::<Vec<_>>();
        let scale = |values: Vec<Expr<'g>>| {
            let constants = values.into_iter().filter_map(|e| e.as_constant());
            4e-15 * constants.fold(0.0, |m: f64, c| m.max(c.abs()))
        };
        let clean = |e: Expr<'g>, scale: f64| match e.as_constant() {
            Some(c) if c.abs() <= scale => e.graph().constant(0.0),
            _ => e,
        };
        let symmetric = |m: &Sym3<'g>| {
            let scale = scale(full(m));
            Sym3::from_fn(|i, j| clean(m.entry(i, j), scale))
        };
        let coupling = scale(entries(&self.coupling));
        Articulated {
            mass: symmetric(&self.mass),
            coupling: Mat3(self.coupling.0.map(|row| row.map(|e| clean(e, coupling)))),
            inertia: symmetric(&self.inertia),
            bias: self.bias,
        }
    }

    /// As felt at an origin from which its own is at r.
    fn moved(&self, r: Vec3<'g>) -> Self {
        if r.is_zero() {
            return *self;
        }
        // B' = B + r̂ K
        let columns = [0, 1, 2].map(|j| {
            let column = Vec3([0, 1, 2].map(|i| self.mass.entry(i, j)));
            self.coupling.column(j) + r.cross(column)
        });
        let coupling = Mat3::from_columns(columns);
        // J' = J − B r̂ + r̂ B'ᵀ: by axis of r, so that every product is made once
        let inertia = Sym3::from_fn(|i, j| {
            (0..3).fold(self.inertia.entry(i, j), |sum, k| {
                if r.0[k].is_zero() {
                    return sum;
                }
                let zero = r.0[k].graph().constant(0.0);
                let mut factor = zero;
                for b in 0..3 {
                    // (e_k ×)_{jb} B_ib and (e_k ×)_{ib} B'_jb
                    factor = added(factor, permutation(j, k, b), self.coupling.0[i][b]);
                    factor = added(factor, permutation(i, k, b), coupling.0[j][b]);
                }
                sum + r.0[k] * factor
            })
        });
        Articulated {
            mass: self.mass,
            coupling,
            inertia,
            bias: Wrench {
                force: self.bias.force,
                moment: self.bias.moment + r.cross(self.bias.force),
            },
        }
    }

    /// What is left when the coordinate of an axis follows.
    fn without_axis(
        &self,
        link: &Link<'g>,
        frame: &FramedLink<'g>,
        choice: &Choice,
        chosen: &LinkChoice,
    ) -> (Eliminated<'g>, Self) {
        let LinkJoint::Axis {
            turn,
            slide,
            acting,
            ..
        } = link.joint
        else {
            unreachable!("only axes are eliminated as such")
        };
        let graph = acting.graph();
        let zero = graph.constant(0.0);
        let unit = choice.unit;
        // what acts on a slider is a force, in the unit of length
        let (slide, acting) = match turn == 0.0 {
            true => (slide, unit * acting),
            false => ((1.0 / unit) * slide, acting),
        };
        let acting = frame.sign * acting;
        let z = |m: &Sym3<'g>| Vec3([m.entry(0, 2), m.entry(1, 2), m.entry(2, 2)]);
        let needed = Wrench {
            force: slide * z(&self.mass) + turn * Vec3(self.coupling.0[2]),
            moment: slide * self.coupling.column(2) + turn * z(&self.inertia),
        };
        let whole = slide * needed.force.0[2] + turn * needed.moment.0[2];
        let inverse = whole.recip();
        let gain = Wrench {
            force: inverse * needed.force,
            moment: inverse * needed.moment,
        };
        let left = acting - slide * self.bias.force.0[2] - turn * self.bias.moment.0[2];
        let axis = Axis {
            turn,
            slide,
            needed,
            inverse,
            gain,
            left,
        };
        let mut rest = *self;
        let (u, g) = (&needed, &gain);
        rest.mass = Sym3::from_fn(|i, j| self.mass.entry(i, j) - u.force.0[i] * g.force.0[j]);
        rest.inertia =
            Sym3::from_fn(|i, j| self.inertia.entry(i, j) - u.moment.0[i] * g.moment.0[j]);
        for i in 0..3 {
            for j in 0..3 {
                let product = u.moment.0[i] * g.force.0[j];
                rest.coupling.0[i][j] = self.coupling.0[i][j] - product;
            }
        }
        rest.bias = match chosen.scales_bias {
            true => {
                let scaled = left * inverse;
                Wrench {
                    force: self.bias.force + scaled * u.force,
                    moment: self.bias.moment + scaled * u.moment,
                }
            }
            false => Wrench {
                force: self.bias.force + left * g.force,
                moment: self.bias.moment + left * g.moment,
            },
        };
        if turn != 0.0 && slide.is_zero() {
            // the row and the column of the turn vanish, and the moment is what acts
            for i in 0..3 {
                rest.coupling.0[2][i] = zero;
            }
            rest.inertia = Sym3::from_fn(|i, j| match i == 2 || j == 2 {
                true => zero,
                false => rest.inertia.entry(i, j),
            });
            rest.bias.moment.0[2] = acting;
        } else if turn == 0.0 {
            for i in 0..3 {
                rest.coupling.0[i][2] = zero;
            }
            rest.mass = Sym3::from_fn(|i, j| match i == 2 || j == 2 {
                true => zero,
                false => rest.mass.entry(i, j),
            });
            rest.bias.force.0[2] = acting;
        }
        (Eliminated::Axis(axis), rest)
    }

    /// What is left when the element turns at will: no moment passes.
    fn without_ball(&self) -> (Eliminated<'g>, Self) {
        let graph = self.mass.diagonal[0].graph();
        let inertia = &self.inertia;
        let lower = (0..3).map(|i| (0..=i).map(|j| inertia.entry(i, j)).collect());
        let factors = Ldl::of(graph, lower.collect());
        let half = factors.forward(self.coupling.0.map(Vec3).to_vec());
        let coupling = factors.scale(&half);
        let moment = factors.forward(self.bias.moment.0.map(|n| -n).to_vec());
        let bias = factors.scale(&moment);
        let mut rest = Articulated {
            bias: Wrench {
                force: self.bias.force,
                moment: Vec3::zero(graph),
            },
            ..Articulated::none(graph)
        };
        rest.mass = Sym3::from_fn(|i, j| {
            let rows = half.iter().zip(&coupling);
            rows.fold(self.mass.entry(i, j), |sum, (y, z)| sum - y.0[i] * z.0[j])
        });
        for (y, b) in half.iter().zip(&bias) {
            rest.bias.force = rest.bias.force + *b * *y;
        }
        let done = Eliminated::Ball {
            factors,
            coupling,
            bias,
        };
        (done, rest)
    }

    /// Δa and Δα where nothing holds it.
    fn floating(&self, graph: &'g Graph) -> (Vec3<'g>, Vec3<'g>) {
        let entry = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, true) => self.mass.entry(i, j),
            (false, true) => self.coupling.0[i - 3][j],
            (true, false) => self.coupling.0[j - 3][i],
            (false, false) => self.inertia.entry(i - 3, j - 3),
        };
        let lower = (0..6).map(|i| (0..=i).map(|j| entry(i, j)).collect());
        let right = self.bias.force.0.iter().chain(&self.bias.moment.0);
        let right = right.map(|f| -*f).collect();
        let x = Ldl::of(graph, lower.collect()).solve(right);
        (Vec3([x[0], x[1], x[2]]), Vec3([x[3], x[4], x[5]]))
    }
}

/// The entry (i, j) of e_k ×.
fn permutation(i: usize, k: usize, j: usize) -> i8 {
    match ((j + 3 - i) % 3, i == j || j == k || i == k) {
        (_, true) => 0,
        // (e_z ×)_xy = −1
        (1, _) => -1,
        _ => 1,
    }
}

fn added<'g>(sum: Expr<'g>, sign: i8, term: Expr<'g>) -> Expr<'g> {
    match sign {
        1 => sum + term,
        -1 => sum - term,
        _ => sum,
    }
}
