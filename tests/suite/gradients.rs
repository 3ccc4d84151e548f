//! Derivatives of responses across events: switches that parameters move, and points of curves of time that parameters
//! stretch.

use super::lanes::engine;
use bryant_runtime::batch::rows::{Asked, Gradients, Job};
use bryant_runtime::batch::{Fixed, LaneFormula, Pace, Settings, Status};
use bryant_runtime::{Response, Tolerances, Width};

const BALL: &str = "models/switches.yaml";
const LINKS: &str = "models/motions.yaml";

const TOLERANCE: f64 = 1e-9;

fn within(tolerance: f64) -> Pace {
    Pace::Adaptive(Tolerances::of(tolerance))
}

fn position<'a>(mut names: impl Iterator<Item = &'a str>, name: &str) -> usize {
    names
        .position(|known| known == name)
        .expect("one of the model's")
}

/// Responses at a row of the named parameters, and their derivatives with respect to each parameter.
fn differentiated(
    path: &str,
    duration: f64,
    pace: Pace,
    parameters: &[(&str, f64)],
    responses: &[(&str, Response)],
) -> Gradients {
    let engine = engine(path);
    let info = engine.info();
    let output = |name| position(info.outputs.iter().map(|output| output.name), name);
    let parameter = |name| position(info.parameters.iter().map(|parameter| parameter.name), name);
    let job = Job {
        settings: Settings {
            duration,
            samples: 1001,
            pace,
            locate: true,
            max_steps: 100_000,
            time_limit: None,
            energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        },
        varied: parameters.iter().map(|(name, _)| parameter(name)).collect(),
        fixed: Vec::new(),
        responses: responses
            .iter()
            .map(|(name, response)| Asked::of(output(name), *response))
            .collect(),
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    };
    let row: Vec<f64> = parameters.iter().map(|(_, value)| *value).collect();
    let count = row.len();
    let along = |i: usize| (0..count).map(move |k| f64::from(u8::from(i == k)));
    let directions: Vec<f64> = (0..count).flat_map(along).collect();
    let found = engine.gradients(&job, &row, &directions).unwrap();
    assert!(found.rows.iter().all(|row| row.status == Status::Done));
    found
}

/// The ball of `models/switches.yaml` is pushed with 3 m/s² from the ignition until it is high, where its speed is 2
/// m/s. It begins to fall at 0.68 s, and 4/6 s earlier for each second by which the upward push begins later: the push
/// takes 4 of 10 m/s² away. The motion consists of polynomials of the second degree, which the integrator follows
/// exactly.
#[test]
fn a_switched_force_is_differentiated_by_both_of_its_ends() {
    let window = 0.05;
    let responses = [
        ("ax", Response::Integral),
        ("vx", Response::Final),
        ("ax", Response::Mean),
        ("ax", Response::Peak),
        ("ax", Response::TimeOfPeak),
        ("ax", Response::Clip { duration: window }),
        ("ax", Response::Hic { window: 0.2 }),
        ("on", Response::Integral),
        ("x", Response::Final),
    ];
    let parameters = [("ignition", 0.11), ("height", 0.6), ("delay", 0.03)];
    let found = differentiated(BALL, 1.0, within(TOLERANCE), &parameters, &responses);
    // HIC of a push that is shorter than the window: its length times the 2.5th power
    let strength = (3.0_f64 / 9.806_65).powf(2.5);
    let (length, rest) = (0.09, 0.8);
    let expected = [
        (3.0 * length, [-3.0, 1.5, 0.0]),
        (1.0 + 3.0 * length, [-3.0, 1.5, 0.0]),
        (3.0 * length, [-3.0, 1.5, 0.0]),
        (3.0, [0.0, 0.0, 0.0]),
        (0.11, [1.0, 0.0, 0.0]),
        (3.0, [0.0, 0.0, 0.0]),
        (strength * length, [-strength, 0.5 * strength, 0.0]),
        (0.32, [0.0, 2.0 / 3.0 * 0.5, 2.0 / 3.0]),
        (
            1.0 + 1.5 * length * length + 3.0 * length * rest,
            [-3.0 * (length + rest), 1.5 * rest, 0.0],
        ),
    ];
    for (k, (value, slopes)) in expected.into_iter().enumerate() {
        let name = responses[k];
        // events are located to 1e-13 of a step; rates at them come from differences of 1e-4 of a step on a parabola,
        // with rounding divided by that
        let bound = 1e-9;
        let ours = found.values[k];
        assert!(
            (ours - value).abs() < bound,
            "{name:?}: {ours}, not {value}"
        );
        for (i, slope) in slopes.into_iter().enumerate() {
            let ours = found.slopes[i * responses.len() + k];
            let parameter = parameters[i].0;
            assert!(
                (ours - slope).abs() < bound,
                "{name:?} by {parameter}: {ours}, not {slope}"
            );
        }
    }
}

