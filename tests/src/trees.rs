//! Random and regular trees, and random states of them: the same for the same seed.

use crate::reference::element;
use bryant_generator::expression::Function;
use bryant_generator::law::types::Field;
use bryant_generator::model::{
    Active, Coordinates, Dimension, Element, ElementId, FieldComponent, Force, Joint, Model,
    Number, Reference, Run, System,
};
use bryant_generator::motion::Layout;
use bryant_generator::motion::ball::Orientation;
pub use bryant_hard::random::Random;

/// The branching of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Each element on the one before.
    Chain,
    /// All on the root.
    Star,
    /// Each on any before it.
    Random,
}

/// A model of one random tree in a field of gravity. Masses 0.5 to 5 kg, lengths up to 0.4 m, inertias of general
/// ellipsoids.
pub fn random_tree(
    random: &mut Random,
    dimension: Dimension,
    coordinates: Coordinates,
    reference: Reference,
    shape: Shape,
    count: usize,
) -> Model {
    let plane = dimension == Dimension::Plane;
    let vector = |random: &mut Random, size: f64| -> [Number; 3] {
        let mut v = [0, 1, 2].map(|_| random.uniform(-size, size));
        if plane {
            v[1] = 0.0;
        }
        v.map(Number::from)
    };
    let elements: Vec<Element> = (0..count)
        .map(|k| {
            let mass = random.uniform(0.5, 5.0);
            // semi-axes of a solid ellipsoid: its moments of inertia are always realisable
            let squares = [0, 1, 2].map(|_| random.uniform(0.03, 0.2f64).powi(2));
            let sum: f64 = squares.iter().sum();
            Element {
                name: format!("e{k}"),
                parent: (k > 0).then(|| match shape {
                    Shape::Chain => k - 1,
                    Shape::Star => 0,
                    Shape::Random => random.below(k),
                }),
                joint: Joint::Ball,
                at: if k > 0 {
                    vector(random, 0.4)
                } else {
                    [0.0; 3].map(Number::from)
                },
                mass: mass.into(),
                cg: vector(random, 0.2),
                inertia: squares.map(|s| (mass / 5.0 * (sum - s)).into()),
                axes: if plane {
                    [0.0; 3].map(Number::from)
                } else {
                    vector(random, 3.0)
                },
                ..element()
            }
        })
        .collect();
    one_system(dimension, coordinates, reference, elements)
}

/// A chain of equal elements that hang along −z from a reference joint: rods of 1 kg and 0.1 m, slightly asymmetric.
pub fn chain(
    dimension: Dimension,
    coordinates: Coordinates,
    reference: Reference,
    count: usize,
) -> Model {
    let elements = (0..count)
        .map(|k| Element {
            name: format!("e{k}"),
            parent: k.checked_sub(1),
            at: if k > 0 { [0.002, 0.0, -0.1] } else { [0.0; 3] }.map(Number::from),
            joint: Joint::Ball,
            mass: 1.0.into(),
            cg: [0.003, 0.0, -0.05].map(Number::from),
            inertia: [0.9e-3, 1.0e-3, 0.3e-3].map(Number::from),
            ..element()
        })
        .collect();
    one_system(dimension, coordinates, reference, elements)
}

fn one_system(
    dimension: Dimension,
    coordinates: Coordinates,
    reference: Reference,
    elements: Vec<Element>,
) -> Model {
    let on = (0..elements.len())
        .map(|element| ElementId { system: 0, element })
        .collect();
    Model {
        name: "random-tree".into(),
        title: String::new(),
        dimension,
        coordinates,
        parameters: vec![],
        curves: vec![],
        vehicles: vec![],
        systems: vec![System {
            name: "tree".into(),
            elements,
            reference,
            position: [0.0; 3].map(Number::from),
            velocity: [0.0; 3].map(Number::from),
        }],
        forces: vec![Force {
            name: "gravity".into(),
            law: Box::new(Field {
                on,
                acceleration: [0.0, 0.0, -9.81].map(|a| FieldComponent::Constant(a.into())),
            }),
            active: Active::default(),
        }],
        switches: vec![],
        outputs: vec![],
        run: Run {
            duration: 1.0,
            every: 0.01,
        },
        shown: vec![],
        units: Default::default(),
        digest: String::new(),
    }
}

/// The functions that the equations of trees call: only choices. Any other function gives NaN.
pub fn choices(function: Function, arguments: &[f64]) -> f64 {
    match (function, arguments) {
        (Function::Choose, &[a, b, then, otherwise]) => {
            if a < b {
                then
            } else {
                otherwise
            }
        }
        _ => f64::NAN,
    }
}

/// Random charts for a model in Bryant angles, one for each element, which are the first entries of its memory; empty
/// for other models.
pub fn random_charts(random: &mut Random, model: &Model) -> Vec<f64> {
    (0..Layout::of(model).charts())
        .map(|_| f64::from(u8::from(random.uniform(0.0, 1.0) > 0.5)))
        .collect()
}

/// A random state: positions within a metre, any orientation (Bryant angles away from their singularity), rates of a
/// few per second.
pub fn random_state(random: &mut Random, model: &Model) -> (Vec<f64>, Vec<f64>) {
    let layout = Layout::of(model);
    let mut q: Vec<f64> = layout
        .coordinates
        .iter()
        .map(|_| random.uniform(-1.0, 1.0))
        .collect();
    for (s, system) in model.systems.iter().enumerate() {
        for element in 0..system.elements.len() {
            let range = layout.element_coordinates(ElementId { system: s, element });
            if system.elements[element].joint != Joint::Ball {
                continue;
            }
            match layout.orientation {
                Orientation::Angle => q[range.start] = random.uniform(-3.0, 3.0),
                Orientation::Bryant => {
                    q[range.start] = random.uniform(-3.0, 3.0);
                    q[range.start + 1] = random.uniform(-1.2, 1.2);
                    q[range.start + 2] = random.uniform(-3.0, 3.0);
                }
                Orientation::Quaternion => {
                    let norm = q[range.clone()].iter().map(|a| a * a).sum::<f64>().sqrt();
                    q[range].iter_mut().for_each(|a| *a /= norm);
                }
            }
        }
    }
    let v = layout
        .velocities
        .iter()
        .map(|_| random.uniform(-4.0, 4.0))
        .collect();
    (q, v)
}
