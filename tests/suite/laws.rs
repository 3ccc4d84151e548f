//! Force laws against the closed forms of `reference/contact.yaml`.
//!
//! The error of a run is at most steps · tolerance times the amplification of the mechanism. In these mechanisms, a
//! coordinate with the error e causes a velocity error ω e and vice versa, where ω is the largest rate of the
//! mechanism: steps · tolerance · max(ω, 1).

use bryant_tests::models;
use bryant_tests::runs::{Recording, run};
use serde_yaml::Value;

pub const TOLERANCE: f64 = 1e-11;
pub const G: f64 = 9.81;

/// Error of the integration if the largest rate of the mechanism is this \[1/s\].
pub fn integration(run: &Recording, rate: f64) -> f64 {
    run.steps * TOLERANCE * rate.max(1.0)
}

pub fn close(what: &str, ours: f64, expected: f64, bound: f64) {
    let error = (ours - expected).abs();
    assert!(
        error <= bound,
        "{what}: {ours} instead of {expected}, off by {error:e}, allowed {bound:e}"
    );
    assert!(
        bound <= 2e-2 * expected.abs(),
        "{what}: the bound {bound:e} on {expected} is empty"
    );
}

pub fn last(column: &[f64]) -> f64 {
    column[column.len() - 1]
}

#[test]
fn a_damped_ball_bounces_with_the_restitution_of_its_damping() {
    let entry = models::bounce::ENTRY;
    let reference: Value = serde_yaml::from_str(include_str!("../reference/contact.yaml"))
        .expect("reference files are YAML");
    let numbers = |key: &str| -> Vec<f64> {
        let list = reference["linear_spring_dashpot"][key].as_sequence();
        let list = list.expect("a list");
        list.iter().filter_map(Value::as_f64).collect()
    };
    let (stiffness, omega) = (1e4, 100.0);
    let pairs = numbers("zeta")
        .into_iter()
        .zip(numbers("e_force_clamped_at_zero"));
    for (zeta, restitution) in pairs {
        // ζ = d/(2 √(k m)), m = 1 kg
        let damping = 2.0 * zeta * f64::sqrt(stiffness);
        let run = run(&entry, &[("damping", damping)], TOLERANCE);
        // it began at a depth of 1e-12 m
        let bound = integration(&run, omega) + 1e-12 * omega;
        close(
            &format!("restitution at ζ = {zeta}"),
            last(&run.column("velocity")),
            restitution,
            bound,
        );
        assert!(run.column("force").iter().all(|force| *force >= 0.0));
        // the force vanishes at the time of the formula, between these two samples
        let s = (1.0 - zeta * zeta).sqrt();
        let angle = std::f64::consts::PI - (2.0 * zeta * s).atan2(1.0 - 2.0 * zeta * zeta);
        let end = angle / (omega * s);
        for (t, force) in run.times.iter().zip(run.column("force")) {
            assert_eq!(force > 0.0, *t < end, "force {force} at {t} s, ζ = {zeta}");
        }
    }
}

#[test]
fn a_sliding_block_stops_after_its_stopping_distance() {
    let entry = models::sliding_block::ENTRY;
    let (speed, tolerance_speed) = (2.0, 0.01);
    for mu in [0.2, 0.4, 0.8] {
        let run = run(&entry, &[("mu", mu)], TOLERANCE);
        let deceleration = mu * G;
        let (x, v) = (run.column("x"), run.column("vx"));
        // Below the tolerance speed it no longer brakes fully: from there it travels v_tol²/(μ g) instead of half of
        // that.
        let ideal = speed * speed / (2.0 * deceleration);
        let creep = tolerance_speed * tolerance_speed / (2.0 * deceleration);
        let error = integration(&run, deceleration / tolerance_speed);
        close("stopping distance", last(&x), ideal + creep, error);
        close("stopping distance", last(&x), ideal, creep + error);
        // until then it brakes with constant deceleration
        let stop = (speed - tolerance_speed) / deceleration;
        for (t, v) in run.times.iter().zip(&v).filter(|(t, _)| **t < stop) {
            close("speed", *v, speed - deceleration * t, error);
        }
    }
}

