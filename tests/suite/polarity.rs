//! Channels of dummies have the signs of SAE J211-1: each is held against manipulations by hand, as in the table of SAE
//! J1733, whatever the axes of the model are. No expected sign follows from a formula of the program: the hand says it.

use super::command_call::call;
use super::directory;
use super::share::share;
use serde_json::Value;
use std::fs;
use std::path::Path;

type Vector = [f64; 3];

fn cross([a, b, c]: Vector, [d, e, f]: Vector) -> Vector {
    [b * f - c * e, c * d - a * f, a * e - b * d]
}

fn combined(factors: Vector, directions: [Vector; 3]) -> Vector {
    [0, 1, 2].map(|i| (0..3).map(|k| factors[k] * directions[k][i]).sum())
}

/// A person who stands: up in the frames of its elements, where the model says what is forward; and both in absolute
/// axes at the start.
struct Standing {
    up: Vector,
    anatomy: &'static str,
    start: &'static str,
    seen: [Vector; 2],
}

const X: Vector = [1.0, 0.0, 0.0];
const Y: Vector = [0.0, 1.0, 0.0];
const Z: Vector = [0.0, 0.0, 1.0];

fn minus(v: Vector) -> Vector {
    v.map(|x| -x)
}

fn people() -> Vec<Standing> {
    let person = |up, anatomy, start, seen| Standing {
        up,
        anatomy,
        start,
        seen,
    };
    vec![
        person(Z, "", "", [X, Z]),
        // faces the other way, aside, and hangs head down
        person(Z, "", "angles: { ROOT: [0, 0, 180 deg] }", [minus(X), Z]),
        person(Z, "", "angles: { ROOT: [0, 0, 90 deg] }", [Y, Z]),
        person(Z, "", "angles: { ROOT: [180 deg, 0, 0] }", [X, minus(Z)]),
        // lies on the back
        person(Z, "", "angles: { ROOT: [0, -90 deg, 0] }", [Z, minus(X)]),
        // frames that are turned: those of somebody who faces -x, of a lateral scene, of a program with z forward and x
        // down, of one with z down
        person(Z, "anatomy: { forward: -x }", "", [minus(X), Z]),
        person(Z, "anatomy: { forward: y }", "", [Y, Z]),
        person(
            minus(X),
            "anatomy: { forward: z, up: -x }",
            "",
            [Z, minus(X)],
        ),
        person(minus(Z), "anatomy: { up: -z }", "", [X, minus(Z)]),
    ]
}

impl Standing {
    /// A place by its height, in the frames of the elements.
    fn at(&self, height: f64) -> String {
        format!("{:?}", self.up.map(|x| height * x))
    }

    /// What a hand does, by its parts forward, to the left and up, in absolute axes.
    fn hand(&self, parts: Vector) -> Vector {
        let [forward, up] = self.seen;
        combined(parts, [forward, cross(up, forward), up])
    }

    /// A system of two parts that are welded to each other, the first of them fixed by its mass.
    fn two(&self, [first, second]: [(&str, f64); 2], joint: f64) -> String {
        let start = self.start.replace("ROOT", first.0);
        format!(
            "systems:\n  - name: man\n    reference: fixed\n    {}\n    elements:\n      - {{ name: {}, mass: 1e6 kg, cg: {}, inertia: [1e6, 1e6, 1e6] }}\n      \
             - {{ name: {}, on: {}, at: {}, joint: weld, mass: 4.5 kg, cg: {}, inertia: [0.03, 0.03, 0.03] }}\n    start: {{ {start} }}\n",
            self.anatomy,
            first.0,
            self.at(first.1),
            second.0,
            first.0,
            self.at(joint),
            self.at(second.1)
        )
    }
}

/// The first row of the table of a model, without the time.
fn first_row(path: &Path, text: &str) -> Vec<f64> {
    fs::write(path.join("model.yaml"), text).unwrap();
    let rows = call(path, &["run", "model.yaml", "--no-files", "--csv", "-"], 0).0;
    let row = rows.lines().nth(1).unwrap();
    row.split(',')
        .skip(1)
        .map(|cell| cell.parse().unwrap())
        .collect()
}

const HEADER: &str = "model: hand\ndimension: 3\nrun: { duration: 1 ms, every: 1 ms }\n";

