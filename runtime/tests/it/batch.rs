//! Lanes against single runs, against each other, and against closed forms.

use crate::models::Ledge;
use bryant_runtime::batch::rows::{Asked, Job, gradients, rows, rows_of_singles};
use bryant_runtime::batch::{
    Ended, Fixed, LaneFormula, Pace, STEPS_BETWEEN, Scenarios, Series, Settings, Status, run,
};
use bryant_runtime::batch::{with_compiled, with_compiled_singles};
use bryant_runtime::real::lanes::{OfAnyWidth, Several, Width};
use bryant_runtime::response::Response;
use bryant_runtime::simulate::{Settings as Single, simulate};
use bryant_runtime::{
    Compiled, Dual, Formula, Info, Model, OutputInfo, ParameterInfo, ParameterSet, Real, StateKind,
    Tolerances,
};

/// A mass of 1 kg that flies at a spring, whose latch makes it stiffer from a certain depth on, while it is pushed
/// from 0.1 s on.
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

const fn parameter(name: &str, default: f64) -> ParameterInfo<'_> {
    ParameterInfo {
        name,
        unit: "",
        default,
        min: f64::NEG_INFINITY,
        max: f64::INFINITY,
        input: false,
    }
}

impl<T: Real> Model<T> for Bumper<T> {
    type With<U: Real> = Bumper<U>;
    type Parameters = Parameters<T>;
    type State = [T; 3];
    const INFO: &'static Info<'static> = &Info {
        name: "bumper",
        digest: "",
        dimension: 2,
        coordinates: &["x"],
        velocities: &["v"],
        kinds: &[StateKind::Position, StateKind::Velocity, StateKind::Memory],
        units: &["m", "m/s", ""],
        auxiliaries: &[],
        memory: &["latched"],
        event_functions: &["latches"],
        kinks: &["touches"],
        onsets: &[],
        corners: 0,
        longest_step: f64::INFINITY,
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
            OutputInfo {
                name: "speed",
                unit: "m/s",
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
    fn outputs(&self, _: T, y: &[T; 3], results: &mut [T]) {
        results.copy_from_slice(&[y[0], self.force(y), y[1]]);
    }
    fn normalize(&self, _: &mut [T; 3]) {}
    #[inline(always)]
    fn renew(&self, _: T, y: &mut [T; 3]) {
        let deep = self.parameters.all[2].lt(y[0]);
        y[2] = T::select(deep, T::from_f64(1.0), y[2]);
    }
    #[inline(always)]
    fn event_functions(&self, _: T, y: &[T; 3], results: &mut [T]) {
        let never = T::from_f64(-1.0);
        let latched = T::from_f64(0.5).lt(y[2]);
        results.copy_from_slice(&[T::select(latched, never, y[0] - self.parameters.all[2])]);
    }
    #[inline(always)]
    fn kinks(&self, _: T, y: &[T; 3], results: &mut [T]) {
        results.copy_from_slice(&[y[0]]);
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

const BUMPER: Compiled<Bumper> = Compiled::new();
const LEDGE: Compiled<Ledge> = Compiled::new();
const SWING: Compiled<Swing> = Compiled::new();

/// Rows of parameters, and what became of them.
struct Rows<S> {
    rows: Vec<[S; 4]>,
    /// Steps after which every other one is given up.
    patience: u64,
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
    fn gives_up(&self, scenario: usize, steps: u64) -> bool {
        assert!(self.ended[scenario].is_none() && steps.is_multiple_of(STEPS_BETWEEN));
        scenario % 2 == 1 && steps > self.patience
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
        Rows {
            rows,
            patience: u64::MAX,
            ended,
        }
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
        time_limit: None,
        energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
    }
}

fn fixed(method: LaneFormula, step: f64) -> Settings {
    settings(Pace::Fixed(Fixed { method, step }))
}

fn adaptive() -> Settings {
    settings(Pace::Adaptive(Tolerances::of(TOLERANCE)))
}

/// A batch of the bumper in registers.
struct Batch<'a, F>(&'a Settings, &'a mut Rows<F>);

impl<F: Real> OfAnyWidth<F> for Batch<'_, F> {
    type Output = ();
    fn run<T: Several<One = F>>(self) {
        run::<T>(&BUMPER, self.0, self.1);
    }
}

type Runs = Vec<(Ended, Vec<f64>)>;

/// What becomes of these rows; `None` without registers of this width.
fn doubles(width: Width, settings: &Settings, all: Vec<[f64; 4]>) -> Option<Runs> {
    let mut rows = Rows::new(all);
    with_compiled(width, Batch(settings, &mut rows))?;
    Some(rows.all())
}

/// The same in singles.
fn singles(width: Width, settings: &Settings, all: Vec<[f64; 4]>) -> Option<Runs> {
    let single = |row: &[f64; 4]| row.map(|x| x as f32);
    let mut rows = Rows::new(all.iter().map(single).collect());
    with_compiled_singles(width, Batch(settings, &mut rows))?;
    let mut runs = Runs::new();
    for (ended, values) in rows.all() {
        runs.push((ended, values.iter().map(|x| f64::from(*x)).collect()));
    }
    Some(runs)
}

/// Runs without parameters and outputs.
struct Ends(Vec<Option<Ended>>);

impl<S: Real> Scenarios<S> for Ends {
    fn count(&self) -> usize {
        self.0.len()
    }
    fn parameter(&self, _: usize, _: usize) -> S {
        unreachable!("there are none")
    }
    fn level(&self, _: usize) -> f64 {
        1.0
    }
    fn outputs(&self) -> &[usize] {
        &[]
    }
    fn ended(&mut self, scenario: usize, ended: &Ended, _: &Series<S>) {
        self.0[scenario] = Some(*ended);
    }
}

struct Ledges<'a>(&'a Settings);

impl<F: Real> OfAnyWidth<F> for Ledges<'_> {
    type Output = Vec<Option<Ended>>;
    fn run<T: Several<One = F>>(self) -> Self::Output {
        let mut ends = Ends(vec![None; 11]);
        run::<T>(&LEDGE, self.0, &mut ends);
        ends.0
    }
}

/// As of single runs: an event function that jumps where a run stands would cut every step down to nothing, for ever.
#[test]
fn a_event_function_that_jumps_where_a_lane_stands_does_not_stop_it() {
    let rk4 = |step| fixed(LaneFormula::Rk4, step).pace;
    for pace in [adaptive().pace, rk4(0.01), rk4(0.5)] {
        let settings = Settings {
            duration: 4.0,
            samples: 9,
            max_steps: 200_000,
            ..settings(pace)
        };
        for width in [Width::One, Width::Two, Width::Four, Width::Eight] {
            let doubles = with_compiled(width, Ledges(&settings));
            let singles = with_compiled_singles(width, Ledges(&settings));
            for ended in doubles.into_iter().chain(singles).flatten() {
                let ended = ended.unwrap();
                assert_eq!((ended.status, ended.t), (Status::Done, 4.0), "{ended:?}");
                assert!(ended.steps > 30, "{ended:?}");
            }
        }
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
        method: bryant_runtime::Integrator::adaptive(Formula::Dopri5, Tolerances::of(tolerance)),
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

/// Each scenario in a batch of its own.
fn one_by_one(batch: &dyn Fn(Vec<[f64; 4]>) -> Option<Runs>) -> Option<Runs> {
    let each = scenarios(37).into_iter();
    let runs: Option<Vec<Runs>> = each.map(|row| batch(vec![row])).collect();
    Some(runs?.concat())
}

#[test]
fn lanes_equal_scalar() {
    let steps = || {
        LaneFormula::ALL
            .into_iter()
            .map(|method| fixed(method, 1e-3))
    };
    for settings in steps().chain([adaptive()]) {
        let alone = one_by_one(&|rows| doubles(Width::One, &settings, rows));
        for width in [Width::One, Width::Two, Width::Four, Width::Eight] {
            let abreast = doubles(width, &settings, scenarios(37));
            if let (Some(abreast), Some(alone)) = (abreast, &alone) {
                assert_eq!(bits(&abreast), bits(alone), "{width:?}");
            }
        }
    }
    for settings in steps().chain([coarse()]) {
        let alone = one_by_one(&|rows| singles(Width::One, &settings, rows));
        for width in [Width::One, Width::Two, Width::Four, Width::Eight] {
            let abreast = singles(width, &settings, scenarios(37));
            if let (Some(abreast), Some(alone)) = (abreast, &alone) {
                assert_eq!(bits(&abreast), bits(alone), "singles, {width:?}");
            }
        }
    }
}

#[test]
fn a_run_is_the_same_whatever_its_neighbours_do() {
    let all = doubles(Width::widest(), &adaptive(), scenarios(37)).unwrap();
    for (i, row) in scenarios(37).into_iter().enumerate() {
        let one = doubles(Width::widest(), &adaptive(), vec![row]).unwrap();
        assert_eq!(bits(&one), bits(&all[i..=i]));
    }
}

#[test]
fn a_lane_that_fails_is_told_and_disturbs_nobody() {
    let mut rows = scenarios(24);
    rows[3][1] = -1.0;
    rows[10][0] = f64::NAN;
    rows[11][3] = f64::INFINITY;
    let runs = doubles(Width::widest(), &adaptive(), rows).unwrap();
    let good = doubles(Width::widest(), &adaptive(), scenarios(24)).unwrap();
    for (i, (run, good)) in runs.iter().zip(&good).enumerate() {
        match i {
            3 | 10 | 11 => assert_eq!(run.0.status, Status::Refused),
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
        time_limit: None,
        energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        ..adaptive()
    };
    for (ended, values) in doubles(Width::widest(), &few, scenarios(9)).unwrap() {
        assert_eq!(ended.status, Status::TooManySteps);
        assert_eq!(ended.steps + ended.rejected, 20);
        assert!(ended.t > 0.0 && ended.t < 0.4);
        assert!(values[0].is_finite() && values[40].is_nan());
    }
}

#[test]
fn runs_are_those_of_the_ordinary_time_loop() {
    let runs = doubles(Width::widest(), &adaptive(), scenarios(24)).unwrap();
    for (row, (ended, values)) in scenarios(24).into_iter().zip(&runs) {
        assert_eq!((ended.status, ended.t), (Status::Done, 0.4));
        // either errs by at most a tolerance a step, which the motion does not amplify: two or three periods of an
        // oscillator, whose force is up to 650 N/m times the place
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
    let all = LaneFormula::ALL.into_iter();
    let cases = all.flat_map(|method| [(method, 0.01, 40), (method, 0.04, 3 + 8)]);
    for (method, step, steps) in cases {
        let settings = fixed(method, step);
        let doubles = doubles(Width::One, &settings, vec![row]);
        let singles = singles(Width::One, &settings, vec![row]);
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
    let runs = singles(Width::widest(), &coarse(), scenarios(24)).unwrap();
    for (row, (ended, values)) in scenarios(24).into_iter().zip(&runs) {
        assert_eq!((ended.status, ended.t), (Status::Done, 0.4));
        // steps that rounding makes shorter would be many more
        let of_doubles = doubles(Width::widest(), &coarse(), vec![row]).unwrap();
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
    let fixed = fixed(LaneFormula::Rk4, 1e-3);
    let singles = singles(Width::widest(), &fixed, scenarios(24)).unwrap();
    let doubles = doubles(Width::widest(), &fixed, scenarios(24)).unwrap();
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
    let runs = singles(Width::widest(), &adaptive(), scenarios(9)).unwrap();
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
        responses: vec![Asked::of(0, Response::Peak)],
        estimate: true,
        wanted: f64::INFINITY,
        width: Width::widest(),
    };
    let singles = rows_of_singles(&BUMPER, &job, &all).unwrap();
    let doubles = rows(&BUMPER, &job, &all).unwrap();
    assert_eq!((singles.rows.len(), singles.responses.len()), (24, 24));
    for (i, row) in singles.rows.iter().enumerate() {
        let [ours, other] = [singles.responses[i], doubles.responses[i]];
        let bound = 2.0 * f64::from(row.steps) * COARSE;
        assert!((ours - other).abs() <= bound, "{i}: {ours} {other}");
        assert!(row.status == Status::Done && row.error < 0.1, "{row:?}");
        assert_eq!(ours, f64::from(ours as f32));
    }
}

/// ẍ = −ω² x from x = 1 at rest, ω the only parameter: x = cos ωt. Nothing of it has a kink.
#[derive(Clone, Copy, Debug)]
struct Swing<T = f64>(Frequency<T>);

#[derive(Clone, Copy, Debug)]
struct Frequency<T>(T);

impl<T: Real> ParameterSet<T> for Frequency<T> {
    fn defaults() -> Self {
        Frequency(T::from_f64(3.0))
    }
    fn get(&self, index: usize) -> Option<T> {
        (index == 0).then_some(self.0)
    }
    fn set(&mut self, index: usize, value: T) -> bool {
        self.0 = value;
        index == 0
    }
}

impl<T: Real> Model<T> for Swing<T> {
    type With<U: Real> = Swing<U>;
    type Parameters = Frequency<T>;
    type State = [T; 2];
    const INFO: &'static Info<'static> = &Info {
        name: "swing",
        kinds: &[StateKind::Position, StateKind::Velocity],
        units: &["m", "m/s"],
        memory: &[],
        event_functions: &[],
        kinks: &[],
        onsets: &[],
        corners: 0,
        longest_step: f64::INFINITY,
        conditions: &[],
        outputs: &[OutputInfo {
            name: "place",
            unit: "m",
        }],
        parameters: &[parameter("frequency", 3.0)],
        breakpoints: &[],
        ..*Bumper::<f64>::INFO
    };
    fn new(parameters: Frequency<T>) -> Self {
        Swing(parameters)
    }
    fn parameters(&self) -> &Frequency<T> {
        &self.0
    }
    fn initial_state(&self) -> [T; 2] {
        [T::from_f64(1.0), T::from_f64(0.0)]
    }
    #[inline(always)]
    fn derivative(&self, _: T, y: &[T; 2]) -> [T; 2] {
        let frequency = self.0.0;
        [y[1], -(frequency * frequency * y[0])]
    }
    fn coordinate_rates(&self, y: &[T; 2], rate: &mut [T; 2]) {
        rate[0] = y[1];
    }
    #[inline(always)]
    fn outputs(&self, _: T, y: &[T; 2], results: &mut [T]) {
        results.copy_from_slice(&[y[0]]);
    }
    fn normalize(&self, _: &mut [T; 2]) {}
}

/// Where rows end, by fixed steps.
fn finals(settings: Settings, varied: usize, estimate: bool) -> Job {
    Job {
        settings,
        varied: (0..varied).collect(),
        fixed: Vec::new(),
        responses: vec![Asked::of(0, Response::Final)],
        estimate,
        wanted: f64::INFINITY,
        width: Width::widest(),
    }
}

#[test]
fn fixed_steps_have_their_order_and_estimate_their_error() {
    // at 0.7 s, near ωt = 3π/4, neither phase nor amplitude of any of them hides its error
    let frequencies: Vec<f64> = (0..11).map(|i| 3.2 + 0.03 * f64::from(i)).collect();
    let found = |method, step| {
        let settings = Settings {
            duration: 0.7,
            ..fixed(method, step)
        };
        rows(&SWING, &finals(settings, 1, true), &frequencies).unwrap()
    };
    for method in LaneFormula::ALL {
        let order = method.formula().order();
        let (long, short) = (found(method, 0.02), found(method, 0.01));
        for (i, frequency) in frequencies.iter().enumerate() {
            let exact = (0.7 * frequency).cos();
            let error = |place: f64| (place - exact).abs();
            let [coarse, fine] = [long.responses[i], short.responses[i]].map(error);
            assert_eq!((long.rows[i].steps, short.rows[i].steps), (35, 70));
            // Of e⁻ᶻ(R(z) − eᶻ), R the stability polynomial, the second term is 1.72 z times the first for Dormand &
            // Prince, whose 6th coefficient is 1/600, and less for the others: with |z| = ωh ≤ 0.07 and 1/1.3 < |tan
            // ωt| < 1.3 at most 0.16 of it at the longer step, half of that at the shorter: log₂(0.84/0.92) = −0.13
            let seen = (coarse / fine).log2();
            assert!((seen - f64::from(order)).abs() < 0.2, "{method:?} {seen}");
            let told = short.rows[i].error * exact.abs();
            assert!(
                fine < 2.0 * told && told < 2.0 * fine,
                "{method:?}: {told:e}, not {fine:e}"
            );
        }
    }
}

#[test]
fn the_error_estimate_over_kinks_assumes_first_order() {
    let all: Vec<f64> = scenarios(24).concat();
    let found = |step, estimate| {
        let settings = fixed(LaneFormula::Rk4, step);
        rows(&BUMPER, &finals(settings, 4, estimate), &all).unwrap()
    };
    let (told, long) = (found(1e-3, true), found(2e-3, false));
    for (i, row) in told.rows.iter().enumerate() {
        let (fine, coarse) = (told.responses[i], long.responses[i]);
        // samples are up to a hundred times as large as what ends near 0
        let scale = fine.abs().max(coarse.abs());
        let difference = (fine - coarse).abs() / scale;
        let rounded = 0.5 * f64::EPSILON * f64::from(row.steps);
        assert!(row.error <= (1.0 + 1e-12) * difference + rounded, "{row:?}");
        assert!(row.error >= rounded);
        if scale > 0.2 {
            assert!(row.error >= (1.0 - 1e-12) * difference, "{row:?}");
        }
    }
}

#[test]
fn many_fixed_steps_in_singles_are_told_to_round() {
    let settings = Settings {
        duration: 0.7,
        ..fixed(LaneFormula::Dopri5, 1e-4)
    };
    let found = rows_of_singles(&SWING, &finals(settings, 1, true), &[3.0]).unwrap();
    let (row, place) = (found.rows[0], found.responses[0]);
    assert_eq!(row.steps, 7000);
    // 7000 roundings of half an ε each, 2⁻²⁴: 0.04 %, of which chance leaves less
    let exact = 2.1_f64.cos();
    let rounded = 7000.0 * 2.0_f64.powi(-24);
    assert!(row.error >= rounded, "{row:?}");
    assert!((place / exact - 1.0).abs() <= row.error, "{place} {row:?}");
}

struct Slopes<'a>(&'a Settings, &'a mut Rows<Dual<f64>>);

impl OfAnyWidth for Slopes<'_> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        run::<Dual<T>>(&BUMPER, self.0, self.1);
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
    let mut rows = Rows::new(rows);
    with_compiled(Width::widest(), Slopes(&located, &mut rows)).unwrap();
    let runs = rows.all();
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
            // of the difference: h² times a third derivative below 10⁴ of what moves by 0.1 m, and 10⁻¹³ × some hundred
            // steps / h; of ours: 10⁻⁹ × some hundred steps
            let difference = (right[k] - left[k]) / (2.0 * h);
            let ours = values[k].slope;
            assert!(
                (ours - difference).abs() < 1e-6,
                "{along} {k}: {ours} {difference}"
            );
        }
    }
}

#[test]
fn derivatives_of_what_is_summed_up_know_when_a_force_jumps() {
    let row = [1.0, 100.0, 0.06, 300.0];
    let responses = [
        (1, Response::Integral),
        (2, Response::Final),
        (1, Response::Mean),
        (1, Response::Peak),
        (1, Response::Clip { duration: 0.05 }),
        (1, Response::ContiguousClip { duration: 0.02 }),
        (1, Response::Hic { window: 0.036 }),
    ];
    let job = |tolerance: f64| Job {
        settings: Settings {
            locate: true,
            samples: 401,
            ..settings(Pace::Adaptive(Tolerances::of(tolerance)))
        },
        varied: vec![0, 1, 2, 3],
        fixed: Vec::new(),
        responses: responses
            .map(|(output, response)| Asked::of(output, response))
            .to_vec(),
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    };
    let along = |i: usize| (0..4).map(move |k| if k == i { row[i] } else { 0.0 });
    let directions: Vec<f64> = (0..4).flat_map(along).collect();
    let found = gradients(&BUMPER, &job(1e-9), &row, &directions).unwrap();
    for direction in 0..4 {
        let slopes = &found.slopes[direction * responses.len()..][..responses.len()];
        let moved = |by: f64| {
            let mut row = row;
            row[direction] *= 1.0 + by;
            gradients(&BUMPER, &job(1e-13), &row, &[0.0; 4])
                .unwrap()
                .values
        };
        let h = 1e-6;
        let (right, left) = (moved(h), moved(-h));
        for (k, (_, response)) in responses.iter().enumerate() {
            let difference = (right[k] - left[k]) / (2.0 * h);
            // of the difference: h² times what bends, and 10⁻¹³ × some hundred steps / h of values up to 20; of ours:
            // 10⁻⁹ × some hundred steps
            let bound = 1e-5 * found.values[k].abs().max(1.0);
            assert!(
                (slopes[k] - difference).abs() < bound,
                "{direction} {response:?}: {} {difference}",
                slopes[k]
            );
        }
        // What the force takes, 1 kg loses, but for 2 N from 0.1 s on. The force has four smooth pieces of at most 24 N
        // · sin(20 t), of which the line through samples sums h²/12 of what the rate changes by too little, 2 · 480
        // N/s; a parameter moves that by at most 20 · 0.4 + 2 times itself.
        let impulse = [row[0], 0.0, 0.0, 0.0][direction] - slopes[1];
        let bound = 1e-6 / 12.0 * 4.0 * 960.0 * 10.0;
        assert!(
            (slopes[0] - impulse).abs() < bound,
            "{direction}: {} {impulse}",
            slopes[0]
        );
        assert!(impulse.abs() > 5.0 * bound, "{direction}: {impulse}");
    }
}

#[test]
fn what_is_given_up_ends_there_and_nothing_else_does() {
    // 4000 steps or some more, asked at every 1024th
    for (patience, steps) in [(100, 1024), (1024, 2048), (3000, 3072), (4096, u32::MAX)] {
        for width in Width::ALL.into_iter().filter(|width| width.is_available()) {
            let mut rows = Rows::new(scenarios(13));
            rows.patience = patience;
            let settings = fixed(LaneFormula::Rk4, 1e-4);
            with_compiled(width, Batch(&settings, &mut rows)).expect("registers");
            for (scenario, (ended, _)) in rows.all().iter().enumerate() {
                if scenario % 2 == 1 && steps < u32::MAX {
                    assert_eq!((ended.status, ended.steps), (Status::TooManySteps, steps));
                } else {
                    assert_eq!(ended.status, Status::Done, "{scenario}");
                }
            }
        }
    }
}
