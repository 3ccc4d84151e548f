//! What a file is decides what is said; lenient readers are followed.

use super::{Options, about_y, imported, notes, refused};

#[test]
fn what_a_file_is_decides_what_is_said() {
    let of_xacro = r#"<robot name="r"><link name="l"><inertial><mass value="${m}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>"#;
    for (text, part, help) in [
        (
            r#"<mujoco model="m"><worldbody/></mujoco>"#,
            "this is MJCF",
            "YAML",
        ),
        (
            "<?xml version=\"1.0\"?>\n<!-- made by hand -->\n<sdf version=\"1.7\"/>",
            "this is SDF",
            "URDF",
        ),
        ("<COLLADA/>", "COLLADA", "shapes are not read"),
        (
            "<!DOCTYPE html>\n<html><body><p>a</body></html>",
            "HTML",
            "Raw",
        ),
        (
            r#"<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro/></robot>"#,
            "xacro",
            "xacro robot",
        ),
        (
            r#"<robot name="r"><xacro:macro/></robot>"#,
            "macros",
            "xacro robot",
        ),
        (of_xacro, "${m}", "xacro robot"),
        (
            r#"<robot name="r"><group name="arm"/></robot>"#,
            "SRDF",
            "beside it",
        ),
        (
            "<?xml version=\"1.0\"?>\n<!DOCTYPE robot>\n<robot name=\"r\"/>",
            "DOCTYPE",
            "remove",
        ),
        (r#"<robot name="a & b"/>"#, "`&`", "&amp;"),
        (
            r#"<robot name="a"><link name="a<b"/></robot>"#,
            "`<`",
            "&lt;",
        ),
        (
            "<robot name=\"a\">\n<link name=\"b\"/>\n",
            "not whole",
            "whole file",
        ),
        (
            r#"<robot name="a"><link name="b" name="c"/></robot>"#,
            "twice",
            "remove",
        ),
        (
            "<!-- a -->\n<?xml version=\"1.0\"?>\n<robot name=\"r\"/>",
            "before `<?xml",
            "beginning",
        ),
        ("model: m\ndimension: 2\n", "begins with <robot>", ".yaml"),
        ("", "empty", "URDF"),
        ("<!-- nothing -->", "no element", "URDF"),
    ] {
        let found = refused(text);
        let problem = &found.problems[0];
        assert!(
            problem.message.contains(part) && problem.help.contains(help),
            "{text}\n{found}"
        );
    }
    let doctype = refused("<?xml version=\"1.0\"?>\n<!DOCTYPE robot>\n<robot name=\"r\"/>");
    assert_eq!(
        (doctype.problems[0].line, doctype.problems[0].column),
        (2, 1)
    );
}

#[test]
fn blanks_comments_and_namespaces_are_no_hindrance() {
    let yaml = |text: &str| imported(text, &Options::default()).yaml;
    let declared = format!("<?xml version=\"1.0\"?>\n{}", about_y(""));
    let plain = yaml(&declared);
    for before in ["\n  ", "\u{feff}", "\u{feff}\r\n"] {
        assert_eq!(yaml(&format!("{before}{declared}")), plain);
    }
    let base = "<link name=\"base\"/>";
    let comment = declared.replace(base, &format!("{base}<!-- a -- b ---><!-- ü -->"));
    assert_eq!(yaml(&comment), plain);
    let namespace = declared.replace("<robot ", "<robot xmlns=\"http://www.ros.org\" ");
    assert_eq!(yaml(&namespace), plain);
}

#[test]
fn places_stay_where_prefixes_are_declared_for_a_file() {
    let more = r#"<sensor:camera name="c" a:b="1"/><a:b/>"#;
    let text = about_y(more).replacen(
        "\n<link name=\"base\"/>",
        "<link name=\"base\" x:y=\"1\"/>\n",
        1,
    );
    let text = format!("\n{text}");
    let said = notes(&text);
    assert!(
        said.contains("line 2") && said.contains("line 6"),
        "{said}\n{text}"
    );
    // in the line of the root, and in another one
    for (right, wrong) in [
        ("<axis xyz=\"0 1 0\"", "<axis xyz=\"0 0 0\""),
        ("<link name=\"base\"", "<link name=\"\""),
    ] {
        let text = text.replace(right, wrong);
        let value = wrong.rfind('"').unwrap() - wrong.find('"').unwrap() - 1;
        let (index, line) = text
            .lines()
            .enumerate()
            .find(|(_, l)| l.contains(wrong))
            .unwrap();
        let start = line.find(wrong).unwrap() + 1;
        let column = if value > 0 {
            start + wrong.find('"').unwrap() + 1
        } else {
            start
        };
        let found = refused(&text);
        let problem = &found.problems[0];
        assert_eq!(
            (problem.line, problem.column),
            (index + 1, column),
            "{found}"
        );
    }
}
