//! `bryant human`: bodies as systems that models include.

use super::command_call::call;
use super::directory;
use serde_json::Value;
use std::fs;
use std::path::Path;

const SCENE: &str = "model: two
dimension: 3
include: [man.yaml, woman.yaml]
systems:
  - { name: woman, start: { position: [1, 0, 0.6] } }
forces:
  - { field: gravity, acceleration: [0, 0, -1 gn] }
outputs:
  - { name: head, of: man/head, at: [0, 0, 0], what: position, component: z }
  - { name: man centre, of: man, what: position, component: [x, y, z] }
  - { name: left foot, of: woman/left-foot, at: [0, 0, 0], what: position, component: [x, y, z] }
  - { name: right foot, of: woman/right-foot, at: [0, 0, 0], what: position, component: [x, y, z] }
run: { duration: 1 ms, every: 1 ms }
";

fn first_row(path: &Path) -> Vec<(String, f64)> {
    call(
        path,
        &["run", "two.yaml", "--csv", "run.csv", "--no-files"],
        0,
    );
    let table = fs::read_to_string(path.join("run.csv")).unwrap();
    let mut rows = table.lines();
    let names = rows.next().unwrap().split(',').map(str::to_owned);
    let values = rows
        .next()
        .unwrap()
        .split(',')
        .map(|cell| cell.parse().unwrap());
    names.zip(values).collect()
}

#[test]
fn two_people_stand_and_sit_in_one_scene() {
    let directory = directory();
    let path = directory.path();
    call(path, &["human", "--like", "male-50", "-o", "man.yaml"], 0);
    let woman = [
        "human",
        "--sex",
        "f",
        "--stature",
        "162 cm",
        "--mass",
        "60 kg",
        "--name",
        "woman",
        "--posture",
        "seated",
    ];
    let (text, _) = call(path, &woman, 0);
    fs::write(path.join("woman.yaml"), text).unwrap();
    fs::write(path.join("two.yaml"), SCENE).unwrap();
    let (checked, told) = call(path, &["check", "two.yaml", "--json"], 0);
    let checked: Value = serde_json::from_str(&checked).unwrap();
    // no joint comes close to a singular position
    assert_eq!(checked["warnings"], serde_json::json!([]), "{told}");
    let row = first_row(path);
    let value = |name: &str| {
        row.iter()
            .find(|(column, _)| column.starts_with(name))
            .unwrap()
            .1
    };
    // the seventh cervical vertebra: the stature less 242.9 mm of 1741
    assert!(
        (value("head") - (1.753 - 0.2429 * 1.753 / 1.741)).abs() < 5e-4,
        "{row:?}"
    );
    // the centre of gravity of men is at 55 to 57 % of the stature, above the middle of the feet
    assert!(
        (0.55..0.57).contains(&(value("man centre z") / 1.753)),
        "{row:?}"
    );
    assert!(value("man centre y").abs() < 1e-12);
    // both sides are mirror images
    for axis in ["x", "z"] {
        assert!(
            (value(&format!("left foot {axis}")) - value(&format!("right foot {axis}"))).abs()
                < 1e-12
        );
    }
    assert!(
        (value("left foot y") + value("right foot y")).abs() < 1e-12 && value("left foot y") > 0.05
    );
    // she sits: the ankle is in front of the hip by the thigh, and below it by the shank
    assert!(
        (value("left foot x") - (1.0 + 0.3685 * 1.62 / 1.735)).abs() < 1e-3,
        "{row:?}"
    );
    assert!(
        (value("left foot z") - (0.6 - 0.4386 * 1.62 / 1.735)).abs() < 1e-3,
        "{row:?}"
    );
    // the masses that the file prints add up to the total mass
    let text = fs::read_to_string(path.join("woman.yaml")).unwrap();
    let masses = text.lines().filter_map(|line| {
        let mass = line
            .split("mass: ")
            .nth(1)?
            .split(" kg")
            .next()?
            .parse::<f64>()
            .ok()?;
        Some(mass * if line.contains("mirror") { 2.0 } else { 1.0 })
    });
    assert!((masses.sum::<f64>() - 60.0).abs() < 1e-9);
}

