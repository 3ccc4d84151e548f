//! Many states at once: the bits of a row do not depend on its neighbours, and rollouts follow closed forms.

use crate::bits::common::Random;
use bryant_engine::batch::{Batch, Hold, Misfit, Rollout, Rows, Wanted};
use bryant_engine::{Engine, Evaluated};
use bryant_runtime::{Dynamics, Real, Refusal, Section};

/// A cart on a rail along x, whose mass is a parameter, and which an input pushes.
const CART: &str = "\
model: cart
dimension: 2
parameters: { mass: 2 kg }
inputs: { push: { value: 1 N, min: -100 N, max: 100 N } }
systems:
  - name: cart
    reference: fixed
    elements: [{ name: body, joint: { slider: x }, mass: mass, cg: [0, 0], inertia: 1 }]
forces: [{ joint: cart/body, motor: push }]
outputs:
  - { name: x, of: cart/body, what: position, component: x }
  - { name: a, of: cart/body, what: acceleration, component: x }
run: { duration: 1 s, every: 0.1 s }
";

fn engine(text: &str) -> Engine {
    Engine::of_text("model.yaml", text).unwrap_or_else(|problems| panic!("{problems}"))
}

fn dummy() -> Engine {
    engine(include_str!("../../../models/dummy15.yaml"))
}

/// States near that of the start, by rows.
struct States {
    q: Vec<f64>,
    v: Vec<f64>,
}

impl States {
    fn near_the_start(engine: &Engine, count: usize, random: &mut Random) -> Self {
        let model = engine.over::<f64>();
        let info = model.info();
        let mut y = vec![0.0; info.state_length()];
        model.initial_state(&mut y);
        let (mut q, mut v) = (vec![], vec![]);
        for _ in 0..count {
            let mut state = y.clone();
            for entry in &mut state {
                *entry += 0.3 * (random.next());
            }
            model.normalize(&mut state);
            let (coordinates, rest) = state.split_at(info.coordinates.len());
            q.extend_from_slice(coordinates);
            v.extend_from_slice(&rest[..info.velocities.len()]);
        }
        States { q, v }
    }

    fn rows(&self) -> Rows<'_> {
        Rows {
            coordinates: &self.q,
            velocities: &self.v,
            ..Rows::default()
        }
    }
}

fn evaluated(batch: &mut Batch, wanted: Wanted, rows: &Rows<'_>) -> Vec<f64> {
    let count = rows.velocities.len() / batch.info().velocities.len();
    let mut results = vec![f64::NAN; count * batch.length(wanted)];
    batch.evaluate(wanted, rows, &mut results).unwrap();
    results
}

const ALL: [Wanted; 7] = [
    Wanted::Rates,
    Wanted::Accelerations,
    Wanted::Section(Section::Outputs),
    Wanted::Section(Section::KineticEnergy),
    Wanted::MassMatrix,
    Wanted::VelocityForces,
    Wanted::AppliedForces,
];

#[test]
fn engines_are_shared_among_threads_and_models_are_sent() {
    fn shared<T: Send + Sync>() {}
    fn sent<T: Send>() {}
    fn of_any_scalar<T: Real>() {
        sent::<Evaluated<T>>();
    }
    shared::<Engine>();
    sent::<Batch>();
    of_any_scalar::<f64>();
}

#[test]
fn a_row_has_the_same_bits_alone_beside_others_and_on_threads() {
    let engine = dummy();
    let random = &mut Random::new(1);
    let states = States::near_the_start(&engine, 37, random);
    let info = engine.info();
    let (nq, nv) = (info.coordinates.len(), info.velocities.len());
    for wanted in ALL {
        let together = evaluated(&mut engine.batch(1), wanted, &states.rows());
        for threads in [2, 3, 8] {
            let found = evaluated(&mut engine.batch(threads), wanted, &states.rows());
            assert_eq!(found, together, "{wanted:?} on {threads} threads");
        }
        let mut batch = engine.batch(1);
        let length = batch.length(wanted);
        for row in [0, 7, 36] {
            let alone = Rows {
                coordinates: &states.q[row * nq..][..nq],
                velocities: &states.v[row * nv..][..nv],
                ..Rows::default()
            };
            let alone = evaluated(&mut batch, wanted, &alone);
            assert_eq!(alone, together[row * length..][..length], "{wanted:?}");
        }
    }
}

