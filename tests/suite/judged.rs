//! `bryant criteria`: recordings with closed forms, by names and by channel codes.

use super::called::call;
use super::directory;
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

const G: f64 = 9.80665;

/// A table at 10 kHz, 100 ms long, of columns with units.
fn table(path: &Path, every: f64, columns: &[(&str, &dyn Fn(f64) -> f64)]) {
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let mut text = format!("time [s],{}\n", names.join(","));
    for i in 0..=(0.1 / every).round() as u32 {
        let t = f64::from(i) * every;
        let values: Vec<String> = columns.iter().map(|(_, of)| of(t).to_string()).collect();
        text.push_str(&format!("{t},{}\n", values.join(",")));
    }
    fs::write(path, text).unwrap();
}

/// A half-sine of this length from 20 ms on.
fn half_sine(size: f64, length: f64) -> impl Fn(f64) -> f64 {
    move |t| match (0.02..=0.02 + length).contains(&t) {
        true => size * (PI * (t - 0.02) / length).sin(),
        false => 0.0,
    }
}

fn judged(path: &Path, arguments: &[&str]) -> Value {
    let all = [&["criteria", "test.csv", "--json"], arguments].concat();
    serde_json::from_str(&call(path, &all, 0).0).unwrap()
}

fn value(judged: &Value, name: &str) -> f64 {
    let all = judged["criteria"].as_array().unwrap();
    let one = all.iter().find(|one| one["criterion"] == name).unwrap();
    one["value"].as_f64().unwrap_or_else(|| panic!("{one}"))
}

#[test]
fn pulses_have_the_criteria_of_their_closed_forms() {
    let directory = directory();
    let path = directory.path();
    let (head, chest) = (half_sine(100.0, 0.02), half_sine(59.9, 0.06));
    let (deflection, femur) = (half_sine(-50.0, 0.06), half_sine(-12e3, 0.06));
    table(
        &path.join("test.csv"),
        1e-4,
        &[
            ("head [g]", &head),
            ("11CHST0000H3ACXC [g]", &chest),
            ("11CHST0000H3ACYC [g]", &|_| 0.0),
            ("11CHST0000H3ACZC [g]", &|_| 0.0),
            ("11CHST0000H3DSX0 [mm]", &deflection),
            ("11FEMRLE00H3FOZB [N]", &femur),
        ],
    );
    let of_head = [
        "--standard",
        "fmvss 208",
        "--dummy",
        "hybrid iii 50m",
        "--place",
        "head=head",
    ];
    let found = judged(path, &of_head);
    // without a filter: 829.29, 3 ms between 98.6 and 97.2 of each; CFC1000 and CFC180 take less than 0.1 % of pulses of 20 and 60 ms
    let near = |name: &str, exact: f64| {
        let found = value(&found, name);
        assert!(
            (found / exact - 1.0).abs() < 1e-3,
            "{name}: {found} {exact}"
        );
    };
    near("HIC15", 829.291299083);
    near("chest 3 ms", 59.9 * (1.5e-3 * PI / 0.06).cos());
    near("chest deflection", 50.0);
    near("femur left", 12e3);
    let criteria = found["criteria"].as_array().unwrap();
    let one = |name: &str| {
        criteria
            .iter()
            .find(|one| one["criterion"] == name)
            .unwrap()
    };
    assert_eq!(
        (&one("HIC15")["met"], &one("chest 3 ms")["met"]),
        (&false.into(), &true.into())
    );
    assert_eq!(one("femur right")["missing"], "femur-right");
    let (text, _) = call(path, &[&["criteria", "test.csv"], &of_head[..]].concat(), 0);
    assert!(
        text.contains("MISSED by 18 %") && text.contains("filtered as a resultant"),
        "{text}"
    );
    assert!(
        text.contains("not judged") && text.contains("femur right (femur-right)"),
        "{text}"
    );
    // D = A sin ω t: S A² ω/(2 D₀)
    let of_chest = judged(path, &["--standard", "UN R94", "--dummy", "Hybrid III 50M"]);
    assert!(
        (value(&of_chest, "VC") / 0.3715493 - 1.0).abs() < 2e-3,
        "{of_chest}"
    );
}

/// 100 g along x and z at once: the resultant of components, in the plane without y.
#[test]
fn a_resultant_is_of_filtered_components() {
    let directory = directory();
    let path = directory.path();
    let pulse = half_sine(100.0 * G / 2f64.sqrt(), 0.02);
    table(
        &path.join("test.csv"),
        1e-4,
        &[
            ("11HEADCG00H3ACX0 [m/s^2]", &pulse),
            ("11HEADCG00H3ACZ0 [m/s^2]", &pulse),
        ],
    );
    let arguments = ["--standard", "UN R94", "--dummy", "Hybrid III 50M"];
    // y is missing, and nobody has said that it is 0
    let (_, error) = call(
        path,
        &[&["criteria", "test.csv"], &arguments[..]].concat(),
        2,
    );
    assert!(error.contains("no channel that a criterion"), "{error}");
    let found = judged(path, &[&arguments[..], &["--planar"]].concat());
    assert!(
        (value(&found, "HIC36") / 829.291299083 - 1.0).abs() < 1e-3,
        "{found}"
    );
}

