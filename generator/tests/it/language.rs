//! The meaning of models: names become indices, quantities become SI numbers, absent effects become nothing.

use bryant_generator::law::ForceKind;
use bryant_generator::law::types::{BeltLength, Field, JointOutput, Load};
use bryant_generator::model::{
    Body, Component, Dimension, ElementId, Extrapolate, FieldComponent, Given, Model, Number,
    PointQuantity, Projection, Quantity, Reference, Translation,
};
use bryant_generator::read;
use bryant_generator::read_str;
use std::io;
use std::path::{Path, PathBuf};

/// A complete example, as an engineer would write it.
const SAMPLE: &str = r#"
model: sled-pendulum
dimension: 2                      # motion in the x–z plane
parameters:
  belt_stiffness: { value: 60 kN, min: 5 kN, max: 200 kN }
curves:
  pulse:   { unit: [ms, m/s^2], points: [[0, 0], [10, 0], [20, 198], [90, 198], [100, 0]] }
  webbing: { points: [[0, 0], [0.1, 1]], extrapolate: linear }
systems:
  - name: man
    elements:
      - { name: torso, mass: 30 kg, cg: [0, 0.2], inertia: 1.1 }
      - { name: head, on: torso, at: [0, 0.45], mass: 4.5, cg: [0.02, 0.1], inertia: 0.03 }
    start: { position: [0, 0.25], angles: { torso: -15 deg } }
forces:
  - joint: man/head               # about the joint that carries the head
    elastic: { points: [[-60 deg, -40], [0, 0], [60 deg, 40]], extrapolate: linear }
    damping: 0.6
  - field: sled
    acceleration: [pulse, 0]
  - belt: chest
    from: { on: man/torso, at: [0.1, 0.35] }
    to:   { on: frame, at: [-0.4, 0.7] }
    force: { curve: webbing, times: belt_stiffness }
    slack: 20 mm
outputs:
  - { name: chest belt force, of: belt chest, what: force }
  - { name: head acceleration, of: man/head, at: cg, what: acceleration }
"#;

fn nothing_included(path: &Path) -> io::Result<String> {
    Err(io::Error::new(
        io::ErrorKind::NotFound,
        path.display().to_string(),
    ))
}

fn model(text: &str) -> Model {
    read_str("test.yaml", text, &nothing_included)
        .unwrap_or_else(|e| panic!("{e}"))
        .0
}

// Long: every key of the sample.
#[test]
fn the_sample_means_what_it_says() {
    let model = model(SAMPLE);
    assert_eq!(
        (model.name.as_str(), model.dimension),
        ("sled-pendulum", Dimension::Plane)
    );
    let stiffness = &model.parameters[0];
    assert_eq!(
        (stiffness.default, stiffness.min, stiffness.max),
        (60e3, Some(5e3), Some(200e3))
    );
    assert_eq!(stiffness.unit, "N");

    let pulse = &model.curves[0];
    assert_eq!(pulse.extrapolate, Extrapolate::Hold);
    assert_eq!(pulse.points[2], [0.02, 198.0]);
    assert_eq!(model.curves[1].extrapolate, Extrapolate::Linear);
    assert_eq!(model.curves[2].name, "joint man/head elastic");
    assert_eq!(
        model.curves[2].points[0],
        [-60.0 * (std::f64::consts::PI / 180.0), -40.0]
    );

    let man = &model.systems[0];
    assert_eq!(man.reference, Reference::Free);
    assert_eq!(
        man.position.clone().map(|n| n.constant()),
        [Some(0.0), Some(0.0), Some(0.25)]
    );
    let [torso, head] = &man.elements[..] else {
        panic!("two elements")
    };
    assert_eq!((torso.parent, head.parent), (None, Some(0)));
    assert_eq!(
        head.at.clone().map(|n| n.constant()),
        [Some(0.0), Some(0.0), Some(0.45)]
    );
    assert_eq!(
        torso.angles[1].constant(),
        Some(-15.0 * (std::f64::consts::PI / 180.0))
    );
    assert_eq!(head.inertia[1].constant(), Some(0.03));

    let id = |element| ElementId { system: 0, element };
    let ForceKind::Joint(joint) = ForceKind::of(&model.forces[0]) else {
        panic!("a joint")
    };
    assert_eq!(joint.child, id(1));
    let about = &joint.about;
    assert_eq!(about[1].damping, Some(Number::Constant(0.6)));
    assert_eq!(
        (&about[0], &about[2]),
        (&Default::default(), &Default::default())
    );
    assert!(about[1].friction.is_none() && about[1].neutral.is_none());
    let ForceKind::Field(field) = ForceKind::of(&model.forces[1]) else {
        panic!("a field")
    };
    let Field { on, acceleration } = field;
    assert_eq!(on, &[id(0), id(1)]);
    assert!(matches!(&acceleration[0], FieldComponent::Curve(c) if c.curve == 0));
    assert_eq!(acceleration[2], FieldComponent::Constant(Number::ZERO));
    let ForceKind::Belt(belt) = ForceKind::of(&model.forces[2]) else {
        panic!("a belt")
    };
    assert_eq!(belt.force.times, Number::Parameter(0));
    assert_eq!(belt.length, BeltLength::Slack(Number::Constant(0.02)));

    assert_eq!(model.outputs[0].unit, "N");
    assert_eq!(
        model.outputs[1].quantity,
        Quantity::Point {
            body: Body::Element(id(1)),
            at: head.cg.clone(),
            what: PointQuantity::Acceleration,
            relative_to: Body::Frame,
            projection: Projection::absolute(Component::Resultant),
        }
    );
    assert_eq!((model.run.duration, model.run.every), (1.0, 0.01));
}

