//! Laws with hysteresis that wait for a switch: what happens before it leaves no trace in them.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::{Dynamics, Formula, Integrator, Settings, Tolerances, simulate};
use std::ops::ControlFlow;

const TOLERANCE: f64 = 1e-10;

/// A mass on a spring swings about x = 0.2 m with the amplitude 0.2 m and the period 1 s. At x = 0 it is 0.1 m deep in
/// the plane, and stretches the belt by 0.2 m.
fn scene(law: &str, since: &str) -> Engine {
    let text = format!(
        "
model: waiting
dimension: 2
systems:
  - name: s
    reference: fixed
    elements: [{{ name: b, joint: {{ slider: x }}, mass: 1, cg: [0, 0], inertia: 1 }}]
    start: {{ joints: {{ b: 0.4 }} }}
forces:
  - {{ joint: s/b, neutral: 0.2, stiffness: {} }}
  - {{ {law}{since} }}
switches: [{{ switch: over, when: {{ time: 1 }} }}]
outputs:
  - {{ name: q, of: joint s/b, what: position }}
  - {{ name: rate, of: joint s/b, what: rate }}
run: {{ duration: 2 s, every: 0.05 s }}
",
        (2.0 * std::f64::consts::PI).powi(2)
    );
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("waiting.yaml", &text, &none)
        .unwrap_or_else(|e| panic!("{e}\n{text}"));
    Engine::new(Config::new().lists(&model)).expect("no functions")
}

/// q and q̇ at samples every 0.05 s.
fn run(engine: &Engine, duration: f64) -> Vec<[f64; 2]> {
    let machine = engine.over::<f64>();
    let settings = Settings {
        method: Integrator::adaptive(Formula::Dopri5, Tolerances::of(TOLERANCE)),
        duration,
        every: 0.05,
        locate: true,
        ..Settings::of(machine.info())
    };
    let mut state = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut state);
    let mut samples = Vec::new();
    simulate::run(&machine, &state, &settings, None, &mut |sample| {
        samples.push([sample.outputs[0], sample.outputs[1]]);
        ControlFlow::Continue(())
    })
    .unwrap_or_else(|failure| panic!("{failure}"));
    samples
}

/// After a whole period in which the law waits, the motion is that of a law that acts from the start.
#[test]
fn what_happens_before_the_switch_leaves_no_set() {
    let plane = "contact: c, ellipsoid: { on: s/b, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0, 0], normal: [1, 0] }, \
                 elastic: { points: [[0, 0], [0.1, 2]], extrapolate: linear }, ";
    let belt = "belt: b, from: { on: s/b, at: [0, 0] }, to: { on: frame, at: [0.9, 0] }, length: 0.7, \
                force: { points: [[0, 0], [0.3, 2]], extrapolate: linear }, ";
    let back =
        "unloading: { points: [[0, 0], [0.4, 1]], extrapolate: linear }, unloading_slope: 200";
    for law in [
        format!("{plane}unloading_slope: 200"),
        format!("{belt}unloading_slope: 60"),
        format!("{plane}{back}"),
        format!("{belt}{back}"),
    ] {
        let waits = run(&scene(&law, ", since: over"), 2.0);
        let acts = run(&scene(&law, ""), 1.0);
        let free = run(&scene(&law, ", until: over"), 1.0);
        let (mut apart, mut felt) = (0.0f64, 0.0f64);
        for (i, at) in acts.iter().enumerate() {
            for k in 0..2 {
                apart = apart.max((waits[20 + i][k] - at[k]).abs());
                felt = felt.max((free[i][k] - at[k]).abs());
            }
        }
        // the same equations but for a selection, which changes the order of operations: roundings of some hundred
        // steps
        assert!(felt < 1e-10, "{law}: the same before it ends, {felt}");
        let unloaded = 0.4 - acts[20][0];
        assert!(unloaded > 1e-3, "{law}: what it takes is felt, {unloaded}");
        // steps of the two runs differ: a hundred steps of the tolerance each, over some units of rate
        assert!(apart < 1e-6, "{law}: {apart}");
    }
}
