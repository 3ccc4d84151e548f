//! Robots from URDF are imported and run.

use super::command_call::call;
use super::directory;

const ARM: &str = r#"<robot name="two-arm">
<link name="base"/>
<link name="Upper Arm">
  <visual><geometry><mesh filename="arm.stl"/></geometry></visual>
  <inertial><origin xyz="0 0 -0.2"/><mass value="2"/><inertia ixx="0.03" ixy="0" ixz="0.001" iyy="0.03" iyz="0" izz="0.01"/></inertial>
</link>
<joint name="shoulder" type="revolute">
  <parent link="base"/><child link="Upper Arm"/><origin xyz="0 0 1" rpy="0 0 1.5708"/><axis xyz="0 1 0"/>
  <limit lower="-0.5" upper="0.5" effort="1" velocity="1"/>
</joint>
</robot>
"#;

#[test]
fn a_robot_is_imported_and_runs() {
    let directory = directory();
    std::fs::write(directory.path().join("arm.urdf"), ARM).unwrap();
    let (written, notes) = call(directory.path(), &["import", "arm.urdf"], 0);
    assert!(
        written.contains("name: upper_arm") && written.contains("# Imported from arm.urdf."),
        "{written}"
    );
    assert!(written.contains("mesh: { file: \"arm.stl\","), "{written}");
    for part in ["--stops", "--right-angles", "line 8"] {
        assert!(notes.contains(part), "{part}\n{notes}");
    }
    let (nothing, _) = call(
        directory.path(),
        &["import", "arm.urdf", "-o", "arm.yaml"],
        0,
    );
    assert!(nothing.is_empty());
    // and a line with the checksum of all lines above
    let kept = std::fs::read_to_string(directory.path().join("arm.yaml")).unwrap();
    let (above, last) = kept.trim_end().rsplit_once('\n').unwrap();
    assert_eq!(above.trim_end(), written.trim_end());
    assert!(last.starts_with("# Written by bryant"), "{last}");
    // the file and the model imported from it are one model
    let table = |model| call(directory.path(), &["run", model, "--no-files"], 0).0;
    assert_eq!(table("arm.urdf"), table("arm.yaml"));
    assert!(table("arm.urdf").contains("shoulder"));
    // whoever runs the file gets the notes of the import
    for command in ["run", "check"] {
        let (_, told) = call(directory.path(), &[command, "arm.urdf"], 0);
        for note in notes.lines() {
            assert!(told.contains(note), "{command}: {note}\n{told}");
        }
        let (_, told) = call(directory.path(), &[command, "arm.yaml"], 0);
        assert!(!told.contains("--stops"), "{command}: {told}");
    }
    // an error that only the model shows has its place in the file: a hinge that moves no inertia
    let flat = ARM.replace("0 0 -0.2", "0 0 0");
    let flat = ["0.03", "0.001", "0.01"]
        .into_iter()
        .fold(flat, |text, value| {
            text.replace(&format!("=\"{value}\""), "=\"0\"")
        });
    std::fs::write(directory.path().join("flat.urdf"), flat).unwrap();
    for command in ["import", "run", "check"] {
        let (_, wrong) = call(directory.path(), &[command, "flat.urdf"], 2);
        assert!(
            wrong.contains("without any inertia") && wrong.contains("flat.urdf:3:"),
            "{command}: {wrong}"
        );
    }
    // effects have the places of the links and joints
    let (effects, _) = call(directory.path(), &["effects", "arm.urdf", "--no-time"], 0);
    assert!(!effects.contains("arm.urdf:1 "), "{effects}");
    let (held, _) = call(
        directory.path(),
        &["import", "arm.urdf", "--stops", "1e5"],
        0,
    );
    assert!(
        held.contains("stop: { from: -0.5, to: 0.5, stiffness: 1e5 }"),
        "{held}"
    );
    let (_, wrong) = call(
        directory.path(),
        &["import", "arm.urdf", "--stops", "-1"],
        2,
    );
    assert!(wrong.contains("positive"), "{wrong}");
    std::fs::write(
        directory.path().join("wrong.urdf"),
        ARM.replace("0 1 0", "0 0 0"),
    )
    .unwrap();
    for command in ["import", "run", "check"] {
        let (_, wrong) = call(directory.path(), &[command, "wrong.urdf"], 2);
        assert!(
            wrong.contains("wrong.urdf:8:") && wrong.contains("help:"),
            "{wrong}"
        );
    }
}

#[test]
fn a_robot_is_known_by_the_content_of_its_file() {
    let directory = directory();
    let write = |name: &str, text: &str| std::fs::write(directory.path().join(name), text).unwrap();
    for name in ["arm.urdf", "ARM.URDF", "arm.xml", "arm.txt"] {
        write(name, ARM);
    }
    write("blank.urdf", &format!("\n {ARM}"));
    for command in [&["run", "--no-files"][..], &["equations"]] {
        let of = |name: &str| call(directory.path(), &[command, &[name]].concat(), 0).0;
        for name in ["ARM.URDF", "arm.xml", "arm.txt", "blank.urdf"] {
            assert_eq!(of(name), of("arm.urdf"), "{command:?} {name}");
        }
    }
    call(directory.path(), &["check", "ARM.URDF"], 0);
    // other encodings of XML: UTF-16 as PowerShell writes it, and ISO 8859-1 where the file says so
    let marked = format!("\u{feff}{ARM}");
    let utf16 = marked.encode_utf16().flat_map(u16::to_le_bytes);
    let latin = format!("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?><!-- \u{fc} -->\n{ARM}");
    let latin = latin.chars().map(|c| c as u8);
    for (name, bytes) in [
        ("utf16.urdf", utf16.collect::<Vec<u8>>()),
        ("latin.urdf", latin.collect()),
    ] {
        std::fs::write(directory.path().join(name), bytes).unwrap();
        let run = |name| call(directory.path(), &["run", "--no-files", name], 0).0;
        assert_eq!(run(name), run("arm.urdf"), "{name}");
    }
    // what is no robot is named by what it is, in every command that takes a model
    write("pendulum.xml", "<mujoco model=\"pendulum\"/>");
    write("world.sdf", "<sdf version=\"1.7\"/>");
    for command in ["check", "run", "equations", "effects", "settle", "import"] {
        for (name, what) in [("pendulum.xml", "MJCF"), ("world.sdf", "SDF")] {
            let (_, wrong) = call(directory.path(), &[command, name], 2);
            assert!(
                wrong.contains(what) && wrong.contains("help:"),
                "{command}: {wrong}"
            );
        }
    }
    // a file of shapes alone is refused, and repaired on demand
    let start = ARM.find("  <inertial>").unwrap();
    let end = ARM.find("</inertial>").unwrap() + "</inertial>".len();
    write("shape.urdf", &[&ARM[..start], &ARM[end..]].concat());
    let (_, wrong) = call(directory.path(), &["check", "shape.urdf"], 2);
    assert!(wrong.contains("--repair-inertias"), "{wrong}");
    let import = [
        "import",
        "shape.urdf",
        "--repair-inertias",
        "-o",
        "shape.yaml",
    ];
    let (_, told) = call(directory.path(), &import, 0);
    assert_eq!(told.matches("repaired: ").count(), 2, "{told}");
    call(directory.path(), &["check", "shape.yaml"], 0);
}
