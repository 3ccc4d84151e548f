//! Times for scenes of real size: the derivative, a run, and a row of a study in lanes. Each is shown beside its parts.
//!
//! ```text
//! cargo bench -p bryant-engine --bench scenes
//! cargo bench -p bryant-engine --bench scenes -- occupant
//! ```
//!
//! A run is watched and has its samples, as in `bryant run`. Its time is divided by that of its evaluations. A second
//! run counts and times the calls of every method. The time of a call is the median, less the time of reading the
//! clock, so a busy machine gives the same result as an idle one. The time of a run is processor time, where the system
//! tells it.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job, rows};
use bryant_runtime::batch::{Pace, Settings as BatchSettings};
use bryant_runtime::simulate::{Watch, run};
use bryant_runtime::{
    Adjustable, Dynamics, Family, Info, Real, Response, Section, Settings, Tolerances, Width,
};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

type Failed = Box<dyn std::error::Error>;

/// A scene and its study: parameters with their ranges \[SI\], time between samples \[s\], responses.
struct Case {
    name: &'static str,
    file: &'static str,
    varied: &'static [(&'static str, f64, f64)],
    sampling: f64,
    responses: &'static [(&'static str, Response)],
    /// Goal for a row in eight lanes \[ms\].
    goal: f64,
}

const KM_H: f64 = 1.0 / 3.6;

const SCENES: [Case; 3] = [
    Case {
        name: "occupant",
        file: "benches/scenes/occupant.yaml",
        varied: &[
            ("limit", 3e3, 8e3),
            ("lap_slack", 0.0, 0.05),
            ("pulse_scale", 0.8, 1.1),
            ("knee_scale", 0.5, 2.0),
        ],
        sampling: 2e-3,
        responses: &[
            ("head acceleration", Response::Hic { window: 15e-3 }),
            ("thorax acceleration", Response::Clip { duration: 3e-3 }),
            ("shoulder force", Response::Peak),
            ("knee left", Response::Peak),
        ],
        goal: 4.0,
    },
    Case {
        name: "pedestrian",
        file: "benches/scenes/pedestrian.yaml",
        varied: &[
            ("speed", 30.0 * KM_H, 50.0 * KM_H),
            ("hood_friction", 0.1, 0.5),
            ("windscreen_scale", 0.5, 2.0),
        ],
        sampling: 1e-4,
        responses: &[
            ("head acceleration", Response::Hic { window: 15e-3 }),
            ("head acceleration", Response::Hic { window: 36e-3 }),
            ("head acceleration", Response::Clip { duration: 3e-3 }),
            ("screen-head force", Response::Peak),
            ("screen-head force", Response::TimeOfPeak),
        ],
        goal: 6.0,
    },
    Case {
        name: "child-seat",
        file: "models/child-seat.yaml",
        varied: &[],
        sampling: 1e-3,
        responses: &[],
        goal: f64::NAN,
    },
];

fn main() -> Result<(), Failed> {
    // `cargo test` builds this file, too, and runs it once; then nothing is measured
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if !arguments.iter().any(|argument| argument == "--bench") {
        return Ok(());
    }
    let wanted: Vec<&String> = arguments.iter().filter(|a| !a.starts_with('-')).collect();
    for scene in &SCENES {
        if wanted.is_empty() || wanted.iter().any(|name| *name == scene.name) {
            measure(scene)?;
        }
    }
    Ok(())
}

fn measure(scene: &Case) -> Result<(), Failed> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let (model, _) = bryant_generator::read(&root.join(scene.file))?;
    let engine = Engine::new(Config::new().matrices(false).lists(&model))?;
    println!("{}", scene.name);
    single(&engine)?;
    if !scene.responses.is_empty() {
        for width in [Width::Eight, Width::Four] {
            in_lanes(&engine, scene, width)?;
        }
    }
    Ok(())
}

/// One run: its time over that of the derivative, and its parts.
fn single(engine: &Engine) -> Result<(), Failed> {
    let machine = engine.over::<f64>();
    watched(&machine)?;
    let mut evaluations = 0;
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Clock::now();
        for _ in 0..RUNS {
            evaluations = watched(&machine)?.0;
        }
        least = least.min(start.elapsed() / RUNS as f64);
    }
    let counted = Counted::new(engine.over::<f64>());
    let (_, steps) = watched(&counted)?;
    let derivative = median(&counted.counts, "derivative");
    let model = evaluations as f64 * derivative;
    println!(
        "  derivative {:.3} µs; run {:.2} ms, {evaluations} evaluations: {:.2} × their derivatives (goal 1.5)",
        1e6 * derivative,
        1e3 * least,
        least / model
    );
    tell(&counted.counts, steps, model);
    Ok(())
}

