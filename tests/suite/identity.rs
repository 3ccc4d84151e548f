//! Balances as identities of the equations: the rate of a quantity, differentiated along the motion, has the required
//! value.
//!
//! Both are sums of the same size, so they agree within the rounding of their terms: 10 κ ε of the accelerations,
//! measured as their scatter.

use crate::users::functions;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Equations;
use bryant_generator::expression::differentiate::differentiate_along;
use bryant_generator::expression::evaluate::Inputs;
use bryant_generator::expression::{NodeId, Symbol};
use bryant_generator::model::Model;
use bryant_tests::rounding::Rounded;
use bryant_tests::trees::Random;

const STATES: usize = 20;
/// As in `compiled`: the factor from the scatter of eight samples to the largest difference.
const C: f64 = 20.0;

/// A model with its equations, for the check of balances.
pub struct Balance<'a> {
    model: &'a Model,
    /// Its equations.
    pub equations: Equations,
}

impl<'a> Balance<'a> {
    /// The balance of a model.
    pub fn of(model: &'a Model) -> Self {
        let options = Options {
            matrices: false,
            route: None,
        };
        let equations = derive_with(model, options);
        Balance { model, equations }
    }

    /// Checks at random states near the start that the quantities of these names have these rates.
    ///
    /// # Panics
    /// If one of them has another rate.
    pub fn holds(&self, names: &[&str], quantities: &[NodeId], rates: &[NodeId]) {
        let (model, equations) = (self.model, &self.equations);
        let graph = &equations.graph;
        let derived = differentiate_along(graph, quantities, |symbol| {
            graph.expr(match symbol {
                Symbol::Time => graph.constant(1.0).id(),
                Symbol::Coordinate(i) => equations.coordinate_rates[i as usize],
                Symbol::Velocity(i) => equations.accelerations[i as usize],
                _ => graph.constant(0.0).id(),
            })
        });
        let derived = derived.expect("the quantity is differentiable");
        let count = derived.len();
        let mut roots = derived.clone();
        let pairs = derived.iter().zip(rates);
        roots.extend(pairs.map(|(a, b)| (graph.expr(*a) - graph.expr(*b)).id()));
        roots.extend(&equations.initial_coordinates);
        roots.extend(&equations.initial_velocities);
        roots.extend(equations.auxiliaries.iter().map(|s| s.initial));
        roots.extend(equations.memory.iter().map(|s| s.initial));

        let functions = functions(model);
        let parameters: Vec<f64> = model.parameters.iter().map(|p| p.default).collect();
        let (coordinates, velocities) = (equations.coordinates.len(), equations.velocities.len());
        let (z, m) = (equations.auxiliaries.len(), equations.memory.len());
        let mut balance = Rounded::new(graph, &roots);
        let start = {
            let ones = |n: usize| vec![1.0; n];
            let inputs = Inputs {
                time: 0.0,
                coordinates: &ones(coordinates),
                velocities: &ones(velocities),
                parameters: &parameters,
                auxiliaries: &ones(z),
                memory: &ones(m),
                accelerations: &[],
            };
            let (values, _) = balance.evaluate(&inputs, &functions, f64::EPSILON);
            values[2 * count..].to_vec()
        };
        let mut random = Random::new(model.name.bytes().map(u64::from).sum());
        for k in 0..STATES {
            let (near, fast) = if k % 2 == 0 { (0.03, 0.5) } else { (0.5, 5.0) };
            let mut state = start.clone();
            for (i, x) in state.iter_mut().enumerate() {
                let range = match i {
                    i if i < coordinates => near,
                    i if i < coordinates + velocities => fast,
                    // in a third of the states, an event that has not happened has happened
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
                accelerations: &[],
                memory: m,
            };
            let (values, scatter) = balance.evaluate(&inputs, &functions, f64::EPSILON);
            for (i, what) in names.iter().enumerate() {
                let bound = C * (scatter[i] + scatter[count + i]);
                assert!(
                    values[count + i].abs() <= bound,
                    "{}: d{what}/dt = {:e}, but what makes it misses it by {:e}, allowed {bound:e}",
                    model.name,
                    values[i],
                    values[count + i]
                );
            }
        }
    }
}
