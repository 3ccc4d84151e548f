//! S, r_s, r_k and v̇ at one state, as a run computes them.

use bryant_engine::{Engine, Interpreted};
use bryant_generator::expression;
use bryant_generator::model::Model;
use bryant_generator::program::{self, Curve, Method};
use bryant_runtime::{Adjustable as _, Dynamics as _};
use serde::{Deserialize, Serialize};

/// A state. Coordinates and velocities are in the order of [`Info::coordinates`](bryant_runtime::Info::coordinates)
/// and [`Info::velocities`](bryant_runtime::Info::velocities).
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
    /// Accelerations for functions that need them; if none are given, those of the motion.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub a: Vec<f64>,
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
    /// The functions that were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub functions: Vec<Function>,
}

/// The values of a function.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// The names of its rows; a single one may have none.
    pub rows: Vec<String>,
    /// The names of its columns; a single one has none.
    pub columns: Vec<String>,
    /// The values, by rows.
    pub values: Vec<Vec<f64>>,
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
    /// The parameters violate a condition of the model.
    #[error("{condition}, which is not so with these parameters")]
    Refused {
        /// The condition.
        condition: String,
    },
    /// A result is not finite, because the state is too far out.
    #[error(
        "{quantity} of {of} is {value} at this state\n  help: look for numbers that are too large, angles at a singularity, and curves left beyond their last point"
    )]
    NotFinite {
        /// The quantity that is not finite.
        quantity: &'static str,
        /// The velocity or the function that it belongs to.
        of: String,
        /// Its value.
        value: f64,
    },
}

/// Allowed deviation of the length of a quaternion from 1: a state that was written by hand may lack a few digits.
const QUATERNION_TOLERANCE: f64 = 1e-4;

/// Evaluates the equations of an engine whose lists have S, r_s and r_k. Parameters are in the model's order (SI).
pub fn at(engine: &Engine, parameters: &[f64], state: &State) -> Result<Evaluation, StateError> {
    let info = engine.info();
    let model = model(engine, parameters);
    if let Some(condition) = model.violated() {
        let condition = info.conditions[condition].to_owned();
        return Err(StateError::Refused { condition });
    }
    let mut y = initial(&model);
    let mut rest = &mut y[..];
    for (key, what, given, names) in [
        ("q", "coordinates", &state.q, info.coordinates),
        ("v", "velocities", &state.v, info.velocities),
        ("z", "states of force laws", &state.z, info.auxiliaries),
        ("m", "memories of force laws", &state.m, info.memory),
    ] {
        let (own, behind) = rest.split_at_mut(names.len());
        // laws begin as in a run, if nothing is given
        if !given.is_empty() || matches!(key, "q" | "v") {
            check_length(key, what, given.len(), names)?;
            own.copy_from_slice(given);
        }
        rest = behind;
    }
    let ranges = engine.lists().quaternions.iter();
    for first in ranges.flat_map(|range| range.clone().step_by(4)) {
        check_quaternion(info.coordinates[first], &state.q[first..first + 4])?;
    }
    // zero has no sign
    let results = |method| -> Vec<f64> {
        let results = model.results(method, state.t, &y).into_iter();
        results.map(|value| value + 0.0).collect()
    };
    let size = info.velocities.len();
    let triangle = results(Method::MassMatrix);
    let mut matrix = vec![vec![0.0; size]; size];
    let entries = (0..size).flat_map(|row| (row..size).map(move |column| [row, column]));
    for ([row, column], entry) in entries.zip(triangle) {
        matrix[row][column] = entry;
        matrix[column][row] = entry;
    }
    let rates = results(Method::Derivative);
    let [r_s, r_k] = [Method::VelocityForces, Method::AppliedForces].map(results);
    let acceleration = rates[info.coordinates.len()..][..size].to_vec();
    let vectors = [&r_s[..], &r_k, &acceleration].concat();
    check_finite(&matrix.concat(), &vectors, info.velocities)?;
    let given = match state.a.is_empty() {
        true => &acceleration,
        false => &state.a,
    };
    check_length("a", "velocities", given.len(), info.velocities)?;
    let function = |(index, function): (usize, &program::Function)| {
        let columns = function.columns.len();
        let mut values = vec![0.0; function.rows.len() * columns];
        model.function(index, state.t, &y, given, &mut values);
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(StateError::NotFinite {
                quantity: "a number",
                of: function.name.clone(),
                value,
            });
        }
        // zero has no sign
        let rows = values.chunks(columns.max(1));
        let rows = rows.map(|row| row.iter().map(|value| value + 0.0).collect());
        Ok(Function {
            name: function.name.clone(),
            rows: function.rows.clone(),
            columns: function.columns.clone(),
            values: rows.collect(),
        })
    };
    let functions = engine.functions().iter().enumerate().map(function);
    let functions = functions.collect::<Result<_, _>>()?;
    Ok(Evaluation {
        state: state.clone(),
        coordinates: owned(info.coordinates),
        velocities: owned(info.velocities),
        mass_matrix: matrix,
        r_s,
        r_k,
        acceleration,
        functions,
    })
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// Checks that a list of a state has as many numbers as `names`.
fn check_length(
    key: &'static str,
    what: &'static str,
    given: usize,
    names: &[&str],
) -> Result<(), StateError> {
    match given == names.len() {
        true => Ok(()),
        false => Err(StateError::Length {
            key,
            what,
            given,
            names: owned(names),
        }),
    }
}

/// Checks that S (by rows) and the vectors r_s, r_k and v̇ (one after the other) are finite.
fn check_finite(matrix: &[f64], vectors: &[f64], velocities: &[&str]) -> Result<(), StateError> {
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
                of: velocities[row].to_owned(),
                value,
            });
        }
    }
    Ok(())
}

/// The model with these parameters.
fn model(engine: &Engine, parameters: &[f64]) -> Interpreted<f64> {
    let mut model = engine.interpreted();
    model.set_parameters(parameters);
    model
}

/// The state in which a run begins.
fn initial(model: &Interpreted<f64>) -> Vec<f64> {
    let mut y = vec![0.0; model.info().state_length()];
    model.initial_state(&mut y);
    y
}

/// The state in which a run begins.
pub fn start(engine: &Engine, parameters: &[f64]) -> State {
    let info = engine.info();
    let mut y = initial(&model(engine, parameters)).into_iter();
    let mut next = |names: &[&str]| y.by_ref().take(names.len()).collect();
    State {
        t: 0.0,
        q: next(info.coordinates),
        v: next(info.velocities),
        z: next(info.auxiliaries),
        m: next(info.memory),
        a: Vec::new(),
    }
}

/// Checks that a quaternion, whose first coordinate has this name, has length 1.
fn check_quaternion(name: &str, q: &[f64]) -> Result<(), StateError> {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let element = name.strip_suffix(".qw").unwrap_or(name).to_owned();
    match (length - 1.0).abs() > QUATERNION_TOLERANCE {
        true => Err(StateError::Quaternion { element, length }),
        false => Ok(()),
    }
}

/// The functions of a model that are not algebra, for plain numbers; a function of the user gives NaN.
pub fn functions(model: &Model) -> impl Fn(expression::Function, &[f64]) -> f64 + use<> {
    let curves: Vec<Curve> = model.curves.iter().map(Curve::from).collect();
    bryant_engine::functions(&curves)
}
