//! Meshes of files in pictures, reports and animations: seen, and never part of the motion.

use super::command_call::call;
use super::directory;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A wedge in mm as text of STL: 2000 long, 500 wide, 1000 high at its front.
fn wedge() -> String {
    let corners = [
        [0, 0, 0],
        [2000, 0, 0],
        [2000, 500, 0],
        [0, 500, 0],
        [2000, 0, 1000],
        [2000, 500, 1000],
    ];
    let faces = [
        [0, 2, 1],
        [0, 3, 2],
        [0, 1, 4],
        [3, 5, 2],
        [1, 2, 5],
        [1, 5, 4],
        [0, 4, 5],
        [0, 5, 3],
    ];
    let mut text = "solid wedge\n".to_owned();
    for face in faces {
        text += "facet normal 0 0 0\nouter loop\n";
        for corner in face.map(|corner: usize| corners[corner]) {
            text += &format!("vertex {} {} {}\n", corner[0], corner[1], corner[2]);
        }
        text += "endloop\nendfacet\n";
    }
    text + "endsolid\n"
}

const SCENE: &str = "model: ride
dimension: 3
vehicles:
  - name: car
    start: { velocity: [3, 0, 0] }
    # its mesh
systems:
  - name: arm
    reference: { on: car, at: [0, 0, 1] }
    elements: [{ name: rod, joint: { hinge: y }, mass: 2, cg: [0, 0, -0.2], inertia: [0.02, 0.02, 0.005] }]
    start: { joints: { rod: 60 deg } }
forces: [{ field: gravity, acceleration: [0, 0, -1 gn] }]
run: { duration: 0.5 s, every: 10 ms }
";
const MESH: &str = "    mesh: { file: parts/wedge.stl, scale: 0.001, at: [0.5, 0, 0.25] }\n";

fn with_mesh() -> String {
    SCENE.replace("    # its mesh\n", MESH)
}

fn written(path: &Path) {
    fs::create_dir_all(path.join("parts")).unwrap();
    fs::write(path.join("parts/wedge.stl"), wedge()).unwrap();
    fs::write(path.join("ride.yaml"), with_mesh()).unwrap();
}

/// The data of a report.
fn data(path: &Path) -> Value {
    let page = fs::read_to_string(path).unwrap();
    let text = page.split("id=\"data\">").nth(1).unwrap();
    serde_json::from_str(text.split("</script>").next().unwrap()).unwrap()
}

/// The JSON of an animation.
fn glb(path: &Path) -> Value {
    let bytes = fs::read(path).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}

const ALL: [&str; 9] = [
    "run",
    "ride.yaml",
    "--no-files",
    "--picture",
    "ride.svg",
    "--report",
    "ride.html",
    "--animation",
    "ride.glb",
];

#[test]
fn a_mesh_is_seen_where_it_is_put() {
    let directory = directory();
    let path = directory.path();
    written(path);
    let (_, told) = call(path, &ALL, 0);
    assert!(!told.contains("warning"), "{told}");
    // the accessor of its places has the corners of the box around it, in the frame of the car
    let json = glb(&path.join("ride.glb"));
    let nodes = json["nodes"].as_array().unwrap();
    let node = nodes.iter().find(|n| n["name"] == "car wedge.stl").unwrap();
    let entry = |key: &str, index: &Value| json[key][index.as_u64().unwrap() as usize].clone();
    let primitive = entry("meshes", &node["mesh"])["primitives"][0].clone();
    let places = entry("accessors", &primitive["attributes"]["POSITION"]);
    for (key, expected) in [("min", [0.5, 0.0, 0.25]), ("max", [2.5, 0.5, 1.25])] {
        for (found, expected) in places[key].as_array().unwrap().iter().zip(expected) {
            assert!((found.as_f64().unwrap() - expected).abs() < 1e-6, "{key}");
        }
    }
    assert_eq!(entry("accessors", &primitive["indices"])["count"], 24);
    // one sees what is in a car
    let material = entry("materials", &primitive["material"]);
    assert_eq!(material["alphaMode"], "BLEND");
    let car = nodes.iter().position(|n| n["name"] == "car").unwrap();
    let children = nodes[car]["children"].as_array().unwrap();
    assert!(
        children
            .iter()
            .any(|child| nodes[child.as_u64().unwrap() as usize] == *node)
    );

    let mesh = &data(&path.join("ride.html"))["scene"]["meshes"][0];
    assert_eq!(mesh["low"], serde_json::json!([0.5, 0, 0.25]));
    // six corners of three numbers of 16 bits, and eight triangles, as base64
    assert_eq!(mesh["places"].as_str().unwrap().len(), 36 / 3 * 4);
    assert_eq!(mesh["corners"].as_str().unwrap().len(), 48 / 3 * 4);

    // from the side it is a triangle with the legs 2 m and 1 m
    let svg = fs::read_to_string(path.join("ride.svg")).unwrap();
    let outline = svg.split("class=\"mesh frame\" points=\"").nth(1).unwrap();
    let outline = outline.split('"').next().unwrap();
    let points: Vec<[f64; 2]> = outline
        .split(' ')
        .map(|point| {
            let (x, y) = point.split_once(',').unwrap();
            [x.parse().unwrap(), y.parse().unwrap()]
        })
        .collect();
    let extent = |axis: usize| {
        let all = points.iter().map(|p| p[axis]);
        all.clone().fold(f64::MIN, f64::max) - all.fold(f64::MAX, f64::min)
    };
    assert!((extent(0) / extent(1) - 2.0).abs() < 0.05, "{points:?}");
    assert!(points.len() < 40, "{points:?}");
    let doubled = points
        .windows(2)
        .map(|p| p[0][0] * p[1][1] - p[1][0] * p[0][1]);
    let area = doubled.sum::<f64>().abs() / 2.0;
    assert!((area / (extent(0) * extent(1)) - 0.5).abs() < 0.05);
}

