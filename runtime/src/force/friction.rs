//! Coulomb friction with a linear ramp through zero speed: F = −F_max · clamp(v/v_tol, −1, 1).
//!
//! The ramp makes the law a function of the state. Below the tolerance speed the friction is viscous, so a body at rest
//! under load creeps; the smaller the tolerance, the slower it creeps.

use crate::Real;

/// Friction force or torque: −`limit` · clamp(`speed`/`tolerance`, −1, 1).
///
/// `limit` \[N\] or \[N m\], not negative; `speed` and `tolerance` \[m/s\] or \[rad/s\], the tolerance positive.
#[inline(always)]
pub fn coulomb<T: Real>(limit: T, speed: T, tolerance: T) -> T {
    let one = T::from_f64(1.0);
    -(limit * (speed / tolerance).max(-one).min(one))
}

/// The factor s of a friction force −s·v for a sliding velocity vector v: s = `limit`/√max(v², tolerance²).
///
/// `limit` \[N\], not negative; `speed_squared` v² \[m²/s²\]; `tolerance` \[m/s\], positive; result \[N s/m\]. The
/// force has the magnitude `limit` where |v| ≥ tolerance and falls linearly to zero at rest. The argument of the root
/// is never zero, so the value and its derivatives are defined at rest.
#[inline(always)]
pub fn coulomb_scale<T: Real>(limit: T, speed_squared: T, tolerance: T) -> T {
    limit / speed_squared.max(tolerance * tolerance).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{coulomb, coulomb_scale};
    use crate::Dual;

    #[test]
    fn friction_opposes_sliding_up_to_its_limit() {
        assert_eq!(coulomb(5.0, 2.0, 0.1), -5.0);
        assert_eq!(coulomb(5.0, -2.0, 0.1), 5.0);
        assert_eq!(coulomb(5.0, 0.05, 0.1), -2.5);
        assert_eq!(coulomb(5.0, 0.0, 0.1), 0.0);
        assert!(coulomb(5.0, f64::NAN, 0.1).is_nan());
    }

    #[test]
    fn vector_friction_has_the_magnitude_of_its_limit() {
        let (vx, vy) = (3.0_f64, -4.0_f64);
        let scale = coulomb_scale(10.0, vx * vx + vy * vy, 0.01);
        assert_eq!(scale, 2.0);
        assert_eq!((scale * vx).hypot(scale * vy), 10.0);
        assert_eq!(coulomb_scale(10.0, 0.0, 0.5), 20.0);
        assert!(coulomb_scale(10.0, f64::NAN, 0.5).is_nan());
    }

    #[test]
    fn scalar_and_vector_law_agree() {
        for speed in [0.0_f64, 0.03, 0.1, 0.7] {
            let vector = -coulomb_scale(4.0, speed * speed, 0.1) * speed;
            assert!((vector - coulomb(4.0, speed, 0.1)).abs() <= 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn derivative_at_rest_is_finite() {
        let constant = Dual::<f64>::constant;
        let speed = Dual::variable(0.0);
        let scale = coulomb_scale(constant(10.0), speed * speed, constant(0.5));
        assert_eq!(scale, constant(20.0));
        let force = coulomb(constant(10.0), speed, constant(0.5));
        assert_eq!(force.slope, -20.0);
    }
}
