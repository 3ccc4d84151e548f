//! Every kink of every force law is known: if the derivative is not smooth along a line through the state, a switching
//! function or an event function changes its sign, or time passes a breakpoint.
//!
//! Along the line y + s ẏ, with memory held, the second difference of ẏ over a grid of width h is h² ẏ″ in smooth
//! parts. At a kink it is about h times the jump of the slope, in the one or two differences that contain the kink. A
//! second difference that is many times larger than its neighbours cannot come from the smooth part on a grid that
//! resolves it, so it is a kink.

use crate::share::share;
use bryant_generator::law::ForceKind;
use bryant_generator::model::Model;
use bryant_generator::read;
use bryant_runtime::Section;
use bryant_runtime::program::{Entry, Job};
use bryant_tests::models::MODELS;
use bryant_tests::trees::Random;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::Path;

/// Number of states along a run from which lines begin.
const STATES: usize = 40;
/// Number of cells of the grid on a line, which reaches as far as the next state.
const CELLS: usize = 800;
/// A second difference at a kink is this many times larger than its neighbours: hundreds of cells lie between two
/// samples, so the smooth part changes little from one cell to the next.
const STICKS_OUT: f64 = 30.0;
/// A jump below this share of the largest rate of the run is not seen: a thousand times the rounding of equations with
/// condition 10³.
const UNSEEN: f64 = 1e6 * f64::EPSILON;

/// Kinks that are the only sign of a non-smooth effect in some model.
const NEEDED: [&str; 19] = [
    "begins to fade",
    "crosses an edge",
    "damping is full",
    "goes taut",
    "kink of the curve",
    "kink of the elastic curve",
    "lower stop begins",
    "lower stop damps in full",
    "lower stop pushes",
    "pulls",
    "pulls with the force of the limiter",
    "pushes",
    "slides",
    "the line ends",
    "the line meets the loading curve",
    "the line meets the unloading curve",
    "touches",
    "upper stop begins",
    "upper stop pushes",
];

/// The kinks on the lines of a model.
#[derive(Debug, Default)]
struct Seen {
    /// Number of known kinks.
    told: usize,
    /// Switching functions that were the only sign of a kink, without the name of their force: "touches", "slides".
    alone: BTreeSet<&'static str>,
    /// Unknown kinks: the line, the place on it, the entry of the derivative.
    untold: Vec<String>,
}

/// |f(i + 1) − 2 f(i) + f(i − 1)| of one entry over all inner points.
fn second_differences(rates: &[Vec<f64>], entry: usize) -> Vec<f64> {
    let of = |three: &[Vec<f64>]| {
        (three[2][entry] - three[1][entry]) - (three[1][entry] - three[0][entry])
    };
    rates.windows(3).map(|three| of(three).abs()).collect()
}

