//! `bryant settle`: finds a state of rest as a start of runs.

mod start_text;
mod supports;

use super::Error;
use super::model_argument::{Found, find};
use super::outputs::{Outputs, Replacing, is_standard};
use super::parameters::{parse_parameters, values_of};
use super::prepare::{Prepared, prepare_model};
use super::progress::{Progress, Whole};
use super::terminal::Terminal;
use crate::scene::with_forces;
use crate::settling::{End, Settled, Wanted, settle};
use crate::signature::{self, ContentKind};
use crate::{files, interrupt, quantity, simulation, state_file};
use bryant_generator::model::{
    Body, Component, ElementId, Model, Output, PointQuantity, Projection, Quantity, Reference,
};
use bryant_runtime::program::{Job, Start};
use bryant_runtime::{Dynamics, Family, Info};
use serde_json::json;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Find a state of rest, in which all forces are in balance, and write it as a state to start runs from
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
The model is let go from its start, and stopped wherever its kinetic energy has passed a maximum, until nothing moves any more. Time stands still: loads that depend
on it are those of t = 0. Nothing is added to the equations. Damping and friction by speed do not act at rest; friction that holds, permanent sets and other memory
have the values that they took on the way to rest. Reference joints keep their velocities, as those of an occupant who moves along with a car, and nothing moves
relative to them; angular velocities are not kept.

In a state of rest every centre of gravity accelerates by at most 0.001 g, or as --residual says, and a slight push does not move the model away. If there is no such
state, or if a system rests further from its start than --distance, the exit code is 3 and nothing is written.

Examples:
  bryant settle my.yaml -o rest.json
  bryant run my.yaml --start rest.json
  bryant settle my.yaml --yaml                       the same as `start:` of its systems, in the words of a model")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// Write the state to this file, for `bryant run --start`, instead of to standard output
    #[arg(long, short, alias = "output", value_name = "STATE.json")]
    out: Option<PathBuf>,

    /// Value of a parameter of the model, with its unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// Acceleration that may remain in a state of rest, in parts of the acceleration of gravity
    #[arg(long, value_name = "SHARE", default_value_t = 1e-3, value_parser = share, allow_hyphen_values = true)]
    residual: f64,

    /// How far the root of a free system may rest from where it starts, by its centre of gravity: who sits nearly right
    /// is moved by centimetres, and who slides off by metres
    #[arg(long, value_name = "LENGTH", default_value = "0.3 m", value_parser = distance, allow_hyphen_values = true)]
    distance: f64,

    /// Write the systems' `start:` in the words of a model, instead of a state
    #[arg(long)]
    yaml: bool,

    /// Largest number of evaluations of the equations
    #[arg(long, value_name = "COUNT", default_value_t = 5_000_000, value_parser = clap::value_parser!(u64).range(1..))]
    evaluations: u64,

    /// Print the forces that carry the model as JSON
    #[arg(long, requires = "out")]
    json: bool,

    #[command(flatten)]
    replacing: Replacing,
}

/// Standard gravity \[m/s²\].
pub(super) use bryant_runtime::response::STANDARD_GRAVITY;
const G: f64 = STANDARD_GRAVITY;

fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (1e-9..=0.01).contains(&share) => Ok(share),
        _ => Err("give a number from 1e-9 to 0.01".to_owned()),
    }
}

/// Reads a length, or off.
fn distance(text: &str) -> Result<f64, String> {
    match text {
        "off" => Ok(f64::INFINITY),
        text => match quantity::quantity(text, "m") {
            Ok(length) if length > 0.0 => Ok(length),
            Ok(_) => Err("give a length above 0, or off".to_owned()),
            Err(error) => Err(format!("{error}, or off")),
        },
    }
}

/// A body that has gone this many times the allowed distance before it rests will not return.
const LOST: f64 = 2.0;