/// What a hand does to the head, in parts forward, left and up, one row for each channel: head rearward, leftward,
/// upward; left ear toward the left shoulder, chin toward the sternum, chin toward the left shoulder. The first three
/// are forces, the others moments.
const MANIPULATIONS: [Vector; 6] = [
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

/// Each manipulation gives its own channel of the load cell, with a positive sign, and no other.
fn holds(path: &Path, system: &str, on: &str, reaction: f64, who: &Standing, outputs: &str) {
    for (channel, parts) in MANIPULATIONS.into_iter().enumerate() {
        let (key, size) = if channel < 3 {
            ("force", 100.0)
        } else {
            ("moment", 10.0)
        };
        let hand = who.hand(parts.map(|x| reaction * size * x));
        let text = format!(
            "{HEADER}{system}forces:\n  - {{ load: hand, on: man/{on}, {key}: {hand:?} }}\n{outputs}"
        );
        let found = first_row(path, &text);
        for (other, value) in found.iter().enumerate() {
            let expected = if other == channel { size } else { 0.0 };
            // what holds the hand gives way by a millionth
            assert!(
                (value - expected).abs() < 1e-2,
                "{channel} {found:?}\n{text}"
            );
        }
    }
}

#[test]
fn the_neck_has_the_signs_of_its_manipulations() {
    let directory = directory();
    let path = directory.path();
    let outputs = |of: &str, more: &str| {
        let one = |name: &str, code: &str| {
            format!(
                "  - {{ name: {name}, of: joint man/{of}, what: {name}, component: [x, y, z], code: 11NECKUP00H3{code}?A{more} }}\n"
            )
        };
        format!("outputs:\n{}{}", one("force", "FO"), one("moment", "MO"))
    };
    for who in share(3, people()) {
        let carried = who.two([("thorax", 0.0), ("head", 0.05)], 0.25);
        // on either side of the joint it is the same channel
        for more in ["", ", axes: man/head", ", on: man/thorax"] {
            holds(path, &carried, "head", 1.0, &who, &outputs("head", more));
        }
        // the head carries the thorax, and the hand pushes the chest the other way
        let carrying = who.two([("head", 0.05), ("thorax", -0.2)], 0.0);
        holds(
            path,
            &carrying,
            "thorax",
            -1.0,
            &who,
            &outputs("thorax", ""),
        );
    }
}

/// The femur is compressed where the knee is pushed to the hip, at either end, whichever part carries the other.
#[test]
fn a_femur_that_is_pushed_is_negative() {
    let directory = directory();
    let path = directory.path();
    for who in people() {
        let system = who.two([("pelvis", 0.05), ("left-thigh", -0.17)], 0.0);
        let shank = format!(
            "      - {{ name: left-shank, on: left-thigh, at: {}, joint: weld, mass: 4 kg, cg: {}, inertia: [0.05, 0.05, 0.05] }}\n    start",
            who.at(-0.42),
            who.at(-0.2)
        );
        let system = system.replace("    start", &shank);
        let outputs = "outputs:\n  - { name: hip, of: joint man/left-thigh, what: force, component: z, code: 11FEMRLE00H3FOZA }\n  \
                       - { name: knee, of: joint man/left-shank, what: force, component: z, on: man/left-thigh, axes: local, code: 11FEMRLE01H3FOZA }\n  \
                       - { name: shank, of: joint man/left-shank, what: force, component: z, axes: man/left-thigh, code: 11FEMRLE02H3FOZA }\n";
        let push = who.hand([0.0, 0.0, 1000.0]);
        let text = format!(
            "{HEADER}{system}forces:\n  - {{ load: hand, on: man/left-shank, force: {push:?} }}\n{outputs}"
        );
        for value in first_row(path, &text) {
            assert!((value + 1000.0).abs() < 0.1, "{value}\n{text}");
        }
    }
}

/// A blow to the back, to the left side and on the top is positive; so is a turn about each axis of the standard by the
/// right hand.
#[test]
fn sensors_have_the_signs_of_blows() {
    let directory = directory();
    let path = directory.path();
    let outputs = "outputs:\n  - { name: blow, of: man/head, what: accelerometer, component: [x, y, z], code: 11HEADCG00H3AC?A }\n  \
                   - { name: turn, of: man/head, what: angular_acceleration, component: [x, y, z], code: 11HEADCG00H3AA?A }\n";
    let blows = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    for who in people() {
        let system = format!(
            "systems:\n  - name: man\n    {}\n    elements: [{{ name: head, mass: 5 kg, cg: {}, inertia: [0.02, 0.02, 0.02] }}]\n    start: {{ {} }}\n",
            who.anatomy,
            who.at(0.05),
            who.start.replace("ROOT", "head")
        );
        for (channel, parts) in blows.into_iter().enumerate() {
            let [force, moment] = [5.0, 0.2].map(|size| who.hand(parts.map(|x| size * x)));
            let text = format!(
                "{HEADER}{system}forces:\n  - {{ load: hand, on: man/head, at: cg, force: {force:?}, moment: {moment:?} }}\n{outputs}"
            );
            let found = first_row(path, &text);
            for (index, value) in found.iter().enumerate() {
                let size = if index < 3 { 1.0 } else { 10.0 };
                let expected = if index % 3 == channel { size } else { 0.0 };
                assert!(
                    (value - expected).abs() < 1e-6,
                    "{channel} {found:?}\n{text}"
                );
            }
        }
    }
}

/// The image of a part whose frame is turned has the mirrored frame: both hands are struck outwards, along their own x.
#[test]
fn a_mirror_image_has_its_own_axes() {
    let directory = directory();
    let path = directory.path();
    let text = format!(
        "{HEADER}systems:\n  - name: man\n    elements:\n      - {{ name: torso, mass: 1e6 kg, cg: [0, 0, 0], inertia: [1e6, 1e6, 1e6] }}\n      \
         - {{ name: left-hand, mirror: true, on: torso, at: [0, 0.3, 0], joint: {{ slider: y }}, anatomy: {{ forward: y }}, mass: 0.5 kg, cg: [0, 0, 0], inertia: [0.001, 0.001, 0.001] }}\nforces:\n  \
         - {{ load: left-blow, on: man/left-hand, force: [0, 1, 0] }}\n  - {{ load: right-blow, on: man/right-hand, force: [0, -1, 0] }}\noutputs:\n  \
         - {{ name: left, mirror: true, of: man/left-hand, what: accelerometer, component: x, code: 11HANDLE00H3ACXA }}\n"
    );
    for value in first_row(path, &text) {
        assert!((value - 2.0).abs() < 1e-4, "{value}");
    }
}

/// Rates, angles and displacements: nodding forward turns against y, a body that rises moves against z, one that goes
/// to the right along y.
#[test]
fn motions_have_the_axes_of_the_standard() {
    let directory = directory();
    let path = directory.path();
    let text = "model: hand\ndimension: 3\nsystems:\n  - name: man\n    elements: [{ name: head, mass: 5 kg, cg: [0, 0, 0], inertia: [0.02, 0.02, 0.02] }]\n    \
                start: { velocity: [1, 2, 3], rates: { head: [0, 0.5, 0] } }\noutputs:\n  \
                - { name: way, of: man/head, what: displacement, component: [x, y, z], code: 11HEADCG00H3DS?A }\n  \
                - { name: speed, of: man/head, what: velocity, component: [x, y, z], code: 11HEADCG00H3VE?A }\n  \
                - { name: nod, of: man/head, what: angle, component: y, code: 11HEADCG00H3ANYA }\n  \
                - { name: rate, of: man/head, what: angular_velocity, component: y, code: 11HEADCG00H3AVYA }\nrun: { duration: 10 ms, every: 10 ms }\n";
    fs::write(path.join("model.yaml"), text).unwrap();
    let rows = call(path, &["run", "model.yaml", "--no-files", "--csv", "-"], 0).0;
    let last = rows.lines().last().unwrap().split(',').skip(1);
    let last: Vec<f64> = last.map(|cell| cell.parse().unwrap()).collect();
    let expected = [0.01, -0.02, -0.03, 1.0, -2.0, -3.0, -0.005, -0.5];
    for (found, expected) in last.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{last:?}");
    }
}

