//! Short forms: lists, mirror images, named surfaces and groups, instances. Their generated text equals byte for byte
//! that of the long form, whether the program writes the long form (`check --long`) or a person.

use bryant_generator::dynamics::derive;
use bryant_generator::equations::Equations;
use bryant_generator::model::{Model, Number};
use bryant_generator::program::Options;
use bryant_generator::read_str;
use bryant_generator::target::rust;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;

/// The files that a model includes.
type Files<'f> = BTreeMap<&'f str, &'f str>;

fn read(text: &str, files: &Files<'_>) -> Result<(Model, String), String> {
    let loader = |path: &Path| match files.get(path.to_str().unwrap()) {
        Some(text) => Ok((*text).to_owned()),
        None => Err(io::ErrorKind::NotFound.into()),
    };
    let scene = bryant_generator::read_annotated_str("model.yaml", text, &loader)
        .map_err(|e| e.to_string())?;
    let (model, _) = read_str("model.yaml", text, &loader).map_err(|e| e.to_string())?;
    Ok((model, scene.long_form))
}

/// The generated text of a model, without the digest of its files.
fn generated(model: &Model) -> String {
    let mut model = model.clone();
    model.digest = String::new();
    let equations: Equations = derive(&model);
    rust::module(&model, &equations, &Options::default())
}

/// The generated text of a short form; it must equal that of its long form.
fn of_short(text: &str, files: &Files<'_>) -> String {
    let (model, long) = read(text, files).unwrap_or_else(|e| panic!("{e}"));
    let short = generated(&model);
    let (again, longer) = read(&long, &Files::new()).unwrap_or_else(|e| panic!("{e}\n{long}"));
    assert_eq!(long, longer, "the long form of a long form");
    assert!(short == generated(&again), "{long}");
    short
}

/// Checks that both give the same text.
fn same(short: &str, long: &str) {
    let written = generated(
        &read(long, &Files::new())
            .unwrap_or_else(|e| panic!("{e}"))
            .0,
    );
    let made = of_short(short, &Files::new());
    let line = made.lines().zip(written.lines()).find(|(a, b)| a != b);
    assert!(made == written, "{line:?}");
}

/// The problems of a model.
fn problems(text: &str, files: &Files<'_>) -> String {
    read(text, files)
        .err()
        .unwrap_or_else(|| panic!("accepted:\n{text}"))
}

#[test]
fn scenes_of_real_size_have_a_long_form() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/scenes");
    for (name, contacts) in [("pedestrian", 20), ("occupant", 12)] {
        let text = std::fs::read_to_string(directory.join(format!("{name}.yaml"))).unwrap();
        let made = of_short(&text, &Files::new());
        let long = read(&text, &Files::new()).unwrap().1;
        assert_eq!(
            long.matches("- contact:").count() + long.matches("{ contact:").count(),
            contacts
        );
        for word in ["mirror", "surfaces:\n  groups"] {
            assert!(!long.contains(word), "{word}: {long}");
        }
        assert!(made.contains("pub fn"));
    }
}

const LEGS: &str = "
model: legs
dimension: 3
parameters: { width: 90 mm, lean: 10 deg, foam: 2 }
curves:
  odd: { points: [[-30 deg, -60], [0, 0], [30 deg, 60]], extrapolate: linear }
  bent: { points: [[-0.2, -30], [0, 0], [0.5, 10]], extrapolate: linear }
  push: { points: [[0, 0], [1, 5]] }
";

/// All items that a mirror affects, written once.
const MIRRORED: &str = "
systems:
  - name: man
    elements:
      - { name: hip, mass: 12, cg: [0.01, 0.02, 0], inertia: [0.1, 0.1, 0.1] }
      - { name: left-leg, mirror: true, on: hip, at: [0.1, width, -0.05], mass: 8, cg: [0.02, -0.01, -0.2], inertia: [0.1, 0.12, 0.02], axes: [5 deg, 0.1, 3 deg] }
      - { name: left-foot, mirror: true, on: left-leg, at: [0, 0, -0.4], mass: 1, cg: [0.1, 0.01 - width / 10, 0], inertia: [0.001, 0.002, 0.002] }
    start:
      angles: { hip: [0, 0.1, 0], left-leg: [2 deg, -0.3, lean], left-foot: [0, 0, 1 deg] }
      rates: { left-leg: [1, 2, 3 rad/s] }
surfaces:
  left-knee: { mirror: true, on: man/left-leg, center: [0.05, 0.01, -0.4], semi_axes: [0.06, 0.05, 0.07], axes: [0.1, 0.2, 0.3] }
  board: { on: frame, at: [0.6, 0.2, 0], normal: [-1, 0.1, 0], along: [0, 1, 0], extent: [0.3, 0.2] }
