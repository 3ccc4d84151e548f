//! Events that begin and end within one step, so that the ends of the step do not show them.

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::jobs::{adaptive, fixed, name};
use crate::random::Random;
use crate::scene;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Tolerances};
use std::f64::consts::PI;

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::NonSmoothness,
        name: "a ball that flies at another, at 0.1 to 500 m/s",
        law: "Equal masses in an elastic impact exchange their speeds. While no force acts, the error is 0 and steps grow. No ball may fly \
              through the other one within a step.",
        run: bullets,
    },
    Case {
        group: Group::NonSmoothness,
        name: "a threshold that is passed for a moment",
        law: "A switch fires when its quantity passes a threshold, however soon the quantity comes back. The switched force then moves the \
              swing by 0.1 rad.",
        run: thresholds,
    },
    Case {
        group: Group::NonSmoothness,
        name: "a switch that is flown past, at 0.5 to 500 m/s",
        law: "A distance falls and rises in straight lines, and a switch fires when it is below a threshold of 1 mm to 0.5 m. Free flight \
              makes no error, so a step could be as long as the whole flight. From the switch on a force of 100 N moves a mass of 1 kg by \
              50 t² m.",
        run: flown_past,
    },
];

/// Methods with error control, and their tolerances.
const METHODS: [(Formula, f64); 5] = [
    (Formula::Dopri5, 1e-7),
    (Formula::Tsit5, 1e-4),
    (Formula::Merson, 1e-6),
    (Formula::Dop853, 1e-9),
    (Formula::Rodas5, 1e-7),
];

/// Number of scenes of each method.
const SCENES: usize = 40;

fn log_uniform(random: &mut Random, low: f64, high: f64) -> f64 {
    random.uniform(low.ln(), high.ln()).exp()
}

fn bullets(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("bullet");
    let mut random = Random::new(20);
    for (formula, tolerance) in METHODS {
        bench.variant(name(formula, tolerance));
        let mut missed = 0;
        for _ in 0..SCENES {
            let speed = log_uniform(&mut random, 0.1, 500.0);
            let size = log_uniform(&mut random, 1e-3, 0.3);
            // the stiffness that turns the relative motion, whose mass is 1/2, within a tenth of the size
            let stiffness = 0.5 * (speed / (0.1 * size)).powi(2);
            let job = Job {
                parameters: vec![
                    ("speed".into(), speed),
                    ("size".into(), size),
                    ("stiffness".into(), stiffness),
                ],
                // the run ends some time after the impact, different in every scene
                duration: Some(random.uniform(1.5, 20.0) / speed),
                every: Some(1.0 / speed),
                ..adaptive(formula, Tolerances::of(tolerance))
            };
            let run = bench.succeed(&scene, &job)?;
            let speeds = run.output("speed")?;
            missed += usize::from(speeds[speeds.len() - 1] < 0.5 * speed);
        }
        bench.at_most(
            format!("impacts of {SCENES} that are missed"),
            missed as f64,
            0.0,
            "",
            "the target gets all of the speed, or none if the ball flew through it",
        );
    }
    Ok(())
}

fn thresholds(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("passed-threshold");
    let mut random = Random::new(21);
    for (formula, tolerance) in METHODS {
        bench.variant(name(formula, tolerance));
        let mut missed = 0;
        for _ in 0..SCENES {
            // the overshoot is above the error of angles: about a hundred steps of a tenth of the tolerance each
            let over = log_uniform(&mut random, 100.0 * tolerance, 3e-2);
            let phase = random.uniform(0.3, 2.0 * PI - 0.3);
            let job = Job {
                parameters: vec![
                    ("start".into(), phase.cos()),
                    ("speed".into(), -10.0 * phase.sin()),
                    ("level".into(), 1.0 - over),
                ],
                ..adaptive(formula, Tolerances::of(tolerance))
            };
            let run = bench.succeed(&scene, &job)?;
            let angles = run.output("angle")?;
            let away = angles[angles.len() - 1] - expected(phase, 1.0 - over);
            missed += usize::from(away.abs() > 0.01);
        }
        bench.at_most(
            format!("switches of {SCENES} that do not fire"),
            missed as f64,
            0.0,
            "",
            "without the push the swing differs by up to 0.1 rad",
        );
    }
    Ok(())
}

fn flown_past(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("passed-by");
    let mut random = Random::new(22);
    let steps = [
        (Formula::Rk4, 0.1),
        (Formula::Dopri5, 0.01),
        (Formula::Heun, 1.0),
    ];
    let with_tolerance = METHODS.map(|(formula, tolerance)| {
        let job = adaptive(formula, Tolerances::of(tolerance));
        (name(formula, tolerance), job)
    });
    let of_steps = steps.map(|(formula, step)| {
        (
            format!("{formula}, steps of {step} s"),
            fixed(formula, step),
        )
    });
    for (name, method) in with_tolerance.into_iter().chain(of_steps) {
        bench.variant(name);
        let mut missed = 0;
        for _ in 0..SCENES {
            let speed = log_uniform(&mut random, 0.5, 500.0);
            let at = random.uniform(0.1, 0.9);
            // the force law does not act at either end of the run
            let near = log_uniform(&mut random, 1e-3, 0.5f64.min(0.09 * speed));
            let aside = 0.95 * near * random.uniform(0.0, 1.0);
            let parameters = [
                ("start", -speed * at),
                ("aside", aside),
                ("speed", speed),
                ("near", near),
            ];
            let job = Job {
                parameters: parameters.map(|(name, value)| (name.into(), value)).into(),
                ..method.clone()
            };
            let run = bench.succeed(&scene, &job)?;
            let z = run.output("z")?;
            let left = 1.0 - at + (near * near - aside * aside).sqrt() / speed;
            let exact = aside + 50.0 * left * left;
            missed += usize::from((z[z.len() - 1] - exact).abs() > 1e-2 * exact);
        }
        bench.at_most(
            format!("switches of {SCENES} that do not fire"),
            missed as f64,
            0.0,
            "",
            "without the push the ball stays within half a metre, with the push it moves by 0.5 to 50 m",
        );
    }
    Ok(())
}

/// The angle after 1 s. It is cos(10 t + p) until it first rises through the level; from then on it oscillates about
/// 0.05, where spring and push are in balance.
fn expected(phase: f64, level: f64) -> f64 {
    let up = -level.acos();
    let at = 0.1 * (up - phase).rem_euclid(2.0 * PI);
    let left = 10.0 * (1.0 - at);
    0.05 + (level - 0.05) * left.cos() - up.sin() * left.sin()
}