/// In the plane there are x, z and the turn about y, for somebody who faces either way.
#[test]
fn a_planar_neck_has_the_same_signs() {
    let directory = directory();
    let path = directory.path();
    for (facing, anatomy) in [(1.0, ""), (-1.0, "anatomy: { forward: -x }")] {
        let model = |load: &str| {
            format!(
                "model: plane\ndimension: 2\nsystems:\n  - name: man\n    reference: fixed\n    {anatomy}\n    elements:\n      \
                 - {{ name: thorax, mass: 1e6 kg, cg: [0, 0], inertia: 1e6 }}\n      - {{ name: head, on: thorax, at: [0, 0.25], joint: weld, mass: 4.5 kg, cg: [0, 0.05], inertia: 0.03 }}\n\
                 forces:\n  - {{ load: hand, on: man/head, {load} }}\ncriteria: {{ standard: FMVSS 208, dummy: Hybrid III 50M, neck: man/head }}\nrun: {{ duration: 10 ms, every: 1 ms }}\n"
            )
        };
        for (load, expected) in [
            (
                format!("force: [{}, 0]", -100.0 * facing),
                [100.0, 0.0, 0.0],
            ),
            ("force: [0, 100]".to_owned(), [0.0, 100.0, 0.0]),
            // of somebody who faces x, a positive moment presses the chin to the sternum
            (format!("moment: {}", 10.0 * facing), [0.0, 0.0, 10.0]),
        ] {
            let found = first_row(path, &model(&load));
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-2,
                    "{load}: {found} {expected}"
                );
            }
        }
    }
}