#[test]
fn the_bundled_sled_pendulum_is_the_sample_with_a_run() {
    let path = PathBuf::from(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../models/sled-pendulum.yaml"
    ));
    let (mut bundled, files) = read(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(files.len(), 1);
    assert_eq!((bundled.run.duration, bundled.run.every), (0.15, 0.002));
    let sample = model(SAMPLE);
    bundled.title = sample.title.clone();
    bundled.run = sample.run.clone();
    bundled.digest = sample.digest.clone();
    assert_eq!(bundled, sample);
}

/// A planar man with a torso and a head, and the additional text of a test.
fn man(rest: &str) -> String {
    format!(
        "model: m\ndimension: 2\nsystems:\n  - name: man\n    elements:\n      - {{ name: torso, mass: 30, cg: [0, 0.2], inertia: 1.1 }}\n      - {{ name: head, on: torso, at: [0, 0.45], mass: 4.5, cg: [0.02, 0.1], inertia: 0.03 }}\n{rest}"
    )
}

/// The model without the names of its source text.
fn anonymous(text: &str) -> Model {
    Model {
        digest: String::new(),
        ..model(text)
    }
}

#[test]
fn what_is_zero_is_as_if_never_mentioned() {
    let plain = "forces:
  - { joint: man/head, elastic: { points: [[-1, -40], [1, 40]] } }
  - { contact: seat, ellipsoid: { on: man/torso, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0, 0], normal: [0, 1] }, elastic: { points: [[0, 0], [1, 9]] } }
";
    let zeros = "curves: { unused: { points: [[0, 0], [1, 1]] } }
forces:
  - { joint: man/torso, damping: 0, friction: 0 N*m, elastic: { points: [[0, 0], [1, 0]] } }
  - { field: nothing, acceleration: [0, 0 gn] }
  - { field: gravity, acceleration: [0, -1 gn], enabled: false }
  - { load: idle, on: man/head, at: cg, force: [0, { points: [[0, 0], [1, 0]] }], moment: 0 N*m }
  - { load: thrust, on: man/head, force: [1, 1], enabled: false }
  - { joint: man/head, elastic: { points: [[-1, -40], [1, 40]] }, damping: 0, friction: 0, neutral: 0 deg }
  - { contact: seat, ellipsoid: { on: man/torso, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0, 0], normal: [0, 3] }, elastic: { points: [[0, 0], [1, 9]] }, damping: 0, damping_depth: 5 mm, unloading_slope: 0, friction: 0 % }
";
    assert_eq!(model(&man(plain)), model(&man(zeros)));
}

#[test]
fn a_switch_that_nothing_waits_for_is_as_if_never_mentioned() {
    let forces = "forces:\n  - { load: push, on: man/torso, force: [1, 0] }\n";
    let idle = "forces:\n  - { load: push, on: man/torso, force: [1, 0] }\n  - { joint: man/head, damping: 0, since: first }\n";
    // only the third waits for the second, and the force that waits for the first does nothing
    let switches = "switches:\n  - { switch: first, when: { of: joint man/head, what: torque, above: 1 } }\n  - { switch: second, when: { time: 1 }, after: 1 }\n  - { switch: third, when: { of: switch second, what: acts, above: 0.5 } }\n";
    let plain = anonymous(&man(forces));
    assert_eq!(anonymous(&man(&format!("{idle}{switches}"))), plain);

    // an output that refers to a switch keeps it, with everything that its trigger observes
    let outputs = "outputs:\n  - { name: a, of: switch third, what: acts }\n  - { name: b, of: switch first, what: time }\n";
    let seen = model(&man(&format!("{idle}{switches}{outputs}")));
    let names: Vec<&str> = seen.switches.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["first", "second", "third"]);
    assert_eq!(seen.forces.len(), 2);
}

