//! Models in lanes: the same bits in registers of every width, and the motion of the ordinary time loop, which for
//! fixed steps agrees to the last bit.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Entry as RowsEntry, Job};
use bryant_runtime::batch::{self, Fixed, Pace, Settings, Status};
use bryant_runtime::real::lanes::{OfAnyWidth, with_width};
use bryant_runtime::{
    Adjustable, Dynamics, Formula, Info, Integrator, Report, Response, Several, Tolerances, Width,
    simulate,
};
use std::ops::ControlFlow;
use std::path::Path;

/// Tolerance of the runs in lanes.
const TOLERANCE: f64 = 1e-9;
/// Tolerance of the single runs for comparison, a tenth of that in lanes. The lanes may differ from them by as much as
/// a single run with a hundred times their tolerance does. Errors fall like the tolerance, to a hundredth, or at worst,
/// at kinks, like its root, to a tenth. The rest is for the scatter at kinks, where no two runs are alike.
const FINE: f64 = 0.1 * TOLERANCE;
const COARSE: f64 = 100.0 * TOLERANCE;
/// Events are located to this share of a step, and a step is at most as long as the run.
const LOCATED: f64 = 1e-13;

/// The engine of a model of this crate, or of a bundled one.
pub(crate) fn engine(path: &str) -> Engine {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let (model, _) = bryant_generator::read(&path).unwrap_or_else(|problems| panic!("{problems}"));
    let lists = Config::new().matrices(false).lists(&model);
    Engine::new(lists).expect("it has no functions of a user")
}

const SEAT: &str = "../models/child-seat.yaml";
const WEBBING: &str = "models/webbing.yaml";
const DRIVES: &str = "models/drives.yaml";
const SWITCHES: &str = "models/switches.yaml";
const POLES: &str = "models/poles-bryant.yaml";
const TOP: &str = "models/free-top.yaml";

/// Rows of all parameters within a few per cent of their defaults and within their bounds.
fn rows(info: &Info, count: usize) -> Vec<f64> {
    let row = |i: usize| {
        info.parameters
            .iter()
            .enumerate()
            .map(move |(k, parameter)| {
                let turn = ((i * 29 + k * 13) % 17) as f64 / 17.0 - 0.5;
                let value = parameter.default * (1.0 + 0.2 * turn);
                value.clamp(parameter.min, parameter.max)
            })
    };
    (0..count).flat_map(row).collect()
}

fn job(info: &Info, duration: f64, width: Width) -> Job {
    Job {
        settings: Settings {
            duration,
            samples: 101,
            pace: Pace::Adaptive(Tolerances::of(TOLERANCE)),
            locate: false,
            max_steps: 1_000_000,
            time_limit: None,
            energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        },
        varied: (0..info.parameters.len()).collect(),
        fixed: Vec::new(),
        responses: Vec::new(),
        estimate: false,
        wanted: f64::INFINITY,
        width,
    }
}

/// The bits of all outputs of some rows, and how the rows ended.
fn bits(engine: &Engine, duration: f64, width: Width, count: usize) -> Vec<u64> {
    let info = engine.info();
    let all: Vec<usize> = (0..info.outputs.len()).collect();
    let job = job(info, duration, width);
    let across = info.parameters.len().max(1);
    let rows = rows(info, count);
    let mut bits = Vec::new();
    for i in 0..count {
        let row = rows.get(i * across..(i + 1) * across).unwrap_or(&[]);
        let (row, samples) = engine.series(&job, row, &all).unwrap();
        assert_eq!(row.status, Status::Done, "{} {i}", info.name);
        bits.push(u64::from(row.steps));
        bits.extend(samples.iter().map(|sample| sample.to_bits()));
    }
    bits
}

