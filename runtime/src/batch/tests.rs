//! Lanes against single runs, against each other, and against closed forms.

use super::rows::{Asked, Job, rows, rows_of_singles};
use super::{Ended, Pace, Scenarios, Series, Settings, Status, run};
use crate::real::lanes::{OfAnyWidth, Several, Width, with_width, with_width_of_singles};
use crate::response::Response;
use crate::simulate::{Method, Settings as Single, simulate};
use crate::{
    Dual, Formula, Info, Model, OutputInfo, ParameterInfo, ParameterSet, Real, StateKind,
    Tolerances,
};

/// A mass of 1 kg that flies at a spring, whose latch makes it stiffer from a certain depth on, while it is pushed from 0.1 s on.
#[derive(Clone, Copy, Debug)]
struct Bumper<T = f64> {
    parameters: Parameters<T>,
}

#[derive(Clone, Copy, Debug)]
struct Parameters<T> {
    /// [speed at the start, stiffness, depth of the latch, stiffness that it adds]
    all: [T; 4],
}

impl<T: Real> ParameterSet<T> for Parameters<T> {
    fn defaults() -> Self {
        Parameters {
            all: [1.0, 100.0, 0.06, 300.0].map(T::from_f64),
        }
    }
    fn get(&self, index: usize) -> Option<T> {
        self.all.get(index).copied()
    }
    fn set(&mut self, index: usize, value: T) -> bool {
        self.all
            .get_mut(index)
            .map(|place| *place = value)
            .is_some()
    }
}

const fn parameter(name: &'static str, default: f64) -> ParameterInfo {
    ParameterInfo {
        name,
        unit: "",
        default,
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
    }
}

impl<T: Real> Model<T> for Bumper<T> {
    type With<U: Real> = Bumper<U>;
    type Parameters = Parameters<T>;
    type State = [T; 3];
    type Outputs = [T; 2];
    type Guards = [T; 1];
    type Kinks = [T; 1];
    type Powers = [T; 0];
    type Curves = [T; 0];
    const INFO: &'static Info = &Info {
        name: "bumper",
        digest: "",
        dimension: 2,
        coordinates: &["x"],
        velocities: &["v"],
        kinds: &[StateKind::Position, StateKind::Velocity, StateKind::Memory],
        auxiliaries: &[],
        memory: &["latched"],
        guards: &["latches"],
        kinks: &["touches"],
        powers: &[],
        curves: &[],
        time_ends: false,
        pivots: &[],
        conditions: &["stiffness"],
        free: false,
        outputs: &[
            OutputInfo {
                name: "place",
                unit: "m",
            },
            OutputInfo {
                name: "force",
                unit: "N",
            },
        ],
        parameters: &[
            parameter("speed", 1.0),
            parameter("stiffness", 100.0),
            parameter("depth", 0.06),
            parameter("latch", 300.0),
        ],
        breakpoints: &[0.1],
        duration: 0.4,
        every: 0.02,
    };
    fn new(parameters: Parameters<T>) -> Self {
        Bumper { parameters }
    }
    fn parameters(&self) -> &Parameters<T> {
        &self.parameters
    }
    fn violated(&self) -> Option<usize> {
        (self.parameters.all[1].to_f64() < 0.0).then_some(0)
    }
    fn initial_state(&self) -> [T; 3] {
        let zero = T::from_f64(0.0);
        [T::from_f64(-0.05), self.parameters.all[0], zero]
    }
    #[inline(always)]
    fn derivative(&self, t: T, y: &[T; 3]) -> [T; 3] {
        let zero = T::from_f64(0.0);
        let push = T::select(t.lt(T::from_f64(0.1)), zero, T::from_f64(2.0));
        [y[1], push - self.force(y), zero]
    }
    fn coordinate_rates(&self, y: &[T; 3], rate: &mut [T; 3]) {
        rate[0] = y[1];
    }
    #[inline(always)]
    fn outputs(&self, _: T, y: &[T; 3]) -> [T; 2] {
        [y[0], self.force(y)]
    }
    fn normalize(&self, _: &mut [T; 3]) {}
    #[inline(always)]
    fn renew(&self, _: T, y: &mut [T; 3]) {
        let deep = self.parameters.all[2].lt(y[0]);
        y[2] = T::select(deep, T::from_f64(1.0), y[2]);
    }
    #[inline(always)]
    fn guards(&self, _: T, y: &[T; 3]) -> [T; 1] {
        let never = T::from_f64(-1.0);
        let latched = T::from_f64(0.5).lt(y[2]);
        [T::select(latched, never, y[0] - self.parameters.all[2])]
    }
    #[inline(always)]
    fn kinks(&self, _: T, y: &[T; 3]) -> [T; 1] {
        [y[0]]
    }
}

