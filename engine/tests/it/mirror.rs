//! Mirror images by symmetry: a body whose sides are images of each other, and which starts symmetrically, accelerates
//! symmetrically.
//!
//! Nothing here knows how images are made. Polar vectors of the two sides differ in the sign of y, axial ones in the
//! signs of x and z. The parts in the middle have no acceleration along y and none about x and z.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::{Dynamics, Formula, Integrator, Settings, Tolerances, simulate};
use std::ops::ControlFlow;

/// All laws act at the start: angles are beyond stops, curves are not odd, contacts touch, belts are taut.
const SCENE: &str = "
model: twins
dimension: 3
curves:
  bent: { points: [[-1, -30], [0, 5], [0.5, 10]], extrapolate: linear }
  push: { points: [[-1, 2], [1, 5]] }
vehicles:
  - { name: car, acceleration: [3, 0, 1], start: { velocity: [2, 0, 1] } }
systems:
  - name: man
    elements:
      - { name: hip, mass: 12, cg: [0.01, 0, 0.02], inertia: [0.3, 0.1, 0.2], axes: [0, 0.4, 0] }
      - { name: left-leg, mirror: true, on: hip, at: [0.1, 0.09, -0.05], mass: 8, cg: [0.02, -0.01, -0.2], inertia: [0.1, 0.12, 0.05], axes: [0.5, 0.1, 0.3] }
      - { name: left-foot, mirror: true, on: left-leg, at: [0.01, 0.02, -0.4], mass: 1, cg: [0.1, 0.01, 0], inertia: [0.01, 0.02, 0.025], axes: [-0.2, 0.1, 0.6] }
      - { name: neck, on: hip, at: [0, 0, 0.5], mass: 3, cg: [0.02, 0, 0.2], inertia: [0.03, 0.04, 0.05] }
    start:
      velocity: [1, 0, -2]
      angles: { hip: [0, 0.1, 0], left-leg: [0.2, -0.3, 0.4], left-foot: [-0.3, 0.5, 0.6], neck: [0, -0.4, 0] }
      rates: { hip: [0, 2, 0], left-leg: [1, 2, 3], left-foot: [-4, 5, -6], neck: [0, -3, 0] }
surfaces:
  left-knee: { mirror: true, on: man/left-leg, center: [0.05, 0.01, -0.4], semi_axes: [0.06, 0.05, 0.07], axes: [0.1, 0.2, 0.3] }
  board: { on: car, at: [0.2, 0, 0], normal: [1, 0, 0.2] }
forces:
  - { field: gravity, acceleration: [0, 0, -9.81] }
  - joint: man/left-leg
    mirror: true
    about:
      x: { elastic: bent, neutral: 0.1, damping: 1, stop: { from: -0.1, to: 0.05, stiffness: 100, damping: 2 } }
      y: { elastic: bent, neutral: 0.2, friction: 3, stop: { from: -0.1, to: 0.05, stiffness: 100 } }
      z: { elastic: { curve: bent, times: 2 }, stop: { to: 0.1, stiffness: 10 } }
  - joint: man/left-foot
    mirror: true
    axis: x
    flexion: { stiffness: 10, damping: 1, stop: { to: 0.4, stiffness: 10 } }
    torsion: { elastic: bent, neutral: -0.1, stop: { to: 0.1, stiffness: 10 } }
  - { joint: man/left-foot, name: twist, mirror: true, axis: y, torsion: { elastic: bent, damping: 2 } }
  - { contact: left-knee, mirror: true, ellipsoid: left-knee, plane: board, stiffness: 5e4, friction: 0.3, damping: 50 }
  - { contact: shin, ellipsoid: left-knee, with: right-knee, stiffness: 1e4 }
  - { contact: left-toe, mirror: true, ellipsoid: { on: man/left-foot, center: [0.2, 0.01, 0], semi_axes: [0.03, 0.04, 0.05] }, plane: { on: man/hip, at: [0, 0.1, -0.3], normal: [0.3, 0.2, 1] }, stiffness: 5e4, friction: 1 }
  - { belt: strap-left, mirror: true, from: { on: man/left-leg, at: [0, 0.05, -0.1] }, to: { on: car, at: [-0.3, 0.2, 0] }, stiffness: 5e4, length: 0.1 }
  - { spring: left, mirror: true, from: { on: man/left-foot, at: [0, 0.05, 0] }, to: { on: man/hip, at: [0.2, 0.1, 0] }, stiffness: 100, length: 0.1, damping: 3 }
  - { load: left-push, mirror: true, on: man/left-foot, at: [0.1, 0.02, 0], force: [push, { curve: push, times: 2 }, 3], moment: [push, 2, { points: [[-1, 2], [1, 1]] }] }
