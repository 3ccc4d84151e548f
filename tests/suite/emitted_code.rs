//! Compiled equations against the interpreted graph: only this test finds errors that are only in the emitted code.
//!
//! Both compute the same expressions in different arrangements, so they differ by rounding, by c·κ·ε. κ·ε is measured
//! at every state as the scatter of the interpreted values when every operation, input and constant errs randomly by up
//! to ε (`bryant_tests::rounding`). c is the factor from eight samples to a largest error. For a normal distribution
//! with deviation σ, the difference of two evaluations exceeds 6.5 σ once in 10⁵, and the largest of eight samples is
//! below 0.3 σ equally rarely, hence c = 20. A rounding error is at most ε/2, which leaves a factor of two for longer
//! chains of operations.

use crate::users::functions;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::{Equations, Route};
use bryant_generator::expression::evaluate::Inputs;
use bryant_generator::method::Method;
use bryant_generator::model::Model;
use bryant_runtime::program::Entry;
use bryant_runtime::{Model as _, ParameterSet, Section};
use bryant_tests::compiled_equations::Compiled;
use bryant_tests::models::MODELS;
use bryant_tests::rounding::Rounded;
use bryant_tests::trees::Random;
use nalgebra::DMatrix;
use std::path::Path;

const C: f64 = 20.0;
const STATES: usize = 20;

/// S is assembled for models with at most this many freedoms: S of a chain of 100 takes ten million operations.
const LARGEST_MATRIX: usize = 60;

/// A state and parameters at which a model is evaluated.
struct Point {
    parameters: Vec<f64>,
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    z: Vec<f64>,
    m: Vec<f64>,
}

impl Point {
    fn inputs(&self) -> Inputs<'_, f64> {
        Inputs {
            time: self.t,
            coordinates: &self.q,
            velocities: &self.v,
            parameters: &self.parameters,
            auxiliaries: &self.z,
            memory: &self.m,
            accelerations: &[],
        }
    }

    fn state(&self) -> Vec<f64> {
        [&self.q[..], &self.v, &self.z, &self.m].concat()
    }

    fn named(&self, model: &Model) -> Vec<(String, f64)> {
        let names = model.parameters.iter().map(|p| p.name.clone());
        names.zip(self.parameters.iter().copied()).collect()
    }
}

/// States around the start of a run: near it, where contacts touch and belts tighten, and far from it. Parameters have
/// their defaults, or random values within their bounds, or within a factor of a half if they have no bounds.
fn points(model: &Model, equations: &Equations, entry: &Entry) -> Vec<Point> {
    let mut random = Random::new(entry.info.name.bytes().map(u64::from).sum());
    let mut points = Vec::new();
    for k in 0..2 * STATES {
        let mut point = Point {
            parameters: model.parameters.iter().map(|p| p.default).collect(),
            t: random.uniform(0.0, model.run.duration),
            q: vec![],
            v: vec![],
            z: vec![],
            m: vec![],
        };
        // parameters that the model refuses together are drawn again
        let start = (0..100).find_map(|_| {
            if k >= STATES {
                let drawn = model.parameters.iter().map(|p| {
                    let about = 0.5 * p.default.abs();
                    let from = p.min.unwrap_or(p.default - about);
                    let to = p.max.unwrap_or(p.default + about);
                    random.uniform(from, to)
                });
                point.parameters = drawn.collect();
            }
            entry.initial_state(&point.named(model)).ok()
        });
        let start = start.expect("parameters that are allowed");
        let (near, fast) = if k % 2 == 0 { (0.03, 0.5) } else { (0.5, 5.0) };
        let (q, rest) = start.split_at(equations.coordinates.len());
        let (v, rest) = rest.split_at(equations.velocities.len());
        let (z, m) = rest.split_at(equations.auxiliaries.len());
        point.q = q.iter().map(|x| x + random.uniform(-near, near)).collect();
        point.v = v.iter().map(|x| x + random.uniform(-fast, fast)).collect();
        // states of laws are lengths, angles and fractions; times that are never reached stay
        let mut law = |x: &f64| match x.abs() < 1e20 {
            true => x + random.uniform(-0.1 * near, 0.1 * near),
            false => *x,
        };
        point.z = z.iter().map(&mut law).collect();
        point.m = m.iter().map(&mut law).collect();
        // charts are 0 or 1
        for chart in &mut point.m[..equations.charts] {
            *chart = f64::from(u8::from(random.uniform(0.0, 1.0) > 0.5));
        }
        for range in &equations.quaternions {
            let quaternion = &mut point.q[range.clone()];
            let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
            quaternion.iter_mut().for_each(|x| *x /= norm);
        }
        points.push(point);
    }
    points
}

