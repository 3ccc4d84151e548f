//! `bryant criteria`: recordings with closed forms, with places by names and by channel codes.

use super::command_call::call;
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

/// A half-sine of this length that begins at 20 ms.
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
    // without a filter: 829.29, and 3 ms between 98.6 and 97.2 of each; CFC1000 and CFC180 reduce pulses of 20 and 60
    // ms by less than 0.1 %
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

/// A force of this size that lasts so long \[s\], from 10 ms on. Its edges lie between two samples.
fn rectangle(size: f64, length: f64) -> impl Fn(f64) -> f64 {
    move |t| match (0.01 - 1e-6..=0.01 + length + 1e-6).contains(&t) {
        true => size,
        false => 0.0,
    }
}

/// Limits of UN R94 that fall with the duration of a force: a rectangle at each corner, one that is a little higher,
/// one that lasts a little longer. What is seen without a formula: behind the last corner a force may last; regulations
/// with one limit judge the peak.
#[test]
fn limits_fall_with_the_duration_of_a_force() {
    let directory = directory();
    let path = directory.path();
    // the class is that of the criterion, so nothing is filtered
    for (criterion, column, corners) in [
        (
            "neck tension",
            "11NECKUP00H3FOZA [kN]",
            &[(35e-3, 2.9), (60e-3, 1.1)][..],
        ),
        (
            "neck shear",
            "11NECKUP00H3FOXA [kN]",
            &[(25e-3, -1.5), (35e-3, 1.5), (45e-3, -1.1)],
        ),
        ("femur left", "11FEMRLE00H3FOZB [kN]", &[(10e-3, -7.58)]),
    ] {
        let row = |size: f64, length: f64, standard: &str| -> Value {
            let force = rectangle(size, length);
            table(&path.join("test.csv"), 1e-4, &[(column, &force)]);
            let found = judged(path, &["--standard", standard, "--dummy", "Hybrid III 50M"]);
            let all = found["criteria"].as_array().unwrap();
            let one = all.iter().find(|one| one["criterion"] == criterion);
            one.unwrap_or(&Value::Null).clone()
        };
        let near = |found: &Value, expected: f64| {
            let found = found.as_f64().unwrap();
            assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
        };
        for (index, (length, size)) in corners.iter().enumerate() {
            let (length, size): (f64, f64) = (*length, *size);
            let newton = 1e3 * size.abs();
            let kept = row(size, length, "UN R94");
            near(&kept["value"], newton);
            near(&kept["limit"], newton);
            near(&kept["duration"], length);
            assert_eq!(kept["met"], true, "{kept}");
            let said = format!("exceeded for {:.1} ms in total", 1e3 * length);
            assert!(kept["detail"].as_str().unwrap().contains(&said), "{kept}");
            let higher = row(1.002 * size, length, "UN R94");
            near(&higher["value"], 1.002 * newton);
            near(&higher["limit"], newton);
            assert_eq!(higher["met"], false, "{higher}");
            // half of the way to the next corner, the limit is half of the way, too
            let longer = match corners.get(index + 1) {
                Some((next, level)) => {
                    let half = row(size, 0.5 * (length + next), "UN R94");
                    let level = f64::abs(*level);
                    near(&half["limit"], 0.5 * (newton + 1e3 * level));
                    (half, size.abs() == level)
                }
                None => (row(size, length + 0.02, "UN R94"), true),
            };
            assert_eq!(longer.0["met"], longer.1, "{}", longer.0);
        }
        // no force lasts at its peak
        let short = row(3.0, 0.0, "UN R94");
        near(&short["value"], 3000.0);
        assert_eq!(short["detail"], "its peak");
        let other = row(corners[0].1, 50e-3, "UN R137");
        assert!(
            other["duration"].is_null() && other["met"] == true,
            "{other}"
        );
    }
    let (listed, _) = call(path, &["criteria", "--list"], 0);
    assert!(
        listed.contains("3300 N at 0 ms, 2900 N at 35 ms, 1100 N at 60 ms"),
        "{listed}"
    );
}

/// A head that is pulled up by 2 kN, less where the pull begins and ends.
const PULLED: &str = "model: pulled
dimension: 3
parameters: { pull: { value: 2 kN, min: 0, max: 9 kN } }
curves: { pulse: { unit: [ms, 1], points: [[0, 0], [10, 1], [60, 1], [70, 0], [90, 0]] } }
systems:
  - name: man
    reference: fixed
    elements:
      - { name: chest, mass: 1e6 kg, cg: [0, 0, 0.1], inertia: [1e6, 1e6, 1e6] }
      - { name: head, on: chest, at: [0, 0, 0.25], joint: weld, mass: 4.5 kg, cg: [0, 0, 0.12], inertia: [0.03, 0.03, 0.03] }
forces:
  - { load: hand, on: man/head, at: cg, force: [0, 0, { curve: pulse, times: pull }] }
criteria: { standard: UN R94, dummy: Hybrid III 50M, neck: man/head }
run: { duration: 90 ms, every: 0.1 ms }
";

/// The trapezium exceeds F (1 - u) for 50 ms + 20 ms u. Beside the limit of this duration that is largest at its top:
/// 2000 N for 50 ms, where 1820 N are allowed. A run says so, and its recording; a study and a gradient have the ratio.
#[test]
fn a_force_that_lasts_is_the_same_in_every_command() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("pulled.yaml"), PULLED).unwrap();
    let run = [
        "run",
        "pulled.yaml",
        "--no-files",
        "--json",
        "--csv",
        "test.csv",
    ];
    let run: Value = serde_json::from_str(&call(path, &run, 0).0).unwrap();
    let places = ["--place", "neck-fx=neck-fx", "--place", "neck-fz=neck-fz"];
    let limits = ["--standard", "UN R94", "--dummy", "Hybrid III 50M"];
    let recording = judged(path, &[&limits[..], &places].concat());
    for judged in [&run["criteria"], &recording] {
        let all = judged["criteria"].as_array().unwrap();
        let one = all
            .iter()
            .find(|one| one["criterion"] == "neck tension")
            .unwrap();
        // the filter of CFC1000 rounds the corners of the trapezium off, by less than 1 %
        let near = |key: &str, expected: f64| {
            let found = one[key].as_f64().unwrap();
            assert!((found / expected - 1.0).abs() < 1e-2, "{key}: {one}");
        };
        near("value", 2000.0);
        near("limit", 1820.0);
        near("duration", 50e-3);
        assert_eq!(one["met"], false, "{one}");
    }
    let ratio = value(&run["criteria"], "neck tension") / 1820.0;
    let of = [
        "gradient",
        "pulled.yaml",
        "--of",
        "neck tension",
        "--wrt",
        "pull",
        "--json",
    ];
    let slope: Value = serde_json::from_str(&call(path, &of, 0).0).unwrap();
    // the ratio is in proportion to the pull
    let found = numbers(&slope);
    let has = |found: &[f64], wanted: f64| found.iter().any(|x| (x / wanted - 1.0).abs() < 1e-2);
    assert!(has(&found, ratio) && has(&found, ratio / 2000.0), "{slope}");
    let study = "model: pulled.yaml\ntables: [csv]\ndesign: grid\nparameters: { pull: { values: [1 kN, 2 kN] } }\nresponses: [{ criterion: all }]\n";
    fs::write(path.join("study.yaml"), study).unwrap();
    call(path, &["sweep", "study.yaml", "--out", "rows"], 0);
    let rows = fs::read_to_string(path.join("rows/results.csv")).unwrap();
    let cells = rows.lines().skip(1).flat_map(|line| line.split(','));
    let cells: Vec<f64> = cells.filter_map(|cell| cell.parse().ok()).collect();
    assert!(has(&cells, ratio) && has(&cells, 0.5 * ratio), "{rows}");
}

