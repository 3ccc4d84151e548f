//! Reference trees and states, computed independently of any engine (see `reference/README.md`), as models.

use bryant_generator::law::types::Field;
use bryant_generator::model::{
    Active, Coordinates, Dimension, Element, ElementId, FieldComponent, Force, Joint, Model,
    Number, Reference, Run, System,
};
use serde_json::Value;

/// One state of a reference file, with the expected values. Vectors in absolute axes; planar ones in (x, z).
pub struct ReferenceState {
    /// Position of the reference joint.
    pub position: Vec<f64>,
    /// Velocity of the reference joint.
    pub velocity: Vec<f64>,
    /// Quaternion (w, x, y, z) of each element, or its angle.
    pub orientation: Vec<Vec<f64>>,
    /// ω of each element.
    pub angular_velocity: Vec<Vec<f64>>,
    /// Moment on each element at its joint; the opposite acts on the parent.
    pub joint_moment: Vec<Vec<f64>>,
    /// Expected acceleration of the reference joint.
    pub reference_joint_acceleration: Vec<f64>,
    /// Expected angular acceleration of each element.
    pub angular_acceleration: Vec<Vec<f64>>,
    /// Expected acceleration of each centre of gravity.
    pub cg_acceleration: Vec<Vec<f64>>,
}

/// A reference file.
pub struct ReferenceTree {
    /// The tree with its gravity, without the joint moments.
    pub model: Model,
    /// States.
    pub states: Vec<ReferenceState>,
}

/// `chain5`, `dummy15` or `planar9`.
pub fn load(name: &str, coordinates: Coordinates) -> ReferenceTree {
    let text = match name {
        "chain5" => include_str!("../reference/chain5.json"),
        "dummy15" => include_str!("../reference/dummy15.json"),
        "planar9" => include_str!("../reference/planar9.json"),
        _ => panic!("no reference file {name}"),
    };
    let json: Value = serde_json::from_str(text).expect("reference files are JSON");
    let gravity = numbers(&json["gravity"]);
    let dimension = if gravity.len() == 2 {
        Dimension::Plane
    } else {
        Dimension::Space
    };
    let in_space = |v: Vec<f64>| -> [Number; 3] {
        match *v {
            [x, z] => [x, 0.0, z].map(Number::from),
            [x, y, z] => [x, y, z].map(Number::from),
            _ => panic!("a vector of {} components", v.len()),
        }
    };
    let entries = json["elements"].as_array().expect("elements");
    let name_of = |value: &Value| value.as_str().map(str::to_owned);
    let elements: Vec<Element> = entries
        .iter()
        .map(|e| {
            let parent = name_of(&e["parent"]).map(|p| {
                entries
                    .iter()
                    .position(|e| name_of(&e["name"]).as_ref() == Some(&p))
                    .expect("parent")
            });
            let inertia = match dimension {
                Dimension::Plane => [0.0, e["inertia"].as_f64().expect("inertia"), 0.0],
                Dimension::Space => {
                    let i = numbers(&e["inertia_xx_yy_zz_xy_xz_yz"]);
                    assert_eq!(i[3..], [0.0; 3], "principal axes are the frame's");
                    [i[0], i[1], i[2]]
                }
            };
            Element {
                name: name_of(&e["name"]).expect("name"),
                parent,
                at: in_space(numbers(&e["at"])),
                joint: Joint::Ball,
                mass: e["mass"].as_f64().expect("mass").into(),
                cg: in_space(numbers(&e["cg"])),
                inertia: inertia.map(Number::from),
                ..element()
            }
        })
        .collect();
    let on = (0..elements.len())
        .map(|element| ElementId { system: 0, element })
        .collect();
    let model = Model {
        name: name.into(),
        title: String::new(),
        dimension,
        coordinates,
        parameters: vec![],
        curves: vec![],
        vehicles: vec![],
        shown: vec![],
        units: Default::default(),
        systems: vec![System {
            name: "tree".into(),
            elements,
            reference: if json["base"] == "free" {
                Reference::Free
            } else {
                Reference::Fixed
            },
            position: [0.0; 3].map(Number::from),
            velocity: [0.0; 3].map(Number::from),
        }],
        forces: vec![Force {
            name: "gravity".into(),
            law: Box::new(Field {
                on,
                acceleration: in_space(gravity).map(FieldComponent::Constant),
            }),
            active: Active::default(),
        }],
        switches: vec![],
        outputs: vec![],
        run: Run {
            duration: 1.0,
            every: 0.1,
        },
        digest: String::new(),
    };
    let states = json["states"]
        .as_array()
        .expect("states")
        .iter()
        .map(|s| state(s, dimension))
        .collect();
    ReferenceTree { model, states }
}

/// An element without any property, to be completed by `..`.
pub fn element() -> Element {
    let zero = || [0.0; 3].map(Number::from);
    Element {
        name: String::new(),
        parent: None,
        at: zero(),
        joint: Joint::Ball,
        mass: 0.0.into(),
        cg: zero(),
        inertia: zero(),
        axes: zero(),
        angles: zero(),
        angular_velocity: zero(),
        points: Vec::new(),
    }
}

fn state(s: &Value, dimension: Dimension) -> ReferenceState {
    let vectors = |v: &Value| match v[0] {
        Value::Array(_) => v.as_array().expect("vectors").iter().map(numbers).collect(),
        _ => numbers(v).into_iter().map(|a| vec![a]).collect::<Vec<_>>(),
    };
    let (orientation, rate) = match dimension {
        Dimension::Plane => ("angle", "angle_rate"),
        Dimension::Space => ("orientation_wxyz", "angular_velocity"),
    };
    let expect = &s["expect"];
    ReferenceState {
        position: numbers(&s["position"]),
        velocity: numbers(&s["velocity"]),
        orientation: vectors(&s[orientation]),
        angular_velocity: vectors(&s[rate]),
        joint_moment: vectors(&s["joint_moment_on_child"]),
        reference_joint_acceleration: numbers(&expect["reference_joint_acceleration"]),
        angular_acceleration: vectors(&expect["angular_acceleration"]),
        cg_acceleration: vectors(&expect["cg_acceleration"]),
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value
        .as_array()
        .expect("an array")
        .iter()
        .map(|v| v.as_f64().expect("a number"))
        .collect()
}
