//! `bryant run --animation` and `--parquet`: the motion in glTF 2.0, the table as Apache Parquet.

use super::command_call::call;
use super::directory;
use super::tables::{self, column};
use serde_json::Value;
use std::fs;

const SCENE: &str = "model: swing
dimension: 3
vehicles: [{ name: car, start: { velocity: [2, 0, 0] } }]
systems:
  - name: \"arm\"
    reference: { on: car, at: [0, 0, 1] }
    elements:
      - { name: upper, joint: { hinge: y }, mass: 2, cg: [0, 0, -0.2], inertia: [0.02, 0.02, 0.005] }
      - { name: lower, on: upper, at: [0, 0, -0.4], joint: { hinge: x }, mass: 1, cg: [0, 0, -0.15], inertia: [0.01, 0.01, 0.002] }
    start: { joints: { upper: 150 deg, lower: -100 deg } }
forces:
  - { field: gravity, acceleration: [0, 0, -1 gn] }
  - { contact: floor, ellipsoid: { on: arm/lower, center: [0, 0, -0.3], semi_axes: [0.05, 0.03, 0.08], axes: [0, 20 deg, 0] }, plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1], extent: [3, 1] }, stiffness: 20 kN/m, damping: 100 }
  - { belt: strap, from: { on: car, at: [0.5, 0, 1.2] }, to: { on: arm/lower, at: [0, 0, -0.3] }, stiffness: 5 kN, slack: 0.2 m }
outputs:
  - { name: lower, of: arm/lower, at: [0, 0, 0], what: position, component: [x, y, z] }
  - { name: tip, of: arm/lower, at: [0, 0, -0.3], what: position, component: [x, y, z] }
  - { name: strap, of: belt strap, what: length }
  - { name: pull, of: belt strap, what: force }
run: { duration: 1.5 s, every: 10 ms }
";

/// The JSON and the buffer of a file.
fn parts(bytes: &[u8]) -> (Value, &[u8]) {
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!(
        (&bytes[..4], word(4), word(8)),
        (&b"glTF"[..], 2, bytes.len())
    );
    let text = word(12);
    assert_eq!(&bytes[16..20], b"JSON");
    let buffer = 20 + text;
    assert_eq!(
        (&bytes[buffer + 4..buffer + 8], word(buffer) + buffer + 8),
        (&b"BIN\0"[..], bytes.len())
    );
    let json = serde_json::from_slice(&bytes[20..buffer]).unwrap();
    (json, &bytes[buffer + 8..])
}

