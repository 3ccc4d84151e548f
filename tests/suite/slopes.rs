//! `bryant gradient` across events: what an event does not touch keeps its derivatives, and what has no derivative is
//! said.

use super::command_call::call;
use super::{directory, json};
use std::path::Path;

/// Two carts that share nothing: each is pushed by 3 N from a switch on, one of them from a time that is a parameter.
const CARTS: &str = "\
model: carts
dimension: 2
parameters: { when: WHEN s, push: 3 N }
systems:
  - name: a
    elements: [{ name: cart, mass: 2 kg, cg: [0, 0], inertia: 1 }]
  - name: b
    elements: [{ name: cart, mass: 1 kg, cg: [0, 0], inertia: 1 }]
    start: { velocity: [1, 0] }
switches:
  - { switch: of-a, when: { time: when } }
  - { switch: of-b, when: { time: 0.04 s } }
forces:
  - { load: on-a, on: a/cart, at: [0, 0], force: [push, 0], since: of-a }
  - { load: on-b, on: b/cart, at: [0, 0], force: [push, 0], since: of-b }
outputs:
  - { name: va, of: a/cart, what: velocity, component: x }
  - { name: vb, of: b/cart, what: velocity, component: x }
  - { name: xa, of: a/cart, what: position, component: x }
  - { name: xb, of: b/cart, what: position, component: x }
run: { duration: 0.1 s, every: 1 ms }
";

/// The derivatives of the final values of outputs by the parameters of a scene.
fn slopes(
    here: &Path,
    scene: &str,
    outputs: &[&str],
    more: &[&str],
    code: i32,
) -> (Vec<Vec<f64>>, String) {
    std::fs::write(here.join("scene.yaml"), scene).unwrap();
    let of: Vec<String> = outputs
        .iter()
        .map(|output| format!("final of {output}"))
        .collect();
    let mut all = vec!["gradient", "scene.yaml", "--json"];
    for of in &of {
        all.extend(["--of", of.as_str()]);
    }
    all.extend(more);
    let (stdout, stderr) = call(here, &all, code);
    if stdout.is_empty() {
        return (Vec::new(), stderr);
    }
    let found = json(&stdout);
    let responses = found["responses"].as_array().unwrap();
    let slopes = responses.iter().map(|response| {
        let parameters = response["parameters"].as_array().unwrap();
        parameters
            .iter()
            .map(|parameter| parameter["derivative"].as_f64().unwrap())
            .collect()
    });
    (slopes.collect(), stderr)
}

/// v = F (D − T)/m and x = F (D − T)²/2m after a push from T to D = 0.1 s, by T and by F; the other cart by F alone. So
/// it is if both events happen at the same time.
#[test]
fn an_event_moves_what_it_touches_and_nothing_else() {
    let directory = directory();
    for when in [0.02, 0.0400001, 0.04, 0.07] {
        let scene = CARTS.replace("WHEN", &when.to_string());
        let outputs = ["va", "vb", "xa", "xb"];
        let (found, _) = slopes(directory.path(), &scene, &outputs, &["--check"], 0);
        let (a, b) = (0.1 - when, 0.06);
        let expected = [
            [-1.5, a / 2.0],
            [0.0, b],
            [-1.5 * a, a * a / 4.0],
            [0.0, b * b / 2.0],
        ];
        // 1e-8 is the tolerance of the run, 1e-7 what events of the same time are moved apart by
        for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
            assert!(
                (found - expected).abs() < 2e-6,
                "{when}: {found} {expected}"
            );
        }
        for other in [found[1][0], found[3][0]] {
            assert!(other.abs() < 1e-12, "{when}: {other}");
        }
    }
}

/// A push from T to D has no derivative by T at T = D, where differences see one side of the kink.
#[test]
fn differences_that_disagree_are_no_success() {
    let directory = directory();
    let scene = CARTS.replace("WHEN", "0.1");
    let (_, said) = slopes(
        directory.path(),
        &scene,
        &["va"],
        &["--check", "--wrt", "when"],
        3,
    );
    assert!(
        said.contains("disagree") && said.contains("help: "),
        "{said}"
    );
    // within a tolerance of one's own, 10 % are allowed
    let scene = CARTS.replace("WHEN", "0.02");
    slopes(
        directory.path(),
        &scene,
        &["va"],
        &["--check", "--tolerance", "1e-6"],
        0,
    );
}

/// One event that changes what another of the same time does has other derivatives on either side: the cart is pushed
/// from both switches on, at first by `push`, and by as much again once the other fires, but only while the first
/// pushes.
#[test]
fn events_of_the_same_time_that_meet_are_told_apart_or_said() {
    let directory = directory();
    let scene = CARTS
        .replace("WHEN", "0.04")
        .replace("since: of-a }", "since: of-a, until: of-b }");
    // from T until 0.04 s it is pushed if T is before, and never stops if T is after: a kink at 0.04 s
    let (_, said) = slopes(directory.path(), &scene, &["va"], &["--wrt", "when"], 3);
    assert!(
        said.contains("at the same time") && said.contains("help: "),
        "{said}"
    );
}

/// The ball of one system falls from a height that is a parameter, the other from the same height that is not; their
/// floors push back with damping at once, so that forces jump at the touch.
#[test]
fn balls_that_touch_at_the_same_time_are_two() {
    let directory = directory();
    let ball = |name: &str, height: &str| {
        format!(
            "  - name: {name}\n    elements: [{{ name: ball, mass: 1, cg: [0, 0], inertia: 1 }}]\n    start: {{ position: [0, {height}] }}\n"
        )
    };
    let floor = |name: &str| {
        format!(
            "  - {{ contact: floor-{name}, ellipsoid: {{ on: {name}/ball, center: [0, 0], semi_axes: [0.1, 0.1] }}, plane: {{ on: frame, at: [0, 0], \
             normal: [0, 1] }}, stiffness: 1e4, damping: 50 }}\n"
        )
    };
    let scene = format!(
        "model: balls\ndimension: 2\nparameters: {{ height: 0.3 m }}\nsystems:\n{}{}forces:\n  - {{ field: gravity, acceleration: [0, -9.81] }}\n{}{}outputs:\n  \
         - {{ name: va, of: a/ball, what: velocity, component: z }}\n  - {{ name: vb, of: b/ball, what: velocity, component: z }}\nrun: {{ duration: 0.3 s, \
         every: 1 ms }}\n",
        ball("a", "height"),
        ball("b", "0.3 m"),
        floor("a"),
        floor("b"),
    );
    let (found, _) = slopes(directory.path(), &scene, &["va", "vb"], &["--check"], 0);
    assert!(
        found[0][0].abs() > 1.0 && found[1][0].abs() < 1e-9,
        "{found:?}"
    );
}
