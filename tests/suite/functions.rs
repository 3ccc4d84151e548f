//! Functions of the user beside a model.

use super::command_call::call;
use super::{json, numbers, without_a_toolchain};

/// The example of the documentation page: its model and its function.
fn ball() -> tempfile::TempDir {
    let page = include_str!("../../docs/forces/user.md");
    let block = |language: &str| {
        let begin = format!("```{language}\n");
        let (_, rest) = page.split_once(&begin).expect("a block");
        rest.split("```").next().expect("its end").to_owned()
    };
    let directory = tempfile::tempdir().unwrap();
    std::fs::write(directory.path().join("ball.yaml"), block("yaml")).unwrap();
    std::fs::write(directory.path().join("drag.rs"), block("rust")).unwrap();
    directory
}

/// It waits, so that other tests go on in the meantime.
#[test]
fn a_function_that_does_not_return_ends_the_run() {
    let directory = ball();
    let path = directory.path().join("drag.rs");
    let text = std::fs::read_to_string(&path).unwrap();
    let (head, body) = text.split_once("-> Output<T> {").expect("a function");
    let wait = "loop { std::thread::sleep(std::time::Duration::from_millis(50)); }\n#[allow(unreachable_code)]";
    std::fs::write(&path, format!("{head}-> Output<T> {{ {wait} {{ {body} }}")).unwrap();
    let (_, error) = call(directory.path(), &["run", "ball.yaml", "--no-files"], 3);
    let said = "(drag.rs) does not return: one call of it has taken 10 s";
    assert!(error.contains(said) && error.contains("help: "), "{error}");
}

/// A ball in air lands before and below a ball without drag: v_t² = 2 m g/(ρ c_d A) = 134 m²/s².
#[test]
fn a_force_of_the_users_own_runs_from_its_page() {
    let directory = ball();
    let here = directory.path();
    let run = |arguments: &[&str]| {
        let arguments = [&["run", "ball.yaml", "--no-files", "--json"], arguments].concat();
        let (out, _) = call(here, &arguments, 0);
        json(&out)["rows"]
            .as_array()
            .unwrap()
            .iter()
            .map(numbers)
            .collect::<Vec<_>>()
    };
    let (drawn, free) = (run(&[]), run(&["--set", "cd=0"]));
    let last = |rows: &[Vec<f64>]| rows[rows.len() - 1].clone();
    // without drag x = 20 t, z = 15 t − g t²/2, within the tolerance of the run
    let (g, t) = (9.80665, 3.0);
    let [time, x, z, drag] = last(&free)[..] else {
        panic!("{free:?}")
    };
    assert!(time == t && drag == 0.0);
    assert!((x - 20.0 * t).abs() < 1e-3 && (z - (15.0 * t - g * t * t / 2.0)).abs() < 1e-3);
    // with drag, by steps of a tenth of a millisecond of the midpoint rule, whose error is below 1e-6 here
    let k = 0.5 * 1.2 * 0.47 * 13e-4 / 0.05;
    let (mut p, mut v, h) = ([0.0, 0.0], [20.0f64, 15.0], 1e-4);
    let rate = |v: [f64; 2]| {
        let speed = v[0].hypot(v[1]);
        [-k * speed * v[0], -k * speed * v[1] - g]
    };
    for _ in 0..30_000 {
        let a = rate(v);
        let middle = [v[0] + h / 2.0 * a[0], v[1] + h / 2.0 * a[1]];
        let a = rate(middle);
        for i in 0..2 {
            p[i] += h * middle[i];
            v[i] += h * a[i];
        }
    }
    let [_, x, z, drag] = last(&drawn)[..] else {
        panic!("{drawn:?}")
    };
    assert!(
        (x - p[0]).abs() < 1e-3 && (z - p[1]).abs() < 1e-3,
        "{x} {z} {p:?}"
    );
    let expected = 0.05 * k * (v[0] * v[0] + v[1] * v[1]);
    assert!(
        (drag - expected).abs() < 1e-4 * expected,
        "{drag} {expected}"
    );
}