forces:
  - joint: man/left-leg
    mirror: true
    about:
      x: { elastic: bent, neutral: 3 deg, damping: 1, stop: { from: -20 deg, to: 0.5, stiffness: 100 } }
      y: { elastic: bent, neutral: 4 deg, stop: { from: -20 deg, to: 0.5, stiffness: 100 } }
      z: { elastic: { curve: bent, times: foam }, stop: { to: lean, stiffness: 10 } }
  - joint: man/left-foot
    mirror: true
    axis: x
    flexion: { stiffness: 10, stop: { to: 0.4, stiffness: 10 } }
    torsion: { elastic: { points: [[0, 0], [1, 3]], extrapolate: linear }, neutral: -0.1 }
  - { contact: left-knee, mirror: true, ellipsoid: left-knee, plane: board, stiffness: 5e4 }
  - { contact: left-toe, mirror: true, ellipsoid: { on: man/left-foot, center: [0.2, 0.01, 0], semi_axes: [0.03, 0.03, 0.03] }, plane: { on: man/hip, at: [0, 0.1, 0.5], normal: [0, 0.2, -1] }, stiffness: 5e4 }
  - { belt: strap-left, mirror: true, from: { on: man/left-leg, at: [0, 0.05, -0.1] }, to: { on: frame, at: [-0.3, 0.2, 0] }, stiffness: 5e4 }
  - { spring: left, mirror: true, from: { on: man/left-foot, at: [0, 0.05, 0] }, to: { on: man/hip, at: [0.2, 0.1, 0] }, stiffness: 100 }
  - bushing: left
    mirror: true
    from: { on: man/hip, at: [0, 0.1, 0], axes: [0.1, 0.2, 0.3] }
    to: { on: man/left-leg, at: [0.1, 0.02, 0.1] }
    along: { x: { elastic: bent }, y: { elastic: bent, damping: 3 }, z: { stiffness: 10 } }
    about: { x: { elastic: bent }, y: { elastic: bent, damping: 3 }, z: { stiffness: 10 } }
  - { load: left-push, mirror: true, on: man/left-foot, at: [0.1, 0.02, 0], force: [push, { curve: push, times: foam }, 3], moment: [push, 2, { points: [[0, 0], [1, 1]] }] }
outputs:
  - { name: left knee, mirror: true, of: contact left-knee, what: force, component: y, axes: man/left-leg }
  - { name: Left foot, mirror: true, of: man/left-foot, what: position, at: [0.1, 0.02, 0], relative_to: man/left-leg }
  - { name: torque left, mirror: true, of: joint man/left-leg, what: torque, about: x }
  - { name: strap of the left side, mirror: true, of: belt strap-left, what: force }
";

/// The same by hand.
const BOTH_SIDES: &str = "
systems:
  - name: man
    elements:
      - { name: hip, mass: 12, cg: [0.01, 0.02, 0], inertia: [0.1, 0.1, 0.1] }
      - { name: left-leg, on: hip, at: [0.1, width, -0.05], mass: 8, cg: [0.02, -0.01, -0.2], inertia: [0.1, 0.12, 0.02], axes: [5 deg, 0.1, 3 deg] }
      - { name: right-leg, on: hip, at: [0.1, -width, -0.05], mass: 8, cg: [0.02, 0.01, -0.2], inertia: [0.1, 0.12, 0.02], axes: [-5 deg, 0.1, -3 deg] }
      - { name: left-foot, on: left-leg, at: [0, 0, -0.4], mass: 1, cg: [0.1, 0.01 - width / 10, 0], inertia: [0.001, 0.002, 0.002] }
      - { name: right-foot, on: right-leg, at: [0, 0, -0.4], mass: 1, cg: [0.1, -(0.01 - width / 10), 0], inertia: [0.001, 0.002, 0.002] }
    start:
      angles: { hip: [0, 0.1, 0], left-leg: [2 deg, -0.3, lean], right-leg: [-2 deg, -0.3, -lean], left-foot: [0, 0, 1 deg], right-foot: [0, 0, -1 deg] }
      rates: { left-leg: [1, 2, 3 rad/s], right-leg: [-1, 2, -3] }
forces:
  - joint: man/left-leg
    about:
      x: { elastic: bent, neutral: 3 deg, damping: 1, stop: { from: -20 deg, to: 0.5, stiffness: 100 } }
      y: { elastic: bent, neutral: 4 deg, stop: { from: -20 deg, to: 0.5, stiffness: 100 } }
      z: { elastic: { curve: bent, times: foam }, stop: { to: lean, stiffness: 10 } }
  - joint: man/right-leg
    about:
      x: { elastic: { points: [[-0.5, -10], [0, 0], [0.2, 30]], extrapolate: linear }, neutral: -3 deg, damping: 1, stop: { from: -0.5, to: 20 deg, stiffness: 100 } }
      y: { elastic: bent, neutral: 4 deg, stop: { from: -20 deg, to: 0.5, stiffness: 100 } }
      z: { elastic: { curve: { points: [[-0.5, -10], [0, 0], [0.2, 30]], extrapolate: linear }, times: foam }, stop: { from: -lean, stiffness: 10 } }
  - joint: man/left-foot
    axis: x
    flexion: { stiffness: 10, stop: { to: 0.4, stiffness: 10 } }
    torsion: { elastic: { points: [[0, 0], [1, 3]], extrapolate: linear }, neutral: -0.1 }
  - joint: man/right-foot
    axis: x
    flexion: { stiffness: 10, stop: { to: 0.4, stiffness: 10 } }
    torsion: { elastic: { points: [[-1, -3], [0, 0]], extrapolate: linear }, neutral: 0.1 }
  - contact: left-knee
    ellipsoid: { on: man/left-leg, center: [0.05, 0.01, -0.4], semi_axes: [0.06, 0.05, 0.07], axes: [0.1, 0.2, 0.3] }
    plane: { on: frame, at: [0.6, 0.2, 0], normal: [-1, 0.1, 0], along: [0, 1, 0], extent: [0.3, 0.2] }
    stiffness: 5e4
  - contact: right-knee
    ellipsoid: { on: man/right-leg, center: [0.05, -0.01, -0.4], semi_axes: [0.06, 0.05, 0.07], axes: [-0.1, 0.2, -0.3] }
    plane: { on: frame, at: [0.6, 0.2, 0], normal: [-1, 0.1, 0], along: [0, 1, 0], extent: [0.3, 0.2] }
    stiffness: 5e4
  - { contact: left-toe, ellipsoid: { on: man/left-foot, center: [0.2, 0.01, 0], semi_axes: [0.03, 0.03, 0.03] }, plane: { on: man/hip, at: [0, 0.1, 0.5], normal: [0, 0.2, -1] }, stiffness: 5e4 }
  - { contact: right-toe, ellipsoid: { on: man/right-foot, center: [0.2, -0.01, 0], semi_axes: [0.03, 0.03, 0.03] }, plane: { on: man/hip, at: [0, -0.1, 0.5], normal: [0, -0.2, -1] }, stiffness: 5e4 }
  - { belt: strap-left, from: { on: man/left-leg, at: [0, 0.05, -0.1] }, to: { on: frame, at: [-0.3, 0.2, 0] }, stiffness: 5e4 }
  - { belt: strap-right, from: { on: man/right-leg, at: [0, -0.05, -0.1] }, to: { on: frame, at: [-0.3, -0.2, 0] }, stiffness: 5e4 }
  - { spring: left, from: { on: man/left-foot, at: [0, 0.05, 0] }, to: { on: man/hip, at: [0.2, 0.1, 0] }, stiffness: 100 }
  - { spring: right, from: { on: man/right-foot, at: [0, -0.05, 0] }, to: { on: man/hip, at: [0.2, -0.1, 0] }, stiffness: 100 }
  - bushing: left
    from: { on: man/hip, at: [0, 0.1, 0], axes: [0.1, 0.2, 0.3] }
    to: { on: man/left-leg, at: [0.1, 0.02, 0.1] }
    along: { x: { elastic: bent }, y: { elastic: bent, damping: 3 }, z: { stiffness: 10 } }
    about: { x: { elastic: bent }, y: { elastic: bent, damping: 3 }, z: { stiffness: 10 } }
  - bushing: right
    from: { on: man/hip, at: [0, -0.1, 0], axes: [-0.1, 0.2, -0.3] }
    to: { on: man/right-leg, at: [0.1, -0.02, 0.1] }
    along: { x: { elastic: bent }, y: { elastic: { points: [[-0.5, -10], [0, 0], [0.2, 30]], extrapolate: linear }, damping: 3 }, z: { stiffness: 10 } }
    about: { x: { elastic: { points: [[-0.5, -10], [0, 0], [0.2, 30]], extrapolate: linear } }, y: { elastic: bent, damping: 3 }, z: { stiffness: 10 } }
  - { load: left-push, on: man/left-foot, at: [0.1, 0.02, 0], force: [push, { curve: push, times: foam }, 3], moment: [push, 2, { points: [[0, 0], [1, 1]] }] }
  - { load: right-push, on: man/right-foot, at: [0.1, -0.02, 0], force: [push, { curve: push, times: -foam }, 3], moment: [{ curve: push, times: -1 }, 2, { curve: { points: [[0, 0], [1, 1]] }, times: -1 }] }
