//! User forces: their Rust files are part of the model, and the generated text contains them.

use bryant_generator::model::Model;
use bryant_generator::read_str;
use bryant_generator::read_without_sources;
use bryant_generator::target::rust;
use bryant_generator::{Config, Diagnostics};
use std::io;
use std::path::{Path, PathBuf};

const HEAD: &str = "\
model: m
dimension: 2
systems:
  - name: man
    elements:
      - { name: torso, mass: 30, cg: [0, 0.2], inertia: 1.1 }
      - { name: head, on: torso, at: [0, 0.45], mass: 4.5, cg: [0.02, 0.1], inertia: 0.03 }
";

const PUSH: &str = "\
//! A force.

/// Along the velocity.
fn push<T: Real>(input: &Input<T>) -> Output<T> {
    let mut output = Output::zero();
    output.points.at.force = input.points.at.velocity; // \"}\" { is no bracket
    output
}
";

fn read(forces: &str, function: &str) -> Result<(Model, Vec<PathBuf>), Diagnostics> {
    let loader = |path: &Path| match path.to_str() {
        Some("models/push.rs") => Ok(function.to_owned()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    read_str("models/m.yaml", &format!("{HEAD}{forces}"), &loader)
}

fn model(forces: &str) -> (Model, Vec<PathBuf>) {
    read(forces, PUSH).unwrap_or_else(|problems| panic!("{problems}"))
}

fn source(forces: &str) -> String {
    Config::new().source(&model(forces).0)
}

/// The generated text without the digest, which depends on how the model is written.
fn without_digest(source: &str) -> String {
    let lines = source.lines();
    let lines = lines.filter(|line| !line.contains("digest:") && !line.contains("SHA-256"));
    lines.collect::<Vec<_>>().join("\n")
}

const ONE: &str =
    "forces:\n  - { user: push, source: push.rs, points: { at: { on: man/head, at: cg } } }\n";

#[test]
fn the_file_is_part_of_what_a_model_is_made_of() {
    let (model, paths) = model(ONE);
    assert_eq!(
        paths,
        ["models/m.yaml", "models/push.rs"].map(PathBuf::from)
    );
    let (again, _) = read(ONE, PUSH).unwrap();
    assert_eq!(model.digest, again.digest);
    let (changed, _) = read(ONE, &PUSH.replace("Along", "Against")).unwrap();
    assert_ne!(model.digest, changed.digest);
    // with either kind of line ends
    let (windows, _) = read(ONE, &PUSH.replace('\n', "\r\n")).unwrap();
    assert_eq!(model.digest, windows.digest);
}

#[test]
fn the_text_stands_letter_for_letter_in_a_module_of_its_own() {
    let source = source(ONE);
    assert!(source.contains(&format!(
        "pub mod push {{\n// push.rs, as its author wrote it\n\n{PUSH}"
    )));
    assert!(source.contains("push::scalars(["), "{source}");
    assert!(
        source.contains("let [push_at_force_x, push_at_force_z] ="),
        "{source}"
    );
    syn::parse_file(&source).expect("Rust");
}

#[test]
fn forces_that_are_alike_share_a_module_and_others_do_not() {
    let force = |name: &str, port: &str| {
        format!(
            "  - {{ user: {name}, function: push, source: push.rs, points: {{ {port}: {{ on: man/head, at: cg }} }} }}\n"
        )
    };
    let alike = source(&format!(
        "forces:\n{}{}",
        force("a", "at"),
        force("b", "at")
    ));
    assert_eq!(alike.matches("pub mod push").count(), 1);
    let function = PUSH.replace("points.at", "points.point");
    let forces = format!(
        "forces:\n{}  - {{ user: c, function: push, source: push.rs, points: {{ point: {{ on: man/torso, at: cg }}, at: {{ on: frame, at: [0, 0] }} }} }}\n",
        force("b", "point")
    );
    let function = format!("{function}// and `at`\nconst _: () = {{ let at = (); at }};\n");
    let (model, _) = read(&forces, &function).unwrap_or_else(|problems| panic!("{problems}"));
    let source = Config::new().source(&model);
    assert!(source.contains("pub mod push {") && source.contains("pub mod push_2 {"));
    assert!(source.contains("push::scalars([") && source.contains("push_2::scalars(["));
}

#[test]
fn what_is_switched_off_leaves_no_trace() {
    let gravity = "forces:\n  - { field: gravity, acceleration: [0, -9.81] }\n";
    let off = "  - { user: push, enabled: false, source: push.rs, points: { at: { on: man/head, at: cg } }, states: { at-rest: { initial: 1 } }, curves: { c: { points: [[0, 0], [1, 1]] } } }\n";
    let function = format!("{PUSH}fn more() {{ at_rest; c; }}\n");
    let (off, _) =
        read(&format!("{gravity}{off}"), &function).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(
        without_digest(&Config::new().source(&off)),
        without_digest(&source(gravity))
    );
}

/// A force with all possible ports.
const EVERYTHING: &str = "\
forces:
  - user: all-of-it
    source: push.rs
    points: { a-point: { on: man/head, at: cg }, anchor: { on: frame, at: VECTOR } }
    bodies: { body: man/torso }
    lines: { line: { from: { on: man/torso, at: VECTOR }, to: { on: frame, at: VECTOR } } }
    joints: { neck: man/head }
    parameters: { area: 2 m^2, gust: { points: [[0, 0], [1, 10 m/s]] }, cd: 1 }
    curves: { shape: { points: [[0, 0], [1, 1]] }, none: { points: [[0, 0], [1, 0]] } }
    states: { activation: { initial: 0.05 }, path: { initial: 0 m } }
";

#[test]
fn a_skeleton_is_accepted_for_what_it_was_made_for() {
    for (dimension, zeros) in [(2, "[0, 0]"), (3, "[0, 0, 0]")] {
        let head = match dimension {
            2 => HEAD.to_owned(),
            _ => HEAD
                .replace("dimension: 2", "dimension: 3")
                .replace("inertia: 1.1", "inertia: [1, 1, 1]")
                .replace("inertia: 0.03", "inertia: [1, 1, 1]")
                .replace("[0, 0.2]", "[0, 0, 0.2]")
                .replace("[0, 0.45]", "[0, 0, 0.45]")
                .replace("[0.02, 0.1]", "[0.02, 0, 0.1]"),
        };
        let text = head + &EVERYTHING.replace("VECTOR", zeros);
        let missing = |_: &Path| Err(io::ErrorKind::NotFound.into());
        let model = read_without_sources("m.yaml", &text, &missing)
            .unwrap_or_else(|problems| panic!("{problems}"));
        assert_eq!(rust::skeleton(&model, "nothing"), None);
        let skeleton = rust::skeleton(&model, "all-of-it").expect("the force");
        assert!(skeleton.contains("pub fn all_of_it<T: Real>(input: &Input<T>)"));
        let loader = |_: &Path| Ok(skeleton.clone());
        let (model, _) = read_str("m.yaml", &text, &loader)
            .unwrap_or_else(|problems| panic!("{problems}\n{skeleton}"));
        syn::parse_file(&Config::new().source(&model)).expect("Rust");
    }
}

/// A parser that recurses for every bracket must not overflow the stack.
#[test]
fn hostile_rust_is_refused() {
    let many = |text: &str| text.repeat(250_000 / text.len());
    for text in [
        many("("),
        many("{ ( ["),
        format!(
            "fn push() {{ {}{} }}",
            "(".repeat(60_000),
            ")".repeat(60_000)
        ),
        format!("fn push() {{ {}1 }}", many("!")),
        format!("fn push() {{ {}1 }}", many("-")),
        format!("fn push() {{ {}1 }}", many("x=")),
        format!("fn push() {{ {} {{}} }}", many("if a {} else ")),
        format!("fn push() {{ {}1 }}", many("&mut ")),
        format!("fn push() {{ {}1 }}", many("return ")),
        format!("fn push(x: {}u8) {{}}", many("&'a ")),
        "\u{0}".to_owned(),
        "é".repeat(300_000),
        String::new(),
    ] {
        let problems = read(ONE, &text).expect_err("hostile text is accepted");
        assert!(problems.to_string().len() < 10_000);
    }
}
