//! URDF: what is read, what is refused with which place, and the resulting model.
//!
//! The refused texts follow the tests of the ROS parser (urdfdom, `test/assets/bad_*.urdf`), one case each, in texts of
//! our own.

mod coupling;
mod digits;
mod kinds;
mod parts;
mod repair;
use bryant_generator::Diagnostics;
use bryant_generator::dynamics::derive;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::method::Method;
use bryant_generator::model::Model;
use bryant_generator::read_str;
use bryant_generator::urdf::{Base, Imported, Options, import};
use std::io;
use std::path::Path;

fn nothing_included(_: &Path) -> io::Result<String> {
    Err(io::ErrorKind::NotFound.into())
}

fn read(text: &str) -> Model {
    match read_str("model.yaml", text, &nothing_included) {
        Ok((model, _)) => model,
        Err(problems) => panic!("{problems}\n{text}"),
    }
}

fn imported(text: &str, options: &Options) -> Imported {
    import("robot.urdf", text, options).unwrap_or_else(|problems| panic!("{problems}"))
}

fn refused(text: &str) -> Diagnostics {
    match import("robot.urdf", text, &Options::default()) {
        Err(problems) => problems,
        Ok(imported) => panic!("accepted:\n{}", imported.yaml),
    }
}

const INERTIAL: &str = r#"<inertial><origin xyz="0.1 0 0"/><mass value="2"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.015"/></inertial>"#;

/// A base, and an arm on a hinge. `%` stands for the additions of a case.
const ARM: [&str; 3] = [
    "<robot name=\"arm\">\n<link name=\"base\"/>\n<link name=\"arm\">",
    "</link>\n<joint name=\"hinge\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/>",
    "</joint>\n",
];

/// The arm, with additions to its link, its joint, and the robot.
fn arm(link: &str, joint: &str, robot: &str) -> String {
    let [head, middle, tail] = ARM;
    format!("{head}{INERTIAL}{link}{middle}{joint}{tail}{robot}</robot>\n")
}

fn geometry(shape: &str) -> String {
    arm(
        &format!("\n<visual><geometry>{shape}</geometry></visual>"),
        "",
        "",
    )
}

/// Placeholders of exporters: what is only shown refuses no robot.
#[test]
fn visual_shapes_without_size_are_left_out() {
    for shape in [
        "<box size=\"0 0 0\"/>",
        "<box size=\"1 1 0\"/>",
        "<box size=\"-1 1 1\"/>",
        "<sphere radius=\"0\"/>",
        "<sphere radius=\"-1\"/>",
        "<cylinder radius=\"0.1\" length=\"0\"/>",
        "<mesh filename=\"a.stl\" scale=\"0 1 1\"/>",
    ] {
        let imported = imported(&geometry(shape), &Options::default());
        read(&imported.yaml);
        let told = imported.notes.join(" ");
        assert!(
            told.contains("visual shapes without size"),
            "{shape}: {told}"
        );
        assert!(!imported.yaml.contains("mesh"), "{shape}");
    }
    // a mirrored file is seen, and so are the ends of a capsule without a middle
    for shape in [
        "<mesh filename=\"a.stl\" scale=\"-1 1 1\"/>",
        "<capsule radius=\"0.1\" length=\"0\"/>",
    ] {
        let imported = imported(&geometry(shape), &Options::default());
        read(&imported.yaml);
        assert!(imported.yaml.contains("mesh"), "{shape}");
        assert!(
            !imported.notes.join(" ").contains("without size"),
            "{shape}"
        );
    }
}

/// A joint of a type, with its content.
fn joint(kind: &str, inside: &str) -> String {
    arm(
        "",
        "",
        &format!(
            "<link name=\"hand\">{INERTIAL}</link>\n<joint name=\"wrist\" {kind}><parent link=\"arm\"/><child link=\"hand\"/>{inside}</joint>\n"
        ),
    )
}

