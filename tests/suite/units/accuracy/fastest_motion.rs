use bryant::accuracy::fastest_motion::fastest;
use bryant::equations::Engine;
use bryant_runtime::program::Job;

/// A rod of J = 0.6 kg m² whose joint has friction of 2 N m, smooth below a rate of 0.01 rad/s: c = 200 N m s/rad at
/// rest. The spring of 60 N m/rad alone would give 10 1/s.
#[test]
fn what_makes_a_scene_stiff_is_named() {
    let text = "\
model: clock
dimension: 2
systems:
  - name: clock
    reference: fixed
    elements: [{ name: rod, mass: 2 kg, cg: [0, 0], inertia: 0.6 }]
forces: [{ joint: clock/rod, elastic: { points: [[-1, -60], [1, 60]], extrapolate: linear }, friction: 2 N*m, friction_speed: 0.01 rad/s }]
outputs: [{ name: swing, of: clock/rod, what: angle }]
run: { duration: 0.1 s, every: 10 ms }
";
    let none = |_: &std::path::Path| Err(std::io::Error::from(std::io::ErrorKind::NotFound));
    let model = bryant_generator::read_str("clock.yaml", text, &none)
        .expect("a model")
        .0;
    let engine = bryant::equations::of(&model).expect("equations");
    let found = fastest(&engine, &Job::default(), &[], 10.0).expect("a motion");
    // λ² + (c/J) λ + k/J = 0
    let (c, k) = (200.0 / 0.6, 60.0 / 0.6);
    let exact = 0.5 * (c + f64::sqrt(c * c - 4.0 * k));
    assert!((found.rate / exact - 1.0).abs() < 1e-3, "{found:?} {exact}");
    assert_eq!(found.velocity, model_velocity(&engine));
    assert!(
        found
            .effect
            .as_deref()
            .is_some_and(|e| e.contains("friction")),
        "{found:?}"
    );
}

fn model_velocity(engine: &Engine) -> &str {
    engine.info().velocities[0]
}
