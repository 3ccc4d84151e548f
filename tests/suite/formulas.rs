//! Outputs with formulas: columns, responses and gradients of them are those of the outputs that they are made of.

use super::command_call::call;
use super::json;
use std::fs;

/// A block that falls on two springs under its ends, turned a little.
const BLOCK: &str = "\
model: block
dimension: 2
parameters: { lever: { value: 0.2 m }, stiffness: { value: 5 kN/m } }
systems:
  - name: man
    elements:
      - { name: body, mass: 10 kg, cg: [0, 0], inertia: 0.4 }
      - { name: head, on: body, at: [0, 0.3], mass: 4 kg, cg: [0, 0.1], inertia: 0.03 }
    start: { position: [0, 0.101], angles: { body: 3 deg }, velocity: [0.5, -0.2] }
forces:
  - { field: gravity, acceleration: [0, -1 gn] }
  - { joint: man/head, stiffness: 60, damping: 2 }
  - { contact: left, ellipsoid: { on: man/body, center: [-0.2, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0, 0], normal: [0, 1] }, stiffness: stiffness, damping: 100 }
  - { contact: right, ellipsoid: { on: man/body, center: [0.2, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0, 0], normal: [0, 1] }, stiffness: stiffness, damping: 100 }
outputs:
  - { name: left, of: contact left, what: normal }
  - { name: right, of: contact right, what: normal }
  - { name: relative acceleration, of: man/head, what: acceleration, component: x, relative_to: man/body }
  - { name: relative velocity, of: man/head, what: velocity, component: x, relative_to: man/body }
  - { name: seat load, formula: left + right }
  - { name: difference, formula: left - 2 * right }
  - { name: resultant, formula: sqrt(left * left + right * right) }
  - { name: nic, formula: lever * a + v * v, with: { a: relative acceleration, v: relative velocity } }
  - { name: share, formula: 100 * left / (load + 1 N), with: { load: seat load } }
run: { duration: 0.2 s, every: 10 ms }
";

#[test]
fn a_formula_is_what_its_outputs_make_of_it() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("block.yaml"), BLOCK).unwrap();
    call(
        at,
        &["run", "block.yaml", "--no-files", "--csv", "t.csv"],
        0,
    );
    let text = fs::read_to_string(at.join("t.csv")).unwrap();
    let heading = text.lines().next().unwrap();
    for unit in ["seat load [N]", "resultant [N]", "nic [m^2/s^2]", "share"] {
        assert!(heading.split(',').any(|name| name == unit), "{heading}");
    }
    let mut pressed = 0;
    for row in text.lines().skip(1) {
        let row: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [
            _,
            left,
            right,
            a,
            v,
            load,
            difference,
            resultant,
            nic,
            share,
        ] = row[..]
        else {
            panic!("{row:?}");
        };
        pressed += usize::from(load > 0.0);
        for (is, should) in [
            (load, left + right),
            (difference, left - 2.0 * right),
            (resultant, left.hypot(right)),
            (nic, 0.2 * a + v * v),
            (share, 100.0 * left / (load + 1.0)),
        ] {
            // a few roundings of a double
            assert!(
                (is - should).abs() <= 1e-14 * (is.abs() + left + right),
                "{row:?}"
            );
        }
    }
    assert!(pressed > 5, "{text}");
}