outputs:
  - { name: left knee, of: contact left-knee, what: force, component: y, axes: man/left-leg }
  - { name: right knee, of: contact right-knee, what: force, component: y, axes: man/right-leg }
  - { name: Left foot, of: man/left-foot, what: position, at: [0.1, 0.02, 0], relative_to: man/left-leg }
  - { name: Right foot, of: man/right-foot, what: position, at: [0.1, -0.02, 0], relative_to: man/right-leg }
  - { name: torque left, of: joint man/left-leg, what: torque, about: x }
  - { name: torque right, of: joint man/right-leg, what: torque, about: x }
  - { name: strap of the left side, of: belt strap-left, what: force }
  - { name: strap of the right side, of: belt strap-right, what: force }
";

/// Joints with axes: sliders are polar, hinges axial, a screw gets the other hand, and a follower follows the image of
/// its leader.
// Long: each model twice, in short and in full, in space and in the plane.
#[test]
fn joints_with_axes_have_mirror_images() {
    let element = |name: &str, on: &str, y: &str, joint: &str, inertia: &str, mirror: &str| {
        format!(
            "      - {{ name: {name}, {mirror}on: {on}, at: [0.1, {y}, 0], joint: {joint}, mass: 1, cg: [0.1, 0, 0], inertia: {inertia} }}\n"
        )
    };
    let plain = "[0.1, 0.1, 0.1]";
    let joints = [
        ("{ hinge: x }", "{ hinge: -x }"),
        (
            "{ slider: -y, name: out, zero: 0.1 }",
            "{ slider: y, name: out, zero: 0.1 }",
        ),
        (
            "{ screw: [1, -2, lean], pitch: 5 mm, armature: 0.1 }",
            "{ screw: [-1, -2, -lean], pitch: -5 mm, armature: 0.1 }",
        ),
        ("{ universal: [x, y] }", "[{ hinge: -x }, { hinge: y }]"),
        ("{ cylinder: z }", "[{ slider: z }, { hinge: -z }]"),
        (
            "{ planar: x }",
            "[{ slider: -y }, { slider: z }, { hinge: -x }]",
        ),
        (
            "translation",
            "[{ slider: x }, { slider: -y }, { slider: z }]",
        ),
        (
            "[{ hinge: z, name: yaw }, { slider: [0, 1, 0], name: out }]",
            "[{ hinge: -z, name: yaw }, { slider: [0, -1, 0], name: out }]",
        ),
        (
            "free",
            "[{ slider: x }, { slider: -y }, { slider: z }, { hinge: -x }, { hinge: y }, { hinge: -z }]",
        ),
        ("weld", "weld"),
    ];
    let (mut short, mut long) = (String::new(), String::new());
    for (i, (left, right)) in joints.into_iter().enumerate() {
        let (name, image) = (format!("left-{i}"), format!("right-{i}"));
        short += &element(&name, "hip", "0.2", left, plain, "mirror: true, ");
        long += &element(&name, "hip", "0.2", left, plain, "");
        long += &element(&image, "hip", "-0.2", right, plain, "");
    }
    let follows = |leader: &str, axis: &str| {
        format!("{{ hinge: {axis}, follows: {{ joint: {leader}, ratio: -2 }} }}")
    };
    let tensor = "[0.1, 0.1, 0.1, 0.01, 0.02, -0.03]";
    let (left, right) = (follows("left-0", "y"), follows("right-0", "y"));
    short += &element("left-gear", "left-1", "0", &left, tensor, "mirror: true, ");
    long += &element("left-gear", "left-1", "0", &left, tensor, "");
    long += &element(
        "right-gear",
        "right-1",
        "0",
        &right,
        "[0.1, 0.1, 0.1, -0.01, 0.02, 0.03]",
        "",
    );
    let scene = |elements: &str, more: &str| {
        format!(
            "model: arms\ndimension: 3\nparameters: {{ lean: 0.3 }}\nsystems:\n  - name: man\n    elements:\n      - {{ name: hip, mass: 12, cg: [0.01, 0, 0], inertia: {plain} }}\n{elements}    start:\n      joints: {{ left-0: 0.3, left-3: [0.1, 0.2]{more} }}\n      joint_rates: {{ left-2: 4{} }}\n",
            match more {
                "" => "",
                _ => ", right-2: 4",
            }
        )
    };
    let law = "elastic: { points: [[-1, -3], [0, 0], [0.5, 4]], extrapolate: linear }, neutral: 0.1, motor: 2, stop: { to: 0.5, stiffness: 10 }";
    same(
        &(scene(&short, "")
            + &format!(
                "forces:\n  - {{ joint: man/left-0, mirror: true, {law} }}\n  - {{ joint: man/left-3, freedom: angle-x, mirror: true, {law} }}\n"
            )),
        &(scene(&long, ", right-0: 0.3, right-3: [0.1, 0.2]")
            + &format!(
                "forces:\n  - {{ joint: man/left-0, {law} }}\n  - {{ joint: man/right-0, {law} }}\n  - {{ joint: man/left-3, freedom: angle-x, {law} }}\n  - {{ joint: man/right-3, freedom: angle-x, {law} }}\n"
            )),
    );
    // in the plane a mirror of x reverses rotations about y and sliding along x
    let planar = |arms: &str| {
        format!(
            "model: arms\ndimension: 2\nmirror: {{ axis: x }}\nsystems:\n  - name: man\n    elements:\n      - {{ name: hip, mass: 12, cg: [0, 0], inertia: 1 }}\n{arms}"
        )
    };
    let arm = |name: &str, x: &str, joint: &str, mirror: &str| {
        format!(
            "      - {{ name: {name}, {mirror}on: hip, at: [{x}, 0], joint: {joint}, mass: 1, cg: [0, 0.1], inertia: 0.1 }}\n"
        )
    };
    let pairs = [
        ("{ hinge: y }", "{ hinge: -y }"),
        ("{ slider: [1, 2] }", "{ slider: [-1, 2] }"),
        (
            "{ planar: y }",
            "[{ slider: -x }, { slider: z }, { hinge: -y }]",
        ),
    ];
    let (mut short, mut long) = (String::new(), String::new());
    for (i, (left, right)) in pairs.into_iter().enumerate() {
        short += &arm(&format!("left-{i}"), "1", left, "mirror: true, ");
        long += &arm(&format!("left-{i}"), "1", left, "");
        long += &arm(&format!("right-{i}"), "-1", right, "");
    }
    same(&planar(&short), &planar(&long));
}