// Long: a line for each file.
#[test]
fn what_urdfdom_refuses_is_refused_with_its_place() {
    let long = "type=\"revolute\"";
    let cases: Vec<(&str, String, usize, &str)> = vec![
        ("box without size", geometry("<box/>"), 4, "size"),
        ("box of two sizes", geometry("<box size=\"1 2\"/>"), 4, "3 numbers"),
        ("cylinder without length", geometry("<cylinder radius=\"1\"/>"), 4, "length"),
        ("cylinder without radius", geometry("<cylinder length=\"1\"/>"), 4, "radius"),
        ("sphere without radius", geometry("<sphere/>"), 4, "radius"),
        ("mesh without file", geometry("<mesh/>"), 4, "a mesh needs a file"),
        ("unknown shape", geometry("<cone radius=\"1\"/>"), 4, "no shape <cone>"),
        ("shape without geometry", arm("\n<collision/>", "", ""), 4, "<geometry>"),
        ("two joints of a name", joint("type=\"fixed\"", "").replace("wrist", "hinge"), 6, "two joints"),
        ("two links of a name", arm("", "", "<link name=\"arm\"/>"), 5, "two links"),
        ("two materials of a name", arm("", "", "<material name=\"red\"/>\n<material name=\"red\"/>"), 6, "two materials"),
        ("empty dynamics", arm("", "\n<dynamics/>", ""), 5, "neither damping nor friction"),
        ("negative damping", arm("", "\n<dynamics damping=\"-1\"/>", ""), 5, "negative"),
        ("no XML", "<robot name=\"a\">\n<link name=\"b\">\n</robot>".into(), 3, "no XML"),
        ("joint without type", joint("", ""), 6, "no type"),
        ("joint of unknown type", joint("type=\"spherical\"", ""), 6, "no type of joint"),
        ("joint without name", arm("", "", "<joint type=\"fixed\"/>"), 5, "needs a name"),
        ("unknown child", arm("", "", "<joint name=\"j\" type=\"fixed\"><parent link=\"arm\"/>\n<child link=\"leg\"/></joint>"), 6, "the child"),
        ("unknown parent", arm("", "", "<joint name=\"j\" type=\"fixed\">\n<parent link=\"leg\"/><child link=\"arm\"/></joint>"), 6, "the parent"),
        ("no child", arm("", "", "<joint name=\"j\" type=\"fixed\"><parent link=\"arm\"/></joint>"), 5, "has no child"),
        ("limit without effort", joint(long, "\n<limit velocity=\"1\"/>"), 7, "effort"),
        ("limit without velocity", joint(long, "\n<limit effort=\"1\"/>"), 7, "velocity"),
        ("effort that is no number", joint(long, "\n<limit effort=\"much\" velocity=\"1\"/>"), 7, "much"),
        ("velocity that is no number", joint(long, "\n<limit effort=\"1\" velocity=\"1 2\"/>"), 7, "1 2"),
        ("limits that are exchanged", joint(long, "\n<limit lower=\"1\" upper=\"0\" effort=\"1\" velocity=\"1\"/>"), 7, "above the upper"),
        ("revolute without limits", joint(long, ""), 6, "no limits"),
        ("prismatic without limits", joint("type=\"prismatic\"", ""), 6, "no limits"),
        ("malformed version", arm("", "", "").replace("name=\"arm\">\n<link name=\"base", "name=\"arm\" version=\"1.x\">\n<link name=\"base"), 1, "no version"),
        ("version too high", arm("", "", "").replace("name=\"arm\">\n<link name=\"base", "name=\"arm\" version=\"2.0\">\n<link name=\"base"), 1, "no version"),
        ("version too low", arm("", "", "").replace("name=\"arm\">\n<link name=\"base", "name=\"arm\" version=\"0.9\">\n<link name=\"base"), 1, "no version"),
        ("version without a point", arm("", "", "").replace("name=\"arm\">\n<link name=\"base", "name=\"arm\" version=\"1\">\n<link name=\"base"), 1, "no version"),
        ("mimic without a joint", arm("", "\n<mimic multiplier=\"2\"/>", ""), 5, "not named"),
        ("mimic of an unknown joint", arm("", "\n<mimic joint=\"leader\"/>", ""), 5, "does not exist"),
        ("robot without links", "<robot name=\"arm\"/>".into(), 1, "no links"),
        ("no robot", "<machine name=\"arm\"/>".into(), 1, "begins with <robot>"),
        ("robot without name", arm("", "", "").replace("<robot name=\"arm\">", "<robot>"), 1, "needs a name"),
        ("safety controller without velocity", arm("", "\n<safety_controller k_position=\"1\"/>", ""), 5, "k_velocity"),
        ("two roots", arm("", "", "<link name=\"lost\"/>"), 5, "two root links"),
        ("a link on itself", arm("", "", "<link name=\"ring\"/>\n<joint name=\"j\" type=\"fixed\"><parent link=\"ring\"/><child link=\"ring\"/></joint>"), 6, "carries itself"),
        ("a child twice", joint("type=\"fixed\"", "").replace("</robot>", "<joint name=\"k\" type=\"fixed\"><parent link=\"base\"/><child link=\"hand\"/></joint></robot>"), 7, "a child twice"),
        ("a circle", arm("", "", "<joint name=\"back\" type=\"fixed\"><parent link=\"arm\"/><child link=\"base\"/></joint>"), 5, "carries itself"),
        ("inertial without inertia", arm("", "", "").replace("<link name=\"base\"/>", "<link name=\"base\"><inertial><mass value=\"1\"/></inertial></link>"), 2, "not complete"),
        ("negative mass", arm("", "", "").replace("mass value=\"2\"", "mass value=\"-2\""), 3, "negative"),
        ("mass that is not finite", arm("", "", "").replace("mass value=\"2\"", "mass value=\"nan\""), 3, "nan"),
        ("inertia of no body", arm("", "", "").replace("ixx=\"0.01\"", "ixx=\"0.1\""), 3, "above the sum of the other two"),
        ("inertia with a negative moment", arm("", "", "").replace("ixx=\"0.01\"", "ixx=\"-0.01\""), 3, "negative principal moment"),
        ("inertia without mass", arm("", "", "").replace("mass value=\"2\"", "mass value=\"0\""), 3, "no mass"),
        ("axis without direction", arm("", "\n<axis xyz=\"0 0 0\"/>", ""), 5, "no direction"),
        ("axis of two numbers", arm("", "\n<axis xyz=\"0 1\"/>", ""), 5, "3 numbers"),
        ("origin said twice", arm("", "\n<origin rpy=\"0 0 0\" quat_xyzw=\"0 0 0 1\"/>", ""), 5, "either"),
        ("quaternion without direction", arm("", "\n<origin quat_xyzw=\"0 0 0 0\"/>", "").replace("<robot", "<robot version=\"1.1\""), 5, "no direction"),
        ("quaternion of an old version", arm("", "\n<origin quat_xyzw=\"0 0 0 1\"/>", ""), 5, "version 1.1"),
        ("macros", "<robot name=\"a\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:include filename=\"b\"/></robot>".into(), 2, "not expanded"),
        ("a joint that follows itself", joint("type=\"continuous\"", "\n<mimic joint=\"wrist\"/>"), 7, "so itself"),
        ("a joint that follows a fixed one", joint("type=\"continuous\"", "\n<mimic joint=\"hinge\"/>").replace("name=\"hinge\" type=\"continuous\"", "name=\"hinge\" type=\"fixed\""), 7, "does not move"),
        ("a planar joint that follows", joint("type=\"planar\"", "\n<mimic joint=\"hinge\"/>"), 7, "several freedoms"),
        ("mimic with a word", joint("type=\"continuous\"", "\n<mimic joint=\"hinge\" multiplier=\"two\"/>"), 7, "two"),
        ("a file without masses", arm("", "", "").replace(INERTIAL, ""), 1, "no link of this robot has a mass"),
        ("an end without mass", joint("type=\"continuous\"", "").replacen(&format!("hand\">{INERTIAL}"), "hand\">", 1), 6, "nothing says how fast"),
        ("two ends without mass", joint("type=\"continuous\"", "").replacen(&format!("hand\">{INERTIAL}"), "hand\">", 1).replace("</robot>", "<link name=\"thumb\"/><joint name=\"t\" type=\"continuous\"><parent link=\"arm\"/><child link=\"thumb\"/></joint></robot>"), 6, "2 links move and have no mass: \"hand\" (line 5), \"thumb\" (line 7)"),
        ("nothing that moves", "<robot name=\"a\"><link name=\"b\"/></robot>".into(), 1, "nothing moves"),
        ("what floats on what moves", joint("type=\"floating\"", ""), 6, "can float"),
    ];
    for (what, text, line, part) in cases {
        let found = refused(&text);
        let shown = found.to_string();
        let problem = found.problems.iter().find(|p| p.message.contains(part));
        let problem =
            problem.unwrap_or_else(|| panic!("{what}: {part:?} is not in\n{shown}\n{text}"));
        assert_eq!(problem.line, line, "{what}\n{shown}");
        assert!(
            problem.column > 0 && !problem.help.is_empty(),
            "{what}\n{shown}"
        );
        assert_eq!(
            found.problems.len(),
            1,
            "{what}: nothing else is wrong\n{shown}"
        );
    }
}

