//! Flexion and torsion of a ball joint: the angle between the long axes of its two bodies, and the twist about them.
//!
//! e, c: the long axes of parent and child in absolute axes; ω = ω_child − ω_parent
//!
//! | | angle | its rate | where |
//! |---|---|---|---|
//! | flexion | β = angle(e, c) ∈ \[0, π\] | n · ω | n = (e × c)/sin β |
//! | torsion | τ, the twist of A_parentᵀ A_child = swing · twist | t · ω | t = (e + c)/(1 + e·c) |
//!
//! To verify n and t, consider three turns that together span all others. A turn about n increases the swing and leaves
//! the twist: n·n = 1, t·n = 0. A turn about c multiplies the twist from the right and leaves the swing: n·c = 0,
//! t·c = 1. A turn about e rotates the plane of bending and increases the twist, both by the same angle: n·e = 0,
//! t·e = 1. A moment −f(β) n − g(τ) t therefore has the power −f β̇ − g τ̇, and stores ∫f + ∫g.
//!
//! Damping and friction of flexion resist the swinging of the long axis c, seen from the parent: c moves at ċ = ω × c,
//! which is the angular velocity w = c × ċ = ω − (c·ω) c. Its component along n is β̇; it has another one if the plane
//! of bending turns; for a body that spins about its own long axis it is 0. The moments −d w and −F w/max(|w|,
//! tolerance) have the power −d w² and −F w²/max(|w|, tolerance), as w·ω = w². So they pass smoothly through β = 0 and
//! β = π, where n has no direction; so does an elastic torque that is 0 there. At β = π neither the twist nor the plane
//! of bending is defined: sin β and 1 + e·c are bounded from below, so that moments stay finite, and a run that passes
//! through β = π reports it by means of the [bearing].

use super::{Rotation, elastic_torque, stop, stop_kinks};
use crate::equations::NO_BEARING;
use crate::expression::choose;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph};
use crate::force::branches::coulomb_scale;
use crate::force::switch::Gate;
use crate::force::{AppliedForces, Product};
use crate::law::joint::JointMeasures;
use crate::law::joint::check::JointTorque;
use crate::motion::ElementMotion;
use crate::motion::numbers::number;

/// Lower bound of sin² β: the square of the rounding error of a unit vector.
const SMALLEST_SINE_SQUARED: f64 = 1e-32;

/// Lower bound of 1 + cos β.
const SMALLEST_OPENING: f64 = 1e-12;

/// Flexion and torsion of a ball joint in one state.
pub struct Bent<'g> {
    /// β, β̇ and n.
    pub bend: Rotation<'g>,
    /// τ, τ̇ and t.
    pub twist: Rotation<'g>,
    /// Sine and cosine of τ, both times the same positive factor.
    pub of_twist: [Expr<'g>; 2],
    /// w \[rad/s\].
    swing: Vec3<'g>,
}

impl<'g> Bent<'g> {
    /// Flexion and torsion of the joint between two bodies. `axis` is the index of the long axis, the same in both.
    pub fn of(
        graph: &'g Graph,
        inboard: &ElementMotion<'g>,
        outboard: &ElementMotion<'g>,
        axis: usize,
    ) -> Self {
        let one = graph.constant(1.0);
        let omega = outboard.omega - inboard.omega;
        let [a, b] = [inboard, outboard].map(|body| body.rotation.column(axis));
        let cosine = a.dot(b);
        let across = a.cross(b);
        let sine = across
            .squared()
            .max(graph.constant(SMALLEST_SINE_SQUARED))
            .sqrt();
        let normal = sine.recip() * across;
        let bend = Rotation {
            angle: sine.atan2(cosine),
            rate: normal.dot(omega),
            direction: normal,
            unit: "rad",
        };

        // with the quaternion (w, …) of A_parentᵀ A_child, tan τ = 2 w z/(w² − z²); numerator and denominator are
        // computed from the matrix, times 2
        let [j, k] = [(axis + 1) % 3, (axis + 2) % 3];
        let entry = |row: usize, column: usize| {
            inboard
                .rotation
                .column(row)
                .dot(outboard.rotation.column(column))
        };
        let of_twist = [entry(k, j) - entry(j, k), entry(j, j) + entry(k, k)];
        let angle = of_twist[0].atan2(of_twist[1]);
        let opening = (one + cosine).max(graph.constant(SMALLEST_OPENING));
        let direction = opening.recip() * (a + b);
        let rate = direction.dot(omega);
        Bent {
            bend,
            twist: Rotation {
                angle,
                rate,
                direction,
                unit: "rad",
            },
            of_twist,
            swing: omega - b.dot(omega) * b,
        }
    }

