//! What models mean: names to indices, quantities to SI, absent effects to nothing.

use bryant_generator::model::{
    BeltLength, Component, Dimension, ElementId, Extrapolate, FieldComponent, ForceKind, Model,
    Number, PointQuantity, Quantity, Reference, read, read_str,
};
use std::io;
use std::path::{Path, PathBuf};

/// The sample of the design, as an engineer would write it.
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
    elastic: { points: [[-60 deg, -40], [0, 0], [60 deg, 40]] }
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
    let ForceKind::Joint { child, about } = &model.forces[0].kind else {
        panic!("a joint")
    };
    assert_eq!(*child, id(1));
    assert_eq!(about[1].damping, Some(Number::Constant(0.6)));
    assert_eq!(
        (&about[0], &about[2]),
        (&Default::default(), &Default::default())
    );
    assert!(about[1].friction.is_none() && about[1].neutral.is_none());
    let ForceKind::Field { on, acceleration } = &model.forces[1].kind else {
        panic!("a field")
    };
    assert_eq!(on, &[id(0), id(1)]);
    assert!(matches!(&acceleration[0], FieldComponent::Curve(c) if c.curve == 0));
    assert_eq!(acceleration[2], FieldComponent::Constant(Number::ZERO));
    let ForceKind::Belt(belt) = &model.forces[2].kind else {
        panic!("a belt")
    };
    assert_eq!(belt.force.times, Number::Parameter(0));
    assert_eq!(belt.length, BeltLength::Slack(Number::Constant(0.02)));

    assert_eq!(model.outputs[0].unit, "N");
    assert_eq!(
        model.outputs[1].quantity,
        Quantity::Point {
            element: id(1),
            at: head.cg.clone(),
            what: PointQuantity::Acceleration,
            component: Component::Resultant,
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
