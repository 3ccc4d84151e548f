//! The last screen of a run: what a person sees of it who scrolls nothing.

use super::command_call::call;
use super::{directory, json, numbers};

/// Lines and characters of a line of a terminal that nobody made larger.
const SCREEN: (usize, usize) = (24, 80);

#[test]
fn the_result_of_a_run_fits_on_one_screen() {
    let directory = directory();
    for (model, words) in [
        ("child-seat", &["head accelerometer", "head excursion"][..]),
        ("child-restraint", &["met by", "HIC", "remarks 4"]),
        ("frontal", &["met by", "Nij", "femur left"]),
    ] {
        let (told, wrote) = call(directory.path(), &["run", model, "--quiet"], 0);
        let lines: Vec<&str> = told.trim().lines().collect();
        assert!(lines[0].starts_with(&format!("{model}: ")), "{told}");
        let widest = lines.iter().map(|line| line.chars().count()).max();
        // what follows is one line with the names of files
        assert!(lines.len() < SCREEN.0 && widest <= Some(SCREEN.1), "{told}");
        for word in words {
            assert!(told.contains(word), "{word}: {told}");
        }
        for begin in ["energy  closes to ", "trust   every output within "] {
            assert!(
                lines.iter().any(|line| line.starts_with(begin)),
                "{begin}{told}"
            );
        }
        let files = format!("wrote {model}.csv, {model}.svg");
        assert_eq!(wrote.lines().last(), Some(&files[..]), "{wrote}");
    }
}

/// A rod on a spring, pushed from its rest: φ = −(3/ω) sin ωt with ω² = 40/s².
const SWING: &str = "\
model: swing
dimension: 2
systems:
  - name: s
    reference: fixed
    elements: [{ name: rod, mass: 1, cg: [0, 0], inertia: 1 }]
    start: { rates: { rod: -3 } }
forces: [{ joint: s/rod, elastic: { points: [[-2, -80], [2, 80]], extrapolate: linear } }]
outputs: [{ name: angle, of: s/rod, what: angle }, { name: rate, of: s/rod, what: angular_velocity }]
run: { duration: 0.4 s, every: 0.1 s }
";

#[test]
fn peaks_are_between_rows_and_have_their_sign() {
    let directory = tempfile::tempdir().unwrap();
    let model = SWING;
    std::fs::write(directory.path().join("swing.yaml"), model).unwrap();
    let (out, _) = call(
        directory.path(),
        &["run", "swing.yaml", "--no-files", "--json"],
        0,
    );
    let value = json(&out);
    let w = 40f64.sqrt();
    let expected = [
        ("angle", -3.0 / w, std::f64::consts::FRAC_PI_2 / w),
        // the first of two that are equal
        ("rate", -3.0, 0.0),
    ];
    let peaks = value["peaks"].as_array().unwrap();
    assert_eq!(peaks.len(), 2, "{value}");
    for (peak, (name, size, time)) in peaks.iter().zip(expected) {
        assert_eq!(peak["output"], name);
        let found = numbers(&serde_json::json!([peak["value"], peak["time_s"]]));
        // samples are 20 ms apart: of an extremum (ωh/2)²/2 = 0.2 % at most is lost, and its time is that of a parabola
        assert!((found[0] - size).abs() < 2e-3 * size.abs(), "{peaks:?}");
        assert!((found[1] - time).abs() < 2e-3, "{peaks:?}");
    }
}