#[test]
fn a_body_beyond_the_data_is_refused_with_the_reason() {
    let directory = directory();
    let path = directory.path();
    for (stature, mass, name, told) in [
        ("1.1 m", "20 kg", "man", "stretched to 1.40 to 2.10 m"),
        ("1.8 m", "30 kg", "man", "body mass index of 9.3"),
        ("1.8 kg", "80 kg", "man", "a quantity in m is needed"),
        ("1.8 m", "80 kg", "Bad Name", "small letters"),
    ] {
        let arguments = [
            "human",
            "--sex",
            "m",
            "--stature",
            stature,
            "--mass",
            mass,
            "--name",
            name,
        ];
        let (_, error) = call(path, &arguments, 2);
        assert!(error.contains(told), "{error}");
    }
}

/// A person by a key in a model is the same as the one that the command writes.
#[test]
fn a_person_in_a_model_is_the_one_of_the_command() {
    let directory = directory();
    let path = directory.path();
    let written = [
        "human",
        "--like",
        "male-50",
        "--posture",
        "seated",
        "-o",
        "man.yaml",
    ];
    call(path, &written, 0);
    let model = |include: &str| {
        format!(
            "model: sits
dimension: 3
include: [{include}]
forces: [{{ field: gravity, acceleration: [0, 0, -1 gn] }}]
outputs: [{{ name: head, of: man/head, what: acceleration }}]
run: {{ duration: 20 ms, every: 10 ms }}
"
        )
    };
    let made = "{ human: { like: male-50, posture: seated }, system: man }";
    let by_size =
        "{ human: { sex: m, stature: 1.753 m, mass: 77.7 kg, posture: seated }, system: man }";
    let tables = ["man.yaml", made, by_size].map(|include| {
        fs::write(path.join("sits.yaml"), model(include)).unwrap();
        let run = ["run", "sits.yaml", "--csv", "run.csv", "--no-files"];
        call(path, &run, 0);
        fs::read_to_string(path.join("run.csv")).unwrap()
    });
    assert_eq!(tables[0], tables[1]);
    assert_eq!(tables[0], tables[2]);
    for (wrong, said) in [
        (
            "{ human: { sex: m }, system: man }",
            "what size the person has",
        ),
        (
            "{ human: { sex: m, percentile: 100 }, system: man }",
            "no percentile 100",
        ),
        (
            "{ human: { sex: m, stature: 1.2 m, mass: 30 kg }, system: man }",
            "beyond the data",
        ),
        (
            "{ human: { sex: m, stature: 1.8 s, mass: 80 kg }, system: man }",
            "no number that a body can be made of",
        ),
        (
            "{ human: { like: male-50 }, system: man }, { human: { like: male-95 }, system: man }",
            "two systems called \"man\"",
        ),
    ] {
        fs::write(path.join("sits.yaml"), model(wrong)).unwrap();
        let (_, told) = call(path, &["check", "sits.yaml"], 2);
        assert!(told.contains(said), "{said}: {told}");
    }
}