/// Checks that every difference is at most C times its scatter; returns the largest share of that.
fn compare(what: &str, names: &[&str], ours: &[f64], expected: &[f64], scatter: &[f64]) -> f64 {
    assert_eq!(ours.len(), expected.len(), "{what}");
    let mut largest = 0.0f64;
    for (i, (ours, expected)) in ours.iter().zip(expected).enumerate() {
        let name = names.get(i).unwrap_or(&"");
        let (error, bound) = ((ours - expected).abs(), C * scatter[i]);
        assert!(
            error <= bound,
            "{what} {name} [{i}]: {ours:e} compiled, {expected:e} interpreted; off by {error:e}, allowed {bound:e}"
        );
        if bound > 0.0 {
            largest = largest.max(error / bound);
        }
    }
    largest
}

/// Entries of a vector or a matrix are sums of parts of others: all get the largest scatter.
fn together(scatter: &[f64]) -> Vec<f64> {
    vec![scatter.iter().fold(0.0f64, |m, x| m.max(*x)); scatter.len()]
}

fn check(compiled: &Compiled) {
    let (model, entry) = (compiled.model(), &compiled.entry);
    let name = entry.info.name;
    assert_eq!(model.name, name);
    assert_eq!(
        model.digest, entry.info.digest,
        "{name} was compiled from another text"
    );
    let derive = |route| {
        let matrices = compiled.matrices.is_some();
        derive_with(&model, Options { matrices, route })
    };
    let equations = derive(None);
    let (size, coordinates) = (equations.velocities.len(), equations.coordinates.len());

    let mut roots = equations.coordinate_rates.clone();
    roots.extend(&equations.accelerations);
    roots.extend(equations.auxiliaries.iter().map(|state| state.next));
    let zero = equations.graph.constant(0.0).id();
    roots.extend(equations.memory.iter().map(|_| zero));
    let full = roots.len();
    roots.extend(&equations.outputs);
    roots.push(equations.section(Method::KineticEnergy)[0].value);
    roots.extend(
        equations
            .section(Method::Powers)
            .iter()
            .map(|power| power.value),
    );
    roots.extend(
        equations
            .event_functions
            .iter()
            .map(|event_function| event_function.value),
    );
    if equations.charts > 0 {
        roots.extend(&equations.renewed_coordinates);
        roots.extend(&equations.renewed_velocities);
    }
    roots.extend(equations.memory.iter().map(|state| state.next));
    roots.extend(equations.kinks.iter().map(|kink| kink.value));
    for method in [Method::Momentum, Method::ExternalWrench] {
        roots.extend(equations.section(method).iter().map(|of| of.value));
    }
    let mut motion = Rounded::new(&equations.graph, &roots);
    let matrices: Vec<_> = equations.mass_matrix.concat();
    let roots = [
        &matrices[..],
        &equations.velocity_forces,
        &equations.applied_forces,
    ]
    .concat();
    let mut forces = Rounded::new(&equations.graph, &roots);
    let other = (size <= LARGEST_MATRIX).then(|| {
        let route = match equations.route {
            Route::Elimination => Route::MassMatrix,
            Route::MassMatrix => Route::Elimination,
        };
        derive(Some(route))
    });
    let mut by_other = other
        .as_ref()
        .map(|other| Rounded::new(&other.graph, &other.accelerations));

    let functions = functions(&model);
    let outputs: Vec<&str> = entry.info.outputs.iter().map(|o| o.name).collect();
    let mut share = 0.0f64;
    for point in points(&model, &equations, entry) {
        let (values, scatter) = motion.evaluate(&point.inputs(), &functions, f64::EPSILON);
        assert!(values.iter().all(|x| x.is_finite()), "{name}: {values:?}");
        let (state, named) = (point.state(), point.named(&model));
        let mut rates = vec![f64::NAN; full];
        entry
            .derivative(&named, point.t, &state, &mut rates)
            .expect("a derivative");
        let of = |section: Section| {
            let results = entry.section(section, &named, point.t, &state);
            results.expect("a state of the model")
        };
        let out = of(Section::Outputs);
        let mut others = [of(Section::KineticEnergy), of(Section::Powers)].concat();
        let event_functions = of(Section::EventFunctions);
        let mut renewed = match equations.memory.is_empty() {
            true => state.clone(),
            false => of(Section::Renewed),
        };
        let kinks = of(Section::Kinks);
        let momentum = [of(Section::Momentum), of(Section::ExternalWrench)].concat();
        let memory = renewed.split_off(state.len() - point.m.len());
        let (moving, laws) = renewed.split_at(coordinates + size);
        assert_eq!(laws, point.z, "{name}: what is integrated is not renewed");
        others.extend(event_functions);
        if equations.charts > 0 {
            others.extend(moving);
        } else {
            assert_eq!(
                moving,
                &state[..moving.len()],
                "{name}: only memory is renewed"
            );
        }
        others.extend(memory);
        others.extend(kinks);
        others.extend(momentum);

        let ends = [0, coordinates, coordinates + size, full];
        let (q_dot, rest) = rates.split_at(coordinates);
        let (v_dot, laws) = rest.split_at(size);
        let parts = [q_dot, v_dot, laws];
        for (part, range) in parts.iter().zip(ends.windows(2)) {
            let range = range[0]..range[1];
            let scatter = together(&scatter[range.clone()]);
            let names = match range.start {
                0 => entry.info.coordinates,
                start if start < coordinates + size => entry.info.velocities,
                _ => entry.info.auxiliaries,
            };
            let what = format!("{name}: rate of");
            share = share.max(compare(&what, names, part, &values[range], &scatter));
        }
        let of_outputs = full..full + outputs.len();
        share = share.max(compare(
            &format!("{name}: output"),
            &outputs,
            &out,
            &values[of_outputs.clone()],
            &scatter[of_outputs],
        ));
        let rest = full + outputs.len()..;
        share = share.max(compare(
            &format!("{name}: energy, powers, event_functions, renewed state, kinks, momentum"),
            &[],
            &others,
            &values[rest.clone()],
            &scatter[rest],
        ));

        let Some(matrices) = compiled.matrices else {
            continue;
        };
        let ours = matrices(&point.parameters, point.t, &point.q, &point.v, &point.m);
        let (values, scatter) = forces.evaluate(&point.inputs(), &functions, f64::EPSILON);
        let mut start = 0;
        for (what, length) in [("S", size * size), ("r_s", size), ("r_k", size)] {
            let range = start..start + length;
            let scatter = together(&scatter[range.clone()]);
            let what = format!("{name}: {what}");
            let (ours, values) = (&ours[range.clone()], &values[range.clone()]);
            share = share.max(compare(&what, &[], ours, values, &scatter));
            start = range.end;
        }
        let accelerations = &ours[start..];
        assert_eq!(accelerations, v_dot, "{name}: two ways to the same method");

        // The other route rounds differently, by the condition of S, for the same forces; the rounding of the forces
        // themselves is in the scatter.
        let Some(by_other) = &mut by_other else {
            continue;
        };
        let (expected, scatter) = by_other.evaluate(&point.inputs(), &functions, f64::EPSILON);
        let spectrum =
            DMatrix::from_row_slice(size, size, &values[..size * size]).symmetric_eigenvalues();
        let condition = spectrum.max() / spectrum.min();
        let norm = |x: &[f64]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let difference: Vec<f64> = accelerations
            .iter()
            .zip(&expected)
            .map(|(a, b)| a - b)
            .collect();
        let bound = 10.0 * condition * f64::EPSILON * norm(&expected) + C * norm(&scatter);
        assert!(
            norm(&difference) <= bound,
            "{name}: routes differ by {:e}, allowed {bound:e} (condition {condition:e})",
            norm(&difference)
        );
    }
    println!("{name}: at most {share:.2} of what rounding allows");
}

