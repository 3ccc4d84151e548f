//! The reference page agrees with the program: every key of every record, and valid examples.

use bryant_generator::description::vocabulary;
use bryant_generator::read::LANGUAGE;
use bryant_generator::read_str;

use std::io;
use std::path::Path;

const PAGE: &str = include_str!("../../../docs/reference.md");

/// Keys and defaults in the tables that begin with `| key |`, by the heading above each table.
fn documented() -> Vec<(String, Vec<(String, String)>)> {
    let mut heading = String::new();
    let mut tables: Vec<(String, Vec<(String, String)>)> = Vec::new();
    let mut inside = false;
    for line in PAGE.lines() {
        if line.starts_with('#') {
            heading = line.trim_start_matches('#').trim().to_owned();
        }
        if line.starts_with("| key |") {
            inside = true;
            tables.push((heading.clone(), Vec::new()));
        } else if !line.starts_with('|') {
            inside = false;
        } else if inside && !line.starts_with("|---") {
            let cells: Vec<&str> = line.split('|').map(str::trim).collect();
            assert_eq!(cells.len(), 6, "{line}");
            assert!(
                cells[3..5].iter().all(|c| !c.is_empty()),
                "default and meaning: {line}"
            );
            let key = cells[1].trim_matches('`').to_owned();
            let row = (key, cells[3].to_owned());
            tables.last_mut().unwrap().1.push(row);
        }
    }
    tables
}

#[test]
fn every_key_is_documented_and_every_documented_key_is_read() {
    let capital = |title: &str| title[..1].to_uppercase() + &title[1..];
    let read: Vec<(String, Vec<String>)> = vocabulary(LANGUAGE)
        .into_iter()
        .map(|(title, keys)| {
            (
                capital(title),
                keys.iter().map(|k| k.name.to_owned()).collect(),
            )
        })
        .collect();
    let keys = |rows: Vec<(String, String)>| rows.into_iter().map(|(key, _)| key).collect();
    let documented: Vec<(String, Vec<String>)> = documented()
        .into_iter()
        .map(|(heading, rows)| (heading, keys(rows)))
        .collect();
    assert_eq!(documented, read);
}

#[test]
fn what_is_required_is_called_required() {
    let tables = documented();
    for ((title, keys), (_, rows)) in vocabulary(LANGUAGE).into_iter().zip(&tables) {
        for (key, (_, default)) in keys.iter().zip(rows) {
            // if one of several keys is required, a check of its own says so
            assert_eq!(
                default == "required",
                !key.optional,
                "{title}: {}",
                key.name
            );
        }
    }
}

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