#[test]
fn rows_have_the_values_of_the_model_over_one_number() {
    let engine = dummy();
    let model = engine.over::<f64>();
    let info = engine.info();
    let (nq, nv) = (info.coordinates.len(), info.velocities.len());
    let states = States::near_the_start(&engine, 9, &mut Random::new(2));
    let mut batch = engine.batch(1);
    let [rates, accelerations, outputs] =
        [ALL[0], ALL[1], ALL[2]].map(|wanted| evaluated(&mut batch, wanted, &states.rows()));
    // both round a few thousand operations; the matrices are well conditioned
    let near = |found: f64, expected: f64, size: f64| {
        assert!(
            (found - expected).abs() <= 1e-9 * size,
            "{found} for {expected}"
        );
    };
    let size = |of: &[f64]| {
        of.iter()
            .fold(1.0, |most: f64, value| most.max(value.abs()))
    };
    for row in 0..9 {
        let mut y = states.q[row * nq..][..nq].to_vec();
        y.extend_from_slice(&states.v[row * nv..][..nv]);
        y.resize(info.state_length(), 0.0);
        let mut rate = vec![0.0; y.len()];
        model.derivative(0.0, &y, &mut rate);
        for i in 0..rate.len() {
            near(rates[row * rate.len() + i], rate[i], size(&rate));
        }
        for i in 0..nv {
            near(accelerations[row * nv + i], rate[nq + i], size(&rate));
        }
        let mut expected = vec![0.0; info.outputs.len()];
        model.outputs(0.0, &y, &mut expected);
        for (i, expected) in expected.iter().enumerate() {
            near(
                outputs[row * info.outputs.len() + i],
                *expected,
                size(&rate),
            );
        }
    }
}

#[test]
fn the_matrices_obey_the_equations_of_motion() {
    let engine = dummy();
    let nv = engine.info().velocities.len();
    let states = States::near_the_start(&engine, 5, &mut Random::new(3));
    let mut batch = engine.batch(2);
    let mut of = |wanted| evaluated(&mut batch, wanted, &states.rows());
    let (s, a) = (of(Wanted::MassMatrix), of(Wanted::Accelerations));
    let (r_s, r_k) = (of(Wanted::VelocityForces), of(Wanted::AppliedForces));
    for row in 0..5 {
        let s = &s[row * nv * nv..][..nv * nv];
        for i in 0..nv {
            let terms = (0..nv).map(|j| s[i * nv + j] * a[row * nv + j]);
            let (force, size) = terms.fold((0.0, 1.0), |(sum, size): (f64, f64), term| {
                assert!((0..nv).all(|j| s[i * nv + j] == s[j * nv + i]));
                (sum + term, size + term.abs())
            });
            let expected = r_s[row * nv + i] + r_k[row * nv + i];
            assert!((force - expected).abs() < 1e-9 * size, "{force} {expected}");
        }
    }
}

#[test]
fn parameters_vary_from_row_to_row_and_are_forgotten_afterwards() {
    let engine = engine(CART);
    let mut batch = engine.batch(1);
    let (q, v) = ([0.0; 3], [0.0; 3]);
    let rows = |inputs| Rows {
        coordinates: &q,
        velocities: &v,
        inputs,
        ..Rows::default()
    };
    let accelerations =
        |batch: &mut Batch, inputs| evaluated(batch, Wanted::Accelerations, &rows(inputs));
    // the input alone
    assert_eq!(
        accelerations(&mut batch, &[4.0, -6.0, 0.0]),
        [2.0, -3.0, 0.0]
    );
    assert_eq!(accelerations(&mut batch, &[]), [0.5; 3]);
    // mass and input: what depends on the mass is computed for each row
    batch.vary(&[0, 1]);
    assert_eq!(
        accelerations(&mut batch, &[4.0, 4.0, 2.0, 4.0, 1.0, 3.0]),
        [1.0, 2.0, 3.0]
    );
    assert_eq!(accelerations(&mut batch, &[]), [0.5; 3]);
    batch.set_parameters(&[4.0, 8.0]).unwrap();
    assert_eq!(accelerations(&mut batch, &[]), [2.0; 3]);
}

#[test]
fn what_does_not_fit_or_is_not_allowed_is_refused_and_changes_nothing() {
    let engine = engine(CART);
    let mut batch = engine.batch(1);
    let (q, v) = ([0.0; 2], [0.0; 2]);
    let rows = |inputs| Rows {
        coordinates: &q,
        velocities: &v,
        inputs,
        ..Rows::default()
    };
    let mut results = [7.0; 2];
    let mut refused = |batch: &mut Batch, inputs| {
        let found = batch.evaluate(Wanted::Accelerations, &rows(inputs), &mut results);
        assert_eq!(results, [7.0; 2]);
        found.unwrap_err()
    };
    let of_row = |row, refusal: Refusal| {
        let mut message = String::new();
        refusal.write(engine.info(), &mut message).unwrap();
        Misfit::Refused {
            row,
            refusal,
            message,
        }
    };
    assert_eq!(
        refused(&mut batch, &[1.0, 101.0]),
        of_row(1, Refusal::OutOfLimits(1, 101.0))
    );
    let found = refused(&mut batch, &[f64::NAN, 1.0]);
    assert!(matches!(
        found,
        Misfit::Refused {
            row: 0,
            refusal: Refusal::NotFinite(1, _),
            ..
        }
    ));
    assert!(matches!(
        refused(&mut batch, &[1.0]),
        Misfit::Length {
            what: "inputs",
            found: 1,
            needed: 2
        }
    ));
    // a mass must be positive
    batch.vary(&[0]);
    assert_eq!(
        refused(&mut batch, &[1.0, -1.0]),
        of_row(1, Refusal::Condition(0))
    );
    assert_eq!(
        refused(&mut batch, &[f64::INFINITY, 1.0]),
        of_row(0, Refusal::NotFinite(0, f64::INFINITY))
    );
    assert!(batch.set_parameters(&[-1.0, 0.0]).is_err());
    batch
        .evaluate(Wanted::Accelerations, &rows(&[]), &mut results)
        .unwrap();
    assert_eq!(results, [0.5; 2]);
}

