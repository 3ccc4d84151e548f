//! Systems without a freedom of their own: welded, carried by a vehicle or moved as given, following, alone in a model
//! and beside others, with forces and outputs, in every command. Each works, or is refused with its place and a remedy.

use super::command_call::bryant;
use super::share::share;
use super::{directory, json};
use std::path::Path;

/// What a system may be that does not move by itself; its first element is post/p.
const SYSTEMS: [(&str, &str); 6] = [
    (
        "fixed",
        "reference: fixed, elements: [{ name: p, joint: weld, BODY }]",
    ),
    (
        "chain",
        "reference: fixed, elements: [{ name: p, joint: weld, BODY }, { name: q, on: p, at: [0, 0, 0.5], joint: weld, BODY }]",
    ),
    (
        "riding",
        "reference: { on: car, at: [0, 0, 1] }, elements: [{ name: p, joint: weld, BODY }]",
    ),
    (
        "driven",
        "reference: { acceleration: [{ points: [[0, 0], [0.05, 100], [0.1, 0]] }, 0, 0] }, elements: [{ name: p, joint: weld, BODY }]",
    ),
    ("free", "elements: [{ name: p, joint: weld, BODY }]"),
    (
        "followers",
        "reference: fixed, elements: [{ name: p, joint: weld, BODY }, { name: q, on: p, at: [0, 0, 0.5], joint: { hinge: y, follows: { joint: r, \
         ratio: 2 } }, BODY }, { name: r, on: p, at: [0, 0, 0.2], joint: { hinge: y, follows: { joint: q, ratio: 0.5 } }, BODY }]",
    ),
];

const FORCES: [&str; 6] = [
    "",
    "  - { field: gravity, acceleration: [0, 0, -9.81] }\n",
    "  - { spring: s, from: { on: post/p, at: [0, 0, 0.4] }, to: { on: frame, at: [1, 0, 0] }, stiffness: 100 }\n",
    "  - { bushing: s, from: { on: post/p, at: [0, 0, 0.4] }, to: { on: frame, at: [0, 0, 0] }, along: { x: { stiffness: 10, damping: 1 } }, about: { y: \
     { stiffness: 1 } } }\n",
    "  - { belt: s, from: { on: post/p, at: [0, 0, 0.4] }, to: { on: frame, at: [1, 0, 0] }, stiffness: 100, slack: 0 }\n",
    "  - { contact: s, ellipsoid: { on: post/p, center: [0, 0, 0], semi_axes: [0.1, 0.1, 0.1] }, plane: { on: frame, at: [0, 0, -0.05], normal: [0, 0, 1] \
     }, stiffness: 1000, damping: 10, friction: 0.3 }\n",
];

const OUTPUTS: &str = "\
outputs:
  - { name: x, of: post/p, at: cg, what: position, component: x }
  - { name: a, of: post/p, at: cg, what: acceleration, component: resultant }
  - { name: F, of: joint post/p, what: force, component: z }
  - { name: M, of: joint post/p, what: moment, component: y }
";

const BALL: &str = "  - { name: ball, elements: [{ name: b, mass: 1, cg: [0, 0, 0], inertia: [0.1, 0.1, 0.1] }], start: { position: [0.05, 0, 1] } }\n";
const TO_BALL: &str = "  - { spring: t, from: { on: post/p, at: [0, 0, 0.4] }, to: { on: ball/b, at: [0, 0, 0] }, stiffness: 100 }\n";

fn scene(system: &str, force: &str, ball: bool, outputs: bool) -> String {
    let body = "mass: heft, cg: [0.1, 0, 0.2], inertia: [0.1, 0.12, 0.14]";
    let mut text = "model: stiff\ndimension: 3\nparameters: { heft: 1 kg }\n".to_owned();
    text += "vehicles: [{ name: car, acceleration: [{ points: [[0, 0], [0.05, 100], [0.1, 0]] }, 0, 0], start: { velocity: [10, 0, 0] } }]\n";
    text += &format!(
        "systems:\n  - {{ name: post, {} }}\n",
        system.replace("BODY", body)
    );
    text += if ball { BALL } else { "" };
    if ball || !force.is_empty() {
        text += &format!("forces:\n{force}{}", if ball { TO_BALL } else { "" });
    }
    text += if outputs { OUTPUTS } else { "" };
    text + "run: { duration: 0.1 s, every: 50 ms }\n"
}

