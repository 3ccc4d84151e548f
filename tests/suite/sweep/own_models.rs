//! Models that are not bundled: running them needs no compiler, and merging needs no model.

use super::folder::{Table, assert_same};
use crate::command_call::{bryant, call, expect};
use std::path::Path;

/// A ball under gravity whose initial height is a parameter: z(T) = z₀ + v₀ T − g T²/2 in closed form.
const BALL: &str = "\
model: ball
dimension: 2
parameters:
  gravity: { value: 9.81 m/s^2, min: 0 m/s^2, max: 30 m/s^2 }
systems:
  - name: ball
    elements: [{ name: body, mass: 2 kg, cg: [0, 0], inertia: 1 kg*m^2 }]
    start: { velocity: [1 m/s, 4 m/s] }
forces:
  - { field: earth, acceleration: [0, -gravity] }
outputs:
  - { name: height, of: ball/body, what: position, component: z }
run: { duration: 0.5 s, every: 10 ms }
";

const FALLS: &str = "\
model: ../models/ball.yaml
design: latin hypercube
runs: 64
parameters: { gravity: { from: 1 m/s^2, to: 20 m/s^2 } }
responses: [{ of: height, what: final }, { of: height, what: peak }]
keep: { runs: [40] }
tables: [csv, parquet]
";

/// A ball that a force lifts, starting some time after the ball was at a height: memory decides where it ends.
const LIFTED: &str = "\
model: lifted
dimension: 2
parameters:
  height: { value: 0.5 m, min: 0 m, max: 0.79 m }
  delay: { value: 30 ms, min: 0 s, max: 1 s }
systems:
  - name: ball
    elements: [{ name: body, mass: 2 kg, cg: [0, 0], inertia: 1 kg*m^2 }]
    start: { velocity: [0, 4 m/s] }
forces:
  - { field: gravity, acceleration: [0, -10 m/s^2] }
  - { load: lift, on: ball/body, force: [0, 8 N], since: later }
switches:
  - { switch: high, when: { of: ball/body, what: position, component: z, above: height } }
  - { switch: later, when: { of: ball/body, what: position, component: z, above: height }, after: delay }
outputs:
  - { name: z, of: ball/body, what: position, component: z }
  - { name: high, of: switch high, what: time }
run: { duration: 0.6 s, every: 10 ms }
";

const LIFTS: &str = "\
model: lifted.yaml
design: sobol
runs: 64
parameters:
  height: { from: 0.1 m, to: 0.7 m }
  delay: { from: 0 s, to: 0.2 s }
responses: [{ of: z, what: final }, { of: high, what: final }]
tables: [csv]
";

/// Runs without a compiler.
#[track_caller]
fn without_compiler(at: &Path, arguments: &[&str]) -> (String, String) {
    let mut command = bryant(at);
    command.args(arguments);
    command.env("RUSTC", "/nonexistent/rustc");
    command.env("BRYANT_CACHE", at.join("no-cache"));
    expect(command.output().unwrap(), arguments, 0)
}

#[test]
fn a_model_of_ones_own_needs_no_compiler() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    for folder in ["models", "studies"] {
        std::fs::create_dir(at.join(folder)).unwrap();
    }
    std::fs::write(at.join("models/ball.yaml"), BALL).unwrap();
    std::fs::write(at.join("studies/falls.yaml"), FALLS).unwrap();
    let study = "studies/falls.yaml";

    call(
        at,
        &["sweep", study, "--out", "shared", "--shard", "1/2"],
        0,
    );
    without_compiler(at, &["sweep", study, "--out", "shared", "--shard", "0/2"]);

    // a block is lost; the study continues from there
    std::fs::remove_file(at.join("shared/blocks/00000002.part")).unwrap();
    let (_, said) = call(at, &["merge", "shared", "--shards", "2"], 2);
    assert!(said.contains("1 of 4 blocks are missing: 2"), "{said}");
    assert!(said.contains("of shards 0 of 2"), "{said}");
    let (_, said) = without_compiler(at, &["sweep", study, "--out", "shared"]);
    assert!(
        said.contains("16 runs in") && said.contains("48 were there"),
        "{said}"
    );

    call(
        at,
        &[
            "sweep",
            study,
            "--out",
            "single",
            "--threads",
            "1",
            "--lanes",
            "1",
        ],
        0,
    );
    // merging needs neither study nor model
    std::fs::remove_dir_all(at.join("models")).unwrap();
    std::fs::remove_dir_all(at.join("studies")).unwrap();
    std::fs::remove_file(at.join("shared/results.csv")).unwrap();
    without_compiler(at, &["merge", "shared"]);
    assert_same(&at.join("single"), &at.join("shared"));

    let table = Table::read(&at.join("shared/results.csv"));
    let (gravity, last) = (
        table.numbers("gravity [m/s^2]"),
        table.numbers("final of height [m]"),
    );
    let peak = table.numbers("peak of height [m]");
    for row in 0..64 {
        let g = gravity[row];
        // a parabola, which every method integrates exactly up to rounding; its peak lies between samples, 0.5 ms apart
        let exact = 4.0 * 0.5 - g * 0.5 * 0.5 / 2.0;
        assert!((last[row] - exact).abs() < 1e-12, "{} {exact}", last[row]);
        let exact = if 4.0 / g < 0.5 {
            16.0 / (2.0 * g)
        } else {
            exact
        };
        let between = g * 0.25e-3 * 0.25e-3 / 2.0 + 1e-12;
        assert!(
            (peak[row] - exact).abs() <= between,
            "{} {exact}",
            peak[row]
        );
    }
}

#[test]
fn what_a_model_remembers_is_of_each_run() {
    let directory = tempfile::tempdir().unwrap();
    let at = directory.path();
    std::fs::write(at.join("lifted.yaml"), LIFTED).unwrap();
    std::fs::write(at.join("lifts.yaml"), LIFTS).unwrap();
    call(at, &["sweep", "lifts.yaml", "--out", "results"], 0);
    let narrow = ["--lanes", "1", "--threads", "1"];
    call(
        at,
        &[&["sweep", "lifts.yaml", "--out", "alone"], &narrow[..]].concat(),
        0,
    );
    assert_same(&at.join("results"), &at.join("alone"));

    let table = Table::read(&at.join("results/results.csv"));
    let (height, delay) = (table.numbers("height [m]"), table.numbers("delay [s]"));
    let (last, high) = (
        table.numbers("final of z [m]"),
        table.numbers("final of high [s]"),
    );
    for row in 0..64 {
        // z = 4 t − 5 t² is the height; from t on, 8 N lift 2 kg
        let at_height = (4.0 - (16.0 - 20.0 * height[row]).sqrt()) / 10.0;
        assert!(
            (high[row] - at_height).abs() < 1e-9,
            "{} {at_height}",
            high[row]
        );
        let t = at_height + delay[row];
        let left = 0.6 - t;
        let exact = 4.0 * t - 5.0 * t * t + (4.0 - 10.0 * t) * left - 3.0 * left * left;
        assert!((last[row] - exact).abs() < 1e-9, "{} {exact}", last[row]);
    }
}
