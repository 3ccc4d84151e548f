//! Derivatives of inverse dynamics and of accelerations, and the linearisation of the whole scene.

use super::Known;
use crate::dynamics::derivatives::{
    self, NotDifferentiable, acceleration_derivatives, inverse_dynamics_derivatives, linearisation,
    of_laws_but_fields,
};
use crate::expression::Expr;
use crate::model::Model;

impl<'g> Known<'g, '_> {
    fn of_derivatives(&self) -> derivatives::DerivativeInputs<'g, '_> {
        let scene = self.scene;
        derivatives::DerivativeInputs {
            graph: scene.graph,
            model: scene.model,
            layout: scene.layout,
            state: self.state,
            motion: scene.motion,
            start: scene.start,
            systems: self.systems,
            applied: scene.applied,
        }
    }
}

/// ∂τ/∂q and ∂τ/∂v, side by side.
pub fn of_inverse_dynamics<'g>(known: &Known<'g, '_>) -> Result<Vec<Expr<'g>>, NotDifferentiable> {
    let found = inverse_dynamics_derivatives(&known.of_derivatives(), &known.given)?;
    let rows = found.by_position.iter().zip(&found.by_velocity);
    Ok(rows.flat_map(|(q, v)| [&q[..], v].concat()).collect())
}

/// v̇, ∂v̇/∂q, ∂v̇/∂v and S⁻¹, side by side.
pub fn of_accelerations<'g>(known: &Known<'g, '_>) -> Result<Vec<Expr<'g>>, NotDifferentiable> {
    let scene = known.of_derivatives();
    let found = acceleration_derivatives(&scene, &of_laws_but_fields(&scene))?;
    let row = |i: usize| {
        let parts = [
            &found.by_position[i],
            &found.by_velocity[i],
            &found.inverse[i],
        ];
        let parts = parts.into_iter().flatten().copied();
        std::iter::once(found.accelerations[i])
            .chain(parts)
            .collect::<Vec<_>>()
    };
    Ok((0..known.size()).flat_map(row).collect())
}

/// A and B, and C and D below them.
pub fn of_scene<'g>(known: &Known<'g, '_>) -> Result<Vec<Expr<'g>>, NotDifferentiable> {
    let scene = known.of_derivatives();
    let found = linearisation(&scene, &inputs(scene.model))?;
    let above = found.a.iter().zip(&found.b);
    let below = found.c.iter().zip(&found.d);
    let rows = above.chain(below);
    Ok(rows.flat_map(|(x, u)| [&x[..], u].concat()).collect())
}

/// The inputs of a model, by their index among the parameters.
fn inputs(model: &Model) -> Vec<usize> {
    let parameters = model.parameters.iter().enumerate();
    parameters
        .filter_map(|(index, of)| of.input.then_some(index))
        .collect()
}

/// Along the motion of each velocity, then by each velocity.
pub fn motions_and_velocities(known: &Known<'_, '_>) -> Vec<String> {
    let names = || {
        known
            .scene
            .layout
            .velocities
            .iter()
            .map(|v| v.name.as_str())
    };
    let along = names().map(|name| format!("along {name}"));
    along
        .chain(names().map(|name| format!("by {name}")))
        .collect()
}

/// A value, its derivatives as [`motions_and_velocities`], and those by each generalised force.
pub fn value_and_derivatives(known: &Known<'_, '_>) -> Vec<String> {
    let forces = known
        .scene
        .layout
        .velocities
        .iter()
        .map(|v| format!("by force on {}", v.name));
    let derivatives = motions_and_velocities(known).into_iter().chain(forces);
    std::iter::once("value".to_owned())
        .chain(derivatives)
        .collect()
}

/// The state without the lengths of quaternions, then the inputs.
pub fn state_and_inputs(known: &Known<'_, '_>) -> Vec<String> {
    let inputs = inputs(known.scene.model).into_iter();
    let inputs =
        inputs.map(|index| format!("by input {}", known.scene.model.parameters[index].name));
    let laws = auxiliaries(known).map(|name| format!("by {name}"));
    let state = motions_and_velocities(known).into_iter().chain(laws);
    state.chain(inputs).collect()
}

/// The rates of the state without the lengths of quaternions, then the outputs.
pub fn rates_and_outputs(known: &Known<'_, '_>) -> Vec<String> {
    let names = || {
        known
            .scene
            .layout
            .velocities
            .iter()
            .map(|v| v.name.as_str())
    };
    let rates = names().map(str::to_owned);
    let rates = rates.chain(names().map(|name| format!("rate of {name}")));
    let laws = auxiliaries(known).map(|name| format!("rate of {name}"));
    let outputs = known
        .scene
        .model
        .outputs
        .iter()
        .map(|output| output.name.clone());
    rates.chain(laws).chain(outputs).collect()
}

fn auxiliaries<'a>(known: &'a Known<'_, '_>) -> impl Iterator<Item = &'a str> {
    let auxiliaries = known.scene.applied.states.auxiliaries.iter();
    auxiliaries.map(|state| state.name.as_str())
}