outputs:
  - { name: left foot, mirror: true, of: man/left-foot, what: acceleration, at: [0.1, 0.02, 0], component: [x, y, z] }
  - { name: left leg, mirror: true, of: man/left-leg, what: acceleration, component: [x, y, z] }
  - { name: left hip joint, mirror: true, of: joint man/left-leg, what: force, component: [x, y, z] }
  - { name: left knee, mirror: true, of: contact left-knee, what: force, component: [x, y, z] }
  - { name: left toe, mirror: true, of: contact left-toe, what: force, component: [x, y, z] }
  - { name: left strap, mirror: true, of: belt strap-left, what: force, component: [x, y, z] }
  - { name: left spring, mirror: true, of: spring left, what: force, component: [x, y, z] }
  - { name: left turning, mirror: true, of: man/left-foot, what: angular_acceleration, component: [x, y, z] }
  - { name: left moment, mirror: true, of: joint man/left-foot, what: moment, component: [x, y, z] }
  - { name: neck, of: man/neck, what: acceleration, component: [x, y, z] }
  - { name: nod, of: man/neck, what: angular_acceleration, component: [x, y, z] }
";

/// Joints of every kind with coordinates of their own, which mirror images have, too: a joint of one side with all
/// freedoms of a kind, lists, short forms, followers, vectors, tensors.
const MECHANISM: &str = "
model: mechanism
dimension: 3
parameters: { lean: 0.3 }
curves:
  bent: { points: [[-1, -30], [0, 5], [0.5, 10]], extrapolate: linear }
  foam: { points: [[-1, -30], [0, 0], [0.5, 10]], extrapolate: linear }
  push: { points: [[-1, 2], [1, 5]] }
systems:
  - name: man
    reference: fixed
    elements:
      - { name: hip, joint: [{ slider: x }, { slider: z }, { hinge: y }], mass: 12, cg: [0.01, 0, 0.02], inertia: [0.3, 0.15, 0.2, 0, 0.01, 0] }
      - { name: left-leg, mirror: true, on: hip, at: [0.1, 0.09, -0.05], joint: [{ hinge: z, name: yaw }, { slider: [0.1, lean, -1], name: out }, { hinge: [1, -0.5, 0.2], zero: 0.2, name: roll }], mass: 8, cg: [0.02, -0.01, -0.2], inertia: [0.1, 0.12, 0.05, 0.01, -0.02, 0.005] }
      - { name: left-foot, mirror: true, on: left-leg, at: [0.01, 0.02, -0.4], joint: { screw: [0.2, 1, lean], pitch: 0.3 }, mass: 1, cg: [0.1, 0.01, 0], inertia: [0.01, 0.02, 0.025], axes: [-0.2, 0.1, 0.6] }
      - { name: left-toe, mirror: true, on: left-foot, at: [0.1, 0.02, 0], joint: { universal: [y, -x] }, mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002] }
      - { name: left-rod, mirror: true, on: left-foot, at: [0, 0.02, 0.1], joint: { cylinder: z }, mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002] }
      - { name: left-plate, mirror: true, on: left-rod, at: [0.1, 0.02, 0], joint: { planar: x }, mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002] }
      - { name: left-box, mirror: true, on: left-plate, at: [0.1, 0.02, 0], joint: translation, mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002] }
      - { name: left-bird, mirror: true, on: left-box, at: [0.1, 0.02, 0], joint: free, mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002] }
      - { name: left-gear, mirror: true, on: left-leg, at: [0, 0, -0.1], joint: { hinge: [1, 1, 0], armature: 0.01, follows: { joint: left-foot, ratio: -0.7, offset: 0.1 } }, mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002] }
      - { name: left-ball, mirror: true, on: left-gear, at: [0, 0.1, -0.1], mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002, 0.0001, 0.0002, -0.0003] }
      - { name: left-tip, mirror: true, on: left-ball, at: [0, 0.1, -0.1], joint: weld, mass: 0.3, cg: [0.05, 0.01, 0], inertia: [0.001, 0.002, 0.002] }
    start:
      joints: { hip: [0.1, 0.2, 0.3], left-leg: [0.2, 0.03, 0.4], left-foot: 0.7, left-toe: [0.3, -0.5], left-rod: [0.02, 1], left-plate: [0.01, -0.02, 0.4], left-box: [0.01, 0.02, 0.03], left-bird: [0.1, 0.2, -0.1, 0.4, -0.6, 0.5] }
      joint_rates: { hip: [1, 2, -3], left-leg: [3, -0.5, 2], left-foot: 5, left-toe: [-2, 3], left-rod: [0.3, 4], left-plate: [0.4, -0.6, 3], left-box: [0.5, 0.7, -0.3], left-bird: [0.5, 0.7, -0.3, 2, -3, 4] }
      angles: { left-ball: [0.2, -0.3, 0.4] }
      rates: { left-ball: [1, 2, 3] }