/// 100 g along x and z at once: the resultant of the components, without y in the plane.
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
    // y is missing, and the user has not said that it is 0
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

/// A channel: its code, unit and status, and its values over time.
type Recorded<'a> = (&'a str, &'a str, &'a str, &'a dyn Fn(f64) -> f64);

/// A test in ISO-MME, with values at 10 kHz.
fn test_of(path: &Path, channels: &[Recorded<'_>]) {
    let inner = path.join("test/Channel");
    fs::remove_dir_all(path.join("test")).ok();
    fs::create_dir_all(&inner).unwrap();
    fs::write(
        path.join("test/t1.mme"),
        "Data format edition number  :1.6\n",
    )
    .unwrap();
    for (index, (code, unit, status, of)) in channels.iter().enumerate() {
        let mut text = format!(
            "Channel code                :{code}\nUnit                        :{unit}\nReference channel           :implicit\n\
             Data status                 :{status}\nSampling interval           :0.0001\nTime of first sample        :0\n"
        );
        for i in 0..=1000 {
            text.push_str(&format!("{}\n", of(f64::from(i) * 1e-4)));
        }
        fs::write(inner.join(format!("t1.{:03}", index + 1)), text).unwrap();
    }
}

const BY_208: [&str; 6] = [
    "criteria",
    "test",
    "--standard",
    "FMVSS 208",
    "--dummy",
    "Hybrid III 50M",
];

/// HIC of a half-sine of 20 ms: 0.41464564954151 A^2.5 T \[A in g\]. Filters of CFC1000 change it by less than 0.1 %.
fn hic(size: f64) -> f64 {
    0.41464564954151 * size.powf(2.5) * 0.02
}

/// The driver has no y channel, the passenger has all three; none is mixed with the other.
#[test]
fn a_verdict_is_of_one_occupant() {
    let directory = directory();
    let path = directory.path();
    let (large, small) = (half_sine(60.0, 0.02), half_sine(30.0, 0.02));
    test_of(
        path,
        &[
            ("11HEADCG00H3ACXP", "g", "ok", &large),
            ("11HEADCG00H3ACZP", "g", "ok", &large),
            ("13HEADCG00H3ACXP", "g", "ok", &small),
            ("13HEADCG00H3ACYP", "g", "NOVALUE", &large),
            ("13HEADCG00H3ACZP", "g", "", &small),
        ],
    );
    let (_, error) = call(path, &BY_208, 2);
    assert!(
        error.contains("11 (front left")
            && error.contains("13 (front right")
            && error.contains("--occupant"),
        "{error}"
    );
    let of = |more: &[&str]| -> Value {
        let all = [&BY_208[..], &["--json"], more].concat();
        serde_json::from_str(&call(path, &all, 0).0).unwrap()
    };
    let passenger = of(&["--occupant", "13"]);
    // √(30² + 60² + 30²) = 73.485
    let expected = hic(5400f64.sqrt());
    assert!(
        (value(&passenger, "HIC15") / expected - 1.0).abs() < 1e-3,
        "{passenger}"
    );
    assert_eq!(passenger["occupant"], "13");
    let head = passenger["criteria"]
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["criterion"] == "HIC15")
        .unwrap();
    assert_eq!(head["channels"]["head-y"], "13HEADCG00H3ACYP");
    let text = call(path, &[&BY_208[..], &["--occupant", "13"]].concat(), 0).0;
    assert!(
        text.contains("occupant 13 (front right)")
            && text.contains("13HEADCG00H3ACXP, 13HEADCG00H3ACYP"),
        "{text}"
    );
    let (_, error) = call(path, &[&BY_208[..], &["--occupant", "11"]].concat(), 2);
    assert!(error.contains("no channel that a criterion"), "{error}");
    let driver = of(&["--occupant", "11", "--planar"]);
    assert!(
        (value(&driver, "HIC15") / hic(7200f64.sqrt()) - 1.0).abs() < 1e-3,
        "{driver}"
    );
    let mixed = [
        "--place",
        "head-x=11HEADCG00H3ACXP",
        "--place",
        "head-y=13HEADCG00H3ACYP",
    ];
    let (_, error) = call(path, &[&BY_208[..], &mixed].concat(), 2);
    assert!(error.contains("belongs to occupant 13"), "{error}");
}

/// Several sensors, filters and spellings: one is judged only if it is clear which.
#[test]
fn a_sensor_is_not_chosen_by_chance() {
    let directory = directory();
    let path = directory.path();
    let of = |more: &[&str]| -> Value {
        let all = [&BY_208[..], &["--json"], more].concat();
        serde_json::from_str(&call(path, &all, 0).0).unwrap()
    };
    let (least, most) = (half_sine(-20.0, 0.06), half_sine(-64.0, 0.06));
    test_of(
        path,
        &[
            ("11CHSTLEUP00DSXC", "mm", "ok", &least),
            ("11CHSTRIUP00DSXC", "mm", "ok", &least),
            ("11CHSTLELO00DSXC", "mm", "ok", &least),
            ("11CHSTRILO00DSXC", "mm", "ok", &most),
        ],
    );
    let (_, error) = call(path, &BY_208, 2);
    assert!(
        error.contains("several channels could be chest-deflection")
            && error.contains("11CHSTRILO00DSXC")
            && error.contains("--place"),
        "{error}"
    );
    let found = of(&["--place", "chest-deflection=11CHSTRILO00DSXC"]);
    assert!(
        (value(&found, "chest deflection") - 64.0).abs() < 0.05,
        "{found}"
    );
    let row = found["criteria"]
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["criterion"] == "chest deflection")
        .unwrap();
    assert_eq!(
        (&row["filter"], &row["met"]),
        (&"CFC600".into(), &false.into())
    );
    assert!(
        row["detail"]
            .as_str()
            .unwrap()
            .contains("filtered by CFC180 before"),
        "{row}"
    );

    // the head by its other spelling, a redundant sensor, and a 3 ms value that is no time history
    let (head, other) = (half_sine(60.0, 0.02), half_sine(20.0, 0.02));
    let nothing = |_: f64| 0.0;
    test_of(
        path,
        &[
            ("11CHST003CH3ACRX", "g", "ok", &head),
            ("11HEADCGRDH3ACXA", "g", "ok", &other),
            ("11HEADCGRDH3ACYA", "g", "ok", &nothing),
            ("11HEADCGRDH3ACZA", "g", "ok", &nothing),
            ("11HEAD0000H3ACXC", "g", "ok", &other),
            ("11HEAD0000H3ACXA", "g", "ok", &head),
            ("11HEAD0000H3ACYP", "g", "ok", &nothing),
            ("11HEAD0000H3ACZ0", "g", "ok", &nothing),
        ],
    );
    let (_, error) = call(path, &BY_208, 2);
    assert!(
        error.contains("11HEADCGRDH3ACXA") && error.contains("11HEAD0000H3ACXA"),
        "{error}"
    );
    for (pattern, size, channel) in [
        ("??HEAD00*", 60.0, "11HEAD0000H3ACXA"),
        ("??HEADCGRD*", 20.0, "11HEADCGRDH3ACXA"),
    ] {
        let found = of(&["--place", &format!("head={pattern}")]);
        assert!(
            (value(&found, "HIC15") / hic(size) - 1.0).abs() < 1e-3,
            "{found}"
        );
        let row = &found["criteria"][0];
        assert_eq!(row["channels"]["head-x"], channel, "{row}");
        let chest = found["criteria"]
            .as_array()
            .unwrap()
            .iter()
            .find(|one| one["criterion"] == "chest 3 ms")
            .unwrap();
        assert_eq!(chest["missing"], "chest");
    }
}

