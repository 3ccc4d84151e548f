//! The balance of energy, dT/dt = Σ P, as an identity of the equations at any state of every model.
//!
//! dT/dt = Σ ∂T/∂q q̇ + Σ ∂T/∂v v̇ + ∂T/∂t is derived from the kinetic energy alone, the powers from the forces: a force that
//! does other work than its power says, acts at another point, or has no reaction, shows. Both are sums of the same size, so
//! they agree within rounding of their terms: 10 κ ε of the accelerations, which is measured as their scatter.
//!
//! And as the balance of runs: what is missing at the end is what the integrator lost, at most its tolerance in each step.

use crate::users::functions;
use bryant_generator::expression::differentiate::differentiate_along;
use bryant_generator::expression::evaluate::Inputs;
use bryant_generator::expression::{NodeId, Symbol, sum};
use bryant_generator::formalism::{Options, derive_with};
use bryant_runtime::program::Job;
use bryant_runtime::{Adaptive, Method, Tolerances};
use bryant_tests::models::MODELS;
use bryant_tests::rounding::Rounded;
use bryant_tests::trees::Random;
use std::ops::ControlFlow;

/// The tolerance is relative to coordinates, a spring's energy goes with the square of a difference of them, which in these
/// models comes down to a tenth of their size (the ball of `bounce`, 0.1 m above the origin, sinks in by 1 cm).
const AMPLIFICATION: f64 = 2.0 * 10.0;

const STATES: usize = 20;
/// As in `compiled`: what eight samples of the scatter say of a largest difference.
const C: f64 = 20.0;

#[test]
fn the_powers_are_the_rate_of_the_kinetic_energy() {
    for compiled in MODELS {
        let model = compiled.model();
        let name = &model.name;
        let equations = derive_with(
            &model,
            Options {
                matrices: false,
                route: None,
            },
        );
        let graph = &equations.graph;
        let rate = differentiate_along(graph, &[equations.kinetic_energy], |symbol| {
            graph.expr(match symbol {
                Symbol::Time => graph.constant(1.0).id(),
                Symbol::Coordinate(i) => equations.coordinate_rates[i as usize],
                Symbol::Velocity(i) => equations.accelerations[i as usize],
                _ => graph.constant(0.0).id(),
            })
        });
        let rate = graph.expr(rate.expect("kinetic energy is differentiable")[0]);
        let powers = equations.powers.iter().map(|p| graph.expr(p.value));
        let difference = (rate - sum(graph, powers)).id();
        let mut roots: Vec<NodeId> = vec![difference, rate.id()];
        roots.extend(&equations.initial_coordinates);
        roots.extend(&equations.initial_velocities);
        roots.extend(equations.auxiliaries.iter().map(|s| s.initial));
        roots.extend(equations.memory.iter().map(|s| s.initial));

        let functions = functions(&model);
        let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
        let (coordinates, velocities) = (equations.coordinates.len(), equations.velocities.len());
        let (z, m) = (equations.auxiliaries.len(), equations.memory.len());
        let mut balance = Rounded::new(graph, &roots);
        let start = {
            let zeros = |n: usize| vec![1.0; n];
            let inputs = Inputs {
                time: 0.0,
                coordinates: &zeros(coordinates),
                velocities: &zeros(velocities),
                parameters: &parameters,
                auxiliaries: &zeros(z),
                memory: &zeros(m),
            };
            let (values, _) = balance.evaluate(&inputs, &functions, f64::EPSILON);
            values[2..].to_vec()
        };
        let mut random = Random::new(name.bytes().map(u64::from).sum());
        for k in 0..STATES {
            let (near, fast) = if k % 2 == 0 { (0.03, 0.5) } else { (0.5, 5.0) };
            let mut state = start.clone();
            for (i, x) in state.iter_mut().enumerate() {
                let range = match i {
                    i if i < coordinates => near,
                    i if i < coordinates + velocities => fast,
                    // what has not happened yet has happened in a third of the states
                    _ if x.abs() > 1e20 => {
                        *x = if k % 3 == 1 { 0.0 } else { *x };
                        0.0
                    }
                    _ => 0.1 * near,
                };
                *x += random.uniform(-range, range);
            }
            for range in &equations.quaternions {
                let quaternion = &mut state[range.clone()];
                let norm = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
                quaternion.iter_mut().for_each(|x| *x /= norm);
            }
            let (q, rest) = state.split_at(coordinates);
            let (v, rest) = rest.split_at(velocities);
            let (z, m) = rest.split_at(z);
            let inputs = Inputs {
                time: random.uniform(0.0, model.run.duration),
                coordinates: q,
                velocities: v,
                parameters: &parameters,
                auxiliaries: z,
                memory: m,
            };
            let (values, scatter) = balance.evaluate(&inputs, &functions, f64::EPSILON);
            let bound = C * (scatter[0] + scatter[1]);
            assert!(
                values[0].abs() <= bound,
                "{name}: dT/dt = {:e} W, but the powers miss it by {:e} W, allowed {bound:e}",
                values[1],
                values[0]
            );
        }
    }
}

#[test]
fn the_balance_of_every_run_closes_to_the_tolerance_of_the_integrator() {
    let bundled = bryant_generated::MODELS.iter().map(|m| m.entry);
    for entry in bundled.chain(MODELS.iter().map(|m| m.entry)) {
        let name = entry.info.name;
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let tolerances = Tolerances {
                relative: tolerance,
                coordinates: 1e-2 * tolerance,
                velocities: tolerance,
            };
            let job = Job {
                method: Some(Method::Dopri5(Adaptive {
                    tolerances,
                    ..Adaptive::default()
                })),
                ..Job::default()
            };
            let outcome = (entry.run_balanced)(&job, &mut |_, _, _| ControlFlow::Continue(()));
            let report = outcome
                .result
                .unwrap_or_else(|e| panic!("{name}: {}", e.message));
            let energy = outcome.energy.expect("a balance");
            let bound = AMPLIFICATION * report.steps as f64 * tolerance;
            println!(
                "{name:20} {tolerance:e} {:10.2e} of {bound:8.1e}",
                energy.relative_gap()
            );
            assert!(
                energy.relative_gap() <= bound,
                "{name}: {energy:?} misses {:e} of what was exchanged, allowed {bound:e}",
                energy.relative_gap()
            );
        }
    }
}
