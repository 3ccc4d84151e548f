//! Belts that pay out and take in webbing, against closed forms.
//!
//! As in `laws`, the error of a run is at most steps · tolerance, times the largest rate ω of the mechanism if a
//! coordinate becomes a velocity. The location of an event errs by less: it uses the interpolant of a step.

use bryant_runtime::program::Entry;
use bryant_tests::models;
use bryant_tests::runs::{Recording, run};

const TOLERANCE: f64 = 1e-11;
/// Untensioned length of all belts except the reel's \[m\].
const LENGTH: f64 = 0.5;

fn entry() -> Entry {
    models::webbing::ENTRY
}

/// Error of the integration if the largest rate of the mechanism is this \[1/s\].
fn integration(run: &Recording, rate: f64) -> f64 {
    run.steps * TOLERANCE * rate.max(1.0)
}

fn close(what: &str, ours: f64, expected: f64, bound: f64) {
    let error = (ours - expected).abs();
    assert!(
        error <= bound,
        "{what}: {ours} instead of {expected}, off by {error:e}, allowed {bound:e}"
    );
}

fn last(run: &Recording, name: &str) -> f64 {
    let column = run.column(name);
    column[column.len() - 1]
}

#[test]
fn a_limiter_absorbs_the_energy_that_it_is_given() {
    let (mass, speed, stiffness) = (10.0, 10.0, 40e3);
    let omega = f64::sqrt(stiffness / LENGTH / mass);
    for limit in [3e3, 4e3, 6e3] {
        let run = run(&entry(), &[("limit", limit)], TOLERANCE);
        let error = integration(&run, omega);
        // Up to F the webbing stores F ε_F ℓ/2. From there on the mass moves (1 + ε_F) for each metre paid out, against
        // F.
        let strain = limit / stiffness;
        let stored = 0.5 * limit * strain * LENGTH;
        let energy = 0.5 * mass * speed * speed;
        let payout = (energy - stored) / (limit * (1.0 + strain));
        close("payout", last(&run, "crash payout"), payout, error);
        // and the energy stored in the longer webbing is returned
        let back = limit * strain * (LENGTH + payout);
        let rebound = -f64::sqrt(back / mass);
        close("rebound", last(&run, "crash v"), rebound, error);

        let stop = run.column("crash v").iter().position(|v| *v < 0.0).unwrap();
        let mut limited = 0;
        for (k, tension) in run.column("crash tension").into_iter().enumerate() {
            assert!(tension <= limit, "{tension} N beyond {limit} N");
            // from v_F = √(v² − 2 E/m) on, the speed falls by F/m
            limited += usize::from(k < stop && (tension - limit).abs() <= 1e-12 * limit);
        }
        let braking = f64::sqrt(speed * speed - 2.0 * stored / mass) * mass / limit;
        let samples = braking / 0.2e-3;
        assert!(
            (limited as f64 - samples).abs() <= 2.0,
            "{limited} {samples}"
        );
        // a limiter never takes webbing back
        let payouts = run.column("crash payout");
        assert!(payouts.windows(2).all(|w| w[1] >= w[0] - 1e-15));
    }
}

#[test]
fn a_limit_that_is_never_reached_changes_nothing() {
    let run = run(&entry(), &[("limit", 50e3)], TOLERANCE);
    let omega = f64::sqrt(40e3 / LENGTH / 10.0);
    assert_eq!(last(&run, "crash payout"), 0.0);
    close(
        "rebound",
        last(&run, "crash v"),
        -10.0,
        integration(&run, omega),
    );
    for (t, x) in run.times.iter().zip(run.column("crash x")) {
        if omega * t < std::f64::consts::PI {
            let expected = 10.0 / omega * (omega * t).sin();
            close("position", x, expected, integration(&run, 1.0));
        }
    }
}