/// A curve that an input stretches, so that a condition restricts mass and input.
#[test]
fn a_row_that_was_refused_does_not_refuse_others() {
    let stretched = CART.replace(
        "motor: push",
        "motor: { curve: { points: [[0, 0], [1, 10]] }, stretch: push / 1 N + 1 }",
    );
    let engine = engine(&stretched);
    let mut batch = engine.batch(1);
    let rows = |inputs| Rows {
        time: 0.5,
        coordinates: &[0.0],
        velocities: &[0.0],
        inputs,
        ..Rows::default()
    };
    let mut results = [0.0];
    batch.vary(&[0]);
    let refused = batch.evaluate(Wanted::Accelerations, &rows(&[-1.0]), &mut results);
    assert!(refused.is_err());
    // now the input varies, and the mass is that of the batch again: 10 · 0.5/2 N on 2 kg
    batch.vary(&[1]);
    batch
        .evaluate(Wanted::Accelerations, &rows(&[1.0]), &mut results)
        .unwrap();
    assert_eq!(results, [1.25]);
    assert!(
        batch
            .evaluate(Wanted::Accelerations, &rows(&[-2.0]), &mut results)
            .is_err()
    );
    batch
        .evaluate(Wanted::Accelerations, &rows(&[1.0]), &mut results)
        .unwrap();
    assert_eq!(results, [1.25]);
}

/// With held inputs the motion is a parabola in each step, with linear ones a cubic: the method follows both to
/// rounding.
#[test]
fn rollouts_follow_closed_forms() {
    let engine = engine(CART);
    let (rows, steps, parts, h) = (13, 50, 3, 0.02);
    let random = &mut Random::new(4);
    let mut number = || 10.0 * (random.next());
    let q: Vec<f64> = (0..rows).map(|_| number()).collect();
    let v: Vec<f64> = (0..rows).map(|_| number()).collect();
    for (hold, ticks) in [(Hold::Constant, steps), (Hold::Linear, steps + 1)] {
        let push: Vec<f64> = (0..rows * ticks).map(|_| number()).collect();
        let rollout = Rollout {
            step: h,
            steps,
            parts,
            hold,
        };
        let from = Rows {
            coordinates: &q,
            velocities: &v,
            inputs: &push,
            ..Rows::default()
        };
        let mut states = vec![f64::NAN; rows * steps * 2];
        let mut outputs = vec![f64::NAN; rows * steps * 2];
        engine
            .batch(2)
            .rollout(&rollout, &from, &mut states, &mut outputs)
            .unwrap();
        for row in 0..rows {
            let (mut x, mut u) = (q[row], v[row]);
            for k in 0..steps {
                let begin = push[row * ticks + k] / 2.0;
                let end = match hold {
                    Hold::Constant => begin,
                    Hold::Linear => push[row * ticks + k + 1] / 2.0,
                };
                // a = begin + (end − begin) t/h
                x += h * u + h * h * (begin / 2.0 + (end - begin) / 6.0);
                u += h * (begin + end) / 2.0;
                let at = 2 * (row * steps + k);
                for (found, expected) in [(states[at], x), (states[at + 1], u), (outputs[at], x)] {
                    assert!(
                        (found - expected).abs() < 1e-12,
                        "{hold:?} {row} {k}: {found} {expected}"
                    );
                }
                assert!((outputs[at + 1] - end).abs() < 1e-12);
            }
        }
        // one step after the other gives the same bits
        let mut batch = engine.batch(1);
        let mut state = [q[5], v[5]];
        for k in 0..steps {
            let inputs = &push[5 * ticks + k..][..1 + ticks - steps];
            let before = state;
            let from = Rows {
                time: 0.0,
                coordinates: &before[..1],
                velocities: &before[1..],
                inputs,
                ..Rows::default()
            };
            batch
                .rollout(
                    &Rollout {
                        steps: 1,
                        ..rollout
                    },
                    &from,
                    &mut state,
                    &mut [],
                )
                .unwrap();
            assert_eq!(state, states[2 * (5 * steps + k)..][..2]);
        }
    }
}