/// A torso on a sled, on whose neck a head nods; the codes stand at outputs, or `criteria` makes them.
fn nodding(direction: f64, outputs: &str, criteria: &str) -> String {
    format!(
        "model: nod\ndimension: 3\nparameters: {{ braking: {{ value: 10 gn, min: 0, max: 30 gn }} }}\nvehicles:\n  - {{ name: sled, start: {{ velocity: [10, 0, 0] }}, acceleration: [{{ curve: {{ unit: [ms, 1], \
         points: [[0, 0], [20, {direction}], [80, {direction}], [100, 0]] }}, times: braking }}, 0, 0] }}\nsystems:\n  - name: man\n    reference: {{ on: sled, at: [0, 0, 0.5] }}\n    elements:\n      \
         - {{ name: thorax, joint: {{ hinge: y }}, mass: 17 kg, cg: [0, 0, 0.12], inertia: [0.3, 0.3, 0.2] }}\n      \
         - {{ name: head, on: thorax, at: [0, 0, 0.25], mass: 6.08 kg, cg: [0, 0, 0.12], inertia: [0.033, 0.036, 0.025] }}\nforces:\n  - {{ field: gravity, acceleration: [0, 0, -1 gn] }}\n  \
         - {{ joint: man/thorax, stiffness: 5000, damping: 100 }}\n  - {{ joint: man/head, axis: z, flexion: {{ stiffness: 60, damping: 1 }}, torsion: {{ stiffness: 60, damping: 1 }} }}\n\
         {outputs}run: {{ duration: 150 ms, every: 10 ms }}\ncriteria: {{ standard: FMVSS 208, dummy: Hybrid III 50M, {criteria} }}\n"
    )
}

const CODED: &str = "outputs:\n  - { name: neck, of: joint man/head, what: force, component: [x, y, z], axes: local, code: 11NECKUP00H3FO?A }\n  \
                     - { name: neck moment, of: joint man/head, what: moment, component: [x, y, z], axes: local, code: 11NECKUP00H3MO?A }\n";

fn criterion<'v>(judged: &'v Value, name: &str) -> &'v Value {
    let all = judged["criteria"]["criteria"].as_array().unwrap();
    all.iter().find(|one| one["criterion"] == name).unwrap()
}