impl Arguments {
    /// Searches the state of rest and writes it.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        found.tell(terminal);
        if let Some(path) = &self.out {
            let mut outputs = Outputs::of(&found.files, self.replacing);
            let kind = match self.yaml {
                true => ContentKind::Model,
                false => ContentKind::State,
            };
            outputs.take("--out", path, kind)?;
        }
        let values = values_of(&found.model, &self.set_values(&found)?);
        let watched = Watched::new(&found.model);
        let engine = prepare_model(&found, &watched.model, terminal)?;
        let mut model = Family::over::<f64>(&*engine);
        model.set_parameters(&values);
        if let Some(condition) = model.violated() {
            return Err(Error::Input(format!(
                "a parameter cannot have this value: {}",
                engine.info().conditions[condition]
            )));
        }
        let mut start = vec![0.0; engine.info().state_length()];
        model.initial_state(&mut start);
        let progress = Progress::new(terminal, "settling".to_owned(), Whole::Unknown);
        let wanted = Wanted {
            acceleration: self.residual * G,
            evaluations: self.evaluations,
        };
        // the largest force of each contact, belt, spring and bushing during the search
        let mut carried: Vec<(String, f64)> = Vec::new();
        let settled = settle(
            &*model,
            0.0,
            &start,
            wanted,
            &mut |state| {
                let outputs = watched.outputs(&*model, 0.0, state);
                for (name, force) in watched.rests_on(&outputs) {
                    match carried.iter_mut().find(|(one, _)| *one == name) {
                        Some((_, most)) => *most = most.max(force),
                        None => carried.push((name, force)),
                    }
                }
                let near = watched.distance(&outputs, true).0 <= LOST * self.distance;
                (watched.acceleration(&outputs).0, near)
            },
            &mut |_, _| !interrupt::asked(),
        );
        drop(progress);
        engine.check()?;
        if interrupt::asked() {
            return Err(Error::Interrupted(
                "the model does not rest yet, and nothing was written".to_owned(),
            ));
        }
        let outputs = watched.outputs(&*model, 0.0, &settled.state);
        let (_, worst) = watched.acceleration(&outputs);
        let rests = watched.rests_on(&outputs);
        let found_at = EndPosition {
            farthest: watched.distance(&outputs, true),
            allowed: self.distance,
            reasons: supports::reasons(&found.model, engine.info(), &settled.state, &carried),
        };
        refuse(&settled, worst, &found_at)?;
        doubt(&engine, &self.set_values(&found)?, &settled)?;
        self.write(&found, &values, &settled, engine.info(), terminal)?;
        let farthest = watched.distance(&outputs, false);
        if self.json {
            let forces: Vec<_> = rests
                .iter()
                .map(|(name, force)| json!({ "force": name, "newton": force }))
                .collect();
            return terminal.print_json(&json!({
                "acceleration": settled.acceleration,
                "of": worst,
                "stops": settled.stops,
                "farthest_m": farthest.0,
                "farthest_of": farthest.1,
                "rests_on": forces,
            }));
        }
        for line in text(&settled, worst, farthest, &rests).lines() {
            match &self.out {
                Some(path) if !is_standard(path) => terminal.print(&format!("{line}\n"))?,
                // standard output has the state, so this line goes to standard error
                _ => terminal.note(line),
            }
        }
        Ok(())
    }

    fn set_values(&self, found: &Found) -> Result<Vec<(String, f64)>, Error> {
        parse_parameters(&self.set, &found.scene)
    }

    fn write(
        &self,
        found: &Found,
        values: &[f64],
        settled: &Settled,
        info: &Info<'_>,
        terminal: &mut Terminal,
    ) -> Result<(), Error> {
        let state = match self.yaml {
            true => start_text::start(&found.model, info, values, &settled.state)
                .map(|text| signature::signed(&text))
                .map_err(Error::failed)?,
            false => state_file::of_state(&found.model.name, info, 0.0, &settled.state),
        };
        match &self.out {
            Some(path) if !is_standard(path) => {
                files::replace(path, |out| out.write_all(state.as_bytes())).map_err(Error::system)
            }
            _ => terminal.print(&state),
        }
    }
}

/// Length of the run that checks a state of rest \[s\].
const LOOKED: f64 = 1e-4;

