//! Stops, contacts and belts far stiffer than the rest of the scene.
//!
//! A step under control of its error errs by no more than tolerance · (1 + |y|) in each entry y of the state. An error δ of a coordinate
//! becomes one of ω δ of its velocity while a spring of frequency ω acts, so that N steps change a speed v by at most
//! N · tolerance · (1 + v) · ω, whatever lies between.

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::jobs::{adaptive, name, name_with_kinks, with_kinks};
use crate::measure::{largest, steps};
use crate::scene;
use bryant_runtime::{Formula, Tolerances};

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::Stiffness,
        name: "pressed against a stop of 1e6 N·m/rad on 1e-3 kg·m²",
        law: "The wheel comes to rest at the depth M/k. An explicit method cannot take steps longer than about 3/ω = 0.1 ms there, and \
              must find that out by itself; one for stiff problems may.",
        run: pressed,
    },
    Case {
        group: Group::Stiffness,
        name: "thrown between stops of 1e6 N·m/rad",
        law: "Without damping the wheel keeps its energy: (J θ'² + k d²)/2, d the depth in a stop.",
        run: thrown,
    },
    Case {
        group: Group::Stiffness,
        name: "a ball on a plate of 1e9 N/m",
        law: "Nothing is lost: each jump reaches the height of the first.",
        run: hard_ball,
    },
    Case {
        group: Group::Stiffness,
        name: "a belt that snaps taut at 10 m/s",
        law: "From slack to slack is half an oscillation: tension v √(k m) at most, π √(m/k) long, and the mass leaves as fast as it came.",
        run: snapping_belt,
    },
];

/// Methods with control of their error that are not for stiff problems.
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
    let tolerances: &[f64] = match bench.full() {
        true => &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12],
        false => &[1e-2, 1e-4, 1e-6, 1e-10],
    };
    for formula in EXPLICIT {
        for &tolerance in tolerances {
            bench.variant(name(formula, tolerance));
            let run = bench.run(&scene, &adaptive(formula, Tolerances::uniform(tolerance)))?;
            let away = run.output("angle")?.into_iter().map(|a| (a - rest).abs());
            let finished = if run.result.is_ok() { 0.0 } else { f64::NAN };
            bench.at_most(
                "way from the place of rest",
                largest(away) + finished,
                10.0 * tolerance * (1.0 + rest) + 2.0 / 1e6,
                "rad",
                "ten steps' tolerance, for at the limit of stability errors of a step decay slowly, and the way to go",
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
            let run = bench.succeed(&scene, &adaptive(formula, Tolerances::of(tolerance)))?;
            let speeds: Vec<f64> = run.states.iter().map(|state| speed(state)).collect();
            let grown = largest(speeds.iter().copied()) / rate;
            bench.at_most(
                format!("growth of the speed in each of {} steps", steps(&run)?),
                grown.ln().max(0.0) / steps(&run)?,
                2.0 * tolerance,
                "",
                "each step may err by tolerance × (1 + θ'), always to the same side; one beyond its limit of stability would double its error",
            );
            if tolerance < 1e-6 {
                let away = speeds.iter().map(|speed| (speed - rate).abs());
                bench.at_most(
                    "change of the speed",
                    largest(away),
                    steps(&run)? * tolerance * (1.0 + rate) * omega,
                    "rad/s",
                    "steps × tolerance × (1 + θ') ω",
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
    // T + V from where it touches
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
        let asked = with_kinks(formula, Tolerances::of(tolerance), locate);
        let run = bench.succeed(&scene, &asked)?;
        let away = run
            .states
            .iter()
            .map(|y| ((2.0 * energy(y)).sqrt() - speed).abs());
        bench.at_most(
            "change of the speed at touch",
            largest(away),
            steps(&run)? * tolerance * (1.0 + speed) * omega,
            "m/s",
            "steps × tolerance × (1 + v) ω",
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
        let asked = with_kinks(formula, Tolerances::uniform(tolerance), locate);
        let run = bench.succeed(&scene, &asked)?;
        let error = steps(&run)? * tolerance * (1.0 + speed) * omega.max(1.0);
        let because = "steps × tolerance × (1 + v) ω";
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
        // an error of speed moves what oscillates by 1/ω of it
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
