//! Stops, contacts and belts that are far stiffer than the rest of the scene.
//!
//! A step with error control has an error of at most a_x in a coordinate and r v + a_v in a velocity v, with the
//! relative tolerance r and the absolute tolerances a. While a spring of frequency ω acts, the point (v, ω x) moves on
//! a circle: an error of x counts as ω times as much of v, and neither grows. Without losses, errors of the amplitude
//! √(v² + ω² x²) add up, and N steps change it by at most N (r v + a_v + ω a_x), whatever happens in between.

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::jobs::{adaptive, name, name_with_kinks, with_kinks};
use crate::measure::{error_of_rate, error_of_speed, largest, steps};
use crate::scene;
use bryant_runtime::{Formula, Tolerances};

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::Stiffness,
        name: "pressed against a stop of 1e6 N·m/rad on 1e-3 kg·m²",
        law: "The wheel comes to rest at the depth M/k. An explicit method cannot take steps longer than about 3/ω = 0.1 ms there, and \
              must find this out by itself. A method for stiff problems can take longer steps.",
        run: pressed,
    },
    Case {
        group: Group::Stiffness,
        name: "thrown between stops of 1e6 N·m/rad",
        law: "Without damping the energy (J θ'² + k d²)/2 of the wheel is constant; d is the depth in a stop.",
        run: thrown,
    },
    Case {
        group: Group::Stiffness,
        name: "a ball on a plate of 1e9 N/m",
        law: "No energy is lost: each jump reaches the height of the first.",
        run: hard_ball,
    },
    Case {
        group: Group::Stiffness,
        name: "a belt that snaps taut at 10 m/s",
        law: "The belt is taut for half an oscillation, the time π √(m/k). Its largest tension is v √(k m), and the mass leaves as fast as \
              it came.",
        run: snapping_belt,
    },
];

/// Methods with error control that are not made for stiff problems.
const EXPLICIT: [Formula; 5] = [
    Formula::Heun,
    Formula::Merson,
    Formula::Dopri5,
    Formula::Tsit5,
    Formula::Dop853,
];

fn pressed(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("pressed-stop");
    let rest = 0.1 + 2.0 / 1e6;
    let omega = (1e6f64 / 1e-3).sqrt();
    // speed is largest at ω t = 1 in x = −d (1 + ω t) exp(−ω t)
    let fastest = 2.0 / 1e6 * omega * (-1.0f64).exp();
    let tolerances: &[f64] = match bench.full() {
        true => &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12],
        false => &[1e-2, 1e-4, 1e-6, 1e-10],
    };
    for formula in EXPLICIT {
        for &tolerance in tolerances {
            bench.variant(name(formula, tolerance));
            let tolerances = Tolerances::uniform(tolerance);
            let run = bench.run(&scene, &adaptive(formula, tolerances))?;
            let away = run.output("angle")?.into_iter().map(|a| (a - rest).abs());
            // number of steps in 1 s
            let taken = steps(&run).unwrap_or(f64::NAN);
            let left = errors_left(&tolerances, omega, omega / taken, fastest);
            bench.at_most(
                "distance from the position of rest",
                largest(away),
                left + 2.0 / 1e6,
                "rad",
                "Σ ((1 + k z) a_θ + k z (r θ' + a_ω)/ω) exp(−k z): the remaining errors of the steps k steps ago, z = ω h of the \
                 steps, and the remaining way",
            );
        }
    }
    let tolerances = Tolerances::of(1e-4);
    let explicit = steps(&bench.succeed(&scene, &adaptive(Formula::Dopri5, tolerances))?)?;
    let stiff = steps(&bench.succeed(&scene, &adaptive(Formula::Rodas5, tolerances))?)?;
    bench.variant("rodas5 against dopri5 at 1e-4");
    bench.at_least(
        format!("{explicit} steps over {stiff}"),
        explicit / stiff,
        100.0,
        "",
        "the demand on a method for stiff problems: steps a hundred times longer",
    );
    Ok(())
}

/// The errors that remain after many steps of length z/ω in a critically damped mode, which takes (x, v) to (x (1 + ω
/// t) + v t) exp(−ω t): with q = exp(−z), Σ qᵏ = 1/(1 − q) and Σ k qᵏ = q/(1 − q)².
fn errors_left(of: &Tolerances, omega: f64, z: f64, rate: f64) -> f64 {
    let q = (-z).exp();
    let decaying = 1.0 / (1.0 - q);
    let moving = z * q * decaying * decaying;
    of.angles * (decaying + moving) + error_of_rate(of, rate, 0.0) / omega * moving
}

fn thrown(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("rebound-stop");
    let (inertia, stiffness, rate): (f64, f64, f64) = (1e-3, 1e6, 10.0);
    let omega = (stiffness / inertia).sqrt();
    let speed = |state: &[f64]| {
        let depth = (state[0].abs() - 0.1).max(0.0);
        state[1].hypot(omega * depth)
    };
    for formula in EXPLICIT {
        for tolerance in [1e-2, 1e-5, 1e-9] {
            bench.variant(name(formula, tolerance));
            let tolerances = Tolerances::of(tolerance);
            let run = bench.succeed(&scene, &adaptive(formula, tolerances))?;
            let speeds: Vec<f64> = run.states.iter().map(|state| speed(state)).collect();
            let grown = largest(speeds.iter().copied()) / rate;
            bench.at_most(
                format!("growth of the speed in each of {} steps", steps(&run)?),
                grown.ln().max(0.0) / steps(&run)?,
                2.0 * tolerance,
                "",
                "each step may err by tolerance × (1 + θ'), always in the same direction; a step above its limit of stability would double the error",
            );
            if tolerance < 1e-6 {
                let away = speeds.iter().map(|speed| (speed - rate).abs());
                bench.at_most(
                    "change of the speed",
                    largest(away),
                    steps(&run)? * error_of_rate(&tolerances, rate, omega),
                    "rad/s",
                    "steps × (r θ' + a_ω + ω a_θ): they do not grow if energy is conserved",
                );
            }
        }
    }
    Ok(())
}

