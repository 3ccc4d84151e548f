//! Converts the facts of a model to the form of the runtime, which lives as long as the program.

use bryant_generator::equations::Watched;
use bryant_generator::model;
use bryant_generator::program::{Facts, Kind};
use bryant_runtime::curve::Extrapolate;
use bryant_runtime::{CurveInfo, CurveKind, Info, OutputInfo, ParameterInfo, StateKind};
use std::sync::{Mutex, PoisonError};

/// All facts that were converted, each with its result.
static KNOWN: Mutex<Vec<(Facts, &'static Info)>> = Mutex::new(Vec::new());

/// The facts of a model as [`Info`].
///
/// `Info` consists of references that last as long as the program. Their memory is leaked on purpose, some kilobytes
/// for each model. Equal facts give the same `Info`, so making a model many times leaks only once.
pub fn info(facts: &Facts) -> &'static Info {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, info)) = known.iter().find(|(of, _)| of == facts) {
        return info;
    }
    let info: &'static Info = Box::leak(Box::new(leaked(facts)));
    known.push((facts.clone(), info));
    info
}

fn leaked(facts: &Facts) -> Info {
    let curves = facts.curves.iter().map(|curve| CurveInfo {
        name: word(&curve.name),
        unit: word(&curve.unit),
        first: curve.range[0],
        last: curve.range[1],
        ends: curve.ends,
        extrapolate: extrapolate(curve.extrapolate),
        told: curve.told,
        kind: match curve.kind {
            Watched::Curve(..) => CurveKind::Curve,
            Watched::Bearing => CurveKind::Bearing,
            Watched::HalfTurn => CurveKind::HalfTurn,
            Watched::Direction(component) => CurveKind::Direction(component),
            Watched::Volume => CurveKind::Volume,
            Watched::Edge => CurveKind::Edge,
        },
    });
    let outputs = facts.outputs.iter().map(|output| OutputInfo {
        name: word(&output.name),
        unit: word(&output.unit),
    });
    let parameters = facts.parameters.iter().map(|parameter| ParameterInfo {
        name: word(&parameter.name),
        unit: word(&parameter.unit),
        default: parameter.default,
        min: parameter.min,
        max: parameter.max,
        input: parameter.input,
    });
    Info {
        name: word(&facts.name),
        digest: word(&facts.digest),
        dimension: facts.dimension,
        coordinates: words(&facts.coordinates),
        velocities: words(&facts.velocities),
        kinds: list(facts.kinds.iter().map(|&of| kind(of))),
        units: words(&facts.units),
        auxiliaries: words(&facts.auxiliaries),
        memory: words(&facts.memory),
        event_functions: words(&facts.event_functions),
        kinks: words(&facts.kinks),
        onsets: words(&facts.onsets),
        corners: facts.corners,
        longest_step: facts.longest_step,
        powers: words(&facts.powers),
        curves: list(curves),
        time_ends: facts.time_ends,
        pivots: words(&facts.pivots),
        conditions: words(&facts.conditions),
        free: facts.free,
        outputs: list(outputs),
        parameters: list(parameters),
        breakpoints: list(facts.breakpoints.iter().copied()),
        duration: facts.duration,
        every: facts.every,
    }
}

fn word(text: &str) -> &'static str {
    Box::leak(text.into())
}

fn words(texts: &[String]) -> &'static [&'static str] {
    list(texts.iter().map(|text| word(text)))
}

fn list<T>(items: impl Iterator<Item = T>) -> &'static [T] {
    Box::leak(items.collect())
}

fn kind(of: Kind) -> StateKind {
    match of {
        Kind::Position => StateKind::Position,
        Kind::Angle => StateKind::Angle,
        Kind::Velocity => StateKind::Velocity,
        Kind::AngularVelocity => StateKind::AngularVelocity,
        Kind::Law => StateKind::Law,
        Kind::Memory => StateKind::Memory,
    }
}

/// The continuation of a curve beyond its points, as a type of the runtime.
pub fn extrapolate(of: model::Extrapolate) -> Extrapolate {
    match of {
        model::Extrapolate::Linear => Extrapolate::Linear,
        model::Extrapolate::Hold => Extrapolate::Hold,
        model::Extrapolate::Error => Extrapolate::Error,
    }
}
