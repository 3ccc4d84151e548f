//! Where surfaces touch: nearest points by their definition, forces by what they do to a mechanism.

use super::{engine, models, values};
use bryant_generator::effect::{Effect, without};
use bryant_generator::law::ForceKind;
use bryant_generator::model::{Body, Model};
use bryant_runtime::{Dynamics, StateKind};
use bryant_tests::trees::Random;
use std::path::Path;

fn read(text: &str) -> Model {
    let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
    let read = bryant_generator::read_str("balls.yaml", text, &none);
    read.map(|(model, _)| model)
        .unwrap_or_else(|problems| panic!("{problems}"))
}

/// The rows of the contacts of a model, at a state that differs from that of its start by `change`.
fn contacts(model: &Model, change: impl Fn(&mut [f64])) -> (Vec<String>, Vec<[f64; 10]>) {
    let engine = engine(model, &["contacts".to_owned()]);
    let machine = engine.over::<f64>();
    let mut y = vec![0.0; engine.info().state_length()];
    machine.initial_state(&mut y);
    change(&mut y);
    let found = values(&engine, &machine, "contacts", (0.0, &y), &[]);
    let rows = found
        .chunks_exact(10)
        .map(|row| row.try_into().expect("ten"));
    (engine.functions()[0].rows.clone(), rows.collect())
}

fn same(found: &[f64], expected: &[f64], most: f64) {
    assert_eq!(found.len(), expected.len());
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= most, "{found:?}, not {expected:?}");
    }
}

/// A ball over the ground, beside the edge of a shelf and beside another ball: numbers that one sees.
#[test]
fn a_ball() {
    let text = "model: balls
dimension: 3
systems:
  - name: ball
    reference: free
    elements: [{ name: body, mass: 2, cg: [0, 0, 0], inertia: [0.1, 0.1, 0.1] }]
    start: { position: [0, 0, 0.48], velocity: [0, 0, -2] }
forces:
  - { contact: ground, ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [0.5, 0.5, 0.5] }, plane: { on: frame, at: [0, 0, 0], normal: [0, 0, 1] }, stiffness: 1000, damping: 10 }
  - { contact: shelf, ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [0.5, 0.5, 0.5] }, plane: { on: frame, at: [2, 0, 0.1], normal: [0, 0, 1], along: [1, 0, 0], extent: [0.5, 0.5], edge: { rule: cut } }, stiffness: 1000 }
  - { contact: post, ellipsoid: { on: ball/body, center: [0, 0, 0], semi_axes: [0.5, 0.5, 0.5] }, with: { on: frame, center: [0, 1, 0.48], semi_axes: [0.3, 0.3, 0.3] }, stiffness: 1000 }
run: { duration: 1 s, every: 10 ms }
";
    let (names, rows) = contacts(&read(text), |_| ());
    assert_eq!(names, ["ground", "shelf", "post"]);
    // 2 cm deep: 20 N of the spring, and 20 N of the damper
    same(
        &rows[0],
        &[-0.02, 0.0, 0.0, -0.02, 0.0, 0.0, 1.0, 0.0, 0.0, 40.0],
        1e-12,
    );
    // 12 cm below the plane of the shelf, which ends 1.5 m beside the ball
    same(
        &rows[1],
        &[1.5, 0.0, 0.0, -0.02, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0],
        1e-12,
    );
    // half-way between the points that face each other
    same(
        &rows[2],
        &[0.2, 0.0, 0.6, 0.48, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0],
        1e-12,
    );
}

