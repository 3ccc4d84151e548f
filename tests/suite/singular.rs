//! Positions and axes of joints that make no motion: named at the start of a run and by `check`.

use super::command_call::call;

/// A body on a joint, with a force on it or without.
fn on_a_joint(joint: &str, force: &str) -> String {
    format!(
        "model: several
dimension: 3
systems:
  - name: arm
    reference: fixed
    elements: [{{ name: hand, mass: 2 kg, cg: [0.1, 0.2, 0.3], inertia: [0.1, 0.2, 0.25], joint: {joint} }}]
forces: [{{ field: earth, acceleration: [0, 0, -9.81] }}{force}]
run: {{ duration: 1 s, every: 0.1 s }}
"
    )
}

#[test]
fn a_start_in_a_singular_position_of_a_joint_is_named() {
    let directory = tempfile::tempdir().unwrap();
    let three = "[ { hinge: z }, { hinge: y }, { hinge: x } ]";
    let text = on_a_joint(three, "");
    let with = |angle: &str| {
        let start = format!("start: {{ joints: {{ hand: [0 deg, {angle}, 0 deg] }} }}\nforces");
        text.replace("forces", &format!("    {start}"))
    };
    let run = |angle: &str, code: i32| {
        std::fs::write(directory.path().join("several.yaml"), with(angle)).unwrap();
        call(
            directory.path(),
            &["run", "several.yaml", "--no-files"],
            code,
        )
        .1
    };
    for angle in ["90 deg", "-90 deg", "89.99999999 deg"] {
        let told = run(angle, 3);
        assert!(
            told.contains("the joint of \"arm/hand\" is in, or close to, a singular position")
                && told.contains("there angle-z and angle-x move the element alike"),
            "{told}"
        );
    }
    // the run can continue away from there
    run("60 deg", 0);
    // where rounding alone says how it leaves such a position, it is not trusted
    let euler = "[ { hinge: z, name: a }, { hinge: x, name: b }, { hinge: z, name: c } ]";
    let start = "    start: { joints: { hand: [0, 180 deg, 0] } }\nforces";
    let text = on_a_joint(euler, "").replace("forces", start);
    let run = |text: String, code: i32| {
        std::fs::write(directory.path().join("several.yaml"), text).unwrap();
        let arguments = ["run", "several.yaml", "--no-files", "--no-verify"];
        call(directory.path(), &arguments, code).1
    };
    let told = run(text.clone(), 3);
    assert!(
        told.contains("at the start the joint of \"arm/hand\" is in a singular position")
            && told.contains("there a and c move the element alike"),
        "{told}"
    );
    // a rotor keeps the mass matrix regular
    run(text.replace("name: c", "name: c, armature: 0.05"), 0);
}

#[test]
fn check_warns_of_singular_positions_of_a_joint() {
    let three = "[ { hinge: z }, { hinge: y }, { hinge: x } ]";
    let stop = |to: &str| {
        format!(
            ", {{ joint: arm/hand, freedom: angle-y, stop: {{ from: -{to}, to: {to}, stiffness: 100 }} }}"
        )
    };
    let tilted = "[ { hinge: z }, { hinge: [0, 1, 1], name: tilt }, { hinge: x } ]";
    let polar = "[ { hinge: z, name: first }, { slider: x }, { hinge: z, name: last } ]";
    for (joint, force, told) in [
        (
            three,
            "",
            Some(
                "is singular at angle-y = -90° or 90°: there angle-z and angle-x move the element alike",
            ),
        ),
        (
            "free",
            "",
            Some("angle-y = -90° or 90°: there angle-x and angle-z move"),
        ),
        (
            three,
            &stop("85 deg"),
            Some("comes within 10° of angle-y = -90° or 90°, where it is singular"),
        ),
        (three, &stop("79 deg"), None),
        // a.(b x c) = 0 if the axis of the last joint lies in the plane of the others
        (tilted, "", Some("is singular at tilt = -90° or 90°")),
        (
            polar,
            "",
            Some("is singular at position-x = 0 mm: there first and last move"),
        ),
        (
            "[ { hinge: z, name: a, armature: 0.1 }, { hinge: x, name: b }, { hinge: z, name: c } ]",
            "",
            None,
        ),
        (
            "[ { hinge: x, name: a }, { hinge: [1, 1e-5, 0], name: b } ]",
            "",
            Some("the axes of a and b of \"arm/hand\" are only 6e-4° apart"),
        ),
        (
            "[ { slider: z, name: a }, { slider: [0.02, 0, -1], name: b } ]",
            "",
            Some("are only 1.1° apart"),
        ),
        (
            "[ { hinge: x, name: a }, { hinge: [1, 0.05, 0], name: b } ]",
            "",
            None,
        ),
        (
            "[ { hinge: x, name: a }, { slider: [1, 1e-5, 0], name: b } ]",
            "",
            None,
        ),
        ("{ universal: [x, y] }", "", None),
        ("{ cylinder: z }", "", None),
        ("{ planar: z }", "", None),
        ("translation", "", None),
        ("{ hinge: x }", "", None),
    ] {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(
            directory.path().join("several.yaml"),
            on_a_joint(joint, force),
        )
        .unwrap();
        let (_, stderr) = call(directory.path(), &["check", "several.yaml"], 0);
        match told {
            Some(told) => assert!(stderr.contains(told), "{joint}: {stderr}"),
            None => assert!(
                !stderr.contains("singular") && !stderr.contains("apart"),
                "{joint}: {stderr}"
            ),
        }
    }
}

#[test]
fn an_axis_of_parameters_needs_a_direction() {
    let directory = tempfile::tempdir().unwrap();
    let scene = on_a_joint("{ hinge: [a, 0, b] }", "")
        .replace("dimension: 3", "dimension: 3\nparameters: { a: 1, b: 1 }");
    std::fs::write(directory.path().join("axis.yaml"), scene).unwrap();
    let run = |set: [&str; 2], code: i32| {
        let arguments = [
            "run",
            "axis.yaml",
            "--no-files",
            "--set",
            set[0],
            "--set",
            set[1],
        ];
        call(directory.path(), &arguments, code).1
    };
    // squares that overflow, vanish, or keep few digits; no direction; no number
    for set in [
        ["a=1e200", "b=1"],
        ["a=1e-200", "b=0"],
        ["a=1e-162", "b=0"],
        ["a=0", "b=0"],
    ] {
        let told = run(set, 2);
        assert!(
            told.contains("`joint` of arm/hand must have an axis with a direction"),
            "{set:?}: {told}"
        );
    }
    for set in [["a=1e100", "b=1"], ["a=1e-100", "b=0"], ["a=0", "b=-3"]] {
        run(set, 0);
    }
}

#[test]
fn a_freedom_without_inertia_has_the_remedy_that_helps() {
    let twice = on_a_joint("[ { hinge: z, name: a }, { hinge: z, name: b } ]", "");
    let light = on_a_joint("{ hinge: z }", "").replace(
        "cg: [0.1, 0.2, 0.3], inertia: [0.1, 0.2, 0.25]",
        "cg: [0, 0, 0.3], inertia: [0.1, 0.1, 0]",
    );
    for (scene, help) in [
        (twice, "whatever its mass: remove one of them"),
        (
            light,
            "give what it carries mass or moments of inertia there",
        ),
    ] {
        let directory = tempfile::tempdir().unwrap();
        std::fs::write(directory.path().join("several.yaml"), scene).unwrap();
        let (_, stderr) = call(directory.path(), &["check", "several.yaml"], 2);
        assert!(
            stderr.contains("without any inertia") && stderr.contains(help),
            "{stderr}"
        );
    }
}