#[test]
fn a_criterion_is_refused_where_it_would_be_wrong() {
    let directory = directory();
    let path = directory.path();
    let head = half_sine(100.0, 0.02);
    let one = |column: &str, every: f64| {
        table(&path.join("test.csv"), every, &[(column, &head)]);
        let arguments = [
            "criteria",
            "test.csv",
            "--standard",
            "FMVSS 208",
            "--dummy",
            "Hybrid III 50M",
        ];
        let place = format!("head={}", column.split(" [").next().unwrap());
        call(path, &[&arguments[..], &["--place", &place]].concat(), 2).1
    };
    let coarse = one("head [g]", 2e-4);
    assert!(
        coarse.contains("HIC15") && coarse.contains("CFC1000 needs a sample every 0.100 ms"),
        "{coarse}"
    );
    let filtered = one("11HEADCG00H3ACRD [g]", 1e-4);
    assert!(
        filtered.contains("filtered by CFC60 already, and CFC1000 is wanted"),
        "{filtered}"
    );
    let unit = one("head [N]", 1e-4);
    assert!(unit.contains("its unit is `N`"), "{unit}");
    let (_, unknown) = call(
        path,
        &[
            "criteria",
            "test.csv",
            "--standard",
            "FMVSS 208",
            "--dummy",
            "Hybrid IV",
        ],
        2,
    );
    assert!(unknown.contains("UN R94, Hybrid III 50M"), "{unknown}");
    for (place, told) in [
        ("nose=head", "there is no place \"nose\""),
        ("head=nose", "no channel \"nose\""),
    ] {
        let arguments = [
            "criteria",
            "test.csv",
            "--standard",
            "FMVSS 208",
            "--dummy",
            "Hybrid III 50M",
            "--place",
            place,
        ];
        let (_, error) = call(path, &arguments, 2);
        assert!(error.contains(told), "{error}");
    }
    let (listed, _) = call(path, &["criteria", "--list"], 0);
    assert!(
        listed.contains("FMVSS 208, CRABI 12M") && listed.contains("49 CFR 571.208"),
        "{listed}"
    );
}

/// A run is judged by samples of its own, and by the words of a recording of it.
#[test]
fn a_run_is_judged_as_its_recording_is() {
    let directory = directory();
    let path = directory.path();
    let places = [
        "--place",
        "head=head accelerometer",
        "--place",
        "chest=chest accelerometer",
    ];
    let judge = [
        &[
            "run",
            "child-seat",
            "--no-files",
            "--json",
            "--criteria",
            "FMVSS 208, Hybrid III 3YO",
        ],
        &places[..],
    ]
    .concat();
    let run: Value = serde_json::from_str(&call(path, &judge, 0).0).unwrap();
    let fine = [
        "run",
        "child-seat",
        "--every",
        "0.1 ms",
        "--csv",
        "test.csv",
        "--no-files",
    ];
    call(path, &fine, 0);
    let recording = judged(
        path,
        &[
            &["--standard", "FMVSS 208", "--dummy", "Hybrid III 3YO"],
            &places[..],
        ]
        .concat(),
    );
    // two seconds of rows of 2 ms in the one, of 0.1 ms in the other
    assert_eq!(run["criteria"], recording);
    assert!(value(&recording, "HIC15") > 100.0, "{recording}");
    let (text, _) = call(
        path,
        &[
            &[
                "run",
                "child-seat",
                "--no-files",
                "--report",
                "r.html",
                "--criteria",
                "FMVSS 208, Hybrid III 3YO",
            ],
            &places[..],
        ]
        .concat(),
        0,
    );
    assert!(text.contains("HIC15") && text.contains("met by"), "{text}");
    let page = fs::read_to_string(path.join("r.html")).unwrap();
    assert!(page.contains("\"standard\":\"FMVSS 208\""));
    for (arguments, told) in [
        (
            &["--criteria", "FMVSS 208"][..],
            "give a regulation and a dummy",
        ),
        (
            &["--criteria", "FMVSS 999, Hybrid III 50M"],
            "there are those of FMVSS 208",
        ),
        (&["--place", "head=head accelerometer"], "add --criteria"),
        (
            &[
                "--criteria",
                "UN R94, Hybrid III 50M",
                "--place",
                "head=nose",
            ],
            "no channel \"nose\"",
        ),
        (
            &[
                "--criteria",
                "UN R94, Hybrid III 50M",
                "--place",
                "femur-left=head accelerometer",
            ],
            "its unit is",
        ),
    ] {
        let (_, error) = call(
            path,
            &[&["run", "child-seat", "--no-files"], arguments].concat(),
            2,
        );
        assert!(error.contains(told), "{arguments:?}: {error}");
    }
}
