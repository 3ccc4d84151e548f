//! The facts of a model in the form of the runtime.

use bryant_generator::equations::Watched;
use bryant_generator::model;
use bryant_generator::program::{self, Facts};
use bryant_runtime::curve::Extrapolate;
use bryant_runtime::{CurveInfo, CurveKind, Info, OutputInfo, ParameterInfo, StateKind};
use std::sync::Arc;

/// The facts of a model, and the [`Info`] that borrows them.
#[derive(Debug)]
pub struct OwnedInfo {
    /// It borrows from the fields behind it, so its lifetime is theirs: only [`OwnedInfo::get`] reads it.
    info: Info<'static>,
    _lists: Arc<Lists<'static>>,
    _facts: Arc<Facts>,
}

impl OwnedInfo {
    /// A copy of these facts.
    #[expect(unsafe_code, reason = "the parts of one value borrow from each other")]
    pub fn new(facts: &Facts) -> Self {
        let facts = Arc::new(facts.clone());
        // SAFETY, here and below: What an `Arc` refers to stays in its place and is not changed while the `Arc` lives,
        // wherever that moves. Both live as long as the owner, which drops what borrows before what is borrowed. The
        // `Info` leaves the owner by `get` alone, which shortens all lifetimes in it to a borrow of the owner.
        let of: &'static Facts = unsafe { &*Arc::as_ptr(&facts) };
        let lists = Arc::new(Lists::of(of));
        let all: &'static Lists<'static> = unsafe { &*Arc::as_ptr(&lists) };
        OwnedInfo {
            info: all.info(of),
            _lists: lists,
            _facts: facts,
        }
    }

    /// The facts.
    pub fn get(&self) -> &Info<'_> {
        &self.info
    }
}

/// The lists of an [`Info`], whose texts are those of the facts.
#[derive(Debug)]
struct Lists<'a> {
    /// The lists of names, in the order of [`Lists::of`].
    texts: [Vec<&'a str>; 11],
    kinds: Vec<StateKind>,
    curves: Vec<CurveInfo<'a>>,
    outputs: Vec<OutputInfo<'a>>,
    parameters: Vec<ParameterInfo<'a>>,
}

impl<'a> Lists<'a> {
    fn of(facts: &'a Facts) -> Self {
        let texts = [
            &facts.coordinates,
            &facts.velocities,
            &facts.units,
            &facts.auxiliaries,
            &facts.memory,
            &facts.event_functions,
            &facts.kinks,
            &facts.onsets,
            &facts.powers,
            &facts.pivots,
            &facts.conditions,
        ];
        let curves = facts.curves.iter().map(|curve| CurveInfo {
            name: &curve.name,
            unit: &curve.unit,
            first: curve.range[0],
            last: curve.range[1],
            ends: curve.ends,
            extrapolate: extrapolate(curve.extrapolate),
            told: curve.states_extrapolation,
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
            name: &output.name,
            unit: &output.unit,
        });
        let parameters = facts.parameters.iter().map(|parameter| ParameterInfo {
            name: &parameter.name,
            unit: &parameter.unit,
            default: parameter.default,
            min: parameter.min,
            max: parameter.max,
            input: parameter.input,
        });
        Lists {
            texts: texts.map(|names| names.iter().map(String::as_str).collect()),
            kinds: facts.kinds.iter().map(|&of| kind(of)).collect(),
            curves: curves.collect(),
            outputs: outputs.collect(),
            parameters: parameters.collect(),
        }
    }

    /// All facts; `facts` are those of which the lists are.
    fn info(&'a self, facts: &'a Facts) -> Info<'a> {
        let [
            coordinates,
            velocities,
            units,
            auxiliaries,
            memory,
            event_functions,
            kinks,
            onsets,
            powers,
            pivots,
            conditions,
        ] = &self.texts;
        Info {
            name: &facts.name,
            digest: &facts.digest,
            dimension: facts.dimension,
            coordinates,
            velocities,
            kinds: &self.kinds,
            units,
            auxiliaries,
            memory,
            event_functions,
            kinks,
            onsets,
            corners: facts.corners,
            longest_step: facts.longest_step,
            powers,
            curves: &self.curves,
            time_ends: facts.time_ends,
            pivots,
            conditions,
            free: facts.free,
            outputs: &self.outputs,
            parameters: &self.parameters,
            breakpoints: &facts.breakpoints,
            duration: facts.duration,
            every: facts.every,
        }
    }
}

fn kind(of: program::StateKind) -> StateKind {
    match of {
        program::StateKind::Position => StateKind::Position,
        program::StateKind::Angle => StateKind::Angle,
        program::StateKind::Velocity => StateKind::Velocity,
        program::StateKind::AngularVelocity => StateKind::AngularVelocity,
        program::StateKind::Law => StateKind::Law,
        program::StateKind::Memory => StateKind::Memory,
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
