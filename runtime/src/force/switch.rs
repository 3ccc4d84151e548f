//! Choices: one value where a < b, another elsewhere.

use crate::Real;

/// `then` where `a` < `b`, `otherwise` elsewhere. NaN where the comparison fails because one of them is not finite.
///
/// Both values are computed. The value that is not chosen has no effect, even if it is NaN.
#[inline(always)]
pub fn choose<T: Real>(a: T, b: T, then: T, otherwise: T) -> T {
    T::select(a.lt(b), then, otherwise + (a.taint() + b.taint()))
}

#[cfg(test)]
mod tests {
    use super::choose;
    use crate::test_scalars::Pair;

    #[test]
    fn the_side_not_chosen_leaves_no_trace() {
        assert_eq!(choose(1.0, 2.0, 3.0, f64::NAN), 3.0);
        assert_eq!(choose(2.0, 2.0, f64::NAN, 4.0), 4.0);
        let lanes = choose(
            Pair([1.0, 2.0]),
            Pair([1.5, 1.5]),
            Pair([3.0, f64::NAN]),
            Pair([f64::NAN, 4.0]),
        );
        assert_eq!(lanes, Pair([3.0, 4.0]));
    }

    #[test]
    fn what_cannot_be_compared_shows() {
        assert!(choose(f64::NAN, 2.0, 3.0, 4.0).is_nan());
        assert!(choose(1.0, f64::NAN, 3.0, 4.0).is_nan());
    }
}