/// Fails if a run that starts at this state cannot be trusted, because something is wrong there, such as a curve that
/// is exceeded.
fn doubt(engine: &Prepared, set: &[(String, f64)], settled: &Settled) -> Result<(), Error> {
    let job = Job {
        duration: Some(LOOKED),
        every: Some(LOOKED),
        parameters: set.to_vec(),
        start: Some(Start {
            t: 0.0,
            state: settled.state.clone(),
        }),
        ..Job::default()
    };
    let recording = simulation::run(&**engine, &job, &mut |_| {});
    if let Err(error) = &recording.result {
        return Err(Error::failed(format!(
            "the model rests, but no run can start there: {}",
            error.message
        )));
    }
    let reasons: Vec<String> = recording
        .doubts
        .iter()
        .map(|doubt| format!("  {}\n  help: {}", doubt.message, doubt.remedy))
        .collect();
    match reasons.is_empty() {
        true => Ok(()),
        false => Err(Error::failed(format!(
            "the model rests, but where it cannot be trusted:\n{}",
            reasons.join("\n")
        ))),
    }
}

/// The position at the end of the search.
struct EndPosition<'a> {
    /// The largest distance of a centre of gravity from its start \[m\], and its element.
    farthest: (f64, &'a str),
    /// The largest distance that is allowed \[m\].
    allowed: f64,
    /// The likely reasons if the model has no state of rest.
    reasons: Vec<String>,
}

impl EndPosition<'_> {
    /// The likely reasons as lines behind a message.
    fn reasons(&self) -> String {
        let lines = self.reasons.iter().map(|reason| format!("\n  {reason}"));
        lines.collect()
    }
}

/// Fails if the search found no state of rest, and says why.
fn refuse(settled: &Settled, worst: &str, place: &EndPosition<'_>) -> Result<(), Error> {
    let g = settled.acceleration / G;
    let (far, element) = place.farthest;
    let allowed = place.allowed;
    match settled.end {
        End::Rest if far > allowed => Err(Error::failed(format!(
            "\"{element}\" rests {far:.2} m from its start: is this what you want?{}\n  \
             help: look at where it lies (`bryant run` from a start without --start shows its way); --distance says how far it may go (here {allowed} m), or off",
            place.reasons()
        ))),
        End::Lost => Err(Error::failed(format!(
            "the model does not come to rest near its start: after {} stops \"{element}\" is {far:.2} m from there, and \"{worst}\" still has {g:.3} g{}\n  \
             help: `bryant run` shows where it goes; let something hold it, or give a larger --distance (here {allowed} m), or off",
            settled.stops,
            place.reasons()
        ))),
        End::Rest => Ok(()),
        End::Unstable => Err(Error::failed(
            "the model is in balance, but the balance is unstable: a slight push moves it away\n  help: let it start beside that place, or add something that holds it".to_owned(),
        )),
        End::Moving => Err(Error::failed(format!(
            "the model does not come to rest: after {} stops the centre of gravity of \"{worst}\" still has {g:.3} g, and \"{element}\" is {far:.2} m from its start{}\n  \
             help: look at what does not carry it (`bryant run` shows where it goes), or allow more --evaluations or --residual",
            settled.stops,
            place.reasons()
        ))),
        End::NotFinite => Err(Error::failed(
            "the numbers of the model are no longer finite on its way to rest\n  help: `bryant run` shows where it goes".to_owned(),
        )),
    }
}

fn text(
    settled: &Settled,
    worst: &str,
    (far, element): (f64, &str),
    rests: &[(String, f64)],
) -> String {
    let mut text = format!(
        "rests after {} stops; the largest remaining acceleration is {:.1e} g, that of \"{worst}\"; farthest from its start is \"{element}\", {far:.3} m\n",
        settled.stops,
        settled.acceleration / G
    );
    let width = rests
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    for (name, force) in rests {
        let _ = writeln!(text, "  {name:width$}  {force:>8.1} N");
    }
    if rests.is_empty() {
        text.push_str("  no contact, belt, spring or bushing carries it\n");
    }
    text
}

/// The model with additional outputs, which the search and its result need.
pub(super) struct Watched {
    pub model: Model,
    /// Number of outputs of the model itself.
    own: usize,
    /// Names of contacts, belts, springs and bushings, each with the index of the first of its three outputs.
    forces: Vec<(String, usize)>,
    /// The index of the first output for elements, and the names of the elements. Each has two outputs: its
    /// acceleration, and its distance from the start.
    elements: (usize, Vec<String>),
    /// For each element true if it is the root of a free system.
    roots: Vec<bool>,
}