/// A person in the plane moves like the same person in space whose sides move alike.
#[test]
fn a_person_in_the_plane_moves_as_the_one_in_space() {
    let directory = directory();
    let path = directory.path();
    let moved = |dimension: u8, like: &str| {
        let [gravity, velocity, rate] = match dimension {
            2 => ["[0, -1 gn]", "[1, 2]", "3"],
            _ => ["[0, 0, -1 gn]", "[1, 0, 2]", "[0, 3, 0]"],
        };
        let hand = if dimension == 2 { "hand" } else { "right-hand" };
        let scene = format!(
            "model: one
dimension: {dimension}
include: [{{ human: {{ like: {like}, posture: seated, angles: {{ trunk: -20 deg, head: 10 deg, feet: 5 deg }} }}, system: man }}]
systems: [{{ name: man, start: {{ velocity: {velocity}, rates: {{ head: {rate} }} }} }}]
forces: [{{ field: gravity, acceleration: {gravity} }}]
outputs:
  - {{ name: head, of: man/head, at: cg, what: position, component: [x, z] }}
  - {{ name: hand, of: man/{hand}, at: cg, what: position, component: [x, z] }}
  - {{ name: neck, of: joint man/head, what: torque{} }}
run: {{ duration: 0.2 s, every: 20 ms }}
",
            if dimension == 2 { "" } else { ", about: y" }
        );
        fs::write(path.join("one.yaml"), scene).unwrap();
        let (text, _) = call(path, &["run", "one.yaml", "--json", "--no-files"], 0);
        let run: Value = serde_json::from_str(&text).unwrap();
        let rows = run["rows"].as_array().unwrap().iter();
        let row = |row: &Value| -> Vec<f64> {
            let row = row.as_array().unwrap().iter();
            row.map(|value| value.as_f64().unwrap()).collect()
        };
        rows.map(row).collect::<Vec<_>>()
    };
    for like in ["male-50", "child-3", "hybrid-3-5"] {
        let [plane, space] = [2, 3].map(|dimension| moved(dimension, like));
        assert_eq!(plane.len(), 11);
        let neck = space
            .iter()
            .fold(0.0f64, |most, row| most.max(row[5].abs()));
        for (plane, space) in plane.iter().zip(&space) {
            for column in 1..5 {
                // masses are written to 0.1 g, moments of inertia to 1 g m²
                let apart = (plane[column] - space[column]).abs();
                assert!(apart < 2e-4, "{like} {column} {plane:?} {space:?}");
            }
            assert!(
                (plane[5] - space[5]).abs() < 5e-3 * neck,
                "{like} {plane:?} {space:?}"
            );
        }
    }
}

/// The feet stand on the ground in every posture; impossible requests are refused with a message in the user's words.
#[test]
fn postures_are_angles() {
    let directory = directory();
    let path = directory.path();
    let with = |angles: &str| {
        format!(
            "model: one
dimension: 3
include: [{{ human: {{ like: child-6, angles: {{ {angles} }} }}, system: child }}]
outputs: [{{ name: ankle, of: child/left-foot, at: [0, 0, 0], what: position, component: z }}]
run: {{ duration: 1 ms, every: 1 ms }}
"
        )
    };
    let ankle = |angles: &str| {
        fs::write(path.join("one.yaml"), with(angles)).unwrap();
        let (text, _) = call(path, &["run", "one.yaml", "--json", "--no-files"], 0);
        let run: Value = serde_json::from_str(&text).unwrap();
        run["rows"][0][1].as_f64().unwrap()
    };
    let standing = ankle("trunk: 0");
    assert!((0.02..0.08).contains(&standing), "{standing}");
    for angles in [
        "thighs: -40 deg, shanks: 1 rad",
        "trunk: 30 deg, thighs: -60 deg, head: -20 deg",
    ] {
        assert!((ankle(angles) - standing).abs() < 2e-4, "{angles}");
    }
    let command = [
        "human",
        "--like",
        "child-6",
        "--name",
        "child",
        "--angle",
        "thighs=-40 deg",
    ];
    let (text, _) = call(path, &command, 0);
    assert!(text.contains("left-thigh: [-40 deg, 0, 0]"), "{text}");
    for (angles, told) in [("knees: 3", "knees"), ("head: 3 kg", "number of rad")] {
        fs::write(path.join("one.yaml"), with(angles)).unwrap();
        let (_, error) = call(path, &["check", "one.yaml"], 2);
        assert!(error.contains(told), "{error}");
    }
    for (angle, told) in [
        ("knees=3 deg", "a body has no angle"),
        ("thighs", "write a name"),
        ("thighs=3 kg", "rad"),
    ] {
        let (_, error) = call(path, &["human", "--like", "child-6", "--angle", angle], 2);
        assert!(error.contains(told), "{error}");
    }
}