#[test]
fn bundled_models_compute_what_their_equations_say() {
    use bryant_generated as bundled;
    let with_matrices = [
        bryant_tests::compiled!("../models/child-seat.yaml", bundled::child_seat),
        bryant_tests::compiled!("../models/dummy15.yaml", bundled::dummy15),
        bryant_tests::compiled!("../models/robot-arm.yaml", bundled::robot_arm),
        bryant_tests::compiled!("../models/skydiver.yaml", bundled::skydiver),
        bryant_tests::compiled!("../models/sled-pendulum.yaml", bundled::sled_pendulum),
        // r_k also takes the states of force laws
        Compiled {
            path: "../models/elbow.yaml",
            entry: bundled::find("elbow").expect("it is bundled").entry,
            matrices: None,
        },
    ];
    for model in bundled::MODELS {
        let named = |c: &&Compiled| c.entry.info.name == model.entry.info.name;
        let compiled = with_matrices.iter().find(named);
        check(compiled.unwrap_or_else(|| {
            panic!("{} is to be listed here", model.entry.info.name);
        }));
    }
}

#[test]
fn test_models_compute_what_their_equations_say() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for directory in ["models", "models/large"] {
        for entry in std::fs::read_dir(here.join(directory)).expect("a directory of models") {
            let path = entry.expect("an entry").path();
            let is_model = path.extension().is_some_and(|e| e == "yaml");
            let listed = MODELS.iter().any(|m| here.join(m.path) == path);
            assert!(listed || !is_model, "{} is to be listed", path.display());
        }
    }
    MODELS.iter().for_each(check);
}