/// What its file says of a channel is heard by every command.
#[test]
fn a_channel_that_failed_is_not_used() {
    let directory = directory();
    let path = directory.path();
    let (head, nothing) = (half_sine(60.0, 0.02), |_: f64| 0.0);
    let test = |status: &str| {
        test_of(
            path,
            &[
                ("11HEADCG00H3ACXP", "g", status, &head),
                ("11HEADCG00H3ACYP", "g", "ok", &nothing),
                ("11HEADCG00H3ACZP", "g", "ok", &nothing),
                // computed of the channel that failed
                ("11HEADCG00H3ACRA", "g", "ok", &head),
            ],
        );
    };
    test("ok");
    call(path, &BY_208, 0);
    for status in [
        "channel failed",
        "no data",
        "Meaningless Data",
        "questionable data",
    ] {
        test(status);
        let (_, error) = call(path, &BY_208, 2);
        assert!(
            error.contains("11HEADCG00H3ACXP") && error.contains(status),
            "{error}"
        );
    }
    let named = [&BY_208[..], &["--place", "head-x=11HEADCG00H3ACXP"]].concat();
    let (text, _) = call(path, &named, 0);
    assert!(
        text.contains("its file says \"questionable data\""),
        "{text}"
    );
    let (rated, told) = call(path, &["compare", "test", "test"], 0);
    assert!(
        told.contains("11HEADCG00H3ACXP")
            && told.contains("questionable data")
            && !rated.contains("ACXP"),
        "{rated} {told}"
    );
    test_of(path, &[("11HEADCG00H3ACXP", "g", "no data", &head)]);
    let (_, error) = call(path, &["compare", "test", "test"], 2);
    assert!(
        error.contains("no channel is left") && error.contains("no data"),
        "{error}"
    );
    let (rated, told) = call(
        path,
        &[
            "compare",
            "test",
            "test",
            "--channel",
            "11HEADCG00H3ACXP=11HEADCG00H3ACXP",
        ],
        0,
    );
    assert!(
        rated.contains("ACXP") && told.contains("no data"),
        "{rated} {told}"
    );
}

/// Damages the text of a channel; `None` if it has nothing to damage.
type Damages = fn(&str) -> Option<String>;

/// What can be wrong with the file of a channel: how its text is made from a sound one; `None` stands for no file at
/// all.
const DAMAGE: [(&str, Damages); 5] = [
    ("is neither a number", |text| Some(format!("{text}x\n"))),
    ("there is no file .002 of this channel", |_| None),
    ("the file says that this is", |text| {
        Some(text.replacen("H3", "H4", 1))
    }),
    ("`Sampling interval` must be there", |text| {
        Some(text.replacen("Sampling interval", "Interval", 1))
    }),
    ("has a second value", |text| {
        Some(format!("Unit :N\n{text}"))
    }),
];

/// Damages the second channel of a test, which has this code in the list of channels.
fn damage(path: &Path, code: &str, how: fn(&str) -> Option<String>) {
    let inner = path.join("test/Channel");
    fs::write(
        inner.join("t1.chn"),
        format!("Name of channel 002 :{code}\n"),
    )
    .unwrap();
    let file = inner.join("t1.002");
    let text = fs::read_to_string(&file).unwrap();
    match how(&text) {
        Some(text) => fs::write(file, text).unwrap(),
        None => fs::remove_file(file).unwrap(),
    }
}

