//! What `bryant check` and `bryant run` say of mistakes, most of which leave a model valid, and that they do not say it
//! of others.

use super::command_call::call;
use super::directory;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A man on a sled of 44 km/h = 12.22 m/s that brakes, held by a belt on a reel; each test spoils a part.
const SLED: &str = "model: sled
dimension: 2
parameters: { load: 60 kN }
curves: { crash: { unit: [ms, gn], points: [[0, 0], [20, -20], [80, 0]] } }
vehicles: [{ name: sled, start: { velocity: [44 km/h, 0] }, acceleration: [crash, 0] }]
systems:
  - name: man
    elements:
      - { name: torso, mass: 30 kg, cg: [0, 0.2], inertia: 1.1 }
    start: { position: [0, 0.3], velocity: [44 km/h, 0] }
surfaces:
  seat: { on: sled, at: [0, 0], normal: [0, 1], extent: 0.4 }
forces:
  - { field: gravity, acceleration: [0, -1 gn] }
  - { contact: seat, ellipsoid: { on: man/torso, center: [0, 0], semi_axes: [0.31, 0.31] }, plane: seat, stiffness: 100 kN/m, damping: 300 }
  - { belt: chest, from: { on: man/torso, at: [0.1, 0.35] }, to: { on: sled, at: [-0.4, 0.5] }, stiffness: load, damping: 300, retractor: { lock: crash, spool: 5 N } }
switches: [{ switch: crash, when: { of: sled, what: acceleration, component: x, below: -5 gn } }]
outputs: [{ name: belt, of: belt chest, what: force }]
run: { duration: 60 ms, every: 20 ms }
";

/// What `check` warns of.
fn warnings(path: &Path, text: &str) -> Vec<String> {
    fs::write(path.join("sled.yaml"), text).unwrap();
    let (told, _) = call(path, &["check", "sled.yaml", "--json"], 0);
    let told: Value = serde_json::from_str(&told).unwrap();
    let all = told["warnings"].as_array().unwrap().iter();
    all.map(|one| one.as_str().unwrap().to_owned()).collect()
}

/// What `run` says beside its results.
fn notes(path: &Path, text: &str, more: &[&str]) -> Vec<String> {
    fs::write(path.join("sled.yaml"), text).unwrap();
    let run = ["run", "sled.yaml", "--json", "--no-files", "--no-verify"];
    let (told, _) = call(path, &[&run[..], more].concat(), 0);
    let told: Value = serde_json::from_str(&told).unwrap();
    let all = told["notes"].as_array().unwrap().iter();
    all.map(|one| one.as_str().unwrap().to_owned()).collect()
}

#[test]
fn nothing_is_said_of_a_scene_that_is_right() {
    let directory = directory();
    assert_eq!(warnings(directory.path(), SLED), [""; 0]);
    assert_eq!(notes(directory.path(), SLED, &[]), [""; 0]);
}

#[test]
fn each_mistake_is_said_by_check_and_by_run() {
    let directory = directory();
    let path = directory.path();
    let mistakes = [
        // 44 km/h are 12.2 m/s
        (
            "position: [0, 0.3], velocity: [44 km/h, 0]",
            "position: [0, 0.3]",
            "\"man\" starts at 0 m/s, but \"sled\", to which its contact \"seat\" leads, at 12.2 m/s",
        ),
        // 0.3 m over the plane, whose normal points down
        (
            "normal: [0, 1]",
            "normal: [0, -1]",
            "contact \"seat\" begins with \"man/torso\" on the wrong side: the centre of its ellipsoid is 0.3 m behind the plane",
        ),
        (
            "  - { field: gravity, acceleration: [0, -1 gn] }\n",
            "",
            "no field acts, so nothing has weight",
        ),
        (
            "curves: {",
            "curves: { spare: { points: [[0, 0], [1, 1]] },",
            "the curve \"spare\" (sled.yaml:4) is used by nothing",
        ),
        (
            "parameters: {",
            "parameters: { spare: 1,",
            "the parameter \"spare\" (sled.yaml:3) is used by nothing",
        ),
        (
            "switches: [",
            "switches: [{ switch: spare, when: { time: 1 ms } }, ",
            "nothing waits for the switch \"spare\"",
        ),
    ];
    for (right, wrong, said) in mistakes {
        let text = SLED.replacen(right, wrong, 1);
        assert_ne!(text, SLED);
        // a run so short that nothing follows from the mistake, not even that the switch fires
        let short = ["--duration", "1 ms", "--every", "1 ms"];
        let mut of_run = notes(path, &text, &short);
        of_run.retain(|note| !note.contains("did not fire"));
        for told in [warnings(path, &text), of_run] {
            assert_eq!(told.len(), 1, "{said}\n{told:?}");
            assert!(told[0].contains(said), "{said}\n{told:?}");
        }
    }
}