impl Watched {
    /// The model with outputs for each force and each element.
    pub fn new(model: &Model) -> Self {
        let own = model.outputs.len();
        let mut watched = with_forces(model);
        let mut forces = Vec::new();
        for (index, output) in watched.outputs.iter().enumerate().skip(own) {
            // the components y and z follow x
            let is_first = |projection: &Projection| projection.component == Component::X;
            match &output.quantity {
                Quantity::ForceOn {
                    force, projection, ..
                } if is_first(projection) => {
                    forces.push((model.forces[*force].name.clone(), index));
                }
                Quantity::ForceOnPoints {
                    force,
                    points,
                    projection,
                } if is_first(projection) => {
                    let name = &model.forces[*force].name;
                    forces.push((format!("{name}, segment {}", points.len()), index));
                }
                _ => {}
            }
        }
        let first_element = watched.outputs.len();
        let mut add = |name: String, body: Body, at: _, what: PointQuantity| {
            watched.outputs.push(Output {
                name: format!("{name} at rest: {what:?}"),
                quantity: Quantity::Point {
                    body,
                    at,
                    what,
                    relative_to: Body::Frame,
                    projection: Projection::absolute(Component::Resultant),
                },
                unit: String::new(),
                code: None,
                filter: None,
                channel: None,
            });
        };
        let (mut elements, mut roots) = (Vec::new(), Vec::new());
        for (s, system) in model.systems.iter().enumerate() {
            for (e, element) in system.elements.iter().enumerate() {
                let id = ElementId {
                    system: s,
                    element: e,
                };
                let name = format!("{}/{}", system.name, element.name);
                for what in [PointQuantity::Acceleration, PointQuantity::Displacement] {
                    add(name.clone(), Body::Element(id), element.cg.clone(), what);
                }
                elements.push(name);
                let free = matches!(system.reference, Reference::Free);
                roots.push(free && element.parent.is_none());
            }
        }
        Watched {
            model: watched,
            own,
            forces,
            elements: (first_element, elements),
            roots,
        }
    }

    /// All outputs at a time \[s\] and a state.
    pub fn outputs(
        &self,
        model: &(impl Dynamics<f64> + ?Sized),
        t: f64,
        state: &[f64],
    ) -> Vec<f64> {
        let mut outputs = vec![0.0; self.model.outputs.len()];
        model.outputs(t, state, &mut outputs);
        outputs
    }

    /// Those that a scene with forces asks for.
    pub fn of_scene<'a>(&self, outputs: &'a [f64]) -> &'a [f64] {
        &outputs[self.own..self.elements.0]
    }

    /// The largest acceleration of a centre of gravity \[m/s²\], and the name of its element.
    pub fn acceleration(&self, outputs: &[f64]) -> (f64, &str) {
        let (first, names) = &self.elements;
        let mut worst = (0.0, names.first().map_or("", String::as_str));
        for (value, name) in outputs[*first..].iter().step_by(2).zip(names) {
            // NaN counts as infinite
            if value.is_nan() || *value > worst.0 {
                worst = (
                    if value.is_nan() {
                        f64::INFINITY
                    } else {
                        *value
                    },
                    name,
                );
            }
        }
        worst
    }

    /// The largest distance of a centre of gravity from its start \[m\], and the name of its element: of all elements,
    /// or only `of_roots` of free systems, because arms and legs move farther.
    fn distance(&self, outputs: &[f64], of_roots: bool) -> (f64, &str) {
        let (first, names) = &self.elements;
        let mut farthest = (0.0, names.first().map_or("", String::as_str));
        let distances = outputs[*first..].iter().skip(1).step_by(2);
        for ((value, name), root) in distances.zip(names).zip(&self.roots) {
            if *value > farthest.0 && (*root || !of_roots) {
                farthest = (*value, name);
            }
        }
        farthest
    }

    /// Names of the contacts, belts, springs and bushings that carry load, with their forces \[N\].
    fn rests_on(&self, outputs: &[f64]) -> Vec<(String, f64)> {
        let force = |first: usize| {
            outputs[first..first + 3]
                .iter()
                .map(|f| f * f)
                .sum::<f64>()
                .sqrt()
        };
        let all = self
            .forces
            .iter()
            .map(|(name, first)| (name.clone(), force(*first)));
        all.filter(|(_, force)| *force > 0.0).collect()
    }
}
