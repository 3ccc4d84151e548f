//! Friction of a joint about one coordinate: Coulomb friction, regularised by speed or by a bristle that holds.
//!
//! **By speed.** Q = −M sat(θ̇/v_s): a function of the state alone; a joint that should stick creeps slowly.
//!
//! **By a bristle.** The law of [contacts](crate::law::contact::force) for one coordinate, under a given load: with the
//! deflection z of the bristle,
//!
//! s = sat(z/z_b + θ̇/v_s),   Q = −M s,   ż = v_s (s − z/z_b)
//!
//! While |z/z_b + θ̇/v_s| ≤ 1 the joint sticks, and ż = θ̇ exactly: under a constant torque below M the joint comes to
//! rest within z_b, and does not creep. Beyond, it slides under the full torque M, and z follows s z_b; |z| ≤ z_b
//! always. While the force waits for a switch, the bristle straightens.

use super::Rotation;
use crate::expression::Expr;
use crate::force::AppliedForces;
use crate::force::branches::{coulomb, share};
use crate::force::switch::Gate;
use crate::model::{Bristle, Friction};
use crate::motion::numbers::number;

/// The torque of friction.
pub fn friction<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    gate: Gate<'g>,
    law: &Friction,
    bristle: Option<&Bristle>,
    Rotation { rate, unit, .. }: Rotation<'g>,
) -> Expr<'g> {
    let graph = rate.graph();
    let (limit, tolerance) = (number(graph, &law.limit), number(graph, &law.tolerance));
    let slides = format!("{owner}: slides");
    let Some(Bristle { displacement }) = bristle else {
        applied.kink(slides, move || rate.max(-rate) - tolerance);
        return coulomb(limit, rate, tolerance);
    };
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let deflection = number(graph, displacement);
    let (index, z) = applied.auxiliary(format!("{owner}: bristle"), unit, zero);
    let trial = z / deflection + rate / tolerance;
    applied.kink(slides, move || trial.max(-trial) - one);
    let share = share(trial);
    applied.states.auxiliaries[index].next = tolerance * (gate.of(share) - z / deflection);
    -(limit * share)
}
