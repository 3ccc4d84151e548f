//! S, r_s, r_k and v̇ at one state, by evaluating the graph of the equations. Only functions of user forces are
//! compiled.

use bryant_engine::UserFunctions;
use bryant_generator::equations::{Equations, LawState, Variable};
use bryant_generator::expression::NodeId;
use bryant_generator::expression::evaluate::{Inputs, evaluate};
use bryant_generator::law::ForceKind;
use bryant_generator::model::Model;
use serde::{Deserialize, Serialize};

mod functions;

pub(crate) use functions::stop;
pub use functions::{functions, functions_with};

/// A state. Coordinates and velocities are in the order of [`Equations::coordinates`] and [`Equations::velocities`].
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Time \[s\].
    #[serde(default)]
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
    /// Continuous states of force laws; if none are given, those at the start of a run.
    #[serde(default)]
    pub z: Vec<f64>,
    /// Memory of force laws; if none are given, the values at the start of a run.
    #[serde(default)]
    pub m: Vec<f64>,
}

/// The equations of motion S v̇ = r_s + r_k at one state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluation {
    /// The state, in the form that `--at` reads.
    pub state: State,
    /// Names of q.
    pub coordinates: Vec<String>,
    /// Names of v.
    pub velocities: Vec<String>,
    /// S, by rows.
    #[serde(rename = "S")]
    pub mass_matrix: Vec<Vec<f64>>,
    /// r_s.
    pub r_s: Vec<f64>,
    /// r_k.
    pub r_k: Vec<f64>,
    /// v̇.
    pub acceleration: Vec<f64>,
}

/// A state that does not fit the model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StateError {
    /// A list has too few or too many numbers.
    #[error("\"{key}\" has {given} numbers, but there are {} {what}: {}", .names.len(), .names.join(", "))]
    Length {
        /// The key of the list: "q" or "v".
        key: &'static str,
        /// The meaning of its numbers.
        what: &'static str,
        /// How many numbers are given.
        given: usize,
        /// The names of the expected numbers.
        names: Vec<String>,
    },
    /// The length of a quaternion is not 1.
    #[error(
        "the quaternion {element}.qw … {element}.qz has length {length}, but an orientation has 1\n  help: divide its four numbers by their length; no rotation is 1, 0, 0, 0"
    )]
    Quaternion {
        /// The element, `system/element`.
        element: String,
        /// √(w² + x² + y² + z²).
        length: f64,
    },
    /// A function of a user force is not available; it is written in Rust, and not part of the graph.
    #[error(
        "the user force \"{force}\" is computed by the Rust function {function}, which is not available\n  help: compile it by `UserForces::of`, and hand it over; `enabled: false` leaves it out"
    )]
    User {
        /// The force.
        force: String,
        /// The function.
        function: String,
    },
    /// The parameters violate a condition of the model.
    #[error("{condition}, which is not so with these parameters")]
    Refused {
        /// The condition.
        condition: String,
    },
    /// A result is not finite, because the state is too far out.
    #[error(
        "{quantity} of {velocity} is {value} at this state\n  help: look for numbers that are too large, angles at a singularity, and curves left beyond their last point"
    )]
    NotFinite {
        /// The quantity that is not finite.
        quantity: &'static str,
        /// The velocity that it belongs to.
        velocity: String,
        /// Its value.
        value: f64,
    },
}

/// Allowed deviation of the length of a quaternion from 1: a state that was written by hand may lack a few digits.
const QUATERNION_TOLERANCE: f64 = 1e-4;

/// Evaluates the equations, which must have been derived with S, r_s and r_k. Parameters are in the model's order (SI).
/// `users` are the functions of user forces, if the model has any.
pub fn at(
    model: &Model,
    equations: &Equations,
    parameters: &[f64],
    state: &State,
    users: Option<&dyn UserFunctions>,
) -> Result<Evaluation, StateError> {
    knows_user_forces(model, users)?;
    if let Some(condition) = refused(model, equations, parameters) {
        return Err(StateError::Refused { condition });
    }
    let names = |variables: &[Variable]| -> Vec<String> {
        variables.iter().map(|v| v.name.clone()).collect()
    };
    let coordinates = names(&equations.coordinates);
    let velocities = names(&equations.velocities);
    check_length("q", "coordinates", state.q.len(), &coordinates)?;
    check_length("v", "velocities", state.v.len(), &velocities)?;
    check_quaternions(&coordinates, &state.q)?;
    let laws = |key, what, states: &[LawState], given: &[f64]| {
        let values = match given.is_empty() {
            true => initial(model, equations, states, parameters),
            false => given.to_vec(),
        };
        let names: Vec<String> = states.iter().map(|s| s.name.clone()).collect();
        check_length(key, what, values.len(), &names).map(|()| values)
    };
    let z = laws(
        "z",
        "states of force laws",
        &equations.auxiliaries,
        &state.z,
    )?;
    let m = laws("m", "memories of force laws", &equations.memory, &state.m)?;
    let inputs = Inputs {
        time: state.t,
        coordinates: &state.q,
        velocities: &state.v,
        parameters,
        auxiliaries: &z,
        memory: &m,
    };
    let mut roots: Vec<NodeId> = equations.mass_matrix.iter().flatten().copied().collect();
    roots.extend(&equations.velocity_forces);
    roots.extend(&equations.applied_forces);
    roots.extend(&equations.accelerations);
    let functions = functions_with(model, users);
    let mut values = evaluate(&equations.graph, &roots, &inputs, &functions);
    // zero has no sign
    values.iter_mut().for_each(|value| *value += 0.0);
    let size = velocities.len();
    let (matrix, vectors) = values.split_at(size * size);
    check_finite(matrix, vectors, &velocities)?;
    let mut vectors = vectors.chunks(size.max(1)).map(<[f64]>::to_vec);
    let mut vector = || vectors.next().unwrap_or_default();
    Ok(Evaluation {
        state: state.clone(),
        coordinates,
        velocities,
        mass_matrix: matrix.chunks(size.max(1)).map(<[f64]>::to_vec).collect(),
        r_s: vector(),
        r_k: vector(),
        acceleration: vector(),
    })
}

