//! Belts: F = max(0, elastic + viscous force) where the relative elongation is positive, F = 0 where the belt is slack.
//! The generator computes the two forces (`law/belt/force`): f(ε) with ε = (L − L₀)/L₀, and damping on the rate of
//! stretch.

use crate::Real;

/// Tension \[N\] of a belt at the relative elongation `elongation`, given its elastic force and viscous force \[N\].
///
/// A belt never pushes. The tension is 0 at and below its untensioned length, whatever the damping, and never negative
/// above it.
#[inline(always)]
pub fn tension<T: Real>(elongation: T, elastic: T, viscous: T) -> T {
    super::contact::normal_force(elongation, elastic, viscous)
}

#[cfg(test)]
mod tests {
    use super::tension;

    #[test]
    fn a_belt_pulls_only_when_stretched() {
        assert_eq!(tension(0.1, 100.0, 20.0), 120.0);
        assert_eq!(tension(0.1, 100.0, -120.0), 0.0);
        assert_eq!(tension(0.0, 100.0, 20.0), 0.0);
        assert_eq!(tension(-0.1, 100.0, 20.0), 0.0);
    }
}