/// The derivative of a sum is the sum of the derivatives, also with respect to a parameter of the formula itself.
#[test]
fn responses_and_gradients_take_a_formula() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    fs::write(at.join("block.yaml"), BLOCK).unwrap();
    let of = ["left", "right", "seat load", "nic", "relative acceleration"];
    let of = of.map(|name| format!("value at 150 ms of {name}"));
    let mut arguments = vec!["gradient", "block.yaml", "--json"];
    arguments.extend(of.iter().flat_map(|of| ["--of", of]));
    let (text, _) = call(at, &arguments, 0);
    let told = json(&text);
    let response = |of: &str| {
        let all = told["responses"]
            .as_array()
            .unwrap_or_else(|| panic!("{told}"));
        let one = all.iter().find(|r| r["response"] == of);
        one.unwrap_or_else(|| panic!("{of}: {told}")).clone()
    };
    let derivative = |of: &str, by: &str| {
        let one = response(of);
        let all = one["parameters"].as_array().unwrap();
        let of = all.iter().find(|p| p["name"] == by);
        of.and_then(|p| p["derivative"].as_f64())
            .unwrap_or_else(|| panic!("{one}"))
    };
    let [left, right, load, nic, acceleration] = &of;
    let sum = derivative(left, "stiffness") + derivative(right, "stiffness");
    let whole = derivative(load, "stiffness");
    assert!(
        sum != 0.0 && (whole - sum).abs() <= 1e-12 * sum.abs(),
        "{told}"
    );
    // ∂(l a + v²)/∂l = a, because nothing else depends on l
    let value = response(acceleration)["value"].as_f64().unwrap();
    let by_lever = derivative(nic, "lever");
    assert!(
        (by_lever - value).abs() <= 1e-12 * value.abs(),
        "{by_lever} {told}"
    );
    let (_, said) = call(
        at,
        &["run", "block.yaml", "--no-files", "-r", "peak of seat load"],
        0,
    );
    assert!(!said.contains("error"), "{said}");
}

#[test]
fn formulas_that_are_wrong_are_told() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    let sum = "formula: left + right";
    for (formula, needles) in [
        (
            "formula: left + rigth",
            ["no output above is called \"rigth\"", "right"],
        ),
        (
            "formula: left + later",
            ["no output above is called \"later\"", "above"],
        ),
        (
            "formula: left + v, with: { v: relative velocity }",
            ["a sum of", "m/s"],
        ),
        (
            "formula: left + r, with: { r: rigth }",
            ["no output above is called \"rigth\"", "right"],
        ),
        (
            "formula: left + m, with: { m: right }",
            ["is a unit", "\"m\""],
        ),
        ("formula: lever * 2", ["names no output", "with"]),
        ("formula: left +", ["formula", "help"]),
        (
            "formula: left + right, what: force",
            ["no key \"what\"", "formula"],
        ),
    ] {
        let text = BLOCK
            .replace(sum, formula)
            .replace("load: seat load", "load: left");
        let text = text.replace(
            "run:",
            "  - { name: later, of: man/head, what: angle }\nrun:",
        );
        fs::write(at.join("block.yaml"), text).unwrap();
        let (_, said) = call(at, &["check", "block.yaml"], 2);
        assert!(
            needles.iter().all(|needle| said.contains(needle)),
            "{formula}: {said}"
        );
        assert!(said.contains("block.yaml:"), "{said}");
    }
}

/// The formula of a file that is read twice is about the outputs of its own instance.
#[test]
fn each_instance_has_its_own_formula() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    let part = "\
systems:
  - name: man
    elements: [{ name: body, mass: 10 kg, cg: [0, 0], inertia: 0.4 }]
outputs:
  - { name: x, of: man/body, what: position, component: x }
  - { name: height above, of: man/body, what: position, component: z }
  - { name: sum, formula: x + up, with: { up: height above } }
";
    let scene = "\
model: two
dimension: 2
include: [{ file: man.yaml, system: one }, { file: man.yaml, system: two }]
systems:
  - { name: one, start: { position: [1, 2] } }
  - { name: two, start: { position: [10, 20] } }
run: { duration: 1 ms, every: 1 ms }
";
    fs::write(at.join("man.yaml"), part).unwrap();
    fs::write(at.join("two.yaml"), scene).unwrap();
    let (text, _) = call(at, &["run", "two.yaml", "--no-files", "--csv", "-"], 0);
    let mut lines = text.lines();
    let heading: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row: Vec<f64> = lines
        .next()
        .unwrap()
        .split(',')
        .map(|c| c.parse().unwrap())
        .collect();
    for (name, value) in [("one sum [m]", 3.0), ("two sum [m]", 30.0)] {
        let column = heading
            .iter()
            .position(|h| *h == name)
            .unwrap_or_else(|| panic!("{heading:?}"));
        assert_eq!(row[column], value);
    }
}
