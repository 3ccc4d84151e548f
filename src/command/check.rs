//! `bryant check`: prints what a model contains, or all problems in it.

use super::Error;
use super::caution::cautions;
use super::model_argument::{find, find_without_sources, nearest};
use super::progress::Progress;
use super::terminal::Terminal;
use crate::units::{self, TIME, short};
use bryant_generator::dynamics::{self, derive_with};
use bryant_generator::equations::Route;
use bryant_generator::expression::count::Count;
use bryant_generator::law::ForceKind;
use bryant_generator::model::annotated_model::AnnotatedModel;
use bryant_generator::model::units::UnitSystem;
use bryant_generator::model::{Coordinates, Dimension, Model, Parameter, Reference, System};
use bryant_generator::program::{self, Options};
use bryant_generator::target::rust;
use bryant_picture::text::typeset;
use bryant_study::criteria::limits::Limits;
use bryant_study::criteria::{Judged, Missing, judge};
use bryant_study::facts::ModelFacts;
use clap::Args;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Read a model and say what is in it, or report everything that is wrong with it
#[derive(Debug, Args)]
#[command(after_long_help = "\
Nothing is compiled. The operations are those of one evaluation of the equations; sines, cosines and curves are not
counted among them and are listed beside.

Examples:
  bryant check my.yaml
  bryant check my.yaml --long                        what its lists, mirror images and instances stand for
  bryant check my.yaml --skeleton drag > drag.rs     the function of a user force, to be filled in
  bryant check child-seat --json")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// Print a first Rust file for this user force, whose file need not exist yet
    #[arg(long, value_name = "FORCE", conflicts_with = "json")]
    skeleton: Option<String>,

    /// Print the model in its long form: one file, lists, mirror images, named surfaces and instances written out
    #[arg(long, conflicts_with_all = ["json", "skeleton"])]
    long: bool,

    /// Print JSON
    #[arg(long)]
    json: bool,

    /// Units of parameters, outputs and times: SI, or engineering (mm, g, kN, °, kPa, ms) [default: as the model says]
    #[arg(long, value_name = "SYSTEM", value_parser = units::system())]
    units: Option<UnitSystem>,
}

impl Arguments {
    /// Reads the model and reports.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        if let Some(force) = &self.skeleton {
            return terminal.print(&skeleton(&find_without_sources(&self.model)?, force)?);
        }
        let mut found = find(&self.model)?;
        found.show_in(self.units);
        found.tell(terminal);
        if self.long {
            return terminal.print(&found.scene.long_form);
        }
        let facts = ModelFacts::of(&found.scene);
        let judged = facts.criteria.as_ref().map(|asked| judge(&facts, asked));
        let judged = judged.transpose().map_err(Error::Input)?;
        let progress = Progress::deriving(terminal, &found.model.name);
        let costs = Costs::of(&found.model);
        drop(progress);
        for caution in cautions(&found.scene) {
            terminal.note(&format!("warning: {caution}"));
        }
        for caution in judged
            .iter()
            .flat_map(|(limits, all)| unjudged(limits, all))
        {
            terminal.note(&caution);
        }
        if self.json {
            terminal.print_json(&as_json(&found.scene, &costs))
        } else {
            terminal.print(&as_text(&found.model, &costs))
        }
    }
}

/// A sentence that names the criteria that cannot be computed; `None` if there are none.
fn unjudged(limits: &Limits, all: &[Judged]) -> Option<String> {
    let missing = all.iter().filter_map(|one| match &one.response {
        Err(Missing::Place(place)) => Some(format!("{} ({place})", one.criterion.name)),
        _ => None,
    });
    let missing: Vec<String> = missing.collect();
    let (standard, dummy) = (&limits.standard, &limits.dummy);
    (!missing.is_empty()).then(|| {
        format!(
            "criteria of {standard} for {dummy} have no output, so they are not judged: {}",
            missing.join(", ")
        )
    })
}

/// The Rust text that `--skeleton` prints.
fn skeleton(model: &Model, force: &str) -> Result<String, Error> {
    rust::skeleton(model, force).ok_or_else(|| {
        let all = model.forces.iter();
        let users = all.filter(|f| matches!(ForceKind::of(f), ForceKind::User(_)));
        let names: Vec<&str> = users.map(|f| f.name.as_str()).collect();
        let help = match (nearest(force, &names), names.is_empty()) {
            (Some(near), _) => format!("did you mean \"{near}\"?"),
            (None, false) => format!("there are: {}", names.join(", ")),
            (None, true) => "add a force `- user: NAME`; see docs/forces/user.md".to_owned(),
        };
        let force = force.escape_debug();
        Error::Input(format!(
            "there is no user force \"{force}\" in this model\n  help: {help}"
        ))
    })
}

