//! The variables of a model, with their value references.

use bryant_runtime::{Info, StateKind};
use std::collections::HashSet;

/// What a variable is in the model, by its index there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Of {
    /// A parameter, constant during a run.
    Parameter(usize),
    /// A parameter that may change during a run.
    Input(usize),
    /// An output.
    Output(usize),
    /// An entry of the state: a coordinate, a velocity, a state of a force law.
    State(usize),
}

/// A variable. Its value reference is its index in the list, plus 1: 0 is the time.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Its name, which no other has.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
    /// What it is.
    pub of: Of,
}

/// All variables of a model: parameters and inputs, outputs, and the state without memory.
pub fn variables(info: &Info) -> Vec<Variable> {
    let parameters = info
        .parameters
        .iter()
        .enumerate()
        .map(|(index, parameter)| {
            let (of, kind) = match parameter.input {
                true => (Of::Input(index), "input"),
                false => (Of::Parameter(index), "parameter"),
            };
            (parameter.name, parameter.unit, of, kind)
        });
    let outputs = info.outputs.iter().enumerate();
    let outputs = outputs.map(|(index, of)| (of.name, of.unit, Of::Output(index), "output"));
    let state = (0..info.state_length()).filter(|&index| info.kind(index) != StateKind::Memory);
    let state = state.map(|index| {
        let name = info.state_name(index).unwrap_or_default();
        let unit = info.state_unit(index).unwrap_or_default();
        (name, unit, Of::State(index), "state")
    });
    let mut taken = HashSet::from([TIME.to_owned()]);
    let mut variables = Vec::new();
    for (name, unit, of, kind) in parameters.chain(outputs).chain(state) {
        // a parameter and an output may have the same name in a model
        let mut name = name.to_owned();
        while !taken.insert(name.clone()) {
            name = format!("{kind} {name}");
        }
        let unit = unit.to_owned();
        variables.push(Variable { name, unit, of });
    }
    variables
}

/// The name of the independent variable.
pub const TIME: &str = "time";
