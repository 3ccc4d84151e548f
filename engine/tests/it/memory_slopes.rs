//! Derivatives through the memory of laws: of what the foot of an unloading line, a locked length, webbing that is paid
//! out and the times of switches carry on from an event whose time depends on parameters. Each is compared with central
//! differences of rows, or with a closed form.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{self, Doubt, Pace, Status};
use bryant_runtime::response::Response;
use bryant_runtime::simulate::ENERGY_LIMIT;
use bryant_runtime::{Tolerances, Width};

const TOLERANCE: f64 = 1e-12;
/// The share of its value by which a parameter is changed to either side, and twice.
const MOVED: f64 = 1e-4;

/// A mass of 1 kg on a line swings about x = 0.2 m; at x = 0 it is 0.1 m deep in a plane, and stretches a belt by 0.2
/// m. Beside it, and sharing nothing with it, a mass is pushed from `when` on.
fn scene(parameters: &str, forces: &str, more: &str) -> Engine {
    let text = format!(
        "
model: memory
dimension: 2
parameters: {{ spring: 40, when: 0.2, {parameters} }}
curves:
  ramp: {{ points: [[0, 0], [0.1, 1]], extrapolate: linear }}
  bent: {{ points: [[-1, -4], [0, 0], [1, 10]], extrapolate: linear }}
systems:
  - name: s
    reference: fixed
    elements: [{{ name: b, joint: {{ slider: x }}, mass: 1, cg: [0, 0], inertia: 1 }}]
    start: {{ joints: {{ b: 0.4 }} }}
  - name: o
    reference: fixed
    elements: [{{ name: b, joint: {{ slider: x }}, mass: 1, cg: [0, 0], inertia: 1 }}]
    start: {{ joints: {{ b: 0.1 }} }}
switches:
  - {{ switch: other, when: {{ time: when }} }}
{more}forces:
  - {{ joint: s/b, neutral: 0.2, stiffness: spring }}
  - {{ joint: o/b, name: of-o, neutral: 0.2, stiffness: 30 }}
  - {{ load: on-o, on: o/b, at: [0, 0], force: [3, 0], since: other }}
{forces}outputs:
  - {{ name: q, of: joint s/b, what: position }}
  - {{ name: rate, of: joint s/b, what: rate }}
  - {{ name: apart, of: joint o/b, what: position }}
run: {{ duration: 1 s, every: 0.1 s }}
"
    );
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("memory.yaml", &text, &none)
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// The final values of q, its rate, and the position of what shares nothing with it, by so many parameters.
fn job(parameters: usize, duration: f64) -> Job {
    Job {
        settings: batch::Settings {
            duration,
            samples: 2,
            pace: Pace::Adaptive(Tolerances::of(TOLERANCE)),
            locate: true,
            max_steps: 100_000,
            time_limit: None,
            energy_limit: ENERGY_LIMIT,
        },
        varied: (0..parameters).collect(),
        fixed: Vec::new(),
        responses: (0..3).map(|i| Asked::of(i, Response::Final)).collect(),
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    }
}

/// A direction for each parameter, as long as its value.
fn directions(row: &[f64]) -> Vec<f64> {
    let count = row.len();
    let entry = |i: usize| match i / count == i % count {
        true => row[i % count],
        false => 0.0,
    };
    (0..count * count).map(entry).collect()
}

/// Compares the derivatives of all responses by all parameters, each times its value, with central differences. Returns
/// the largest slope of the first system.
fn compare(what: &str, engine: &Engine, row: &[f64], duration: f64) -> f64 {
    let job = job(row.len(), duration);
    let found = engine
        .gradients(&job, row, &directions(row))
        .expect("registers");
    let mut largest = 0.0f64;
    for parameter in 0..row.len() {
        let ended = found.rows[parameter];
        assert_eq!(
            (ended.status, ended.doubt),
            (Status::Done, None),
            "{what} to {duration}, parameter {parameter}"
        );
        let places = [-2.0, -1.0, 1.0, 2.0].map(|places| places * MOVED);
        let moved = places.map(|share| {
            let mut moved = row.to_vec();
            moved[parameter] *= 1.0 + share;
            moved
        });
        let rows = engine.rows(&job, &moved.concat()).expect("registers");
        assert!(rows.rows.iter().all(|row| row.status == Status::Done));
        let steps = rows.rows.iter().map(|row| row.steps).max().unwrap_or(0);
        for response in 0..3 {
            let at = |place: usize| rows.responses[3 * place + response];
            let wide = (at(3) - at(0)) / (4.0 * MOVED);
            let close = (at(2) - at(1)) / (2.0 * MOVED);
            let ours = found.slopes[3 * parameter + response];
            // the error of a difference is of the square of what it goes over, so three times that of the close one
            // lies between both; and each step errs by the tolerance times 1 + the rate of at most 4 1/s, in both rows
            let errs = f64::from(steps) * 5.0 * TOLERANCE;
            let allowed = (wide - close).abs() + errs / MOVED + errs;
            let apart = (ours - close).abs();
            assert!(
                apart <= allowed,
                "{what} to {duration}: {ours} for {close} of response {response} by parameter {parameter}, allowed {allowed:e}"
            );
            // what happens to one system is nothing to the other
            let (own, of_other) = (parameter != 1, response == 2);
            if own == of_other {
                assert!(
                    ours.abs() <= 1e-12,
                    "{what} to {duration}: {ours} of response {response} by parameter {parameter}"
                );
            }
            if own && !of_other {
                largest = largest.max(ours.abs());
            }
        }
    }
    largest
}

const PLANE: &str = "contact: c, ellipsoid: { on: s/b, center: [0, 0], semi_axes: [0.1, 0.1] }, \
                     plane: { on: frame, at: [0, 0], normal: [1, 0] }, elastic: { curve: ramp, times: hard }";
const BELT: &str = "belt: b, from: { on: s/b, at: [0, 0] }, to: { on: frame, at: [0.9, 0] }, length: 0.7, \
                    force: { curve: ramp, times: hard }";

/// The other system is pushed from every tenth of the time on: before, under load, on the way back.
fn at_all_times(what: &str, engine: &Engine, row: &[f64], durations: &[f64]) {
    let mut largest = 0.0f64;
    for &duration in durations {
        for tenth in [1, 3, 5, 7, 9] {
            let mut row = row.to_vec();
            // at no time of anything else
            row[1] = duration * (f64::from(tenth) + 0.123) / 10.0;
            largest = largest.max(compare(what, engine, &row, duration));
        }
    }
    // what is compared is not nothing
    assert!(largest > 1e-2, "{what}: {largest}");
}

#[test]
fn feet_of_unloading_lines_carry_derivatives_on() {
    let back = "unloading: { curve: ramp, times: soft }, unloading_slope: steep";
    let joint = "joint: s/b, name: stop, neutral: 0.15, elastic: { curve: ramp, times: hard }";
    for (what, law, steep) in [
        (
            "a set of a contact",
            format!("{PLANE}, unloading_slope: steep"),
            200.0,
        ),
        (
            "a set of a belt",
            format!("{BELT}, unloading_slope: steep"),
            60.0,
        ),
        (
            "sets of a joint",
            format!("{joint}, unloading_slope: steep"),
            200.0,
        ),
        ("unloading of a contact", format!("{PLANE}, {back}"), 200.0),
        ("unloading of a belt", format!("{BELT}, {back}"), 60.0),
        ("unloading of a joint", format!("{joint}, {back}"), 200.0),
    ] {
        let (parameters, row) = match law.contains("soft") {
            true => (
                "hard: 2.1, soft: 0.7, steep: 200",
                vec![40.0, 0.2, 2.1, 0.7, steep],
            ),
            false => ("hard: 2.1, steep: 200", vec![40.0, 0.2, 2.1, steep]),
        };
        let engine = scene(parameters, &format!("  - {{ {law} }}\n"), "");
        at_all_times(what, &engine, &row, &[0.35, 0.6, 0.95, 1.7]);
    }
}

#[test]
fn lengths_that_a_belt_remembers_carry_derivatives_on() {
    // locked when the mass comes by, a moment later
    let locks = "  - { switch: locks, when: { of: joint s/b, what: position, below: place }, after: late }\n";
    let belt = "belt: b, from: { on: s/b, at: [0, 0] }, to: { on: frame, at: [0.9, 0] }, force: { curve: ramp, times: hard }";
    let law = format!("  - {{ {belt}, retractor: {{ lock: locks, spool: 0.5 }} }}\n");
    let engine = scene("hard: 2.1, place: 0.32, late: 0.05", &law, locks);
    at_all_times(
        "a retractor",
        &engine,
        &[40.0, 0.2, 2.1, 0.32, 0.05],
        &[0.25, 0.6, 1.3],
    );
    let law = format!("  - {{ {BELT}, limiter: {{ force: most }} }}\n");
    let engine = scene("hard: 4, most: 3", &law, "");
    at_all_times(
        "a limiter",
        &engine,
        &[40.0, 0.2, 4.0, 3.0],
        &[0.35, 0.5, 0.95, 1.4],
    );
}

#[test]
fn a_law_that_begins_at_an_event_is_loaded_from_its_state_there() {
    let begins = "  - { switch: begins, when: { of: joint s/b, what: position, below: place }, after: late }\n";
    let law = format!("  - {{ {PLANE}, unloading_slope: steep, since: begins }}\n");
    let engine = scene(
        "hard: 2.1, steep: 200, place: 0.12, late: 0.05",
        &law,
        begins,
    );
    at_all_times(
        "a contact that begins",
        &engine,
        &[40.0, 0.2, 2.1, 200.0, 0.12, 0.05],
        &[0.4, 0.9, 1.6],
    );
}

/// x = 0.2 + 0.2 cos ω t passes `place` at t₁ = acos((place − 0.2)/0.2)/ω; from T = t₁ + late on F pulls, and the mass
/// swings about 0.2 + F/k more.
#[test]
fn a_latch_keeps_the_derivative_of_its_time() {
    let fires = "  - { switch: fires, when: { of: joint s/b, what: position, below: place }, after: late }\n";
    let law = "  - { load: on-s, on: s/b, at: [0, 0], force: [pull, 0], since: fires }\n";
    let engine = scene("place: 0.25, late: 0.1, pull: 5", law, fires);
    let row = [40.0, 0.05, 0.25, 0.1, 5.0];
    let (duration, w) = (0.7, 40f64.sqrt());
    let begins = ((0.25 - 0.2) / 0.2f64).acos() / w + 0.1;
    // q = … + F/k (1 − cos ω (D − T))
    let phase = w * (duration - begins);
    let by_time = -5.0 / 40.0 * w * phase.sin();
    let by_place = -1.0 / (w * (0.2f64.powi(2) - 0.05f64.powi(2)).sqrt());
    let expected = [
        (2, 0.25 * by_place * by_time),
        (3, 0.1 * by_time),
        (4, 5.0 / 40.0 * (1.0 - phase.cos())),
    ];
    let found = engine
        .gradients(&job(row.len(), duration), &row, &directions(&row))
        .expect("registers");
    for (parameter, expected) in expected {
        let ended = found.rows[parameter];
        assert_eq!(ended.status, Status::Done);
        let ours = found.slopes[3 * parameter];
        // each step errs by the tolerance, in the state and in its derivatives, and a rate by that in time
        let allowed = f64::from(ended.steps) * 5.0 * TOLERANCE;
        assert!(
            (ours - expected).abs() <= allowed,
            "{parameter}: {ours} for {expected}, allowed {allowed:e}"
        );
    }
}

/// Two kinks whose functions have other rates, and pass 0 together: their time is one.
#[test]
fn kinks_of_one_cause_are_one_event() {
    let law = |name: &str, times: &str| {
        format!(
            "  - {{ joint: s/b, name: {name}, neutral: 0.15, elastic: {{ curve: bent, times: {times} }}, unloading_slope: steep }}\n"
        )
    };
    let laws = law("one", "hard") + &law("two", "soft");
    let engine = scene("hard: 2.1, soft: 0.7, steep: 200", &laws, "");
    at_all_times(
        "two joints",
        &engine,
        &[40.0, 0.2, 2.1, 0.7, 200.0],
        &[0.35, 0.6, 0.95],
    );
}

/// A push that begins where another ends: by the time of one of them there is a slope on either side, and none is
/// given.
#[test]
fn what_is_tied_has_no_slope() {
    let late = "  - { switch: late, when: { time: 0.3 } }\n";
    let law =
        "  - { load: second, on: o/b, at: [0, 0], force: [2, 0], since: other, until: late }\n";
    let engine = scene("pull: 1", law, late);
    let slopes = |when: f64| {
        let row = [40.0, when, 1.0];
        let found = engine.gradients(&job(3, 0.5), &row, &directions(&row));
        let found = found.expect("registers");
        let row = found.rows[1];
        ((row.status, row.doubt), found.slopes[3..6].to_vec())
    };
    let (ended, found) = slopes(0.3);
    assert_eq!(ended, (Status::Doubtful, Some(Doubt::Tied)));
    assert!(found.iter().all(|slope| slope.is_nan()), "{found:?}");
    let (ended, found) = slopes(0.2);
    assert_eq!(ended, (Status::Done, None));
    assert!(found[2].abs() > 0.1, "{found:?}");
}