/// Nearest points lie on both surfaces, and the line between them is along both of their normals.
#[test]
fn nearest_points_of_ellipsoids() {
    const AXES: [[f64; 3]; 2] = [[0.3, 0.12, 0.2], [0.25, 0.4, 0.15]];
    let text = |[a, b, c]: [f64; 3], [d, e, f]: [f64; 3]| {
        format!("model: eggs
dimension: 3
systems:
  - name: egg
    reference: free
    elements: [{{ name: body, mass: 2, cg: [0, 0, 0], inertia: [0.1, 0.1, 0.1] }}]
  - name: other
    reference: free
    elements: [{{ name: body, mass: 2, cg: [0, 0, 0], inertia: [0.1, 0.1, 0.1] }}]
    start: {{ position: [0.1, 0, 0] }}
forces:
  - {{ contact: eggs, ellipsoid: {{ on: egg/body, center: [0, 0, 0], semi_axes: [{a}, {b}, {c}] }}, with: {{ on: other/body, center: [0, 0, 0], semi_axes: [{d}, {e}, {f}] }}, stiffness: 1000 }}
run: {{ duration: 1 s, every: 10 ms }}
")
    };
    let model = read(&text(AXES[0], AXES[1]));
    let frames = ["egg/body", "other/body"];
    let asked: Vec<String> = frames
        .iter()
        .map(|frame| format!("pose({frame})"))
        .chain(["contacts".to_owned()])
        .collect();
    let engine = engine(&model, &asked);
    let machine = engine.over::<f64>();
    let mut random = Random::new(7);
    let (mut apart, mut pressed) = (0, 0);
    for _ in 0..200 {
        let mut y = vec![0.0; engine.info().state_length()];
        machine.initial_state(&mut y);
        for entry in &mut y {
            *entry += random.uniform(-0.5, 0.5);
        }
        machine.normalize(&mut y);
        let poses = frames
            .map(|frame| values(&engine, &machine, &format!("pose({frame})"), (0.0, &y), &[]));
        let row = values(&engine, &machine, "contacts", (0.0, &y), &[]);
        let (gap, place, normal, force) = (row[0], &row[1..4], &row[4..7], &row[7..]);
        (apart, pressed) = (
            apart + usize::from(gap > 0.0),
            pressed + usize::from(gap < 0.0),
        );
        for (which, (pose, axes)) in poses.iter().zip(AXES).enumerate() {
            let side = if which == 0 { 0.5 } else { -0.5 };
            // in the axes of the ellipsoid: R^T (point - center)
            let local = |v: [f64; 3]| {
                [0, 1, 2].map(|j| (0..3).map(|i| pose[4 * i + j] * v[i]).sum::<f64>())
            };
            let point =
                local([0, 1, 2].map(|i| place[i] + side * gap * normal[i] - pose[4 * i + 3]));
            let inside: f64 = point.iter().zip(axes).map(|(x, a)| (x / a).powi(2)).sum();
            same(&[inside], &[1.0], 1e-9);
            // towards the other body
            let outward = [0, 1, 2].map(|i| point[i] / axes[i].powi(2));
            let size = outward.iter().map(|x| x * x).sum::<f64>().sqrt();
            let towards = local([0, 1, 2].map(|i| -2.0 * side * normal[i]));
            same(&outward.map(|x| x / size), &towards, 1e-7);
        }
        let expected = [0, 1, 2].map(|i| 1000.0 * (-gap).max(0.0) * normal[i]);
        same(force, &expected, 1e-6);
    }
    assert!(
        apart > 30 && pressed > 30,
        "{apart} apart, {pressed} pressed"
    );
}

/// On every model with contacts: what the generalised forces lose without them is the sum of J^T F over both bodies.
#[test]
fn their_forces_are_those_of_the_model() {
    let mut checked = 0;
    for model in models(&["../models", "../models/applications", "models"]) {
        checked += usize::from(forces_agree(&model));
    }
    assert!(checked > 10, "only {checked} models were checked");
}

fn forces_agree(model: &Model) -> bool {
    let mut pairs: Vec<[Body; 2]> = Vec::new();
    let mut reduced = model.clone();
    for (force, of) in model.forces.iter().enumerate().rev() {
        let mut own: Vec<[Body; 2]> = match ForceKind::of(of) {
            // the push of an edge that fades is at the centre
            ForceKind::Contact(contact)
                if contact.against.plane().is_some_and(|p| p.extent.is_some()) =>
            {
                return false;
            }
            ForceKind::Contact(contact) => {
                vec![[contact.ellipsoid.center.on, contact.against.place().on]]
            }
            ForceKind::Airbag(airbag) => airbag
                .against
                .iter()
                .map(|other| [airbag.ellipsoid.center.on, other.center.on])
                .collect(),
            _ => continue,
        };
        own.append(&mut pairs);
        pairs = own;
        match without(&reduced, Effect::Force { force }) {
            Some(variant) => reduced = variant.model,
            None => return false,
        }
    }
    if pairs.is_empty() {
        return false;
    }
    let elements: Vec<String> = pairs
        .iter()
        .flatten()
        .filter(|body| matches!(body, Body::Element(_)))
        .map(|body| model.name_of(*body))
        .collect();
    let frames = elements
        .iter()
        .flat_map(|element| ["pose", "jacobian"].map(|of| format!("{of}({element})")));
    let both = ["contacts", "applied_forces"].map(String::from);
    let mut asked: Vec<String> = frames.chain(both.clone()).collect();
    asked.sort();
    asked.dedup();
    let whole = engine(model, &asked);
    let rest = engine(&reduced, &both);
    let (machine, without) = (whole.over::<f64>(), rest.over::<f64>());
    let info = whole.info();
    let (n, q) = (info.velocities.len(), info.coordinates.len());
    assert_eq!(
        rest.functions()[rest.function("contacts").expect("it is")].rows,
        [""; 0]
    );
    let mut random = Random::new(info.name.len() as u64);
    let mut touched = false;
    for _ in 0..4 {
        let mut y = vec![0.0; info.state_length()];
        machine.initial_state(&mut y);
        for (entry, kind) in y.iter_mut().zip(info.kinds) {
            if !matches!(kind, StateKind::Memory | StateKind::Law) {
                *entry += random.uniform(-0.2, 0.2);
            }
        }
        machine.normalize(&mut y);
        let mut less = vec![0.0; rest.info().state_length()];
        without.initial_state(&mut less);
        less[..q + n].copy_from_slice(&y[..q + n]);
        let of = |name: &str| values(&whole, &machine, name, (0.0, &y), &vec![0.0; n]);
        let forces = of("applied_forces");
        let others = values(
            &rest,
            &without,
            "applied_forces",
            (0.0, &less),
            &vec![0.0; n],
        );
        let rows = of("contacts");
        assert_eq!(rows.len(), 10 * pairs.len(), "{}", model.name);
        let mut sum = others.clone();
        let mut sizes = vec![0.0; n];
        for (row, bodies) in rows.chunks_exact(10).zip(&pairs) {
            touched |= row[7..].iter().any(|&force| force != 0.0);
            for (body, sign) in bodies.iter().zip([1.0, -1.0]) {
                if !matches!(body, Body::Element(_)) {
                    continue;
                }
                let element = model.name_of(*body);
                let (pose, jacobian) = (
                    of(&format!("pose({element})")),
                    of(&format!("jacobian({element})")),
                );
                let arm = [0, 1, 2].map(|i| row[1 + i] - pose[4 * i + 3]);
                let force = [0, 1, 2].map(|i| sign * row[7 + i]);
                let moment = [0, 1, 2].map(|i| {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    arm[j] * force[k] - arm[k] * force[j]
                });
                let wrench = [force, moment].concat();
                for column in 0..n {
                    let terms = (0..6).map(|row| jacobian[n * row + column] * wrench[row]);
                    for term in terms {
                        sum[column] += term;
                        sizes[column] += term.abs();
                    }
                }
            }
        }
        for i in 0..n {
            let most = 1e-11 * (sizes[i] + forces[i].abs() + others[i].abs()) + 1e-12;
            assert!(
                (sum[i] - forces[i]).abs() <= most,
                "{}: {} of {i}, not {}, within {most:e}",
                model.name,
                sum[i],
                forces[i]
            );
        }
    }
    touched
}