impl<T: Real> Bumper<T> {
    #[inline(always)]
    fn force(&self, y: &[T; 3]) -> T {
        let [_, stiffness, _, latch] = self.parameters.all;
        // where it latches the force jumps
        y[0].max(T::from_f64(0.0)) * (stiffness + latch * y[2])
    }
}

/// Rows of parameters, and what became of them.
struct Rows<S> {
    rows: Vec<[S; 4]>,
    ended: Vec<Option<(Ended, Vec<S>)>>,
}

impl<S: Real> Scenarios<S> for Rows<S> {
    fn count(&self) -> usize {
        self.rows.len()
    }
    fn parameter(&self, scenario: usize, index: usize) -> S {
        self.rows[scenario][index]
    }
    fn level(&self, _: usize) -> f64 {
        1.0
    }
    fn outputs(&self) -> &[usize] {
        &[0, 1]
    }
    fn ended(&mut self, scenario: usize, ended: &Ended, series: &Series<S>) {
        assert!(self.ended[scenario].is_none(), "twice");
        let values = [series.of(0), series.of(1)].concat();
        self.ended[scenario] = Some((*ended, values));
    }
}

impl<S: Real> Rows<S> {
    fn new(rows: Vec<[S; 4]>) -> Self {
        let ended = vec![None; rows.len()];
        Rows { rows, ended }
    }

    fn all(self) -> Vec<(Ended, Vec<S>)> {
        self.ended.into_iter().map(Option::unwrap).collect()
    }
}

const TOLERANCE: f64 = 1e-8;

fn settings(pace: Pace) -> Settings {
    Settings {
        duration: 0.4,
        samples: 41,
        pace,
        locate: false,
        max_steps: 100_000,
    }
}

fn adaptive() -> Settings {
    settings(Pace::Adaptive(Tolerances::of(TOLERANCE)))
}

struct Values<'a>(&'a Settings, Vec<[f64; 4]>);

impl<F: Real> OfAnyWidth<F> for Values<'_> {
    type Output = Vec<(Ended, Vec<f64>)>;
    fn run<T: Several<One = F>>(self) -> Self::Output {
        let rows = self.1.into_iter();
        let mut rows = Rows::new(rows.map(|row| row.map(F::from_f64)).collect());
        run::<T, Bumper<T>>(self.0, &mut rows);
        let as_doubles = |values: Vec<F>| values.into_iter().map(F::to_f64).collect();
        let runs = rows.all().into_iter();
        runs.map(|(ended, values)| (ended, as_doubles(values)))
            .collect()
    }
}

/// What singles can keep.
const COARSE: f64 = 1e-4;

fn coarse() -> Settings {
    settings(Pace::Adaptive(Tolerances::of(COARSE)))
}

/// Scenarios that differ in all parameters, some of which latch and some of which do not.
fn scenarios(count: usize) -> Vec<[f64; 4]> {
    let one = |i: usize| {
        let x = |k: usize| ((i * 37 + k * 101) % 64) as f64 / 64.0;
        [
            0.5 + x(1),
            50.0 + 100.0 * x(2),
            0.02 + 0.1 * x(3),
            500.0 * x(4),
        ]
    };
    (0..count).map(one).collect()
}