#[test]
fn a_ball_slips_until_it_rolls() {
    let entry = models::sliding_sphere::ENTRY;
    let (speed, mu, tolerance_speed, radius) = (5.0, 0.2, 0.01, 0.1);
    let run = run(&entry, &[("mu", mu)], TOLERANCE);
    // the slip is reduced with a(1 + m r²/I) = 7/2 μ g; below the tolerance speed it decays with the time constant τ
    let rate = 3.5 * mu * G;
    let fading = tolerance_speed / rate;
    let error = integration(&run, 1.0 / fading);
    let (rolls, rolling) = (2.0 * speed / (7.0 * mu * G), 5.0 * speed / 7.0);
    let columns = ["x", "y", "vx", "vy", "wx", "wy"].map(|name| run.column(name));
    let (mut slipping, mut rolled) = (0, 0);
    for (k, t) in run.times.iter().enumerate() {
        let [x, y, vx, vy, wx, wy] = std::array::from_fn(|i| columns[i][k]);
        // everything is along (3, 4, 0), the spin across it
        let (along, across) = ((3.0 * vx + 4.0 * vy) / 5.0, (4.0 * vx - 3.0 * vy) / 5.0);
        assert!(across.abs() <= error, "drift {across} at {t} s");
        let spin = (3.0 * wy - 4.0 * wx) / 5.0;
        if *t < rolls - fading {
            slipping += 1;
            close("speed", along, speed - mu * G * t, error);
            close(
                "slip",
                along - radius * spin,
                speed - rate * t,
                10.0 * error,
            );
        } else if *t > rolls + 40.0 * fading {
            rolled += 1;
            close("speed", along, rolling, error);
            close("spin", radius * spin, rolling, error);
            // The decaying slip travels v_tol τ/2 further than an ideal one; the centre moves by two sevenths of it.
            let slid = 12.0 * speed * speed / (49.0 * mu * G);
            let ideal = slid + rolling * (t - rolls);
            let more = tolerance_speed * fading / 7.0;
            close("way", (3.0 * x + 4.0 * y) / 5.0, ideal + more, error);
        }
    }
    assert!(slipping > 10 && rolled > 10, "{slipping} {rolled}");
}

#[test]
fn an_ellipse_rocks_with_its_frequency() {
    let entry = models::rocking::ENTRY;
    let (m, a, c, inertia, angle) = (2.0, 0.3, 0.2, 0.065, 1e-3);
    let frequency = |inertia: f64| f64::sqrt(m * G * (a * a - c * c) / (c * inertia));
    // A swing of amplitude θ₀ is slower than a small one by a share proportional to θ₀². One part comes from the lever
    // arm h' = c α sin θ cos θ/√(1 + α sin² θ), which decreases by (2/3 + α/2) θ²; another from the centre, which rises
    // with it: m h'² = m c² α² θ² in addition to I. α = a²/c² − 1.
    let alpha = a * a / (c * c) - 1.0;
    let swing = angle * angle * (1.0 + alpha + m * c * c * alpha * alpha / inertia);
    let check = |parameters: &[(&str, f64)], omega: f64, slip: f64| {
        let run = run(&entry, parameters, TOLERANCE);
        // Errors of the height and of the slip stay constant or decay: only ω amplifies an error of the angle.
        let error = integration(&run, omega);
        for (t, ours) in run.times.iter().zip(run.column("angle")) {
            let expected = angle * (omega * t).cos();
            // the phase is wrong by these shares of it
            let bound = angle * omega * t * (swing + slip) + error;
            assert!(
                (ours - expected).abs() <= bound && bound < 0.02 * angle,
                "angle at {t} s: {ours} instead of {expected}, allowed {bound:e}"
            );
        }
    };
    check(&[], frequency(inertia), 0.0);

    // Rolling: friction below its tolerance speed is a damper of μ m g/v_tol, whose slip is the share ω v_tol/(μ g) of
    // the motion.
    let (mu, tolerance_speed) = (10.0, 0.01);
    let omega = frequency(inertia + m * c * c);
    let slip = omega * tolerance_speed / (mu * G);
    check(
        &[("mu", mu), ("tolerance_speed", tolerance_speed)],
        omega,
        slip,
    );
}

#[test]
fn slack_makes_the_peak_of_a_belt() {
    let entry = models::slack_belt::ENTRY;
    let (mass, field, stiffness) = (4.0, 200.0, 2e4);
    for slack in [0.0, 0.01, 0.04] {
        let run = run(&entry, &[("slack", slack)], TOLERANCE);
        let length = 0.5 + slack;
        let omega = f64::sqrt(stiffness / length / mass);
        let error = integration(&run, omega);
        let tension = run.column("tension");
        let peak = tension.iter().fold(0.0f64, |m, x| m.max(*x)) / mass;
        let expected = field * (1.0 + f64::sqrt(1.0 + 2.0 * slack * omega * omega / field));
        // the peak is within half a sampling interval of a sample: at most (ω Δt/2)²/2 of the amplitude above it
        let sampling = (expected - field) * (omega * 0.5e-4f64).powi(2) / 2.0;
        let bound = sampling + omega * omega * error;
        close(&format!("peak, slack {slack} m"), peak, expected, bound);
        assert!(peak <= expected + omega * omega * error);
        // an accelerometer on the mass reads the effect of the belt, and nothing before
        for (reading, tension) in run.column("accelerometer").iter().zip(&tension) {
            let bound = 1e-12 * expected;
            assert!(
                (reading + tension / mass).abs() <= bound,
                "{reading} {tension}"
            );
        }
        // the mass reaches the belt with √(2 a₀ s)
        let taut = f64::sqrt(2.0 * slack / field);
        if slack > 0.0 {
            let k = run.at(taut);
            let speed = f64::sqrt(2.0 * field * slack);
            close("take-up speed", run.column("vx")[k], speed, error);
        }
    }
}
