//! No step passes over a touch, an edge, a taut belt or a stop. The scenes are the random ones of the hard cases
//! ([`bryant_hard::meeting`]), whose motion is known in closed form until something acts.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_hard::meeting::{self, Case, DURATION, EVERY, FORMULAS, Met, TOLERANCE};
use bryant_runtime::batch::{self, Ended, Scenarios, Series};
use bryant_runtime::real::lanes::{OfAnyWidth, Width, with_width};
use bryant_runtime::{
    Adjustable, Dynamics, Family, Formula, Integrator, Settings, Several, Tolerances, Watch,
    simulate,
};
use std::ops::ControlFlow;

/// Number of scenes of each shape.
const SCENES: usize = 170;

/// A shape, its equations and its scenes.
struct Shape {
    name: &'static str,
    engine: Engine,
    cases: Vec<Case>,
}

fn shapes() -> Vec<Shape> {
    let all = meeting::shapes(SCENES).into_iter();
    all.map(|shape| {
        let model = shape.scene.model().expect("scenes are right");
        Shape {
            name: shape.name,
            engine: Engine::new(Config::new().lists(&model)).expect("no functions"),
            cases: shape.cases,
        }
    })
    .collect()
}

#[test]
fn no_run_steps_over_anything() {
    let mut wrong = Vec::new();
    for Shape {
        name,
        engine,
        cases,
    } in shapes()
    {
        let met = cases.iter().filter(|case| case.met == Met::Yes).count();
        assert!(
            met > SCENES / 5 && met < SCENES,
            "{name}: {met} of {SCENES} meet anything"
        );
        let mut model = engine.over::<f64>();
        for (i, case) in cases.iter().enumerate() {
            model.set_parameters(&case.parameters);
            let mut start = vec![0.0; model.info().state_length()];
            model.initial_state(&mut start);
            let formula = FORMULAS[i % FORMULAS.len()];
            let settings = Settings {
                every: EVERY[i % EVERY.len()],
                method: Integrator::adaptive(formula, Tolerances::of(TOLERANCE)),
                ..Settings::of(model.info())
            };
            let mut end = Vec::new();
            let done = simulate::run(&model, &start, &settings, None, &mut |sample| {
                end = sample.outputs.to_vec();
                ControlFlow::Continue(())
            });
            let mistake = match done {
                Ok(_) => case.judge(&end),
                Err(failure) => Some(failure.to_string()),
            };
            wrong.extend(mistake.map(|mistake| format!("{name} {i} by {formula}: {mistake}")));
        }
    }
    none(&wrong);
}

/// The ends of single runs with error control.
fn exact(engine: &Engine, cases: &[Case]) -> Vec<Vec<f64>> {
    let mut model = engine.over::<f64>();
    let mut end_of = |case: &Case| {
        model.set_parameters(&case.parameters);
        let mut start = vec![0.0; model.info().state_length()];
        model.initial_state(&mut start);
        let settings = Settings {
            method: Integrator::adaptive(Formula::Dopri5, Tolerances::of(1e-8)),
            ..Settings::of(model.info())
        };
        let mut end = Vec::new();
        let done = simulate::run(&model, &start, &settings, None, &mut |sample| {
            end = sample.outputs.to_vec();
            ControlFlow::Continue(())
        });
        assert!(done.is_ok(), "{done:?}");
        end
    };
    cases.iter().map(&mut end_of).collect()
}

/// Fixed steps of single runs and of lanes \[s\]: one for the whole run, and two in which fast bodies may pass over
/// everything.
const STEPS: [f64; 3] = [1.0, 0.13, 0.01];

/// What is wrong with the end of a run in fixed steps, if anything is. It is wrong if the run ends, without a warning,
/// as if nothing had been met, though the obstacle changes the end by more than 3 % (a visit that needs no warning
/// changes it by at most 1 %). It is also wrong if there is a warning and nothing was met. How well steps resolve what
/// they notice depends on their length. `exact` is the end with error control. On a parabola the stages of a step may
/// lie where the motion does not go, and a force there makes the step wrong; so a false warning counts only in straight
/// flight.
fn judged_if_told(case: &Case, exact: &[f64], end: &[f64], told: bool) -> Option<String> {
    // balls and plates give two components of a velocity, belts and stops a position
    let straight = case.free.len() > 1;
    let apart = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / case.scale
    };
    let effect = apart(exact, &case.free);
    let wrong = match (case.met, told) {
        (Met::Yes, false) => effect > 0.03 && apart(end, &case.free) < 0.5 * effect,
        (Met::No, true) => straight,
        _ => false,
    };
    wrong.then(|| {
        let met = case.met;
        format!(
            "{met:?}, told: {told}, an effect of {effect:e}: {end:?}, free {:?}, exact {exact:?}: {:?}",
            case.free, case.parameters
        )
    })
}