/// A braked torso: the head flies forward, so the neck pulls, and bends forward. A pushed one: the head lags, and the
/// neck bends back.
#[test]
fn a_head_that_nods_is_judged_as_what_it_does() {
    let directory = directory();
    let path = directory.path();
    let run = |text: &str, more: &[&str]| -> Value {
        fs::write(path.join("nod.yaml"), text).unwrap();
        let arguments = [&["run", "nod.yaml", "--no-files", "--json"], more].concat();
        serde_json::from_str(&call(path, &arguments, 0).0).unwrap()
    };
    let detail = |judged: &Value| {
        criterion(judged, "Nij")["detail"]
            .as_str()
            .unwrap()
            .to_owned()
    };
    let value = |judged: &Value, name: &str| criterion(judged, name)["value"].as_f64().unwrap();
    let coded = run(&nodding(-1.0, CODED, "head: man/head"), &[]);
    assert!(
        detail(&coded).starts_with("tension and flexion at"),
        "{coded}"
    );
    assert!(value(&coded, "neck tension") > 5.0 * value(&coded, "neck compression"));
    let rear = run(&nodding(1.0, CODED, "head: man/head"), &[]);
    assert!(detail(&rear).contains("extension at"), "{rear}");
    // `neck` makes the same three channels
    let made = run(&nodding(-1.0, "", "neck: man/head"), &[]);
    for name in ["Nij", "neck tension", "neck compression"] {
        let of = |judged: &Value| criterion(judged, name)["value"].clone();
        assert_eq!(of(&made), of(&coded));
        assert_eq!(detail(&made), detail(&coded));
    }
    // a man who only sits has compression, by the weight of his head: 6.08 kg
    let sits = run(
        &nodding(-1.0, CODED, "head: man/head"),
        &["--set", "braking=0"],
    );
    assert!(
        (value(&sits, "neck compression") / (6.08 * 9.80665) - 1.0).abs() < 1e-3,
        "{sits}"
    );
    assert_eq!(value(&sits, "neck tension"), 0.0);
    // other programs get the same signs
    fs::write(
        path.join("nod.yaml"),
        nodding(-1.0, CODED, "head: man/head"),
    )
    .unwrap();
    let mme = [
        "run",
        "nod.yaml",
        "--no-files",
        "--every",
        "0.1 ms",
        "--mme",
        "test",
    ];
    call(path, &mme, 0);
    let judge = [
        "criteria",
        "test",
        "--standard",
        "FMVSS 208",
        "--dummy",
        "Hybrid III 50M",
        "--json",
    ];
    let read: Value = serde_json::from_str(&call(path, &judge, 0).0).unwrap();
    let read = serde_json::json!({ "criteria": read });
    assert!(
        detail(&read).starts_with("tension and flexion at"),
        "{read}"
    );
    assert!(
        (value(&read, "Nij") / value(&coded, "Nij") - 1.0).abs() < 1e-3,
        "{read}"
    );
}

#[test]
fn what_would_have_a_wrong_sign_is_refused() {
    let directory = directory();
    let path = directory.path();
    let check = |text: &str, told: &str| {
        fs::write(path.join("nod.yaml"), text).unwrap();
        let (_, error) = call(path, &["check", "nod.yaml"], 2);
        assert!(error.contains(told), "{told}: {error}");
    };
    let text = nodding(-1.0, CODED, "head: man/head");
    for (from, to, told) in [
        (
            "component: [x, y, z], axes: local, code: 11NECKUP00H3FO?A",
            "component: x, code: 11NECKUP00H3FOZA",
            "wants the component z",
        ),
        (
            "what: force, component: [x, y, z], axes: local",
            "what: force, component: [x, y, z], axes: frame",
            "turns with the head",
        ),
        (
            "what: force, component: [x, y, z], axes: local",
            "what: force, component: [x, y, z], on: man/thorax, axes: local",
            "turns with the head",
        ),
        (
            "inertia: [0.033, 0.036, 0.025] }",
            "inertia: [0.033, 0.036, 0.025], neck: lower }",
            "write NECKLO in its code",
        ),
        (
            "inertia: [0.033, 0.036, 0.025] }",
            "inertia: [0.033, 0.036, 0.025], anatomy: { forward: z } }",
            "not at right angles",
        ),
        (
            "cg: [0, 0, 0.12], inertia: [0.033",
            "cg: [0, 0, -0.13], inertia: [0.033",
            "which side of the joint",
        ),
    ] {
        assert!(text.contains(from), "{from}");
        check(&text.replace(from, to), told);
    }
    let lower = CODED.replace("NECKUP", "NECKLO");
    check(
        &nodding(-1.0, &lower, "neck_fz: neck z"),
        "there is no Nij of the lower one",
    );
    check(&nodding(-1.0, "", "neck: man/neck"), "man/neck");
    check(&nodding(-1.0, CODED, "neck: neck z"), "is no head");
    let sensor = "outputs:\n  - { name: head, of: man/head, what: accelerometer, component: x, axes: frame, code: 11HEADCG00H3ACXA }\n";
    check(
        &nodding(-1.0, sensor, "neck: man/head"),
        "of a sensor that turns with",
    );
    // without a code it has the axes of the model, and a name on the command line does not turn it
    let plain = CODED
        .replace(", code: 11NECKUP00H3FO?A", "")
        .replace(", code: 11NECKUP00H3MO?A", "");
    fs::write(
        path.join("nod.yaml"),
        nodding(-1.0, &plain, "head: man/head"),
    )
    .unwrap();
    let (_, error) = call(
        path,
        &[
            "run",
            "nod.yaml",
            "--no-files",
            "--criteria",
            "FMVSS 208, Hybrid III 50M",
            "--place",
            "neck-fz=neck z",
        ],
        2,
    );
    assert!(
        error.contains("has the axes of the model") && error.contains("11NECKUP00H3FOZA"),
        "{error}"
    );
    // `criteria` of a model turns it
    fs::write(
        path.join("nod.yaml"),
        nodding(
            -1.0,
            &plain,
            "neck_fx: neck x, neck_fz: neck z, neck_my: neck moment y",
        ),
    )
    .unwrap();
    let (text, _) = call(path, &["run", "nod.yaml", "--no-files"], 0);
    assert!(text.contains("tension and flexion"), "{text}");
}

