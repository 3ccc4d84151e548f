//! One axis in the articulated-body algorithm. The column of an axis is (z s, z t), so U = (K z s + Bᵀ z t,  B z s + J
//! z t) and D = s U_fz + t U_nz.

use super::articulated_inertia::Articulated;
use super::frames::FramedLink;
use super::shared_velocities::Velocity;
use super::tree::{Link, LinkJoint};
use crate::dynamics::spatial::Wrench;
use crate::expression::Expr;
use crate::expression::vector::{Sym3, Vec3};

/// An axis while it is eliminated.
#[derive(Clone, Copy)]
pub struct Axis<'g> {
    /// t and s of the column
    pub turn: f64,
    pub slide: Expr<'g>,
    /// Inertia of a rotor on the axis, which only this velocity moves
    armature: Expr<'g>,
    /// U
    pub needed: Wrench<'g>,
    /// D
    pub whole: Expr<'g>,
    /// 1/D
    pub inverse: Expr<'g>,
    /// U/D
    gain: Wrench<'g>,
    /// Generalised force on the coordinate
    acting: Expr<'g>,
    /// u
    pub left: Expr<'g>,
}

impl<'g> Axis<'g> {
    /// True if the joint only turns or only slides, and has no rotor. Then the bodies outboard pass no inertia along
    /// the axis.
    fn is_pure(&self) -> bool {
        self.armature.is_zero() && (self.turn == 0.0 || self.slide.is_zero())
    }

    /// q̈ minus its value in the reference motion. `a` and `alpha` are Δa and Δα of the link with the joint at rest.
    pub fn rate(&self, a: Vec3<'g>, alpha: Vec3<'g>, scales_rate: bool) -> Expr<'g> {
        let zero = self.left.graph().constant(0.0);
        // for a pure hinge the coefficient of α_z is exactly D/D = 1, for a pure slider that of a_z, so this term needs
        // no product
        let hinge = self.is_pure() && self.turn != 0.0;
        let slider = self.is_pure() && self.turn == 0.0;
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

    /// U, D and u of the axis, as those of a shared velocity.
    pub fn velocity(&self, row: usize) -> Velocity<'g> {
        Velocity {
            row,
            needed: self.needed,
            whole: self.whole,
            left: self.left,
        }
    }

    /// The power of a wrench per velocity of this axis: s f_z + t n_z.
    pub fn power(&self, wrench: &Wrench<'g>) -> Expr<'g> {
        self.slide * wrench.force.0[2] + self.turn * wrench.moment.0[2]
    }

    /// The axis of a link, given the articulated inertia outboard of it and the reference acceleration of its
    /// coordinate.
    pub fn of(
        outboard: &Articulated<'g>,
        link: &Link<'g>,
        frame: &FramedLink<'g>,
        unit: f64,
        reference: Expr<'g>,
    ) -> Self {
        let LinkJoint::Axis {
            turn,
            slide,
            acting,
            armature,
            ..
        } = link.joint
        else {
            unreachable!("only axes are eliminated as such")
        };
        // a slider moves along a length, so its coordinate and its generalised force are scaled with the unit of length
        let (slide, acting, armature) = match turn == 0.0 {
            true => (slide, unit * acting, (unit * unit) * armature),
            false => ((1.0 / unit) * slide, acting, armature),
        };
        let acting = frame.sign * acting;
        let z = |m: &Sym3<'g>| Vec3([m.entry(0, 2), m.entry(1, 2), m.entry(2, 2)]);
        let needed = Wrench {
            force: slide * z(&outboard.mass) + turn * Vec3(outboard.coupling.0[2]),
            moment: slide * outboard.coupling.column(2) + turn * z(&outboard.inertia),
        };
        let whole = slide * needed.force.0[2] + turn * needed.moment.0[2] + armature;
        let inverse = whole.recip();
        let gain = Wrench {
            force: inverse * needed.force,
            moment: inverse * needed.moment,
        };
        let resisting = acting - armature * reference;
        let bias = &outboard.bias;
        let left = resisting - slide * bias.force.0[2] - turn * bias.moment.0[2];
        Axis {
            turn,
            slide,
            armature,
            needed,
            whole,
            inverse,
            gain,
            acting,
            left,
        }
    }

    /// The articulated inertia that remains when the coordinate moves freely.
    pub fn rest(&self, outboard: &Articulated<'g>, scales_bias: bool) -> Articulated<'g> {
        let mut rest = outboard.less(
            &self.needed,
            &self.gain,
            self.inverse,
            self.left,
            scales_bias,
        );
        if !self.is_pure() {
            return rest;
        }
        let zero = self.left.graph().constant(0.0);
        let without_z = |m: Sym3<'g>| {
            Sym3::from_fn(|i, j| match i == 2 || j == 2 {
                true => zero,
                false => m.entry(i, j),
            })
        };
        if self.turn != 0.0 {
            // the row and the column of z vanish, and the moment along z is the generalised force
            rest.coupling.0[2] = [zero; 3];
            rest.inertia = without_z(rest.inertia);
            rest.bias.moment.0[2] = self.acting;
        } else {
            for row in &mut rest.coupling.0 {
                row[2] = zero;
            }
            rest.mass = without_z(rest.mass);
            rest.bias.force.0[2] = self.acting;
        }
        rest
    }
}