#[test]
fn fixed_steps_tell_what_they_go_over() {
    let mut wrong = Vec::new();
    let formulas = [
        Formula::Rk4,
        Formula::Dopri5,
        Formula::Merson,
        Formula::Heun,
    ];
    for Shape {
        name,
        engine,
        cases,
    } in shapes()
    {
        let exact = exact(&engine, &cases);
        let mut model = engine.over::<f64>();
        let mut told_of = 0;
        let each = cases.iter().enumerate();
        let ways = formulas.map(|formula| STEPS.map(|step| (formula, step)));
        let each = each.flat_map(|case| ways.as_flattened().iter().map(move |way| (case, *way)));
        for ((i, case), (formula, step)) in each {
            model.set_parameters(&case.parameters);
            let mut start = vec![0.0; model.info().state_length()];
            model.initial_state(&mut start);
            let settings = Settings {
                every: DURATION,
                method: Integrator::fixed(formula, step),
                ..Settings::of(model.info())
            };
            let mut watch = Watch::new(model.info(), 0.02);
            let mut end = Vec::new();
            let watched = Some(&mut watch);
            let done = simulate::run(&model, &start, &settings, watched, &mut |sample| {
                end = sample.outputs.to_vec();
                ControlFlow::Continue(())
            });
            // a step into a stiff obstacle may end in NaN, which is a warning, too
            let told = done.is_err() || watch.diagnostics().next().is_some();
            told_of += usize::from(told);
            let mistake = judged_if_told(case, &exact[i], &end, told);
            wrong.extend(
                mistake.map(|mistake| format!("{name} {i} by {formula}, {step} s: {mistake}")),
            );
        }
        assert!(told_of > SCENES / 10, "{name}: {told_of} told of");
    }
    none(&wrong);
}

fn none(wrong: &[String]) {
    assert!(
        wrong.is_empty(),
        "{} wrong\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}

/// The scenes of a shape as rows of a batch.
struct Rows<'a> {
    cases: &'a [Case],
    /// The ends with error control, if steps are fixed.
    exact: Option<&'a [Vec<f64>]>,
    outputs: Vec<usize>,
    wrong: Vec<String>,
}

impl Scenarios<f64> for Rows<'_> {
    fn count(&self) -> usize {
        self.cases.len()
    }
    fn parameter(&self, scenario: usize, index: usize) -> f64 {
        self.cases[scenario].parameters[index]
    }
    fn level(&self, _: usize) -> f64 {
        1.0
    }
    fn outputs(&self) -> &[usize] {
        &self.outputs
    }
    fn ended(&mut self, scenario: usize, ended: &Ended, series: &Series<f64>) {
        let case = &self.cases[scenario];
        let end: Vec<f64> = (0..self.outputs.len())
            .map(|k| series.of(k).last().copied().unwrap_or(f64::NAN))
            .collect();
        let mistake = match (self.exact, ended.status) {
            (Some(exact), status) => {
                let told = status != batch::Status::Done;
                judged_if_told(case, &exact[scenario], &end, told)
            }
            (None, batch::Status::Done) => case.judge(&end),
            (None, status) => Some(format!("{status:?}")),
        };
        self.wrong
            .extend(mistake.map(|mistake| format!("{scenario}: {mistake}")));
    }
}

struct Batch<'a, 'b> {
    engine: &'a Engine,
    pace: batch::Pace,
    rows: &'a mut Rows<'b>,
}

impl OfAnyWidth for Batch<'_, '_> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        let settings = batch::Settings {
            duration: DURATION,
            samples: 2,
            pace: self.pace,
            locate: false,
            max_steps: 100_000,
            time_limit: None,
            energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        };
        batch::run::<T>(self.engine, &settings, self.rows);
    }
}

/// The errors in the lanes of all shapes.
fn wrong_in_lanes(pace: batch::Pace) -> Vec<String> {
    let mut wrong = Vec::new();
    for Shape {
        name,
        engine,
        cases,
    } in shapes()
    {
        let exact = matches!(pace, batch::Pace::Fixed(_)).then(|| exact(&engine, &cases));
        let mut rows = Rows {
            cases: &cases,
            exact: exact.as_deref(),
            outputs: (0..Family::info(&engine).outputs.len()).collect(),
            wrong: Vec::new(),
        };
        let engine = &engine;
        let widths = [Width::Four, Width::One];
        let done = widths.into_iter().find_map(|width| {
            with_width(
                width,
                Batch {
                    engine,
                    pace,
                    rows: &mut rows,
                },
            )
        });
        assert!(done.is_some());
        wrong.extend(rows.wrong.iter().map(|mistake| format!("{name} {mistake}")));
    }
    wrong
}

#[test]
fn no_lane_steps_over_anything() {
    none(&wrong_in_lanes(batch::Pace::Adaptive(Tolerances::of(
        TOLERANCE,
    ))));
}

#[test]
fn lanes_of_fixed_steps_tell_what_they_go_over() {
    for step in STEPS {
        for method in batch::LaneFormula::ALL {
            let pace = batch::Pace::Fixed(batch::Fixed { method, step });
            let wrong = wrong_in_lanes(pace);
            assert!(
                wrong.is_empty(),
                "{method:?}, {step} s: {}",
                wrong.join("\n")
            );
        }
    }
}