#[test]
fn every_problem_is_said_at_once() {
    let text = arm("\n<visual/>", "\n<dynamics/>", "<link/>");
    assert_eq!(refused(&text).problems.len(), 3);
}

/// Accelerations and kinetic energy at a few states; models to be compared have the same coordinates.
fn motion(model: &Model) -> Vec<f64> {
    let equations = derive(model);
    let mut all = Vec::new();
    for state in 0..4 {
        let number = |i: usize, k: usize| ((1 + i + 17 * k + 31 * state) as f64 * 1.7).sin();
        let mut q: Vec<f64> = (0..equations.coordinates.len())
            .map(|i| number(i, 0))
            .collect();
        for range in &equations.quaternions {
            let length = q[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
            q[range.clone()].iter_mut().for_each(|x| *x /= length);
        }
        let v: Vec<f64> = (0..equations.velocities.len())
            .map(|i| number(i, 1))
            .collect();
        let inputs = Inputs {
            time: 0.0,
            coordinates: &q,
            velocities: &v,
            parameters: &[],
            auxiliaries: &[],
            memory: &[],
            accelerations: &[],
        };
        let mut roots = equations.accelerations.clone();
        roots.push(equations.section(Method::KineticEnergy)[0].value);
        all.extend(evaluate(
            &equations.graph,
            &roots,
            &inputs,
            &|f, _: &[f64]| panic!("no {f:?} in these models"),
        ));
    }
    all
}

/// Checks that both move in the same way, up to rounding: no model here has a condition above 1e3.
#[track_caller]
fn same(a: &Model, b: &Model) {
    let (a, b) = (motion(a), motion(b));
    assert_eq!(a.len(), b.len());
    let largest = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    for (a, b) in a.iter().zip(&b) {
        assert!((a - b).abs() < 1e-12 * largest, "{a} {b}");
    }
}

fn of_yaml(elements: &str, reference: &str) -> Model {
    read(&format!(
        "model: m\ndimension: 3\nsystems:\n  - name: m\n    reference: {reference}\n    elements:\n{elements}forces: [{{ field: gravity, acceleration: [0, 0, -9.81] }}]\nrun: {{ duration: 1 s, every: 10 ms }}\n"
    ))
}

fn of_urdf(text: &str) -> Model {
    read(&imported(text, &Options::default()).yaml)
}

fn link(name: &str, inertial: &str) -> String {
    format!("<link name=\"{name}\">{inertial}</link>\n")
}

fn between(name: &str, kind: &str, parent: &str, child: &str, inside: &str) -> String {
    format!(
        "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inside}</joint>\n"
    )
}

fn robot(inside: &[String]) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<robot name=\"m\">\n{}</robot>\n",
        inside.concat()
    )
}