/// The numbers of an accessor of floats.
fn floats(json: &Value, buffer: &[u8], accessor: &Value) -> Vec<f64> {
    let accessor = &json["accessors"][accessor.as_u64().unwrap() as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let (begin, length) = (
        view["byteOffset"].as_u64().unwrap() as usize,
        view["byteLength"].as_u64().unwrap() as usize,
    );
    let bytes = &buffer[begin..begin + length];
    bytes
        .chunks(4)
        .map(|four| f64::from(f32::from_le_bytes(four.try_into().unwrap())))
        .collect()
}

#[test]
fn keyframes_are_where_the_outputs_say() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("swing.yaml"), SCENE).unwrap();
    let run = [
        "run",
        "swing.yaml",
        "--no-files",
        "--csv",
        "run.csv",
        "--animation",
        "swing.glb",
    ];
    let (_, told) = call(path, &run, 0);
    assert!(told.contains("wrote run.csv, swing.glb"), "{told}");
    let bytes = fs::read(path.join("swing.glb")).unwrap();
    let (json, buffer) = parts(&bytes);
    let columns = tables::read(&path.join("run.csv"));
    let written = column(&columns, "time");

    let animation = &json["animations"][0];
    let nodes = json["nodes"].as_array().unwrap();
    let keys = |node: &str, what: &str| {
        let index = nodes
            .iter()
            .position(|n| n["name"] == node)
            .unwrap_or_else(|| panic!("no {node}"));
        let channels = animation["channels"].as_array().unwrap().iter();
        let mut channels =
            channels.filter(|c| c["target"]["node"] == index && c["target"]["path"] == what);
        let sampler =
            &animation["samplers"][channels.next().unwrap()["sampler"].as_u64().unwrap() as usize];
        (
            floats(&json, buffer, &sampler["input"]),
            floats(&json, buffer, &sampler["output"]),
        )
    };
    let (times, places) = keys("arm/lower", "translation");
    let (_, turns) = keys("arm/lower", "rotation");
    let (_, begins) = keys("strap rod", "translation");
    // positions have six digits, singles have seven
    let near = |a: f64, b: f64| assert!((a - b).abs() < 2e-5, "{a} {b}");
    assert_eq!(times.len(), written.len());
    for (k, time) in times.iter().enumerate() {
        near(*time, written[k]);
        let [x, y, z, w] = [0, 1, 2, 3].map(|i| turns[4 * k + i]);
        near(x * x + y * y + z * z + w * w, 1.0);
        // the tip, 0.3 m along the body's −z axis, by the matrix of the quaternion
        let down = [
            2.0 * (x * z + w * y),
            2.0 * (y * z - w * x),
            1.0 - 2.0 * (x * x + y * y),
        ];
        for (i, axis) in ["x", "y", "z"].into_iter().enumerate() {
            near(
                places[3 * k + i],
                column(&columns, &format!("lower {axis}"))[k],
            );
            near(
                places[3 * k + i] - 0.3 * down[i],
                column(&columns, &format!("tip {axis}"))[k],
            );
        }
        // the first rod of the strap begins at its end on the car, which goes with 2 m/s
        for (begin, expected) in begins[3 * k..].iter().zip([2.0 * time + 0.5, 0.0, 1.2]) {
            near(*begin, expected);
        }
        if k > 0 {
            let product: f64 = (0..4)
                .map(|i| turns[4 * k + i] * turns[4 * k - 4 + i])
                .sum();
            assert!(product > 0.0, "the turn jumps at row {k}");
        }
    }
    // the camera goes with the car
    let (_, eyes) = keys("camera", "translation");
    for (k, time) in times.iter().enumerate() {
        near(eyes[3 * k] - eyes[0], 2.0 * time);
        near(eyes[3 * k + 1] - eyes[1], 0.0);
    }
    // at rest everything is where the first keyframe has it
    let mut moved = 0;
    for channel in animation["channels"].as_array().unwrap() {
        let target = &channel["target"];
        let sampler = &animation["samplers"][channel["sampler"].as_u64().unwrap() as usize];
        let first = floats(&json, buffer, &sampler["output"]);
        let node = &nodes[target["node"].as_u64().unwrap() as usize];
        let rest = node[target["path"].as_str().unwrap()].as_array();
        for (rest, first) in rest.expect("it rests somewhere").iter().zip(first) {
            near(rest.as_f64().unwrap(), first);
            moved += 1;
        }
    }
    // translation and rotation of two bodies at least
    assert!(moved >= 14, "{moved}");
    // z is up: the node above all others rotates it to y
    let root: Vec<f64> = nodes[0]["rotation"]
        .as_array()
        .unwrap()
        .iter()
        .map(|x| x.as_f64().unwrap())
        .collect();
    assert!((root[0] + f64::sqrt(0.5)).abs() < 1e-12 && (root[3] - f64::sqrt(0.5)).abs() < 1e-12);
    let ellipsoid = nodes
        .iter()
        .find(|node| node["scale"] == serde_json::json!([0.05, 0.03, 0.08]));
    assert!(ellipsoid.is_some_and(|node| {
        node["name"] == "arm/lower ellipsoid"
            && node["translation"] == serde_json::json!([0.0, 0.0, -0.3])
    }));
    let unnamed = nodes.iter().filter(|node| node["name"].is_null());
    // those that make a rod visible, or wide
    assert!(unnamed.clone().all(|node| node["scale"].is_array()));
}