/// The number of runs that are timed together, and how often this is repeated.
const RUNS: usize = 5;
const ROUNDS: usize = 5;

/// The processor time of this thread, or the wall time where the system does not tell it.
struct Clock {
    start: Instant,
    processor: Option<f64>,
}

impl Clock {
    fn now() -> Self {
        Clock {
            start: Instant::now(),
            processor: Self::processor(),
        }
    }

    /// \[s\]
    fn processor() -> Option<f64> {
        // the time of a running thread is updated when it yields
        std::thread::yield_now();
        let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        Some(1e-9 * text.split(' ').next()?.parse::<f64>().ok()?)
    }

    /// \[s\]
    fn elapsed(&self) -> f64 {
        match (Self::processor(), self.processor) {
            (Some(now), Some(before)) => now - before,
            _ => self.start.elapsed().as_secs_f64(),
        }
    }
}

/// A watched run as the model says. Returns the numbers of evaluations and of steps.
fn watched(machine: &dyn Dynamics<f64>) -> Result<(u64, u64), Failed> {
    let info = machine.info();
    let settings = Settings::of(info);
    let mut initial = vec![0.0; info.state_length()];
    machine.initial_state(&mut initial);
    let mut watch = Watch::new(info, 0.02);
    let report = run(
        machine,
        &initial,
        &settings,
        Some(&mut watch),
        &mut |sample| {
            std::hint::black_box(sample.outputs);
            ControlFlow::Continue(())
        },
    )
    .map_err(|failure| failure.to_string())?;
    Ok((report.evaluations, report.steps + report.rejected))
}

/// Rows of the study in lanes, each with its error estimate.
fn in_lanes(engine: &Engine, scene: &Case, width: Width) -> Result<(), Failed> {
    if !width.is_available() {
        println!("  no registers of width {}", width.name());
        return Ok(());
    }
    let job = job(engine.info(), scene, width)?;
    let rows_wanted = 32;
    let given = spread(scene, rows_wanted);
    let mut least = f64::INFINITY;
    for _ in 0..3 {
        let start = Clock::now();
        let results = rows(engine, &job, &given)?;
        least = least.min(start.elapsed());
        std::hint::black_box(results);
    }
    let row = 1e3 * least / rows_wanted as f64;
    println!(
        "  a row with its estimate, {} lanes: {row:.2} ms (goal {} in eight)",
        width.name(),
        scene.goal
    );
    let counts = Shared::default();
    let counted = CountedFamily(engine, &counts);
    let results = rows(&counted, &job, &given)?;
    let steps: u32 = results
        .rows
        .iter()
        .map(|row| row.steps + row.rejected)
        .sum();
    tell(&counts, u64::from(steps), least);
    Ok(())
}

fn job(info: &Info, scene: &Case, width: Width) -> Result<Job, Failed> {
    let varied = scene.varied.iter().map(|(name, ..)| {
        let found = info.parameters.iter().position(|p| p.name == *name);
        found.ok_or_else(|| format!("no parameter {name}"))
    });
    let responses = scene.responses.iter().map(|(name, response)| {
        let found = info.outputs.iter().position(|o| o.name == *name);
        let output = found.ok_or_else(|| format!("no output {name}"))?;
        Ok(Asked::of(output, *response))
    });
    Ok(Job {
        settings: BatchSettings {
            duration: info.duration,
            samples: (info.duration / scene.sampling).round() as usize + 1,
            pace: Pace::Adaptive(Tolerances::of(1e-6)),
            locate: false,
            max_steps: 1_000_000,
            time_limit: None,
            energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        },
        varied: varied.collect::<Result<_, String>>()?,
        fixed: Vec::new(),
        responses: responses.collect::<Result<_, String>>()?,
        estimate: true,
        wanted: f64::INFINITY,
        width,
    })
}

/// Rows that fill the ranges of the parameters uniformly: Weyl's sequence.
fn spread(scene: &Case, count: usize) -> Vec<f64> {
    let mut rows = Vec::new();
    for row in 0..count {
        for (place, (_, from, to)) in scene.varied.iter().enumerate() {
            let root = [2.0f64, 3.0, 5.0, 7.0][place].sqrt();
            rows.push(from + (to - from) * (0.5 + row as f64 * root).fract());
        }
    }
    rows
}

/// For each method, the times of its calls \[s\].
type Shared = RefCell<BTreeMap<&'static str, Vec<f32>>>;

/// The median of the times of a method \[s\].
fn median(counts: &Shared, name: &str) -> f64 {
    let counts = counts.borrow();
    let Some(times) = counts.get(name) else {
        return 0.0;
    };
    let middle = |mut times: Vec<f32>| {
        times.sort_by(f32::total_cmp);
        f64::from(times[times.len() / 2])
    };
    // two looks at the clock with nothing between them
    let nothing = middle(
        (0..1001)
            .map(|_| Instant::now().elapsed().as_secs_f32())
            .collect(),
    );
    (middle(times.clone()) - nothing).max(0.0)
}

