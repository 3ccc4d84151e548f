//! The articulated-body algorithm in the frames of links, relative to a reference motion.   \[Featherstone 2008, ch.
//! 7\]
//!
//! For accelerations Δ in addition to the reference motion, the bodies outboard of a joint need the wrench f = K Δa +
//! Bᵀ Δα + f₀, n = B Δa + J Δα + n₀. The joint has the column (z s, z t):
//!
//! | leaves to root | |
//! |---|---|
//! | U = (K z s + Bᵀ z t,  B z s + J z t) | D = s U_fz + t U_nz,  u = τ − s f_z − t n_z |
//! | (K, B, J) ← (K, B, J) − U Uᵀ / D | (f₀, n₀) ← (f₀, n₀) + U u / D |
//! | turned by X; moved by r: B' = B + r̂ K,  J' = J − B r̂ + r̂ B'ᵀ | n₀' = n₀ + r × f₀ |
//!
//! For a hinge the row and the column of z vanish in J and B, for a slider those in K and B, so 15 of 21 entries are
//! left. From the root to the leaves, Δa = Xᵀ (Δa_p + Δα_p × r), Δα = Xᵀ Δα_p, and q̈ = q̈ref + (u − U · (Δa, Δα)) / D.

use super::articulated_inertia::{Articulated, invariant};
use super::axis::Axis;
use super::frames::{Choice, Framed, FramedLink};
use super::motion::{LinkMotion, Reference, motion, steps};
use super::shared_velocities::{Shared, Velocity, elimination_links};
use super::tree::{Carried, Link, Tree};
use super::turn::back_through;
use super::wrench::Written;
use crate::dynamics::factorization::Ldl;
use crate::dynamics::spatial::Wrench;
use crate::expression::vector::{Mat3, Sym3, Vec3};
use crate::expression::{Expr, Graph};
use rustc_hash::FxHashMap;

/// The quantities of a joint that the pass outwards needs.
enum Eliminated<'g> {
    /// An axis, with E/D of each shared velocity that is not eliminated yet, by row.
    Axis(Box<Axis<'g>>, Vec<(usize, Expr<'g>)>),
    /// A joint that has a share of a shared velocity: t and s of its column, its share, and the row of the velocity.
    Share {
        turn: f64,
        slide: Expr<'g>,
        share: Expr<'g>,
        row: usize,
    },
    Ball {
        factors: Ldl<'g>,
        /// D⁻¹ L⁻¹ B, by rows
        coupling: Vec<Vec3<'g>>,
        /// −D⁻¹ L⁻¹ n₀
        bias: Vec<Expr<'g>>,
    },
    Base,
}

/// The accelerations of the joint of a link.
#[derive(Clone, Copy)]
pub struct Solved<'g> {
    /// For a ball α, in absolute axes; for an axis q̈, as the first component.
    pub rotation: Vec3<'g>,
    /// For a free base: the acceleration of its origin minus the field, in absolute axes.
    pub base: Vec3<'g>,
}

/// A shared velocity that is eliminated at a certain link.
struct SharedElimination<'g> {
    /// True if the joint of the link itself has a share of the velocity.
    own: bool,
    velocity: Velocity<'g>,
    inverse: Expr<'g>,
    /// D_rq of the velocities q that are eliminated later, by row.
    crossing: Vec<(usize, Expr<'g>)>,
}

/// The results of the pass inwards.
struct Inwards<'g> {
    eliminated: Vec<Eliminated<'g>>,
    /// For each link, the shared velocities that are eliminated there.
    shared: Vec<Vec<SharedElimination<'g>>>,
    outboard: Vec<Articulated<'g>>,
}

/// An articulated inertia and the rest of its way to the parent's origin.
#[derive(Clone, Copy)]
struct Passed<'g> {
    place: Vec3<'g>,
    what: Articulated<'g>,
}

/// The accelerations of all links. Each shared velocity must be eliminated at one of the [links](elimination_links).
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
    let motions = motion(tree, framed, choice, Reference::Chosen);
    let inwards = inwards(tree, framed, choice, &motions, name);
    outwards(tree, framed, choice, &motions, &inwards, name)
}