#[test]
fn single_precision_computes_the_same_to_its_own_rounding() {
    use bryant_generated::dummy15::Mechanism;
    let entry = bryant_generated::find("dummy15")
        .expect("it is bundled")
        .entry;
    let compiled = bryant_tests::compiled!("../models/dummy15.yaml", bryant_generated::dummy15);
    let model = compiled.model();
    let equations = derive_with(
        &model,
        Options {
            matrices: false,
            route: None,
        },
    );
    let size = equations.velocities.len();
    let mut rounded = Rounded::new(&equations.graph, &equations.accelerations);
    let single = Mechanism::<f32>::new(ParameterSet::<f32>::defaults());
    let double = Mechanism::<f64>::new(ParameterSet::<f64>::defaults());
    for mut point in points(&model, &equations, &entry) {
        // both get the same numbers
        point.t = f64::from(point.t as f32);
        for x in point.q.iter_mut().chain(&mut point.v) {
            *x = f64::from(*x as f32);
        }
        let (_, scatter) =
            rounded.evaluate(&point.inputs(), &functions(&model), f32::EPSILON.into());
        let state: Vec<f32> = point.state().iter().map(|x| *x as f32).collect();
        let ours = single.derivative(
            point.t as f32,
            state[..].try_into().expect("as long as the state"),
        );
        let expected = double.derivative(
            point.t,
            point.state()[..].try_into().expect("as long as the state"),
        );
        let ours: Vec<f64> = ours.iter().map(|x| f64::from(*x)).collect();
        let of_velocities = ours.len() - size..;
        let share = compare(
            "dummy15 in f32: rate of",
            entry.info.velocities,
            &ours[of_velocities.clone()],
            &expected[of_velocities],
            &together(&scatter),
        );
        assert!(share > 1e-6, "f32 was not computed with");
    }
}
