//! Mirror images by symmetry: a body whose sides are images of each other, and which starts so, accelerates so.
//!
//! Nothing here knows how images are made. Polar quantities of the two sides differ in the sign of y, axial ones in those of
//! x and z, and what lies in the middle has no acceleration along y and none about x and z.

use bryant_engine::Engine;
use bryant_generator::{Config, model};
use bryant_runtime::Dynamics;

/// All laws act at the start: angles beyond stops, curves that are not odd, contacts that touch, belts that are taut.
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

#[test]
fn what_starts_as_mirror_images_accelerates_so() {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = model::read_str("twins.yaml", SCENE, &none).unwrap_or_else(|e| panic!("{e}"));
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
    // accelerations are of the order of 1e3, rounding 1e-16 of that through a factorisation of condition 1e3
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