/// Number of velocities of a model.
pub fn freedoms(model: &Model) -> usize {
    model
        .systems
        .iter()
        .map(|system| system_freedoms(model, system))
        .sum()
}

fn system_freedoms(model: &Model, system: &System) -> usize {
    let reference = match (&system.reference, model.dimension) {
        (Reference::Free, Dimension::Plane) => 2,
        (Reference::Free, Dimension::Space) => 3,
        (Reference::Fixed | Reference::Prescribed(_) | Reference::Riding { .. }, _) => 0,
    };
    let elements = system.elements.iter();
    let joints = elements.map(|element| element.joint.velocities(model.dimension));
    reference + joints.sum::<usize>()
}

/// The operations of the generated methods. Those of the outputs include the accelerations if outputs need them.
struct Costs {
    route: Route,
    accelerations: Count,
    outputs: Count,
}

impl Costs {
    fn of(model: &Model) -> Self {
        let options = dynamics::Options {
            matrices: false,
            ..dynamics::Options::default()
        };
        let equations = derive_with(model, options);
        let emitted = Options {
            matrices: false,
            ..Options::default()
        };
        let wanted = ["accelerations", "outputs"];
        let costs = program::costs_of(model, &equations, &emitted, Some(&wanted));
        let of = |method: &str| {
            let found = costs.iter().find(|(name, _)| *name == method);
            found.map_or_else(Count::default, |(_, table)| table.total.clone())
        };
        Costs {
            route: equations.route,
            accelerations: of("accelerations"),
            outputs: of("outputs"),
        }
    }
}

fn route(route: Route) -> &'static str {
    match route {
        Route::Elimination => "by elimination",
        Route::MassMatrix => "by factorising S",
    }
}

fn reference(reference: &Reference) -> &'static str {
    match reference {
        Reference::Free => "free",
        Reference::Fixed => "fixed",
        Reference::Prescribed(_) => "prescribed",
        Reference::Riding { .. } => "on a vehicle",
    }
}

fn motion(model: &Model) -> &'static str {
    match (model.dimension, model.coordinates) {
        (Dimension::Plane, _) => "in the x–z plane",
        (Dimension::Space, Coordinates::Quaternion) => "in space, orientations as quaternions",
        (Dimension::Space, Coordinates::Bryant) => "in space, orientations as Bryant angles",
    }
}

/// "1 element", "2 elements"
fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn as_text(model: &Model, costs: &Costs) -> String {
    let mut text = model.name.clone();
    if !model.title.is_empty() {
        let _ = write!(text, ": {}", model.title);
    }
    let _ = writeln!(text, "\n  motion      {}", motion(model));
    for vehicle in &model.vehicles {
        let _ = writeln!(text, "  vehicle     {}", vehicle.name);
    }
    for system in &model.systems {
        let _ = writeln!(
            text,
            "  system      {}: {}, {}, reference joint {}",
            system.name,
            counted(system.elements.len(), "element"),
            counted(system_freedoms(model, system), "freedom"),
            reference(&system.reference)
        );
        for (index, element) in system.elements.iter().enumerate() {
            let mass = element.mass.value(&defaults(model));
            let _ = writeln!(
                text,
                "              {}{} {} kg{}",
                indent(system, index),
                element.name,
                short(mass),
                following(system, index)
            );
        }
    }
    for force in &model.forces {
        let _ = writeln!(text, "  {:11} {}", force.law.key(), force.name);
    }
    if model.forces.is_empty() {
        text.push_str("  forces      none\n");
    }
    for switch in &model.switches {
        let _ = writeln!(text, "  switch      {}", switch.name);
    }
    for parameter in &model.parameters {
        let _ = writeln!(
            text,
            "  {:<11} {}",
            if parameter.input {
                "input"
            } else {
                "parameter"
            },
            describe(parameter, model.units.system)
        );
    }
    for output in &model.outputs {
        let unit = match model.unit_of(output).name.as_str() {
            "" => "-".to_owned(),
            unit => typeset(unit),
        };
        let _ = writeln!(text, "  output      {} [{unit}]", output.name);
    }
    if model.outputs.is_empty() {
        text.push_str("  outputs     none\n");
    }
    let time = model.units.system.unit(TIME);
    let times = [model.run.duration, model.run.every].map(|si| short(time.of_si(si)));
    let _ = writeln!(
        text,
        "  run         {} {unit}, a row every {} {unit}",
        times[0],
        times[1],
        unit = time.name
    );
    let _ = writeln!(
        text,
        "  operations  accelerations {} ({}), outputs {}",
        operations(&costs.accelerations),
        route(costs.route),
        operations(&costs.outputs)
    );
    text
}