#[test]
fn mirror_images_are_those_of_the_long_form() {
    same(&format!("{LEGS}{MIRRORED}"), &format!("{LEGS}{BOTH_SIDES}"));
}

/// A model in the plane whose lateral axis is x.
#[test]
fn in_the_plane_x_may_be_reversed() {
    let head = "model: front\ndimension: 2\n";
    same(
        &format!(
            "{head}mirror: {{ from: near, to: far, axis: x }}
systems:
  - name: man
    elements:
      - {{ name: torso, mass: 30, cg: [0, 0.2], inertia: 1 }}
      - {{ name: near-arm, mirror: true, on: torso, at: [-0.2, 0.4], mass: 4, cg: [0.01, -0.3], inertia: 0.1 }}
    start: {{ angles: {{ near-arm: 10 deg }}, rates: {{ near-arm: -1 }} }}
forces:
  - {{ joint: man/near-arm, mirror: true, stiffness: 3, neutral: 5 deg, stop: {{ from: -10 deg, to: 170 deg, stiffness: 100 }} }}
  - {{ load: near, mirror: true, on: man/near-arm, force: [1, 2], moment: 3 }}
outputs: [{{ name: near hand, mirror: true, of: man/near-arm, what: position, at: [0, -0.6] }}]
"
        ),
        &format!(
            "{head}systems:
  - name: man
    elements:
      - {{ name: torso, mass: 30, cg: [0, 0.2], inertia: 1 }}
      - {{ name: near-arm, on: torso, at: [-0.2, 0.4], mass: 4, cg: [0.01, -0.3], inertia: 0.1 }}
      - {{ name: far-arm, on: torso, at: [0.2, 0.4], mass: 4, cg: [-0.01, -0.3], inertia: 0.1 }}
    start: {{ angles: {{ near-arm: 10 deg, far-arm: -10 deg }}, rates: {{ near-arm: -1, far-arm: 1 }} }}
forces:
  - {{ joint: man/near-arm, stiffness: 3, neutral: 5 deg, stop: {{ from: -10 deg, to: 170 deg, stiffness: 100 }} }}
  - {{ joint: man/far-arm, stiffness: 3, neutral: -5 deg, stop: {{ from: -170 deg, to: 10 deg, stiffness: 100 }} }}
  - {{ load: near, on: man/near-arm, force: [1, 2], moment: 3 }}
  - {{ load: far, on: man/far-arm, force: [-1, 2], moment: -3 }}
outputs:
  - {{ name: near hand, of: man/near-arm, what: position, at: [0, -0.6] }}
  - {{ name: far hand, of: man/far-arm, what: position, at: [0, -0.6] }}
"
        ),
    );
}

