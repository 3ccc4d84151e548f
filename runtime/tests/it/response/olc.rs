//! The occupant load criterion.

use bryant_runtime::{Dual, Response, reduce};

const EVERY: f64 = 1e-4;

fn olc(samples: &[f64]) -> f64 {
    reduce(Response::Olc, samples, EVERY, &mut [])
}

/// A constant deceleration c: s = c t²/2, so t₁² = 0.13/c, and c t²/2 − c t (t − t₁)/2 = c t t₁/2 = 0.3 at t₂ = 0.6/(c
/// t₁). With t₂/t₁ = 0.6/0.13 the criterion is c t₂/(t₂ − t₁) = c · 0.6/0.47.
#[test]
fn a_constant_pulse_has_the_criterion_of_the_closed_form() {
    for pulse in [-200.0, 200.0, -80.0] {
        let samples = vec![pulse; 2001];
        let exact = f64::abs(pulse) * 0.6 / 0.47;
        let found = olc(&samples);
        // velocity is linear, so only sums of 2000 terms are rounded
        assert!((found / exact - 1.0).abs() < 1e-11, "{found} {exact}");
    }
}

#[test]
fn a_pulse_that_ends_too_early_has_none() {
    assert!(olc(&vec![200.0; 100]).is_nan());
    assert!(olc(&vec![0.0; 1000]).is_nan());
    assert!(olc(&[1.0]).is_nan());
}

/// OLC is proportional to a constant pulse.
#[test]
fn it_has_the_derivative_of_the_closed_form() {
    let samples = vec![
        Dual {
            value: -200.0,
            slope: -1.0
        };
        2001
    ];
    let found = reduce(Response::Olc, &samples, EVERY, &mut []);
    let error: f64 = found.slope - 0.6 / 0.47;
    assert!(error.abs() < 1e-11, "{error}");
}