#[test]
fn a_mesh_is_no_part_of_the_motion() {
    let directory = directory();
    let path = directory.path();
    written(path);
    fs::write(path.join("bare.yaml"), SCENE).unwrap();
    let result = |model: &str| {
        let run = [
            "run",
            model,
            "--no-files",
            "--csv",
            "run.csv",
            "--final-state",
            "end.json",
            "--json",
        ];
        let (json, _) = call(path, &run, 0);
        let json: Value = serde_json::from_str(&json).unwrap();
        let state = fs::read_to_string(path.join("end.json")).unwrap();
        (json["digest"].clone(), state)
    };
    let (with, without) = (result("ride.yaml"), result("bare.yaml"));
    assert_eq!(with, without);
    assert!(with.0.is_string());
}

#[test]
fn what_cannot_be_shown_is_a_warning_with_its_place() {
    let directory = directory();
    let path = directory.path();
    written(path);
    let told = |text: &str, picture: &str| {
        fs::write(path.join("ride.yaml"), text).unwrap();
        let (_, told) = call(path, &ALL, 0);
        let svg = fs::read_to_string(path.join("ride.svg")).unwrap();
        assert_eq!(svg.contains("class=\"mesh"), !picture.is_empty(), "{told}");
        told
    };
    let missing = told(&with_mesh().replace("wedge.stl", "edge.stl"), "");
    assert!(
        missing.contains("ride.yaml:6: the mesh is not shown: there is no file parts/edge.stl"),
        "{missing}"
    );
    assert_eq!(missing.matches("edge.stl").count(), 1, "{missing}");
    let (_, checked) = call(path, &["check", "ride.yaml"], 0);
    assert!(
        checked.contains("ride.yaml:6: the mesh is not shown"),
        "{checked}"
    );
    fs::write(path.join("parts/broken.stl"), "solid\nvertex 1 2\n").unwrap();
    let broken = told(&with_mesh().replace("wedge.stl", "broken.stl"), "");
    assert!(
        broken.contains(
            "ride.yaml:6: the mesh is not shown: parts/broken.stl cannot be read: corner 1"
        ),
        "{broken}"
    );
    fs::write(path.join("parts/car.dae"), "<COLLADA/>").unwrap();
    let other = told(&with_mesh().replace("wedge.stl", "car.dae"), "");
    assert!(
        other.contains("it is none of .stl, .obj, .gltf and .glb"),
        "{other}"
    );
    // one that is there beside one that is not
    let both = MESH.replace("mesh: {", "mesh:\n      - parts/no.stl\n      - {");
    let both = told(&SCENE.replace("    # its mesh\n", &both), "one");
    assert!(
        both.contains("ride.yaml:7: the mesh is not shown"),
        "{both}"
    );
    // what is wrong in the model itself is an error
    for (from, to, expected) in [
        ("scale: 0.001", "scale: 0", "of no size"),
        ("scale: 0.001", "scale: [1, 2]", "three axes"),
        ("file: parts/wedge.stl, ", "", "file"),
        ("scale: 0.001", "scael: 0.001", "scale"),
    ] {
        fs::write(path.join("ride.yaml"), with_mesh().replace(from, to)).unwrap();
        let (_, told) = call(path, &["check", "ride.yaml"], 2);
        assert!(told.contains(expected), "{told}");
    }
    // nothing is fixed to this car
    let idle = with_mesh().replace("reference: { on: car, at: [0, 0, 1] }", "reference: fixed");
    let idle = told(&idle, "");
    assert!(idle.contains("nothing is fixed to its vehicle"), "{idle}");
}

