//! Rows of a study that are run again at smaller tolerances: of a motion that is far smaller than what tolerances let
//! pass, a ball that rests on a stiff plate and presses with its weight; and one whose better run cannot be trusted.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::batch::rows::{Asked, Job};
use bryant_runtime::batch::{self, Pace, Status};
use bryant_runtime::response::Response;
use bryant_runtime::{Tolerances, Width};

/// A ball that begins at the depth at which the plate carries it.
const BALL: &str = "model: ball
dimension: 2
parameters: { k: 1e8, mass: 1 kg }
curves: { line: { points: [[0, 0], [1, 1]], extrapolate: linear } }
systems:
  - name: ball
    elements: [{ name: body, mass: mass, cg: [0, 0], inertia: mass * 1e-6 m^2 }]
    start: { position: [0, 0.01 m - mass * (9.81 m/s^2) / (k * 1 N/m)] }
forces:
  - { field: gravity, acceleration: [0, -9.81] }
  - contact: floor
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [10 mm, 10 mm] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { curve: line, times: k }
outputs:
  - { name: force, of: contact floor, what: force }
  - { name: az, of: ball/body, what: acceleration, component: z }
run: { duration: 0.3 s, every: 1 ms }
";

const ACCURACY: f64 = 1e-3;
const G: f64 = 9.81;

fn engine(text: &str) -> Engine {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) =
        bryant_generator::read_str("scene.yaml", text, &none).unwrap_or_else(|e| panic!("{e}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// A study's row, with its responses.
fn row(engine: &Engine, [k, mass]: [f64; 2], asked: &[Asked]) -> (batch::rows::Row, Vec<f64>) {
    let settings = batch::Settings {
        duration: 0.3,
        samples: 6001,
        pace: Pace::Adaptive(Tolerances::of(1e-3 * ACCURACY)),
        locate: false,
        max_steps: 10_000_000,
        time_limit: None,
        energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
    };
    let job = Job {
        settings,
        varied: vec![0, 1],
        fixed: Vec::new(),
        responses: asked.to_vec(),
        estimate: true,
        wanted: ACCURACY,
        width: Width::widest(),
    };
    let found = engine.rows(&job, &[k, mass]).expect("registers");
    (found.rows[0], found.responses)
}

#[test]
fn a_ball_at_rest_presses_with_its_weight_whatever_else_is_asked() {
    let engine = engine(BALL);
    let peak = Asked::of(0, Response::Peak);
    let smallest = Asked::of(0, Response::Minimum);
    // its true value is 0, so that no digit of it is ever right
    let nothing = Asked::of(1, Response::Magnitude);
    for given @ [_, mass] in [[1e7, 1.0], [1e8, 1.0], [1e9, 1.0], [1e9, 10.0], [1e6, 1e-3]] {
        for asked in [
            &[peak][..],
            &[smallest],
            &[peak, nothing],
            &[smallest, nothing],
            &[nothing, smallest, peak],
        ] {
            let (row, responses) = row(&engine, given, asked);
            assert_eq!(row.status, Status::Done, "{given:?}");
            for (asked, found) in asked.iter().zip(responses) {
                if *asked == nothing {
                    continue;
                }
                let error = (found / (mass * G) - 1.0).abs();
                assert!(
                    error <= ACCURACY,
                    "{given:?} {asked:?}: {error:.1e}, {row:?}"
                );
            }
            // what has no right digit is told
            let told = row.error > ACCURACY;
            assert_eq!(told, asked.contains(&nothing), "{given:?}: {row:?}");
        }
    }
}

#[test]
fn what_rows_cannot_reach_is_told() {
    let engine = engine(BALL);
    // a mass of 1 g is 1e-11 m deep: a thousand times less than a thousandth of what the tolerances let pass
    for given @ [_, mass] in [[1e9, 1e-3], [1e10, 1e-3], [1e10, 1.0]] {
        for response in [Response::Peak, Response::Minimum] {
            let (row, responses) = row(&engine, given, &[Asked::of(0, response)]);
            let error = (responses[0] / (mass * G) - 1.0).abs();
            assert!(
                error <= ACCURACY || row.error > ACCURACY,
                "{given:?} {response:?}: {error:.1e}, {row:?}"
            );
        }
    }
}

/// A mass on a spring whose curve, softer one way than the other, goes on beyond its points: for one more width of them
/// it can be trusted.
const SPRING: &str = "model: spring
dimension: 2
parameters: { rate: 1 m/s }
systems:
  - name: cart
    reference: fixed
    elements: [{ name: body, joint: { slider: x }, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { joint_rates: { body: rate } }
forces:
  - { joint: cart/body, elastic: { points: [[-X, -FORCE], [0, 0], [X, FORCE2]], extrapolate: linear } }
outputs: [{ name: x, of: joint cart/body, what: position }]
run: { duration: 0.2 s, every: 10 ms }
";

#[test]
fn a_row_whose_better_run_cannot_be_trusted_is_doubtful() {
    let with = |x: f64| {
        let text = SPRING.replace("FORCE2", &format!("{:e}", 100.0 * x));
        let text = text.replace("FORCE", &format!("{:e}", 120.0 * x));
        engine(&text.replace('X', &format!("{x:e}")))
    };
    let row = |x: f64, rate: f64, tolerance: f64, estimate: bool| {
        let settings = batch::Settings {
            duration: 0.2,
            samples: 21,
            pace: Pace::Adaptive(Tolerances::of(tolerance)),
            locate: false,
            max_steps: 100_000,
            time_limit: None,
            energy_limit: bryant_runtime::simulate::ENERGY_LIMIT,
        };
        let job = Job {
            settings,
            varied: vec![0],
            fixed: Vec::new(),
            responses: vec![Asked::of(0, Response::Final)],
            estimate,
            // no row is as accurate
            wanted: 1e-15,
            width: Width::widest(),
        };
        let found = with(x).rows(&job, &[rate]).expect("registers");
        (found.rows[0], found.responses[0])
    };
    // the points that the ends of steps just do not leave too far
    let least = |rate: f64, tolerance: f64| {
        let [mut left, mut kept] = [1e-3, 1.0];
        for _ in 0..40 {
            let x = 0.5 * (left + kept);
            match row(x, rate, tolerance, false).0.status {
                Status::Done => kept = x,
                _ => left = x,
            }
        }
        kept
    };
    let mut tried = 0;
    for rate in [1.0, 1.3, 1.7, 2.2] {
        // a step ends nearer to the turn of the better run, but where chance has it
        let [usual, better] = [1e-6, 1e-7].map(|tolerance| least(rate, tolerance));
        if usual >= better {
            continue;
        }
        let x = 0.5 * (usual + better);
        let alone = row(x, rate, 1e-6, false);
        assert_eq!(alone.0.status, Status::Done);
        let (row, response) = row(x, rate, 1e-6, true);
        assert_eq!(row.status, Status::Doubtful, "{rate}: {row:?}");
        assert!(response.is_nan() && row.doubt.is_some(), "{row:?}");
        tried += 1;
    }
    assert!(tried > 0);
}
