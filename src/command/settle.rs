//! `bryant settle`: a state of rest to start from.

use super::Error;
use super::model_argument::{Found, find};
use super::outputs::{Outputs, Replacing, is_standard};
use super::parameters::{parse_parameters, values_of};
use super::prepare::{Prepared, prepare_model};
use super::progress::{Progress, Whole};
use super::terminal::Terminal;
use crate::own::Kind;
use crate::report::with_forces;
use crate::settling::{End, Settled, Wanted, settle};
use crate::{files, interrupt, simulation, state_file};
use bryant_generator::model::{
    Body, Component, ElementId, Model, Output, PointQuantity, Projection, Quantity,
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
state, the exit code is 3 and nothing is written.

Examples:
  bryant settle my.yaml -o rest.json
  bryant run my.yaml --start rest.json")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// Write the state to this file, for `bryant run --start`, instead of to standard output
    #[arg(short, long, value_name = "STATE.json")]
    output: Option<PathBuf>,

    /// Value of a parameter of the model, with its unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// Acceleration that may remain in a state of rest, in parts of the acceleration of gravity
    #[arg(long, value_name = "SHARE", default_value_t = 1e-3, value_parser = share, allow_hyphen_values = true)]
    residual: f64,

    /// Largest number of evaluations of the equations
    #[arg(long, value_name = "COUNT", default_value_t = 5_000_000, value_parser = clap::value_parser!(u64).range(1..))]
    evaluations: u64,

    /// Print the forces that carry the model as JSON
    #[arg(long, requires = "output")]
    json: bool,

    #[command(flatten)]
    replacing: Replacing,
}

/// Standard gravity \[m/s²\].
const G: f64 = bryant_runtime::response::STANDARD_GRAVITY;

fn share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(share) if (1e-9..=0.01).contains(&share) => Ok(share),
        _ => Err("give a number from 1e-9 to 0.01".to_owned()),
    }
}

impl Arguments {
    /// Searches the state of rest and writes it.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        found.tell(terminal);
        if let Some(path) = &self.output {
            let mut outputs = Outputs::of(&found.files, self.replacing);
            outputs.take("--output", path, Kind::State)?;
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
        let settled = settle(
            &*model,
            0.0,
            &start,
            wanted,
            &mut |state| watched.acceleration(&watched.outputs(&*model, state)).0,
            &mut |_, _| !interrupt::asked(),
        );
        drop(progress);
        engine.check()?;
        if interrupt::asked() {
            return Err(Error::Interrupted(
                "the model does not rest yet, and nothing was written".to_owned(),
            ));
        }
        let outputs = watched.outputs(&*model, &settled.state);
        let (_, worst) = watched.acceleration(&outputs);
        refuse(&settled, worst)?;
        doubt(&engine, &self.set_values(&found)?, &settled)?;
        self.write(&found, &settled, engine.info(), terminal)?;
        let rests = watched.rests_on(&outputs);
        if self.json {
            let forces: Vec<_> = rests
                .iter()
                .map(|(name, force)| json!({ "force": name, "newton": force }))
                .collect();
            return terminal.print_json(&json!({
                "acceleration": settled.acceleration,
                "of": worst,
                "stops": settled.stops,
                "rests_on": forces,
            }));
        }
        for line in text(&settled, worst, &rests).lines() {
            match &self.output {
                Some(path) if !is_standard(path) => terminal.print(&format!("{line}\n"))?,
                // the state goes to standard output, so the line goes to standard error
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
        settled: &Settled,
        info: &Info,
        terminal: &mut Terminal,
    ) -> Result<(), Error> {
        let state = state_file::of_state(&found.model.name, info, 0.0, &settled.state);
        match &self.output {
            Some(path) if !is_standard(path) => {
                files::replace(path, |out| out.write_all(state.as_bytes())).map_err(Error::system)
            }
            _ => terminal.print(&state),
        }
    }
}

/// A run from the state is examined for this time \[s\].
const LOOKED: f64 = 1e-4;

/// Fails if a run that starts there cannot be trusted, because something is wrong with the position, such as a curve that is exceeded.
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

/// The reason why there is no state of rest, if there is none.
fn refuse(settled: &Settled, worst: &str) -> Result<(), Error> {
    let g = settled.acceleration / G;
    match settled.end {
        End::Rest => Ok(()),
        End::Unstable => Err(Error::failed(
            "the model is in balance, but the balance is unstable: a slight push moves it away\n  help: let it start beside that place, or add something that holds it".to_owned(),
        )),
        End::Moving => Err(Error::failed(format!(
            "the model does not come to rest: after {} stops the centre of gravity of \"{worst}\" still has {g:.3} g\n  \
             help: look at what does not carry it (`bryant run` shows where it goes), or allow more --evaluations or --residual",
            settled.stops
        ))),
        End::NotFinite => Err(Error::failed(
            "the numbers of the model are no longer finite on its way to rest\n  help: `bryant run` shows where it goes".to_owned(),
        )),
    }
}

fn text(settled: &Settled, worst: &str, rests: &[(String, f64)]) -> String {
    let mut text = format!(
        "rests after {} stops; the largest remaining acceleration is {:.1e} g, that of \"{worst}\"\n",
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

/// The model with outputs for the quantities of interest.
struct Watched {
    model: Model,
    /// Contacts, belts, springs and bushings by name, and the index of the first of three outputs of each.
    forces: Vec<(String, usize)>,
    /// Elements by name, and the index of the output of the first.
    elements: (usize, Vec<String>),
}

impl Watched {
    fn new(model: &Model) -> Self {
        let own = model.outputs.len();
        let mut watched = with_forces(model);
        let mut forces = Vec::new();
        for (index, output) in watched.outputs.iter().enumerate().skip(own).step_by(3) {
            match &output.quantity {
                Quantity::ForceOn { force, .. } => {
                    forces.push((model.forces[*force].name.clone(), index));
                }
                Quantity::ForceOnPoints { force, points, .. } => {
                    let name = &model.forces[*force].name;
                    forces.push((format!("{name}, segment {}", points.len()), index));
                }
                _ => {}
            }
        }
        let mut add = |name: String, body: Body, at: _, what: PointQuantity| {
            watched.outputs.push(Output {
                name: format!("{name} at rest"),
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
        let first_element = own + 3 * forces.len();
        let mut elements = Vec::new();
        for (s, system) in model.systems.iter().enumerate() {
            for (e, element) in system.elements.iter().enumerate() {
                let id = ElementId {
                    system: s,
                    element: e,
                };
                let name = format!("{}/{}", system.name, element.name);
                add(
                    name.clone(),
                    Body::Element(id),
                    element.cg.clone(),
                    PointQuantity::Acceleration,
                );
                elements.push(name);
            }
        }
        Watched {
            model: watched,
            forces,
            elements: (first_element, elements),
        }
    }

    fn outputs(&self, model: &(impl Dynamics<f64> + ?Sized), state: &[f64]) -> Vec<f64> {
        let mut outputs = vec![0.0; self.model.outputs.len()];
        model.outputs(0.0, state, &mut outputs);
        outputs
    }

    /// The largest acceleration of a centre of gravity \[m/s²\], and the name of its element.
    fn acceleration(&self, outputs: &[f64]) -> (f64, &str) {
        let (first, names) = &self.elements;
        let mut worst = (0.0, names.first().map_or("", String::as_str));
        for (value, name) in outputs[*first..].iter().zip(names) {
            // NaN is not rest
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

    /// Contacts, belts, springs and bushings that carry load, with their forces \[N\].
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
