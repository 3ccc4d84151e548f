//! Joints that follow others across a base that rests, rotors, and limits.

use super::{
    INERTIAL, LIMIT, Options, about_y, acceleration, between, derive, imported, joint, link, notes,
    of_urdf, read, refused, robot,
};

/// A finger whose centre of mass is at y = ±0.02 m, z = 0.05 m.
fn finger(name: &str, side: f64) -> String {
    let y = 0.02 * side;
    let inertia =
        r#"<mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0" izz="1e-5"/>"#;
    link(
        name,
        &format!("<inertial><origin xyz=\"0 {y} 0.05\"/>{inertia}</inertial>"),
    )
}

/// A hinge about x.
fn about_x(name: &str, kind: &str, [parent, child]: [&str; 2], y: f64, more: &str) -> String {
    let inside = format!("<origin xyz=\"0 {y} 0\"/><axis xyz=\"1 0 0\"/>{LIMIT}{more}");
    between(name, kind, parent, child, &inside)
}

/// Two fingers on a palm, and more.
fn gripper(palm: &str, more: &[String]) -> String {
    let follows = "<mimic joint=\"finger\" multiplier=\"-1\"/>";
    let own = [
        link("palm", palm),
        finger("left", 1.0),
        finger("right", -1.0),
        about_x("finger", "revolute", ["palm", "left"], 0.03, ""),
        about_x("other", "revolute", ["palm", "right"], -0.03, follows),
    ];
    robot(&[&own, more].concat())
}

#[test]
fn fingers_on_a_palm_that_rests_follow_each_other() {
    // both fall outwards: S = 2 (J + m (y² + z²)), r = −2 m g y
    let s = 2.0 * (1e-4 + 0.1 * (0.02f64.powi(2) + 0.05f64.powi(2)));
    let r = -2.0 * 0.1 * 9.81 * 0.02;
    for palm in ["", INERTIAL] {
        let text = imported(&gripper(palm, &[]), &Options::default()).yaml;
        let found = acceleration(&text);
        assert!(
            (found / (r / s) - 1.0).abs() < 1e-14,
            "{found} {}\n{text}",
            r / s
        );
    }
    // a third finger that follows none is a system of its own
    let model = of_urdf(&gripper(
        "",
        &[
            finger("thumb", 1.0),
            about_x("third", "continuous", ["palm", "thumb"], 0.0, ""),
        ],
    ));
    assert_eq!(
        (model.systems.len(), derive(&model).velocities.len()),
        (2, 2)
    );
    // a body that floats, with a finger that follows one on the palm
    let model = of_urdf(&gripper(
        "",
        &[
            link("ball", INERTIAL),
            finger("thumb", 1.0),
            between("flies", "floating", "palm", "ball", ""),
            about_x(
                "third",
                "continuous",
                ["ball", "thumb"],
                0.0,
                "<mimic joint=\"finger\"/>",
            ),
        ],
    ));
    assert_eq!(
        (model.systems.len(), derive(&model).velocities.len()),
        (1, 7)
    );
}

