//! The facts of a model that need no evaluation: the content of the runtime's `Info`, as owned data.

use super::breakpoints;
use crate::equations::{Equations, LEAST_VOLUME, NO_BEARING, Variable};
use crate::law::ForceKind;
use crate::method::Method;
use crate::model::{Dimension, Extrapolate, Model};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Names, units and sizes of a model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Facts {
    /// Name of the model.
    pub name: String,
    /// SHA-256 of the model's content, hexadecimal.
    pub digest: String,
    /// 2 for the plane, 3 for space.
    pub dimension: u8,
    /// Names of q, in order.
    pub coordinates: Vec<String>,
    /// Names of v, in order.
    pub velocities: Vec<String>,
    /// The kind of each entry of the state: q, v, z, m.
    pub kinds: Vec<StateKind>,
    /// SI unit of each entry of the state, "" for a pure number.
    pub units: Vec<String>,
    /// Names of z, in order.
    pub auxiliaries: Vec<String>,
    /// Names of m, in order.
    pub memory: Vec<String>,
    /// Names of the event functions.
    pub event_functions: Vec<String>,
    /// Names of the kinks.
    pub kinks: Vec<String>,
    /// Names of the onsets of laws, then of the corners of curves.
    pub onsets: Vec<String>,
    /// Number of the onsets that are corners.
    pub corners: usize,
    /// The longest step allowed \[s\], because it is unknown when user forces begin to act; infinite without user
    /// forces.
    pub longest_step: f64,
    /// Names of the effects that do work.
    pub powers: Vec<String>,
    /// The curves of the state, and the quantities watched like them.
    pub curves: Vec<Watched>,
    /// True if a curve of time has no value beyond its end points.
    pub time_ends: bool,
    /// Elements whose inertia may vanish in some position; see [`pivots`](crate::equations::Equations::pivots).
    pub pivots: Vec<String>,
    /// The conditions that parameters must satisfy.
    pub conditions: Vec<String>,
    /// True if the reference joint of a system is free, so that there is a momentum balance.
    pub free: bool,
    /// Headings and SI units of the outputs.
    pub outputs: Vec<Column>,
    /// Names, SI units and bounds of the parameters.
    pub parameters: Vec<Adjustable>,
    /// Times at which a curve of time has a kink, as far as they do not depend on parameters, increasing \[s\].
    pub breakpoints: Vec<f64>,
    /// Length of a run \[s\].
    pub duration: f64,
    /// Time between samples \[s\].
    pub every: f64,
}

/// The kind of an entry of the state, like the runtime's `StateKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum StateKind {
    /// A coordinate of a reference joint \[m\].
    Position,
    /// An angle \[rad\], or a component of a unit quaternion.
    Angle,
    /// The velocity of a reference joint \[m/s\].
    Velocity,
    /// An angular velocity of an element, or the rate of an angle \[rad/s\].
    AngularVelocity,
    /// A state of a force law.
    Law,
    /// A memory of a force law, or the chart of an element.
    Memory,
}

/// A curve whose argument depends on the state, or another quantity watched like such an argument.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Watched {
    /// Name of its owner and of the curve.
    pub name: String,
    /// SI unit of its abscissa; "" for a pure number.
    pub unit: Cow<'static, str>,
    /// Its first and last abscissa; for other quantities, the range of values.
    pub range: [f64; 2],
    /// The values of the curve at these abscissae.
    pub ends: [f64; 2],
    /// Its extrapolation beyond the end points.
    pub extrapolate: Extrapolate,
    /// True if the description states the extrapolation, false if it is the default.
    pub states_extrapolation: bool,
    /// The kind of watched quantity.
    pub kind: crate::equations::Watched,
}

/// A column of the table of outputs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Column {
    /// Heading.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adjustable {
    /// Name.
    pub name: String,
    /// SI unit, "" where unknown.
    pub unit: String,
    /// Default (SI).
    pub default: f64,
    /// Smallest value allowed (SI), −∞ where unbounded.
    pub min: f64,
    /// Largest value allowed (SI), +∞ where unbounded.
    pub max: f64,
    /// True for an input: it may change during a run.
    pub input: bool,
}

