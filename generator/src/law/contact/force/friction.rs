//! Friction of a contact: Coulomb friction, regularised by speed or by a bristle that holds.
//!
//! **By speed.** F = −μN v/max(|v|, v_s): a function of the state alone; a body that should stick creeps slowly.
//!
//! **By a bristle.** A spring and a damper in parallel, in series with a slider that yields at μN. With the deflection
//! z of the bristle in the tangent plane,
//!
//! s_t = z/z_b + v/v_s,   s = s_t/max(1, |s_t|),   F = −μN s,   ż = v_s (s − z/z_b).
//!
//! While |s_t| ≤ 1 the contact sticks: ż = v exactly, an elastic-viscous support of stiffness μN/z_b that does not
//! creep. Beyond, it slides with the full friction μN, and z follows s z_b at the rate v_s/z_b, which is not stiff at
//! any speed; |z| ≤ z_b always. While the bodies are apart, s counts as 0 and the bristle straightens at the same rate.
//!
//! z is stored along axes of the second body, in which a bristle at rest has constant components: two axes of a plane
//! or, if the normal changes its direction, all three axes. Then the component along the normal has no effect and
//! decays.

use super::{AppliedForces, Product, Touch};
use crate::expression::choose;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, sum};
use crate::force::branches::{coulomb, coulomb_scale, share};
use crate::model::{Dimension, Friction, Number};
use crate::motion::numbers::number;

/// The result of friction.
pub struct Rubbing<'g> {
    /// Force on the first body, in absolute axes \[N\].
    pub force: Vec3<'g>,
    /// Magnitude of the force \[N\]; signed in the plane.
    pub magnitude: Expr<'g>,
}

/// Friction under a normal force. `owner` is the name of the contact, such as "contact seat".
pub fn friction<'g>(
    applied: &mut AppliedForces<'g>,
    dimension: Dimension,
    owner: &str,
    law: &Friction,
    displacement: Option<&Number>,
    pressure: Expr<'g>,
    touch: &Touch<'g>,
) -> Rubbing<'g> {
    let graph = pressure.graph();
    let limit = number(graph, &law.limit) * pressure;
    let tolerance = number(graph, &law.tolerance);
    match displacement {
        Some(displacement) => {
            let bristle_limit = number(graph, displacement);
            sticking(
                applied,
                dimension,
                owner,
                pressure,
                limit,
                [bristle_limit, tolerance],
                touch,
            )
        }
        None => regularised(applied, dimension, owner, limit, tolerance, touch),
    }
}

fn work(owner: &str) -> String {
    format!("{owner}: friction")
}

fn slides(owner: &str) -> String {
    format!("{owner}: slides")
}

fn regularised<'g>(
    applied: &mut AppliedForces<'g>,
    dimension: Dimension,
    owner: &str,
    limit: Expr<'g>,
    tolerance: Expr<'g>,
    touch: &Touch<'g>,
) -> Rubbing<'g> {
    match dimension {
        Dimension::Plane => {
            let tangent = touch.planar_tangent();
            let slip = tangent.dot(touch.velocity);
            let magnitude = coulomb(limit, slip, tolerance);
            applied.kink(slides(owner), move || slip.max(-slip) - tolerance);
            applied.work(work(owner), Product::Scalars(magnitude, slip));
            Rubbing {
                force: magnitude * tangent,
                magnitude,
            }
        }
        Dimension::Space => {
            let slip = touch.slip();
            let squared = slip.squared();
            let scale = coulomb_scale(limit, squared, tolerance);
            applied.kink(slides(owner), move || squared - tolerance.squared());
            applied.work(work(owner), Product::Scalars(-scale, squared));
            Rubbing {
                force: -(scale * slip),
                magnitude: scale * squared.sqrt(),
            }
        }
    }
}

fn sticking<'g>(
    applied: &mut AppliedForces<'g>,
    dimension: Dimension,
    owner: &str,
    pressure: Expr<'g>,
    limit: Expr<'g>,
    [deflection, tolerance]: [Expr<'g>; 2],
    touch: &Touch<'g>,
) -> Rubbing<'g> {
    let graph = limit.graph();
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let axes = match dimension {
        Dimension::Plane => vec![touch.planar_tangent()],
        Dimension::Space => touch.tangents.clone(),
    };
    let slip: Vec<Expr<'g>> = match axes.len() {
        3 => axes.iter().map(|axis| axis.dot(touch.slip())).collect(),
        _ => axes.iter().map(|axis| axis.dot(touch.velocity)).collect(),
    };
    let bristle: Vec<(usize, Expr<'g>)> = (0..axes.len())
        .map(|i| {
            let which = ["", " 2", " 3"][i];
            applied.auxiliary(format!("{owner}: bristle{which}"), "m", zero)
        })
        .collect();
    let mut tangential: Vec<Expr<'g>> = bristle.iter().map(|(_, z)| *z).collect();
    if let [x, y, z] = tangential[..] {
        // removes the component that now points along the normal
        let normal: Vec<Expr<'g>> = axes.iter().map(|axis| axis.dot(touch.normal)).collect();
        let along = x * normal[0] + y * normal[1] + z * normal[2];
        for (z, n) in tangential.iter_mut().zip(normal) {
            *z = *z - along * n;
        }
    }
    let trial: Vec<Expr<'g>> = tangential
        .iter()
        .zip(&slip)
        .map(|(z, v)| *z / deflection + *v / tolerance)
        .collect();
    // with the operands in this order, a NaN stays a NaN
    let (share, magnitude): (Vec<Expr<'g>>, _) = match trial[..] {
        [trial] => {
            let share = share(trial);
            applied.kink(slides(owner), move || trial.max(-trial) - one);
            (vec![share], -(limit * share))
        }
        _ => {
            let squared = sum(graph, trial.iter().map(|s| s.squared()));
            let scale = squared.max(one).sqrt().recip();
            applied.kink(slides(owner), move || squared - one);
            let share = trial.iter().map(|s| scale * *s).collect();
            (share, limit * (scale * squared.sqrt()))
        }
    };
    for ((index, z), s) in bristle.iter().zip(&share) {
        let held = choose(zero, pressure, *s, zero);
        applied.states.auxiliaries[*index].next = tolerance * (held - *z / deflection);
    }
    let mut force = Vec3::zero(graph);
    for (axis, share) in axes.iter().zip(&share) {
        force = force - (limit * *share) * *axis;
    }
    applied.work(work(owner), Product::Vectors(force, touch.velocity));
    Rubbing { force, magnitude }
}
