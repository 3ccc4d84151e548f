//! No step goes over a touch, an edge, a taut belt or a stop: random scenes whose motion is known in closed form until something acts.
//!
//! Everything flies freely for a second, so a method of order 2 or more would take it in one step, and shows nothing at its end of what it
//! went over. Whether anything is met follows from the straight line or the parabola. Where it is met by more than a hundredth of its
//! size, the end of the run must differ from that of free flight; where it is not met, it must be that end.

use bryant_engine::Engine;
use bryant_generator::{Config, model};
use bryant_runtime::batch::{self, Ended, Scenarios, Series};
use bryant_runtime::real::lanes::{OfAnyWidth, Width, with_width};
use bryant_runtime::{
    Adjustable, Dynamics, Family, Formula, Method, Settings, Several, Tolerances, simulate,
};
use std::ops::ControlFlow;

/// Scenes of each shape.
const SCENES: usize = 170;
/// Methods of single runs, one after the other.
const FORMULAS: [Formula; 5] = [
    Formula::Dopri5,
    Formula::Tsit5,
    Formula::Dop853,
    Formula::Rodas5,
    Formula::Merson,
];
/// Times between samples of single runs \[s\].
const EVERY: [f64; 3] = [1.0, 0.1, 1e-3];
const DURATION: f64 = 1.0;

/// Numbers that look random.
struct Random(u64);

impl Random {
    /// Evenly between 0 and 1 (splitmix64, Steele, Lea and Flood 2014).
    fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / 2f64.powi(64)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Evenly in its logarithm.
    fn of_size(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.share())
    }

    fn direction(&mut self) -> [f64; 2] {
        let angle = self.between(0.0, std::f64::consts::TAU);
        [angle.cos(), angle.sin()]
    }

    /// Sizes and speeds of the family.
    fn size(&mut self) -> f64 {
        self.of_size(1e-3, 1.0)
    }

    fn speed(&mut self) -> f64 {
        self.of_size(0.1, 500.0)
    }
}

/// Whether something is met.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Met {
    Yes,
    No,
    /// By too little to be seen, or nobody can tell.
    Hardly,
}

/// A scene of a shape.
struct Case {
    /// The parameters of the shape, in its order.
    parameters: Vec<f64>,
    /// The outputs at the end, if nothing is met.
    free: Vec<f64>,
    /// What a difference is measured by.
    scale: f64,
    met: Met,
}

/// Stiffness of a mass of 1 that turns it within a tenth of a size.
fn stiffness(speed: f64, size: f64) -> f64 {
    (speed / (0.1 * size)).powi(2)
}

fn met(depth: f64, size: f64) -> Met {
    match depth / size {
        share if share > 0.01 => Met::Yes,
        share if share < -1e-6 => Met::No,
        _ => Met::Hardly,
    }
}