/// A driver in a seat in front of a bolster and a steering column, which are parts by name.
fn with_parts(dimension: u8, keys: &str) -> String {
    let v = |x: f64, z: f64| match dimension {
        2 => format!("[{x}, {z}]"),
        _ => format!("[{x}, 0, {z}]"),
    };
    format!(
        "model: one
dimension: {dimension}
parameters: {{ stiff: {{ value: 1, min: 0.5, max: 4 }} }}
vehicles: [{{ name: car, start: {{ velocity: {velocity} }}, acceleration: {brake}, stops: true }}]
include:
  - {{ human: {{ like: male-50, posture: seated, angles: {{ trunk: -15 deg, thighs: -80 deg }} }}, system: driver }}
  - {{ part: seat, name: seat, on: car, at: {seat}, against: [driver] }}
  - {{ part: knee-bolster, name: bolster, on: car, at: {bolster}, against: [driver], times: stiff{keys} }}
  - {{ part: steering-column, name: wheel, on: car, at: {wheel}, against: [driver] }}
systems: [{{ name: driver, start: {{ velocity: {velocity} }} }}]
forces: [{{ field: gravity, acceleration: {gravity} }}]
outputs:
  - {{ name: column, of: joint wheel/wheel, what: position }}
  - {{ name: set, of: joint wheel/wheel, what: permanent_set_above }}
  - {{ name: knee, of: contact bolster-panel-driver-{thigh}, what: force }}
  - {{ name: seat, of: contact seat-cushion-driver-pelvis, what: force }}
run: {{ duration: 120 ms, every: 1 ms }}
",
        velocity = v(10.0, 0.0),
        brake = v(-200.0, 0.0),
        gravity = v(0.0, -9.81),
        seat = v(0.05, 0.36),
        bolster = v(0.56, 0.52),
        wheel = v(0.4, 0.85),
        thigh = if dimension == 2 { "thigh" } else { "left-thigh" },
    )
}

#[test]
fn parts_of_a_car_hold_who_meets_them() {
    let directory = directory();
    let path = directory.path();
    for dimension in [2, 3] {
        let run = |options: &[&str]| {
            fs::write(path.join("one.yaml"), with_parts(dimension, "")).unwrap();
            let all = ["run", "one.yaml", "--csv", "run.csv", "--no-files"];
            call(path, &[&all[..], options].concat(), 0);
            super::tables::read(&path.join("run.csv"))
        };
        let usual = run(&[]);
        let knee = super::tables::largest(&usual, "knee");
        assert!(knee > 0.0);
        assert!(super::tables::largest(&usual, "seat") > 0.0);
        // the column gives way and does not go beyond its end. What stays is what its unloading at 2 MN/m does not give
        // back: 20 mm of 40 kN at most
        let most = super::tables::largest(&usual, "column");
        let set = super::tables::largest(&usual, "set");
        assert!((0.01..0.13).contains(&most), "{most}");
        assert!(most - 0.02 < set && set < most, "{most} {set}");
        let hard = run(&["--set", "stiff=3"]);
        assert!(super::tables::largest(&hard, "knee") > knee);
    }
    for (text, told) in [
        (with_parts(3, ", at: [0, 0]"), "twice"),
        (
            with_parts(3, "").replace("system: driver", "system: \"a: b\""),
            "is no name",
        ),
        (
            with_parts(3, "").replace("times: stiff", "times: stiff + 1"),
            "neither a number nor",
        ),
        (
            with_parts(3, "").replace("name: bolster", "name: \"a: b\""),
            "is no name",
        ),
        (
            with_parts(3, "").replace("against: [driver], times", "against: [\"a}\"], times"),
            "is no name",
        ),
        (with_parts(3, ", angle: .inf"), "a number of rad"),
        (with_parts(3, ", angle: 3 kg"), "a number of rad"),
        (
            with_parts(3, "").replace("[0.56, 0, 0.52]", "[0.56, 0.52]"),
            "a place has 3 coordinates here, not 2",
        ),
        (
            with_parts(2, "").replace("knee-bolster", "knee-pad"),
            "knee-bolster",
        ),
        (
            with_parts(3, "").replace(
                "at: [0.4, 0, 0.85], against: [driver]",
                "at: [0.4, 0, 0.85], against: [pilot]",
            ),
            "pilot-thorax",
        ),
    ] {
        fs::write(path.join("one.yaml"), text).unwrap();
        let (_, error) = call(path, &["check", "one.yaml"], 2);
        assert!(error.contains(told), "{told}: {error}");
    }
}

