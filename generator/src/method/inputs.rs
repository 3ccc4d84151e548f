//! The inputs of methods: time, coordinates, velocities, states of force laws, parameters, and values that were
//! computed before.
//!
//! Values that are known before a method runs are inputs of its graph. The graph has symbols for all but two kinds of
//! them. These two (event functions, values derived from parameters) are numbered as parameters, after those of the
//! model.

pub use super::argument::Argument;
use crate::equations::{Equations, LawState, Variable};
use crate::expression::Symbol;
use crate::model::Model;
use crate::names::snake;

/// An input of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// t
    Time,
    /// `q[i]`
    Coordinate(usize),
    /// `v[i]`
    Velocity(usize),
    /// `z[i]`
    Auxiliary(usize),
    /// `m[i]`
    Memory(usize),
    /// `a[i]`: v̇, for a method that starts from it
    Acceleration(usize),
    /// `g[i]`: an event function, for the method that renews the memory
    EventFunction(usize),
    /// Field of the parameters
    Parameter(usize),
    /// Field of the mechanism, computed from parameters
    Derived(usize),
}

impl Input {
    /// The array argument and the index in it; `None` for an input that is not in an array argument.
    pub fn element(self) -> Option<(Argument, usize)> {
        match self {
            Input::Coordinate(i) => Some((Argument::Coordinates, i)),
            Input::Velocity(i) => Some((Argument::Velocities, i)),
            Input::Auxiliary(i) => Some((Argument::Auxiliaries, i)),
            Input::Memory(i) => Some((Argument::Memory, i)),
            Input::Acceleration(i) => Some((Argument::Accelerations, i)),
            Input::EventFunction(i) => Some((Argument::EventFunctions, i)),
            Input::Time | Input::Parameter(_) | Input::Derived(_) => None,
        }
    }

    /// The argument that contains the input; `None` for a value stored in the mechanism.
    pub fn argument(self) -> Option<Argument> {
        match self {
            Input::Time => Some(Argument::Time),
            _ => self.element().map(|(argument, _)| argument),
        }
    }
}

/// Names of all inputs.
#[derive(Default)]
pub struct Inputs {
    /// Names of q.
    pub coordinates: Vec<String>,
    /// Names of v.
    pub velocities: Vec<String>,
    /// Names of z.
    pub auxiliaries: Vec<String>,
    /// Names of m.
    pub memory: Vec<String>,
    /// Names of v̇.
    pub accelerations: Vec<String>,
    /// Names of the event functions.
    pub event_functions: Vec<String>,
    /// Names of the fields of the parameters.
    pub parameters: Vec<String>,
    /// Names of the fields of the mechanism.
    pub derived: Vec<String>,
    /// The section in which each field of the mechanism was created.
    pub derived_in: Vec<String>,
}

impl Inputs {
    /// Names for the inputs of a model's methods. Values derived from parameters are added later, when they are found.
    pub fn new(model: &Model, equations: &Equations) -> Self {
        let only = model.systems.len() == 1;
        let word = |variable: &Variable| {
            let system = &model.systems[variable.system].name;
            let name = variable.name.as_str();
            let rest = name.strip_prefix(system.as_str()).filter(|_| only);
            let rest = rest.and_then(|rest| rest.strip_prefix(['.', '/']));
            snake(rest.unwrap_or(name))
        };
        let coordinates: Vec<String> = equations.coordinates.iter().map(word).collect();
        let velocities: Vec<String> = equations.velocities.iter().map(word).collect();
        let clash = velocities.iter().any(|name| coordinates.contains(name));
        let of = |suffix: &str| {
            velocities
                .iter()
                .map(|name| format!("{name}_{suffix}"))
                .collect()
        };
        let laws = |states: &[LawState]| states.iter().map(|state| snake(&state.name)).collect();
        Self {
            auxiliaries: laws(&equations.auxiliaries),
            memory: laws(&equations.memory),
            accelerations: of("dot"),
            event_functions: equations
                .event_functions
                .iter()
                .map(|event_function| format!("event_function_{}", snake(&event_function.name)))
                .collect(),
            velocities: if clash {
                of("rate")
            } else {
                velocities.clone()
            },
            coordinates,
            parameters: model.parameters.iter().map(|p| snake(&p.name)).collect(),
            derived: Vec::new(),
            derived_in: Vec::new(),
        }
    }

    /// The symbol of an input.
    pub fn symbol(&self, input: Input) -> Symbol {
        let parameter = |index: usize| Symbol::Parameter(index as u32);
        match input {
            Input::Time => Symbol::Time,
            Input::Coordinate(i) => Symbol::Coordinate(i as u32),
            Input::Velocity(i) => Symbol::Velocity(i as u32),
            Input::Auxiliary(i) => Symbol::Auxiliary(i as u32),
            Input::Memory(i) => Symbol::Memory(i as u32),
            Input::Parameter(i) => parameter(i),
            Input::Acceleration(i) => Symbol::Acceleration(i as u32),
            Input::EventFunction(i) => parameter(self.parameters.len() + i),
            Input::Derived(i) => parameter(self.parameters.len() + self.event_functions.len() + i),
        }
    }

    /// The input of a symbol.
    pub fn input(&self, symbol: Symbol) -> Input {
        let parameters = self.parameters.len();
        let event_functions = parameters + self.event_functions.len();
        match symbol {
            Symbol::Time => Input::Time,
            Symbol::Coordinate(i) => Input::Coordinate(i as usize),
            Symbol::Velocity(i) => Input::Velocity(i as usize),
            Symbol::Auxiliary(i) => Input::Auxiliary(i as usize),
            Symbol::Memory(i) => Input::Memory(i as usize),
            Symbol::Parameter(i) => match i as usize {
                i if i < parameters => Input::Parameter(i),
                i if i < event_functions => Input::EventFunction(i - parameters),
                i => Input::Derived(i - event_functions),
            },
            Symbol::Acceleration(i) => Input::Acceleration(i as usize),
        }
    }

    /// Number of elements of an array argument; 0 for time.
    pub fn length(&self, argument: Argument) -> usize {
        match argument {
            Argument::Time => 0,
            Argument::Coordinates => self.coordinates.len(),
            Argument::Velocities | Argument::Accelerations => self.velocities.len(),
            Argument::Auxiliaries => self.auxiliaries.len(),
            Argument::Memory => self.memory.len(),
            Argument::EventFunctions => self.event_functions.len(),
        }
    }

    /// The inputs that change from call to call, each with the name it should have if that is free.
    pub fn variables(&self) -> impl Iterator<Item = (Input, String)> {
        let all = |names: &[String], input: fn(usize) -> Input| {
            let names = names.to_vec();
            names
                .into_iter()
                .enumerate()
                .map(move |(i, name)| (input(i), name))
        };
        std::iter::once((Input::Time, "t".to_string()))
            .chain(all(&self.coordinates, Input::Coordinate))
            .chain(all(&self.velocities, Input::Velocity))
            .chain(all(&self.auxiliaries, Input::Auxiliary))
            .chain(all(&self.memory, Input::Memory))
            .chain(all(&self.accelerations, Input::Acceleration))
            .chain(all(&self.event_functions, Input::EventFunction))
    }
}