/// The same kinds of systems in the plane.
const PLANAR: [(&str, &str); 6] = [
    (
        "fixed",
        "reference: fixed, elements: [{ name: p, joint: weld, BODY }]",
    ),
    (
        "chain",
        "reference: fixed, elements: [{ name: p, joint: weld, BODY }, { name: q, on: p, at: [0, 0.5], joint: weld, BODY }]",
    ),
    (
        "riding",
        "reference: { on: car, at: [0, 1] }, elements: [{ name: p, joint: weld, BODY }]",
    ),
    (
        "driven",
        "reference: { acceleration: [{ points: [[0, 0], [0.05, 100], [0.1, 0]] }, 0] }, elements: [{ name: p, joint: weld, BODY }]",
    ),
    ("free", "elements: [{ name: p, joint: weld, BODY }]"),
    (
        "followers",
        "reference: fixed, elements: [{ name: p, joint: weld, BODY }, { name: q, on: p, at: [0, 0.5], joint: { hinge: y, follows: { joint: r, \
         ratio: 2 } }, BODY }, { name: r, on: p, at: [0, 0.2], joint: { hinge: y, follows: { joint: q, ratio: 0.5 } }, BODY }]",
    ),
];

const PLANAR_FORCES: [&str; 4] = [
    "",
    "  - { field: gravity, acceleration: [0, -9.81] }\n",
    "  - { bushing: s, from: { on: post/p, at: [0, 0.4] }, to: { on: frame, at: [0, 0] }, along: { x: { stiffness: 10, damping: 1 } } }\n",
    "  - { contact: s, ellipsoid: { on: post/p, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0, -0.05], normal: [0, 1] }, stiffness: \
     1000, damping: 10, friction: 0.3 }\n",
];

/// A planar scene.
fn planar(system: &str, force: &str, ball: bool) -> String {
    let body = "mass: heft, cg: [0.1, 0.2], inertia: 0.12";
    let mut text = "model: flat\ndimension: 2\nparameters: { heft: 1 kg }\n".to_owned();
    text += "vehicles: [{ name: car, acceleration: [{ points: [[0, 0], [0.05, 100], [0.1, 0]] }, 0], start: { velocity: [10, 0] } }]\n";
    text += &format!(
        "systems:\n  - {{ name: post, {} }}\n",
        system.replace("BODY", body)
    );
    if ball {
        text += "  - { name: ball, elements: [{ name: b, mass: 1, cg: [0, 0], inertia: 0.1 }], start: { position: [0.05, 1] } }\n";
    }
    if !force.is_empty() {
        text += &format!("forces:\n{force}");
    }
    text += "outputs:\n  - { name: x, of: post/p, at: cg, what: position, component: x }\n  - { name: F, of: joint post/p, what: force, component: z }\n";
    text + "run: { duration: 0.1 s, every: 50 ms }\n"
}

/// Every command that reads a model.
const COMMANDS: [&[&str]; 12] = [
    &["run", "s.yaml", "--no-files"],
    &["check", "s.yaml"],
    &["effects", "s.yaml", "--json"],
    &["equations", "s.yaml"],
    &["equations", "s.yaml", "--latex"],
    &["equations", "s.yaml", "--rust"],
    &["equations", "s.yaml", "--c"],
    &["equations", "s.yaml", "--json"],
    &["settle", "s.yaml"],
    &["modes", "s.yaml"],
    &["gradient", "s.yaml", "--of", "final of x"],
    &[
        "accuracy",
        "s.yaml",
        "--quick",
        "--budget",
        "1 s",
        "--no-files",
    ],
];

/// The values that `equations` prints at the start are printed again where that state is given.
fn holds_at_its_start(here: &Path, of: &str) {
    let values = |more: &[&str]| {
        let output = bryant(here)
            .args(["equations", "s.yaml", "--json"])
            .args(more)
            .output()
            .unwrap();
        output
            .status
            .success()
            .then(|| json(&String::from_utf8(output.stdout).unwrap()))
    };
    let Some(at_start) = values(&[]) else { return };
    std::fs::write(here.join("at.json"), at_start["state"].to_string()).unwrap();
    assert!(values(&["--at", "at.json"]) == Some(at_start), "{of}");
}