/// A damaged channel that the verdict does not need is left out and named; one that it needs, or might have needed, is
/// an error.
#[test]
fn a_damaged_channel_matters_where_it_might_have_been_used() {
    let directory = directory();
    let path = directory.path();
    let (head, nothing) = (half_sine(60.0, 0.02), |_: f64| 0.0);
    let test = |code: &str| {
        test_of(
            path,
            &[
                ("11HEADCG00H3ACXA", "g", "ok", &head),
                (code, "g", "ok", &nothing),
                ("11HEADCG00H3ACYA", "g", "ok", &nothing),
                ("11HEADCG00H3ACZA", "g", "ok", &nothing),
            ],
        );
    };
    for (told, how) in DAMAGE {
        // the pelvis; the resultant beside its components; another occupant, once this one is chosen
        for (code, more) in [
            ("11PELV0000H3ACYA", &[][..]),
            ("11HEADCG00H3ACRA", &[]),
            ("13HEADCG00H3ACYA", &["--occupant", "11"]),
            ("11HEADCGRDH3ACXA", &["--place", "head=??HEADCG00*"]),
        ] {
            test(code);
            damage(path, code, how);
            let all = [&BY_208[..], more, &["--json"]].concat();
            let (found, noted) = call(path, &all, 0);
            assert!(
                noted.contains(code) && noted.contains(told),
                "{code}: {noted}"
            );
            let found: Value = serde_json::from_str(&found).unwrap();
            let near = value(&found, "HIC15") / hic(60.0) - 1.0;
            assert!(near.abs() < 1e-3, "{found}");
            assert!(found["left_out"].to_string().contains(code), "{found}");
            // beside a test without this channel it is not compared either
            let sound = [("11HEADCG00H3ACXA", "g", "ok", &head as &dyn Fn(f64) -> f64)];
            fs::rename(path.join("test"), path.join("whole")).unwrap();
            test_of(path, &sound);
            let (rated, noted) = call(path, &["compare", "test", "whole"], 0);
            assert!(rated.contains("11HEADCG00H3ACXA"), "{rated}");
            assert!(noted.contains(code) && noted.contains(told), "{noted}");
            fs::remove_dir_all(path.join("whole")).unwrap();
        }
        // asked for; a component of the head; a redundant sensor; another spelling of the same head
        for (code, more) in [
            (
                "11PELV0000H3ACYA",
                &["--place", "chest=11PELV0000H3ACYA"][..],
            ),
            ("11HEADCG00H3ACYP", &[]),
            ("11HEADCGRDH3ACXA", &[]),
            ("11HEAD0000H3ACZA", &[]),
            ("11CHST0000H3DSXA", &[]),
        ] {
            test(code);
            damage(path, code, how);
            let (_, error) = call(path, &[&BY_208[..], more].concat(), 2);
            assert!(
                error.contains(code) && error.contains(told),
                "{code}: {error}"
            );
        }
        // a test beside itself compares all channels
        test("11PELV0000H3ACYA");
        damage(path, "11PELV0000H3ACYA", how);
        let (_, error) = call(path, &["compare", "test", "test"], 2);
        assert!(error.contains("11PELV") && error.contains(told), "{error}");
        let named = [
            "compare",
            "test",
            "test",
            "--channel",
            "11PELV0000H3ACYA=11HEADCG00H3ACXA",
        ];
        let (_, error) = call(path, &named, 2);
        assert!(error.contains(told), "{error}");
        let others = [
            "compare",
            "test",
            "test",
            "--channel",
            "11HEADCG00H3ACXA=11HEADCG00H3ACXA",
        ];
        let (_, noted) = call(path, &others, 0);
        assert!(noted.contains(told), "{noted}");
        // a curve of a model is refused, whatever channel it wants of a test that contradicts itself
        let model = SWUNG.replace("CODE", "11HEADCG00H3ACXA");
        fs::write(path.join("swung.yaml"), model).unwrap();
        let of_test = ["there is no file", "the file says"];
        if of_test.iter().any(|one| told.contains(one)) {
            let (_, error) = call(path, &["check", "swung.yaml"], 2);
            assert!(error.contains(told), "{error}");
        }
        let model = SWUNG.replace("CODE", "11PELV0000H3ACYA");
        fs::write(path.join("swung.yaml"), model).unwrap();
        call(path, &["check", "swung.yaml"], 2);
    }
    // it is not known which channel is missing
    test("11PELV0000H3ACYA");
    fs::write(path.join("test/Channel/t1.chn"), "Number of channels :5\n").unwrap();
    let (_, error) = call(path, &BY_208, 2);
    assert!(error.contains("the list has 5 channels"), "{error}");
}

/// A model that is moved by a channel of the test.
const SWUNG: &str = "model: swung
dimension: 2
curves: { pulse: { mme: test/t1.mme, channel: CODE } }
vehicles: [{ name: sled, acceleration: [pulse, 0] }]
systems:
  - name: arm
    reference: { on: sled, at: [0, 0] }
    elements: [{ name: a, mass: 1, cg: [0, -0.1], inertia: 0.01 }]
outputs: [{ name: swing, of: arm/a, what: angle }]
run: { duration: 10 ms, every: 1 ms }
";