#[test]
fn what_changes_no_webbing_is_as_if_never_mentioned() {
    let belt = |more: &str| {
        anonymous(&man(&format!(
            "forces:\n  - {{ belt: lap, from: {{ on: man/torso, at: [0.1, 0] }}, to: {{ on: frame, at: [-0.2, 0] }}, force: {{ points: [[0, 0], [1, 9]], extrapolate: linear }}{more} }}\nswitches: [{{ switch: crash, when: {{ time: 1 }} }}]\n"
        )))
    };
    let plain = belt("");
    assert_eq!(
        belt(", pretensioner: { fire: crash, retract: { points: [[0, 0], [1, 0]] } }"),
        plain
    );
    assert_eq!(
        belt(", damping: 0, damping_stretch: 2 mm, unloading_slope: 0"),
        plain
    );
    assert!(plain.switches.is_empty());
    assert_eq!(belt(", retractor: { lock: crash }").switches.len(), 1);
}

#[test]
fn a_stop_and_a_lock_without_force_are_as_if_never_mentioned() {
    let joint = |laws: &str| {
        anonymous(&man(&format!(
            "forces:\n  - {{ joint: man/head, damping: 1{laws} }}\nswitches: [{{ switch: hurt, when: {{ time: 1 }} }}]\n"
        )))
    };
    let plain = joint("");
    assert_eq!(
        joint(", stop: { to: 1, stiffness: 0 }, lock: { by: hurt, stiffness: 0, damping: 0 }"),
        plain
    );
    assert!(plain.switches.is_empty());

    let space = |laws: &str| {
        anonymous(&format!(
            "model: m\ndimension: 3\nsystems:\n  - name: man\n    elements:\n      - {{ name: torso, mass: 30, cg: [0, 0, 0.2], inertia: [1, 1, 1] }}\nforces:\n  - {{ joint: man/torso, about: {{ x: {{ damping: 1 }} }}{laws} }}\n"
        ))
    };
    let idle = ", axis: x, flexion: { damping: 0, elastic: { points: [[0, 0], [1, 0]] } }, torsion: { friction: 0 }";
    assert_eq!(space(idle), space(""));
}

