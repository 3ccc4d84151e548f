//! Runs with meaningless settings and parameters.

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::case_model::CaseModel;
use crate::scene;
use bryant_runtime::program::{ErrorKind, Job, Scalar};
use bryant_runtime::{Adaptive, Formula, Integrator, Pace, Tolerances};

/// Settings of runs.
pub const SETTINGS: Case = Case {
    group: Group::Garbage,
    name: "runs with invalid settings",
    law: "A run with meaningless settings is refused, fails with a message, or ends within its limit of steps with finite \
          numbers.",
    run: settings,
};

/// Parameters of runs.
pub const PARAMETERS: Case = Case {
    group: Group::Garbage,
    name: "runs with extreme parameters",
    law: "A run with meaningless parameters is refused, fails with a message, or ends within its limit of steps with finite \
          numbers.",
    run: parameters,
};

/// Limit of steps: enough for meaningful settings, but soon reached by others.
const LIMIT: u64 = 20_000;

const GARBAGE: [f64; 13] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    -1.0,
    5e-324,
    -5e-324,
    1e-300,
    1e-17,
    1e9,
    1e300,
    f64::MAX,
];

/// Counts how runs ended.
#[derive(Default)]
struct Ends {
    refused: usize,
    failed: usize,
    finished: usize,
    wrong: Vec<String>,
}

impl Ends {
    fn run(
        &mut self,
        bench: &Bench<'_>,
        scene: &CaseModel,
        what: &str,
        job: &Job,
    ) -> Result<(), Trouble> {
        let run = bench.run(scene, job)?;
        let mut numbers = run
            .times
            .iter()
            .chain(run.states.iter().flatten())
            .chain(run.outputs.iter().flatten());
        if let Some(number) = numbers.find(|x| !x.is_finite()) {
            self.wrong.push(format!("{what}: {number} in a sample"));
        }
        match &run.result {
            Err(error) if error.message.is_empty() => {
                self.wrong.push(format!("{what}: no message"))
            }
            Err(error) if error.kind == ErrorKind::Job => self.refused += 1,
            Err(error) if error.message.contains("make no sense") => self.refused += 1,
            Err(_) => self.failed += 1,
            Ok(report) if report.steps + report.rejected > LIMIT => {
                self.wrong.push(format!("{what}: {} steps", report.steps));
            }
            Ok(report) if !report.t.is_finite() || run.times.is_empty() => {
                self.wrong.push(format!("{what}: ends at {}", report.t));
            }
            Ok(_) => self.finished += 1,
        }
        Ok(())
    }

    fn note(&self, bench: &mut Bench<'_>, least: [usize; 2]) {
        let total = self.refused + self.failed + self.finished;
        bench.states(
            "refused, failed with a message, or finished with finite numbers",
            self.wrong.is_empty(),
            match self.wrong.first() {
                None => format!(
                    "{total} runs: {} refused, {} failed, {} finished",
                    self.refused, self.failed, self.finished
                ),
                Some(first) => format!("{} wrong: {first}", self.wrong.len()),
            },
            "never a hang, a panic or a number that is not finite",
        );
        for (what, count, least) in [
            ("refused or failed", self.refused + self.failed, least[0]),
            ("finished", self.finished, least[1]),
        ] {
            bench.at_least(what, count as f64, least as f64, "", "both happen");
        }
    }
}

fn settings(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("oscillator");
    let mut ends = Ends::default();
    let plain = Job {
        max_steps: Some(LIMIT),
        ..Job::default()
    };
    let with = |change: &dyn Fn(&mut Adaptive)| {
        let mut adaptive = Adaptive::default();
        change(&mut adaptive);
        Some(Integrator {
            formula: Formula::Dopri5,
            pace: Pace::Adaptive(adaptive),
        })
    };
    let formulas = match bench.full() {
        true => &Formula::ALL[..],
        false => &[Formula::SemiImplicitEuler, Formula::Rk4, Formula::Rodas5],
    };
    for x in GARBAGE {
        let jobs = [
            (
                "duration",
                Job {
                    duration: Some(x),
                    ..plain.clone()
                },
            ),
            (
                "every",
                Job {
                    every: Some(x),
                    ..plain.clone()
                },
            ),
            (
                "duration and every",
                Job {
                    duration: Some(x),
                    every: Some(x),
                    ..plain.clone()
                },
            ),
            (
                "tolerance",
                Job {
                    method: Some(Integrator::adaptive(Formula::Dopri5, Tolerances::of(x))),
                    ..plain.clone()
                },
            ),
            (
                "tolerance of Rodas",
                Job {
                    method: Some(Integrator::adaptive(Formula::Rodas5, Tolerances::of(x))),
                    ..plain.clone()
                },
            ),
            (
                "relative tolerance",
                Job {
                    method: with(&|a| a.tolerances.relative = x),
                    ..plain.clone()
                },
            ),
            (
                "tolerance of angles",
                Job {
                    method: with(&|a| a.tolerances.angles = x),
                    ..plain.clone()
                },
            ),
            (
                "first step",
                Job {
                    method: with(&|a| a.first_step = Some(x)),
                    ..plain.clone()
                },
            ),
            (
                "largest step",
                Job {
                    method: with(&|a| a.largest_step = x),
                    ..plain.clone()
                },
            ),
            (
                "smallest step",
                Job {
                    method: with(&|a| a.smallest_step = x),
                    ..plain.clone()
                },
            ),
        ];
        for (what, job) in jobs {
            ends.run(bench, &scene, &format!("{what} {x:e}"), &job)?;
        }
        for formula in formulas {
            let job = Job {
                method: Some(Integrator::fixed(*formula, x)),
                ..plain.clone()
            };
            ends.run(bench, &scene, &format!("step {x:e} of {formula}"), &job)?;
        }
    }
    let limits = [0, 1, 2].map(|limit| Job {
        max_steps: Some(limit),
        ..plain.clone()
    });
    for job in limits {
        ends.run(bench, &scene, &format!("{:?} steps", job.max_steps), &job)?;
    }
    ends.note(bench, [50, 20]);
    Ok(())
}

fn parameters(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("extremes");
    let mut ends = Ends::default();
    let names = [
        "mass",
        "moment",
        "length",
        "speed",
        "pull",
        "stiffness",
        "damping",
        "friction",
        "lengthening",
    ];
    let scalars = match bench.full() {
        true => &[Scalar::F64, Scalar::F32, Scalar::Fast, Scalar::DoubleDouble][..],
        false => &[Scalar::F64],
    };
    for scalar in scalars {
        for name in names {
            for x in GARBAGE {
                // a negative mass is meaningless, too, but belongs to another case
                if x < 0.0 && name != "speed" && name != "pull" {
                    continue;
                }
                let job = Job {
                    parameters: vec![(name.into(), x)],
                    max_steps: Some(LIMIT),
                    scalar: *scalar,
                    ..Job::default()
                };
                ends.run(
                    bench,
                    &scene,
                    &format!("{name} = {x:e} in {}", scalar.name()),
                    &job,
                )?;
            }
        }
    }
    ends.note(bench, [20, 20]);
    Ok(())
}
