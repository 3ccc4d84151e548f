//! The reference motion: any motion that the joints allow at the given velocities, in the frames of the links.
//!
//! It goes from the root to the leaves. X is the rotation from the axes of a link to its parent's, and r the place of
//! the link there:
//!
//! | | |
//! |---|---|
//! | ω = Xᵀ ω_p + z q̇ | α⁰ = Xᵀ α⁰_p + (ω_y, −ω_x, 0) q̇ + z q̈ref |
//! | a⁰ = Xᵀ (a⁰_p + Γ_p r) | Γ = α̂⁰ + ω̂ ω̂:  Γ_ij = ω_i ω_j ∓ α⁰_k,  Γ_ii = −(ω_j² + ω_k²) |
//! | along a slide d = z s q: a⁰ += Γ d + 2 ω × z s q̇ + z s q̈ref | with ω and α⁰ before the turn about z |
//!
//! q̈ref is chosen such that α⁰_z, or a⁰_z of a slider, costs the fewest operations; mostly these are 0. On a ball α⁰ =
//! 0, and for a free base a⁰ = 0, so that a field need not be turned from link to link.

use super::body::Body;
use super::frames::{Choice, Framed, ReferenceTurn};
use super::tree::{LinkJoint, Tree};
use super::turn::back_through;
use crate::dynamics::spatial::Wrench;
use crate::expression::Expr;
use crate::expression::vector::Vec3;

/// The reference motion of a link, in its axes.
#[derive(Clone, Copy)]
pub struct LinkMotion<'g> {
    /// ω
    pub omega: Vec3<'g>,
    /// α⁰
    pub alpha: Vec3<'g>,
    /// a⁰, the acceleration of its origin
    pub acceleration: Vec3<'g>,
    /// q̈ref
    pub reference: Expr<'g>,
}

impl<'g> LinkMotion<'g> {
    /// Γ_ij
    fn gamma_entry(&self, i: usize, j: usize) -> Expr<'g> {
        let (w, alpha) = (self.omega.0, self.alpha.0);
        if i == j {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            return -(w[a] * w[a] + w[b] * w[b]);
        }
        let k = 3 - i - j;
        match (j + 3 - i) % 3 {
            1 => w[i] * w[j] - alpha[k],
            _ => w[i] * w[j] + alpha[k],
        }
    }

    /// Γ v
    pub fn gamma(&self, v: Vec3<'g>) -> Vec3<'g> {
        let zero = v.0[0].graph().constant(0.0);
        Vec3([0, 1, 2].map(|i| {
            (0..3).fold(zero, |sum, j| match v.0[j].is_zero() {
                true => sum,
                false => sum + self.gamma_entry(i, j) * v.0[j],
            })
        }))
    }

    /// Adds the acceleration due to a slide along z with this displacement and speed.
    fn slide(&mut self, displacement: Expr<'g>, speed: Expr<'g>) {
        let graph = speed.graph();
        let mut along = Vec3::zero(graph);
        along.0[2] = displacement;
        let coriolis = 2.0 * speed;
        let [x, y, _] = self.omega.0;
        self.acceleration = self.acceleration
            + self.gamma(along)
            + Vec3([y * coriolis, -(x * coriolis), graph.constant(0.0)]);
    }

    /// Adds a rotation about z at this rate.
    fn turn(&mut self, rate: Expr<'g>) {
        self.omega.0[2] = self.omega.0[2] + rate;
        let [x, y, _] = self.omega.0;
        self.alpha.0[0] = self.alpha.0[0] + y * rate;
        self.alpha.0[1] = self.alpha.0[1] - x * rate;
    }

    /// Adds the reference acceleration q̈ref of a joint that turns, slides, or does both.
    fn accelerate(&mut self, turns: bool, slides: bool, chosen: ReferenceTurn) {
        let zero = self.reference.graph().constant(0.0);
        match (turns, slides) {
            (true, false) => {
                let [x, y, _] = self.omega.0;
                let given = self.alpha.0[2];
                let wanted = match chosen {
                    ReferenceTurn::Zero => zero,
                    ReferenceTurn::Rest => given,
                    ReferenceTurn::Product => x * y,
                    ReferenceTurn::NegativeProduct => -(x * y),
                };
                self.reference = wanted - given;
                self.alpha.0[2] = wanted;
            }
            (false, _) if chosen != ReferenceTurn::Rest => {
                self.reference = -self.acceleration.0[2];
                self.acceleration.0[2] = zero;
            }
            _ => {}
        }
    }

    /// The wrench that a body needs in this motion; `by_inertia` writes its moment with J instead of Σ.
    pub fn inertia(&self, body: &Body<'g>, by_inertia: bool) -> Wrench<'g> {
        let h = body.first;
        let force = self.gamma(h) + body.mass * self.acceleration;
        let turning = match by_inertia {
            true => {
                let inertia = body.inertia();
                self.omega.cross(inertia.times(self.omega)) + inertia.times(self.alpha)
            }
            false => self.turning(body),
        };
        Wrench {
            force,
            moment: turning + h.cross(self.acceleration),
        }
    }

    /// The vector of ΓΣ − (ΓΣ)ᵀ: n_x = (ΓΣ)_zy − (ΓΣ)_yz, and cyclic.
    fn turning(&self, body: &Body<'g>) -> Vec3<'g> {
        let zero = body.mass.graph().constant(0.0);
        let sigma = |i: usize, j: usize| body.second.entry(i, j);
        let term = |i: usize, j: usize, s: Expr<'g>| match s.is_zero() {
            true => zero,
            false => self.gamma_entry(i, j) * s,
        };
        Vec3([0, 1, 2].map(|x| {
            let (y, z) = ((x + 1) % 3, (x + 2) % 3);
            let squares = |i: usize| self.omega.0[i] * self.omega.0[i];
            let difference = match sigma(y, z).is_zero() {
                true => zero,
                // Γ_zz − Γ_yy = ω_z² − ω_y²
                false => (squares(z) - squares(y)) * sigma(y, z),
            };
            term(z, x, sigma(x, y)) - term(y, x, sigma(x, z)) + term(z, y, sigma(y, y))
                - term(y, z, sigma(z, z))
                + difference
        }))
    }
}

/// A vector as a sum of vectors along the axes in the given order; zero vectors are left out.
pub fn steps<'g>(v: Vec3<'g>, order: [usize; 3]) -> Vec<Vec3<'g>> {
    let graph = v.0[0].graph();
    let along = |axis: usize| {
        let mut step = Vec3::zero(graph);
        step.0[axis] = v.0[axis];
        step
    };
    let steps = order.map(along).into_iter();
    steps.filter(|step| !step.is_zero()).collect()
}