#[test]
fn a_force_without_law_stays_where_an_output_looks_at_it() {
    let text = man("forces:
  - { joint: man/torso, damping: 0 }
  - { joint: man/head, damping: 0 }
outputs:
  - { name: neck, of: joint man/head, what: angle }
");
    let model = model(&text);
    assert_eq!(model.forces.len(), 1);
    assert_eq!(model.forces[0].name, "man/head");
    let Quantity::OfForce { force: 0, what } = &model.outputs[0].quantity else {
        panic!("a quantity of the first force")
    };
    assert!(matches!(what.get(), Some(JointOutput { about: 1, .. })));
}

#[test]
fn a_reference_without_acceleration_moves_uniformly() {
    let zero = "    reference: { acceleration: [0, { points: [[0, 0], [1, 0]] }] }\n";
    let fixed = anonymous(&man("    reference: fixed\n"));
    assert_eq!(anonymous(&man(zero)), fixed);
    let at_rest = zero.to_owned() + "    start: { velocity: [0, 0] }\n";
    assert_eq!(anonymous(&man(&at_rest)), fixed);
    let uniform = model(&man(
        &(zero.to_owned() + "    start: { velocity: [2 m/s, 0] }\n")
    ));
    let system = &uniform.systems[0];
    let still = Translation {
        given: Given::Acceleration,
        curves: [None, None, None],
        stops: None,
    };
    assert_eq!(system.reference, Reference::Prescribed(still));
    assert_eq!(
        system.velocity.clone().map(|n| n.constant()),
        [Some(2.0), Some(0.0), Some(0.0)]
    );
    assert!(uniform.curves.is_empty());
}

#[test]
fn a_constant_acceleration_of_the_reference_is_a_held_curve() {
    let text = "parameters: { braking: 5 m/s^2 }\n".to_owned()
        + &man(
            "    reference: { acceleration: [-2 * braking, { points: [[0, 0], [1, 3]], extrapolate: error }] }
    start: { velocity: [50 km/h, 0] }
",
        );
    let model = model(&text);
    let Reference::Prescribed(Translation {
        given: Given::Acceleration,
        curves: [Some(x), None, Some(z)],
        stops: None,
    }) = &model.systems[0].reference
    else {
        panic!("{:?}", model.systems[0].reference)
    };
    let constant = &model.curves[x.curve];
    assert_eq!(constant.points, [[0.0, 1.0], [1.0, 1.0]]);
    assert_eq!(
        (constant.extrapolate, constant.name.as_str()),
        (Extrapolate::Hold, "reference man acceleration x")
    );
    assert_eq!(x.times.value(&[5.0]), -10.0);
    assert_eq!(model.curves[z.curve].extrapolate, Extrapolate::Error);
    assert_eq!(model.curves[z.curve].name, "reference man acceleration z");
}

fn load_of(model: &Model, index: usize) -> &Load {
    let ForceKind::Load(load) = ForceKind::of(&model.forces[index]) else {
        panic!("{:?}", model.forces[index])
    };
    load
}

#[test]
fn a_load_acts_on_the_joint_of_its_element_by_default() {
    let text = "parameters: { scale: 2 }
curves: { pull: { unit: [ms, kN], points: [[0, 0], [100, 4]] } }
".to_owned()
        + &man("forces:
  - { load: thrust, on: man/torso, force: [3 kN * scale, { curve: pull, times: -1 }] }
  - { load: rope, on: man/head, at: cg, force: [{ points: [[0, 5], [1, 7]] }, 0] }
  - { load: motor, on: man/head, at: [0, 20 cm], moment: { points: [[0, 0], [1, 9]], extrapolate: error } }
");
    let model = model(&text);
    let constants = |v: &[Number; 3]| v.clone().map(|n| n.constant().unwrap());
    let (zero, torso, head) = (
        FieldComponent::Constant(Number::ZERO),
        Body::Element(ElementId {
            system: 0,
            element: 0,
        }),
        Body::Element(ElementId {
            system: 0,
            element: 1,
        }),
    );

    let thrust = load_of(&model, 0);
    assert_eq!((thrust.on.on, constants(&thrust.on.at)), (torso, [0.0; 3]));
    let FieldComponent::Constant(x) = &thrust.force[0] else {
        panic!("{:?}", thrust.force)
    };
    assert_eq!(x.value(&[0.5]), 1500.0);
    assert_eq!(thrust.force[1], zero);
    assert!(
        matches!(&thrust.force[2], FieldComponent::Curve(c) if c.curve == 0 && c.times == Number::Constant(-1.0))
    );
    assert_eq!(model.curves[0].points[1], [0.1, 4000.0]);
    assert_eq!(thrust.moment, [zero.clone(), zero.clone(), zero.clone()]);

    let rope = load_of(&model, 1);
    assert_eq!(
        (rope.on.on, constants(&rope.on.at)),
        (head, [0.02, 0.0, 0.1])
    );
    assert!(
        matches!(&rope.force[0], FieldComponent::Curve(c) if model.curves[c.curve].name == "load rope force x")
    );

    let motor = load_of(&model, 2);
    assert_eq!(
        (motor.on.on, constants(&motor.on.at)),
        // a moment has no point of attack
        (head, [0.0, 0.0, 0.0])
    );
    assert_eq!(motor.force, [zero.clone(), zero.clone(), zero.clone()]);
    assert!(
        matches!(&motor.moment[1], FieldComponent::Curve(c) if model.curves[c.curve].name == "load motor moment")
    );
    assert_eq!((&motor.moment[0], &motor.moment[2]), (&zero, &zero));
}

#[test]
fn elements_may_stand_in_any_order() {
    let text = "model: m\ndimension: 2\nsystems:\n  - name: man\n    elements:
      - { name: hand, on: arm, at: [0, 1], mass: 1, cg: [0, 0], inertia: 1 }
      - { name: foot, on: torso, at: [0, 1], mass: 2, cg: [0, 0], inertia: 1 }
      - { name: torso, mass: 3, cg: [0, 0], inertia: 1 }
      - { name: arm, on: torso, at: [0, 1], mass: 4, cg: [0, 0], inertia: 1 }
    start: { angles: { hand: 1, torso: 2 } }
";
    let elements = &model(text).systems[0].elements;
    let names: Vec<(&str, Option<usize>)> = elements
        .iter()
        .map(|e| (e.name.as_str(), e.parent))
        .collect();
    assert_eq!(
        names,
        [
            ("torso", None),
            ("foot", Some(0)),
            ("arm", Some(0)),
            ("hand", Some(2))
        ]
    );
    assert_eq!(elements[3].angles[1], Number::Constant(1.0));
    assert_eq!(elements[0].angles[1], Number::Constant(2.0));
}

#[test]
fn expressions_of_parameters_stay_and_constants_fold() {
    let text = "parameters: { stiffness: 2 kN, unused: 30 kg, mu: 0.5 }\n".to_owned()
        + &man("forces:
  - { joint: man/head, damping: 2 * 3 N*m*s * mu, friction: (stiffness + 1 kN) * 10 cm, friction_speed: 1 rpm }
");
    let model = model(&text);
    let ForceKind::Joint(joint) = ForceKind::of(&model.forces[0]) else {
        panic!("a joint")
    };
    let about = &joint.about;
    let damping = about[1].damping.clone().unwrap();
    assert_eq!(
        damping,
        Number::Product(
            Box::new(Number::Constant(6.0)),
            // nothing depends on the second of three
            Box::new(Number::Parameter(1))
        )
    );
    assert_eq!(damping.value(&[2000.0, 0.25]), 1.5);
    let friction = about[1].friction.clone().unwrap();
    assert_eq!(friction.limit.value(&[2000.0, 0.5]), 300.0);
    assert_eq!(
        friction.tolerance.constant(),
        Some(std::f64::consts::PI / 30.0)
    );
}

#[test]
fn friction_without_a_speed_has_the_documented_one() {
    let model = model(&man("forces:
  - { joint: man/head, friction: 1 }
  - { contact: seat, friction: 0.3, ellipsoid: { on: man/torso, center: [0, 0], semi_axes: [0.1, 0.1] }, plane: { on: frame, at: [0, 0], normal: [3, 4] }, damping: 1 }
"));
    let ForceKind::Joint(joint) = ForceKind::of(&model.forces[0]) else {
        panic!("a joint")
    };
    let about = &joint.about;
    assert_eq!(
        about[1].friction.as_ref().unwrap().tolerance,
        Number::Constant(0.1)
    );
    let ForceKind::Contact(contact) = ForceKind::of(&model.forces[1]) else {
        panic!("a contact")
    };
    assert_eq!(
        contact.friction.as_ref().unwrap().tolerance,
        Number::Constant(0.01)
    );
    // the reader makes normals unit vectors
    let plane = contact.against.plane().expect("a plane");
    assert_eq!(
        plane.normal.clone().map(|n| n.constant()),
        [Some(0.6), Some(0.0), Some(0.8)]
    );
}

#[test]
fn space_has_three_of_everything() {
    let text = "model: m
dimension: 3
coordinates: bryant
curves: { pulse: { unit: [ms, gn], points: [[0, 0], [100, 20]] }, winding: { points: [[0, 0], [1, 1]] } }
systems:
  - name: man
    reference: { acceleration: [pulse, 0, { curve: pulse, times: -2 }] }
    elements:
      - { name: torso, mass: 30, cg: [0, 0, 0.2], inertia: [1, 2, 2.5], axes: [0, 20 deg, 0] }
      - { name: head, on: torso, at: [0, 0, 0.45], mass: 4.5, cg: [0.02, 0, 0.1], inertia: [0.03, 0.03, 0.02] }
    start: { position: [1, 2, 3], velocity: [7, 8, 9], angles: { head: [1, 2, 3] }, rates: { torso: [4, 5, 6] } }
forces:
  - { joint: man/head, about: { x: { damping: 1 }, z: { damping: 3 } } }
  - { load: wrench, on: man/head, force: [1, 2, 3 kN], moment: [4 N*m, winding, { curve: winding, times: 5 }] }
outputs:
  - { name: a, of: joint man/head, what: rate, about: z }
  - { name: b, of: man/head, what: angular_velocity }
  - { name: c, of: man/head, what: angle, component: x }
";
    let model = model(text);
    let man = &model.systems[0];
    let Reference::Prescribed(Translation {
        curves: [Some(x), None, Some(z)],
        ..
    }) = &man.reference
    else {
        panic!("{:?}", man.reference)
    };
    assert_eq!(
        (x.curve, x.times.constant(), z.times.constant()),
        (0, Some(1.0), Some(-2.0))
    );
    assert_eq!(model.curves[0].points[1], [0.1, 20.0 * 9.80665]);
    let constants = |v: &[Number; 3]| v.clone().map(|n| n.constant().unwrap());
    assert_eq!(constants(&man.position), [1.0, 2.0, 3.0]);
    assert_eq!(constants(&man.velocity), [7.0, 8.0, 9.0]);
    assert_eq!(constants(&man.elements[1].angles), [1.0, 2.0, 3.0]);
    assert_eq!(
        constants(&man.elements[0].angular_velocity),
        [4.0, 5.0, 6.0]
    );
    assert_eq!(constants(&man.elements[0].inertia), [1.0, 2.0, 2.5]);
    let ForceKind::Joint(joint) = ForceKind::of(&model.forces[0]) else {
        panic!("a joint")
    };
    let about = &joint.about;
    assert_eq!(about[2].damping, Some(Number::Constant(3.0)));
    assert!(about[1].damping.is_none());
    let wrench = load_of(&model, 1);
    let constant = |value| FieldComponent::Constant(Number::Constant(value));
    assert_eq!(
        wrench.force,
        [constant(1.0), constant(2.0), constant(3000.0)]
    );
    assert_eq!(wrench.moment[0], constant(4.0));
    assert!(matches!(&wrench.moment[1], FieldComponent::Curve(c) if c.curve == 1));
    assert!(
        matches!(&wrench.moment[2], FieldComponent::Curve(c) if c.times == Number::Constant(5.0))
    );
    let Quantity::OfForce { what, .. } = &model.outputs[0].quantity else {
        panic!("a quantity of a force")
    };
    assert!(matches!(what.get(), Some(JointOutput { about: 2, .. })));
    assert!(matches!(
        model.outputs[1].quantity,
        Quantity::Rotation {
            projection: Projection {
                component: Component::Resultant,
                axes: Body::Frame,
            },
            ..
        }
    ));
}

#[test]
fn included_files_count_as_written_before() {
    let loader = |path: &Path| {
        match path.to_str() {
        Some("models/data/child.yaml") => Ok("include: [units.yaml]
parameters: { scale: 2 }
systems:
  - { name: child, elements: [{ name: torso, mass: 6.5 * scale, cg: [0, 0.1 * first], inertia: 0.05 * last }], start: { position: [9, 9] } }
"
        .to_owned()),
        Some("models/data/units.yaml") => Ok("parameters: { first: 1 }\n".to_owned()),
        _ => Err(io::ErrorKind::NotFound.into()),
    }
    };
    let text = "model: m
dimension: 2
include: [data/child.yaml, ./data/units.yaml]
parameters: { last: 3 }
systems:
  - { name: child, reference: fixed, start: { position: [1, 2] } }
";
    let (model, files) = read_str("models/m.yaml", text, &loader).unwrap_or_else(|e| panic!("{e}"));
    let names: Vec<&str> = model.parameters.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["first", "scale", "last"]);
    assert_eq!(model.systems[0].reference, Reference::Fixed);
    assert_eq!(model.systems[0].position[2], Number::Constant(2.0));
    let files: Vec<&str> = files.iter().map(|p| p.to_str().unwrap()).collect();
    assert_eq!(
        files,
        [
            "models/m.yaml",
            "models/data/child.yaml",
            "models/data/units.yaml"
        ]
    );
}

#[test]
fn the_digest_is_of_what_the_text_means() {
    let text = man("forces:\n  - { field: gravity, acceleration: [0, -1 gn] }\n");
    let digest = |name: &str, text: &str| read_str(name, text, &nothing_included).unwrap().0.digest;
    let means = digest("a.yaml", &text);
    assert_eq!(means.len(), 64);
    for same in [
        text.replace('\n', "\r\n"),
        text.replace("mass: 30", "mass: 30000 g"),
        text.replace("-1 gn", "-9.80665"),
        text.replace("[0, -1 gn]", "[-0.0, -1 gn]"),
        format!("# a comment\n{text}"),
        format!("{text}parameters: {{ unused: 1 }}\n"),
    ] {
        assert_eq!(digest("b/c.yaml", &same), means, "{same}");
    }
    for other in [
        text.replace("30", "31"),
        text.replace("torso", "trunk"),
        text.replace("model: m", "model: n"),
    ] {
        assert_ne!(digest("a.yaml", &other), means, "{other}");
    }
}

#[test]
fn a_pendulum_of_a_point_mass_is_regular_on_a_fixed_joint() {
    // a point mass turns about a fixed joint with the inertia m c², but a free one has none about itself
    let text = |reference| {
        format!(
            "model: m\ndimension: 2\nsystems:\n  - {{ name: pendulum, reference: {reference}, elements: [{{ name: bob, mass: 1, cg: [0, -1], inertia: 0 }}] }}\n"
        )
    };
    model(&text("fixed"));
    assert!(read_str("m.yaml", &text("free"), &nothing_included).is_err());
}

#[test]
fn a_chain_of_two_thousand_elements_is_read_soon() {
    let mut text = "model: m\ndimension: 3\nsystems:\n  - name: chain\n    elements:\n      - { name: e0, mass: 1, cg: [0, 0, 0.5], inertia: [1, 1, 1] }\n".to_owned();
    for k in 1..2000 {
        text += &format!(
            "      - {{ name: e{k}, on: e{}, at: [0, 0, 1], mass: 1 kg, cg: [0, 0, 0.5], inertia: [1, 1, 1] }}\n",
            k - 1
        );
    }
    let begin = std::time::Instant::now();
    assert_eq!(model(&text).systems[0].elements.len(), 2000);
    // this takes a second in an optimised build; this one may be unoptimised and share its processor
    assert!(begin.elapsed().as_secs() < 20, "{:?}", begin.elapsed());
}

mod hostile {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

        /// Every damaged model gives a model or a message, never a panic, and every message can be drawn.
        #[test]
        fn damaged_text_never_panics(
            cuts in prop::collection::vec((0usize..1500, 0usize..12, "[-\\[\\]{}:,#'\"&*!|>%@` \\t\\n0-9a-e.é²^()/]{0,4}"), 1..5)
        ) {
            let mut characters: Vec<char> = SAMPLE.chars().collect();
            for (at, length, insert) in cuts {
                let at = at.min(characters.len());
                let end = (at + length).min(characters.len());
                characters.splice(at..end, insert.chars());
            }
            let text: String = characters.into_iter().collect();
            if let Err(problems) = read_str("damaged.yaml", &text, &nothing_included) {
                prop_assert!(!problems.problems.is_empty());
                prop_assert!(!problems.to_string().is_empty());
                prop_assert!(problems.lines().all(|line| !line.contains('\n')));
            }
        }
    }
}

#[test]
fn a_curve_from_a_file_is_the_curve_as_if_written_in_place() {
    let text = |curve: &str| {
        man(&format!(
            "curves: {{ pulse: {{ {curve}, unit: [ms, m/s^2], interpolate: cubic }} }}
forces: [{{ field: sled, acceleration: [pulse, {{ curve: pulse, stretch: 2 }}] }}]
"
        ))
    };
    let loader = |path: &Path| match path.to_str() {
        Some("models/data/pulse.csv") => Ok("time,note,ax\n0,a,0\n20,b,198\n90,c,5e1\n".to_owned()),
        _ => nothing_included(path),
    };
    let read =
        |text: &str| read_str("models/sled.yaml", text, &loader).unwrap_or_else(|e| panic!("{e}"));
    let in_place = text("points: [[0, 0], [20, 198], [90, 50]]");
    let in_file = text("file: data/../data/pulse.csv, columns: [time, 3]");
    let (model, files) = read(&in_file);
    assert_eq!(
        files,
        ["models/sled.yaml", "models/data/pulse.csv"].map(PathBuf::from)
    );
    // as a path is written on Windows
    let (same, same_files) = read(&text(r"file: data\..\data\pulse.csv, columns: [time, 3]"));
    assert_eq!((&same.curves, same_files), (&model.curves, files));
    let anonymous = |model: Model| Model {
        digest: String::new(),
        ..model
    };
    let digest = model.digest.clone();
    assert_eq!(anonymous(model), anonymous(read(&in_place).0));

    // the included file is part of the model's digest
    let changed = |path: &Path| loader(path).map(|text| text.replace("198", "199"));
    let (other, _) = read_str("models/sled.yaml", &in_file, &changed).unwrap();
    assert_ne!(other.digest, digest);
}

#[test]
fn a_curve_stretched_by_one_is_as_if_not_stretched() {
    let text = |acceleration: &str| {
        man(&format!(
            "curves: {{ pulse: {{ points: [[0, 0], [1, 2]], interpolate: linear }} }}
forces: [{{ field: sled, acceleration: [{acceleration}, 0] }}]
"
        ))
    };
    let plain = anonymous(&text("pulse"));
    assert_eq!(
        anonymous(&text("{ curve: pulse, stretch: 1, times: 100 % }")),
        plain
    );
    assert_ne!(anonymous(&text("{ curve: pulse, stretch: 2 }")), plain);
}

#[test]
fn a_vehicle_that_nothing_uses_is_as_if_not_written() {
    let rest = "forces: [{ field: gravity, acceleration: [0, -9.81] }]\n";
    let vehicles = "vehicles:
  - { name: car, acceleration: [{ points: [[0, 0], [1, 3]] }, 0], angles: 3 deg }
  - { name: sled, start: { velocity: [1, 0] } }
";
    assert_eq!(
        anonymous(&man(&format!("{vehicles}{rest}"))),
        anonymous(&man(rest))
    );
    // only the second is used, and it becomes the first
    let output = "outputs: [{ name: x, of: sled, what: position }]\n";
    let model = model(&man(&format!("{vehicles}{rest}{output}")));
    assert_eq!(model.vehicles.len(), 1);
    assert_eq!(model.vehicles[0].name, "sled");
    assert!(model.curves.is_empty());
    assert!(matches!(
        model.outputs[0].quantity,
        Quantity::Point {
            body: Body::Vehicle(0),
            ..
        }
    ));
    // so it is when an output refers to it, and when a switch does
    let output =
        "outputs: [{ name: x, of: man/head, what: velocity, relative_to: sled, axes: frame }]\n";
    let model = self::model(&man(&format!("{vehicles}{rest}{output}")));
    assert_eq!(model.vehicles.len(), 1);
    assert!(matches!(
        model.outputs[0].quantity,
        Quantity::Point {
            relative_to: Body::Vehicle(0),
            projection: Projection {
                axes: Body::Frame,
                ..
            },
            ..
        }
    ));
    let switch = "forces: [{ load: push, on: man/head, force: [1, 0], since: far }]
switches: [{ switch: far, when: { of: sled, what: displacement, above: 1 m } }]\n";
    let model = self::model(&man(&format!("{vehicles}{switch}")));
    assert_eq!(model.vehicles.len(), 1);
    assert!(matches!(
        model.switches[0].trigger.quantity(),
        Some(Quantity::Point {
            body: Body::Vehicle(0),
            ..
        })
    ));
}

#[test]
fn a_joint_on_a_vehicle_starts_where_that_is() {
    let text = man("    reference: { on: car, at: [0.3, 0.2] }
parameters: { tilt: 30 deg }
vehicles:
  - name: car
    angles: { points: [[0, 1], [2, 1.5]], interpolate: cubic }
    start: { position: [5, 1] }
  - { name: tilted, angles: tilt, start: { position: [0, 2] } }
forces:
  - { belt: b, from: { on: man/head, at: [0, 0] }, to: { on: tilted, at: [1, 0] }, force: { points: [[0, 0], [1, 9]] } }
");
    let model = model(&text);
    let man = &model.systems[0];
    assert!(matches!(
        man.reference,
        Reference::Riding { vehicle: 0, .. }
    ));
    // x axis (cos φ, −sin φ), z axis (sin φ, cos φ)
    let (s, c) = 1f64.sin_cos();
    let expected = [5.0 + 0.3 * c + 0.2 * s, 0.0, 1.0 - 0.3 * s + 0.2 * c];
    for (ours, expected) in man.position.iter().zip(expected) {
        let ours = ours.constant().expect("a number");
        assert!((ours - expected).abs() <= 4.0 * f64::EPSILON * 5.0);
    }
    let ForceKind::Belt(belt) = ForceKind::of(&model.forces[0]) else {
        panic!("a belt")
    };
    assert_eq!(belt.to.on, Body::Vehicle(1));
    assert_eq!(model.vehicles[1].angles_at_start[1], Number::Parameter(0));
}

/// A sensor measures components, so a filter is given to them; of a resultant it is refused, whatever has it.
#[test]
fn resultants_are_not_filtered() {
    let text = |output: &str, what: &str| {
        format!(
            "{}{output}, filter: CFC60, {what} }}]\nrun: {{ duration: 1 s, every: 10 ms }}\n",
            SAMPLE.replace(
                "  - field: sled",
                "  - bushing: mount\n    from: { on: frame, at: [0, 0] }\n    to: { on: man/torso, at: [0, 0] }\n    along: { x: { stiffness: 3 }, z: { stiffness: 3 } }\n  - field: sled"
            )
            .split("outputs:")
            .next()
            .unwrap_or_default()
            .to_owned()
                + "outputs: [{ name: of, "
        )
    };
    for of in [
        "of: bushing mount, what: force",
        "of: bushing mount, what: displacement",
        "of: man/head, what: acceleration",
        "of: joint man/head, what: force",
    ] {
        let whole = read_str(
            "test.yaml",
            &text(of, "component: resultant"),
            &nothing_included,
        );
        let told = whole.err().map(|told| told.to_string());
        assert!(
            told.as_ref()
                .is_some_and(|told| told.contains("a resultant is not filtered")),
            "{of}: {told:?}"
        );
        assert!(
            read_str("test.yaml", &text(of, "component: x"), &nothing_included).is_ok(),
            "{of}"
        );
    }
}

/// Curves of one test read each of its files once, and count as files of the model.
#[test]
fn curves_of_one_test_read_it_once() {
    let head = "Time of first sample :0\nSampling interval :0.001\nUnit :m/s^2\n";
    let model = "model: sled
dimension: 2
vehicles: [{ name: sled, acceleration: [{ curve: pulse }, { curve: heave }] }]
curves:
  pulse: { mme: t.mme, channel: 10SLED000000ACX0, extrapolate: hold }
  heave: { mme: t.mme, channel: 10SLED000000ACZ0, extrapolate: hold }
systems:
  - name: a
    reference: free
    elements: [{ name: b, mass: 1 kg, cg: [0, 0], inertia: 1 }]
outputs: [{ name: x, of: sled, what: acceleration, component: x }]
run: { duration: 1 ms, every: 1 ms }
";
    let channel = |code: &str| format!("Channel code :{code}\n{head}0\n1\n");
    let texts = [
        ("t.mme", "Test title :x\n".to_owned()),
        ("Channel/t.001", channel("10SLED000000ACX0")),
        ("Channel/t.002", channel("10SLED000000ACZ0")),
    ];
    let asked = std::cell::RefCell::new(Vec::new());
    let loader = |path: &Path| {
        let path = path.to_string_lossy().replace('\\', "/");
        let text = texts.iter().find(|(name, _)| *name == path);
        asked.borrow_mut().push(path);
        text.map(|(_, text)| text.clone())
            .ok_or_else(|| io::ErrorKind::NotFound.into())
    };
    let (_, files) = read_str("sled.yaml", model, &loader).unwrap_or_else(|e| panic!("{e}"));
    let mut asked = asked.into_inner();
    let all = asked.len();
    asked.sort();
    asked.dedup();
    assert_eq!(asked.len(), all, "a file is read again");
    let files: Vec<String> = files.iter().map(|f| f.display().to_string()).collect();
    assert_eq!(
        files,
        ["sled.yaml", "t.mme", "Channel/t.001", "Channel/t.002"]
            .map(|f| f.replace('/', std::path::MAIN_SEPARATOR_STR))
    );
}
