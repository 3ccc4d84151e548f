//! Scenes of real size. Machine code has the bits of the interpreter in every method, over doubles and over lanes of
//! every width, at states where contacts, stops and belts act, with and without slopes. Rows of parameters have the
//! same bits in lanes of every width. Outputs of which only some are wanted have the same bits.

use super::common::Writes;
use bryant_engine::Engine;
use bryant_engine::internals::for_batch;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{Pace, Settings};
use bryant_runtime::real::Array8;
use bryant_runtime::real::lanes::{MOST_LANES, OfAnyWidth, with_width};
use bryant_runtime::{
    Dual, Dynamics, Formula, Integrator as RunMethod, Real, Reason, Response, Section,
    Settings as RunSettings, Several, Tolerances, Width, simulate,
};
use std::ops::ControlFlow;
use std::path::Path;

const SCENES: [&str; 2] = ["occupant", "pedestrian"];

fn engine(name: &str) -> Engine {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/scenes");
    let (model, _) = bryant_generator::read(&root.join(format!("{name}.yaml"))).unwrap();
    Engine::new(Config::new().matrices(false).lists(&model)).unwrap()
}

/// Weyl's sequence: uniform in −1 to 1.
struct Weyl(f64);

impl Weyl {
    fn next(&mut self) -> f64 {
        self.0 = (self.0 + std::f64::consts::SQRT_2).fract();
        2.0 * self.0 - 1.0
    }
}

/// Makes a scalar from the numbers of its lanes, and gives its bits.
struct Lanes<T> {
    of: fn(&[f64; MOST_LANES]) -> T,
    bits: fn(T) -> Vec<u64>,
}

fn bits(value: f64) -> u64 {
    match value.is_nan() {
        true => f64::NAN.to_bits(),
        false => value.to_bits(),
    }
}

/// States around the start; the further away, the more bodies overlap. Speeds go up to metres and radians per second.
fn state<T: Real>(
    model: &dyn Dynamics<T>,
    lanes: &Lanes<T>,
    reach: f64,
    weyl: &mut Weyl,
) -> Vec<T> {
    let info = model.info();
    let mut y = vec![T::from_f64(0.0); info.state_length()];
    model.initial_state(&mut y);
    let moves = info.coordinates.len() + info.velocities.len();
    for (index, entry) in y.iter_mut().enumerate().take(moves) {
        let speed = if index < info.coordinates.len() {
            1.0
        } else {
            10.0
        };
        *entry += (lanes.of)(&[(); MOST_LANES].map(|()| reach * speed * weyl.next()));
    }
    model.normalize(&mut y);
    y
}

fn same<T: Real>(what: &str, lanes: &Lanes<T>, one: &[T], other: &[T]) {
    for (index, (one, other)) in one.iter().zip(other).enumerate() {
        assert_eq!((lanes.bits)(*one), (lanes.bits)(*other), "{what} {index}");
    }
}

fn check<T: Real>(name: &str, lanes: &Lanes<T>) {
    let engine = engine(name);
    let [interpreted, code] = for_batch::<T>(&engine);
    let info = engine.info();
    let weyl = &mut Weyl(0.1);
    let nought = T::from_f64(0.0);
    for round in 0..12 {
        let reach = [0.0, 1e-3, 0.03, 0.2][round % 4];
        let y = state::<T>(&*code, lanes, reach, weyl);
        let t = (lanes.of)(&[(); MOST_LANES].map(|()| 0.08 * (1.0 + weyl.next())));
        let compare = |what: &str, count: usize, run: &Writes<'_, T>| {
            let [mut found, mut wanted] = [vec![nought; count], vec![nought; count]];
            run(&*code, &mut found);
            run(&*interpreted, &mut wanted);
            same(&format!("{name}: {what}"), lanes, &found, &wanted);
        };
        compare("derivative", y.len(), &|m, out| m.derivative(t, &y, out));
        for &section in Section::ALL {
            compare(section.name(), info.length(section), &|m, out| {
                m.section(section, t, &y, out);
            });
        }
        some_outputs(name, lanes, &engine, t, &y);
    }
}