/// A run is judged by its own samples, and with the same names as its recording.
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
    // one has samples between its steps, the other rows at the ends of its steps: both err by less than 1e-4, which the
    // default tolerance keeps
    for name in ["HIC15", "chest 3 ms"] {
        let both = [&run["criteria"], &recording].map(|judged| value(judged, name));
        assert!((both[0] / both[1] - 1.0).abs() < 1e-4, "{name} {both:?}");
    }
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
            "no output \"nose\"",
        ),
        (
            &[
                "--criteria",
                "UN R94, Hybrid III 50M",
                "--place",
                "femur-left=head accelerometer",
            ],
            "is in `m/s^2`, and the place femur-left is in N",
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

/// A seat whose model names its regulation.
const SEAT: &str = "criteria: { standard: FMVSS 208, dummy: Hybrid III 3YO, head: child/head, chest: chest accelerometer }\n";

fn seat(path: &Path, more: &str) {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
    let text = fs::read_to_string(models.join("child-seat.yaml")).unwrap();
    let data = path.join("data");
    fs::create_dir_all(&data).unwrap();
    fs::copy(
        models.join("data/child-3yo.yaml"),
        data.join("child-3yo.yaml"),
    )
    .unwrap();
    fs::write(path.join("seat.yaml"), format!("{text}\n{more}")).unwrap();
}

/// Run, study and gradient use the same names, and the derivative is that of differences of runs.
#[test]
fn criteria_of_a_model_are_the_same_in_every_command() {
    let directory = directory();
    let path = directory.path();
    seat(path, SEAT);
    let run = |slack: f64| -> Value {
        let set = format!("lap_slack={slack}");
        let run = [
            "run",
            "seat.yaml",
            "--no-files",
            "--json",
            "--accuracy",
            "1e-5",
            "--set",
            &set,
        ];
        serde_json::from_str(&call(path, &run, 0).0).unwrap()
    };
    let hic = |slack: f64| value(&run(slack)["criteria"], "HIC15");
    let study = "model: seat.yaml\ntables: [csv]\ndesign: grid\nparameters: { lap_slack: [29.7 mm, 30 mm, 30.3 mm] }\nresponses: [{ criterion: all }, { of: chest accelerometer, what: peak, \
                 filter: CFC180 }]\n";
    fs::write(
        path.join("study.yaml"),
        study.replace(
            "[29.7 mm, 30 mm, 30.3 mm]",
            "{ values: [29.7 mm, 30 mm, 30.3 mm] }",
        ),
    )
    .unwrap();
    call(path, &["sweep", "study.yaml", "--out", "rows"], 0);
    let rows = fs::read_to_string(path.join("rows/results.csv")).unwrap();
    assert!(
        rows.contains("HIC15") && rows.contains("chest 3 ms"),
        "{rows}"
    );
    let gradient = [
        "gradient",
        "seat.yaml",
        "--of",
        "HIC15",
        "--wrt",
        "lap_slack",
        "--set",
        "lap_slack=0.03",
        "--json",
    ];
    let gradient = call(path, &gradient, 0).0;
    let gradient: Value = serde_json::from_str(&gradient).unwrap();
    let text = gradient.to_string();
    let [below, here, above] = [0.0297, 0.03, 0.0303].map(hic);
    let slope = (above - below) / 6e-4;
    let found = numbers(&gradient);
    // one of the numbers in the answer is the value and one the slope; differences over 1 % of the slack err by their
    // square, and a sample is 1 % of a jump
    assert!(
        found.iter().any(|x| (x / here - 1.0).abs() < 1e-4),
        "{here} {text}"
    );
    assert!(
        found.iter().any(|x| (x / slope - 1.0).abs() < 1e-2),
        "{slope} {text}"
    );
    let in_rows = rows.lines().skip(1).flat_map(|line| line.split(','));
    let in_rows: Vec<f64> = in_rows.filter_map(|cell| cell.parse().ok()).collect();
    for value in [below, here, above] {
        // the study is accurate to 0.1 %
        assert!(
            in_rows.iter().any(|x| (x / value - 1.0).abs() < 1e-3),
            "{value} {rows}"
        );
    }
}

/// All numbers in a JSON text.
fn numbers(of: &Value) -> Vec<f64> {
    match of {
        Value::Number(number) => number.as_f64().into_iter().collect(),
        Value::Array(all) => all.iter().flat_map(numbers).collect(),
        Value::Object(all) => all.values().flat_map(numbers).collect(),
        _ => Vec::new(),
    }
}

/// The column of an output with a filter is the filtered column of the output without it, whatever the rows are.
#[test]
fn outputs_are_filtered_whatever_rows_are_shown() {
    use bryant_signal::Signal;
    use bryant_signal::filter::{Class, Standard, filtered};
    let directory = directory();
    let path = directory.path();
    let text = "model: swing\ndimension: 3\nsystems:\n  - name: man\n    reference: fixed\n    elements:\n      - { name: arm, mass: 2 kg, cg: [0, 0, -0.3], inertia: [0.1, 0.1, 0.02] }\n    start: { \
                angles: { arm: [20 deg, 0, 0] } }\nforces:\n  - field: gravity\n    acceleration: [0, 0, -9.81]\n  - joint: man/arm\n    about: { x: { stiffness: 2e4 N*m/rad } }\noutputs:\n  - { \
                name: raw, of: man/arm, what: acceleration, component: y }\n  - { name: clean, of: man/arm, what: acceleration, component: y, filter: CFC60 }\nrun: { duration: 80 ms, every: 2 ms }\n";
    fs::write(path.join("swing.yaml"), text).unwrap();
    let columns = |every: &str| -> Vec<Vec<f64>> {
        let run = [
            "run",
            "swing.yaml",
            "--no-files",
            "--csv",
            "-",
            "--every",
            every,
        ];
        let rows = call(path, &run, 0).0;
        let rows = rows.lines().skip(1);
        rows.map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
            .collect()
    };
    let (mut fine, mut largest) = (Vec::new(), 0.0);
    for (standard, name) in [
        (Standard::SaeJ211, "SAE CFC60"),
        (Standard::Iso6487, "CFC60"),
    ] {
        let filter = format!("filter: {name} }}");
        fs::write(
            path.join("swing.yaml"),
            text.replace("filter: CFC60 }", &filter),
        )
        .unwrap();
        fine = columns("0.1 ms");
        let raw = Signal {
            first: 0.0,
            interval: 1e-4,
            values: fine.iter().map(|row| row[1]).collect(),
        };
        let expected = filtered(&raw, Class::Cfc60, standard).unwrap().values;
        largest = expected.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let differ = fine
            .iter()
            .filter(|row| (row[1] - row[2]).abs() > 0.01 * largest)
            .count();
        assert!(differ > 100, "the filter does nothing here");
        for (row, expected) in fine.iter().zip(&expected) {
            // the model's rows are 2 ms apart, with 20 samples in each, every 0.1 ms; here these samples are rows.
            // Other rows cause other steps, which the tolerance of 1e-7 keeps to 1e-4, and an average over the time of
            // a filter is closer. The two standards, whose frequencies differ by 0.28 %, differ by more
            assert!(
                (row[2] - expected).abs() < 1e-5 * largest,
                "{row:?} {expected}"
            );
        }
    }
    for row in columns("2 ms") {
        let place = (row[0] / 1e-4).round() as usize;
        assert!((row[2] - fine[place][2]).abs() < 1e-6 * largest, "{row:?}");
    }
    // errors are reported
    for (from, to, told) in [
        (
            "component: y, filter: CFC60",
            "filter: CFC60",
            "a resultant is not filtered",
        ),
        ("filter: CFC60", "filter: CFC100", "did you mean"),
        (
            "filter: CFC60",
            "filter: CFC60, code: 11HEADCG00H3ACYA",
            "does not say the filter",
        ),
    ] {
        fs::write(path.join("swing.yaml"), text.replace(from, to)).unwrap();
        let (_, error) = call(path, &["check", "swing.yaml"], 2);
        assert!(error.contains(told), "{told}: {error}");
    }
    fs::write(path.join("swing.yaml"), text).unwrap();
    let coarse = [
        "run",
        "swing.yaml",
        "--no-files",
        "-r",
        "peak of clean",
        "--sampling",
        "2 ms",
    ];
    let (_, error) = call(path, &coarse, 2);
    assert!(error.contains("CFC60 needs a sample every"), "{error}");
    let short = [
        "run",
        "swing.yaml",
        "--no-files",
        "--duration",
        "0.5 ms",
        "--every",
        "0.1 ms",
    ];
    let (_, error) = call(path, &short, 2);
    assert!(error.contains("a filter needs 10 samples"), "{error}");
    // a run that breaks off has no filtered values
    let broken = [
        "run",
        "swing.yaml",
        "--no-files",
        "--csv",
        "-",
        "--max-steps",
        "40",
    ];
    let rows = call(path, &broken, 3).0;
    assert!(rows.lines().nth(1).unwrap().ends_with("NaN"), "{rows}");
}

/// The filters of SAE J211-1 pass slightly less, both in a run and in its recording, by an option and by the key of a
/// model.
#[test]
fn criteria_have_the_filters_of_either_standard() {
    let directory = directory();
    let path = directory.path();
    seat(path, SEAT);
    let of_run = |more: &[&str]| -> f64 {
        let run = [
            "run",
            "seat.yaml",
            "--no-files",
            "--json",
            "--accuracy",
            "1e-6",
        ];
        let run = call(path, &[&run[..], more].concat(), 0).0;
        let run: Value = serde_json::from_str(&run).unwrap();
        value(&run["criteria"], "chest 3 ms")
    };
    let (iso, sae) = (of_run(&[]), of_run(&["--filter-standard", "sae-j211"]));
    // frequencies are lower by 0.28 %
    assert!(iso != sae && (sae / iso - 1.0).abs() < 3e-3, "{iso} {sae}");
    let fine = [
        "run",
        "seat.yaml",
        "--every",
        "0.1 ms",
        "--csv",
        "test.csv",
        "--no-files",
        "--accuracy",
        "1e-6",
    ];
    call(path, &fine, 0);
    let judge = [
        "--standard",
        "FMVSS 208",
        "--dummy",
        "Hybrid III 3YO",
        "--place",
        "chest=chest accelerometer",
    ];
    for (more, expected) in [(&[][..], iso), (&["--filter-standard", "sae-j211"], sae)] {
        let found = value(&judged(path, &[&judge[..], more].concat()), "chest 3 ms");
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
    }
    seat(
        path,
        &SEAT.replace("dummy:", "filter_standard: sae-j211, dummy:"),
    );
    assert_eq!(of_run(&[]), sae);
    assert_eq!(of_run(&["--filter-standard", "iso6487"]), iso);
}

#[test]
fn criteria_that_a_model_cannot_have_are_refused() {
    let directory = directory();
    let path = directory.path();
    for (criteria, told) in [
        (
            "{ standard: FMVSS 999, dummy: Hybrid III 3YO, head: child/head }",
            "there are those of FMVSS 208",
        ),
        (
            "{ standard: FMVSS 208, dummy: Hybrid III 3YO, head: child/nose }",
            "no element",
        ),
        (
            "{ standard: FMVSS 208, dummy: Hybrid III 3YO, neck_fz: chest accelerometer }",
            "and the place neck-fz is in N",
        ),
        (
            "{ standard: FMVSS 208, dummy: Hybrid III 3YO, nose: child/head }",
            "no key",
        ),
        (
            "{ standard: FMVSS 208, dummy: Hybrid III 3YO, head_x: head accelerometer }",
            "is a resultant, and the place head-x is a component",
        ),
        ("{ dummy: Hybrid III 3YO }", "lacks the key \"standard\""),
    ] {
        seat(path, &format!("criteria: {criteria}\n"));
        let (_, error) = call(path, &["check", "seat.yaml"], 2);
        assert!(error.contains(told), "{told}: {error}");
    }
    seat(path, SEAT);
    let (_, told) = call(path, &["check", "seat.yaml"], 0);
    assert!(told.contains("Nij (neck-fx)"), "{told}");
    let one = [
        "run",
        "seat.yaml",
        "--no-files",
        "--criteria",
        "FMVSS 208, Hybrid III 3YO",
        "--place",
        "chest=head-x",
    ];
    let (_, error) = call(path, &one, 2);
    assert!(
        error.contains("is a component, and the place chest is a resultant"),
        "{error}"
    );
    let of_neck = ["gradient", "seat.yaml", "--of", "Nij", "--wrt", "lap_slack"];
    let (_, error) = call(path, &of_neck, 2);
    assert!(
        error.contains("needs an output at the place neck-fx"),
        "{error}"
    );
    let (_, error) = call(path, &["gradient", "child-seat", "--of", "HIC15"], 2);
    assert!(error.contains("give it `criteria:"), "{error}");
    let study = "model: seat.yaml\ntables: [csv]\ndesign: grid\nparameters: { lap_slack: { from: 0 mm, to: 30 mm, count: 2 } }\nrun: { sampling: 1 ms }\nresponses: [{ criterion: HIC15 }]\n";
    fs::write(path.join("study.yaml"), study).unwrap();
    let (_, error) = call(path, &["sweep", "study.yaml", "--out", "rows"], 2);
    assert!(
        error.contains("CFC1000 needs a sample every 0.0001 s"),
        "{error}"
    );
}

/// The velocity after 20 ms of a free body under a pulse: 10 g at its middle, so ∫ = 10 g 10 ms, whatever separators
/// and units its file has.
#[test]
fn curves_have_the_units_of_their_headings() {
    let directory = directory();
    let path = directory.path();
    let model = |curve: &str| {
        format!(
            "model: p\ndimension: 2\ncurves:\n  pulse: {curve}\nsystems:\n  - name: man\n    elements:\n      - {{ name: torso, mass: 30, cg: [0, 0.2], inertia: 1.1 }}\n\
             forces:\n  - {{ field: sled, acceleration: [pulse, 0] }}\noutputs:\n  - {{ name: vx, of: man/torso, at: cg, what: velocity, component: x }}\nrun: {{ duration: 20 ms, every: 10 ms }}\n"
        )
    };
    let run = |curve: &str, table: &str| -> f64 {
        fs::write(path.join("p.yaml"), model(curve)).unwrap();
        fs::write(path.join("pulse.csv"), table).unwrap();
        let rows = call(path, &["run", "p.yaml", "--no-files", "--csv", "-"], 0).0;
        rows.lines()
            .last()
            .unwrap()
            .split(',')
            .nth(1)
            .unwrap()
            .parse()
            .unwrap()
    };
    let refused = |curve: &str, table: &str| {
        fs::write(path.join("p.yaml"), model(curve)).unwrap();
        fs::write(path.join("pulse.csv"), table).unwrap();
        call(path, &["run", "p.yaml", "--no-files"], 2).1
    };
    let expected = 10.0 * G * 0.01;
    for (curve, table) in [
        (
            "{ file: pulse.csv }",
            "time [ms],ax [g]\n0,0\n10,10\n20,0\n",
        ),
        (
            "{ file: pulse.csv }",
            "time [s];ax [m/s^2]\n0;0\n0.01;98.0665\n0.02;0\n",
        ),
        (
            "{ file: pulse.csv }",
            "\u{feff}time (ms)\tax/g\r\n0\t0\r\n10\t10\r\n20\t0\r\n",
        ),
        (
            "{ file: pulse.csv, columns: [time, ax] }",
            "ay [g],time [ms],ax [g]\n5,0,0\n5,10,10\n5,20,0\n",
        ),
        (
            "{ file: pulse.csv, unit: [ms, gn] }",
            "time [ms],ax [g]\n0,0\n10,10\n20,0\n",
        ),
        (
            "{ file: pulse.csv, unit: [ms, gn] }",
            "time,ax [g]\n0,0\n10,10\n20,0\n",
        ),
        ("{ file: pulse.csv, unit: [ms, gn] }", "0,0\n10,10\n20,0\n"),
    ] {
        let found = run(curve, table);
        assert!(
            (found / expected - 1.0).abs() < 1e-6,
            "{curve} {table}: {found}"
        );
    }
    for (curve, table, told) in [
        (
            "{ file: pulse.csv, unit: [ms, m/s^2] }",
            "time,ax\n0,0,0,0\n10,0,100,5\n20,0,0,0\n",
            "pulse.csv:2",
        ),
        (
            "{ file: pulse.csv, unit: [ms, m/s^2] }",
            "0,0,0,0\n10,0,100,5\n20,0,0,0\n",
            "decimal marks",
        ),
        (
            "{ file: pulse.csv, unit: [ms, m/s^2] }",
            "time;ax\n0,0;0\n10,0;100,5\n20,0;0\n",
            "decimal mark",
        ),
        (
            "{ file: pulse.csv, unit: [ms, m/s^2] }",
            "time [s],ax [g]\n0,0\n10,10\n20,0\n",
            "not the one under `unit`",
        ),
        (
            "{ file: pulse.csv }",
            "time [furlong],ax [g]\n0,0\n10,10\n20,0\n",
            "is no unit",
        ),
        (
            "{ file: pulse.csv }",
            "time [ms],ax [N]\n0,0\n10,10\n20,0\n",
            "acceleration",
        ),
        (
            "{ file: pulse.csv, columns: [time, ax] }",
            "time [ms],ax [g],ax [m/s^2]\n0,0,0\n10,10,98\n20,0,0\n",
            "2 columns",
        ),
    ] {
        let error = refused(curve, table);
        assert!(error.contains(told), "{table}: {error}");
    }
    // 1.2 s at 10 kHz: A sin(π t/1.2 s) with vibrations that the sum over whole periods does not keep; points that are
    // left out are said
    let many: String = (0..=12_000)
        .map(|i| {
            let t = f64::from(i) * 1e-4;
            format!(
                "{t},{}\n",
                200.0 * (PI * t / 0.02).sin().powi(2) + (2.0 * PI * 3e3 * t).sin()
            )
        })
        .collect();
    let pulse = format!("time [s],ax [m/s^2]\n{many}");
    let found = run("{ file: pulse.csv }", &pulse);
    // ∫ 200 sin² over one period of 20 ms is 2; 60 periods of the vibration add nothing. The points of the vibration
    // are 3.3 in a period, and lines between the points that stay are off by the error that is said
    let (_, told) = call(path, &["run", "p.yaml", "--no-files"], 0);
    assert!(told.contains("has 12001 points in its file"), "{told}");
    let said: f64 = told
        .split("differ from it by ")
        .nth(1)
        .unwrap()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!(
        said > 0.0 && said < 2.0 && (found - 2.0).abs() < said * 0.02,
        "{found} {said}"
    );
    let (_, told) = call(path, &["check", "p.yaml"], 0);
    assert!(told.contains("has 12001 points in its file"), "{told}");
}

/// A curve from a channel equals the one from the same numbers in a text file, whatever the unit of the channel and its
/// spelling.
#[test]
fn pulses_come_from_channels_of_tests() {
    let directory = directory();
    let path = directory.path();
    let model = |curve: &str| {
        format!(
            "model: sled\ndimension: 2\ncurves:\n  pulse: {curve}\nsystems:\n  - name: man\n    reference: fixed\n    elements:\n      - {{ name: arm, mass: 2 kg, cg: [0, -0.3], inertia: 0.1 }}\n\
             forces:\n  - field: sled\n    acceleration: [pulse, -9.81]\noutputs:\n  - {{ name: swing, of: man/arm, what: angle }}\nrun: {{ duration: 60 ms, every: 5 ms }}\n"
        )
    };
    let channel = |unit: &str, values: &[f64]| {
        let rows: Vec<String> = values.iter().map(f64::to_string).collect();
        let text = format!(
            "Test object number          :1\r\nName of the channel         :Schlitten, Verz\u{f6}gerung\r\nChannel code                :10SLED000000ACXD\r\nUnit                        :{unit}\r\nReference channel           :implicit\r\n\
             Sampling interval           :0.01\r\nTime of first sample        :-0.01\r\nNumber of samples           :{}\r\n{}\r\n",
            rows.len(),
            rows.join("\r\n")
        );
        // ISO 8859-1: each character is a byte
        let bytes: Vec<u8> = text.chars().map(|c| c as u8).collect();
        fs::write(path.join("tests/Channel/T1.001"), bytes).unwrap();
    };
    fs::create_dir_all(path.join("tests/Channel")).unwrap();
    fs::write(
        path.join("tests/T1.mme"),
        "Data format edition number  :1.6\n",
    )
    .unwrap();
    let list =
        "Number of channels          :1\nName of channel 001         :10SLED000000ACXD / sled\n";
    fs::write(path.join("tests/Channel/T1.chn"), list).unwrap();
    let values = [0.0, 0.0, 19.6133, 29.41995, 9.80665, 0.0];
    let swing = |curve: &str| -> String {
        fs::write(path.join("sled.yaml"), model(curve)).unwrap();
        call(path, &["run", "sled.yaml", "--no-files", "--csv", "-"], 0).0
    };
    let points: Vec<String> = values
        .iter()
        .enumerate()
        .map(|(i, x)| format!("[{}, {x}]", 0.01 * i as f64 - 0.01))
        .collect();
    let expected = swing(&format!("{{ points: [{}] }}", points.join(", ")));
    let of_channel = "{ mme: tests/T1.mme, channel: 10SLED000000ACXD }";
    channel("m/(s*s)", &values);
    assert_eq!(swing(of_channel), expected);
    channel("g", &values.map(|x| x / G));
    let last = |table: &str| -> f64 {
        let row = table.lines().last().unwrap();
        row.split(',').nth(1).unwrap().parse().unwrap()
    };
    let (found, expected) = (last(&swing(of_channel)), last(&expected));
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    // the long form can be read again
    let long = call(path, &["check", "sled.yaml", "--long"], 0).0;
    fs::write(path.join("long.yaml"), long).unwrap();
    call(path, &["check", "long.yaml"], 0);
    for (curve, told) in [
        ("{ mme: tests/T1.mme }", "which channel"),
        (
            "{ mme: tests/T1.mme, channel: 10SLED000000ACYD }",
            "10SLED000000ACXD",
        ),
        ("{ mme: tests/T2.mme, channel: 10SLED000000ACXD }", "T2.mme"),
        ("{ channel: 10SLED000000ACXD }", "without a test"),
        (
            "{ mme: tests/T1.mme, channel: 10SLED000000ACXD, unit: [ms, N] }",
            "has no meaning",
        ),
    ] {
        fs::write(path.join("sled.yaml"), model(curve)).unwrap();
        let (_, error) = call(path, &["check", "sled.yaml"], 2);
        assert!(error.contains(told), "{told}: {error}");
    }
    fs::write(path.join("sled.yaml"), model(of_channel)).unwrap();
    channel("N", &values);
    let (_, error) = call(path, &["check", "sled.yaml"], 2);
    assert!(error.contains("acceleration"), "{error}");
    channel("m/s^2", &values);
    let file = path.join("tests/Channel/T1.001");
    let bytes = fs::read(&file).unwrap();
    fs::write(
        &file,
        [
            &b"Data status                 :channel failed\r\n"[..],
            &bytes,
        ]
        .concat(),
    )
    .unwrap();
    let (_, error) = call(path, &["check", "sled.yaml"], 2);
    assert!(error.contains("channel failed"), "{error}");
    channel("m/s^2", &[0.0, f64::NAN]);
    let (_, error) = call(path, &["check", "sled.yaml"], 2);
    assert!(error.contains("the sample is missing"), "{error}");
}

/// The files of a test: `T1.mme`, the list, a pulse and its times; `-` stands for no file.
#[derive(Clone)]
struct Files([String; 4]);

impl Files {
    fn write(&self, path: &Path) {
        let names = [
            "T1.mme",
            "Channel/T1.chn",
            "Channel/T1.001",
            "Channel/T1.002",
        ];
        for (name, text) in names.into_iter().zip(&self.0) {
            let file = path.join("tests").join(name);
            match text.as_str() {
                "-" => fs::remove_file(file).unwrap_or_default(),
                text => fs::write(file, text).unwrap(),
            }
        }
    }

    /// With one text in place of another in one of the files.
    fn with(&self, index: usize, from: &str, to: &str) -> Files {
        let mut files = self.clone();
        files.0[index] = files.0[index].replacen(from, to, 1);
        assert_ne!(files.0[index], self.0[index], "{from}");
        files
    }

    /// With other files.
    fn replaced(&self, others: &[(usize, &str)]) -> Files {
        let mut files = self.clone();
        for (index, text) in others {
            files.0[*index] = (*text).to_owned();
        }
        files
    }
}

/// A curve and a recording read the same channels from the same files, and refuse the same files at the same place.
#[test]
fn curves_and_recordings_read_tests_by_the_same_rules() {
    let directory = directory();
    let path = directory.path();
    fs::create_dir_all(path.join("tests/Channel")).unwrap();
    let model = "model: sled\ndimension: 2\ncurves:\n  pulse: { mme: tests/T1.mme, channel: 10SLED000000ACXD }\nsystems:\n  - name: man\n    reference: fixed\n    elements:\n      - { name: arm, mass: 2 kg, cg: [0, -0.3], inertia: 0.1 }\n\
        forces:\n  - field: sled\n    acceleration: [pulse, -9.81]\noutputs:\n  - { name: swing, of: man/arm, what: angle }\nrun: { duration: 60 ms, every: 5 ms }\n";
    fs::write(path.join("sled.yaml"), model).unwrap();
    let channel = |code: &str, unit: &str, more: &str, values: &[f64]| {
        let rows: Vec<String> = values.iter().map(f64::to_string).collect();
        format!(
            "Channel code :{code}\nUnit :{unit}\n{more}Number of samples :{}\n{}\n",
            rows.len(),
            rows.join("\n")
        )
    };
    let implicit = "Time of first sample :-0.01\nSampling interval :0.01\n";
    let explicit = "Reference channel :explicit\nReference channel name :10TIRS000000TI00\n";
    let values = [0.0, 3.0, 20.0, 30.0, 10.0, 0.0];
    let times = [-0.01, 0.0, 0.01, 0.02, 0.03, 0.04];
    let list = "Number of channels :2\nName of channel 001 :10SLED000000ACXD / sled\nName of channel 002 :10TIRS000000TI00 / time\n";
    let sound = Files([
        "Title :tests of a sled\n".to_owned(),
        list.to_owned(),
        channel("10SLED000000ACXD", "m/s^2", implicit, &values),
        channel("10TIRS000000TI00", "s", "", &times),
    ]);
    let swing = || {
        let table = call(path, &["run", "sled.yaml", "--no-files", "--csv", "-"], 0).0;
        let row = table.lines().last().unwrap();
        row.split(',').nth(1).unwrap().parse::<f64>().unwrap()
    };
    let read = || {
        let found = bryant_signal::Recording::read(&path.join("tests/T1.mme"));
        found.map(|found| found.channels)
    };
    sound.write(path);
    let (expected, recorded) = (swing(), read().unwrap());
    assert!(expected.abs() > 0.01 && recorded.len() == 1, "{expected}");
    // the same channel, written in other ways
    let timed = channel("10SLED000000ACXD", "m/s^2", explicit, &values);
    let in_g = channel("10sled000000acxd", "g", implicit, &values.map(|x| x / G));
    let in_ms = channel("10TIRS000000TI00", "ms", "", &times.map(|t| t * 1e3));
    for files in [
        sound.replaced(&[(2, &in_g)]),
        sound.with(2, "10SLED000000ACXD", "NOVALUE"),
        sound.with(2, "m/s^2", "m/(s*s)"),
        sound.replaced(&[(2, &timed)]),
        sound.replaced(&[(2, &timed), (3, &in_ms)]),
        sound.replaced(&[(1, "-")]),
        sound.with(0, "tests", "first: test"),
    ] {
        files.write(path);
        let (found, channels) = (swing(), read().unwrap());
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
        let [found, expected] = [&channels, &recorded].map(|all| &all[0]);
        assert_eq!(found.name, expected.name);
        let factor = bryant_signal::unit::factor(&found.unit, &expected.unit).unwrap();
        for (a, b) in found.signal.values.iter().zip(&expected.signal.values) {
            assert!((factor * a - b).abs() < 1e-12, "{channels:?}");
        }
        assert!((found.signal.first - expected.signal.first).abs() < 1e-15);
        assert!((found.signal.interval - expected.signal.interval).abs() < 1e-15);
    }
    // damaged files
    let timed = sound.replaced(&[(2, &timed)]);
    for (files, place) in [
        (sound.with(2, ":6", ":7"), "T1.001:5"),
        (sound.with(2, "\n20\n", "\n2o\n"), "T1.001:8"),
        (sound.with(2, "\n20\n", "\n20,5\n"), "T1.001:8"),
        (sound.with(2, "\n20\n", "\nx :20\n"), "T1.001:8"),
        (sound.with(2, "\n20\n", "\n\n20\n"), "T1.001:9"),
        (sound.with(2, "l :0.01", "l :0"), "T1.001:4"),
        (sound.with(2, "Time of first", "Day of"), "T1.001:1"),
        (sound.with(2, "m/s^2", "m/s^2\nUnit :g"), "T1.001:3"),
        (sound.with(2, "ACXD", "ACYD"), "T1.001:1"),
        (sound.with(1, ":2", ":3"), "T1.chn:1"),
        (sound.replaced(&[(3, "-")]), "T1.chn:3"),
        (timed.with(3, "Unit :s", "Unit :N"), "T1.002:2"),
        (timed.with(3, "\n0.02\n", "\n0.01\n"), "T1.002:7"),
        (
            timed.with(3, "Unit", "Data status :no data\nUnit"),
            "T1.002:2",
        ),
        (sound.replaced(&[(0, "-")]), "T1.mme"),
    ] {
        files.write(path);
        // a recording may go without a channel that is damaged
        let recorded = match bryant_signal::Recording::read(&path.join("tests/T1.mme")) {
            Ok(found) => found.damaged.first().unwrap().error.clone(),
            Err(error) => error.to_string(),
        };
        let (_, curve) = call(path, &["check", "sled.yaml"], 2);
        assert!(
            recorded.contains(place) && curve.contains(place),
            "{place}: {recorded}\n{curve}"
        );
        // both use the same words; of a file that is not there the system says its own
        let first = recorded.lines().next().unwrap();
        let message = first.split_once(": ").unwrap().1;
        assert!(
            place == "T1.mme" || curve.contains(message),
            "{message}: {curve}"
        );
    }
    // a code that two channels have is refused where it is named
    let twice = channel("10SLED000000ACXD", "g", implicit, &values);
    sound.replaced(&[(1, "-"), (3, &twice)]).write(path);
    let (_, curve) = call(path, &["check", "sled.yaml"], 2);
    let both = "--channel=10SLED000000ACXD=10SLED000000ACXD";
    let (_, error) = call(path, &["compare", "tests", "tests", both], 2);
    for said in [curve, error] {
        assert!(said.contains("2 channels \"10SLED000000ACXD\""), "{said}");
    }
}