forces:
  - { field: gravity, acceleration: [0, 0, -9.81] }
  - { joint: man/left-leg, freedom: yaw, mirror: true, elastic: bent, neutral: 0.1, damping: 1, friction: 0.3, stop: { from: -0.1, to: 0.05, stiffness: 100, damping: 2 } }
  - { joint: man/left-leg, freedom: roll, name: roll, mirror: true, elastic: foam, unloading_slope: 200, motor: push, drive: { to: push, stiffness: 3, damping: 1 } }
  - { joint: man/left-foot, mirror: true, stiffness: 3, friction: 0.3, friction_displacement: 0.1, motor: { curve: push, times: -2 } }
  - { joint: man/left-ball, mirror: true, about: { x: { motor: push, drive: { to: push, stiffness: 0.3 } }, y: { motor: 0.2 }, z: { elastic: foam, unloading: { points: [[-1, -3], [0, 0], [1, 4]], extrapolate: linear }, drive: { to: { curve: push, times: 0.1 }, stiffness: 0.2 } } } }
outputs:
  - { name: left foot, mirror: true, of: man/left-foot, what: acceleration, at: [0.1, 0.02, 0], component: [x, y, z] }
  - { name: left leg, mirror: true, of: man/left-leg, what: acceleration, component: [x, y, z] }
  - { name: left toe, mirror: true, of: man/left-toe, what: acceleration, component: [x, y, z] }
  - { name: left plate, mirror: true, of: man/left-plate, what: acceleration, component: [x, y, z] }
  - { name: left bird, mirror: true, of: man/left-bird, what: acceleration, at: [0.2, 0.1, -0.1], component: [x, y, z] }
  - { name: left gear, mirror: true, of: man/left-gear, what: angular_acceleration, component: [x, y, z] }
  - { name: left tip, mirror: true, of: man/left-tip, what: angular_acceleration, component: [x, y, z] }
  - { name: left force, mirror: true, of: joint man/left-leg, what: force, component: [x, y, z] }
  - { name: left moment, mirror: true, of: joint man/left-foot, what: moment, component: [x, y, z] }
  - { name: left yaw, mirror: true, of: joint man/left-leg, freedom: yaw, what: acceleration }
  - { name: left screwing, mirror: true, of: joint man/left-foot, what: acceleration }
  - { name: hip, of: man/hip, what: acceleration, component: [x, y, z] }
";