impl Facts {
    /// The facts of a model.
    pub fn of(model: &Model, equations: &Equations) -> Self {
        let variables = |variables: &[Variable]| names(variables, |v| &v.name);
        let mut of_time = equations.curves_of_time.iter();
        Facts {
            name: model.name.clone(),
            digest: model.digest.clone(),
            dimension: match model.dimension {
                Dimension::Plane => 2,
                Dimension::Space => 3,
            },
            coordinates: variables(&equations.coordinates),
            velocities: variables(&equations.velocities),
            kinds: kinds(equations),
            units: units(equations),
            auxiliaries: names(&equations.auxiliaries, |state| &state.name),
            memory: names(&equations.memory, |state| &state.name),
            event_functions: names(&equations.event_functions, |event_function| {
                &event_function.name
            }),
            kinks: names(&equations.kinks, |kink| &kink.name),
            onsets: names(&equations.onsets, |onset| &onset.name),
            corners: equations.corners,
            longest_step: longest_step(model),
            powers: names(equations.section(Method::Powers), |power| &power.name),
            curves: watched(model, equations),
            time_ends: of_time
                .any(|&(curve, _)| model.curves[curve].extrapolate == Extrapolate::Error),
            pivots: names(&equations.pivots, |pivot| &pivot.name),
            conditions: names(&equations.conditions, |condition| &condition.name),
            free: !equations.section(Method::Momentum).is_empty(),
            outputs: (model.outputs.iter())
                .map(|output| Column {
                    name: output.name.clone(),
                    unit: output.unit.to_string(),
                })
                .collect(),
            parameters: (model.parameters.iter())
                .map(|parameter| Adjustable {
                    name: parameter.name.clone(),
                    unit: parameter.unit.clone(),
                    default: parameter.default,
                    min: parameter.min.unwrap_or(f64::NEG_INFINITY),
                    max: parameter.max.unwrap_or(f64::INFINITY),
                    input: parameter.input,
                })
                .collect(),
            breakpoints: breakpoints::constant(model, equations),
            duration: model.run.duration,
            every: model.run.every,
        }
    }
}

fn names<T>(of: &[T], name: impl Fn(&T) -> &String) -> Vec<String> {
    of.iter().map(|one| name(one).clone()).collect()
}

/// The kind of each entry of the state: q, v, z, m.
fn kinds(equations: &Equations) -> Vec<StateKind> {
    let of = |variables: &[Variable], [joint, element]: [StateKind; 2]| {
        let kind = |variable: &Variable| match variable.element {
            None => joint,
            Some(_) => element,
        };
        variables.iter().map(kind).collect::<Vec<_>>()
    };
    [
        of(
            &equations.coordinates,
            [StateKind::Position, StateKind::Angle],
        ),
        of(
            &equations.velocities,
            [StateKind::Velocity, StateKind::AngularVelocity],
        ),
        vec![StateKind::Law; equations.auxiliaries.len()],
        vec![StateKind::Memory; equations.memory.len()],
    ]
    .concat()
}

/// The unit of each entry of the state.
fn units(equations: &Equations) -> Vec<String> {
    let variables = equations.coordinates.iter().chain(&equations.velocities);
    let laws = equations.auxiliaries.iter().chain(&equations.memory);
    let units = variables.map(|variable| variable.unit);
    let units = units.chain(laws.map(|state| state.unit));
    units.map(String::from).collect()
}

/// The shortest time scale of any user force; a force that declares none counts with the time between samples.
fn longest_step(model: &Model) -> f64 {
    let scales = model
        .forces
        .iter()
        .filter_map(|force| match ForceKind::of(force) {
            ForceKind::User(user) if !user.function.name.is_empty() => {
                Some(user.scale.unwrap_or(model.run.every))
            }
            _ => None,
        });
    scales.fold(f64::INFINITY, f64::min)
}

/// The range of a bearing \[rad\] and of a component of a direction; the upper end is the value that stands for none.
const BEARINGS: [f64; 2] = [-std::f64::consts::PI, NO_BEARING];

fn watched(model: &Model, equations: &Equations) -> Vec<Watched> {
    let of = |watched: &crate::equations::CurveOfState| {
        let crate::equations::Watched::Curve(index, unit) = watched.what else {
            let range = match watched.what {
                crate::equations::Watched::Volume => [0.0, 1.0 - LEAST_VOLUME],
                crate::equations::Watched::Edge => [0.0, 1.0],
                _ => BEARINGS,
            };
            return Watched {
                name: watched.name.clone(),
                unit: "".into(),
                range,
                ends: [0.0; 2],
                extrapolate: Extrapolate::Hold,
                states_extrapolation: true,
                kind: watched.what,
            };
        };
        let curve = &model.curves[index];
        let [[first, start], .., [last, end]] = curve.points[..] else {
            unreachable!("the reader of models refuses a curve of fewer than two points");
        };
        Watched {
            name: watched.name.clone(),
            unit: unit.into(),
            range: [first, last],
            ends: [start, end],
            extrapolate: curve.extrapolate,
            states_extrapolation: curve.states_extrapolation,
            kind: crate::equations::Watched::Curve(index, ""),
        }
    };
    equations.curves.iter().map(of).collect()
}
