//! Evaluates the equations of a model at the start of a run without compilation: finds values that are not finite, and
//! whether a run would report them.

use crate::bench::Engine;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Equations;
use bryant_generator::expression::NodeId;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::model::Model;

/// A model with its equations, which are evaluated at the start of a run.
pub struct Start<'a> {
    engine: &'a dyn Engine,
    model: &'a Model,
    equations: Equations,
}

/// What was found at a start.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// All values are finite.
    Finite,
    /// A value that a run evaluates is not finite: the run ends at its beginning with a message.
    Reported,
    /// A value is not finite, and no run would report it; the value's name.
    Silent(String),
}

impl<'a> Start<'a> {
    /// Derives the equations; `engine` provides the functions that they call.
    pub fn of(engine: &'a dyn Engine, model: &'a Model) -> Start<'a> {
        let options = Options {
            matrices: false,
            route: None,
        };
        let equations = derive_with(model, options);
        Start {
            engine,
            model,
            equations,
        }
    }

    /// Evaluates everything that a run evaluates before its first sample, with these parameters.
    pub fn at(&self, parameters: &[f64]) -> Found {
        let equations = &self.equations;
        let functions = self.engine.functions(self.model);
        let values = |roots: &[NodeId], q: &[f64], v: &[f64], z: &[f64], m: &[f64]| {
            let inputs = Inputs {
                time: 0.0,
                coordinates: q,
                velocities: v,
                parameters,
                auxiliaries: z,
                accelerations: &[],
                memory: m,
            };
            evaluate(&equations.graph, roots, &inputs, &functions)
        };
        let initial = |roots: &[NodeId]| values(roots, &[], &[], &[], &[]);
        let initial_of = |states: &[bryant_generator::equations::LawState]| {
            initial(&states.iter().map(|state| state.initial).collect::<Vec<_>>())
        };
        let mut q = initial(&equations.initial_coordinates);
        for range in &equations.quaternions {
            let norm = q[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
            q[range.clone()].iter_mut().for_each(|x| *x /= norm);
        }
        let v = initial(&equations.initial_velocities);
        let z = initial_of(&equations.auxiliaries);
        let mut m = initial_of(&equations.memory);
        let next: Vec<NodeId> = equations.memory.iter().map(|m| m.next).collect();
        for _ in 0..=equations.event_functions.len() {
            m = values(&next, &q, &v, &z, &m);
        }

        let at = |roots: &[NodeId]| values(roots, &q, &v, &z, &m);
        let rates: Vec<NodeId> = (equations.coordinate_rates.iter())
            .chain(&equations.accelerations)
            .copied()
            .chain(equations.auxiliaries.iter().map(|z| z.next))
            .collect();
        let finite = |values: &[f64]| values.iter().all(|x| x.is_finite());
        // a run evaluates its initial state, the rates and outputs at this state, and memory after its first step
        let states = [&q, &v, &z, &m];
        if !(states.into_iter().all(|values| finite(values))
            && finite(&at(&rates))
            && finite(&at(&equations.outputs)))
        {
            return Found::Reported;
        }
        // An event function that is NaN never changes its sign, so the event would never happen and nothing would
        // report it. Energies may overflow, because the balance at the end of a run reports this.
        let named = equations.event_functions.iter().chain(&equations.kinks);
        let (names, roots): (Vec<&str>, Vec<NodeId>) = named
            .map(|named| (named.name.as_str(), named.value))
            .unzip();
        match at(&roots).iter().position(|x| !x.is_finite()) {
            Some(i) => Found::Silent(names[i].to_owned()),
            None => Found::Finite,
        }
    }
}