fn tell(counts: &Shared, steps: u64, whole: f64) {
    println!(
        "    {:18} {:>9} {:>7} {:>9} {:>7}",
        "", "calls", "a step", "µs each", "share"
    );
    let mut sum = 0.0;
    for (name, times) in counts.borrow().iter() {
        let (calls, each) = (times.len() as f64, median(counts, name));
        println!(
            "    {name:18} {calls:>9} {:>7.2} {:>9.3} {:>7.3}",
            calls / steps as f64,
            1e6 * each,
            calls * each / whole
        );
        sum += calls * each;
    }
    println!(
        "    {:18} {:>9} {:>7} {:>9} {:>7.3}",
        "all",
        "",
        "",
        "",
        sum / whole
    );
}

/// A model whose calls are counted and timed.
struct Counted<M> {
    model: M,
    counts: Shared,
}

impl<M> Counted<M> {
    fn new(model: M) -> Self {
        Counted {
            model,
            counts: Shared::default(),
        }
    }
}

/// A family whose models all count into one table.
struct CountedFamily<'a>(&'a Engine, &'a Shared);

struct CountedIn<'a, T: Real> {
    model: Box<dyn Adjustable<T> + 'a>,
    counts: &'a Shared,
}

impl Family for CountedFamily<'_> {
    fn info(&self) -> &Info<'_> {
        self.0.info()
    }

    fn over<T: Real>(&self) -> Box<dyn Adjustable<T> + '_> {
        Box::new(CountedIn {
            model: Family::over(self.0),
            counts: self.1,
        })
    }

    fn for_batch<T: Real>(&self) -> Box<dyn Adjustable<T> + '_> {
        Box::new(CountedIn {
            model: Family::for_batch(self.0),
            counts: self.1,
        })
    }
}

/// [`Dynamics`] for a type that holds a model, with every call counted.
macro_rules! counted {
    ($($name:ident($($given:ident: $type:ty),*) $(-> $output:ty)?;)*) => {
        $(
            fn $name(&self, $($given: $type),*) $(-> $output)? {
                let start = Instant::now();
                let result = self.model.$name($($given),*);
                let time = start.elapsed().as_secs_f32();
                self.counts.borrow_mut().entry(stringify!($name)).or_default().push(time);
                result
            }
        )*
    };
}

macro_rules! methods {
    () => {
        fn info(&self) -> &Info<'_> {
            self.model.info()
        }

        fn parameter(&self, index: usize) -> Option<T> {
            self.model.parameter(index)
        }

        counted! {
            initial_state(y: &mut [T]);
            derivative(t: T, y: &[T], rate: &mut [T]);
            coordinate_rates(y: &[T], rate: &mut [T]);
            jacobian(t: T, y: &[T], by_state: &mut [T], by_time: &mut [T]) -> bool;
            normalize(y: &mut [T]);
            smallest_pivot(t: T, y: &[T]) -> Option<(usize, T)>;
            violated() -> Option<usize>;
            kink_after(t: f64) -> T;
        }

        fn section(&self, section: Section, t: T, y: &[T], results: &mut [T]) {
            let start = Instant::now();
            self.model.section(section, t, y, results);
            let time = start.elapsed().as_secs_f32();
            let mut counts = self.counts.borrow_mut();
            counts.entry(section.name()).or_default().push(time);
        }

        fn sections(&self, t: T, y: &[T], wanted: &mut [(Section, &mut [T])]) {
            let start = Instant::now();
            self.model.sections(t, y, wanted);
            let time = start.elapsed().as_secs_f32();
            // the powers alone are wanted within a step
            let name = match wanted.len() {
                2 => "exchange",
                _ => "arrive",
            };
            self.counts.borrow_mut().entry(name).or_default().push(time);
        }
    };
}

impl<T: Real, M: Dynamics<T>> Dynamics<T> for Counted<M> {
    methods!();
}

impl<T: Real> Dynamics<T> for CountedIn<'_, T> {
    methods!();
}

impl<T: Real> Adjustable<T> for CountedIn<'_, T> {
    fn want_outputs(&mut self, wanted: &[usize]) {
        self.model.want_outputs(wanted);
    }

    fn set_parameters(&mut self, values: &[T]) {
        let start = Instant::now();
        self.model.set_parameters(values);
        let time = start.elapsed().as_secs_f32();
        self.counts
            .borrow_mut()
            .entry("set_parameters")
            .or_default()
            .push(time);
    }
}