/// Refuses a model with a user force whose function is not in `users`.
fn knows_user_forces(model: &Model, users: Option<&dyn UserFunctions>) -> Result<(), StateError> {
    for (index, force) in model.forces.iter().enumerate() {
        let known = users.is_some_and(|users| users.knows(index));
        if let ForceKind::User(user) = ForceKind::of(force)
            && !known
        {
            return Err(StateError::User {
                force: force.name.clone(),
                function: user.function.name.clone(),
            });
        }
    }
    Ok(())
}

/// Checks that a list of a state has as many numbers as `names`.
fn check_length(
    key: &'static str,
    what: &'static str,
    given: usize,
    names: &[String],
) -> Result<(), StateError> {
    match given == names.len() {
        true => Ok(()),
        false => Err(StateError::Length {
            key,
            what,
            given,
            names: names.to_vec(),
        }),
    }
}

/// Checks that S (by rows) and the vectors r_s, r_k and v̇ (one after the other) are finite.
fn check_finite(matrix: &[f64], vectors: &[f64], velocities: &[String]) -> Result<(), StateError> {
    let size = velocities.len().max(1);
    let rows = matrix.chunks(size).enumerate();
    let rows = rows.map(|(row, values)| ("a number in the row of S", row, values));
    let quantities = ["r_s", "r_k", "the acceleration"].into_iter();
    let entries = quantities
        .zip(vectors.chunks(size))
        .flat_map(|(quantity, vector)| {
            let entries = vector.chunks(1).enumerate();
            entries.map(move |(row, value)| (quantity, row, value))
        });
    for (quantity, row, values) in rows.chain(entries) {
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(StateError::NotFinite {
                quantity,
                velocity: velocities[row].clone(),
                value,
            });
        }
    }
    Ok(())
}

/// The state in which a run begins.
pub fn start(model: &Model, equations: &Equations, parameters: &[f64]) -> State {
    let at = |roots: &[NodeId]| of_parameters(model, equations, roots, parameters);
    let of_laws = |states: &[LawState]| initial(model, equations, states, parameters);
    State {
        t: 0.0,
        q: at(&equations.initial_coordinates),
        v: at(&equations.initial_velocities),
        z: of_laws(&equations.auxiliaries),
        m: of_laws(&equations.memory),
    }
}

/// The states of force laws at the start of a run.
fn initial(
    model: &Model,
    equations: &Equations,
    states: &[LawState],
    parameters: &[f64],
) -> Vec<f64> {
    let roots: Vec<NodeId> = states.iter().map(|state| state.initial).collect();
    of_parameters(model, equations, &roots, parameters)
}

/// The condition that the parameters violate; `None` if they violate none.
fn refused(model: &Model, equations: &Equations, parameters: &[f64]) -> Option<String> {
    let roots: Vec<NodeId> = equations.conditions.iter().map(|c| c.value).collect();
    let values = of_parameters(model, equations, &roots, parameters);
    let mut conditions = equations.conditions.iter().zip(values);
    let broken = conditions.find(|(condition, value)| !condition.rule.keeps(*value))?;
    Some(broken.0.name.clone())
}

/// The values of `roots`, which depend only on parameters.
fn of_parameters(
    model: &Model,
    equations: &Equations,
    roots: &[NodeId],
    parameters: &[f64],
) -> Vec<f64> {
    let inputs = Inputs {
        time: 0.0,
        coordinates: &[],
        velocities: &[],
        parameters,
        auxiliaries: &[],
        memory: &[],
    };
    evaluate(&equations.graph, roots, &inputs, &functions(model))
}

/// Checks that each quaternion, four coordinates with names that end in qw … qz, has length 1.
fn check_quaternions(names: &[String], q: &[f64]) -> Result<(), StateError> {
    for (i, name) in names.iter().enumerate() {
        let Some(element) = name.strip_suffix(".qw") else {
            continue;
        };
        let length = q[i..].iter().take(4).map(|x| x * x).sum::<f64>().sqrt();
        if (length - 1.0).abs() > QUATERNION_TOLERANCE {
            let element = element.to_owned();
            return Err(StateError::Quaternion { element, length });
        }
    }
    Ok(())
}