/// A belt has one colour and width at a time, which grow with its force by sixths of the largest.
#[test]
fn a_belt_shows_its_force() {
    let directory = directory();
    let path = directory.path();
    // a strap that becomes slack, and taut again
    let scene = SCENE.replace("slack: 0.2 m", "pretension: 20 N");
    fs::write(path.join("swing.yaml"), scene).unwrap();
    let run = [
        "run",
        "swing.yaml",
        "--no-files",
        "--csv",
        "run.csv",
        "--animation",
        "swing.glb",
    ];
    call(path, &run, 0);
    let columns = tables::read(&path.join("run.csv"));
    let pull = column(&columns, "pull");
    let largest = pull.iter().copied().fold(0.0, f64::max);
    assert!(largest > 0.0 && pull.contains(&0.0));
    let bytes = fs::read(path.join("swing.glb")).unwrap();
    let (json, buffer) = parts(&bytes);
    let nodes = json["nodes"].as_array().unwrap();
    let rods = nodes.iter().filter(|node| node["name"] == "strap rod");
    let mut widths = Vec::new();
    for rod in rods {
        // each look: when it is there, and how wide it is
        let looks = rod["children"].as_array().unwrap().iter().map(|switch| {
            let channels = json["animations"][0]["channels"].as_array().unwrap();
            let of = channels
                .iter()
                .find(|c| c["target"]["node"] == *switch)
                .unwrap();
            let sampler = of["sampler"].as_u64().unwrap() as usize;
            let sampler = &json["animations"][0]["samplers"][sampler];
            assert_eq!(sampler["interpolation"], "STEP");
            let [times, scales] =
                ["input", "output"].map(|key| floats(&json, buffer, &sampler[key]));
            let child = nodes[switch.as_u64().unwrap() as usize]["children"][0].as_u64();
            let width = nodes[child.unwrap() as usize]["scale"][0].as_f64().unwrap();
            (times, scales, width)
        });
        let looks: Vec<_> = looks.collect();
        for (time, pull) in column(&columns, "time").iter().zip(pull) {
            let shown = looks.iter().filter(|(times, scales, _)| {
                let k = times.iter().rposition(|t| *t <= time + 1e-6).unwrap();
                scales[3 * k] == 1.0
            });
            let shown: Vec<f64> = shown.map(|(.., width)| *width).collect();
            let steps = (6.0 * pull / largest).ceil();
            assert_eq!(shown.len(), 1, "{time}");
            // 6 mm, and 8 mm more for the largest force
            assert!(
                (shown[0] - 0.006 - 0.008 * steps / 6.0).abs() < 1e-9,
                "{time} {pull} {shown:?}"
            );
            widths.push(steps as usize);
        }
    }
    widths.sort_unstable();
    widths.dedup();
    assert!(widths.len() > 2, "{widths:?}");
}

/// Columns are doubles one after the other, with all digits of the table.
#[test]
fn a_table_as_parquet_has_the_digits_of_the_run() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("swing.yaml"), SCENE).unwrap();
    let run = [
        "run",
        "swing.yaml",
        "--no-files",
        "--csv",
        "run.csv",
        "--parquet",
        "run.parquet",
    ];
    call(path, &run, 0);
    let bytes = fs::read(path.join("run.parquet")).unwrap();
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
    for (name, values) in tables::read(&path.join("run.csv")) {
        let numbers: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        assert!(
            bytes.windows(numbers.len()).any(|part| part == numbers),
            "column {name}"
        );
    }
    let text = String::from_utf8_lossy(&bytes);
    assert!(text.contains("\"tip x\":\"m\"") && text.contains("swing"));
    for (option, file) in [
        ("--parquet", "-"),
        ("--animation", "-"),
        ("--parquet", "run.csv"),
    ] {
        let run = [
            "run",
            "swing.yaml",
            "--no-files",
            "--csv",
            "run.csv",
            option,
            file,
        ];
        call(path, &run, 2);
    }
}