/// Of a body like a Hybrid III the joint of the head is at C7/T1, and its accelerometer at the centre of gravity of
/// head and neck.
#[test]
fn a_head_with_its_neck_has_no_upper_load_cell() {
    let directory = directory();
    let path = directory.path();
    let model = |like: &str, code: &str, criteria: &str| {
        format!(
            "model: sits\ndimension: 3\ninclude: [{{ human: {{ like: {like}, posture: seated }}, system: man }}]\noutputs:\n  \
             - {{ name: neck, of: joint man/head, what: force, component: [x, z], code: 11{code}00H3FO?A }}\n  - {{ name: neck moment, of: joint man/head, what: moment, component: y, code: 11{code}00H3MOYA }}\n\
             run: {{ duration: 5 ms, every: 1 ms }}\ncriteria: {{ standard: FMVSS 208, dummy: Hybrid III 50M, {criteria} }}\n"
        )
    };
    let told = |text: String, code: i32| {
        fs::write(path.join("sits.yaml"), text).unwrap();
        let (out, error) = call(path, &["run", "sits.yaml", "--no-files"], code);
        out + &error
    };
    for like in ["hybrid-3-50", "hybrid-3-5", "child-6", "child-3"] {
        let written = call(path, &["human", "--like", like], 0).0;
        assert!(written.contains("neck: lower"), "{written}");
        let refused = told(model(like, "NECKUP", "head: man/head"), 2);
        assert!(
            refused.contains("at C7/T1") && refused.contains("NECKLO"),
            "{refused}"
        );
    }
    let refused = told(model("hybrid-3-50", "NECKLO", "neck: man/head"), 2);
    assert!(
        refused.contains("the place neck") && refused.contains("at C7/T1"),
        "{refused}"
    );
    let judged = told(model("hybrid-3-50", "NECKLO", "head: man/head"), 0);
    assert!(
        judged.contains("at their common centre of gravity"),
        "{judged}"
    );
    assert!(
        judged.contains("not judged") && judged.contains("Nij (neck-fx)"),
        "{judged}"
    );
    // a person has no load cells: said, and not refused
    let judged = told(model("male-50", "NECKUP", "head: man/head"), 0);
    assert!(judged.contains("at C7/T1"), "{judged}");
}