const BALLS: &str = "
model: balls
dimension: 2
systems:
  - name: a
    elements:
      - { name: low, mass: 1, cg: [0, 0.1], inertia: 0.1 }
      - { name: high, on: low, at: [0, 0.3], mass: 1, cg: [0, 0.1], inertia: 0.1 }
  - name: b
    elements: [{ name: one, mass: 2, cg: [0, 0], inertia: 0.2 }]
    start: { position: [1, 0] }
";

#[test]
fn lists_and_groups_make_one_force_for_each() {
    same(
        &format!(
            "{BALLS}surfaces:
  low: {{ on: a/low, center: [0, 0.1], semi_axes: [0.1, 0.1] }}
  high: {{ on: a/high, center: [0, 0.1], semi_axes: [0.1, 0.1] }}
  one: {{ on: b/one, center: [0, 0], semi_axes: [0.2, 0.1] }}
  floor: {{ on: frame, at: [0, -1], normal: [0, 1] }}
  wall: {{ on: frame, at: [2, 0], normal: [-1, 0] }}
groups:
  both: [low, high]
  all: [both, one]
forces:
  - {{ joint: [a/low, a/high], stiffness: 10, damping: 1 }}
  - {{ contact: ground, ellipsoid: all, plane: [floor, wall], stiffness: 1e4 }}
  - {{ contact: pair, ellipsoid: one, with: both, stiffness: 1e3 }}
  - {{ contact: self, ellipsoid: all, with: all, stiffness: 1e2 }}
outputs:
  - {{ name: tip, of: [a/high, b/one], what: position, component: [x, z] }}
  - {{ name: load, of: [contact ground-one-floor], what: force }}
"
        ),
        &{
            let surface = |name| match name {
                "low" => "{ on: a/low, center: [0, 0.1], semi_axes: [0.1, 0.1] }",
                "high" => "{ on: a/high, center: [0, 0.1], semi_axes: [0.1, 0.1] }",
                "one" => "{ on: b/one, center: [0, 0], semi_axes: [0.2, 0.1] }",
                "floor" => "{ on: frame, at: [0, -1], normal: [0, 1] }",
                _ => "{ on: frame, at: [2, 0], normal: [-1, 0] }",
            };
            let mut text = format!("{BALLS}forces:\n");
            for element in ["low", "high"] {
                text += &format!("  - {{ joint: a/{element}, stiffness: 10, damping: 1 }}\n");
            }
            for body in ["low", "high", "one"] {
                for plane in ["floor", "wall"] {
                    text += &format!(
                        "  - {{ contact: ground-{body}-{plane}, ellipsoid: {}, plane: {}, stiffness: 1e4 }}\n",
                        surface(body),
                        surface(plane)
                    );
                }
            }
            // one contact for each pair, and none of a body with itself
            for (name, a, b, stiffness) in [
                ("pair-low", "one", "low", "1e3"),
                ("pair-high", "one", "high", "1e3"),
                ("self-low-high", "low", "high", "1e2"),
                ("self-low-one", "low", "one", "1e2"),
                ("self-high-one", "high", "one", "1e2"),
            ] {
                text += &format!(
                    "  - {{ contact: {name}, ellipsoid: {}, with: {}, stiffness: {stiffness} }}\n",
                    surface(a),
                    surface(b)
                );
            }
            text += "outputs:\n";
            for (element, path) in [("high", "a/high"), ("one", "b/one")] {
                for axis in ["x", "z"] {
                    text += &format!(
                        "  - {{ name: {element} tip {axis}, of: {path}, what: position, component: {axis} }}\n"
                    );
                }
            }
            text + "  - { name: ground-one-floor load, of: contact ground-one-floor, what: force }\n"
        },
    );
}

#[test]
fn one_law_serves_several_rotations_and_scales_a_curve() {
    let head = "model: head\ndimension: 3\nparameters: { scale: 2 }\nsystems:\n  - name: a\n    elements: [{ name: b, mass: 1, cg: [0, 0, 0.1], inertia: [1, 1, 1] }]\n";
    let law = "{ stiffness: 3, damping: 1 }";
    same(
        &format!("{head}forces: [{{ joint: a/b, about: {{ xz: {law}, y: {{ friction: 1 }} }} }}]"),
        &format!(
            "{head}forces: [{{ joint: a/b, about: {{ x: {law}, y: {{ friction: 1 }}, z: {law} }} }}]"
        ),
    );
    let curve = "{ points: [[-1, -1], [1, 1]] }";
    let about = |curve: &str| {
        format!(
            "forces: [{{ joint: a/b, about: {{ y: {{ elastic: {{ curve: {curve}, times: scale }} }} }} }}]"
        )
    };
    let inline = of_short(&format!("{head}{}", about(curve)), &Files::new());
    let name = "joint-a-b-about-y-elastic";
    let named = format!("{head}curves: {{ {name}: {curve} }}\n{}", about(name));
    let named = of_short(&named, &Files::new());
    let inline = inline.replace("joint a/b about y elastic", name);
    let line = inline.lines().zip(named.lines()).find(|(a, b)| a != b);
    assert!(inline == named, "{line:?}");
    let twice = format!("{head}forces: [{{ joint: a/b, about: {{ xz: {law}, z: {law} }} }}]");
    assert!(problems(&twice, &Files::new()).contains("the rotation about z has two laws"));
}

