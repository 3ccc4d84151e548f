//! The balance of energy, dT/dt = Σ P, as an identity of the equations at any state of every model.
//!
//! dT/dt = Σ ∂T/∂q q̇ + Σ ∂T/∂v v̇ + ∂T/∂t is derived from the kinetic energy only, and the powers from the forces. So
//! the test finds a force whose work differs from its power, that acts at a wrong point, or that has no reaction. Both
//! sides are sums of the same size, so they agree within the rounding of their terms.
//!
//! And as the balance of runs: the gap at the end is the loss of the integrator, at most its tolerance in each step.

use crate::identity::Balance;
use bryant_generator::expression::sum;
use bryant_generator::method::Method as Of;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};
use bryant_tests::models::MODELS;
use std::ops::ControlFlow;

/// The tolerance is relative to coordinates, and the energy of a spring is quadratic in a difference of coordinates,
/// which in these models is at least a tenth of their size (the ball of `bounce`, 0.1 m above the origin, sinks in by 1
/// cm).
const AMPLIFICATION: f64 = 2.0 * 10.0;

#[test]
fn the_powers_are_the_rate_of_the_kinetic_energy() {
    for compiled in MODELS {
        let model = compiled.model();
        let balance = Balance::of(&model);
        let graph = &balance.equations.graph;
        let powers = balance.equations.section(Of::Powers).iter();
        let powers = sum(graph, powers.map(|p| graph.expr(p.value))).id();
        balance.holds(
            &["T"],
            &[balance.equations.section(Of::KineticEnergy)[0].value],
            &[powers],
        );
    }
}

#[test]
fn the_energy_balance_of_every_run_closes_to_the_tolerance() {
    let bundled = bryant_generated::MODELS.iter().map(|m| m.entry);
    for entry in bundled.chain(MODELS.iter().map(|m| m.entry)) {
        let name = entry.info.name;
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let tolerances = Tolerances::of(tolerance);
            let job = Job {
                method: Some(Integrator::adaptive(Formula::Dopri5, tolerances)),
                ..Job::default()
            };
            let outcome = entry.run_balanced(&job, &mut |_, _, _| ControlFlow::Continue(()));
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
