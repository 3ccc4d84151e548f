//! The laws do not depend on the place of the scene: every planar model, rotated by a right angle about y and moved,
//! has the same accelerations, rotated, and every effect has the same power.
//!
//! A right angle maps (x, z) to (z, −x) exactly, so that curves of components are exchanged and the rotation rounds
//! nothing. Only positions further from the origin are rounded, and this is measured as the scatter of both
//! evaluations.

use bryant::evaluation::functions;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::law::types::{
    Against, Belt, Bushing, Contact, Field, Freedom, Joint, Load, Spring,
};
use bryant_generator::method::Method;
use bryant_generator::model::{
    Attachment, Body, Dimension, FieldComponent, Model, Number, Reference, ScaledCurve,
};
use bryant_tests::models::MODELS;
use bryant_tests::rounding::Rounded;
use bryant_tests::trees::Random;
use std::f64::consts::FRAC_PI_2;

use bryant_generator::expression::NodeId;
use bryant_generator::expression::evaluate::Inputs;

const STATES: usize = 10;
/// As in `compiled`: the factor from the scatter of eight samples to the largest difference.
const C: f64 = 20.0;
/// Where the origin goes \[m\].
const MOVE: [f64; 2] = [0.7, -0.4];

fn turn(v: &mut [Number; 3]) {
    v.swap(0, 2);
    v[2] = Number::negative(v[2].clone());
}

fn shift(v: &mut [Number; 3]) {
    turn(v);
    v[0] = Number::sum(v[0].clone(), Number::Constant(MOVE[0]));
    v[2] = Number::sum(v[2].clone(), Number::Constant(MOVE[1]));
}

fn quarter(angle: &mut Number) {
    *angle = Number::sum(angle.clone(), Number::Constant(FRAC_PI_2));
}

fn turn_components(components: &mut [FieldComponent; 3]) {
    components.swap(0, 2);
    match &mut components[2] {
        FieldComponent::Constant(value) => *value = Number::negative(value.clone()),
        FieldComponent::Curve(curve) => curve.times = Number::negative(curve.times.clone()),
    }
}

fn turn_curves(curves: &mut [Option<ScaledCurve>; 3]) {
    curves.swap(0, 2);
    if let Some(curve) = &mut curves[2] {
        curve.times = Number::negative(curve.times.clone());
    }
}

fn move_attachment(attachment: &mut Attachment) {
    if attachment.on == Body::Frame {
        shift(&mut attachment.at);
    }
}

/// The scene elsewhere; `None` if a law depends on absolute angles, or is a user function that cannot be evaluated
/// here.
fn elsewhere(model: &Model) -> Option<Model> {
    let mut model = model.clone();
    if model.dimension != Dimension::Plane || !model.vehicles.is_empty() {
        return None;
    }
    for system in &mut model.systems {
        shift(&mut system.position);
        turn(&mut system.velocity);
        if let Reference::Prescribed(translation) = &mut system.reference {
            turn_curves(&mut translation.curves);
        }
        for element in &mut system.elements {
            quarter(&mut element.angles[1]);
        }
    }
    for force in &mut model.forces {
        let law = &mut force.law;
        if let Some(joint) = law.get::<Joint>() {
            let law = &joint.about[1];
            if joint.child.element == 0 && (law.elastic.is_some() || law.stop.is_some()) {
                return None;
            }
        } else if let Some(field) = law.get_mut::<Field>() {
            turn_components(&mut field.acceleration);
        } else if let Some(load) = law.get_mut::<Load>() {
            turn_components(&mut load.force);
        } else if let Some(contact) = law.get_mut::<Contact>() {
            move_attachment(&mut contact.ellipsoid.center);
            if contact.ellipsoid.center.on == Body::Frame {
                quarter(&mut contact.ellipsoid.axes[1]);
            }
            match &mut contact.against {
                Against::Plane(plane) if plane.at.on == Body::Frame => {
                    shift(&mut plane.at.at);
                    turn(&mut plane.normal);
                    turn(&mut plane.tangent);
                }
                Against::Ellipsoid(other) if other.center.on == Body::Frame => {
                    shift(&mut other.center.at);
                    quarter(&mut other.axes[1]);
                }
                Against::Plane(_) | Against::Ellipsoid(_) => {}
            }
        } else if let Some(belt) = law.get_mut::<Belt>() {
            belt.points_mut().for_each(move_attachment);
        } else if let Some(spring) = law.get_mut::<Spring>() {
            move_attachment(&mut spring.from);
            move_attachment(&mut spring.to);
        } else if let Some(bushing) = law.get_mut::<Bushing>() {
            for mount in [&mut bushing.from, &mut bushing.to] {
                move_attachment(&mut mount.on);
                if mount.on.on == Body::Frame {
                    quarter(&mut mount.axes[1]);
                }
            }
        } else if law.get::<Freedom>().is_none() {
            // a freedom is relative to what carries it, which turns too; of the others it is not known
            return None;
        }
    }
    // the quantity of a switch may be a component
    model.switches.is_empty().then_some(model)
}