/// Triangles of a sphere in bytes of STL.
fn sphere(rings: usize) -> Vec<u8> {
    use std::f32::consts::{PI, TAU};
    let at = |i: usize, j: usize| {
        let (s, c) = (PI * i as f32 / rings as f32).sin_cos();
        let (y, x) = (TAU * j as f32 / rings as f32).sin_cos();
        [0.3 * s * x, 0.3 * s * y, 0.3 * c]
    };
    let mut bytes = vec![0; 80];
    bytes.extend(((2 * rings * rings) as u32).to_le_bytes());
    for i in 0..rings {
        for j in 0..rings {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            for triangle in [[a, b, c], [a, c, d]] {
                bytes.extend([0; 12]);
                bytes.extend(triangle.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
                bytes.extend([0; 2]);
            }
        }
    }
    bytes
}

/// 80 000 triangles, 4 MB: the report stays below 1 MB, and a note says that not all of them are shown.
#[test]
fn a_large_mesh_is_shown_by_fewer_triangles() {
    let directory = directory();
    let path = directory.path();
    written(path);
    fs::write(path.join("parts/wedge.stl"), sphere(200)).unwrap();
    let (_, told) = call(path, &ALL, 0);
    assert!(told.contains("wedge.stl has 80000 triangles: "), "{told}");
    let page = fs::metadata(path.join("ride.html")).unwrap().len();
    assert!(page < 1_000_000, "{page}");
}

/// The links of a robot are shown by the meshes of its description, in their frames: the second joint is turned by 90°
/// about y, so that the mesh of its link leads along z of it, which is x of the robot.
#[test]
fn links_are_shown_by_their_visual_meshes() {
    let directory = directory();
    let path = directory.path();
    fs::create_dir_all(path.join("arm/urdf")).unwrap();
    fs::create_dir_all(path.join("arm/meshes")).unwrap();
    // a plate from 0 to 1 along x, 0.1 along y
    let plate = "v 0 0 0\nv 1 0 0\nv 1 0.1 0\nv 0 0.1 0\nf 1 2 3 4\n";
    fs::write(path.join("arm/meshes/plate.obj"), plate).unwrap();
    let link = |name: &str, visual: &str| {
        format!(
            "<link name=\"{name}\"><inertial><mass value=\"1\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.1\"/></inertial>{visual}</link>\n"
        )
    };
    let mesh = |file: &str, more: &str| {
        format!(
            "<visual>{more}<geometry><mesh filename=\"{file}\" scale=\"0.5 0.5 0.5\"/></geometry></visual>"
        )
    };
    let urdf = "<robot name=\"arm\">\n".to_owned()
        + &link("base", &mesh("package://arm/meshes/plate.obj", ""))
        + &link(
            "tip",
            &mesh(
                "../meshes/plate.obj",
                "<origin xyz=\"0 0 0.2\" rpy=\"0 -1.5707963267948966 0\"/>",
            ),
        )
        + "<joint name=\"hinge\" type=\"continuous\"><parent link=\"base\"/><child link=\"tip\"/><origin xyz=\"0.3 0 0\" rpy=\"0 1.5707963267948966 0\"/><axis xyz=\"0 1 0\"/></joint>\n</robot>\n";
    fs::write(path.join("arm/urdf/arm.urdf"), &urdf).unwrap();
    let run = [
        "run",
        "arm/urdf/arm.urdf",
        "--no-files",
        "--animation",
        "arm.glb",
        "--duration",
        "10 ms",
    ];
    let (_, told) = call(path, &run, 0);
    assert!(
        !told.contains("not shown") && !told.contains("visual"),
        "{told}"
    );
    let json = glb(&path.join("arm.glb"));
    let bounds = |name: &str| {
        let nodes = json["nodes"].as_array().unwrap();
        let node = nodes
            .iter()
            .find(|n| n["name"] == name)
            .unwrap_or_else(|| panic!("no {name}"));
        let mesh = &json["meshes"][node["mesh"].as_u64().unwrap() as usize];
        let places = mesh["primitives"][0]["attributes"]["POSITION"]
            .as_u64()
            .unwrap();
        let places = &json["accessors"][places as usize];
        ["min", "max"].map(|key| [0, 1, 2].map(|i| places[key][i].as_f64().unwrap()))
    };
    let near = |found: [[f64; 3]; 2], expected: [[f64; 3]; 2]| {
        for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
    };
    near(bounds("frame plate.obj"), [[0.0; 3], [0.5, 0.05, 0.0]]);
    // the origin of the visual is 0.2 along z of the link, which is x of the element; both turns together are none
    near(
        bounds("arm/tip plate.obj"),
        [[0.2, 0.0, 0.0], [0.7, 0.05, 0.0]],
    );
    // imported, it says the same
    call(
        path,
        &["import", "arm/urdf/arm.urdf", "-o", "arm/urdf/arm.yaml"],
        0,
    );
    let yaml = fs::read_to_string(path.join("arm/urdf/arm.yaml")).unwrap();
    assert!(
        yaml.contains(
            "mesh:\n  - { file: \"package://arm/meshes/plate.obj\", scale: [0.5, 0.5, 0.5] }"
        ),
        "{yaml}"
    );
    call(
        path,
        &[
            "run",
            "arm/urdf/arm.yaml",
            "--no-files",
            "--animation",
            "again.glb",
            "--duration",
            "10 ms",
        ],
        0,
    );
    assert_eq!(glb(&path.join("again.glb"))["meshes"], json["meshes"]);
    // a file that is missing is told with the line of its link
    fs::remove_file(path.join("arm/meshes/plate.obj")).unwrap();
    let (_, told) = call(path, &run, 0);
    assert!(
        told.contains("arm.urdf:2: the mesh is not shown") && told.contains("arm.urdf:3: "),
        "{told}"
    );
}

/// The mirror image of an element has that of its mesh, and named surfaces are shown that nothing meets.
#[test]
fn mirror_images_and_named_surfaces_are_shown() {
    let directory = directory();
    let path = directory.path();
    fs::write(
        path.join("flag.obj"),
        "v 0 0.2 0\nv 0.3 0.2 0\nv 0 0.2 0.1\nf 1 2 3\n",
    )
    .unwrap();
    let scene = "model: flags
dimension: 3
surfaces:
  shelf: { on: frame, at: [1, 0, 0], normal: [0, 0, 1], extent: [0.5, 0.25] }
  endless: { on: frame, at: [0, 0, -1], normal: [0, 0, 1] }
  cube: { on: bar/mast, center: [0, 0, 1], semi_axes: [0.2, 0.2, 0.2], degree: 8 }
systems:
  - name: bar
    reference: fixed
    elements:
      - { name: mast, joint: { hinge: x }, mass: 1, cg: [0, 0, 0.5], inertia: [1, 1, 1] }
      - { name: left-flag, on: mast, mirror: true, at: [0, 0.1, 1], joint: { hinge: z }, mass: 1, cg: [0.1, 0.1, 0], inertia: [1, 1, 1], mesh: { file: flag.obj, at: [0, 0.05, 0] } }
run: { duration: 10 ms, every: 5 ms }
";
    fs::write(path.join("flags.yaml"), scene).unwrap();
    let run = [
        "run",
        "flags.yaml",
        "--no-files",
        "--animation",
        "flags.glb",
        "--picture",
        "flags.svg",
    ];
    call(path, &run, 0);
    let json = glb(&path.join("flags.glb"));
    let ys = |name: &str| {
        let meshes = json["meshes"].as_array().unwrap();
        let mesh = meshes.iter().find(|m| m["name"] == name).unwrap();
        let places = mesh["primitives"][0]["attributes"]["POSITION"]
            .as_u64()
            .unwrap();
        json["accessors"][places as usize]["min"][1]
            .as_f64()
            .unwrap()
    };
    assert!((ys("bar/left-flag flag.obj") - 0.25).abs() < 1e-6);
    assert!((ys("bar/right-flag flag.obj") + 0.25).abs() < 1e-6);
    let planes = json["meshes"].as_array().unwrap().iter();
    let planes = planes.filter(|m| m["name"].as_str().unwrap().contains("plane"));
    assert_eq!(planes.count(), 1);
    // the outline of a rounded box is no ellipse
    let svg = fs::read_to_string(path.join("flags.svg")).unwrap();
    assert!(svg.contains("<polyline class=\"ellipse s0\""));
    let (long, _) = call(path, &["check", "flags.yaml", "--long"], 0);
    fs::write(path.join("long.yaml"), long).unwrap();
    call(
        path,
        &["run", "long.yaml", "--no-files", "--animation", "long.glb"],
        0,
    );
    assert_eq!(glb(&path.join("long.glb"))["meshes"], json["meshes"]);
}

/// Boxes, spheres, cylinders and capsules of a robot are shown as long as they are, where they are; what they say in
/// YAML is the same.
#[test]
fn links_are_shown_by_their_shapes() {
    let directory = directory();
    let path = directory.path();
    let visual = |shape: &str, z: f64| {
        format!("<visual><origin xyz=\"0 0 {z}\"/><geometry>{shape}</geometry></visual>")
    };
    let shapes = [
        visual("<box size=\"0.4 0.2 0.1\"/>", 0.05),
        visual("<sphere radius=\"0.3\"/>", 1.0),
        visual("<cylinder radius=\"0.1\" length=\"0.5\"/>", 2.0),
        visual("<capsule radius=\"0.1\" length=\"0.5\"/>", 3.0),
    ];
    let urdf = format!(
        "<robot name=\"arm\"><link name=\"base\"/><link name=\"tip\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>{}</link><joint name=\"hinge\" type=\"continuous\"><parent link=\"base\"/><child link=\"tip\"/><axis xyz=\"0 1 0\"/></joint></robot>",
        shapes.concat()
    );
    fs::write(path.join("arm.urdf"), urdf).unwrap();
    let shown = |model: &str| {
        let run = [
            "run",
            model,
            "--no-files",
            "--animation",
            "arm.glb",
            "--duration",
            "10 ms",
            "--force",
            "--picture",
            "arm.svg",
        ];
        let (_, told) = call(path, &run, 0);
        assert!(
            !told.contains("not shown") && !told.contains("visual"),
            "{told}"
        );
        let json = glb(&path.join("arm.glb"));
        let meshes = json["meshes"]
            .as_array()
            .unwrap()
            .iter()
            .filter_map(|mesh| {
                let name = mesh["name"].as_str()?;
                let solid = ["box", "sphere", "cylinder"]
                    .iter()
                    .any(|solid| name.ends_with(solid));
                let places = mesh["primitives"][0]["attributes"]["POSITION"].as_u64()?;
                let places = &json["accessors"][places as usize];
                let bounds =
                    ["min", "max"].map(|key| [0, 1, 2].map(|i| places[key][i].as_f64().unwrap()));
                solid.then_some(bounds)
            });
        meshes.collect::<Vec<_>>()
    };
    let expected = [
        [[-0.2, -0.1, 0.0], [0.2, 0.1, 0.1]],
        [[-0.3, -0.3, 0.7], [0.3, 0.3, 1.3]],
        [[-0.1, -0.1, 1.75], [0.1, 0.1, 2.25]],
        // a capsule: a cylinder, and a sphere at each end
        [[-0.1, -0.1, 2.75], [0.1, 0.1, 3.25]],
        [[-0.1, -0.1, 2.65], [0.1, 0.1, 2.85]],
        [[-0.1, -0.1, 3.15], [0.1, 0.1, 3.35]],
    ];
    let check = |found: Vec<[[f64; 3]; 2]>| {
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
            for (found, expected) in found.as_flattened().iter().zip(expected.as_flattened()) {
                assert!((found - expected).abs() < 1e-6, "{found} {expected}");
            }
        }
    };
    check(shown("arm.urdf"));
    let svg = fs::read_to_string(path.join("arm.svg")).unwrap();
    assert!(svg.contains("mesh (only shown)"), "{svg}");
    call(path, &["import", "arm.urdf", "-o", "arm.yaml"], 0);
    check(shown("arm.yaml"));
    // what is neither, both, or of no size
    let wrong = |mesh: &str, what: &str| {
        let text = format!(
            "model: m\ndimension: 3\nmesh: {{ {mesh} }}\nsystems: [{{ name: p, elements: [{{ name: b, mass: 1, cg: [0, 0, 0], inertia: [1, 1, 1] }}] }}]\nrun: {{ duration: 1, every: 0.5 }}\n"
        );
        fs::write(path.join("m.yaml"), text).unwrap();
        let (_, told) = call(path, &["check", "m.yaml"], 2);
        assert!(
            told.contains(what) && told.contains("m.yaml:3:"),
            "{mesh}: {told}"
        );
    };
    wrong("at: [0, 0, 0]", "either a file or a shape");
    wrong(
        "shape: box, size: 1, file: a.stl",
        "either a file or a shape",
    );
    wrong("shape: box", "has no size");
    wrong("shape: box, size: [1, 0, 1]", "a length above 0");
    wrong("shape: cube, size: 1", "`box`, `sphere`, `cylinder`");
    wrong("file: a.stl, size: 1", "has its own size");
}
