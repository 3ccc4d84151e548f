//! `bryant run --input`: an input follows a file, exactly where the motion has a closed form.

use crate::command_call::call;
use std::path::Path;
use tempfile::tempdir;

/// A cart of 2 kg on a rail, which one input pushes, and a line that another moves a spring along.
const CART: &str = "\
model: cart
dimension: 2
inputs:
  push: { value: 0 N, min: -5 kN, max: 5 kN }
  brake: { value: 0 N, max: 10 N }
systems:
  - name: cart
    reference: fixed
    elements: [{ name: body, joint: { slider: x }, mass: 2 kg, cg: [0, 0], inertia: 1 }]
forces: [{ joint: cart/body, motor: push - brake }]
outputs:
  - { name: x, of: cart/body, what: position, component: x }
  - { name: a, of: cart/body, what: acceleration, component: x }
run: { duration: 1 s, every: 0.1 s }
";

/// In kN over ms, at uneven times: 0 until 0.2 s, up to 2 kN at 0.5 s, then down to -1 kN at 1.5 s.
const PUSH: &str = "t [ms],other [N],push [kN]\n-100,1,0\n200,1,0\n500,1,2\n1500,1,-1\n";

fn write(directory: &Path, name: &str, text: &str) {
    std::fs::write(directory.join(name), text).unwrap();
}

/// The rows of a run as numbers.
fn rows(directory: &Path, arguments: &[&str]) -> Vec<Vec<f64>> {
    let all = [&["run", "cart.yaml", "--no-files", "--csv", "-"], arguments].concat();
    let (table, _) = call(directory, &all, 0);
    let lines = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| {
            line.split(',')
                .map(|number| number.parse().unwrap())
                .collect()
        })
        .collect()
}

/// The push [N], and its double integral, at a time.
fn expected(t: f64) -> [f64; 2] {
    // ramps of a slope [N/s] that begin at a time, with 0 before
    let ramps = [(0.2, 2000.0 / 0.3), (0.5, -2000.0 / 0.3 - 3000.0)];
    let sum = |value: &dyn Fn(f64, f64) -> f64| {
        let each = ramps
            .iter()
            .map(|&(from, slope)| value(slope, (t - from).max(0.0)));
        each.sum::<f64>()
    };
    [
        sum(&|slope, t| slope * t),
        sum(&|slope, t| slope * t * t * t / 6.0),
    ]
}

#[test]
fn an_input_follows_its_column_in_its_units() {
    let folder = tempdir().unwrap();
    let directory = folder.path();
    write(directory, "cart.yaml", CART);
    write(directory, "push.csv", PUSH);
    write(directory, "brake.csv", "time;hand [N]\n0;4\n2;4\n");
    for (arguments, brake) in [
        (&["--input", "push=push.csv"][..], 0.0),
        (&["--input", "push=push.csv, push"], 0.0),
        (
            &["--input", "push=push.csv", "--input", "brake=brake.csv"],
            4.0,
        ),
        (&["--input", "push=push.csv", "--set", "brake=4 N"], 4.0),
    ] {
        for row in rows(directory, arguments) {
            let [t, x, a] = row[..] else {
                panic!("{row:?}")
            };
            let [push, integral] = expected(t);
            // steps end at the rows of the file, and between them the method is exact for a cubic
            let place = (integral - brake * t * t / 2.0) / 2.0;
            assert!(
                (x - place).abs() < 1e-9 * (1.0 + place.abs()),
                "{t}: {x} {place}"
            );
            assert!((a - (push - brake) / 2.0).abs() < 1e-9 * 1000.0, "{t}: {a}");
        }
    }
    // the same steps by a method of fixed ones, in which no row of the file falls within a step
    for row in rows(
        directory,
        &[
            "--input",
            "push=push.csv",
            "--method",
            "rk4",
            "--step",
            "10 ms",
        ],
    ) {
        assert!((row[1] - expected(row[0])[1] / 2.0).abs() < 1e-6, "{row:?}");
    }
}

