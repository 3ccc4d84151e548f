//! Channels of several outputs.

use bryant_runtime::response::channel::{Channel, Chest, Combination, Neck};
use bryant_runtime::response::filter::{Class, Filter, Standard, filtered};
use bryant_runtime::{Dual, Response, reduce};
use core::f64::consts::PI;

fn peak(signal: &[f64]) -> f64 {
    reduce(Response::Peak, signal, 1e-4, &mut [])
}

/// D = A sin ω t has the largest VC = S A² ω/(2 D₀).
#[test]
fn a_half_sine_has_the_viscous_criterion_of_the_closed_form() {
    let chest = Chest {
        factor: 1.3,
        depth: 0.229,
    };
    let omega = PI / 0.06;
    for sign in [1.0, -1.0] {
        let samples = (0..=600).map(|i| sign * 0.05 * (omega * f64::from(i) * 1e-4).sin());
        let formed = Combination::Viscous(chest).form(&[samples.collect()], 1e-4);
        let found = peak(&formed.unwrap());
        let exact = 1.3 * 0.05 * 0.05 * omega / (2.0 * 0.229);
        // the five-point rate errs by (ω Δt)⁴/30; the top lies at most 0.5 samples off: (2 ω Δt/2)²/2
        assert!((found / exact - 1.0).abs() < 2e-5, "{found} {exact}");
        assert!((exact - 0.3715493).abs() < 1e-7);
    }
}

/// Each of the four modes of the neck, with numbers of its own.
#[test]
fn each_mode_of_the_neck_counts_by_itself() {
    let critical = Neck {
        tension: 6806.0,
        compression: 6160.0,
        flexion: 310.0,
        extension: 135.0,
    };
    for (fx, fz, my, expected) in [
        (0.0, 680.6, 31.0, 0.2),
        (0.0, 680.6, -13.5, 0.2),
        (0.0, -616.0, 31.0, 0.2),
        (0.0, -616.0, -13.5, 0.2),
        // the shear force turns the moment: 10 − 0.01778 · 1000
        (1000.0, 0.0, 10.0, 7.78 / 135.0),
    ] {
        let cell = [fx, fz, my].map(|value| vec![0.0, value, 0.0]);
        let found = peak(&Combination::Nij(critical).form(&cell, 1e-4).unwrap());
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

/// The maxima of BrIC are at different times. The example has (30, 20, 10) rad/s.
#[test]
fn rotations_add_their_largest_whenever_they_are() {
    let critical = Combination::Rotation([66.25, 56.45, 42.87]);
    let at = |place: usize, value: f64| {
        let mut signal = vec![0.0; 5];
        signal[place] = value;
        signal
    };
    let formed = critical.form(&[at(0, 30.0), at(2, -20.0), at(3, 10.0)], 1e-4);
    assert!((peak(&formed.unwrap()) - 0.6204776).abs() < 1e-7);
}

#[test]
fn the_tibia_adds_moment_and_force() {
    let tibia = Combination::Tibia {
        moment: 225.0,
        force: 35900.0,
    };
    let formed = tibia.form(&[vec![135.0], vec![-180.0], vec![-3590.0]], 1e-4);
    let found: f64 = formed.unwrap()[0];
    assert!((found - 1.1).abs() < 1e-12);
}

#[test]
fn components_are_filtered_before_their_resultant() {
    let x: Vec<f64> = (0..200).map(|i| (0.9 * f64::from(i)).sin()).collect();
    let y: Vec<f64> = (0..200).map(|i| (1.3 * f64::from(i)).cos()).collect();
    let of = |signal: &[f64]| filtered(signal, 1e-4, Class::Cfc60, Standard::Iso6487).unwrap();
    let channel = Channel::of(
        &[4, 7],
        Some(Filter::iso(Class::Cfc60)),
        Combination::Resultant,
    )
    .unwrap();
    let samples = |output: usize| match output {
        4 => x.clone(),
        _ => y.clone(),
    };
    let found = channel.form(samples, 1e-4).unwrap();
    for ((found, x), y) in found.iter().zip(of(&x)).zip(of(&y)) {
        assert!((found - x.hypot(y)).abs() < 1e-15);
    }
    // samples too far apart for the class
    assert!(channel.form(samples, 2e-3).is_none());
    assert!(Channel::of(&[1], None, Combination::Resultant).is_none());
}

/// At rest the slope of a resultant is 0; elsewhere it is that of the root.
#[test]
fn resultants_have_slopes_at_rest_too() {
    let dual = |value: f64, slope: f64| Dual { value, slope };
    let signals = [
        vec![dual(0.0, 1.0), dual(3.0, 1.0)],
        vec![dual(0.0, 2.0), dual(4.0, 0.5)],
    ];
    let found = Combination::Resultant.form(&signals, 1e-4).unwrap();
    assert_eq!((found[0].value, found[0].slope), (0.0, 0.0));
    assert!((found[1].value - 5.0).abs() < 1e-15);
    assert!((found[1].slope - 1.0).abs() < 1e-15);
}
