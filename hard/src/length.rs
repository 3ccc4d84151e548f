//! Many steps: the energy over a million steps.

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::jobs::many;
use crate::scene;
use bryant_runtime::Formula;

/// The cases of this group.
pub const CASES: &[Case] = &[Case {
    group: Group::Length,
    name: "energy over a million steps",
    law: "On ẍ = −x with fixed steps h a Runge–Kutta method multiplies the energy by |R(ih)|² in each step, R its stability \
          polynomial (Hairer & Wanner II, IV.2); the semi-implicit one keeps x² + v² − h x v.",
    run: energy_over_a_million_steps,
}];

/// Coefficients of 1, z, z² … of the stability polynomials: those of eᶻ up to the order of the method, then others.
const POLYNOMIALS: [(Formula, &[f64]); 4] = [
    (Formula::Heun, &[1.0, 1.0, 0.5]),
    (Formula::Rk4, &[1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0]),
    // Merson's method: Hairer, Nørsett & Wanner I, II.4, solution of order 4
    (
        Formula::Merson,
        &[1.0, 1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 144.0],
    ),
    // Hairer & Wanner II, IV.2, (2.13)
    (
        Formula::Dopri5,
        &[
            1.0,
            1.0,
            1.0 / 2.0,
            1.0 / 6.0,
            1.0 / 24.0,
            1.0 / 120.0,
            1.0 / 600.0,
        ],
    ),
];

/// |R(iy)|² − 1. Powers below the method's order would cancel in exact arithmetic; they are left out, so that rounding
/// does not hide the rest.
fn growth(coefficients: &[f64], y: f64) -> f64 {
    let count = coefficients.len();
    let mut sum = 0.0;
    for power in (2..2 * count).step_by(2) {
        let pairs = (0..count).filter(|i| *i <= power && power - i < count);
        // the sign of i^j times the conjugate of i^k, with j + k = power: i^(2 j − power)
        let terms = pairs.map(|j| {
            let sign = if (2 * j + 3 * power).is_multiple_of(4) {
                1.0
            } else {
                -1.0
            };
            sign * coefficients[j] * coefficients[power - j]
        });
        let coefficient: f64 = terms.sum();
        if coefficient.abs() > 1e-14 {
            sum += coefficient * y.powi(power as i32);
        }
    }
    sum
}

fn energy_over_a_million_steps(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("oscillator");
    let h: f64 = 0.01;
    let steps: f64 = if bench.full() { 1e7 } else { 1e6 };
    let job = |formula| many(formula, h, steps, 100.0);
    let energy = |state: &[f64]| 0.5 * (state[0] * state[0] + state[1] * state[1]);
    for (formula, polynomial) in POLYNOMIALS {
        bench.variant(format!("{} at h = {h}", formula.name()));
        let run = bench.succeed(&scene, &job(formula))?;
        let seen = (energy(run.last()?) / 0.5).ln();
        let expected = steps * growth(polynomial, h).ln_1p();
        // A step rounds each of two numbers to ε/2 of the state, and so changes the energy by at most 2 ε of it.
        // Samples at other phases and a rounded h do not matter, because the energy is constant on a circle.
        bench.at_most(
            format!("deviation of ln E/E₀ from {expected:.3e}"),
            (seen - expected).abs(),
            2.0 * steps * f64::EPSILON,
            "",
            "2 ε for each step: the effect of two roundings of the state, all in one direction",
        );
    }

    let formula = Formula::SemiImplicitEuler;
    bench.variant(format!("{} at h = {h}", formula.name()));
    let run = bench.succeed(&scene, &job(formula))?;
    let kept = |y: &[f64]| y[0] * y[0] + y[1] * y[1] - h * y[0] * y[1];
    let first = kept(run.states.first().map_or(&[0.0, 0.0][..], Vec::as_slice));
    bench.at_most(
        "change of x² + v² − h x v",
        (kept(run.last()?) / first - 1.0).abs(),
        2.0 * steps * f64::EPSILON,
        "",
        "2 ε for each step",
    );
    Ok(())
}