    /// The moment of flexion on the child, and its measures. The torque among these is the component along n.
    pub fn flexion(
        &self,
        graph: &'g Graph,
        applied: &mut AppliedForces<'g>,
        owner: &str,
        gate: Gate<'g>,
        law: &JointTorque,
    ) -> (Vec3<'g>, JointMeasures<'g>) {
        let Rotation {
            angle,
            rate,
            direction,
            unit,
        } = self.bend;
        let rotation = format!("{owner} flexion");
        let argument = move || angle;
        let resists = law.elastic.as_ref().map(|elastic| {
            elastic_torque(applied, &rotation, gate, elastic, law, argument, rate, unit)
        });
        if let Some(law) = &law.stop {
            stop_kinks(graph, applied, &rotation, gate, law, angle, rate);
        }
        let mut torque = graph.constant(0.0);
        let mut along = |term: &str, value: Expr<'g>| {
            let value = gate.of(value);
            torque = torque + value;
            applied.work(
                format!("{owner}: flexion, {term}"),
                Product::Scalars(value, rate),
            );
        };
        if let Some(resists) = resists {
            along("elastic", -resists.0);
        }
        if let Some(law) = &law.stop {
            along("stop", stop(graph, law, angle, rate));
        }
        let squared = self.swing.squared();
        let mut resistance = graph.constant(0.0);
        let mut against = |term: &str, coefficient: Expr<'g>| {
            let coefficient = gate.of(coefficient);
            resistance = resistance + coefficient;
            applied.work(
                format!("{owner}: flexion, {term}"),
                Product::Scalars(-coefficient, squared),
            );
        };
        if let Some(damping) = &law.damping {
            against("damping", number(graph, damping));
        }
        if let Some(friction) = &law.friction {
            let (limit, tolerance) = (
                number(graph, &friction.limit),
                number(graph, &friction.tolerance),
            );
            let scale = coulomb_scale(limit, squared, tolerance);
            against("friction", scale);
            applied.kink(format!("{rotation}: slides"), move || {
                squared - tolerance.squared()
            });
        }
        (
            torque * direction - resistance * self.swing,
            JointMeasures {
                torque: torque - resistance * rate,
                angle,
                rate,
                permanent_sets: resists.map_or([graph.constant(0.0); 2], |resists| resists.1),
            },
        )
    }
}

/// The direction to which the child is bent, as an angle about the long axis of the parent, whose local index is `axis`
/// \[rad\]; [`NO_BEARING`] if it is bent by less than 90°. The angle jumps by half a turn when the flexion passes
/// through 180°.
pub fn bearing<'g>(
    graph: &'g Graph,
    inboard: Mat3<'g>,
    outboard: Mat3<'g>,
    axis: usize,
) -> Expr<'g> {
    let long = outboard.column(axis);
    let [along, x, y] = [axis, (axis + 1) % 3, (axis + 2) % 3];
    let [along, x, y] = [along, x, y].map(|axis| inboard.column(axis).dot(long));
    choose(
        along,
        graph.constant(0.0),
        y.atan2(x),
        graph.constant(NO_BEARING),
    )
}