const DOLL: &str = "
parameters: { stiff: 2 }
curves: { soft: { points: [[0, 0], [0.1, 500]], extrapolate: linear } }
vehicles: [{ name: sled, velocity: [1, 0] }]
systems:
  - name: doll
    elements:
      - { name: torso, mass: 3, cg: [0, 0.1], inertia: 0.05 }
      - { name: head, on: torso, at: [0, 0.3], mass: 1, cg: [0, 0.05], inertia: 0.01 }
    start: { position: [0, 0.5], angles: { torso: 10 deg } }
surfaces:
  head: { on: doll/head, center: [0, 0.05], semi_axes: [0.1, 0.1] }
  chest: { on: doll/torso, center: [0, 0.1], semi_axes: [0.1, 0.1] }
  seat: { on: sled, at: [0, 0], normal: [0, 1] }
groups: { skin: [head, chest] }
forces:
  - { field: gravity, acceleration: [0, -9] }
  - { field: pull, acceleration: [1, 0], on: [doll] }
  - { joint: doll/head, stiffness: stiff, until: hurt }
  - { contact: seat, ellipsoid: skin, plane: seat, elastic: soft }
  - { belt: lap, from: { on: doll/torso, at: [0, 0] }, to: { on: sled, at: [-0.3, 0] }, stiffness: 1e3, retractor: { lock: late } }
switches:
  - { switch: hurt, when: { of: contact seat-head, what: force, above: 100 } }
  - { switch: late, when: { time: 10 ms } }
outputs:
  - { name: head, of: doll/head, what: acceleration }
  - { name: lap, of: belt lap, what: force }
  - { name: sled, of: sled, what: position, component: x }
";

/// The differences of a doll from the common text, with other names.
fn doll(name: &str, prefix: &str, title: &str, x: &str) -> [String; 4] {
    let surface = |which: &str| match which {
        "head" => format!("{{ on: {name}/head, center: [0, 0.05], semi_axes: [0.1, 0.1] }}"),
        _ => format!("{{ on: {name}/torso, center: [0, 0.1], semi_axes: [0.1, 0.1] }}"),
    };
    [
        format!(
            "  - name: {name}
    elements:
      - {{ name: torso, mass: 3, cg: [0, 0.1], inertia: 0.05 }}
      - {{ name: head, on: torso, at: [0, 0.3], mass: 1, cg: [0, 0.05], inertia: 0.01 }}
    start: {{ position: [{x}, 0.5], angles: {{ torso: 10 deg }} }}
"
        ),
        format!(
            "  - {{ field: {prefix}pull, acceleration: [1, 0], on: [{name}] }}
  - {{ joint: {name}/head, stiffness: stiff, until: {prefix}hurt }}
  - {{ contact: {prefix}seat-head, ellipsoid: {}, plane: {{ on: sled, at: [0, 0], normal: [0, 1] }}, elastic: soft }}
  - {{ contact: {prefix}seat-chest, ellipsoid: {}, plane: {{ on: sled, at: [0, 0], normal: [0, 1] }}, elastic: soft }}
  - {{ belt: {prefix}lap, from: {{ on: {name}/torso, at: [0, 0] }}, to: {{ on: sled, at: [-0.3, 0] }}, stiffness: 1e3, retractor: {{ lock: late }} }}
",
            surface("head"),
            surface("chest")
        ),
        format!(
            "  - {{ switch: {prefix}hurt, when: {{ of: contact {prefix}seat-head, what: force, above: 100 }} }}\n"
        ),
        format!(
            "  - {{ name: {title}head, of: {name}/head, what: acceleration }}
  - {{ name: {title}lap, of: belt {prefix}lap, what: force }}
"
        ),
    ]
}

#[test]
fn a_system_is_included_several_times() {
    let files = Files::from([("doll.yaml", DOLL)]);
    let short = "model: two
dimension: 2
include: [{ file: doll.yaml, system: anna }, doll.yaml, { file: doll.yaml, system: anna }]
systems: [{ name: doll, start: { position: [2, 0.5], angles: { torso: 10 deg } } }]
forces: [{ contact: heads, ellipsoid: anna-head, with: head, stiffness: 1e4 }, { contact: far, ellipsoid: anna-skin, with: head, stiffness: 1e4 }]
";
    let [anna, doll] = [
        doll("anna", "anna-", "anna ", "0"),
        doll("doll", "", "", "2"),
    ];
    let on = |name: &str, part: &str, z: &str| {
        format!("{{ on: {name}/{part}, center: [0, {z}], semi_axes: [0.1, 0.1] }}")
    };
    let mut text = String::from("model: two\ndimension: 2\nparameters: { stiff: 2 }\n");
    text += "curves: { soft: { points: [[0, 0], [0.1, 500]], extrapolate: linear } }\n";
    text += "vehicles: [{ name: sled, velocity: [1, 0] }]\nsystems:\n";
    text += &(anna[0].clone() + &doll[0]);
    text += "forces:\n  - { field: gravity, acceleration: [0, -9] }\n";
    text += &(anna[1].clone() + &doll[1]);
    for (name, part, z) in [
        ("heads", "head", "0.05"),
        ("far-anna-head", "head", "0.05"),
        ("far-anna-chest", "torso", "0.1"),
    ] {
        let (a, b) = (on("anna", part, z), on("doll", "head", "0.05"));
        text += &format!("  - {{ contact: {name}, ellipsoid: {a}, with: {b}, stiffness: 1e4 }}\n");
    }
    text += &format!(
        "switches:\n{}  - {{ switch: late, when: {{ time: 10 ms }} }}\n{}",
        anna[2], doll[2]
    );
    text += &format!(
        "outputs:\n{}  - {{ name: sled, of: sled, what: position, component: x }}\n{}",
        anna[3], doll[3]
    );
    let written = generated(
        &read(&text, &Files::new())
            .unwrap_or_else(|e| panic!("{e}"))
            .0,
    );
    let made = of_short(short, &files);
    let line = made.lines().zip(written.lines()).find(|(a, b)| a != b);
    assert!(made == written, "{line:?}");
}