#[test]
fn rotors_of_transmissions_are_armatures() {
    let arm = |inside: &str| {
        about_y(&format!(
            "<transmission name=\"t\">{inside}</transmission>\n"
        ))
    };
    // about y: J = 0.02 + 2 · 0.1² kg m², and gravity turns by m g x = 2 · 9.81 · 0.1 N m
    let (inertia, torque) = (0.04, 2.0 * 9.81 * 0.1);
    let on_hinge =
        |inside: &str| format!("<joint name=\"hinge\"/><actuator name=\"m\">{inside}</actuator>");
    for (inside, armature) in [
        (on_hinge(""), 0.0),
        (on_hinge("<mechanicalReduction>50</mechanicalReduction>"), 0.0),
        (on_hinge("<mechanicalReduction>-50</mechanicalReduction><motorInertia>1e-5</motorInertia>"), 0.025),
        (on_hinge("<motorInertia>1e-2</motorInertia>"), 0.01),
        (on_hinge("<drake:rotor_inertia value=\"1e-4\"/><drake:gear_ratio value=\"20\"/>"), 0.04),
        (on_hinge("<motorInertia>1e-2</motorInertia>") + "<actuator name=\"b\"><motorInertia>2e-2</motorInertia></actuator>", 0.03),
        ("<joint name=\"hinge\"><mechanicalReduction>10</mechanicalReduction></joint><actuator name=\"m\"><motorInertia>1e-4</motorInertia></actuator>".to_owned(), 0.01),
    ] {
        let found = acceleration(&imported(&arm(&inside), &Options::default()).yaml);
        let expected = torque / (inertia + armature);
        assert!((found / expected - 1.0).abs() < 1e-13, "{found} {expected}\n{inside}");
    }
    for (inside, part) in [
        (
            "<joint name=\"elbow\"/><actuator><motorInertia>1</motorInertia></actuator>",
            "\"elbow\"",
        ),
        (
            "<joint name=\"hinge\"/><actuator><motorInertia>-1</motorInertia></actuator>",
            "motorInertia",
        ),
        (
            "<joint name=\"hinge\"/><actuator><motorInertai>1</motorInertai></actuator>",
            "did you mean",
        ),
    ] {
        let found = refused(&arm(inside)).to_string();
        assert!(found.contains(part), "{inside}\n{found}");
    }
    let two = arm(
        "<joint name=\"hinge\"/><joint name=\"hinge\"/><actuator><motorInertia>1</motorInertia></actuator>",
    );
    let said = notes(&two);
    assert!(
        said.contains("although the motion depends on it: rotors"),
        "{said}"
    );
}

#[test]
fn limits_may_be_infinite_or_empty_and_those_of_motors_are_kept() {
    let limited = |limit: &str| {
        joint(
            "type=\"revolute\"",
            &format!("<axis xyz=\"0 1 0\"/><limit {limit}/>"),
        )
    };
    let stops = Options {
        stops: Some(1e4),
        ..Options::default()
    };
    for (limit, stop, empty) in [
        (
            r#"lower="-inf" upper="inf" effort="inf" velocity="inf""#,
            None,
            false,
        ),
        (
            r#"lower="-INF" upper="1" effort="0" velocity="0""#,
            Some("stop: { to: 1, stiffness: "),
            false,
        ),
        (
            r#"lower="-1" upper="Infinity" effort="0" velocity="0""#,
            Some("stop: { from: -1, stiffness: "),
            false,
        ),
        (r#"lower="0" upper="0" effort="0" velocity="0""#, None, true),
        (r#"effort="0" velocity="0""#, None, true),
    ] {
        let found = imported(&limited(limit), &stops);
        read(&found.yaml);
        match stop {
            Some(stop) => assert!(found.yaml.contains(stop), "{limit}\n{}", found.yaml),
            None => assert!(!found.yaml.contains("stop:"), "{limit}\n{}", found.yaml),
        }
        let said = found
            .notes
            .iter()
            .any(|n| n.contains("\"wrist\", line 6, are both 0"));
        assert_eq!(said, empty, "{limit}: {:?}", found.notes);
        read(&imported(&limited(limit), &Options::default()).yaml);
    }
    let kept = imported(
        &limited(r#"lower="-1" upper="2" effort="87" velocity="2.5""#),
        &stops,
    );
    for part in ["at most 87 N·m", "2.5 rad/s"] {
        assert!(kept.yaml.contains(part), "{part}\n{}", kept.yaml);
    }
    assert!(
        kept.notes.iter().any(|n| n.contains("effort and speed")),
        "{:?}",
        kept.notes
    );
    let wrong = limited(r#"lower="nan" upper="1" effort="1" velocity="1""#);
    assert!(refused(&wrong).to_string().contains("nan"));
}