fn bits(runs: &[(Ended, Vec<f64>)]) -> Vec<(Ended, Vec<u64>)> {
    let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect();
    runs.iter().map(|(ended, v)| (*ended, bits(v))).collect()
}

/// The same by single runs of the ordinary time loop.
fn alone(row: [f64; 4], tolerance: f64) -> Vec<f64> {
    let model = Bumper::new(Parameters { all: row });
    let settings = Single {
        every: 0.01,
        method: Method::adaptive(Formula::Dopri5, Tolerances::of(tolerance)),
        ..Single::of(Bumper::<f64>::INFO)
    };
    let mut samples: [Vec<f64>; 2] = Default::default();
    simulate(&model, &settings, &mut |sample| {
        samples[0].push(sample.outputs[0]);
        samples[1].push(sample.outputs[1]);
    })
    .unwrap();
    samples.concat()
}

#[test]
fn lanes_equal_scalar() {
    for settings in [adaptive(), settings(Pace::Fixed(1e-3))] {
        let narrow = with_width(Width::One, Values(&settings, scenarios(37)));
        for width in [Width::Four, Width::Eight] {
            let wide = with_width(width, Values(&settings, scenarios(37)));
            if let (Some(wide), Some(narrow)) = (wide, &narrow) {
                assert_eq!(bits(&wide), bits(narrow), "{width:?}");
            }
        }
    }
    for settings in [coarse(), settings(Pace::Fixed(1e-3))] {
        let narrow = with_width_of_singles(Width::One, Values(&settings, scenarios(37)));
        for width in [Width::Four, Width::Eight] {
            let wide = with_width_of_singles(width, Values(&settings, scenarios(37)));
            if let (Some(wide), Some(narrow)) = (wide, &narrow) {
                assert_eq!(bits(&wide), bits(narrow), "singles, {width:?}");
            }
        }
    }
}

#[test]
fn a_run_is_the_same_whatever_its_neighbours_do() {
    let all = with_width(Width::widest(), Values(&adaptive(), scenarios(37))).unwrap();
    for (i, row) in scenarios(37).into_iter().enumerate() {
        let one = with_width(Width::widest(), Values(&adaptive(), vec![row])).unwrap();
        assert_eq!(bits(&one), bits(&all[i..=i]));
    }
}

#[test]
fn a_lane_that_fails_is_told_and_disturbs_nobody() {
    let mut rows = scenarios(24);
    rows[3][1] = -1.0;
    rows[10][0] = f64::NAN;
    rows[11][3] = f64::INFINITY;
    let runs = with_width(Width::widest(), Values(&adaptive(), rows)).unwrap();
    let good = with_width(Width::widest(), Values(&adaptive(), scenarios(24))).unwrap();
    for (i, (run, good)) in runs.iter().zip(&good).enumerate() {
        match i {
            3 => assert_eq!(run.0.status, Status::Refused),
            10 | 11 => assert_eq!(run.0.status, Status::NonFinite),
            _ => assert_eq!(
                bits(std::slice::from_ref(run)),
                bits(std::slice::from_ref(good))
            ),
        }
    }
    // what was reached before is there, and nothing after
    assert!(runs[10].1.iter().all(|v| v.is_nan()));
}

#[test]
fn a_limit_on_steps_is_kept() {
    let few = Settings {
        max_steps: 20,
        ..adaptive()
    };
    for (ended, values) in with_width(Width::widest(), Values(&few, scenarios(9))).unwrap() {
        assert_eq!(ended.status, Status::TooManySteps);
        assert_eq!(ended.steps + ended.rejected, 20);
        assert!(ended.t > 0.0 && ended.t < 0.4);
        assert!(values[0].is_finite() && values[40].is_nan());
    }
}