const LIMIT: &str = "<limit lower=\"-1\" upper=\"2\" effort=\"10\" velocity=\"1\"/>";

#[test]
fn frames_that_are_turned_are_one_frame() {
    // the child's x is the parent's z, its y the parent's x, its z the parent's y
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned = format!("<origin xyz=\"0.3 0 0.5\" rpy=\"{quarter} 0 {quarter}\"/>");
    let text = robot(&[
        link("base", ""),
        link("a", INERTIAL),
        link("b", INERTIAL),
        between(
            "one",
            "continuous",
            "base",
            "a",
            "<origin xyz=\"0 0 1\"/><axis xyz=\"0 0 -3\"/>",
        ),
        between(
            "two",
            "revolute",
            "a",
            "b",
            &format!("{turned}<axis xyz=\"1 0 0\"/>{LIMIT}"),
        ),
    ]);
    // R = Rz(90°) Rx(90°): e_x → y, e_y → z, e_z → x
    let elements = "      - { name: a, joint: { hinge: [0, 0, -1] }, mass: 2, cg: [0.1, 0, 0], inertia: [0.01, 0.02, 0.015] }
      - { name: b, on: a, at: [0.3, 0, 0.5], joint: { hinge: y }, mass: 2, cg: [0, 0.1, 0], inertia: [0.015, 0.01, 0.02] }
    start: { position: [0, 0, 1] }\n";
    same(&of_urdf(&text), &of_yaml(elements, "fixed"));
}