fn the_same_in_every_width(engine: &Engine, duration: f64) {
    if !Width::One.is_available() {
        return;
    }
    let narrow = bits(engine, duration, Width::One, 3);
    for width in [Width::Two, Width::Four, Width::Eight] {
        if width.is_available() {
            assert!(
                bits(engine, duration, width, 3) == narrow,
                "{} in {width:?}",
                engine.info().name
            );
        }
    }
}

/// A run of a row of parameters over a scalar, with what is done with each sample.
fn run<T: bryant_runtime::Real>(
    engine: &Engine,
    row: &[f64],
    settings: &bryant_runtime::Settings,
    sample: &mut dyn FnMut(&[T]),
) -> Report {
    let mut model = engine.over::<T>();
    let row: Vec<T> = row.iter().map(|value| T::from_f64(*value)).collect();
    model.set_parameters(&row);
    let mut start = vec![T::from_f64(0.0); engine.info().state_length()];
    model.initial_state(&mut start);
    simulate::run(&model, &start, settings, None, &mut |at| {
        sample(at.outputs);
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|failure| panic!("{failure}"))
}

/// Some outputs of a single run, each at 101 samples, and the cost of the run.
fn single(
    engine: &Engine,
    row: &[f64],
    duration: f64,
    tolerance: f64,
    outputs: &[usize],
) -> (Vec<Vec<f64>>, Report) {
    let settings = bryant_runtime::Settings {
        duration,
        every: duration / 100.0,
        method: Integrator::adaptive(Formula::Dopri5, Tolerances::of(tolerance)),
        ..bryant_runtime::Settings::of(engine.info())
    };
    let mut all = vec![Vec::new(); outputs.len()];
    let report = run::<f64>(engine, row, &settings, &mut |found| {
        for (values, output) in all.iter_mut().zip(outputs) {
            values.push(found[*output]);
        }
    });
    (all, report)
}

/// The largest difference of two signals.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let away = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    away.fold(0.0, |most, x| if x <= most { most } else { x })
}

/// Compares outputs in lanes with those of a single run; the named outputs are continuous in time.
fn the_motion_of_a_single_run(path: &str, duration: f64, continuous: &[&str]) {
    let engine = engine(path);
    let info = engine.info();
    the_same_in_every_width(&engine, duration);
    let outputs: Vec<usize> = (0..info.outputs.len())
        .filter(|i| continuous.is_empty() || continuous.contains(&info.outputs[*i].name))
        .collect();
    assert!(continuous.is_empty() || outputs.len() == continuous.len());
    let job = job(info, duration, Width::widest());
    let across = info.parameters.len();
    let rows = rows(info, 4);
    // At a kink a single coarse run may be lucky: the worst of all rows counts.
    let mut scatter = vec![0.0_f64; outputs.len()];
    let mut singles = Vec::new();
    for row in rows.chunks(across.max(1)) {
        let (fine, report) = single(&engine, row, duration, FINE, &outputs);
        let (coarse, _) = single(&engine, row, duration, COARSE, &outputs);
        for (most, (fine, coarse)) in scatter.iter_mut().zip(fine.iter().zip(&coarse)) {
            *most = most.max(apart(coarse, fine));
        }
        singles.push((row, fine, report));
    }
    for (row, fine, report) in singles {
        let (_, samples) = engine.series(&job, row, &outputs).unwrap();
        for (k, fine) in fine.iter().enumerate() {
            let ours = &samples[k * 101..(k + 1) * 101];
            // If the motion is a polynomial, only rounding remains, one of the state for each evaluation, and the
            // effect of events that come slightly early or late: they change the rate of an output by at most twice the
            // largest rate.
            let largest = apart(fine, &vec![0.0; fine.len()]);
            let rounded = report.evaluations as f64 * f64::EPSILON * largest;
            let rate = 100.0 * apart(&fine[1..], &fine[..fine.len() - 1]) / duration;
            let late = report.events as f64 * LOCATED * duration * 2.0 * rate;
            let bound = scatter[k] + rounded + late;
            let away = apart(ours, fine);
            let name = &info.outputs[outputs[k]].name;
            assert!(
                away <= bound,
                "{}, {name}: {away:e} of {bound:e}",
                info.name
            );
        }
    }
}