/// The last row of a run with a small tolerance.
fn last_row(path: &Path, scene: &str) -> Vec<f64> {
    fs::write(path.join("scene.yaml"), scene).unwrap();
    let arguments = [
        "run",
        "scene.yaml",
        "--json",
        "--no-files",
        "--tolerance",
        "1e-9",
    ];
    let (told, _) = call(path, &arguments, 0);
    let told: Value = serde_json::from_str(&told).unwrap();
    let row = told["rows"].as_array().unwrap().last().unwrap();
    let values = row.as_array().unwrap().iter();
    values.map(|value| value.as_f64().unwrap()).collect()
}

/// A ball joint whose laws are about turns in an order moves as one hinge after the other in that order, with the same
/// laws.
#[test]
fn laws_in_an_order_are_those_of_hinges_in_that_order() {
    let directory = directory();
    let path = directory.path();
    let scene = |joint: &str, start: &str, forces: &str| {
        format!(
            "model: top
dimension: 3
systems:
  - name: top
    reference: fixed
    elements: [{{ name: body, {joint}mass: 2, cg: [0.05, 0.1, 0.2], inertia: [0.05, 0.06, 0.03] }}]
    start: {{ {start} }}
forces:
  - {{ field: gravity, acceleration: [0, 0, -1 gn] }}
{forces}outputs: [{{ name: tip, of: top/body, at: [0.3, 0.2, 0.1], what: position, component: [x, y, z] }}]
run: {{ duration: 0.6 s, every: 0.1 s }}
"
        )
    };
    let laws = [
        (
            'x',
            "elastic: { points: [[-1, -30], [0, 0], [1, 8]], extrapolate: linear }, damping: 0.2, neutral: 0.1",
        ),
        (
            'y',
            "stiffness: 12, damping: 0.1, stop: { from: -0.3, to: 0.4, stiffness: 60 }",
        ),
        (
            'z',
            "elastic: { points: [[-1, -4], [0, 0], [1, 20]], extrapolate: linear }, friction: 0.3",
        ),
    ];
    let rates = [('x', 2.0), ('y', -3.0), ('z', 4.0)];
    let at_zero = "rates: { body: [2, -3, 4] }";
    for order in ["xyz", "xzy", "yxz", "yzx", "zxy", "zyx"] {
        let about = laws
            .map(|(axis, law)| format!("{axis}: {{ {law} }}"))
            .join(", ");
        let about = format!("  - {{ joint: top/body, about: {{ order: {order}, {about} }} }}\n");
        let ball = last_row(path, &scene("", at_zero, &about));
        let hinges = order
            .chars()
            .map(|axis| format!("{{ hinge: {axis}, name: {axis}-turn }}"));
        let hinges: Vec<String> = hinges.collect();
        let spins = order
            .chars()
            .map(|axis| rates.iter().find(|(one, _)| *one == axis).unwrap().1);
        let spins: Vec<String> = spins.map(|rate| rate.to_string()).collect();
        let each = laws.map(|(axis, law)| {
            format!("  - {{ joint: top/body, name: {axis}-turn, freedom: {axis}-turn, {law} }}\n")
        });
        let start = format!("joint_rates: {{ body: [{}] }}", spins.join(", "));
        let joint = format!("joint: [{}], ", hinges.join(", "));
        let chain = last_row(path, &scene(&joint, &start, &each.concat()));
        for (a, b) in ball.iter().zip(&chain) {
            // both within 1e-6 at a tolerance of 1e-9
            assert!((a - b).abs() < 2e-6, "{order}: {ball:?} {chain:?}");
        }
    }
}

