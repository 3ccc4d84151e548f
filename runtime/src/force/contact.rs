//! Contact of an ellipsoid with a plane: N = max(0, f(δ) + d·δ̇) where the penetration δ > 0, N = 0 while apart.

use crate::Real;

/// Normal force \[N\] at `penetration` \[m\], given its elastic force and viscous force \[N\].
///
/// The sum never pulls: damping must not hold back an ellipsoid that leaves. While the bodies are apart the force is
/// 0, whatever the other arguments are, even NaN, because a curve need not be defined for negative penetration. A NaN
/// penetration gives NaN.
#[inline(always)]
pub fn normal_force<T: Real>(penetration: T, elastic: T, viscous: T) -> T {
    let zero = T::from_f64(0.0);
    let force = (elastic + viscous).max(zero);
    T::select(zero.lt(penetration), force, penetration.taint())
}

#[cfg(test)]
mod tests {
    use super::normal_force;
    use crate::Dual;
    use crate::test_scalars::Pair;

    #[test]
    fn a_contact_pushes_only_when_penetrated() {
        assert_eq!(normal_force(0.01, 500.0, 100.0), 600.0);
        assert_eq!(normal_force(0.01, 500.0, -600.0), 0.0);
        assert_eq!(normal_force(0.0, 500.0, 100.0), 0.0);
        assert_eq!(normal_force(-0.01, f64::NAN, f64::INFINITY), 0.0);
    }

    #[test]
    fn a_left_curve_is_not_hidden() {
        assert!(normal_force(0.01, f64::NAN, 0.0).is_nan());
        assert!(normal_force(f64::NAN, 1.0, 0.0).is_nan());
    }

    #[test]
    fn lanes_choose_for_themselves() {
        let force = normal_force(
            Pair([0.01, -0.01]),
            Pair([500.0, f64::NAN]),
            Pair([1.0, 1.0]),
        );
        assert_eq!(force, Pair([501.0, 0.0]));
    }

    #[test]
    fn derivative_is_that_of_the_side_taken() {
        let penetration = Dual::variable(0.01);
        let elastic = Dual {
            value: 500.0,
            slope: 50_000.0,
        };
        let still = Dual::constant(0.0);
        assert_eq!(normal_force(penetration, elastic, still), elastic);
        let apart = Dual::variable(-0.01);
        assert_eq!(normal_force(apart, elastic, still), still);
    }
}