fn hard_ball(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("hard-ball");
    let (gravity, stiffness): (f64, f64) = (10.0, 1e9);
    let omega = stiffness.sqrt();
    // T + V with the height above the first touch
    let energy = |state: &[f64]| {
        let height = state[1] - 0.1;
        let speed = state[4];
        0.5 * speed * speed + gravity * height + 0.5 * stiffness * height.min(0.0).powi(2)
    };
    let first = gravity * 1.0;
    let speed = (2.0 * first).sqrt();
    for (formula, tolerance, locate) in [
        (Formula::Dopri5, 1e-9, false),
        (Formula::Dopri5, 1e-9, true),
        (Formula::Dop853, 1e-12, false),
        (Formula::Dop853, 1e-12, true),
        (Formula::Rodas5, 1e-9, true),
    ] {
        bench.variant(name_with_kinks(formula, tolerance, locate));
        let tolerances = Tolerances::of(tolerance);
        let asked = with_kinks(formula, tolerances, locate);
        let run = bench.succeed(&scene, &asked)?;
        let away = run
            .states
            .iter()
            .map(|y| ((2.0 * energy(y)).sqrt() - speed).abs());
        bench.at_most(
            "change of the speed at touch",
            largest(away),
            steps(&run)? * error_of_speed(&tolerances, speed, omega),
            "m/s",
            "steps × (r v + a_v + ω a_x): they do not grow if energy is conserved",
        );
    }
    Ok(())
}

fn snapping_belt(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("snapping-belt");
    let (mass, speed, slack, length): (f64, f64, f64, f64) = (4.0, 10.0, 0.01, 0.51);
    let stiffness = 5e7 / length;
    let omega = (stiffness / mass).sqrt();
    let taut = slack / speed;
    let half = std::f64::consts::PI / omega;
    for (formula, tolerance, locate) in [
        (Formula::Dopri5, 1e-8, false),
        (Formula::Dopri5, 1e-8, true),
        (Formula::Dop853, 1e-11, true),
        (Formula::Rodas5, 1e-8, true),
    ] {
        bench.variant(name_with_kinks(formula, tolerance, locate));
        let tolerances = Tolerances::uniform(tolerance);
        let asked = with_kinks(formula, tolerances, locate);
        let run = bench.succeed(&scene, &asked)?;
        // an error of speed while the belt is slack changes the time at which it becomes taut
        let flown = error_of_speed(&tolerances, speed, 0.0) * omega * taut;
        let error = steps(&run)? * (error_of_speed(&tolerances, speed, omega) + flown);
        let because = "steps × ((r v + a_v) (1 + ω t) + ω a_x), t the time of slack; an oscillation rotates errors and does not amplify them";
        let exact = |t: f64| match t {
            t if t <= taut => (speed * t, speed, 0.0),
            t if t <= taut + half => {
                let (sin, cos) = (omega * (t - taut)).sin_cos();
                let stretch = speed / omega * sin;
                (slack + stretch, speed * cos, stiffness * stretch)
            }
            t => (slack - speed * (t - taut - half), -speed, 0.0),
        };
        let away = |name: &str, of: fn((f64, f64, f64)) -> f64| -> Result<f64, Trouble> {
            let values = run.output(name)?.into_iter().zip(&run.times);
            Ok(largest(values.map(|(x, t)| (x - of(exact(*t))).abs())))
        };
        bench.at_most(
            "error of the speed",
            away("velocity", |exact| exact.1)?,
            error,
            "m/s",
            because,
        );
        // in the oscillation, an error of speed becomes a displacement of 1/ω times as much
        bench.at_most(
            "error of the tension",
            away("tension", |exact| exact.2)?,
            stiffness * error / omega,
            "N",
            "k/ω times that",
        );
        let duration = run.times.last().copied().unwrap_or(0.0);
        bench.at_most(
            "error of the position",
            away("x", |exact| exact.0)?,
            error * duration + error / omega,
            "m",
            "that for 3 ms, and the error of a step",
        );
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_left_are_the_sum_over_all_steps_before() {
        let of = Tolerances {
            relative: 1e-3,
            angles: 2e-3,
            angular_velocities: 5e-3,
            ..Tolerances::of(1e-3)
        };
        let (omega, rate) = (50.0, 4.0);
        for z in [0.5, 1.0, 3.0] {
            let (mut sum, slip) = (0.0, 1e-3 * rate + 5e-3);
            for k in 0..200 {
                let passed = f64::from(k) * z;
                sum += (2e-3 * (1.0 + passed) + slip / omega * passed) * (-passed).exp();
            }
            let closed = errors_left(&of, omega, z, rate);
            // 200 terms, each rounded a few times; the neglected terms are below exp(−100)
            assert!(
                (closed / sum - 1.0).abs() < 1000.0 * f64::EPSILON,
                "{closed} {sum}"
            );
        }
    }
}