/// The neck of a bundled person nods by more than 90° backwards, with a little tilt, as 49 CFR 572.33 wants of a dummy
/// (81° to 106°); the law has no singular angle there, so that the steps stay long.
#[test]
fn a_neck_passes_ninety_degrees_of_extension() {
    let directory = directory();
    let path = directory.path();
    let (man, _) = call(path, &["human", "--like", "hybrid-3-50"], 0);
    let law = man
        .lines()
        .find(|line| line.contains("joint: man/head"))
        .unwrap();
    let scene = format!(
        "model: neck
dimension: 3
systems:
  - name: man
    reference: fixed
    elements:
      - {{ name: thorax, mass: 17.19 kg, cg: [0, 0, 0.12], inertia: [50, 50, 50] }}
      - {{ name: head, on: thorax, at: [0, 0, 0.2438], mass: 6.08 kg, cg: [0, 0, 0.1222], inertia: [0.0334, 0.0361, 0.0248] }}
    start: {{ angles: {{ head: [2 deg, 0, 3 deg] }}, rates: {{ head: [0, -36, 0] }} }}
forces:
{law}
outputs:
  - {{ name: nod, of: joint man/head, what: angle, about: y }}
run: {{ duration: 150 ms, every: 1 ms }}
"
    );
    fs::write(path.join("neck.yaml"), scene).unwrap();
    let (told, _) = call(path, &["check", "neck.yaml", "--json"], 0);
    let told: Value = serde_json::from_str(&told).unwrap();
    assert_eq!(told["warnings"], serde_json::json!([]));
    let (told, _) = call(path, &["run", "neck.yaml", "--json", "--no-files"], 0);
    let told: Value = serde_json::from_str(&told).unwrap();
    let rows = told["rows"].as_array().unwrap().iter();
    let nod = rows.map(|row| row[1].as_f64().unwrap()).fold(0.0, f64::min);
    assert!(nod < -std::f64::consts::FRAC_PI_2, "{nod}");
    // the singular law of before took 3.8 million
    let evaluations = told["report"]["evaluations"].as_u64().unwrap();
    assert!(evaluations < 20_000, "{evaluations}");
}

/// A person whose head, arms and shanks meet nothing has a head, arms and shanks in pictures, on the page and in the
/// animation.
#[test]
fn all_ellipsoids_of_a_person_are_drawn() {
    let directory = directory();
    let path = directory.path();
    let scene = |contact: &str| {
        format!(
            "model: sits
dimension: 3
include: [{{ human: {{ like: male-50, posture: seated }}, system: man }}]
surfaces: {{ seat: {{ on: frame, at: [0.15, 0, 0.36], normal: [0, 0, 1] }} }}
forces:
  - {{ field: gravity, acceleration: [0, 0, -1 gn] }}
{contact}
run: {{ duration: 1 ms, every: 1 ms }}
"
        )
    };
    let contact = "  - { contact: seat, ellipsoid: [man-pelvis, man-thorax], plane: seat, stiffness: 40 kN/m }";
    for contact in ["", contact] {
        fs::write(path.join("sits.yaml"), scene(contact)).unwrap();
        let arguments = ["run", "sits.yaml", "--no-files", "--figures", "1"];
        let files = [
            "--report",
            "r.html",
            "--picture",
            "p.svg",
            "--animation",
            "a.glb",
        ];
        call(path, &[&arguments[..], &files].concat(), 0);
        // pelvis, abdomen, thorax, head, two arms of two, two legs of three: 4 + 2 · 5
        let page = fs::read_to_string(path.join("r.html")).unwrap();
        let (_, ellipsoids) = page.split_once("\"ellipsoids\":").unwrap();
        let mut values = serde_json::Deserializer::from_str(ellipsoids).into_iter::<Value>();
        let ellipsoids = values.next().unwrap().unwrap();
        assert_eq!(ellipsoids.as_array().unwrap().len(), 14, "{ellipsoids}");
        let picture = fs::read_to_string(path.join("p.svg")).unwrap();
        // one more is in the legend; those of both sides are behind each other and the same
        let drawn = picture.matches("<ellipse ").count() - 1;
        assert!(drawn >= 9, "{drawn}");
    }
}
