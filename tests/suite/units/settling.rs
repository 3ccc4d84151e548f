use bryant::settling::{End, Settled, Wanted, settle};
use bryant_generator::Config;
use bryant_runtime::Family;

/// Settles a scene; the acceleration is the largest rate of a velocity.
fn settled(text: &str) -> Settled {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.yaml");
    std::fs::write(&path, text).unwrap();
    let (scene, _) = bryant_generator::read(&path).unwrap();
    let lists = Config::new().matrices(false).lists(&scene);
    let engine = bryant_engine::Engine::new(lists).unwrap();
    let model = engine.over::<f64>();
    let info = engine.info();
    let mut start = vec![0.0; info.state_length()];
    Family::over::<f64>(&engine).initial_state(&mut start);
    let first = info.coordinates.len();
    let mut rate = vec![0.0; start.len()];
    let mut acceleration = |state: &[f64]| {
        bryant_runtime::Dynamics::derivative(&model, 0.0, state, &mut rate);
        let rates = &rate[first..first + info.velocities.len()];
        let most = rates
            .iter()
            .fold(0.0, |most: f64, rate| most.max(rate.abs()));
        (most, true)
    };
    let wanted = Wanted {
        acceleration: 1e-4,
        evaluations: 2_000_000,
    };
    settle(
        &model,
        0.0,
        &start,
        wanted,
        &mut acceleration,
        &mut |_, _| true,
    )
}

const BALL: &str = "model: ball
dimension: 2
systems:
  - name: ball
    elements: [{ name: body, mass: 5, cg: [0, 0], inertia: 0.02 }]
    start: { position: [0, 0.3] }
forces:
  - { field: earth, acceleration: [0, -9.81] }
  - contact: floor
    ellipsoid: { on: ball/body, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1] }
    elastic: { points: [[0, 0], [1, 1e5]], extrapolate: linear }
";

/// k d = m g
#[test]
fn a_ball_comes_to_rest_on_its_spring() {
    let found = settled(BALL);
    assert_eq!(found.end, End::Rest);
    let depth = 0.1 - found.state[1];
    // an acceleration of 1e-4 m/s² is 5e-4 N at 1e5 N/m
    assert!((depth - 5.0 * 9.81 / 1e5).abs() <= 5e-9, "{depth}");
}

/// The same on a moving floor, with a ball that moves along.
#[test]
fn a_ball_rests_on_a_floor_that_moves_with_it() {
    let moving = BALL
        .replace(
            "systems:",
            "vehicles: [{ name: car, velocity: [10, 0] }]\nsystems:",
        )
        .replace(
            "position: [0, 0.3]",
            "position: [0, 0.3], velocity: [10, 0]",
        )
        .replace("plane: { on: frame", "plane: { on: car");
    let found = settled(&moving);
    assert_eq!(found.end, End::Rest);
    let depth = 0.1 - found.state[1];
    assert!((depth - 5.0 * 9.81 / 1e5).abs() <= 5e-9, "{depth}");
    assert!(
        found.state[0].abs() < 1e-9 && found.state[3] == 10.0,
        "{:?}",
        found.state
    );
}

const ROD: &str = "model: rod
dimension: 2
systems:
  - name: rod
    reference: fixed
    elements: [{ name: body, mass: 2, cg: [0, -0.5], inertia: 0.1 }]
    start: { angles: { body: ANGLE } }
forces:
  - { field: earth, acceleration: [0, -9.81] }
";

/// A rod hangs after a release from any angle; a rod that stands upright does not rest.
#[test]
fn a_rod_hangs_and_does_not_stand() {
    let hangs = settled(&ROD.replace("ANGLE", "100 deg"));
    assert_eq!(hangs.end, End::Rest);
    // φ̈ = −m g l/J sin φ with J = 0.6
    assert!(
        hangs.state[0].abs() <= 1e-4 * 0.6 / (2.0 * 9.81 * 0.5) * 1.01,
        "{:?}",
        hangs.state
    );
    let stands = settled(&ROD.replace("ANGLE", "180 deg"));
    assert_eq!(stands.end, End::Unstable);
}

/// Two rods with a spiral spring in each joint, against the equations of statics, solved by Newton's method.
#[test]
fn a_chain_rests_where_statics_says() {
    let text = "model: chain
dimension: 2
systems:
  - name: arm
    reference: fixed
    elements:
      - { name: upper, mass: 2, cg: [0.3, 0], inertia: 0.1 }
      - { name: lower, on: upper, at: [0.6, 0], mass: 1, cg: [0.2, 0], inertia: 0.05 }
forces:
  - { field: earth, acceleration: [0, -9.81] }
  - { joint: arm/upper, stiffness: 30 }
  - { joint: arm/lower, stiffness: 8 }
";
    let found = settled(text);
    assert_eq!(found.end, End::Rest);
    // about +y, a positive angle lowers +x: z of a point at l along the rod is −l sin φ
    let (g, [mut a, mut b]) = (9.81, [0.0f64; 2]);
    for _ in 0..50 {
        let moments = [
            (2.0 * 0.3 + 1.0 * 0.6) * g * a.cos() - 30.0 * a + 8.0 * (b - a),
            1.0 * 0.2 * g * b.cos() - 8.0 * (b - a),
        ];
        let (aa, bb) = (-1.2 * g * a.sin() - 38.0, -0.2 * g * b.sin() - 8.0);
        let determinant = aa * bb - 64.0;
        a -= (bb * moments[0] - 8.0 * moments[1]) / determinant;
        b -= (aa * moments[1] - 8.0 * moments[0]) / determinant;
    }
    // 1e-4 rad/s² of inertias below 0.7 kg m² against stiffnesses above 8 N m
    assert!(
        (found.state[0] - a).abs() < 2e-5 && (found.state[1] - b).abs() < 2e-5,
        "{:?} {a} {b}",
        found.state
    );
}

/// Nothing carries the ball: it never rests, and the search says so.
#[test]
fn what_falls_does_not_rest() {
    let falls = settled(
        &BALL
            .replace("[0, 1] }", "[0, 1], extent: 0.2 }")
            .replace("[0, 0.3]", "[1, 0.3]"),
    );
    assert_eq!(falls.end, End::Moving);
}
