//! Elliptic integrals by duplication, and elliptic functions by the arithmetic-geometric mean.
//!
//! Carlson, Numerical computation of real or complex elliptic integrals, Numerical Algorithms 10 (1995); Abramowitz and
//! Stegun 16.4 and 17.6 for the descending chain of amplitudes.

/// R_F(x, y, z) = ½ ∫₀^∞ [(t+x)(t+y)(t+z)]^−½ dt; the arguments are not negative, and at most one of them is 0.
fn carlson(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    // the error of the series is below d⁶ if the arguments differ from their mean by less than the share d
    const D: f64 = 2e-3;
    let mut value = f64::NAN;
    // each round reduces differences to a quarter: from 2¹⁰²⁴ to D takes fewer than 520 rounds, usually five
    for _ in 0..520 {
        let mean = (x + y + z) / 3.0;
        let [dx, dy, dz] = [x, y, z].map(|a| 1.0 - a / mean);
        if dx.abs().max(dy.abs()).max(dz.abs()) <= D {
            let e2 = dx * dy - dz * dz;
            let e3 = dx * dy * dz;
            let series = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0;
            value = series / mean.sqrt();
            break;
        }
        let [sx, sy, sz] = [x.sqrt(), y.sqrt(), z.sqrt()];
        let lambda = sx * sy + sx * sz + sy * sz;
        [x, y, z] = [x, y, z].map(|a| 0.25 * (a + lambda));
    }
    value
}

/// F(φ, k) = ∫₀^φ dθ/√(1 − k² sin²θ) for |φ| ≤ π/2, 0 ≤ k ≤ 1.
pub fn first_kind(amplitude: f64, modulus: f64) -> f64 {
    let (sin, cos) = amplitude.sin_cos();
    let product = modulus * sin;
    sin * carlson(cos * cos, (1.0 - product) * (1.0 + product), 1.0)
}

/// The amplitude am(u, k), continuous in u, for 0 ≤ k < 1.
pub fn amplitude(u: f64, modulus: f64) -> f64 {
    const ROUNDS: usize = 16;
    let (mut a, mut b) = (1.0, ((1.0 - modulus) * (1.0 + modulus)).sqrt());
    // c/a of each round
    let mut ratios = [0.0; ROUNDS];
    let mut rounds = 0;
    let mut c = modulus;
    // each round about squares c
    while rounds < ROUNDS && c.abs() > f64::EPSILON * a {
        c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        ratios[rounds] = c / a;
        rounds += 1;
    }
    let mut phi = a * u * f64::from(1u32 << rounds);
    for ratio in ratios[..rounds].iter().rev() {
        phi = 0.5 * (phi + (ratio * phi.sin()).asin());
    }
    phi
}

/// The complete integral K(k), the quarter period.
pub fn quarter_period(modulus: f64) -> f64 {
    first_kind(std::f64::consts::FRAC_PI_2, modulus)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// A dozen rounding errors.
    const BOUND: f64 = 16.0 * f64::EPSILON;

    #[test]
    fn the_quarter_period_is_that_of_the_tables() {
        // K(0) = π/2; K(√½) = Γ(¼)²/(4√π), the lemniscatic case
        let gamma_quarter = 3.625_609_908_221_908;
        let lemniscatic = gamma_quarter * gamma_quarter / (4.0 * PI.sqrt());
        assert!((quarter_period(0.0) / FRAC_PI_2 - 1.0).abs() < BOUND);
        assert!((quarter_period(0.5f64.sqrt()) / lemniscatic - 1.0).abs() < BOUND);
        // the same by the arithmetic-geometric mean: K = π / (2 agm(1, k'))
        for modulus in [0.1, 0.5, 0.9, 0.999] {
            let (mut a, mut b) = (1.0f64, ((1.0f64 - modulus) * (1.0 + modulus)).sqrt());
            for _ in 0..10 {
                (a, b) = (0.5 * (a + b), (a * b).sqrt());
            }
            assert!((quarter_period(modulus) * 2.0 * a / PI - 1.0).abs() < BOUND);
        }
    }

    #[test]
    fn the_amplitude_undoes_the_integral() {
        for modulus in [0.0, 0.3, 0.7, 0.95] {
            for i in -10..=10 {
                let phi = FRAC_PI_2 * f64::from(i) / 10.0;
                let u = first_kind(phi, modulus);
                // dφ/du = dn ≤ 1
                assert!(
                    (amplitude(u, modulus) - phi).abs() < 2.0 * BOUND,
                    "{modulus} {phi}"
                );
            }
        }
    }

    #[test]
    fn the_amplitude_grows_by_pi_in_two_quarters() {
        for modulus in [0.2, 0.8, 0.99] {
            let quarter = quarter_period(modulus);
            for i in 0..9 {
                let u = f64::from(i) * quarter;
                let expected = f64::from(i) * FRAC_PI_2;
                // u itself errs by some ε, and dφ/du ≤ 1
                let bound = BOUND * (1.0 + u.abs());
                assert!(
                    (amplitude(u, modulus) - expected).abs() < bound,
                    "{modulus} {i}"
                );
            }
        }
    }
}