#[test]
fn roll_pitch_and_yaw_about_fixed_axes_equal_quaternions() {
    // Rz(0.5) Ry(-0.4) Rx(0.3) as a product of half-angle quaternions
    let half = |angle: f64| ((angle / 2.0).cos(), (angle / 2.0).sin());
    let ((cr, sr), (cp, sp), (cy, sy)) = (half(0.3), half(-0.4), half(0.5));
    let [x, y, z, w] = [
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    ];
    let arm = |origin: &str, axis: &str| {
        robot(&[
            link("base", ""),
            link("a", INERTIAL),
            between("one", "continuous", "base", "a", &format!("{origin}{axis}")),
        ])
    };
    let axis = "<axis xyz=\"1 2 3\"/>";
    let angles = arm("<origin rpy=\"0.3 -0.4 0.5\"/>", axis);
    let quaternion = arm(
        &format!(
            "<origin quat_xyzw=\"{} {} {} {}\"/>",
            2.0 * x,
            2.0 * y,
            2.0 * z,
            2.0 * w
        ),
        axis,
    )
    .replace("<robot", "<robot version=\"1.1\"");
    same(&of_urdf(&angles), &of_urdf(&quaternion));
    // three joints at fixed angles give the same, with yaw as the outermost one
    let chain = robot(&[
        link("base", ""),
        link("yaw", ""),
        link("pitch", ""),
        link("roll", ""),
        link("a", INERTIAL),
        between("y", "fixed", "base", "yaw", "<origin rpy=\"0 0 0.5\"/>"),
        between("p", "fixed", "yaw", "pitch", "<origin rpy=\"0 -0.4 0\"/>"),
        between("r", "fixed", "pitch", "roll", "<origin rpy=\"0.3 0 0\"/>"),
        between("one", "continuous", "roll", "a", axis),
    ]);
    same(&of_urdf(&angles), &of_urdf(&chain));
}

#[test]
fn a_tensor_of_six_numbers_is_three_moments_about_turned_axes() {
    // about z by 0.4: J_xx = a c² + b s², J_yy = a s² + b c², J_xy = (a − b) s c
    let (a, b, c) = (0.3, 0.2, 0.25);
    let (s, co) = 0.4f64.sin_cos();
    let six = [
        a * co * co + b * s * s,
        a * s * s + b * co * co,
        c,
        (a - b) * s * co,
        0.0,
        0.0,
    ];
    let element = |inertia: &str| {
        of_yaml(
            &format!(
                "      - {{ name: a, joint: ball, mass: 2, cg: [0.1, 0.2, 0.3], {inertia} }}\n"
            ),
            "fixed",
        )
    };
    same(
        &element(&format!("inertia: {six:?}")),
        &element(&format!("inertia: [{a}, {b}, {c}], axes: [0, 0, 0.4]")),
    );
}

#[test]
fn tensors_that_no_model_can_have_are_refused() {
    let element = |element: &str, head: &str| {
        let text = format!(
            "model: m\n{head}systems:\n  - name: m\n    reference: fixed\n    elements:\n      - {{ name: a, mass: 1, {element} }}\nrun: {{ duration: 1 s, every: 10 ms }}\n"
        );
        match read_str("model.yaml", &text, &nothing_included) {
            Ok(_) => panic!("accepted: {text}"),
            Err(problems) => problems.to_string(),
        }
    };
    let space = "dimension: 3\nparameters: { size: 0.1 }\n";
    for (written, head, part) in [
        (
            "cg: [0, 0, 1], inertia: [1, 1, 1, 0, 0, size]",
            space,
            "size",
        ),
        ("cg: [0, 0, 1], inertia: [1, 1, 1, 0, 0]", space, "inertia"),
        (
            "cg: [0, 0, 1], inertia: [1, 1, 1, 0, 0, 1.5]",
            space,
            "inertia",
        ),
        (
            "cg: [0, 0, 1], inertia: [1, 1, 3, 0, 0, 0]",
            space,
            "inertia",
        ),
        (
            "cg: [0, 0, 1], inertia: [1, 1, 1, 0, 0, 0], axes: [1, 0, 0]",
            space,
            "axes",
        ),
        (
            "cg: [0, 1], inertia: [1, 1, 1, 0, 0, 0]",
            "dimension: 2\n",
            "inertia",
        ),
    ] {
        let found = element(written, head);
        assert!(
            found.contains(part) && found.contains("model.yaml:"),
            "{written}\n{found}"
        );
    }
}

#[test]
fn links_without_mass_between_joints_are_a_list() {
    let text = robot(&[
        link("base", ""),
        link("cross", ""),
        link("a", INERTIAL),
        between(
            "yaw",
            "continuous",
            "base",
            "cross",
            "<axis xyz=\"0 0 1\"/>",
        ),
        between("pitch", "continuous", "cross", "a", "<axis xyz=\"0 1 0\"/>"),
    ]);
    let elements = "      - { name: a, joint: [{ hinge: z, name: yaw }, { hinge: y, name: pitch }], mass: 2, cg: [0.1, 0, 0], inertia: [0.01, 0.02, 0.015] }\n";
    same(&of_urdf(&text), &of_yaml(elements, "fixed"));
    // axes that pass each other at a distance
    let apart = text.replace(
        "<child link=\"a\"/>",
        "<child link=\"a\"/><origin xyz=\"0.1 0 0\"/>",
    );
    let found = refused(&apart).to_string();
    assert!(
        found.contains("robot.urdf:") && found.contains("cross"),
        "{found}"
    );
}