/// A field without acceleration says that nothing is to have weight, as a number or as a parameter.
#[test]
fn a_scene_in_space_says_that_nothing_has_weight() {
    let directory = directory();
    let path = directory.path();
    for zero in ["[0, 0]", "[0, 0 gn]", "[0, nothing]"] {
        let text = SLED.replacen("[0, -1 gn]", zero, 1).replacen(
            "parameters: {",
            "parameters: { nothing: 0 m/s^2,",
            1,
        );
        let told = warnings(path, &text);
        assert!(
            !told.iter().any(|one| one.contains("no field acts")),
            "{told:?}"
        );
    }
}

/// A field that is switched off, whatever its acceleration, says nothing.
#[test]
fn a_field_that_is_switched_off_gives_no_weight() {
    let directory = directory();
    for off in ["[0, 0], enabled: false", "[0, -1 gn], enabled: false"] {
        let text = SLED.replacen("[0, -1 gn]", off, 1);
        assert_ne!(text, SLED);
        let told = warnings(directory.path(), &text);
        assert_eq!(told.len(), 1, "{told:?}");
        assert!(told[0].contains("no field acts"), "{told:?}");
        // one that acts beside it is enough
        let more = format!("forces:\n  - {{ field: none, acceleration: {off} }}\n");
        let both = SLED.replacen("forces:\n", &more, 1);
        assert_ne!(both, SLED);
        assert_eq!(warnings(directory.path(), &both), [""; 0]);
    }
}

/// A bristle of a millimetre bends within 0.1 s at 0.01 m/s, and within a day at 1e-8 m/s.
#[test]
fn friction_that_takes_for_ever_to_hold_is_said_before_the_run() {
    let directory = directory();
    let path = directory.path();
    let of = |speed: &str| {
        let law = "stiffness: 100 kN/m, ";
        let more =
            format!("{law}friction: 0.3, friction_speed: {speed}, friction_displacement: 1 mm, ");
        SLED.replacen(law, &more, 1)
    };
    let told = warnings(path, &of("1e-8 m/s"));
    assert!(
        told.len() == 1
            && told[0].contains(
                "contact \"seat\" holds by friction within `friction_displacement`, 1e-3 m"
            )
            && told[0].contains("1e5 s")
            && told[0].contains("near 1e-1 m/s"),
        "{told:?}"
    );
    assert_eq!(warnings(path, &of("0.01 m/s")), [""; 0]);
}

/// The belt alone ties the man to the sled as well; a body that is said to rest is left alone, and so is a slow one on
/// a conveyor.
#[test]
fn a_body_is_left_behind_by_what_ties_it() {
    let directory = directory();
    let path = directory.path();
    let rests = SLED.replace(", velocity: [44 km/h, 0] }\nsurfaces", " }\nsurfaces");
    let free = rests.replace("extent: 0.4", "at: [9, 0], extent: 0.4");
    let free = free.replace("at: [0, 0], normal", "normal");
    let told = warnings(path, &free);
    assert!(
        told.len() == 1 && told[0].contains("to which its belt \"chest\" leads"),
        "{told:?}"
    );
    let meant = rests.replace("position: [0, 0.3]", "position: [0, 0.3], velocity: [0, 0]");
    assert_eq!(warnings(path, &meant), [""; 0]);
    let belt = rests.find("  - { belt").unwrap();
    let end = rests.find("switches").unwrap();
    let parcel = format!(
        "{}{}",
        &rests[..belt],
        &rests[rests.find("run:").unwrap()..]
    );
    assert!(end > belt);
    let parcel = parcel.replace("parameters: { load: 60 kN }\n", "");
    let conveyor = parcel.replace(
        "velocity: [44 km/h, 0] }, acceleration",
        "velocity: [2, 0] }, acceleration",
    );
    assert_eq!(warnings(path, &conveyor), [""; 0]);
    assert_eq!(warnings(path, &parcel).len(), 1);
    // a state of rest of a sled of another speed
    let slow = SLED.replace("44 km/h", "22 km/h");
    fs::write(path.join("slow.yaml"), slow).unwrap();
    let short = [
        "run",
        "slow.yaml",
        "--no-files",
        "--duration",
        "1 ms",
        "--every",
        "1 ms",
    ];
    call(
        path,
        &[&short[..], &["--final-state", "rest.json"]].concat(),
        0,
    );
    let state = fs::read_to_string(path.join("rest.json")).unwrap();
    let mut state: Value = serde_json::from_str(&state).unwrap();
    state["time"] = 0.0.into();
    fs::write(path.join("rest.json"), state.to_string()).unwrap();
    let told = notes(path, SLED, &["--start", "rest.json"]);
    assert!(
        told.iter()
            .any(|one| one.contains("\"man\" starts at 6.11 m/s, but \"sled\"")),
        "{told:?}"
    );
}