/// The pass from the leaves to the root.
fn inwards<'g>(
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    choice: &Choice,
    motions: &[LinkMotion<'g>],
    name: &dyn Fn(&Link<'g>) -> String,
) -> Inwards<'g> {
    let graph = tree.graph;
    let written = Written {
        tree,
        framed,
        choice,
    };
    let mut outboard: Vec<Articulated<'g>> = (0..tree.links.len())
        .map(|k| {
            graph.section(format!("element {}: forces", name(&tree.links[k])));
            own(tree, framed, choice, &motions[k], k)
        })
        .collect();
    let elimination_links = elimination_links(tree).unwrap_or_default();
    let mut waiting: Vec<Vec<Passed<'g>>> = vec![Vec::new(); tree.links.len()];
    let mut shared: Vec<Shared<'g>> = vec![Shared::default(); tree.links.len()];
    let (mut eliminated, mut ended) = (Vec::new(), Vec::new());
    for (k, link) in tree.links.iter().enumerate().rev() {
        graph.section(format!("element {}: elimination", name(link)));
        if let Some(Carried::Articulated(carried)) = &link.carries {
            outboard[k] = outboard[k].plus(carried);
        }
        give_constants(graph, k, tree, framed, &mut outboard);
        let group = std::mem::take(&mut waiting[k]);
        if !group.is_empty() {
            let order = (!framed.links[k].aligned).then_some(choice.links[k].order);
            outboard[k] = outboard[k].plus(&together(group, order));
        }
        let mut velocities = std::mem::take(&mut shared[k]);
        let (done, mut rest, here) = joint(
            &written,
            (k, &motions[k]),
            &elimination_links,
            &mut outboard[k],
            &mut velocities,
        );
        eliminated.push(done);
        ended.push(here);
        if let Some(parent) = link.parent {
            let frame = &framed.links[k];
            give_rest(graph, k, tree, framed, &mut rest, &mut outboard[parent]);
            if let Some(along) = written.along(k) {
                rest = rest.moved(along);
            }
            waiting[parent].push(Passed {
                place: frame.place,
                what: rest.turned(&frame.turns),
            });
            let passed =
                velocities.passed(|wrench| written.on_parent(k, parent, wrench).as_it_is());
            shared[parent].join(passed);
        }
    }
    eliminated.reverse();
    ended.reverse();
    Inwards {
        eliminated,
        shared: ended,
        outboard,
    }
}

/// Eliminates the joint of a link, after the shared velocities that end at this link. Returns the quantities for the
/// pass outwards, the remaining articulated inertia, and the shared velocities that ended here.
fn joint<'g>(
    written: &Written<'g, '_>,
    (k, motion): (usize, &LinkMotion<'g>),
    elimination_links: &[(usize, usize)],
    outboard: &mut Articulated<'g>,
    velocities: &mut Shared<'g>,
) -> (Eliminated<'g>, Articulated<'g>, Vec<SharedElimination<'g>>) {
    let (link, chosen) = (&written.tree.links[k], &written.choice.links[k]);
    let own_row = link.joint.is_coupled().then_some(link.row);
    let others = elimination_links
        .iter()
        .filter(|(row, link)| *link == k && Some(*row) != own_row);
    let others = others.filter_map(|(row, _)| end(outboard, velocities, *row, false));
    let mut here: Vec<SharedElimination<'g>> = others.collect();
    if link.parent.is_none() && written.tree.free {
        return (Eliminated::Base, *outboard, here);
    }
    if link.joint.is_ball() {
        let (done, rest) = outboard.without_ball();
        return (done, rest, here);
    }
    let (frame, unit) = (&written.framed.links[k], written.choice.unit);
    let axis = Axis::of(outboard, link, frame, unit, motion.reference);
    let powers = velocities.powers(|wrench| axis.power(wrench));
    if own_row.is_some() {
        let share = written.scaled_share(k);
        velocities.add(share, axis.velocity(link.row), &powers);
        if elimination_links.contains(&(link.row, k)) {
            here.extend(end(outboard, velocities, link.row, true));
        }
        let done = Eliminated::Share {
            turn: axis.turn,
            slide: axis.slide,
            share,
            row: link.row,
        };
        return (done, *outboard, here);
    }
    velocities.eliminate(&axis.needed, (axis.inverse, axis.left), &powers);
    let gains = powers.iter().map(|(row, e)| (*row, *e * axis.inverse));
    let gains = gains.collect();
    let rest = axis.rest(outboard, chosen.scales_bias);
    (Eliminated::Axis(Box::new(axis), gains), rest, here)
}