#[test]
fn runs_are_those_of_the_ordinary_time_loop() {
    let runs = with_width(Width::widest(), Values(&adaptive(), scenarios(24))).unwrap();
    for (row, (ended, values)) in scenarios(24).into_iter().zip(&runs) {
        assert_eq!((ended.status, ended.t), (Status::Done, 0.4));
        // either errs by at most a tolerance a step, which the motion does not amplify: two or three periods of an oscillator, whose
        // force is up to 650 N/m times the place
        let bound = 2.0 * f64::from(ended.steps) * TOLERANCE;
        let reference = alone(row, TOLERANCE);
        for (k, (ours, other)) in values.iter().zip(&reference).enumerate() {
            let scale = if k < 41 { 1.0 } else { 650.0 };
            assert!(
                (ours - other).abs() <= bound * scale,
                "{row:?} {k}: {ours} {other}"
            );
        }
        assert_eq!(values.len(), reference.len());
    }
}

#[test]
fn fixed_steps_follow_a_parabola_and_end_where_the_push_begins() {
    // it flies away from the spring, and is pushed from 0.1 s on: x = −0.05 − 0.4 t + (t − 0.1)²
    let row = [-0.4, 100.0, 1.0, 0.0];
    // 0.04 does not divide 0.1
    for (step, steps) in [(0.01, 40), (0.04, 3 + 8)] {
        let settings = settings(Pace::Fixed(step));
        let doubles = with_width(Width::Plain, Values(&settings, vec![row]));
        let singles = with_width_of_singles(Width::Plain, Values(&settings, vec![row]));
        let both = [(doubles, f64::EPSILON), (singles, f64::from(f32::EPSILON))];
        for (runs, epsilon) in both {
            let (ended, values) = runs.unwrap().remove(0);
            assert_eq!((ended.steps, ended.rejected), (steps, 0));
            assert_eq!((ended.status, ended.t), (Status::Done, 0.4));
            for (i, x) in values[..41].iter().enumerate() {
                let t = 0.01 * i as f64;
                let exact = -0.05 - 0.4 * t + (t - 0.1_f64).max(0.0).powi(2);
                // a few roundings a step of numbers below 1
                assert!(
                    (x - exact).abs() <= 10.0 * f64::from(steps) * epsilon,
                    "{t}: {x}"
                );
            }
        }
    }
}

#[test]
fn singles_keep_their_tolerance() {
    let runs = with_width_of_singles(Width::widest(), Values(&coarse(), scenarios(24))).unwrap();
    for (row, (ended, values)) in scenarios(24).into_iter().zip(&runs) {
        assert_eq!((ended.status, ended.t), (Status::Done, 0.4));
        // steps that rounding makes shorter would be many more
        let of_doubles = with_width(Width::widest(), Values(&coarse(), vec![row])).unwrap();
        let doubles = of_doubles[0].0.steps + of_doubles[0].0.rejected;
        let singles = ended.steps + ended.rejected;
        assert!(singles <= doubles + doubles / 5 + 2, "{singles} {doubles}");
        // at most a tolerance a step, of velocities (1 + |v|) times as much, and they are up to 1.5 m/s
        let bound = 2.5 * f64::from(ended.steps) * COARSE;
        let reference = alone(row, TOLERANCE);
        // the force jumps where it latches, which may be on the other side of a sample
        for (k, (ours, other)) in values.iter().zip(&reference).enumerate().take(41) {
            assert!((ours - other).abs() <= bound, "{row:?} {k}: {ours} {other}");
        }
    }
}

#[test]
fn singles_differ_from_doubles_by_rounding_alone() {
    let fixed = settings(Pace::Fixed(1e-3));
    let singles = with_width_of_singles(Width::widest(), Values(&fixed, scenarios(24))).unwrap();
    let doubles = with_width(Width::widest(), Values(&fixed, scenarios(24))).unwrap();
    for (i, (single, double)) in singles.iter().zip(&doubles).enumerate() {
        assert!(single.0.steps.abs_diff(double.0.steps) <= 1, "{i}");
        // a few roundings a step of places and velocities up to 2
        let bound = 10.0 * f64::from(double.0.steps) * f64::from(f32::EPSILON);
        for (k, (ours, other)) in single.1.iter().zip(&double.1).enumerate() {
            let scale = if k < 41 { 1.0 } else { 650.0 };
            assert!(
                (ours - other).abs() <= bound * scale,
                "{i} {k}: {ours} {other}"
            );
        }
    }
}