/// The sled decelerates by 20 gn along x: above 5 gn is never, below −5 gn is at 5 ms.
#[test]
fn a_switch_that_does_not_fire_says_how_near_it_came() {
    let directory = directory();
    let path = directory.path();
    let never = SLED.replace("below: -5 gn", "above: 5 gn");
    let told = notes(path, &never, &[]);
    let said = "the switch \"crash\" did not fire: the largest value is 0 gn, the threshold 5 gn";
    assert_eq!(told, [said]);
    let nearly = SLED.replace("below: -5 gn", "below: -21 gn");
    let told = notes(path, &nearly, &[]);
    let said =
        "the switch \"crash\" did not fire: the smallest value is -20 gn, the threshold -21 gn";
    assert_eq!(told, [said]);
    let late = SLED.replace(
        "of: sled, what: acceleration, component: x, below: -5 gn",
        "time: 0.2 s",
    );
    let told = notes(path, &late, &[]);
    let said = "the switch \"crash\" did not fire: its time is 0.2 s, and the run ends at 0.06 s";
    assert_eq!(told, [said]);
}

/// A ball of 20 kg that lies 60 mm deep in foam and glides over an edge.
const EDGE: &str = "model: edge
dimension: 2
systems:
  - name: ball
    elements: [{ name: ball, mass: 20 kg, cg: [0, 0], inertia: 0.1 }]
    start: { position: [0.1, 0.04], velocity: [2, 0] }
forces:
  - { field: gravity, acceleration: [0, -1 gn] }
  - { load: weight, on: ball/ball, at: cg, force: [0, -4 kN] }
  - contact: foam
    ellipsoid: { on: ball/ball, center: [0, 0], semi_axes: [0.1, 0.1] }
    plane: { on: frame, at: [0, 0], normal: [0, 1], extent: 0.25 }
    elastic: { unit: [mm, N], points: [[0, 0], [30, 700], [60, 4200], [90, 12000]], extrapolate: linear }
    damping: 300
outputs: [{ name: foam, of: contact foam, what: force, component: [x, z] }]
run: { duration: 80 ms, every: 0.5 ms }
";

/// Over 10 mm the push is 3/2 E/width = 12.6 kN of 4.2 kN (E = 84 J at 60 mm); over the 90 mm of the curve it stays
/// below 3/4 of the force.
#[test]
fn an_edge_pushes_less_than_the_surface_or_says_so() {
    let directory = directory();
    let path = directory.path();
    let largest = |text: &str, code: i32| {
        fs::write(path.join("edge.yaml"), text).unwrap();
        let (told, error) = call(path, &["run", "edge.yaml", "--json", "--no-files"], code);
        let told: Value = serde_json::from_str(&told).unwrap();
        let rows = told["rows"].as_array().unwrap().iter();
        let largest = |column: usize| {
            let values = rows.clone().map(|row| row[column].as_f64().unwrap().abs());
            values.fold(0.0, f64::max)
        };
        ([largest(1), largest(2)], error)
    };
    let ([aside, up], _) = largest(EDGE, 0);
    assert!(aside > 0.0 && aside < 0.75 * up, "{aside} {up}");
    let narrow = EDGE.replace(
        "extent: 0.25",
        "extent: 0.25, edge: { rule: fade, width: 10 mm }",
    );
    let ([aside, up], error) = largest(&narrow, 3);
    assert!(aside > 2.0 * up, "{aside} {up}");
    assert!(
        error.contains("the edge of \"contact foam\" pushes harder than the surface, up to "),
        "{error}"
    );
}