/// The displacement of a link along z, and its rate; `None` if it does not slide.
pub fn slide<'g>(joint: &LinkJoint<'g>, unit: f64, sign: f64) -> Option<(Expr<'g>, Expr<'g>)> {
    match *joint {
        LinkJoint::Axis {
            slide,
            position,
            rate,
            ..
        } if !slide.is_zero() => {
            let along = (sign / unit) * slide;
            Some((along * position, along * rate))
        }
        _ => None,
    }
}

/// The kind of reference motion: its accelerations.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Reference {
    /// As chosen for each axis; α⁰ = 0 for balls.
    Chosen,
    /// As chosen for each axis; balls have the motion of v̇ = 0.
    ChosenOfAxes,
    /// v̇ = 0 in all joints.
    Rest,
}

/// The reference motion of all links.
pub fn motion<'g>(
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    choice: &Choice,
    reference: Reference,
) -> Vec<LinkMotion<'g>> {
    let ground = on_ground(tree, choice);
    let mut motions: Vec<LinkMotion<'g>> = Vec::new();
    for (k, link) in tree.links.iter().enumerate() {
        let parent = link.parent.map_or(&ground, |p| &motions[p]);
        let mut motion = of_link(tree, framed, choice, reference, k, parent);
        if let (0, Some([omega, alpha, acceleration])) = (k, tree.carrier) {
            (motion.omega, motion.alpha, motion.acceleration) = (omega, alpha, acceleration);
        }
        motions.push(motion);
    }
    motions
}

/// The motion at given v̇.
pub struct Given<'g, 'a> {
    /// v̇
    pub accelerations: &'a [Expr<'g>],
    /// The field on a free base, in absolute axes \[m/s²\]; the ground of any other system has it.
    pub field: Vec3<'g>,
}