fn look(entry: &Entry, direction: impl Fn(&mut Random, &[f64]) -> Vec<f64>) -> Seen {
    let info = entry.info;
    let every = info.duration / STATES as f64;
    let job = Job {
        every: Some(every),
        ..Job::default()
    };
    let mut states = Vec::new();
    entry
        .run(&job, &mut |t, y, _| {
            states.push((t, y.to_vec()));
            ControlFlow::Continue(())
        })
        .unwrap_or_else(|error| panic!("{}: {}", info.name, error.message));

    let size = states[0].1.len();
    let moving = size - info.memory.len();
    let names: Vec<&'static str> = info
        .kinks
        .iter()
        .chain(info.event_functions)
        .map(|name| name.split_once(": ").map_or(*name, |(_, what)| what))
        .collect();
    let signs = info.kinks.len() + info.event_functions.len();
    let h = every / CELLS as f64;
    let mut random = Random::new(info.name.bytes().map(u64::from).sum());
    let mut seen = Seen::default();
    let derivative = |t: f64, y: &[f64]| {
        let mut rate = vec![0.0; size];
        entry
            .derivative(&[], t, y, &mut rate)
            .expect("a derivative");
        rate
    };
    let largest = |rates: &[Vec<f64>]| rates.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
    let of_states: Vec<_> = states.iter().map(|(t, y)| derivative(*t, y)).collect();
    let of_run = largest(&of_states);
    // memory is that of the states: the lines go forward, as steps do
    for ((t, y), rate) in states.iter().zip(&of_states) {
        let along = direction(&mut random, rate);
        let mut rates = Vec::new();
        let mut functions = Vec::new();
        let mut times = Vec::new();
        for i in 0..=CELLS {
            let s = i as f64 * h;
            let there: Vec<f64> = y
                .iter()
                .zip(&along)
                .enumerate()
                .map(|(k, (y, rate))| if k < moving { y + s * rate } else { *y })
                .collect();
            let of = |section| entry.section(section, &[], t + s, &there);
            let mut kinks = of(Section::Kinks).expect("kinks");
            kinks.extend(of(Section::EventFunctions).expect("event functions"));
            rates.push(derivative(t + s, &there));
            functions.push(kinks);
            times.push(t + s);
        }
        // the functions that change sign between two points of the grid
        let told = |from: usize, to: usize| -> Vec<&'static str> {
            let changes = |k: &usize| (functions[from][*k] < 0.0) != (functions[to][*k] < 0.0);
            let mut told: Vec<_> = (0..signs).filter(changes).map(|k| names[k]).collect();
            let of_parameters = entry.kink_after(&[], times[from]).expect("a time");
            let mut at = info.breakpoints.iter().chain([&of_parameters]);
            if at.any(|at| times[from] <= *at && *at <= times[to]) {
                told.push("breakpoint");
            }
            told
        };
        let largest = largest(&rates).max(of_run);
        for k in 0..moving {
            let second = second_differences(&rates, k);
            // second[j] contains the points j to j + 2; a kink in the cell from c to c + 1 is in second[c − 1] and
            // second[c]
            for c in 4..second.len() - 4 {
                let here = second[c - 1].max(second[c]);
                let beside = [c - 4, c - 3, c - 2, c + 1, c + 2, c + 3];
                let beside = beside.map(|j| second[j]).into_iter().fold(0.0, f64::max);
                if here > STICKS_OUT * beside + UNSEEN * largest {
                    // a kink at a point of the grid may be in either cell
                    let told = told(c - 1, c + 2);
                    if let [name] = told[..] {
                        seen.alone.insert(name);
                    }
                    if !told.is_empty() {
                        seen.told += 1;
                    } else {
                        seen.untold.push(format!(
                            "at t = {t} + {:e}: rate {k} of {}, {here:e} beside {beside:e} of {largest:e}",
                            times[c] - t,
                            info.state_name(k).unwrap_or_default()
                        ));
                    }
                }
            }
        }
    }
    seen
}

#[test]
fn no_kink_is_forgotten() {
    let compiled = MODELS.iter().map(|m| (m.entry, has_users(&m.model())));
    let bundled = bryant_generated::MODELS.iter().map(|m| {
        let name = m.entry.info.name;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{name}.yaml"));
        let (model, _) = read(&path).unwrap_or_else(|problems| panic!("{problems}"));
        (m.entry, has_users(&model))
    });
    let (mut told, mut alone, mut forgotten) = (0, BTreeSet::new(), Vec::new());
    let models: Vec<_> = compiled
        .chain(bundled)
        .filter(|(_, users)| !users)
        .collect();
    let count = models.len();
    let chosen = share(8, models);
    let all = chosen.len() == count;
    for (entry, _) in chosen {
        // along the motion, and along motions with other velocities
        let straight = look(&entry, |_, rate| rate.to_vec());
        // coordinates continue as before: webbing that a belt has paid out does not come back
        let coordinates = entry.info.coordinates.len();
        let aside = look(&entry, |random, rate| {
            let factor = |i: usize| random.uniform(if i < coordinates { 0.2 } else { -2.0 }, 2.0);
            let factors: Vec<f64> = (0..rate.len()).map(factor).collect();
            factors.iter().zip(rate).map(|(a, b)| a * b).collect()
        });
        let name = entry.info.name;
        println!("{name:24} {:6} {:6}", straight.told, aside.told);
        for seen in [straight, aside] {
            told += seen.told;
            alone.extend(seen.alone);
            if let Some(first) = seen.untold.first() {
                let count = seen.untold.len();
                forgotten.push(format!("{name} has {count}, the first {first}"));
            }
        }
    }
    assert!(
        forgotten.is_empty(),
        "kinks that nothing tells:\n{}",
        forgotten.join("\n")
    );
    // a share may be of models without kinks
    if !all {
        return;
    }
    // without any of these functions, a model would have an unknown kink
    for name in NEEDED {
        assert!(alone.contains(name), "no model needs \"{name}\": {alone:?}");
    }
    assert!(told > 1000, "only {told} kinks were seen");
}

/// Whether user functions act, whose kinks are not known.
fn has_users(model: &Model) -> bool {
    let mut forces = model.forces.iter();
    forces.any(|force| matches!(ForceKind::of(force), ForceKind::User(_)))
}