#[test]
fn a_channel_of_a_test_is_an_input() {
    let folder = tempdir().unwrap();
    let directory = folder.path();
    write(
        directory,
        "cart.yaml",
        &CART.replace("what: position", "what: position, code: 00SLED000000DSX0"),
    );
    write(directory, "push.csv", PUSH);
    let run = [
        "run",
        "cart.yaml",
        "--input",
        "push=push.csv",
        "--no-files",
        "--mme",
        "test",
        "--every",
        "1 ms",
    ];
    call(directory, &run, 0);
    // the place of the first run [m], as a push of 1 N for each metre
    let model = CART.replace("push: { value: 0 N, min: -5 kN, max: 5 kN }", "push: 0 m");
    write(
        directory,
        "cart.yaml",
        &model.replace("motor: push - brake", "motor: push * 1 N / 1 m"),
    );
    for row in rows(directory, &["--input", "push=test, 00SLED000000DSX0"]) {
        let place = expected(row[0])[1] / 2.0;
        // straight lines between samples of 1 ms, and the digits of the file
        assert!(
            (2.0 * row[2] - place).abs() < 1e-3 * (1.0 + place),
            "{row:?} {place}"
        );
    }
}

#[test]
fn what_cannot_be_followed_is_refused_with_place_and_remedy() {
    let folder = tempdir().unwrap();
    let directory = folder.path();
    write(directory, "cart.yaml", CART);
    for (name, text) in [
        ("push.csv", PUSH),
        ("short.csv", "t [s],push [N]\n0,1\n0.9,1\n"),
        ("late.csv", "t [s],push [N]\n0.1,1\n2,1\n"),
        ("strong.csv", "t [s],push [N]\n0,1\n0.5,5001\n1,1\n"),
        ("length.csv", "t [s],push [m]\n0,1\n1,1\n"),
        ("back.csv", "t [s],push [N]\n0,1\n0.6,1\n0.5,1\n1,1\n"),
        ("gap.csv", "t [s],push [N]\n0,1\n0.5,\n1,1\n"),
        ("two.csv", "t [s],left [N],right [N]\n0,1,2\n1,1,2\n"),
        ("word.csv", "t [s],push [N]\n0,1\n1,a\n"),
    ] {
        write(directory, name, text);
    }
    for (arguments, said) in [
        (
            &["push=short.csv"][..],
            "it goes from 0 s to 0.9 s, and the run from 0 s to 1 s\n  help: give a longer file, or a shorter --duration",
        ),
        (&["push=late.csv"], "it goes from 0.1 s to 2 s"),
        (
            &["push=strong.csv"],
            "5001 N at 0.5 s is out of the limits of the input, -5000 to 5000",
        ),
        (
            &["push=length.csv"],
            "\"push\" is in `m`, and the input in `N`",
        ),
        (&["push=back.csv"], "the times do not increase at 0.5 s"),
        (&["push=gap.csv"], "there is no number at 0.5 s"),
        (
            &["push=two.csv"],
            "has no column \"push\"\n  help: name one, --input 'push=two.csv, COLUMN'; there are left, right",
        ),
        (&["push=push.csv, lift"], "has no column \"lift\""),
        (&["push=word.csv"], "word.csv:3: \"a\" is no number"),
        (
            &["pull=push.csv"],
            "the model has no input \"pull\"\n  help: there are: push, brake",
        ),
        (
            &["push=none.csv"],
            "there is no file none.csv\n  help: name a table",
        ),
        (
            &["push=push.csv", "--input", "push=push.csv"],
            "the input \"push\" is given twice",
        ),
        (
            &["push=push.csv", "--set", "push=1 N"],
            "has a value from --set, and a file from --input",
        ),
        (&["push"], "give an input and its file"),
    ] {
        let arguments = [&["run", "cart.yaml", "--no-files", "--input"], arguments].concat();
        let (_, told) = call(directory, &arguments, 2);
        assert!(told.contains(said), "{arguments:?}: {told}");
    }
    let two = [
        "run",
        "cart.yaml",
        "--no-files",
        "--input",
        "push=two.csv, right",
    ];
    call(directory, &two, 0);
}
