//! Pictures of a run and of a study: their views, and their formats.

use super::command_call::call;
use super::directory;
use std::path::Path;

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

fn is_png(path: &Path) -> bool {
    std::fs::read(path).is_ok_and(|bytes| bytes.starts_with(PNG))
}

#[test]
fn every_picture_can_be_had_as_png() {
    let directory = directory();
    let here = directory.path();
    let run = ["run", "clock.yaml", "--plot", "swing", "--pictures"];
    call(here, &[&run[..], &["png"]].concat(), 0);
    assert!(is_png(&here.join("clock.png")));
    assert!(is_png(&here.join("clock-swing-over-time.png")));
    assert!(!here.join("clock.svg").exists());
    call(here, &[&run[..], &["svg"]].concat(), 0);
    let plot = std::fs::read_to_string(here.join("clock-swing-over-time.svg")).unwrap();
    assert!(plot.starts_with("<svg") && plot.contains("swing [rad]"));

    let study = "\
model: clock.yaml
design: saltelli
runs: 48
parameters: { gravity: { from: 5, to: 15 } }
responses: [{ of: bob height, what: mean }]
";
    std::fs::write(here.join("study.yaml"), study).unwrap();
    call(here, &["sweep", "study.yaml", "--pictures", "png"], 0);
    for name in ["scatter", "tornado"] {
        assert!(is_png(&here.join(format!("study-results/{name}.png"))));
    }
    call(here, &["merge", "study-results"], 0);
    let scatter = std::fs::read_to_string(here.join("study-results/scatter.svg")).unwrap();
    assert!(scatter.contains("mean of bob height [m]") && scatter.contains("gravity [m/s²]"));
}

#[test]
fn a_model_in_space_is_seen_from_where_asked() {
    let directory = directory();
    for (view, across, upwards) in [
        ("side", "x [m]", "z [m]"),
        ("front", "y [m]", "z [m]"),
        ("top", "x [m]", "y [m]"),
        ("oblique", "across [m]", "up [m]"),
    ] {
        let picture = ["--no-files", "--picture", "-", "--view", view];
        let run = ["run", "dummy15", "--duration", "20 ms", "--no-verify"];
        let (svg, _) = call(directory.path(), &[&run[..], &picture].concat(), 0);
        for name in [across, upwards] {
            assert!(svg.contains(&format!(">{name}<")), "{view}: no {name}");
        }
    }
    let planar = ["run", "clock.yaml", "--view", "top"];
    let (_, told) = call(directory.path(), &planar, 2);
    assert!(told.contains("clock is planar") && told.contains("help: leave out --view"));
    let (_, told) = call(
        directory.path(),
        &["run", "clock.yaml", "--view", "back"],
        2,
    );
    assert!(told.contains("oblique"), "{told}");
    assert!(!directory.path().join("clock.csv").exists());
}

/// The picture of a scene, after `run`.
fn svg(scene: &str, more: &[&str]) -> String {
    let directory = directory();
    std::fs::write(directory.path().join("scene.yaml"), scene).unwrap();
    let run = [
        "run",
        "scene.yaml",
        "--no-files",
        "--no-verify",
        "--picture",
        "-",
    ];
    call(directory.path(), &[&run[..], more].concat(), 0).0
}

fn headings(svg: &str) -> Vec<&str> {
    let parts = svg.split("class=\"time\"").skip(1);
    let texts = parts.map(|part| part.split('>').nth(1).unwrap());
    texts.map(|text| text.split('<').next().unwrap()).collect()
}

/// A rod that turns about the axis AXIS with RATE, at the origin.
const TURNING: &str = "model: scene
dimension: 3
systems:
  - name: rotor
    reference: fixed
    elements: [{ name: rod, joint: { hinge: AXIS }, mass: 1, cg: [0.2, 0.2, 0], inertia: [0.1, 0.1, 0.1] }]
    start: { joint_rates: { rod: RATE } }
run: { duration: 1 s, every: 125 ms }
";