/// A top that turns at RATE about z for DURATION, with a row every EVERY.
const TOP: &str = "model: top
dimension: DIMENSION
systems:
  - name: top
    elements: [{ name: body, mass: 1, cg: CENTRE, inertia: INERTIA }]
    start: { rates: { body: RATE } }
run: { duration: DURATION, every: EVERY }
";

/// Players turn a body the shorter way from one keyframe to the next: 100 rad/s for 1 s are 100/2π = 15.92 turns,
/// whatever the rows.
#[test]
fn fast_turns_are_played_as_they_are() {
    let directory = directory();
    let path = directory.path();
    let space = |rate: &str| {
        let top = TOP.replace("DIMENSION", "3").replace("CENTRE", "[0, 0, 0]");
        top.replace("INERTIA", "[0.02, 0.03, 0.04]")
            .replace("RATE", rate)
    };
    let plane = |rate: &str| {
        let top = TOP.replace("DIMENSION", "2").replace("CENTRE", "[0, 0]");
        top.replace("INERTIA", "0.04").replace("RATE", rate)
    };
    for (scene, duration, every, turned) in [
        (space("[0, 0, 100]"), 1.0, 0.05, 100.0),
        (space("[0, 0, -100]"), 1.0, 0.5, 100.0),
        (space("[0, 0, 1000]"), 0.5, 0.05, 500.0),
        (plane("100"), 1.0, 0.05, 100.0),
        // more rows than keyframes of a slow motion
        (space("[0, 0, 30]"), 20.0, 0.01, 600.0),
        (space("[0, 0, 1]"), 1.0, 0.05, 1.0),
    ] {
        let scene = scene.replace("DURATION", &format!("{duration} s"));
        fs::write(
            path.join("top.yaml"),
            scene.replace("EVERY", &format!("{every} s")),
        )
        .unwrap();
        let run = ["run", "top.yaml", "--no-files", "--animation", "top.glb"];
        let (_, told) = call(path, &run, 0);
        assert!(!told.contains("cannot show"), "{told}");
        let bytes = fs::read(path.join("top.glb")).unwrap();
        let (json, buffer) = parts(&bytes);
        let animation = &json["animations"][0];
        let channels = animation["channels"].as_array().unwrap();
        let of = channels
            .iter()
            .find(|c| c["target"]["path"] == "rotation")
            .unwrap();
        let sampler = &animation["samplers"][of["sampler"].as_u64().unwrap() as usize];
        let turns = floats(&json, buffer, &sampler["output"]);
        let keys: Vec<&[f64]> = turns.chunks(4).collect();
        let mut sum = 0.0;
        for pair in keys.windows(2) {
            let product: f64 = pair[0].iter().zip(pair[1]).map(|(a, b)| a * b).sum();
            let angle = 2.0 * product.abs().min(1.0).acos();
            assert!(angle < 0.5 * std::f64::consts::PI, "{angle}");
            // about z, to the same side as the first
            sum += angle;
        }
        // singles and six digits of each of the keyframes
        assert!(
            (sum - turned).abs() < 1e-3 * turned + 1e-4,
            "{sum} {turned}"
        );
    }
    // what no number of keyframes can show is said
    let fast = space("[0, 0, 3e4]")
        .replace("DURATION", "1 s")
        .replace("EVERY", "0.1 s");
    fs::write(path.join("top.yaml"), fast).unwrap();
    let run = [
        "run",
        "top.yaml",
        "--no-files",
        "--no-verify",
        "--animation",
        "top.glb",
    ];
    let (_, told) = call(path, &run, 0);
    assert!(
        told.contains("cannot show how fast bodies turn") && told.contains("help: "),
        "{told}"
    );
}