/// Eliminates a shared velocity; `None` if there is no such velocity at this link.
fn end<'g>(
    outboard: &mut Articulated<'g>,
    velocities: &mut Shared<'g>,
    row: usize,
    own: bool,
) -> Option<SharedElimination<'g>> {
    let (velocity, crossing) = velocities.take(row)?;
    let inverse = velocity.whole.recip();
    let needed = &velocity.needed;
    let gain = Wrench {
        force: inverse * needed.force,
        moment: inverse * needed.moment,
    };
    *outboard = outboard.less(needed, &gain, inverse, velocity.left, true);
    velocities.eliminate(needed, (inverse, velocity.left), &crossing);
    Some(SharedElimination {
        own,
        velocity,
        inverse,
        crossing,
    })
}

impl<'g> SharedElimination<'g> {
    /// v̇_r, given the accelerations of the link and the shared velocities that are already known.
    fn rate(&self, a: Vec3<'g>, alpha: Vec3<'g>, known: &FxHashMap<usize, Expr<'g>>) -> Expr<'g> {
        let Velocity { needed, left, .. } = &self.velocity;
        let others = self.crossing.iter();
        let left = others.fold(*left, |left, (row, d)| match known.get(row) {
            Some(rate) => left - *d * *rate,
            None => left,
        });
        (left - needed.moment.dot(alpha) - needed.force.dot(a)) * self.inverse
    }
}

/// The pass from the root to the leaves.
fn outwards<'g>(
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    choice: &Choice,
    motions: &[LinkMotion<'g>],
    inwards: &Inwards<'g>,
    name: &dyn Fn(&Link<'g>) -> String,
) -> Vec<Solved<'g>> {
    let mut pass = Outwards {
        written: Written {
            tree,
            framed,
            choice,
        },
        motions,
        inwards,
        moves: Vec::new(),
        known: FxHashMap::default(),
    };
    let of_link = |(k, link)| {
        tree.graph
            .section(format!("element {}: accelerations", name(link)));
        pass.solve(k)
    };
    tree.links.iter().enumerate().map(of_link).collect()
}

/// The state of the pass from the root to the leaves.
struct Outwards<'a, 'g> {
    written: Written<'g, 'a>,
    motions: &'a [LinkMotion<'g>],
    inwards: &'a Inwards<'g>,
    /// For each link so far: the acceleration of its origin and its angular acceleration relative to the reference
    /// motion, in its axes.
    moves: Vec<(Vec3<'g>, Vec3<'g>)>,
    /// v̇ of shared velocities, by row.
    known: FxHashMap<usize, Expr<'g>>,
}