const BALLS: &str = "
model: balls
dimension: 2
parameters: { x: -1 m, z: 0 m, u: 1 m/s, w: 0 m/s, r: 10 mm, other: 10 mm, k: 1 N/m }
curves: { line: { unit: [m, m], points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { position: [x, z], velocity: [u, w] }
  - name: target
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
forces:
  - contact: hit
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [r, r] }
    with: { on: target/body, center: [0, 0], semi_axes: [other, other] }
    elastic: { curve: line, times: k }
outputs:
  - { name: vx, of: ball/body, what: velocity, component: x }
  - { name: vz, of: ball/body, what: velocity, component: z }
run: { duration: 1 s, every: 0.1 s }
";

fn balls(random: &mut Random) -> Case {
    let (r, s, speed) = (random.size(), random.size(), random.speed());
    let (along, at) = (random.direction(), random.between(0.1, 0.9));
    let aside = random.between(-1.3, 1.3) * (r + s);
    let before = speed * at;
    let place = [
        -before * along[0] - aside * along[1],
        -before * along[1] + aside * along[0],
    ];
    let velocity = along.map(|x| speed * x);
    // idle at both ends of the run
    let clear = |t: f64| (speed * (t - at)).hypot(aside) > r + s;
    let [x, z] = place;
    let [u, w] = velocity;
    Case {
        parameters: vec![x, z, u, w, r, s, stiffness(speed, r.min(s))],
        free: velocity.to_vec(),
        scale: speed,
        met: match clear(0.0) && clear(1.0) {
            true => met(r + s - aside.abs(), r.min(s)),
            false => Met::Hardly,
        },
    }
}

const ELLIPSOIDS: &str = "
model: ellipsoids
dimension: 3
parameters: { x: -1 m, y: 0 m, z: 0 m, u: 1 m/s, v: 0 m/s, w: 0 m/s, a: 10 mm, b: 10 mm, c: 20 mm, k: 1 N/m }
curves: { line: { unit: [m, m], points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
    start: { position: [x, y, z], velocity: [u, v, w] }
  - name: target
    elements: [{ name: body, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]
forces:
  - contact: hit
    ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [a, b, c] }
    with: { on: target/body, center: [0, 0, 0], semi_axes: [a, b, c] }
    elastic: { curve: line, times: k }
outputs:
  - { name: vx, of: ball/body, what: velocity, component: x }
  - { name: vy, of: ball/body, what: velocity, component: y }
  - { name: vz, of: ball/body, what: velocity, component: z }
run: { duration: 1 s, every: 0.1 s }
";

/// Two of one shape that do not turn touch where their centres are an ellipsoid of twice the size apart.
fn ellipsoids(random: &mut Random) -> Case {
    let a = random.size();
    let axes = [
        a,
        a * random.between(0.3, 1.0),
        a * random.between(0.3, 1.0),
    ];
    let (speed, at) = (random.speed(), random.between(0.1, 0.9));
    let mut along = [(); 3].map(|()| random.between(-1.0, 1.0));
    let norm = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    along = along.map(|x| x / norm);
    let through = axes.map(|axis| 1.5 * axis * random.between(-1.0, 1.0));
    let start: Vec<f64> = (0..3).map(|i| through[i] - speed * at * along[i]).collect();
    // nearest to the centre where the ellipsoid is a ball of radius 1
    let (p, d): (Vec<f64>, Vec<f64>) = (0..3)
        .map(|i| (through[i] / (2.0 * axes[i]), along[i] / (2.0 * axes[i])))
        .unzip();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let way = -dot(&p, &d) / dot(&d, &d);
    let nearest = (dot(&p, &p) - way * way * dot(&d, &d)).max(0.0).sqrt();
    let clear = |t: f64| {
        let far = speed * (t - at);
        let there: Vec<f64> = (0..3).map(|i| p[i] + far * d[i]).collect();
        dot(&there, &there) > 1.0
    };
    let least = axes[1].min(axes[2]);
    let velocity = along.map(|x| speed * x);
    let mut parameters = start;
    parameters.extend(velocity);
    parameters.extend(axes);
    parameters.push(stiffness(speed, least));
    Case {
        parameters,
        free: velocity.to_vec(),
        scale: speed,
        met: match clear(0.0) && clear(1.0) {
            true => met(1.0 - nearest, 1.0),
            false => Met::Hardly,
        },
    }
}

const PLATES: &str = "
model: plates
dimension: 2
parameters: { x: -1 m, z: 0 m, u: 1 m/s, w: 0 m/s, r: 10 mm, e: 20 mm, k: 1 N/m }
curves: { line: { unit: [m, m], points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { position: [x, z], velocity: [u, w] }
forces:
  - contact: shelf
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [r, r] }
    plane: { on: frame, at: [0, 0], normal: [0, 1], extent: e }
    elastic: { curve: line, times: k }
outputs:
  - { name: vx, of: ball/body, what: velocity, component: x }
  - { name: vz, of: ball/body, what: velocity, component: z }
run: { duration: 1 s, every: 0.1 s }
";

/// With a second plate, which makes a corner with the first.
const CORNERS: &str = "
  - contact: wall
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [r, r] }
    plane: { on: frame, at: [e, 0], normal: [-1, 0], extent: e }
    elastic: { curve: line, times: k }
";

/// How long a motion is between `low` and `high`, of a run from 0 to 1: when it begins and when it ends.
fn while_between(place: f64, speed: f64, [low, high]: [f64; 2]) -> [f64; 2] {
    let times = [(low - place) / speed, (high - place) / speed];
    [times[0].min(times[1]), times[0].max(times[1])]
}

/// How deep a ball is in a plate at most, along its `normal` and while beside neither of its edges: where it is idle at both ends of the
/// run, and is there for more than a hundredth of its size; `None` where that is not so.
fn depth(normal: [f64; 2], along: [f64; 2], r: f64, e: f64) -> Option<f64> {
    let [height, falls] = normal;
    let [from, to] = while_between(along[0], along[1], [-e, e]);
    let deep = |t: f64| r - (height + falls * t);
    let idle = |t: f64| t < from || to < t || deep(t) < 0.0;
    if !idle(0.0) || !idle(1.0) {
        return None;
    }
    let (from, to) = (from.max(0.0), to.min(1.0));
    if from >= to {
        return Some(f64::NEG_INFINITY);
    }
    let deepest = deep(from).max(deep(to));
    let long = (to - from) * along[1].abs().max(falls.abs()) > 0.02 * e.min(r);
    (long || deepest < 0.0).then_some(deepest)
}

fn plates(random: &mut Random, corner: bool) -> Case {
    let (r, e, speed) = (random.size(), random.size(), random.speed());
    let (along, at) = (random.direction(), random.between(0.1, 0.9));
    let through = [
        random.between(-1.3, 1.3) * e,
        r + random.between(-0.8, 0.2) * r,
    ];
    let [u, w] = along.map(|x| speed * x);
    let [x, z] = [through[0] - u * at, through[1] - w * at];
    let depths = [
        depth([z, w], [x, u], r, e),
        depth([e - x, -u], [z, w], r, e),
    ];
    let depths = &depths[..if corner { 2 } else { 1 }];
    let deepest = depths
        .iter()
        .flatten()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    Case {
        parameters: vec![x, z, u, w, r, e, stiffness(speed, r.min(e))],
        free: vec![u, w],
        scale: speed,
        met: match depths.iter().any(Option::is_none) {
            true => Met::Hardly,
            false => met(deepest, r.min(e)),
        },
    }
}

const BELTS: &str = "
model: belts
dimension: 2
parameters: { z: 0 m, w: 1 m/s, gravity: 10 m/s^2, l: 1 m, f: 1 N }
curves: { line: { points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { position: [0, z], velocity: [0, w] }
forces:
  - { field: gravity, acceleration: [0, -gravity] }
  - belt: leash
    from: { on: frame, at: [0, 0] }
    to: { on: ball/body, at: [0, 0] }
    length: l
    force: { curve: line, times: f }
outputs:
  - { name: z, of: ball/body, what: position, component: z }
run: { duration: 1 s, every: 0.1 s }
";

/// Thrown up it comes back at the end of the run.
fn belts(random: &mut Random) -> Case {
    let w = random.speed();
    let (g, apex) = (2.0 * w, 0.25 * w);
    let l = apex / random.between(0.6, 1.5);
    let z = 0.1 * l;
    Case {
        parameters: vec![z, w, g, l, stiffness(w, l) * l],
        free: vec![z],
        scale: l,
        met: met(z + apex - l, l),
    }
}

const STOPS: &str = "
model: stops
dimension: 2
parameters: { rate: 1 rad/s, moment: -1 N*m, end: 1 rad, k: 1 N*m/rad }
systems:
  - name: wheel
    reference: fixed
    elements: [{ name: wheel, mass: 1 kg, cg: [0, 0], inertia: 1 kg*m^2 }]
    start: { rates: { wheel: rate } }
forces:
  - { joint: wheel/wheel, stop: { to: end, stiffness: k } }
  - { load: back, on: wheel/wheel, moment: moment }
outputs:
  - { name: angle, of: wheel/wheel, what: angle }
run: { duration: 1 s, every: 0.1 s }
";

fn stops(random: &mut Random) -> Case {
    let rate = random.speed();
    let apex = 0.25 * rate;
    let end = apex / random.between(0.6, 1.5);
    Case {
        parameters: vec![rate, -2.0 * rate, end, stiffness(rate, end)],
        free: vec![0.0],
        scale: end,
        met: met(apex - end, end),
    }
}

/// A shape and its scenes.
struct Shape {
    name: &'static str,
    engine: Engine,
    cases: Vec<Case>,
}

fn shapes() -> Vec<Shape> {
    let corners = PLATES.replace("outputs:", &format!("{CORNERS}outputs:"));
    type Make = fn(&mut Random) -> Case;
    let all: [(&str, &str, Make); 6] = [
        ("balls", BALLS, balls),
        ("ellipsoids", ELLIPSOIDS, ellipsoids),
        ("plates", PLATES, |random| plates(random, false)),
        ("corners", &corners, |random| plates(random, true)),
        ("belts", BELTS, belts),
        ("stops", STOPS, stops),
    ];
    let mut random = Random(20);
    let shape = |(name, text, make): (&'static str, &str, Make)| {
        let loader = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
        let scene = model::scene::read_str(name, text, &loader).expect("scenes are right");
        let cases = std::iter::repeat_with(|| make(&mut random))
            .filter(|case| case.met != Met::Hardly)
            .take(SCENES);
        Shape {
            name,
            cases: cases.collect(),
            engine: Engine::new(Config::new().lists(&scene.model)).expect("no functions"),
        }
    };
    all.map(shape).into()
}

/// What is wrong with the end of a run, if anything is.
fn judged(case: &Case, end: &[f64]) -> Option<String> {
    let away = case
        .free
        .iter()
        .zip(end)
        .map(|(free, end)| (free - end).abs());
    let away = away.fold(0.0, f64::max) / case.scale;
    let wrong = match case.met {
        // a hundredth of a size deep it is turned by a tenth or more
        Met::Yes => away < 1e-3,
        // rounding of places of hundreds of metres
        Met::No => away > 1e-6,
        Met::Hardly => false,
    };
    (wrong || away.is_nan())
        .then(|| format!("{:?}, but {away:e} away: {:?}", case.met, case.parameters))
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
                method: Method::adaptive(formula, Tolerances::of(1e-6)),
                ..Settings::of(model.info())
            };
            let mut end = Vec::new();
            let done = simulate::run(&model, &start, &settings, None, &mut |sample| {
                end = sample.outputs.to_vec();
                ControlFlow::Continue(())
            });
            let mistake = match done {
                Ok(_) => judged(case, &end),
                Err(failure) => Some(failure.to_string()),
            };
            wrong.extend(mistake.map(|mistake| format!("{name} {i} by {formula}: {mistake}")));
        }
    }
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
        let mistake = match ended.status {
            batch::Status::Done => judged(case, &end),
            status => Some(format!("{status:?}")),
        };
        self.wrong
            .extend(mistake.map(|mistake| format!("{scenario}: {mistake}")));
    }
}

struct Batch<'a, 'b> {
    engine: &'a Engine,
    rows: &'a mut Rows<'b>,
}

impl OfAnyWidth for Batch<'_, '_> {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        let settings = batch::Settings {
            duration: DURATION,
            samples: 2,
            pace: batch::Pace::Adaptive(Tolerances::of(1e-6)),
            locate: false,
            max_steps: 100_000,
        };
        batch::run::<T>(self.engine, &settings, self.rows);
    }
}

#[test]
fn no_lane_steps_over_anything() {
    let mut wrong = Vec::new();
    for Shape {
        name,
        engine,
        cases,
    } in shapes()
    {
        let mut rows = Rows {
            cases: &cases,
            outputs: (0..Family::info(&engine).outputs.len()).collect(),
            wrong: Vec::new(),
        };
        let engine = &engine;
        let widths = [Width::Four, Width::Plain];
        let done = widths.into_iter().find_map(|width| {
            with_width(
                width,
                Batch {
                    engine,
                    rows: &mut rows,
                },
            )
        });
        assert!(done.is_some());
        wrong.extend(rows.wrong.iter().map(|mistake| format!("{name} {mistake}")));
    }
    assert!(
        wrong.is_empty(),
        "{} wrong\n{}",
        wrong.len(),
        wrong.join("\n")
    );
}