#[test]
fn links_on_fixed_joints_are_one_body_and_keep_their_names() {
    let text = robot(&[
        link("base", ""),
        link("a", INERTIAL),
        link("tool", INERTIAL),
        link("tip", ""),
        between("one", "continuous", "base", "a", "<axis xyz=\"0 1 0\"/>"),
        between("holds", "fixed", "a", "tool", "<origin xyz=\"0.5 0 0.2\"/>"),
        between("ends", "fixed", "tool", "tip", "<origin xyz=\"0.1 0 0\"/>"),
    ]);
    let found = imported(&text, &Options::default());
    for part in ["name: tool", "joint: weld", "tip"] {
        assert!(found.yaml.contains(part), "{part}\n{}", found.yaml);
    }
    let elements = "      - { name: a, joint: { hinge: y }, mass: 2, cg: [0.1, 0, 0], inertia: [0.01, 0.02, 0.015] }
      - { name: b, on: a, at: [0.5, 0, 0.2], joint: weld, mass: 2, cg: [0.1, 0, 0], inertia: [0.01, 0.02, 0.015] }\n";
    same(&read(&found.yaml), &of_yaml(elements, "fixed"));
}

#[test]
fn the_inertia_of_links_fixed_together_is_judged_as_one() {
    let flat = INERTIAL.replace("ixx=\"0.01\"", "ixx=\"0.04\"");
    let parts = |mass: &str| {
        robot(&[
            link("base", ""),
            link("a", &flat),
            link("tool", &INERTIAL.replace("mass value=\"2\"", mass)),
            between("one", "continuous", "base", "a", "<axis xyz=\"0 1 0\"/>"),
            between("holds", "fixed", "a", "tool", "<origin xyz=\"0.5 0 0.2\"/>"),
        ])
    };
    let found = imported(&parts("mass value=\"2\""), &Options::default());
    assert!(
        found.notes.iter().any(|n| n.contains("one element")),
        "{:?}",
        found.notes
    );
    // 0.04 about x is above 0.02 + 0.015 for a alone, but not for both together (Steiner, 2 kg each, 0.25, 0 and 0.1 m
    // from the middle)
    let elements = "      - { name: a, joint: { hinge: y }, mass: 4, cg: [0.35, 0, 0.1], inertia: [0.09, 0.33, 0.28, 0, -0.1, 0] }\n";
    same(&read(&found.yaml), &of_yaml(elements, "fixed"));
    let light = refused(&parts("mass value=\"1e-6\"").replace(
        "ixx=\"0.01\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.015\"",
        "ixx=\"1e-9\" ixy=\"0\" ixz=\"0\" iyy=\"1e-9\" iyz=\"0\" izz=\"1e-9\"",
    ));
    assert!(
        light.to_string().contains("with what is fixed to it"),
        "{light}"
    );
}

#[test]
fn every_type_of_joint_has_its_freedoms() {
    for (kind, inside, freedoms) in [
        ("fixed", "", 1),
        ("continuous", "<axis xyz=\"0 1 0\"/>", 2),
        ("revolute", LIMIT, 2),
        ("prismatic", LIMIT, 2),
        ("planar", "<axis xyz=\"0 0 2\"/>", 4),
        ("planar", "<axis xyz=\"1 1 2\"/>", 4),
    ] {
        let text = joint(&format!("type=\"{kind}\""), inside);
        for (base, more) in [(Base::Fixed, 0), (Base::Free, 6)] {
            // the base has no mass; with mass it is free
            let text = text.replace("<link name=\"base\"/>", &link("base", INERTIAL));
            let options = Options {
                base,
                ..Options::default()
            };
            let model = read(&imported(&text, &options).yaml);
            assert_eq!(derive(&model).velocities.len(), freedoms + more, "{kind}");
        }
    }
    // a link that floats from a fixed base is a system of its own
    let text = robot(&[
        link("base", ""),
        link("a", INERTIAL),
        link("stone", INERTIAL),
        between("one", "continuous", "base", "a", ""),
        between(
            "flies",
            "floating",
            "base",
            "stone",
            "<origin xyz=\"0 0 3\"/>",
        ),
    ]);
    let model = of_urdf(&text);
    assert_eq!(model.systems.len(), 2);
    assert_eq!(derive(&model).velocities.len(), 7);
}

