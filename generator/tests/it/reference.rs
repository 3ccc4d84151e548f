//! The examples of the reference page are valid. Its tables of keys are compared by `tests/suite/keys.rs`.

use bryant_generator::read_str;

use std::io;
use std::path::Path;

const PAGE: &str = include_str!("../../../docs/reference.md");

/// A model around an example, with the parts that the example does not give.
fn completed(example: &str) -> String {
    let has = |key: &str| {
        example
            .lines()
            .any(|line| line.starts_with(&format!("{key}:")))
    };
    let mut text = String::new();
    if !has("model") {
        text += "model: example\n";
    }
    if !has("dimension") {
        text += "dimension: 2\n";
    }
    if !has("systems") {
        text += if example.contains("dimension: 3") {
            "systems:\n  - name: man\n    elements:\n      - { name: torso, mass: 30, cg: [0, 0, 0.2], inertia: [1, 1, 1] }\n      - { name: head, on: torso, at: [0, 0, 0.45], mass: 4.5, cg: [0, 0, 0.1], inertia: [1, 1, 1] }\n"
        } else {
            "systems:\n  - name: man\n    elements:\n      - { name: torso, mass: 30, cg: [0, 0.2], inertia: 1 }\n      - { name: head, on: torso, at: [0, 0.45], mass: 4.5, cg: [0, 0.1], inertia: 1 }\n"
        };
    }
    text + example
}

#[test]
fn every_example_is_valid() {
    let loader = |path: &Path| {
        match path.to_str() {
        Some("data/child.yaml") => Ok("systems:\n  - { name: child, elements: [{ name: torso, mass: 6.5, cg: [0, 0.1], inertia: 0.05 }] }\n".to_owned()),
        Some("data/pulse.csv") => Ok(PAGE
            .split("```text\n")
            .find(|block| block.contains("time;ax;az"))
            .and_then(|block| block.split("```").next())
            .unwrap()
            .to_owned()),
        Some("drag.rs") => Ok("fn drag<T: Real>(input: &Input<T>) -> Output<T> { let p = input.parameters; f(input.points.head, p.density, p.area, p.cd) }".to_owned()),
        Some("muscle.rs") => Ok("fn muscle<T: Real>(i: &Input<T>) -> Output<T> { f(i.lines.muscle, i.joints.neck, i.parameters.excitation, i.parameters.strength, i.curves.force_length(T::from_f64(1.0)), i.states.activation) }".to_owned()),
        _ => Err(io::ErrorKind::NotFound.into()),
    }
    };
    let examples: Vec<&str> = PAGE
        .split("```yaml\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap())
        .collect();
    assert!(examples.len() >= 12, "{}", examples.len());
    for example in examples {
        if let Err(problems) = read_str("example.yaml", &completed(example), &loader) {
            panic!("{problems}\n\n{example}");
        }
    }
}