/// Calls the command: it works, or says where and what to do.
fn holds(here: &Path, arguments: &[&str], of: &str) -> bool {
    let output = bryant(here).args(arguments).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    let code = output.status.code();
    assert!(!said.contains("panicked"), "{arguments:?} of {of}: {said}");
    match code {
        Some(0) => true,
        Some(2 | 3) => {
            assert!(
                said.contains("error: ") && said.contains("help: "),
                "{arguments:?} of {of}: {said}"
            );
            false
        }
        _ => panic!("{arguments:?} of {of}: {code:?} {said}"),
    }
}

#[test]
fn what_cannot_move_by_itself_panics_in_no_command() {
    let directory = directory();
    let here = directory.path();
    let all = SYSTEMS.into_iter().flat_map(|system| {
        let forces = FORCES.into_iter().enumerate();
        forces.flat_map(move |force| [(system, force, false), (system, force, true)])
    });
    for ((name, system), (k, force), ball) in share(8, all) {
        let of = format!("{name} {k} {ball}");
        let text = scene(system, force, ball, true);
        std::fs::write(here.join("s.yaml"), &text).unwrap();
        // every command with the first two forces, the run with all
        let commands = &COMMANDS[..if k < 2 { COMMANDS.len() } else { 3 }];
        let ran = holds(here, commands[0], &of);
        for command in &commands[1..] {
            holds(here, command, &of);
        }
        holds_at_its_start(here, &of);
        assert!(ran || matches!(name, "free" | "followers"), "{of}:\n{text}");
        std::fs::write(here.join("s.yaml"), scene(system, force, ball, false)).unwrap();
        holds(here, commands[0], &of);
    }
}

#[test]
fn nor_in_the_plane() {
    let directory = directory();
    let here = directory.path();
    let all = PLANAR.into_iter().flat_map(|system| {
        let forces = PLANAR_FORCES.into_iter().enumerate();
        forces.flat_map(move |force| [(system, force, false), (system, force, true)])
    });
    for ((name, system), (k, force), ball) in share(8, all) {
        let of = format!("{name} {k} {ball}");
        let text = planar(system, force, ball);
        std::fs::write(here.join("s.yaml"), &text).unwrap();
        let ran = holds(here, COMMANDS[0], &of);
        for command in &COMMANDS[1..] {
            holds(here, command, &of);
        }
        holds_at_its_start(here, &of);
        assert!(ran || matches!(name, "free" | "followers"), "{of}:\n{text}");
    }
}

/// The weight of the post in its joint, and a ball that falls beside: closed forms.
#[test]
fn a_post_carries_its_weight_beside_a_ball_that_falls() {
    let directory = directory();
    let here = directory.path();
    let text = scene(SYSTEMS[0].1, FORCES[1], true, true)
        .replace(TO_BALL, "")
        .replace(
            "outputs:\n",
            "outputs:\n  - { name: z, of: ball/b, what: position, component: z }\n",
        );
    std::fs::write(here.join("s.yaml"), text).unwrap();
    let output = bryant(here)
        .args(["run", "s.yaml", "--no-files", "--json"])
        .output()
        .unwrap();
    assert!(output.status.success());
    let found = json(&String::from_utf8(output.stdout).unwrap());
    let last = found["rows"].as_array().unwrap().last().unwrap();
    let [z, force, moment] = [1, 4, 5].map(|i| last[i].as_f64().unwrap());
    assert!((z - (1.0 - 9.81 * 0.005)).abs() < 1e-9, "{z}");
    // 1 kg at 0.1 m beside the joint: the joint lifts it, and turns it back about y
    assert!(
        (force - 9.81).abs() < 1e-9 && (moment.abs() - 0.981).abs() < 1e-9,
        "{force} {moment}"
    );
}

/// A study of a model that cannot move.
#[test]
fn a_study_of_a_post_is_a_study() {
    let directory = directory();
    let here = directory.path();
    std::fs::write(
        here.join("s.yaml"),
        scene(SYSTEMS[0].1, FORCES[1], false, true),
    )
    .unwrap();
    let study = "model: s.yaml\ndesign: sobol\nruns: 4\nparameters:\n  heft: { from: 1 kg, to: 2 kg }\nresponses:\n  - { of: F, what: final }\n";
    std::fs::write(here.join("study.yaml"), study).unwrap();
    assert!(holds(here, &["sweep", "study.yaml"], "a study"));
}