impl<'g> Outwards<'_, 'g> {
    /// The accelerations of link `k`; its parent's are known.
    // Long: one `match`, an arm for each way in which a joint was eliminated.
    fn solve(&mut self, k: usize) -> Solved<'g> {
        let Written {
            tree,
            framed,
            choice,
        } = self.written;
        let (graph, link, frame) = (tree.graph, &tree.links[k], &framed.links[k]);
        let none = Vec3::zero(graph);
        let (mut a, mut alpha) = self.carried(k);
        let absolute = |v: Vec3<'g>| match frame.aligned {
            true => v,
            false => link.rotation.times(v),
        };
        let mut result = Solved {
            rotation: none,
            base: none,
        };
        match &self.inwards.eliminated[k] {
            Eliminated::Base if !link.joint.is_ball() => {
                (a, alpha) = self.inwards.outboard[k].floating_in_plane(graph);
                result.rotation.0[0] = frame.sign * alpha.0[2];
                result.base = choice.unit * frame.axes.times(a);
            }
            Eliminated::Base => {
                (a, alpha) = self.inwards.outboard[k].floating(graph);
                // for the origin of the joint, which is not that of the frame
                let back = Vec3(choice.base.map(|b| graph.constant(-b / choice.unit)));
                let turned = LinkMotion {
                    alpha,
                    ..self.motions[k]
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
            Eliminated::Axis(axis, gains) => {
                a = self.origin_acceleration(k, a, alpha);
                if link.joint.is_absolute() {
                    alpha = none;
                }
                let rate = axis.rate(a, alpha, choice.links[k].scales_rate);
                let rate = gains.iter().fold(rate, |rate, (row, gain)| {
                    let known = self.known.get(row);
                    known.map_or(rate, |other| rate - *gain * *other)
                });
                alpha = plus_along(alpha, axis.turn * rate);
                a = plus_along(a, axis.slide * rate);
                let unit = if axis.turn == 0.0 { choice.unit } else { 1.0 };
                let sign = frame.sign * unit;
                result.rotation.0[0] = sign * (rate + self.motions[k].reference);
            }
            Eliminated::Share {
                turn,
                slide,
                share,
                row,
            } => {
                a = self.origin_acceleration(k, a, alpha);
                let own = self.inwards.shared[k].iter().filter(|one| one.own);
                self.compute_rates(own, a, alpha);
                if let Some(&rate) = self.known.get(row) {
                    alpha = plus_along(alpha, *turn * (*share * rate));
                    a = plus_along(a, *slide * (*share * rate));
                    result.rotation.0[0] = rate;
                }
            }
        }
        // the shared velocities of which the joint of this link has no share; the one eliminated last comes first
        let others = self.inwards.shared[k].iter().filter(|one| !one.own);
        self.compute_rates(others.rev(), a, alpha);
        self.moves.push((a, alpha));
        result
    }

    /// The accelerations that a link has if its joint is at rest, in its axes.
    fn carried(&self, k: usize) -> (Vec3<'g>, Vec3<'g>) {
        let Written {
            tree,
            framed,
            choice,
        } = self.written;
        let Some(p) = tree.links[k].parent else {
            return (Vec3::zero(tree.graph), Vec3::zero(tree.graph));
        };
        let frame = &framed.links[k];
        let (a, alpha) = self.moves[p];
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

    /// The acceleration of the origin at the place to which a slider has moved it.
    fn origin_acceleration(&self, k: usize, a: Vec3<'g>, alpha: Vec3<'g>) -> Vec3<'g> {
        let along = self.written.along(k);
        along.map_or(a, |along| a + alpha.cross(along))
    }

    /// Computes the rates of shared velocities, in this order.
    fn compute_rates<'h>(
        &mut self,
        shared: impl Iterator<Item = &'h SharedElimination<'g>>,
        a: Vec3<'g>,
        alpha: Vec3<'g>,
    ) where
        'g: 'h,
    {
        for one in shared {
            let rate = one.rate(a, alpha, &self.known);
            self.known.insert(one.velocity.row, rate);
        }
    }
}

fn plus_along<'g>(v: Vec3<'g>, by: Expr<'g>) -> Vec3<'g> {
    Vec3([v.0[0], v.0[1], v.0[2] + by])
}

/// The articulated inertia of a link alone; its bias is the wrench that the body needs in the reference motion, minus
/// the wrench that acts on it.
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
    let needed = motion.inertia(&frame.in_reference, chosen.by_inertia);
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
    /// The wrench that acts on a link, about the origin of its frame and in its axes, in the unit of length.
    pub fn load(&self, link: &Link<'g>, choice: &Choice, base: bool) -> Wrench<'g> {
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

/// The parent of a link, if the link turns about z alone relative to the parent and neither of them is aligned.
fn is_plain_hinge(k: usize, tree: &Tree<'_>, framed: &Framed<'_>) -> Option<usize> {
    let parent = tree.links[k].parent?;
    (tree.links[k].joint.is_hinge() && !framed.links[k].aligned && !framed.links[parent].aligned)
        .then_some(parent)
}

/// Moves the invariant part of a link's own inertia to its parent.
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
        // for hinges, m and h_z are 0 after regrouping, so the invariant part is J alone
        outboard[k] = outboard[k].minus(&part);
        outboard[parent] = outboard[parent].plus(&part.by_constants(&framed.links[k]));
    }
}

/// Moves the invariant part of the remaining articulated inertia to the parent, if that part is constant.
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

/// The sum of the articulated inertias that several links pass on, moved to the origin of their parent axis by axis.
/// Inertias that have the same rest of the way are added before they are moved on.
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

impl<'g> Articulated<'g> {
    /// The articulated inertia that remains when the ball turns freely, so that no moment is passed on.
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
}