/// The torques of the neck are 0 in the posture, unless they are wanted upright; in space and in the plane, by a model
/// and by the command.
#[test]
fn the_neutral_angles_of_a_person_are_those_of_the_posture() {
    let directory = directory();
    let path = directory.path();
    for dimension in [2, 3] {
        let moment = |more: &str| {
            let text = format!(
                "model: sits\ndimension: {dimension}\ninclude: [{{ human: {{ like: hybrid-3-50, posture: seated, angles: {{ trunk: -25 deg, head: 25 deg }}{more} }}, system: man }}]\noutputs:\n  \
                 - {{ name: neck, of: joint man/head, what: moment, component: y }}\nrun: {{ duration: 1 ms, every: 1 ms }}\n"
            );
            first_row(path, &text)[0]
        };
        assert!(moment("").abs() < 1e-9, "{}", moment(""));
        assert!(moment(", neutral: upright").abs() > 20.0);
    }
    let human = |more: &[&str]| {
        let arguments = [
            "human",
            "--like",
            "male-50",
            "--posture",
            "seated",
            "--angle",
            "head=25 deg",
        ];
        call(path, &[&arguments, more].concat(), 0).0
    };
    assert!(human(&[]).contains("neutral: 25 deg"));
    assert!(!human(&["--neutral", "upright"]).contains("neutral: 25 deg"));
}

/// An acceleration in a field other than gravity is read by no instrument: it is refused where it is judged, and said
/// where it is a response.
#[test]
fn what_no_instrument_reads_is_not_judged() {
    let directory = directory();
    let path = directory.path();
    let model = |field: &str, more: &str| {
        format!(
            "model: sled\ndimension: 2\ncurves: {{ pulse: {{ unit: [ms, gn], points: [[0, 0], [10, 0], [20, 20], [90, 20], [100, 0]] }} }}\nsystems:\n  - name: man\n    reference: fixed\n    elements:\n      \
             - {{ name: torso, mass: 30 kg, cg: [0, 0.2], inertia: 1.1 }}\n      - {{ name: head, on: torso, at: [0, 0.45], mass: 4.5 kg, cg: [0.02, 0.1], inertia: 0.03 }}\nforces:\n  - {{ field: sled, acceleration: {field} }}\n  \
             - {{ joint: man/torso, stiffness: 3000, damping: 60 }}\n  - {{ joint: man/head, stiffness: 60, damping: 2 }}\noutputs:\n  - {{ name: head, of: man/head, what: acceleration }}\n  \
             - {{ name: instrument, of: man/head, what: accelerometer }}\nrun: {{ duration: 150 ms, every: 10 ms }}\n{more}"
        )
    };
    let run = |text: &str, more: &[&str], code: i32| {
        fs::write(path.join("sled.yaml"), text).unwrap();
        let (out, error) = call(
            path,
            &[&["run", "sled.yaml", "--no-files"], more].concat(),
            code,
        );
        out + &error
    };
    let judged = ["--criteria", "FMVSS 208, Hybrid III 50M", "--place"];
    let (sled, gravity) = ("[pulse, 0]", "[0, -1 gn]");
    let wrong = run(&model(sled, ""), &[&judged[..], &["head=head"]].concat(), 2);
    assert!(
        wrong.contains("the field \"sled\" acts there") && wrong.contains("what: accelerometer"),
        "{wrong}"
    );
    run(
        &model(sled, ""),
        &[&judged[..], &["head=instrument"]].concat(),
        0,
    );
    run(
        &model(gravity, ""),
        &[&judged[..], &["head=head"]].concat(),
        0,
    );
    let of_model = "criteria: { standard: FMVSS 208, dummy: Hybrid III 50M, head: head }\n";
    assert!(run(&model(sled, of_model), &[], 2).contains("is no reading of an instrument"));
    for (response, warned) in [
        ("HIC15 of head", true),
        ("3 ms clip of head", true),
        ("peak of head", false),
        ("HIC15 of instrument", false),
    ] {
        let told = run(&model(sled, ""), &["-r", response], 0);
        assert_eq!(
            told.contains("warning: \"head\" is no reading of an instrument"),
            warned,
            "{response}: {told}"
        );
        assert!(!run(&model(gravity, ""), &["-r", response], 0).contains("no reading"));
    }
    let with_parameter =
        model(sled, "parameters: { loss: 60 }\n").replace("damping: 60", "damping: loss");
    fs::write(path.join("sled.yaml"), with_parameter).unwrap();
    let study = "model: sled.yaml\ntables: [csv]\ndesign: grid\nparameters: { loss: { values: [60, 70] } }\nresponses: [{ of: head, what: HIC15 }]\n";
    fs::write(path.join("study.yaml"), study).unwrap();
    let (_, told) = call(path, &["sweep", "study.yaml", "--out", "rows"], 0);
    assert!(
        told.contains("warning: \"head\" is no reading of an instrument"),
        "{told}"
    );
}