/// Wanted outputs in any order, with one twice; then other wanted outputs.
fn some_outputs<T: Real>(name: &str, lanes: &Lanes<T>, engine: &Engine, t: T, y: &[T]) {
    let count = engine.info().outputs.len();
    let [mut some, mut all] = [(); 2].map(|()| vec![T::from_f64(0.0); count]);
    let [_, mut chosen] = for_batch::<T>(engine);
    chosen.outputs(t, y, &mut all);
    let each: Vec<usize> = (0..count).collect();
    for wanted in [&[2, 0, 2][..], &[count - 1], &[], &each] {
        chosen.want_outputs(wanted);
        some.fill(T::from_f64(f64::NAN));
        chosen.outputs(t, y, &mut some);
        for &index in wanted {
            let what = format!("{name}: output {index} of {wanted:?}");
            same(&what, lanes, &some[index..=index], &all[index..=index]);
        }
    }
}

#[test]
fn doubles() {
    let lanes = Lanes {
        of: |numbers| numbers[0],
        bits: |value: f64| vec![bits(value)],
    };
    for scene in SCENES {
        check(scene, &lanes);
    }
}

/// One scene.
struct Check(&'static str);

impl OfAnyWidth for Check {
    type Output = ();
    fn run<T: Several<One = f64>>(self) {
        let lanes = Lanes {
            of: |numbers: &[f64; MOST_LANES]| T::of_lanes(numbers),
            bits: |value: T| {
                let lanes = value.lanes().into_iter().take(T::LANES);
                lanes.map(bits).collect()
            },
        };
        check(self.0, &lanes);
        let duals = Lanes {
            of: |numbers: &[f64; MOST_LANES]| Dual {
                value: T::of_lanes(numbers),
                slope: T::of_lanes(&slopes(numbers)),
            },
            bits: |dual: Dual<T>| {
                let lanes = [dual.value, dual.slope].map(T::lanes);
                let there = lanes.iter().flat_map(|lanes| lanes.iter().take(T::LANES));
                there.map(|number| bits(*number)).collect()
            },
        };
        check(self.0, &duals);
    }
}

/// Numbers that differ from these, as slopes.
fn slopes(numbers: &[f64; MOST_LANES]) -> [f64; MOST_LANES] {
    let mut turned = *numbers;
    turned.rotate_left(5);
    turned
}

/// A value with eight slopes, each of which has the bits of a separate dual number.
#[test]
fn slopes_side_by_side() {
    let columns = Lanes {
        of: |numbers: &[f64; MOST_LANES]| Dual {
            value: Array8([numbers[0]; 8]),
            slope: Array8(std::array::from_fn(|i| numbers[i + 1])),
        },
        bits: |dual: Dual<Array8>| {
            dual.value
                .0
                .into_iter()
                .chain(dual.slope.0)
                .map(bits)
                .collect()
        },
    };
    let alone = Lanes {
        of: |numbers: &[f64; MOST_LANES]| Dual {
            value: numbers[0],
            slope: numbers[1],
        },
        bits: |dual: Dual<f64>| vec![bits(dual.value), bits(dual.slope)],
    };
    for scene in SCENES {
        check(scene, &columns);
        check(scene, &alone);
        jacobian(scene);
    }
}

/// Columns of the Jacobian are the slopes of interpreted dual numbers, one by one.
fn jacobian(scene: &str) {
    let engine = engine(scene);
    let (model, dual) = (engine.over::<f64>(), engine.interpreted::<Dual<f64>>());
    let numbers = Lanes {
        of: |numbers| numbers[0],
        bits: |value: f64| vec![bits(value)],
    };
    let weyl = &mut Weyl(0.3);
    for reach in [0.0, 0.03, 0.2] {
        let (t, y) = (0.05, state::<f64>(&model, &numbers, reach, weyl));
        let n = y.len();
        let [mut by_state, mut by_time] = [vec![0.5; n * n], vec![0.5; n]];
        assert!(model.jacobian(t, &y, &mut by_state, &mut by_time));
        let mut rate = vec![Dual::constant(0.0); n];
        for column in 0..=model.info().varying_length() {
            let seed = |entry: usize, value| Dual {
                value,
                slope: f64::from(u8::from(entry == column)),
            };
            let of_time = column == model.info().varying_length();
            let at: Vec<_> = (y.iter().enumerate())
                .map(|(entry, value)| seed(if of_time { usize::MAX } else { entry }, *value))
                .collect();
            let time = seed(if of_time { column } else { usize::MAX }, t);
            dual.derivative(time, &at, &mut rate);
            for (row, rate) in rate.iter().enumerate() {
                let found = match of_time {
                    true => by_time[row],
                    false => by_state[row * n + column],
                };
                assert_eq!(bits(found), bits(rate.slope), "{scene}: {row}, {column}");
            }
        }
    }
}

/// Which lanes search together depends on the width; the results do not.
#[test]
fn rows_have_the_same_bits_in_every_width() {
    for scene in SCENES {
        let engine = engine(scene);
        let info = engine.info();
        let job = |width| Job {
            settings: Settings {
                duration: info.duration,
                samples: 50,
                pace: Pace::Adaptive(Tolerances::of(1e-5)),
                locate: false,
                max_steps: 100_000,
                time_limit: None,
                energy_limit: simulate::ENERGY_LIMIT,
            },
            varied: vec![0],
            fixed: Vec::new(),
            responses: (0..info.outputs.len())
                .map(|output| Asked::of(output, Response::Peak))
                .collect(),
            estimate: false,
            wanted: f64::INFINITY,
            width,
        };
        let start = info.parameters[0].default;
        let rows: Vec<f64> = (0..11)
            .map(|row| start * (0.9 + 0.02 * f64::from(row)))
            .collect();
        let widths = [Width::One, Width::Two, Width::Four, Width::Eight];
        let done = widths
            .into_iter()
            .filter(|width| width.is_available())
            .map(|width| {
                let results = engine.rows(&job(width), &rows).unwrap();
                let steps: Vec<_> = results
                    .rows
                    .iter()
                    .map(|row| (row.steps, row.rejected))
                    .collect();
                (
                    steps,
                    results
                        .responses
                        .iter()
                        .map(|value| bits(*value))
                        .collect::<Vec<_>>(),
                )
            });
        let done: Vec<_> = done.collect();
        for other in done.iter().skip(1) {
            assert_eq!(&done[0], other, "{scene}");
        }
    }
}

#[test]
fn lanes_of_every_width() {
    for width in Width::ALL {
        for scene in SCENES {
            with_width(width, Check(scene));
        }
    }
}

/// Singles resolve times by 10⁻⁸ s at 0.1 s. Shorter steps on the way to a kink move nothing, and a run of such steps
/// would never end. With steps by tolerance a run of this scene takes some thousands.
#[test]
fn singles_do_not_creep_along_kinks() {
    let engine = engine("occupant");
    let model = engine.over::<f32>();
    let mut start = vec![0.0; model.info().state_length()];
    model.initial_state(&mut start);
    for formula in [Formula::Merson, Formula::Dopri5, Formula::Tsit5] {
        for tolerance in [1e-3, 1e-4, 1e-5] {
            let settings = RunSettings {
                every: model.info().duration,
                method: RunMethod::adaptive(formula, Tolerances::of(tolerance)),
                locate: true,
                max_steps: 100_000,
                ..RunSettings::of(model.info())
            };
            let done = simulate::run(&model, &start, &settings, None, &mut |_| {
                ControlFlow::Continue(())
            });
            // a run ends with an error if singles cannot keep the tolerance
            let enough = match &done {
                Ok(report) => report.steps + report.rejected < 50_000,
                Err(failure) => matches!(failure.reason, Reason::StepTooSmall { .. }),
            };
            assert!(enough, "{formula}, {tolerance}: {done:?}");
            assert!(
                done.is_ok() || tolerance < 1e-4,
                "{formula}, {tolerance}: {done:?}"
            );
        }
    }
}
