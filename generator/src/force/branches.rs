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
/// ramp makes the law a function of the state. Below the tolerance the friction is viscous, so a body at rest under
/// load creeps; the smaller the tolerance, the slower it creeps.
pub fn coulomb<'g>(limit: Expr<'g>, speed: Expr<'g>, tolerance: Expr<'g>) -> Expr<'g> {
    -(limit * share(speed / tolerance))
}

/// The factor s of a friction force −s·v for a sliding velocity vector v: s = `limit`/√max(v², tolerance²).
///
/// `limit` \[N\], not negative; `squared` v² \[m²/s²\]; `tolerance` \[m/s\], positive; result \[N s/m\]. The force has
/// the magnitude `limit` where |v| ≥ tolerance and falls linearly to zero at rest. The argument of the root is never
/// zero, so the value and its derivatives are defined at rest.
pub fn coulomb_scale<'g>(limit: Expr<'g>, squared: Expr<'g>, tolerance: Expr<'g>) -> Expr<'g> {
    limit / squared.max(tolerance.squared()).sqrt()
}

/// Force \[N\] of what only pushes, or of a belt, which only pulls: max(0, `elastic` + `viscous`) where `overlap` is
/// positive, 0 elsewhere, whatever the other arguments are there, even NaN: a curve need not be defined below 0.
pub fn one_sided<'g>(overlap: Expr<'g>, elastic: Expr<'g>, viscous: Expr<'g>) -> Expr<'g> {
    let zero = overlap.graph().constant(0.0);
    choose(zero, overlap, (elastic + viscous).max(zero), zero)
}
