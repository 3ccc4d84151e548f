//! What is known of a model without evaluating anything: what the runtime's `Info` holds, as owned data.

use super::breakpoints;
use crate::equations::{Equations, LEAST_VOLUME, NO_BEARING, Variable};
use crate::model::{Dimension, Extrapolate, ForceKind, Model};

/// Names, units, sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct Facts {
    /// Name of the model.
    pub name: String,
    /// SHA-256 of what the model says, hexadecimal.
    pub digest: String,
    /// 2 or 3.
    pub dimension: u8,
    /// Names of q, in order.
    pub coordinates: Vec<String>,
    /// Names of v, in order.
    pub velocities: Vec<String>,
    /// What each entry of the state is: q, v, z, m.
    pub kinds: Vec<Kind>,
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
    /// Names of the onsets, the corners of curves behind those of laws.
    pub onsets: Vec<String>,
    /// How many of the onsets are corners.
    pub corners: usize,
    /// No step may be longer \[s\], because nobody knows when the user's forces begin to act; infinite without such.
    pub longest_step: f64,
    /// Names of the effects that do work.
    pub powers: Vec<String>,
    /// The curves of the state.
    pub curves: Vec<Watched>,
    /// Whether a curve of time must not be left.
    pub time_ends: bool,
    /// Elements whose inertia may vanish in some position.
    pub pivots: Vec<String>,
    /// What parameters must keep.
    pub conditions: Vec<String>,
    /// Whether the reference joint of a system is free, so that there is a momentum to balance.
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

/// What an entry of the state is: the variants of the runtime's `StateKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A coordinate of a reference joint \[m\].
    Position,
    /// An angle \[rad\], or a component of a unit quaternion.
    Angle,
    /// Of a reference joint \[m/s\].
    Velocity,
    /// Of an element, or the rate of an angle \[rad/s\].
    AngularVelocity,
    /// A state of a force law.
    Law,
    /// What a force law remembers, or the chart of an element.
    Memory,
}

/// A curve at an argument that depends on the state, the bearing of a bent joint, or a component of the direction of a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Watched {
    /// Whose it is.
    pub name: String,
    /// Its first and its last abscissa.
    pub range: [f64; 2],
    /// Its values there.
    pub ends: [f64; 2],
    /// What it does beyond.
    pub extrapolate: Extrapolate,
    /// Whether the description says so, and it is not merely the default.
    pub told: bool,
    /// Whether it is a curve.
    pub kind: crate::equations::Watched,
}

/// A column of the table of outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    /// Heading.
    pub name: String,
    /// SI unit, "" for a pure number.
    pub unit: String,
}

/// An adjustable number.
#[derive(Clone, Debug, PartialEq)]
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
}

impl Facts {
    /// Those of a model.
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
            powers: names(&equations.powers, |power| &power.name),
            curves: watched(model, equations),
            time_ends: of_time
                .any(|&(curve, _)| model.curves[curve].extrapolate == Extrapolate::Error),
            pivots: names(&equations.pivots, |pivot| &pivot.name),
            conditions: names(&equations.conditions, |condition| &condition.name),
            free: !equations.momentum.is_empty(),
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

/// What each entry of the state is: q, v, z, m.
fn kinds(equations: &Equations) -> Vec<Kind> {
    let of = |variables: &[Variable], [joint, element]: [Kind; 2]| {
        let kind = |variable: &Variable| match variable.element {
            None => joint,
            Some(_) => element,
        };
        variables.iter().map(kind).collect::<Vec<_>>()
    };
    [
        of(&equations.coordinates, [Kind::Position, Kind::Angle]),
        of(
            &equations.velocities,
            [Kind::Velocity, Kind::AngularVelocity],
        ),
        vec![Kind::Law; equations.auxiliaries.len()],
        vec![Kind::Memory; equations.memory.len()],
    ]
    .concat()
}

/// The unit of each.
fn units(equations: &Equations) -> Vec<String> {
    let variables = equations.coordinates.iter().chain(&equations.velocities);
    let laws = equations.auxiliaries.iter().chain(&equations.memory);
    let units = variables.map(|variable| variable.unit);
    let units = units.chain(laws.map(|state| state.unit));
    units.map(String::from).collect()
}

/// The shortest scale of any user force; of one that declares none, the time between samples.
fn longest_step(model: &Model) -> f64 {
    let scales = model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::User(user) if !user.function.name.is_empty() => {
            Some(user.scale.unwrap_or(model.run.every))
        }
        _ => None,
    });
    scales.fold(f64::INFINITY, f64::min)
}

/// The range of a bearing \[rad\] and of a component, with what stands for none.
const BEARINGS: [f64; 2] = [-std::f64::consts::PI, NO_BEARING];

fn watched(model: &Model, equations: &Equations) -> Vec<Watched> {
    let of = |watched: &crate::equations::CurveOfState| {
        let crate::equations::Watched::Curve(curve) = watched.what else {
            let range = match watched.what {
                crate::equations::Watched::Volume => [0.0, 1.0 - LEAST_VOLUME],
                crate::equations::Watched::Edge => [0.0, 1.0],
                _ => BEARINGS,
            };
            return Watched {
                name: watched.name.clone(),
                range,
                ends: [0.0; 2],
                extrapolate: Extrapolate::Hold,
                told: true,
                kind: watched.what,
            };
        };
        let curve = &model.curves[curve];
        let [[first, start], .., [last, end]] = curve.points[..] else {
            unreachable!("the reader of models refuses a curve of fewer than two points");
        };
        Watched {
            name: watched.name.clone(),
            range: [first, last],
            ends: [start, end],
            extrapolate: curve.extrapolate,
            told: curve.told,
            kind: watched.what,
        }
    };
    equations.curves.iter().map(of).collect()
}