/// A figure is left out where nothing has moved. A rod that has turned by whole turns has moved.
#[test]
fn what_stands_still_is_drawn_once() {
    let turning = |rate: &str| {
        svg(
            &TURNING.replace("AXIS", "y").replace("RATE", rate),
            &["--figures", "3"],
        )
    };
    assert_eq!(headings(&turning("0")), ["0 ms to 1 s"]);
    let turns = turning("25.132741228718345");
    assert_eq!(headings(&turns), ["0 ms", "500 ms", "1 s"]);
    // a rod that comes to rest is drawn until then
    let friction = "forces: [{ joint: rotor/rod, friction: 5, friction_speed: 0.01 }]\nrun:";
    let stops = TURNING
        .replace("AXIS", "y")
        .replace("RATE", "5")
        .replace("run:", friction);
    let stops = svg(&stops, &["--figures", "8"]);
    let found = headings(&stops);
    assert!(
        found.len() < 5 && found[found.len() - 1].ends_with(" to 1 s"),
        "{found:?}"
    );
}

/// The view is that from which the motion is seen largest.
#[test]
fn a_picture_looks_at_the_motion() {
    for (axis, across, upwards) in [
        ("x", "y [m]", "z [m]"),
        ("y", "x [m]", "z [m]"),
        ("z", "x [m]", "y [m]"),
    ] {
        let scene = TURNING
            .replace("AXIS", axis)
            .replace("RATE", "3")
            .replace("[0.2, 0.2, 0]", "[0.2, 0.2, 0.2]");
        // in the plane of the turn the rod is seen to turn
        let scene = match axis {
            "x" => scene.replace("cg: [0.2, 0.2, 0.2]", "cg: [0, 0.3, 0]"),
            _ => scene.replace("cg: [0.2, 0.2, 0.2]", "cg: [0.3, 0, 0]"),
        };
        let svg = svg(&scene, &[]);
        for name in [across, upwards] {
            assert!(svg.contains(&format!(">{name}<")), "{axis}: no {name}");
        }
    }
}

/// A stone that falls by 20 m.
const FALLING: &str = "model: scene
dimension: 2
systems: [{ name: stone, elements: [{ name: stone, mass: 1, cg: [0.1, 0], inertia: 0.02 }] }]
forces: [{ field: gravity, acceleration: [0, -10] }]
run: { duration: 2 s, every: 1 s }
";

/// With a vehicle the view moves: a passenger at rest in it stands still in the picture, and the headings say how far
/// it has gone.
#[test]
fn a_picture_moves_with_the_vehicle() {
    let scene = "model: scene
dimension: 3
vehicles: [{ name: car, start: { velocity: [20, 0, 0] } }]
systems:
  - name: man
    reference: { on: car, at: [0, 0, 1] }
    elements: [{ name: rod, joint: { hinge: y }, mass: 1, cg: [0, 0, -0.2], inertia: [0.1, 0.1, 0.1] }]
run: { duration: 1 s, every: 250 ms }
";
    let driving = svg(scene, &["--figures", "3"]);
    assert_eq!(
        headings(&driving),
        ["0 ms", "500 ms, gone 10.0 m", "1 s, gone 20.0 m"]
    );
    assert!(driving.contains("the view moves with car"));
    let parked = svg(&scene.replace("20, 0, 0", "0, 0, 0"), &["--figures", "3"]);
    assert!(!parked.contains("the view moves"));
    assert_eq!(headings(&parked), ["0 ms to 1 s"]);
    // what falls far is followed, too
    let falling = svg(FALLING, &["--figures", "3"]);
    assert!(falling.contains("the view moves with stone/stone"));
    let overlay = svg(FALLING, &["--figures", "3", "--overlay"]);
    assert!(!overlay.contains("the view moves"));
    assert_eq!(
        headings(&falling),
        ["0 ms", "1 s, gone 5.00 m", "2 s, gone 20.0 m"]
    );
}