#[test]
fn an_error_that_singles_cannot_keep_is_told() {
    // 10⁻⁸ of a force is less than singles tell apart
    let runs = with_width_of_singles(Width::widest(), Values(&adaptive(), scenarios(9))).unwrap();
    for (ended, values) in runs {
        let done = ended.status == Status::Done;
        assert!(done || ended.status == Status::StepTooSmall, "{ended:?}");
        assert_eq!(done, values.iter().all(|value| value.is_finite()));
    }
}

#[test]
fn rows_of_singles_are_rows_within_the_tolerance() {
    let all: Vec<f64> = scenarios(24).concat();
    let job = Job {
        settings: coarse(),
        varied: vec![0, 1, 2, 3],
        fixed: Vec::new(),
        responses: vec![Asked {
            output: 0,
            response: Response::Peak,
        }],
        estimate: true,
        width: Width::widest(),
    };
    let singles = rows_of_singles::<Bumper>(&job, &all).unwrap();
    let doubles = rows::<Bumper>(&job, &all).unwrap();
    assert_eq!((singles.rows.len(), singles.responses.len()), (24, 24));
    for (i, row) in singles.rows.iter().enumerate() {
        let [ours, other] = [singles.responses[i], doubles.responses[i]];
        let bound = 2.0 * f64::from(row.steps) * COARSE;
        assert!((ours - other).abs() <= bound, "{i}: {ours} {other}");
        assert!(row.status == Status::Done && row.error < 0.1, "{row:?}");
        assert_eq!(ours, f64::from(ours as f32));
    }
}

struct Slopes<'a>(&'a Settings, Vec<[Dual<f64>; 4]>);

impl OfAnyWidth for Slopes<'_> {
    type Output = Vec<(Ended, Vec<Dual<f64>>)>;
    fn run<T: Several<One = f64>>(self) -> Self::Output {
        let mut rows = Rows::new(self.1);
        run::<Dual<T>, Bumper<Dual<T>>>(self.0, &mut rows);
        rows.all()
    }
}

#[test]
fn derivatives_are_those_of_differences_across_events() {
    let located = Settings {
        locate: true,
        ..settings(Pace::Adaptive(Tolerances::of(1e-9)))
    };
    // touches, latches with a jump of the force, leaves the spring
    let row = [1.0, 100.0, 0.06, 300.0];
    let rows: Vec<[Dual<f64>; 4]> = (0..4)
        .map(|along| {
            std::array::from_fn(|i| Dual {
                value: row[i],
                slope: if i == along { row[i] } else { 0.0 },
            })
        })
        .collect();
    let runs = with_width(Width::widest(), Slopes(&located, rows)).unwrap();
    for (along, (ended, values)) in runs.iter().enumerate() {
        assert_eq!(ended.status, Status::Done);
        let moved = |by: f64| {
            let mut row = row;
            row[along] *= 1.0 + by;
            alone(row, 1e-13)
        };
        let h = 1e-5;
        let (right, left) = (moved(h), moved(-h));
        // the place at the end, and half way
        for k in [20, 40] {
            // of the difference: h² times a third derivative below 10⁴ of what moves by 0.1 m, and 10⁻¹³ × some hundred steps / h; of
            // ours: 10⁻⁹ × some hundred steps
            let difference = (right[k] - left[k]) / (2.0 * h);
            let ours = values[k].slope;
            assert!(
                (ours - difference).abs() < 1e-6,
                "{along} {k}: {ours} {difference}"
            );
        }
    }
}