impl<'g> Given<'g, '_> {
    /// The motion of all links; a⁰ is the acceleration minus the field.
    pub fn motion(
        &self,
        tree: &Tree<'g>,
        framed: &Framed<'g>,
        choice: &Choice,
    ) -> Vec<LinkMotion<'g>> {
        let given = self.accelerations;
        let three = |first: usize| Vec3([0, 1, 2].map(|i| given[first + i]));
        let ground = on_ground(tree, choice);
        let mut motions: Vec<LinkMotion<'g>> = Vec::new();
        for (k, link) in tree.links.iter().enumerate() {
            let parent = link.parent.map_or(&ground, |p| &motions[p]);
            let mut motion = of_link(tree, framed, choice, Reference::Rest, k, parent);
            let sign = framed.links[k].sign;
            match (&link.joint, tree.base) {
                (LinkJoint::Ball { .. }, Some(base)) if k == 0 => {
                    let own = |v: Vec3<'g>| link.rotation.transposed_times(v);
                    motion.alpha = own(three(link.row));
                    motion.acceleration = (1.0 / choice.unit) * own(three(base) - self.field);
                }
                (LinkJoint::Ball { .. }, _) => {
                    motion.alpha = motion.alpha + link.rotation.transposed_times(three(link.row));
                }
                (
                    LinkJoint::Axis {
                        turn, slide, ratio, ..
                    },
                    _,
                ) => {
                    let rate = sign * (*ratio * given[link.row]);
                    let along = (1.0 / choice.unit) * *slide;
                    motion.alpha.0[2] = motion.alpha.0[2] + *turn * rate;
                    motion.acceleration.0[2] = motion.acceleration.0[2] + along * rate;
                }
            }
            motions.push(motion);
        }
        motions
    }
}

/// The motion of the ground, which carries the first link.
fn on_ground<'g>(tree: &Tree<'g>, choice: &Choice) -> LinkMotion<'g> {
    LinkMotion {
        omega: tree.ground.omega,
        alpha: tree.ground.alpha,
        acceleration: (1.0 / choice.unit) * tree.ground.acceleration,
        reference: tree.graph.constant(0.0),
    }
}

/// The reference motion of link `k`, given that of its parent.
fn of_link<'g>(
    tree: &Tree<'g>,
    framed: &Framed<'g>,
    choice: &Choice,
    reference: Reference,
    k: usize,
    parent: &LinkMotion<'g>,
) -> LinkMotion<'g> {
    let (none, zero) = (Vec3::zero(tree.graph), tree.graph.constant(0.0));
    let (link, frame) = (&tree.links[k], &framed.links[k]);
    let back = |v: Vec3<'g>| back_through(&frame.turns, v);
    let mut carried = parent.acceleration;
    let order = link.parent.map_or([0, 1, 2], |p| choice.links[p].order);
    let single = link.parent.is_some_and(|p| framed.links[p].aligned);
    match single {
        true => carried = carried + parent.gamma(frame.place),
        false => {
            for step in steps(frame.place, order).into_iter().rev() {
                carried = carried + parent.gamma(step);
            }
        }
    }
    let mut motion = LinkMotion {
        omega: none,
        alpha: none,
        acceleration: back(carried),
        reference: zero,
    };
    match &link.joint {
        LinkJoint::Ball { omega, bias, .. } => {
            let in_link = |v: Vec3<'g>| match frame.aligned {
                true => v,
                false => link.rotation.transposed_times(v),
            };
            motion.omega = in_link(*omega);
            if reference != Reference::Chosen {
                motion.alpha = in_link(*bias);
            }
        }
        LinkJoint::Axis {
            rate,
            acceleration,
            absolute: true,
            ..
        } => {
            motion.omega.0[2] = frame.sign * *rate;
            motion.alpha.0[2] = frame.sign * *acceleration;
        }
        LinkJoint::Axis {
            turn,
            slide: advance,
            rate,
            acceleration,
            coupled,
            ..
        } => {
            motion.omega = back(parent.omega);
            motion.alpha = back(parent.alpha);
            let slides = slide(&link.joint, choice.unit, frame.sign);
            if let Some((d, speed)) = slides {
                motion.slide(d, speed);
            }
            if *turn != 0.0 {
                motion.turn(frame.sign * *rate);
            }
            // coupled joints must accelerate together
            let chosen = match reference == Reference::Rest || *coupled {
                true => ReferenceTurn::Rest,
                false => choice.links[k].reference,
            };
            motion.accelerate(*turn != 0.0, slides.is_some(), chosen);
            let along = &mut motion.acceleration.0[2];
            *along = *along + (frame.sign / choice.unit) * *advance * *acceleration;
            if *turn != 0.0 {
                motion.alpha.0[2] = motion.alpha.0[2] + frame.sign * *acceleration;
            }
        }
    }
    motion
}