#[test]
fn mechanisms_whose_sides_are_mirror_images_move_so() {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("mechanism.yaml", MECHANISM, &none)
        .unwrap_or_else(|e| panic!("{e}"));
    let engine = Engine::new(Config::new().lists(&model)).expect("an engine");
    let machine = engine.over::<f64>();
    let mut y = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut y);
    let settings = Settings {
        method: Integrator::adaptive(Formula::Dopri5, Tolerances::of(1e-11)),
        duration: 0.05,
        every: 0.05,
        ..Settings::of(machine.info())
    };
    let mut samples = Vec::new();
    let report = simulate::run(&machine, &y, &settings, None, &mut |sample| {
        samples.push(sample.outputs.to_vec());
        ControlFlow::Continue(())
    });
    let steps = report.unwrap_or_else(|failure| panic!("{failure}")).steps as f64;
    // at the start, rounding in a factorisation; later the tolerance of every step, times accelerations per
    // displacement of 1e6
    for (values, relative) in samples.iter().zip([1e-9, steps * 1e-11 * 1e3]) {
        let named = |name: String| {
            let found = machine.info().outputs.iter().position(|o| o.name == name);
            values[found.unwrap_or_else(|| panic!("{name}"))]
        };
        let of = |name: &str| ["x", "y", "z"].map(|axis| named(format!("{name} {axis}")));
        let tolerance =
            |v: [f64; 3]| relative * (1.0 + v.iter().fold(0.0f64, |m, x| m.max(x.abs())));
        for (name, polar) in [
            ("foot", true),
            ("leg", true),
            ("toe", true),
            ("plate", true),
            ("bird", true),
            ("gear", false),
            ("tip", false),
            ("force", true),
            ("moment", false),
        ] {
            let signs = match polar {
                true => [1.0, -1.0, 1.0],
                false => [-1.0, 1.0, -1.0],
            };
            let (left, right) = (of(&format!("left {name}")), of(&format!("right {name}")));
            assert!(left.iter().all(|v| v.abs() > 1e-3), "{name}: {left:?}");
            for i in 0..3 {
                let apart = (left[i] - signs[i] * right[i]).abs();
                assert!(apart <= tolerance(left), "{name}: {left:?} {right:?}");
            }
        }
        for name in ["yaw", "screwing"] {
            let [left, right] = ["left", "right"].map(|side| named(format!("{side} {name}")));
            assert!(
                (left - right).abs() <= relative * (1.0 + left.abs()),
                "{name}"
            );
        }
        let hip = of("hip");
        assert!(hip[1].abs() <= tolerance(hip), "{hip:?}");
    }
}

#[test]
fn what_starts_as_mirror_images_accelerates_so() {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) =
        bryant_generator::read_str("twins.yaml", SCENE, &none).unwrap_or_else(|e| panic!("{e}"));
    let engine = Engine::new(Config::new().lists(&model)).expect("an engine");
    let machine = engine.over::<f64>();
    let mut y = vec![0.0; machine.info().state_length()];
    machine.initial_state(&mut y);
    let mut values = vec![0.0; machine.info().outputs.len()];
    machine.outputs(0.0, &y, &mut values);
    let of = |name: &str| -> [f64; 3] {
        ["x", "y", "z"].map(|axis| {
            let name = format!("{name} {axis}");
            let found = machine.info().outputs.iter().position(|o| o.name == name);
            values[found.unwrap_or_else(|| panic!("{name}"))]
        })
    };
    // accelerations are about 1e3; their rounding is 1e-16 of that, through a factorisation of condition 1e3
    let tolerance = |v: [f64; 3]| 1e-9 * (1.0 + v.iter().fold(0.0f64, |m, x| m.max(x.abs())));
    for (name, signs) in [
        ("foot", [1.0, -1.0, 1.0]),
        ("leg", [1.0, -1.0, 1.0]),
        ("hip joint", [1.0, -1.0, 1.0]),
        ("knee", [1.0, -1.0, 1.0]),
        ("toe", [1.0, -1.0, 1.0]),
        ("strap", [1.0, -1.0, 1.0]),
        ("spring", [1.0, -1.0, 1.0]),
        ("turning", [-1.0, 1.0, -1.0]),
        ("moment", [-1.0, 1.0, -1.0]),
    ] {
        let (left, right) = (of(&format!("left {name}")), of(&format!("right {name}")));
        assert!(left.iter().all(|v| v.abs() > 1e-3), "{name}: {left:?}");
        for i in 0..3 {
            let apart = (left[i] - signs[i] * right[i]).abs();
            assert!(apart <= tolerance(left), "{name}: {left:?} {right:?}");
        }
    }
    let (neck, nod) = (of("neck"), of("nod"));
    assert!(neck[1].abs() <= tolerance(neck), "{neck:?}");
    assert!(nod[0].abs().max(nod[2].abs()) <= tolerance(nod), "{nod:?}");
}