/// Belts that a state lacks begin at their start; those that only the state has are left out; orientations convert.
#[test]
fn a_state_starts_a_scene_with_another_belt_and_other_coordinates() {
    let directory = directory();
    let path = directory.path();
    let scene = |coordinates: &str, belt: bool| {
        format!(
            "model: swing
dimension: 3
coordinates: {coordinates}
systems:
  - name: man
    elements: [{{ name: torso, mass: 30, cg: [0, 0, 0.2], inertia: [1, 1.2, 0.4] }}]
    start: {{ position: [0, 0, 1], velocity: [0.5, 0, 0], angles: {{ torso: [20 deg, 60 deg, -40 deg] }}, rates: {{ torso: [1, 2, 3] }} }}
forces:
  - {{ field: gravity, acceleration: [0, 0, -1 gn] }}
  - {{ belt: lap, enabled: {belt}, from: {{ on: man/torso, at: [0, 0, 0] }}, to: {{ on: frame, at: [0, 0, 2] }}, stiffness: 1 kN, retractor: {{ lock: late, spool: 5 N }} }}
switches: [{{ switch: late, when: {{ time: 1 ms }} }}]
outputs: [{{ name: turn, of: man/torso, what: angle, component: [x, y, z] }}, {{ name: spin, of: man/torso, what: angular_velocity, component: [x, y, z] }}, {{ name: late, of: switch late, what: acts }}]
run: {{ duration: 0.2 s, every: 0.1 s }}
"
        )
    };
    for (name, coordinates, belt) in [
        ("q-belt.yaml", "quaternion", true),
        ("b.yaml", "bryant", false),
        ("q.yaml", "quaternion", false),
        ("b-belt.yaml", "bryant", true),
    ] {
        fs::write(path.join(name), scene(coordinates, belt)).unwrap();
    }
    let last = |name: &str, more: &[&str]| -> (Vec<f64>, String) {
        let run = ["run", name, "--json", "--no-files", "--tolerance", "1e-9"];
        let (told, error) = call(path, &[&run[..], more].concat(), 0);
        let told: Value = serde_json::from_str(&told).unwrap();
        let row = told["rows"].as_array().unwrap().last().unwrap();
        let values = row.as_array().unwrap().iter().map(|x| x.as_f64().unwrap());
        (values.collect(), error)
    };
    for (first, then) in [("q.yaml", "b.yaml"), ("b.yaml", "q.yaml")] {
        let (whole, _) = last(then, &[]);
        last(
            first,
            &["--duration", "0.1 s", "--final-state", "half.json"],
        );
        let (halves, _) = last(then, &["--start", "half.json"]);
        for (a, b) in whole.iter().zip(&halves) {
            assert!((a - b).abs() < 1e-6, "{first} {then}: {whole:?} {halves:?}");
        }
    }
    last(
        "q.yaml",
        &["--duration", "0.1 s", "--final-state", "half.json"],
    );
    let (_, error) = last("b-belt.yaml", &["--start", "half.json"]);
    assert!(
        error.contains("of what only swing has; these begin as at its start: belt lap"),
        "{error}"
    );
    last(
        "q-belt.yaml",
        &["--duration", "0.1 s", "--final-state", "half.json"],
    );
    let (_, error) = last("b.yaml", &["--start", "half.json"]);
    assert!(
        error.contains("of what swing does not have, and which are left out: belt lap"),
        "{error}"
    );
}

/// Each freedom of a joint may have a law of its own, which wants a name; one force for all is no remedy.
#[test]
fn laws_of_several_freedoms_want_names() {
    let directory = directory();
    let path = directory.path();
    let model = |names: [&str; 2]| {
        let mut text = "model: cart\ndimension: 3\nsystems:\n  - name: m\n    reference: fixed\n    \
                        elements: [{ name: b, joint: translation, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }]\nforces:\n"
            .to_owned();
        for (name, freedom) in names.iter().zip(["position-x", "position-y"]) {
            text += &format!("  - {{ joint: m/b, {name}freedom: {freedom}, stiffness: 100 }}\n");
        }
        text + "outputs: [{ name: x, of: m/b, what: position, component: x }]\nrun: { duration: 1 s, every: 0.1 s }\n"
    };
    fs::write(path.join("cart.yaml"), model([""; 2])).unwrap();
    let (_, error) = call(path, &["check", "cart.yaml"], 2);
    assert!(
        error.contains("give one of them a name") && !error.contains("one force"),
        "{error}"
    );
    fs::write(path.join("cart.yaml"), model(["name: x, ", "name: y, "])).unwrap();
    call(path, &["check", "cart.yaml"], 0);
}