#[test]
fn almost_right_angles_are_reported_and_exact_on_demand() {
    let text = |angle: &str| {
        robot(&[
            link("base", ""),
            link("a", INERTIAL),
            between(
                "one",
                "continuous",
                "base",
                "a",
                &format!("<origin rpy=\"0 0 {angle}\"/><axis xyz=\"1 0 0\"/>"),
            ),
        ])
    };
    let exact = text(&std::f64::consts::FRAC_PI_2.to_string());
    let right = Options {
        right_angles: true,
        ..Options::default()
    };
    let almost = imported(&text("1.5708"), &Options::default());
    let said = |found: &Imported| {
        found
            .notes
            .iter()
            .any(|n| n.contains("almost right angles, line 5"))
    };
    assert!(said(&almost), "{:?}", almost.notes);
    assert!(!said(&imported(&exact, &Options::default())));
    assert_ne!(almost.yaml, imported(&exact, &right).yaml);
    assert_eq!(
        imported(&text("1.5708"), &right).yaml,
        imported(&exact, &right).yaml
    );
    // an angle that is not close to a right angle stays
    assert_eq!(
        imported(&text("1.58"), &right).yaml,
        imported(&text("1.58"), &Options::default()).yaml
    );
}

#[test]
fn damping_friction_and_limits_are_joint_forces() {
    let text = joint(
        "type=\"revolute\"",
        &format!("{LIMIT}<dynamics damping=\"0.5\" friction=\"0.25\"/>"),
    );
    let without = imported(&text, &Options::default());
    let with = imported(
        &text,
        &Options {
            stops: Some(1e4),
            ..Options::default()
        },
    );
    assert!(
        without.notes.iter().any(|n| n.contains("--stops")),
        "{:?}",
        without.notes
    );
    assert!(
        !without.yaml.contains("stop:") && without.yaml.contains("limits -1 and 2"),
        "{}",
        without.yaml
    );
    for part in ["0.5", "0.25"] {
        assert!(without.yaml.contains(part), "{}", without.yaml);
    }
    assert!(
        !with.notes.iter().any(|n| n.contains("--stops")),
        "{:?}",
        with.notes
    );
    assert!(
        with.yaml.contains("10000") || with.yaml.contains("1e4"),
        "{}",
        with.yaml
    );
    // gravity, and that of the joint
    let forces = |found: &Imported| read(&found.yaml).forces.len();
    assert_eq!((forces(&without), forces(&with)), (2, 2), "{}", with.yaml);
}

#[test]
fn joints_that_follow_others_follow() {
    let text = joint(
        "type=\"prismatic\"",
        &format!(
            "{LIMIT}<axis xyz=\"0 0 1\"/><origin xyz=\"0 0 1\"/><mimic joint=\"hinge\" multiplier=\"-0.1\" offset=\"0.02\"/>"
        ),
    );
    let elements = "      - { name: arm, joint: { hinge: x }, mass: 2, cg: [0.1, 0, 0], inertia: [0.01, 0.02, 0.015] }
      - { name: hand, on: arm, at: [0, 0, 1], joint: { slider: z, follows: { joint: arm, ratio: -0.1, offset: 0.02 } }, mass: 2, cg: [0.1, 0, 0], inertia: [0.01, 0.02, 0.015] }\n";
    let found = imported(&text, &Options::default());
    assert_eq!(derive(&read(&found.yaml)).velocities.len(), 1);
    same(&read(&found.yaml), &of_yaml(elements, "fixed"));
    let apart = imported(
        &text,
        &Options {
            uncouple: true,
            ..Options::default()
        },
    );
    assert_eq!(derive(&read(&apart.yaml)).velocities.len(), 2);
    let said = |found: &Imported| found.notes.iter().any(|n| n.contains("moves by itself"));
    assert!(said(&apart) && !said(&found), "{:?}", apart.notes);
}