#[test]
fn a_retractor_locks_at_the_tension_that_there_is() {
    let (mass, speed, stiffness, lock) = (4.0, 2.0, 40e3, 0.02);
    for spool in [0.0, 5.0, 40.0] {
        let run = run(&entry(), &[("spool", spool)], TOLERANCE);
        let strain = spool / stiffness;
        let at_lock = LENGTH + speed * lock - 0.5 * spool / mass * lock * lock;
        let speed_there = speed - spool / mass * lock;
        let length = at_lock / (1.0 + strain);
        let spring = stiffness / length;
        let omega = f64::sqrt(spring / mass);
        let error = integration(&run, omega);
        let turn = ((speed_there * omega * mass).atan2(-spool)) / omega;
        let mut locked = 0;
        for (k, t) in run.times.iter().enumerate() {
            let tension = run.column("reel tension")[k];
            let tau = t - lock;
            if tau <= 0.0 {
                assert_eq!(tension, spool, "at {t} s");
                let free = LENGTH + speed * t - 0.5 * spool / mass * t * t;
                let untensioned = free / (1.0 + strain);
                close("length", run.column("reel length")[k], untensioned, error);
            } else if tau < turn {
                // m ẍ = −T, T = spool + k (x − x_lock): neither the tension nor the speed jumps
                let (s, c) = (omega * tau).sin_cos();
                let expected = spool * c + spring * speed_there / omega * s;
                close("tension", tension, expected, spring * error);
                close("length", run.column("reel length")[k], length, error);
                locked += 1;
            }
        }
        assert!(locked > 50, "{locked}");
        let payout = length - LENGTH / (1.0 + strain);
        close("payout", last(&run, "reel payout"), payout, error);
    }
}

#[test]
fn damping_begins_where_a_retractor_locks() {
    let (lock, speed, stretch) = (0.02, 2.0, 1e-3);
    let damping = 300.0;
    let run = run(&entry(), &[("reel_damping", damping)], TOLERANCE);
    let k = run.at(lock);
    let tension = run.column("reel tension");
    assert_eq!(tension[k], 5.0);
    // between two samples the tension grows at most by its largest rate: at full speed, with damping that fades in over
    // 1 mm
    let steepest = (40e3 / LENGTH + damping * speed / stretch) * speed * 0.2e-3;
    let step = tension[k + 1] - tension[k];
    assert!(0.0 < step && step <= steepest, "{step} N of {steepest} N");
    // which is a small part of the damping without fading in
    assert!(tension[k + 1] < 5.0 + 0.5 * damping * speed);
}

#[test]
fn a_pretensioner_shifts_the_untensioned_length() {
    let run = run(&entry(), &[], TOLERANCE);
    let (stiffness, fired) = (20e3, 0.015);
    let mut pulling = 0;
    for (k, t) in run.times.iter().enumerate() {
        let taken = 6.0 * (t - fired).clamp(0.0, 10e-3);
        let untensioned = LENGTH + 0.02 - taken;
        let expected = stiffness * (LENGTH / untensioned - 1.0).max(0.0);
        pulling += usize::from(expected > 0.0);
        // the firing is located to 1e-13 of a step of at most 120 ms here, in which 6 m/s take little webbing in
        let missed = 6.0 * 0.12 * 1e-13 + 4.0 * f64::EPSILON;
        let bound = stiffness * LENGTH / untensioned.powi(2) * missed + 1e-15 * stiffness;
        close("tension", run.column("tight tension")[k], expected, bound);
        close("payout", run.column("tight payout")[k], -taken, missed);
    }
    assert!(pulling > 100);
}

#[test]
fn steep_unloading_gives_back_a_part_of_the_speed() {
    let run = run(&entry(), &[], TOLERANCE);
    let (mass, speed, stiffness, steepness) = (4.0, 3.0, 10e3, 4.0);
    let spring: f64 = stiffness / LENGTH;
    let omega = f64::sqrt(steepness * spring / mass);
    let error = integration(&run, omega);
    // the triangle under a line that is four times as steep: a quarter of the energy, half the speed
    close("rebound", last(&run, "plastic v"), -speed / 2.0, error);
    let largest = f64::sqrt(mass * speed * speed / spring) / LENGTH;
    let set = largest * (1.0 - 1.0 / steepness);
    close(
        "permanent set",
        last(&run, "plastic set"),
        set,
        error / LENGTH,
    );

    // a switch by force: k v/ω sin ω t = 500 N on the way up, where the tension grows by k v cos ω t
    let omega = f64::sqrt(spring / mass);
    let phase = (500.0 * omega / (spring * speed)).asin();
    let bound = error / (speed * phase.cos());
    close(
        "switch by force",
        last(&run, "pulled"),
        phase / omega,
        bound,
    );
}

#[test]
fn all_of_it_pulls_between_nothing_and_the_limit() {
    let run = run(&entry(), &[], TOLERANCE);
    let tension = run.column("all tension");
    let sudden = tension.iter().position(|t| *t != 10.0).unwrap();
    assert!(sudden > 10, "{sudden}");
    for (t, tension) in run.times.iter().zip(&tension) {
        assert!((0.0..=2500.0).contains(tension), "{tension} N at {t} s");
        assert!(
            *t <= 0.09 || *tension == 0.0,
            "{tension} N at {t} s, when torn"
        );
    }
    assert!(tension.contains(&2500.0));
}