#[test]
fn runs_are_the_same_in_every_width() {
    for (path, duration) in [
        (SEAT, 0.16),
        (WEBBING, 0.1),
        (DRIVES, 0.2),
        (SWITCHES, 0.2),
        (POLES, 0.2),
        (TOP, 0.2),
    ] {
        the_same_in_every_width(&engine(path), duration);
    }
}

/// The rows of a model by its generated Rust, and by the engine.
fn the_same_rows_by_rust(path: &str, entry: RowsEntry) {
    let engine = engine(path);
    let info = engine.info();
    let rows = rows(info, 9);
    let job = Job {
        responses: (0..info.outputs.len())
            .map(|output| Asked::of(output, Response::Final))
            .collect(),
        ..job(info, 0.06, Width::widest())
    };
    let [ours, theirs] = [engine.rows(&job, &rows), (entry.rows)(&job, &rows)]
        .map(|found| found.expect("registers of the widest kind"));
    let bits = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&ours.responses), bits(&theirs.responses));
    assert!(ours.rows.iter().all(|row| row.status == Status::Done));
}

/// The tests of the engine compare single evaluations. Over all registers and their dual numbers, the compiler takes
/// long for a large model: with `--cfg bryant_nightly` there is one.
#[test]
fn rows_of_generated_rust_have_the_bits_of_the_engine() {
    let entry = RowsEntry::of::<bryant_generated::sled_pendulum::Mechanism<f64>>();
    the_same_rows_by_rust("../models/sled-pendulum.yaml", entry);
    #[cfg(bryant_nightly)]
    the_same_rows_by_rust(
        SEAT,
        RowsEntry::of::<bryant_generated::child_seat::Mechanism<f64>>(),
    );
}

#[test]
fn contacts_and_belts_move_as_in_a_single_run() {
    the_motion_of_a_single_run(SEAT, 0.06, &[]);
}

#[test]
fn events_and_memory_move_as_in_a_single_run() {
    let continuous = [
        "crash x",
        "crash v",
        "crash payout",
        "reel v",
        "reel payout",
        "plastic v",
    ];
    the_motion_of_a_single_run(WEBBING, 0.1, &continuous);
}

#[test]
fn joint_laws_with_memory_move_in_lanes_as_in_a_single_run() {
    let continuous = ["carriage", "yaw", "pitch", "fore"];
    the_motion_of_a_single_run(DRIVES, 0.3, &continuous);
}

#[test]
fn chains_of_switches_fire_as_in_a_single_run() {
    the_motion_of_a_single_run(SWITCHES, 0.5, &["x", "z", "vx", "vz", "spin"]);
}

#[test]
fn charts_change_as_in_a_single_run() {
    the_motion_of_a_single_run(POLES, 0.5, &[]);
}

/// A single run over the scalar of a register with one lane, with fixed steps and without samples on the way.
struct Single<'a> {
    engine: &'a Engine,
    row: &'a [f64],
    duration: f64,
    fixed: Fixed,
}

impl OfAnyWidth for Single<'_> {
    /// Number of steps, and the outputs at the end.
    type Output = (u32, Vec<f64>);

    fn run<T: Several<One = f64>>(self) -> (u32, Vec<f64>) {
        let Fixed { method, step } = self.fixed;
        let settings = bryant_runtime::Settings {
            duration: self.duration,
            every: self.duration,
            method: Integrator::fixed(method.formula(), step),
            ..bryant_runtime::Settings::of(self.engine.info())
        };
        let mut end = Vec::new();
        let report = run::<T>(self.engine, self.row, &settings, &mut |outputs| {
            end = outputs.iter().map(|output| output.lane(0)).collect();
        });
        (u32::try_from(report.steps).unwrap(), end)
    }
}