#[test]
fn a_turned_and_moved_scene_has_equal_accelerations_and_powers() {
    let mut compared = 0;
    for compiled in MODELS {
        let model = compiled.model();
        let Some(moved) = elsewhere(&model) else {
            continue;
        };
        compared += 1;
        let name = &model.name;
        let options = Options {
            matrices: false,
            route: None,
        };
        let [here, there] = [&model, &moved].map(|model| derive_with(model, options));
        let roots = |equations: &bryant_generator::equations::Equations| -> Vec<NodeId> {
            let powers = equations.section(Method::Powers).iter().map(|p| p.value);
            equations
                .accelerations
                .iter()
                .copied()
                .chain(powers)
                .collect()
        };
        let mut first = Rounded::new(&here.graph, &roots(&here));
        let mut second = Rounded::new(&there.graph, &roots(&there));
        let functions = functions(&model);
        let functions_there = self::functions(&moved);
        let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
        let mut random = Random::new(name.bytes().map(u64::from).sum());
        let start = compiled
            .entry
            .initial_state(&[])
            .expect("the defaults are allowed");
        for k in 0..STATES {
            let (near, fast) = if k % 2 == 0 { (0.03, 0.5) } else { (0.3, 5.0) };
            let (q, rest) = start.split_at(here.coordinates.len());
            let (v, rest) = rest.split_at(here.velocities.len());
            let (z, m) = rest.split_at(here.auxiliaries.len());
            let q: Vec<f64> = q.iter().map(|x| x + random.uniform(-near, near)).collect();
            let v: Vec<f64> = v.iter().map(|x| x + random.uniform(-fast, fast)).collect();
            let time = random.uniform(0.0, model.run.duration);
            let inputs = Inputs {
                time,
                coordinates: &q,
                velocities: &v,
                parameters: &parameters,
                auxiliaries: z,
                accelerations: &[],
                memory: m,
            };
            // a free reference joint has two successive coordinates named x and z
            let elsewhere =
                |values: &[f64], names: &[bryant_generator::equations::Variable], place: bool| {
                    let mut turned = values.to_vec();
                    for (i, variable) in names.iter().enumerate() {
                        match (variable.element, place) {
                            (None, _)
                                if i + 1 < names.len()
                                    && names[i + 1].element.is_none()
                                    && variable.name.ends_with('x') =>
                            {
                                let by = if place { MOVE } else { [0.0; 2] };
                                turned[i] = values[i + 1] + by[0];
                                turned[i + 1] = -values[i] + by[1];
                            }
                            (Some(_), true) => turned[i] += FRAC_PI_2,
                            _ => {}
                        }
                    }
                    turned
                };
            let (q_there, v_there) = (
                elsewhere(&q, &here.coordinates, true),
                elsewhere(&v, &here.velocities, false),
            );
            let inputs_there = Inputs {
                coordinates: &q_there,
                velocities: &v_there,
                ..inputs
            };
            let (values, scatter) = first.evaluate(&inputs, &functions, f64::EPSILON);
            let (values_there, scatter_there) =
                second.evaluate(&inputs_there, &functions_there, f64::EPSILON);
            let count = here.velocities.len();
            let mut expected = elsewhere(&values[..count], &here.velocities, false);
            expected.extend(&values[count..]);
            // entries are sums of parts of others: the largest scatter is that of all accelerations, and of all powers
            let largest = |range: std::ops::Range<usize>| {
                let both = scatter[range.clone()].iter().chain(&scatter_there[range]);
                both.fold(0.0f64, |m, x| m.max(*x))
            };
            let bounds = [largest(0..count), largest(count..values.len())];
            for (i, (ours, expected)) in values_there.iter().zip(&expected).enumerate() {
                let bound = C * bounds[usize::from(i >= count)];
                assert!(
                    (ours - expected).abs() <= bound,
                    "{name} [{i}]: {ours:e} there, {expected:e} here, allowed {bound:e}"
                );
            }
        }
    }
    assert!(compared >= 10, "only {compared} models");
}