fn defaults(model: &Model) -> Vec<f64> {
    model.parameters.iter().map(|p| p.default).collect()
}

/// The elements whose joints the freedoms of an element follow, as text.
fn following(system: &System, element: usize) -> String {
    let freedoms = system.elements[element].joint.freedoms().iter();
    let leaders = freedoms.filter_map(|freedom| freedom.follows.as_ref());
    let named =
        leaders.map(|follows| format!(", follows {}", system.elements[follows.element].name));
    named.collect()
}

/// The indentation of an element: two spaces for each ancestor.
fn indent(system: &System, mut element: usize) -> String {
    let mut depth = 0;
    while let Some(parent) = system.elements[element].parent {
        depth += 1;
        element = parent;
    }
    "  ".repeat(depth)
}

fn describe(parameter: &Parameter, system: UnitSystem) -> String {
    let shown = system.unit(&parameter.unit);
    let short = |si: f64| short(shown.of_si(si));
    let unit = match shown.name.as_str() {
        "" => String::new(),
        unit => format!(" {}", typeset(unit)),
    };
    let bounds = match (parameter.min, parameter.max) {
        (None, None) => String::new(),
        (Some(min), None) => format!(", at least {}", short(min)),
        (None, Some(max)) => format!(", at most {}", short(max)),
        (Some(min), Some(max)) => format!(", from {} to {}", short(min), short(max)),
    };
    format!(
        "{} = {}{unit}{bounds}",
        parameter.name,
        short(parameter.default)
    )
}

fn operations(count: &Count) -> String {
    let mut text = count.total().to_string();
    let functions = count.sin + count.cos + count.atan2;
    let calls: usize = count.calls.values().sum();
    if functions > 0 {
        let _ = write!(text, " + {functions} sin/cos");
    }
    if calls > 0 {
        let _ = write!(text, " + {}", counted(calls, "call"));
    }
    text
}

fn as_json(scene: &AnnotatedModel, costs: &Costs) -> Value {
    let model = &scene.model;
    let systems: Vec<Value> = model
        .systems
        .iter()
        .map(|system| {
            let elements: Vec<Value> = system
                .elements
                .iter()
                .map(|element| {
                    let parent = element.parent.map(|p| &system.elements[p].name);
                    json!({
                        "name": element.name,
                        "parent": parent,
                        "mass_kg": element.mass.value(&defaults(model)),
                    })
                })
                .collect();
            json!({
                "name": system.name,
                "reference": reference(&system.reference),
                "freedoms": system_freedoms(model, system),
                "elements": elements,
            })
        })
        .collect();
    let forces: Vec<Value> = model
        .forces
        .iter()
        .map(|force| json!({ "kind": force.law.key(), "name": force.name }))
        .collect();
    let switches: Vec<&str> = model.switches.iter().map(|s| s.name.as_str()).collect();
    let parameters: Vec<Value> = model
        .parameters
        .iter()
        .map(|p| {
            let unit = model.units.system.unit(&p.unit);
            let [min, max] = [p.min, p.max].map(|bound| bound.map(|si| unit.of_si(si)));
            json!({ "name": p.name, "default": unit.of_si(p.default), "min": min, "max": max, "unit": unit.name })
        })
        .collect();
    let outputs: Vec<Value> = model
        .outputs
        .iter()
        .map(|o| json!({ "name": o.name, "unit": model.unit_of(o).name }))
        .collect();
    let cost = |count: &Count| {
        json!({
            "operations": count.total(),
            "sin_cos": count.sin + count.cos,
            "calls": count.calls.values().sum::<usize>(),
        })
    };
    json!({
        "model": model.name,
        "title": model.title,
        "digest": model.digest,
        "dimension": if model.dimension == Dimension::Plane { 2 } else { 3 },
        "freedoms": freedoms(model),
        "systems": systems,
        "forces": forces,
        "switches": switches,
        "parameters": parameters,
        "outputs": outputs,
        "run": { "duration_s": model.run.duration, "every_s": model.run.every },
        "accelerations": cost(&costs.accelerations),
        "route": route(costs.route),
        "output_cost": cost(&costs.outputs),
        "warnings": cautions(scene),
    })
}