#[test]
fn what_the_compiler_finds_in_a_function_is_shown_in_its_file() {
    let directory = ball();
    let file = directory.path().join("drag.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("* speed;", "* sped;")).unwrap();
    let (_, err) = call(directory.path(), &["run", "ball.yaml", "--no-files"], 2);
    assert!(err.contains("drag.rs:6:"), "{err}");
    assert!(err.contains("cannot find value `sped`"), "{err}");
    assert!(err.contains("similar name exists: `speed`"), "{err}");
    assert!(!err.contains("fault of bryant"), "{err}");

    // the example of the page
    std::fs::write(
        &file,
        text.replace("points.centre.velocity", "points.center.velocity"),
    )
    .unwrap();
    let (_, err) = call(directory.path(), &["check", "ball.yaml"], 2);
    let page = include_str!("../../docs/forces/user.md");
    assert!(page.contains(err.trim()), "{err}");
}

#[test]
fn a_changed_function_is_compiled_again() {
    let directory = ball();
    let drag = || {
        let (out, _) = call(
            directory.path(),
            &["run", "ball.yaml", "--no-files", "--json"],
            0,
        );
        numbers(&json(&out)["rows"][0])[3]
    };
    let before = drag();
    let file = directory.path().join("drag.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    std::fs::write(&file, text.replace("-0.5", "-1.0")).unwrap();
    let after = drag();
    // the compiler may fuse other operations of the changed text
    assert!(
        (after / (2.0 * before) - 1.0).abs() < 1e-12,
        "{after} after {before}"
    );
}

#[test]
fn a_skeleton_is_a_function_that_compiles_and_does_nothing() {
    let directory = ball();
    let here = directory.path();
    std::fs::remove_file(here.join("drag.rs")).unwrap();
    let (_, err) = call(here, &["run", "ball.yaml"], 2);
    assert!(err.contains("there is no file \"drag.rs\""), "{err}");
    let (out, _) = call(here, &["check", "ball.yaml", "--skeleton", "air"], 0);
    std::fs::write(here.join("drag.rs"), &out).unwrap();
    let (out, _) = call(here, &["run", "ball.yaml", "--no-files", "--json"], 0);
    let rows = json(&out)["rows"].as_array().unwrap().clone();
    assert!(rows.iter().all(|row| numbers(row)[3] == 0.0), "{out}");
    let (_, err) = call(here, &["check", "ball.yaml", "--skeleton", "ait"], 2);
    assert!(err.contains("did you mean \"air\"?"), "{err}");
}

/// r_k of a ball of 50 g is its weight and −½ ρ c_d A |v| v, r_s is 0, and S v̇ = r_k.
#[test]
fn equations_at_a_state_have_the_functions_of_the_user() {
    let directory = ball();
    let here = directory.path();
    let state = |vx: f64, vz: f64| {
        let state = format!("{{\"q\": [0, 2, 0.3], \"v\": [{vx}, {vz}, 0]}}");
        std::fs::write(here.join("state.json"), state).unwrap();
    };
    let at = |cd: &str| {
        let arguments = [
            "equations",
            "ball.yaml",
            "--at",
            "state.json",
            "--json",
            "--set",
            cd,
        ];
        json(&call(here, &arguments, 0).0)
    };
    let (vx, vz) = (12.0, -5.0);
    state(vx, vz);
    for cd in [0.0, 0.47, 1.5] {
        let found = at(&format!("cd={cd}"));
        let factor = -0.5 * 1.2 * cd * 13e-4 * 13.0;
        let expected = [factor * vx, factor * vz - 0.05 * 9.80665, 0.0];
        let (force, rate) = (numbers(&found["r_k"]), numbers(&found["acceleration"]));
        for i in 0..3 {
            assert!((force[i] - expected[i]).abs() < 1e-12, "{found}");
        }
        for i in 0..2 {
            assert!((0.05 * rate[i] - expected[i]).abs() < 1e-12, "{found}");
        }
    }
    // as a table
    let (out, _) = call(here, &["equations", "ball.yaml", "--at", "state.json"], 0);
    assert!(out.contains("ball.vx"), "{out}");
    // a function that panics reports the place
    let file = here.join("drag.rs");
    let text = std::fs::read_to_string(&file).unwrap();
    let panics = text.replace(
        "let mut output",
        "panic!(\"no air\");\n    #[allow(unreachable_code)]\n    let mut output",
    );
    assert_ne!(panics, text);
    std::fs::write(&file, panics).unwrap();
    let arguments = ["equations", "ball.yaml", "--at", "state.json"];
    let (_, err) = call(here, &arguments, 3);
    assert!(
        err.contains("panicked: no air") && err.contains("drag.rs:"),
        "{err}"
    );
}

#[test]
fn what_only_a_crate_can_call_is_said() {
    let directory = ball();
    let here = directory.path();
    let (out, _) = call(here, &["equations", "ball.yaml"], 0);
    assert!(out.contains("drag_returns_centre_force_x(t, "), "{out}");

    let model = std::fs::read_to_string(here.join("ball.yaml")).unwrap();
    let lines = model.lines().filter(|line| !line.contains("source:"));
    let lines: Vec<&str> = lines.collect();
    let model = lines
        .join("\n")
        .replace("function: drag ", "function: crate::aero::drag ");
    std::fs::write(here.join("ball.yaml"), model).unwrap();
    let (out, _) = call(here, &["check", "ball.yaml"], 0);
    assert!(out.contains("user        air"), "{out}");
    let (_, err) = call(here, &["run", "ball.yaml"], 2);
    assert!(
        err.contains("calls crate::aero::drag") && err.contains("source: FILE.rs"),
        "{err}"
    );
}

#[test]
fn a_missing_compiler_is_named_with_the_remedy() {
    let directory = ball();
    let (_, stderr) = without_a_toolchain(directory.path(), &["run", "ball.yaml"], 1);
    assert!(
        stderr.contains("/nonexistent/rustc") && stderr.contains("RUSTC="),
        "{stderr}"
    );
    assert!(!directory.path().join("ball.csv").exists());
}