/// Rows with fixed steps, each beside a twin with steps twice as long, with one failing row among them, against single
/// runs: the numbers of steps and the outputs at the end agree to the last bit.
fn fixed_steps_are_those_of_a_single_run(path: &str, duration: f64, step: f64) {
    let engine = engine(path);
    let info = engine.info();
    let across = info.parameters.len();
    let count = if across == 0 { 1 } else { 7 };
    let mut rows = rows(info, count);
    // a parameter that is NaN
    let fails = (count > 1).then_some(3);
    if let Some(row) = fails {
        rows[row * across] = f64::NAN;
    }
    for method in batch::LaneFormula::ALL {
        let fixed = Fixed { method, step };
        for width in Width::ALL.into_iter().filter(|width| width.is_available()) {
            let ends = |output| Asked::of(output, Response::Final);
            let base = job(info, duration, width);
            let job = Job {
                settings: Settings {
                    pace: Pace::Fixed(fixed),
                    ..base.settings
                },
                responses: (0..info.outputs.len()).map(ends).collect(),
                estimate: true,
                wanted: f64::INFINITY,
                ..base
            };
            let found = engine.rows(&job, &rows).unwrap();
            assert_eq!(found.rows.len(), count);
            for (i, row) in found.rows.iter().enumerate() {
                let name = format!("{} {i}, {method:?} in {width:?}", info.name);
                let ours = &found.responses[i * info.outputs.len()..][..info.outputs.len()];
                if Some(i) == fails {
                    assert_ne!(row.status, Status::Done, "{name}");
                    assert!(ours.iter().all(|end| end.is_nan()), "{name}");
                    continue;
                }
                let single = Single {
                    engine: &engine,
                    row: rows.get(i * across..(i + 1) * across).unwrap_or(&[]),
                    duration,
                    fixed,
                };
                let (steps, single) = with_width(Width::One, single).unwrap();
                assert_eq!((row.status, row.steps), (Status::Done, steps), "{name}");
                let bits = |ends: &[f64]| ends.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(ours), bits(&single), "{name}: {ours:?} {single:?}");
            }
        }
    }
}

#[test]
fn fixed_steps_of_contacts_and_belts_are_those_of_a_single_run() {
    fixed_steps_are_those_of_a_single_run(SEAT, 0.06, 3e-4);
}

#[test]
fn fixed_steps_of_quaternions_are_those_of_a_single_run() {
    fixed_steps_are_those_of_a_single_run(TOP, 0.5, 1.7e-3);
}

#[test]
fn fixed_steps_end_on_events_as_those_of_a_single_run() {
    fixed_steps_are_those_of_a_single_run(WEBBING, 0.1, 1.7e-4);
}

#[test]
fn fixed_steps_change_charts_as_those_of_a_single_run() {
    fixed_steps_are_those_of_a_single_run(POLES, 0.5, 1.7e-3);
}

#[test]
fn a_row_that_cannot_be_run_disturbs_no_other() {
    let engine = engine(SEAT);
    let info = engine.info();
    let across = info.parameters.len();
    let mut rows = rows(info, 9);
    let job = Job {
        responses: vec![Asked::of(0, Response::Peak)],
        ..job(info, 0.06, Width::widest())
    };
    let good = engine.rows(&job, &rows).unwrap();
    rows[4 * across] = f64::NAN;
    rows[7 * across + 2] = 1e300;
    let some = engine.rows(&job, &rows).unwrap();
    for i in 0..9 {
        match i {
            4 | 7 => {
                assert_ne!(some.rows[i].status, Status::Done);
                assert!(some.responses[i].is_nan());
            }
            _ => {
                assert_eq!(some.responses[i].to_bits(), good.responses[i].to_bits());
                assert_eq!(some.rows[i].steps, good.rows[i].steps);
            }
        }
    }
}