#[test]
fn a_start_is_joined_key_by_key() {
    let doll = "systems: [{ name: d, elements: [{ name: a, mass: 1, cg: [0, 0.1], inertia: 1 }, { name: b, on: a, at: [0, 1], mass: 1, cg: [0, 0.1], inertia: 1 }], \
        start: { position: [9, 9], angles: { a: 1, b: 2 }, rates: { b: 3 } } }]";
    let files = Files::from([("doll.yaml", doll)]);
    let text = "model: m\ndimension: 2\ninclude: [doll.yaml]\n\
        systems: [{ name: d, start: { position: [5, 6], velocity: [7, 8], angles: { b: 4 } } }]\n";
    let (model, long) = read(text, &files).unwrap();
    let system = &model.systems[0];
    let value = |number: &Number| number.constant();
    assert_eq!(
        system.position.each_ref().map(value),
        [Some(5.0), Some(0.0), Some(6.0)]
    );
    assert_eq!(
        system.velocity.each_ref().map(value),
        [Some(7.0), Some(0.0), Some(8.0)]
    );
    let angles = system.elements.iter().map(|e| value(&e.angles[1]));
    assert_eq!(angles.collect::<Vec<_>>(), [Some(1.0), Some(4.0)]);
    assert_eq!(value(&system.elements[1].angular_velocity[1]), Some(3.0));
    assert_eq!(
        long.matches("name: d,").count() + long.matches("name: d\n").count(),
        1,
        "{long}"
    );
    assert_eq!(read(&long, &Files::new()).unwrap().0, model);
}

#[test]
fn an_image_that_is_the_same_is_refused() {
    let scene = |force: &str| {
        format!(
            "model: m\ndimension: 3\nsystems: [{{ name: d, elements: [{{ name: a, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }}] }}]\nforces: [{force}]\n"
        )
    };
    for force in [
        "{ contact: left-seat, mirror: true, ellipsoid: { on: d/a, center: [0, 0, 0.1], semi_axes: [1, 1, 1] }, plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }, stiffness: 1 }",
        "{ belt: left, mirror: true, from: { on: d/a, at: [0.1, 0, 0] }, to: { on: frame, at: [1, 0.0, 0] }, stiffness: 1 }",
        "{ spring: left, mirror: true, from: { on: d/a, at: [0.1, 0.2, 0] }, to: { on: d/a, at: [0.1, -0.2, 0] }, stiffness: 1 }",
        "{ load: left, mirror: true, on: d/a, force: [1, 0, 2] }",
    ] {
        let said = problems(&scene(force), &Files::new());
        assert!(said.contains("once more, and would double it"), "{said}");
    }
    let apart = "{ contact: left-seat, mirror: true, ellipsoid: { on: d/a, center: [0, 0.1, 0.1], semi_axes: [1, 1, 1] }, plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }, stiffness: 1 }";
    assert_eq!(
        read(&scene(apart), &Files::new()).unwrap().0.forces.len(),
        2
    );
}

#[test]
fn paths_in_the_long_form_are_those_of_the_model() {
    let files = Files::from([
        (
            "data/doll.yaml",
            "curves: { p: { file: p.csv } }\nsystems: [{ name: d, elements: [{ name: e, mass: 1, cg: [0, 0], inertia: 1 }] }]\nforces: [{ field: f, acceleration: [p, 0] }]",
        ),
        ("data/p.csv", "0,1\n1,2\n"),
    ]);
    let text = "model: m\ndimension: 2\ninclude: [data/doll.yaml]\n";
    let (model, long) = read(text, &files).unwrap();
    assert!(long.contains("file: data/p.csv"), "{long}");
    assert_eq!(
        generated(&read(&long, &files).unwrap().0),
        generated(&model)
    );
}

