//! Every part of a file is read, listed with its line, or refused.

use super::{Options, imported, notes, refused};

/// A robot with every element that is read, each in a line of its own.
const WHOLE: &str = r#"<robot name="whole">
<link name="base"/>
<link name="arm">
<inertial>
<origin xyz="0.1 0 0"/>
<mass value="2"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.015"/>
</inertial>
</link>
<link name="hand">
<inertial>
<origin xyz="0.1 0 0"/>
<mass value="2"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.015"/>
</inertial>
</link>
<joint name="hinge" type="revolute">
<parent link="base"/>
<child link="arm"/>
<origin xyz="0 0 1"/>
<axis xyz="0 1 0"/>
<limit lower="-1" upper="2" effort="10" velocity="1"/>
<dynamics damping="1"/>
<safety_controller k_velocity="1"/>
<calibration rising="0"/>
</joint>
<joint name="wrist" type="revolute">
<parent link="arm"/>
<child link="hand"/>
<mimic joint="hinge"/>
<limit lower="-1" upper="2" effort="10" velocity="1"/>
</joint>
</robot>
"#;

/// The line of `</robot>`.
const LAST: usize = 33;

#[test]
fn what_stands_once_is_refused_twice() {
    for element in [
        "inertial",
        "origin",
        "mass",
        "inertia",
        "parent",
        "child",
        "axis",
        "limit",
        "dynamics",
        "mimic",
        "safety_controller",
        "calibration",
    ] {
        let begin = match element {
            "inertial" => "<inertial>".to_owned(),
            _ => format!("<{element} "),
        };
        let start = WHOLE.find(&begin).unwrap();
        let end = match element {
            "inertial" => "</inertial>",
            _ => "/>",
        };
        let end = start + WHOLE[start..].find(end).unwrap() + end.len();
        let text = format!("{}\n{}{}", &WHOLE[..end], &WHOLE[start..end], &WHOLE[end..]);
        let found = refused(&text).to_string();
        let line = WHOLE[..start].matches('\n').count() + 1;
        for part in [
            format!("two <{element}>"),
            format!("the first is in line {line}"),
        ] {
            assert!(found.contains(&part), "{element}\n{found}");
        }
    }
}

/// The robot with another line.
fn with_line(number: usize, changed: &str) -> String {
    let lines = WHOLE.lines().enumerate();
    let lines = lines.map(|(i, line)| if i + 1 == number { changed } else { line });
    lines.collect::<Vec<&str>>().join("\n")
}

#[test]
fn nothing_vanishes() {
    let plain = notes(WHOLE);
    for (index, line) in WHOLE.lines().enumerate() {
        let number = index + 1;
        // with what is listed as a whole everything inside is listed
        if ["</", "<safety", "<calib"]
            .iter()
            .any(|begin| line.starts_with(begin))
        {
            continue;
        }
        let end = line.find(['/', '>']).unwrap();
        let tag = line[1..end].split(' ').next().unwrap();
        let attribute = format!("{} strange=\"1\"{}", &line[..end], &line[end..]);
        let element = match line.ends_with("/>") {
            true => format!("{}><strange/></{tag}>", &line[..end]),
            false => format!("{line}<strange/>"),
        };
        for changed in [attribute, element, format!("{line}words")] {
            let found = notes(&with_line(number, &changed));
            assert_ne!(found, plain, "{changed}");
            assert!(
                found.contains("URDF does not know it")
                    && found.contains(&format!("line {number}")),
                "{number}: {changed}\n{found}"
            );
        }
    }
}

#[test]
fn misspelt_names_are_refused_with_the_right_one() {
    for (right, wrong, meant) in [
        ("<axis xyz=", "<axes xyz=", "axis"),
        ("<axis xyz=", "<axis xzy=", "xyz"),
        ("<origin xyz=\"0 0 1\"", "<origin rp=\"0 0 1\"", "rpy"),
        ("<dynamics damping", "<dynamic damping", "dynamics"),
        ("damping=\"1\"", "dampng=\"1\" friction=\"0\"", "damping"),
        ("<mimic joint", "<mimick joint", "mimic"),
        (
            "joint=\"hinge\"",
            "joint=\"hinge\" multiplyer=\"2\"",
            "multiplier",
        ),
        (
            "<link name=\"base\"/>",
            "<link name=\"base\"/><Link name=\"b\"/>",
            "link",
        ),
        ("type=\"revolute\"", "type=\"revolut\"", "revolute"),
    ] {
        assert!(WHOLE.contains(right), "{right}");
        let found = refused(&WHOLE.replacen(right, wrong, 1));
        let help = |meant: &str| {
            found
                .problems
                .iter()
                .any(|p| p.help.starts_with("did you mean") && p.help.contains(meant))
        };
        assert!(help(meant), "{wrong}\n{found}");
    }
}

#[test]
fn what_the_motion_depends_on_is_named() {
    for (right, wrong, part) in [
        (
            "damping=\"1\"",
            "damping=\"1\" spring_stiffness=\"40\"",
            "springs of joints (1), line 23",
        ),
        (
            "<axis xyz=\"0 1 0\"/>",
            "<axis xyz=\"0 1 0\"/><joint_properties friction=\"1\"/>",
            "<joint_properties>",
        ),
        (
            "</robot>",
            "<gazebo><joint name=\"closes\" type=\"revolute\"/></gazebo></robot>",
            "joints of Gazebo",
        ),
        (
            "</robot>",
            "<gazebo reference=\"arm\"><turnGravityOff>true</turnGravityOff></gazebo></robot>",
            "gravity of single links",
        ),
        (
            "</robot>",
            "<force_element name=\"f\"/></robot>",
            "forces of Drake (1), line 33: \"f\"",
        ),
    ] {
        let found = notes(&WHOLE.replacen(right, wrong, 1));
        assert!(
            found.contains("although the motion depends on it") && found.contains(part),
            "{wrong}\n{found}"
        );
    }
    for element in [
        "loop_joint",
        "constraint",
        "drake:ball_constraint",
        "drake:joint",
    ] {
        let more = format!("<{element} name=\"l\"/></robot>");
        let found = refused(&WHOLE.replace("</robot>", &more));
        assert_eq!(found.problems[0].line, LAST, "{found}");
        assert!(
            found.to_string().contains(&format!("<{element}> \"l\"")),
            "{found}"
        );
    }
}

#[test]
fn a_tensor_that_is_written_whole_is_symmetric() {
    let both = |lower: &str| {
        WHOLE.replacen(
            "iyy=",
            &format!("iyx=\"{lower}\" izx=\"0\" izy=\"0\" iyy="),
            1,
        )
    };
    assert_eq!(
        imported(&both("0"), &Options::default()).yaml,
        imported(WHOLE, &Options::default()).yaml
    );
    let said = notes(&both("0.001"));
    assert!(
        said.contains("below the diagonal") && said.contains("line 7"),
        "{said}"
    );
}
