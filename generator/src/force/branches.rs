//! The branches that several laws have in common: a share between −1 and 1, Coulomb friction, a force that only pushes.
//!
//! They are made of `min`, `max` and [`choose`]. Both sides of a branch are computed, and a NaN of the side that is not
//! taken has no effect. A NaN that decides shows: leaving a curve must stop the run and not vanish in a `max`, which
//! keeps a NaN of its first operand.

use crate::expression::{Expr, choose};

/// `x`, but at least −1 and at most 1.
pub(crate) fn share<'g>(x: Expr<'g>) -> Expr<'g> {
    let one = x.graph().constant(1.0);
    x.max(-one).min(one)
}

/// Friction force or torque −`limit` · clamp(`speed`/`tolerance`, −1, 1): Coulomb friction with a linear ramp through
/// zero speed.
///
/// `limit` \[N\] or \[N m\], not negative; `speed` and `tolerance` \[m/s\] or \[rad/s\], the tolerance positive. The
/// ramp makes the law a function of the state. Below the tolerance the friction is viscous, so a body at rest under load
/// creeps; the smaller the tolerance, the slower it creeps.
pub(crate) fn coulomb<'g>(limit: Expr<'g>, speed: Expr<'g>, tolerance: Expr<'g>) -> Expr<'g> {
    -(limit * share(speed / tolerance))
}

/// The factor s of a friction force −s·v for a sliding velocity vector v: s = `limit`/√max(v², tolerance²).
///
/// `limit` \[N\], not negative; `squared` v² \[m²/s²\]; `tolerance` \[m/s\], positive; result \[N s/m\]. The force has
/// the magnitude `limit` where |v| ≥ tolerance and falls linearly to zero at rest. The argument of the root is never
/// zero, so the value and its derivatives are defined at rest.
pub(crate) fn coulomb_scale<'g>(
    limit: Expr<'g>,
    squared: Expr<'g>,
    tolerance: Expr<'g>,
) -> Expr<'g> {
    limit / squared.max(tolerance.squared()).sqrt()
}

/// Force \[N\] of what only pushes, or of a belt, which only pulls: max(0, `elastic` + `viscous`) where `overlap` is
/// positive, 0 elsewhere, whatever the other arguments are there, even NaN: a curve need not be defined below 0.
pub(crate) fn one_sided<'g>(overlap: Expr<'g>, elastic: Expr<'g>, viscous: Expr<'g>) -> Expr<'g> {
    let zero = overlap.graph().constant(0.0);
    choose(zero, overlap, (elastic + viscous).max(zero), zero)
}

#[cfg(test)]
mod tests {
    use super::{coulomb, coulomb_scale, one_sided};
    use crate::expression::evaluate::{Inputs, evaluate};
    use crate::expression::{Expr, Function, Graph, Symbol};

    /// A law of three numbers at three numbers.
    fn at(law: for<'g> fn(Expr<'g>, Expr<'g>, Expr<'g>) -> Expr<'g>, numbers: [f64; 3]) -> f64 {
        let graph = Graph::new();
        let [a, b, c] = [0, 1, 2].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let inputs = Inputs {
            time: 0.0,
            coordinates: &numbers,
            velocities: &[],
            parameters: &[],
            auxiliaries: &[],
            memory: &[],
            accelerations: &[],
        };
        // as `bryant_runtime::force::switch::choose`
        let taint = |x: f64| if x.is_finite() { 0.0 } else { f64::NAN };
        let choose = |function, a: &[f64]| match (function, a) {
            (Function::Choose, &[a, b, then, _]) if a < b => then,
            (Function::Choose, &[a, b, _, otherwise]) => otherwise + (taint(a) + taint(b)),
            _ => unreachable!("these laws call nothing else"),
        };
        evaluate(&graph, &[law(a, b, c).id()], &inputs, &choose)[0]
    }

    #[test]
    fn friction_opposes_sliding_up_to_its_limit() {
        assert_eq!(at(coulomb, [5.0, 2.0, 0.1]), -5.0);
        assert_eq!(at(coulomb, [5.0, -2.0, 0.1]), 5.0);
        assert_eq!(at(coulomb, [5.0, 0.05, 0.1]), -2.5);
        assert_eq!(at(coulomb, [5.0, 0.0, 0.1]), 0.0);
        assert!(at(coulomb, [5.0, f64::NAN, 0.1]).is_nan());
    }

    #[test]
    fn vector_friction_has_the_magnitude_of_its_limit() {
        let scale = at(coulomb_scale, [10.0, 25.0, 0.01]);
        assert_eq!((scale * 3.0).hypot(scale * -4.0), 10.0);
        assert_eq!(at(coulomb_scale, [10.0, 0.0, 0.5]), 20.0);
        assert!(at(coulomb_scale, [10.0, f64::NAN, 0.5]).is_nan());
        for speed in [0.0_f64, 0.03, 0.1, 0.7] {
            let vector = -at(coulomb_scale, [4.0, speed * speed, 0.1]) * speed;
            assert!((vector - at(coulomb, [4.0, speed, 0.1])).abs() <= 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn what_only_pushes_is_0_while_apart_and_never_pulls() {
        assert_eq!(at(one_sided, [0.01, 500.0, 100.0]), 600.0);
        assert_eq!(at(one_sided, [0.01, 500.0, -600.0]), 0.0);
        assert_eq!(at(one_sided, [0.0, 500.0, 100.0]), 0.0);
        assert_eq!(at(one_sided, [-0.01, f64::NAN, f64::INFINITY]), 0.0);
        assert!(at(one_sided, [0.01, f64::NAN, 0.0]).is_nan());
        assert!(at(one_sided, [f64::NAN, 1.0, 0.0]).is_nan());
    }
}
