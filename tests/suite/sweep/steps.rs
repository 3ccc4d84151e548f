//! Studies with fixed steps, and in single precision.

use super::directory;
use super::folder::{Table, assert_same};
use crate::command_call::call;
use crate::share::share;
use bryant_runtime::Width;
use std::path::Path;

/// Sixteen runs of the seat; `settings` are the last settings of their `run`.
fn write(at: &Path, name: &str, settings: &str) {
    let few = super::SEAT
        .replace("runs: 160", "runs: 16")
        .replace("117", "11")
        .replace("sampling: 0.1 ms", &format!("sampling: 0.1 ms, {settings}"));
    std::fs::write(at.join(name), few).unwrap();
}

/// Checks that no response of a table deviates by more than this share.
fn near(found: &Table, expected: &Table, bound: f64) {
    for response in ["lap [N]", "injury", "three [m/s^2]", "late [m]"] {
        let pairs = found
            .numbers(response)
            .into_iter()
            .zip(expected.numbers(response));
        for (row, (found, expected)) in pairs.enumerate() {
            let error = (found / expected - 1.0).abs();
            assert!(error <= bound, "{response} of {row}: {error:e}");
        }
    }
}

#[test]
fn fixed_steps_agree_in_all_lanes_and_with_an_accurate_run() {
    let directory = directory();
    let at = directory.path();
    write(at, "sharp.yaml", "accuracy: 1e-6");
    call(at, &["sweep", "sharp.yaml", "--out", "sharp"], 0);
    let sharp = Table::read(&at.join("sharp/results.csv"));
    for method in share(2, ["heun", "rk4", "merson", "dopri5"]) {
        write(
            at,
            "steps.yaml",
            &format!("step: 0.05 ms, method: {method}"),
        );
        call(at, &["sweep", "steps.yaml", "--out", method], 0);
        let table = Table::read(&at.join(method).join("results.csv"));
        assert!(table.words("status").iter().all(|status| *status == "done"));
        // 60 ms in steps of 0.05 ms, some of them shortened by switches or on the way to a kink of the pulse
        let steps = table.numbers("steps");
        assert!(
            steps.iter().all(|steps| (1200.0..1300.0).contains(steps)),
            "{steps:?}"
        );
        let told = table.numbers("error estimate");
        assert!(told.iter().all(|told| *told < 1e-2), "{told:?}");
        // kinks are anywhere in the steps of a run and of its twin: in one row both may have the same error, but not in
        // all
        let most = told.iter().fold(0.0, |most: f64, told| most.max(*told));
        near(&table, &sharp, most);
        for width in Width::ALL.iter().filter(|width| width.is_available()) {
            let folder = format!("{method}-{}", width.name());
            let arguments = ["sweep", "steps.yaml", "--out", &folder];
            call(
                at,
                &[&arguments[..], &["--lanes", width.name()]].concat(),
                0,
            );
            assert_same(&at.join(method), &at.join(&folder));
        }
    }
    // rk4 is the default method of fixed steps
    write(at, "steps.yaml", "step: 0.05 ms, method: rk4");
    call(at, &["sweep", "steps.yaml", "--out", "rk4"], 0);
    write(at, "steps.yaml", "step: 0.05 ms");
    call(at, &["sweep", "steps.yaml", "--out", "said-nothing"], 0);
    let [said, nothing] = ["rk4", "said-nothing"]
        .map(|folder| std::fs::read(at.join(folder).join("results.csv")).unwrap());
    assert!(said == nothing);
    let (_, said) = call(at, &["sweep", "steps.yaml", "--out", "sharp"], 2);
    assert!(said.contains("differs: the study"), "{said}");
}

#[test]
fn single_precision_keeps_its_accuracy_and_is_not_mixed_in() {
    let directory = directory();
    let at = directory.path();
    write(at, "sharp.yaml", "accuracy: 1e-6");
    write(at, "doubles.yaml", "accuracy: 1 %");
    write(at, "singles.yaml", "accuracy: 1 %, precision: single");
    for name in ["sharp", "doubles", "singles"] {
        let study = format!("{name}.yaml");
        call(at, &["sweep", &study, "--out", name], 0);
    }
    let [sharp, singles] =
        ["sharp", "singles"].map(|name| Table::read(&at.join(name).join("results.csv")));
    assert!(
        singles
            .words("status")
            .iter()
            .all(|status| *status == "done")
    );
    near(&singles, &sharp, 1e-2);
    for response in ["lap [N]", "late [m]"] {
        let single = |value: &f64| f64::from(*value as f32) == *value;
        assert!(singles.numbers(response).iter().all(single));
    }
    let arithmetic = std::fs::read_to_string(at.join("singles/study.json")).unwrap();
    assert!(arithmetic.contains("f32, fused"));

    for (study, folder) in [("singles.yaml", "doubles"), ("doubles.yaml", "singles")] {
        let (_, said) = call(at, &["sweep", study, "--out", folder], 2);
        assert!(said.contains("differs"), "{said}");
    }
    let wide = Width::ALL.into_iter().filter(|width| width.is_available());
    for width in wide {
        let folder = format!("singles-{}", width.name());
        let arguments = ["sweep", "singles.yaml", "--out", &folder];
        call(
            at,
            &[&arguments[..], &["--lanes", width.name()]].concat(),
            0,
        );
        let [one, other] = ["singles", &folder]
            .map(|folder| std::fs::read(at.join(folder).join("results.csv")).unwrap());
        assert!(one == other, "{width:?}");
    }
}