#[test]
fn motors_are_inputs_within_the_limits_of_effort() {
    let with = |inputs, uncouple| Options {
        inputs,
        uncouple,
        ..Options::default()
    };
    // a hinge without limits, and a slider that follows it
    let mimic = "<mimic joint=\"hinge\" multiplier=\"-0.1\"/>";
    let text = joint("type=\"prismatic\"", &format!("{LIMIT}{mimic}"));
    let inputs = |options| {
        let inputs = read(&imported(&text, &options).yaml).parameters;
        assert!(inputs.iter().all(|of| of.input && of.default == 0.0));
        let limits = inputs
            .into_iter()
            .map(|of| (of.name, of.unit, of.min, of.max));
        limits.collect::<Vec<_>>()
    };
    let torque = || ("hinge_torque".to_owned(), "N*m".to_owned(), None, None);
    assert_eq!(inputs(with(true, false)), [torque()]);
    let force = (
        "joint_force".to_owned(),
        "N".to_owned(),
        Some(-10.0),
        Some(10.0),
    );
    let both = inputs(with(true, true));
    assert_eq!(both[0], torque());
    assert_eq!(
        (both.len(), &both[1].1, both[1].2, both[1].3),
        (2, &force.1, force.2, force.3)
    );
    assert!(both[1].0.ends_with("_force"));
    assert_eq!(inputs(with(false, true)), []);
    // an arm of 2 kg at 0.1 m about x: J = 0.01, and gravity along z turns it by nothing
    let yaml = imported(&arm("", "", ""), &with(true, false)).yaml;
    assert!((driven(&yaml, &[0.5]) - driven(&yaml, &[0.0]) - 50.0).abs() < 1e-12);
    // limits that act are no comments
    let limited = arm("", LIMIT, "").replace("continuous", "revolute");
    let found = imported(&limited, &with(true, false));
    assert!(
        found.yaml.contains("min: -10 N*m, max: 10 N*m") && !found.yaml.contains("has a motor")
    );
    assert!(
        found
            .notes
            .iter()
            .any(|note| note.contains("the limits of speed of joints do not act"))
    );
}

#[test]
fn a_joint_that_follows_and_moves_no_mass_is_left_out() {
    let text = joint("type=\"continuous\"", "<mimic joint=\"hinge\"/>").replace(
        &link("hand", INERTIAL).replace('\n', ""),
        &link("hand", "").replace('\n', ""),
    );
    let found = imported(&text, &Options::default());
    assert!(
        found.notes.iter().any(|n| n.contains("moves no mass")),
        "{:?}",
        found.notes
    );
    assert_eq!(derive(&read(&found.yaml)).velocities.len(), 1);
    // if it moved by itself, its velocity would be unknown
    let options = Options {
        uncouple: true,
        ..Options::default()
    };
    let refused = import("robot.urdf", &text, &options)
        .unwrap_err()
        .to_string();
    assert!(refused.contains("nothing says how fast"), "{refused}");
}

#[test]
fn names_become_words_that_differ() {
    let text = joint("type=\"continuous\"", "")
        .replace("\"hand\"", "\"Arm\"")
        .replace("\"wrist\"", "\"Hinge \"");
    let found = imported(&text, &Options::default());
    assert!(
        found.yaml.contains("name: arm_2") && found.yaml.contains("#   arm_2: Arm"),
        "{}",
        found.yaml
    );
    assert_eq!(derive(&read(&found.yaml)).velocities.len(), 2);
}

#[test]
fn what_is_left_out_is_listed_with_its_lines() {
    let text = joint("type=\"continuous\"", "").replace(
        "</robot>",
        "<transmission name=\"t\"/>\n<gazebo/>\n<sensor name=\"s\"/>\n</robot>",
    );
    let notes = imported(&text, &Options::default()).notes.join("\n");
    for line in ["line 7", "line 8", "line 9"] {
        assert!(notes.contains(line), "{line}\n{notes}");
    }
}

/// What is said about a robot that is accepted.
fn notes(text: &str) -> String {
    imported(text, &Options::default()).notes.join("\n")
}

/// The acceleration of a model with one freedom, at rest in its start.
fn acceleration(yaml: &str) -> f64 {
    driven(yaml, &[])
}

/// The acceleration, where the parameters have these values.
fn driven(yaml: &str, parameters: &[f64]) -> f64 {
    let equations = derive(&read(yaml));
    assert_eq!(equations.velocities.len(), 1, "{yaml}");
    let inputs = Inputs {
        time: 0.0,
        coordinates: &[0.0],
        velocities: &[0.0],
        parameters,
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    let no_call = |f, _: &[f64]| panic!("no {f:?} in these models");
    evaluate(
        &equations.graph,
        &equations.accelerations,
        &inputs,
        &no_call,
    )[0]
}

/// The arm, turning about y.
fn about_y(robot: &str) -> String {
    arm("", "<axis xyz=\"0 1 0\"/>", robot)
}