/// The joint of a link moves with a piecewise linear speed, so that its acceleration jumps at the points; a parameter
/// stretches the curve.
#[test]
fn points_of_curves_that_a_parameter_stretches_are_events() {
    let (duration, span) = (1.0, 1.25);
    let responses = [
        ("jolted az", Response::Integral),
        ("jolted az", Response::Peak),
        ("jolted az", Response::TimeOfMinimum),
        ("jolted z", Response::Final),
        ("jolted rate", Response::Final),
        ("jolted rate", Response::Peak),
        ("jolted rate", Response::Integral),
    ];
    let found = differentiated(
        LINKS,
        duration,
        within(TOLERANCE),
        &[("span", span)],
        &responses,
    );

    // twice the curve from 0.5 by 2 at 0.2 and −1 at 0.5 to 0.3 at 0.9, at t/span: its slopes are 7.5, −10, 3.25, and
    // at 0.8 it is −0.025
    let x = duration / span;
    let speed = |x: f64| -1.0 + 3.25 * (x - 0.5);
    let area = 0.5 * 0.2 * 2.5 + 0.5 * 0.3 * 1.0 + 0.5 * (x - 0.5) * (speed(x) - 1.0);
    let known = [
        (2.0 * (speed(x) - 0.5), -2.0 * 3.25 * x / span),
        (2.0 * 7.5 / span, -2.0 * 7.5 / (span * span)),
        (0.2 * span, 0.2),
        (2.0 * span * area, 2.0 * (area - x * speed(x))),
    ];
    for (k, (value, slope)) in known.into_iter().enumerate() {
        let [ours, rises] = [found.values[k], found.slopes[k]];
        // motions are given in closed form: rounding, and the error of an event's time divided by the step that locates
        // it
        assert!(
            (ours - value).abs() < 1e-9,
            "{:?}: {ours}, not {value}",
            responses[k]
        );
        assert!(
            (rises - slope).abs() < 1e-9,
            "{:?}: {rises}, not {slope}",
            responses[k]
        );
    }

    // the swing of the link has no closed form: differences err by the square of the step, and by 1e-13 divided by it,
    // times some hundred
    let step = 1e-5;
    let at = |by: f64| {
        differentiated(
            LINKS,
            duration,
            within(1e-13),
            &[("span", span + by)],
            &responses,
        )
    };
    let (right, left) = (at(step), at(-step));
    for (k, response) in responses.iter().enumerate().skip(known.len()) {
        let difference = (right.values[k] - left.values[k]) / (2.0 * step);
        let ours = found.slopes[k];
        assert!(
            (ours - difference).abs() < 1e-5 * difference.abs().max(0.1),
            "{response:?}: {ours}, not {difference}"
        );
        assert!(difference.abs() > 0.01, "{response:?}: {difference}");
    }
}

/// A point that a parameter stretches ends a step, and may be at the time of a sample: the end of the step moves, the
/// sample does not.
#[test]
fn samples_at_points_that_are_stretched_stay_where_they_are() {
    let responses = [0.25, 0.4, 0.625, 0.8].map(|at| ("jolted rate", Response::Value { at }));
    let parameters = [("span", 1.25)];
    let exact = differentiated(LINKS, 1.0, within(1e-12), &parameters, &responses);
    let (method, step) = (LaneFormula::Dopri5, 1e-3);
    let pace = Pace::Fixed(Fixed { method, step });
    let found = differentiated(LINKS, 1.0, pace, &parameters, &responses);
    for (k, response) in responses.iter().enumerate() {
        let (ours, expected) = (found.slopes[k], exact.slopes[k]);
        // a pendulum of 6/s: (ωh)⁵, and the error of the sharp run; the link accelerates by some rad/s², so a shift of
        // the sample by 0.2 s per unit would be visible
        let bound = 1e-8 * expected.abs().max(1.0);
        assert!(
            (ours - expected).abs() < bound,
            "{response:?}: {ours}, not {expected}"
        );
    }
}