/// Every mistake in a short form has a message with a place.
// Long: a few lines for each mistake.
#[test]
fn mistakes_are_told() {
    let none = Files::new();
    let surfaces = "surfaces:
  low: { on: a/low, center: [0, 0.1], semi_axes: [0.1, 0.1] }
  high: { on: a/low, center: [0, 0.2], semi_axes: [0.1, 0.1] }
  floor: { on: frame, at: [0, -1], normal: [0, 1] }
";
    for (text, expected) in [
        (
            "forces: [{ contact: c, ellipsoid: lo, plane: floor, stiffness: 1 }]",
            "there is no surface \"lo\"",
        ),
        (
            "forces: [{ contact: c, ellipsoid: [low, lo], plane: floor, stiffness: 1 }]",
            "did you mean \"low\"?",
        ),
        (
            "forces: [{ contact: c, ellipsoid: floor, plane: floor, stiffness: 1 }]",
            "\"floor\" is a plane",
        ),
        (
            "forces: [{ contact: c, ellipsoid: low, plane: low, stiffness: 1 }]",
            "\"low\" is an ellipsoid",
        ),
        (
            "forces: [{ contact: c, ellipsoid: [low, low], plane: floor, stiffness: 1 }]",
            "is named twice",
        ),
        (
            "forces: [{ contact: c, ellipsoid: [], plane: floor, stiffness: 1 }]",
            "the list is empty",
        ),
        (
            "forces: [{ contact: c, ellipsoid: [low], stiffness: 1 }]",
            "a contact has two sides",
        ),
        (
            "forces: [{ contact: c, ellipsoid: [low, high], plane: [floor], with: [low], stiffness: 1 }]",
            "a contact has two sides",
        ),
        (
            "forces: [{ contact: c, ellipsoid: [low], with: [high], stiffness: 1 }]",
            "on one body",
        ),
        (
            "forces: [{ contact: c, ellipsoid: low, with: high, stiffness: 1 }]",
            "on the same body",
        ),
        (
            "groups: { low: [high] }",
            "two surfaces or groups called \"low\"",
        ),
        (
            "groups: { g: [low, nothing] }",
            "there is no surface \"nothing\"",
        ),
        (
            "forces: [{ joint: a/low, mirror: true, stiffness: 1 }]",
            "\"a/low\" has no mirror image",
        ),
        (
            "forces: [{ belt: lap, mirror: true, from: { on: a/low, at: [0, 0] }, to: { on: frame, at: [1, 0] }, stiffness: 1e3 }]",
            "does not tell the sides apart",
        ),
        (
            "outputs: [{ name: left, mirror: true, of: a/low, what: position }]",
            "\"a/low\" has no mirror image",
        ),
        (
            "outputs: [{ name: all, of: [a/low, b/one], what: position, component: [x, q] }]",
            "\"q\" is none of the words",
        ),
        (
            "outputs: [{ name: all, of: [a/low, a/low], what: position }]",
            "low all",
        ),
        ("mirror: { axis: w }", "\"w\" is none of the words"),
        ("include: [{ file: doll.yaml }]", "lacks the key \"system\""),
        (
            "forces: [{ contact: c, ellipsoid: { mirror: true, on: a/low, center: [0, 0], semi_axes: [1, 1] }, plane: floor, stiffness: 1 }]",
            "no mirror image of its own",
        ),
    ] {
        let found = problems(&format!("{BALLS}{surfaces}{text}\n"), &none);
        assert!(found.contains(expected), "{text}\n{found}");
        assert!(found.contains("model.yaml:"), "{found}");
    }
    // surfaces are checked even if nothing uses them
    let unused =
        format!("{BALLS}surfaces: {{ x: {{ on: a/lo, center: [0, 0], semi_axes: [1, -1] }} }}\n");
    assert!(problems(&unused, &none).contains("there is no element \"a/lo\""));

    let two = "systems: [{ name: d, elements: [{ name: e, mass: 1, cg: [0, 0], inertia: 1 }] }, { name: f, elements: [{ name: e, mass: 1, cg: [0, 0], inertia: 1 }] }]";
    let files = Files::from([("two.yaml", two), ("doll.yaml", DOLL)]);
    let of = |include: &str| {
        problems(
            &format!("model: m\ndimension: 2\ninclude: [{include}]\n"),
            &files,
        )
    };
    assert!(of("{ file: two.yaml, system: g }").contains("describes 2 systems"));
    assert!(of("{ file: none.yaml, system: g }").contains("there is no file"));
    assert!(of("{ file: doll.yaml, system: sled }").contains("a vehicle and a system"));
    assert!(
        of("doll.yaml, { file: doll.yaml, system: doll }").contains("two systems called \"doll\"")
    );
}

#[test]
fn long_lists_do_not_cost_time() {
    let mut text = String::from(
        "model: m\ndimension: 2\nsystems: [{ name: d, elements: [{ name: e, mass: 1, cg: [0, 0], inertia: 1 }] }]\nsurfaces:\n",
    );
    let names = |key: &str| (0..3000).map(|i| format!("{key}{i}")).collect::<Vec<_>>();
    for name in names("e") {
        text += &format!("  {name}: {{ on: d/e, center: [0, 0], semi_axes: [1, 1] }}\n");
    }
    for name in names("p") {
        text += &format!("  {name}: {{ on: frame, at: [0, 0], normal: [0, 1] }}\n");
    }
    text += &format!(
        "forces: [{{ contact: c, ellipsoid: [{}], plane: [{}], stiffness: 1 }}]\n",
        names("e").join(", "),
        names("p").join(", ")
    );
    let begin = std::time::Instant::now();
    assert!(problems(&text, &Files::new()).contains("more than 10000"));
    assert!(begin.elapsed().as_secs() < 30);
}

/// A coefficient of 0 and an absent one give the same model, also where a value that acts must be more than 0.
#[test]
fn coefficients_of_zero_are_absent_ones() {
    let scene = |contact: &str, belt: &str, spring: &str, joint: &str| {
        format!(
            "model: zeros
dimension: 2
systems:
  - name: man
    reference: free
    elements:
      - {{ name: torso, mass: 30, cg: [0, 0.2], inertia: 1.1 }}
      - {{ name: head, on: torso, at: [0, 0.5], mass: 4, cg: [0, 0.1], inertia: 0.03 }}
forces:
  - contact: ground
    ellipsoid: {{ on: man/torso, center: [0, 0], semi_axes: [0.1, 0.1] }}
    plane: {{ on: frame, at: [0, 0], normal: [0, 1] }}
    stiffness: 1e4
{contact}
  - belt: lap
    from: {{ on: man/torso, at: [0, 0] }}
    to: {{ on: frame, at: [1, 0] }}
    stiffness: 1e4
{belt}
  - spring: s
    from: {{ on: man/torso, at: [0, 0.1] }}
    to: {{ on: frame, at: [0, 2] }}
    stiffness: 10
{spring}
  - joint: man/head
    stiffness: 5
{joint}
"
        )
    };
    let zeros = scene(
        "    damping: 0\n    friction: 0\n    friction_speed: 0\n    friction_displacement: 0\n    unloading_slope: 0",
        "    damping: 0\n    slack: 0\n    unloading_slope: 0",
        "    damping: 0",
        "    damping: 0\n    friction: 0\n    friction_displacement: 0\n    neutral: 0\n    motor: 0\n    unloading_slope: 0",
    );
    same(&zeros, &scene("", "", "", ""));
}
