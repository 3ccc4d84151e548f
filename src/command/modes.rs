//! `bryant modes`: the small motions of a mechanism about a state of rest.

mod page;

use super::Error;
use super::model_argument::{Found, find};
use super::outputs::{Outputs, Replacing};
use super::parameters::{parse_parameters, values_of};
use super::prepare::prepare_with;
use super::run::{meshes_of, read_start};
use super::settle::{STANDARD_GRAVITY, Watched};
use super::terminal::Terminal;
use crate::modes::{self, Mode, NoModes, Number, hidden};
use crate::process::command_line;
use crate::report;
use crate::table::{Cells, side_by_side};
use bryant_engine::Evaluated;
use bryant_generator::Config;
use bryant_runtime::{Adjustable, Dynamics, Info, StateKind};
use clap::Args;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::path::PathBuf;

/// List the modes of a mechanism about a state of rest: frequencies, damping, shapes
#[derive(Debug, Args)]
#[command(after_long_help = "\
The equations with all their forces are linearised exactly at the state, by dual numbers, and the modes are those of the linear system. Nothing is left out: gyroscopic
terms, damping, states of force laws. A force that holds or begins to act elsewhere counts as it is in this state.

  frequency   |λ|/2π, that of the mode without its damping; a mode that does not oscillate has none
  damping     -Re λ/|λ|, of the critical one; below 0 the mode grows
  time        in which the motion falls, or grows, by a factor of e
  moves       the shares of the kinetic energy, by velocity of the model

--json has the shapes, too: an entry for each coordinate along the motion of its velocity, each velocity, and each state of a force law, as amplitude and
phase in complex numbers; the largest is 1.

Examples:
  bryant modes robot-arm --start rest.json           about the state that `bryant settle robot-arm -o rest.json` found
  bryant modes robot-arm --start rest.json --report modes.html
  bryant modes my.yaml                               about the start of runs, if the model rests there
  bryant modes my.yaml --set stiffness='40 kN/m' --json > modes.json")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// State of rest in this file, which `bryant settle` wrote [default: the start of runs]
    #[arg(long, value_name = "STATE.json")]
    start: Option<PathBuf>,

    /// Value of a parameter of the model, with its unit; may be repeated
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,

    /// List this many modes at most, the slowest
    #[arg(long, value_name = "COUNT", value_parser = clap::value_parser!(u64).range(1..))]
    most: Option<u64>,

    /// Print the modes with their shapes as JSON
    #[arg(long)]
    json: bool,

    /// Write a report: one page of HTML in which the mechanism moves in each of its modes; any browser shows it,
    /// without a network
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,

    #[command(flatten)]
    replacing: Replacing,
}

/// A page has this many modes at most: some megabytes.
const MOST_DRAWN: usize = 100;

/// The acceleration of a centre of gravity up to which a state is one of rest \[m/s²\], as for `bryant settle`; and the
/// angular velocity \[rad/s\].
const AT_REST: (f64, f64) = (1e-3 * STANDARD_GRAVITY, 1e-3);

/// The velocity above which a state of rest is one that moves along \[m/s\].
const MOVING: f64 = 1e-3;

/// A residual above this is worth a warning: half of the digits are gone, and rounding alone leaves far less.
const POOR: f64 = 1e-8;

/// Velocities with smaller shares of the energy are not listed in the table, and no more than so many are.
const SMALL: f64 = 0.05;
const MANY: usize = 4;

/// The function with S, for the shares of the kinetic energy.
const MASS_MATRIX: &str = "mass_matrix";

/// A mode with what people read.
struct Shown<'a> {
    mode: &'a Mode,
    /// Shares of the kinetic energy, largest first, by velocity; for a mode without motion, sizes of states of force
    /// laws.
    shares: Vec<(&'a str, f64)>,
    /// True if it cannot be told from one that does not move.
    free: bool,
}

impl Arguments {
    /// Lists the modes.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        found.tell(terminal);
        if let Some(path) = &self.report {
            let read = found.files.iter().chain(&self.start);
            Outputs::of(read, self.replacing).take_report(path)?;
        }
        let set = parse_parameters(&self.set, &found.scene)?;
        let watched = Watched::new(&found.model);
        let mut config = Config::new();
        config.matrices(false).functions([MASS_MATRIX]);
        let engine = prepare_with(&found, &watched.model, &config, terminal)?;
        let info = engine.info();
        if info.velocities.is_empty() {
            return Err(Error::Input(
                "nothing in the model can move, so it has no modes\n  \
                 help: give an element a joint that moves, or a system the reference joint `free`"
                    .to_owned(),
            ));
        }
        let mut model = engine.over::<f64>();
        let parameters = values_of(&found.model, &set);
        model.set_parameters(&parameters);
        if let Some(condition) = model.violated() {
            return Err(Error::Input(format!(
                "a parameter cannot have this value: {}",
                info.conditions[condition]
            )));
        }
        let (t, state) = match &self.start {
            Some(path) => {
                let read = read_start(path, &found.model, &engine, &set, f64::INFINITY)?;
                read.notes.iter().for_each(|note| terminal.note(note));
                (read.start.t, read.start.state)
            }
            None => {
                let mut state = vec![0.0; info.state_length()];
                model.initial_state(&mut state);
                (0.0, state)
            }
        };
        let outputs = watched.outputs(&model, t, &state);
        self.must_rest(info, &state, watched.acceleration(&outputs))?;
        if let Some(note) = moves_along(info, &state) {
            terminal.note(&note);
        }
        let index = engine.function(MASS_MATRIX).expect("it was asked for");
        let mut mass = vec![0.0; info.velocities.len().pow(2)];
        let none = vec![0.0; info.velocities.len()];
        model.function(index, t, &state, &none, &mut mass);
        let modes = modes_at(&model, t, &state, &mass)?;
        engine.check()?;
        let hidden = hidden(&modes);
        let most = self.most.map_or(usize::MAX, |most| most as usize);
        let shown = modes.iter().take(most).map(|mode| Shown {
            shares: shares(mode, &mass, info),
            free: mode.rate.norm() <= hidden,
            mode,
        });
        let shown: Vec<Shown<'_>> = shown.collect();
        let mut notes = notes(&modes, &shown, hidden);
        if self.json {
            terminal.print_json(&as_json(&found.model.name, t, hidden, &names(info), &shown))?;
        } else {
            terminal.print(&table(&shown, terminal.width()))?;
        }
        if let Some(path) = &self.report {
            let (meshes, about) = meshes_of(&found);
            notes.extend(about);
            let rest = page::Rest {
                model: &found.model,
                dynamics: &model,
                parameters: &parameters,
                t,
                state: &state,
                forces: watched.of_scene(&outputs),
                meshes,
            };
            let page = self.page(&found, &rest, &shown, &notes)?;
            crate::files::replace(path, |out| out.write_all(page.as_bytes()))
                .map_err(Error::system)?;
        }
        notes.iter().for_each(|note| terminal.note(note));
        Ok(())
    }

    /// The page of the modes.
    fn page(
        &self,
        found: &Found,
        rest: &page::Rest<'_>,
        shown: &[Shown<'_>],
        notes: &[String],
    ) -> Result<String, Error> {
        let drawn = &shown[..shown.len().min(MOST_DRAWN)];
        let mut notes = notes.to_vec();
        if drawn.len() < shown.len() {
            notes.push(format!(
                "the page has the slowest {MOST_DRAWN} of {} modes",
                shown.len()
            ));
        }
        let model = &found.model;
        let title = match model.title.as_str() {
            "" => &model.name,
            title => title,
        };
        let title = format!("Modes of {title}");
        let mut data = page::json(rest, drawn).map_err(Error::system)?;
        data["title"] = title.as_str().into();
        data["model"] = model.name.as_str().into();
        data["version"] = env!("CARGO_PKG_VERSION").into();
        data["digest"] = rest.dynamics.info().digest.into();
        data["command"] = command_line().into();
        data["unstable"] = shown.iter().any(Shown::grows).into();
        data["notes"] = notes.into();
        Ok(report::modes_page(&title, &data))
    }

    /// Fails if the state is none of rest.
    fn must_rest(
        &self,
        info: &Info,
        state: &[f64],
        (acceleration, element): (f64, &str),
    ) -> Result<(), Error> {
        let help = format!(
            "help: `bryant settle {0} -o rest.json` finds a state of rest, and `bryant modes {0} --start rest.json` its modes",
            self.model
        );
        // not a number is no rest either
        if acceleration.is_nan() || acceleration > AT_REST.0 {
            return Err(Error::Input(format!(
                "this is no state of rest: the centre of gravity of \"{element}\" accelerates by {} g\n  {help}",
                digits(acceleration / STANDARD_GRAVITY)
            )));
        }
        let turning = (0..state.len())
            .filter(|&index| info.kind(index) == StateKind::AngularVelocity)
            .find(|&index| state[index].abs() > AT_REST.1);
        match turning {
            None => Ok(()),
            Some(index) => Err(Error::Input(format!(
                "this is no state of rest: {} is {:.3} rad/s\n  {help}",
                info.state_name(index).unwrap_or_default(),
                state[index]
            ))),
        }
    }
}

/// The note that a state of rest is one that moves along.
fn moves_along(info: &Info, state: &[f64]) -> Option<String> {
    let moving = (0..state.len()).filter(|&index| info.kind(index) == StateKind::Velocity);
    let speed = moving.map(|index| state[index].abs()).reduce(f64::max)?;
    (speed > MOVING).then(|| {
        format!(
            "the state moves at up to {} m/s: the modes are those of an observer who moves along, with the forces of this instant",
            digits(speed)
        )
    })
}

/// What is to be said of the modes.
fn notes(modes: &[Mode], shown: &[Shown<'_>], hidden: f64) -> Vec<String> {
    let mut notes = Vec::new();
    if let Some(worst) = modes.iter().map(|mode| mode.residual).reduce(f64::max)
        && worst > POOR
    {
        notes.push(format!(
            "warning: shapes hold to {worst:.0e} only: modes nearly coincide"
        ));
    }
    if shown.iter().any(|one| one.free) {
        notes.push(format!(
            "modes below {} Hz cannot be told from free motions beside the fastest mode",
            digits(hidden / TAU)
        ));
    }
    if shown.iter().any(Shown::grows) {
        notes.push("a mode grows: the state of rest is unstable".to_owned());
    }
    notes
}

fn as_json(model: &str, t: f64, hidden: f64, names: &[String], shown: &[Shown<'_>]) -> Value {
    let modes: Vec<Value> = shown
        .iter()
        .map(|one| {
            let rate = one.mode.rate;
            let shape = names.iter().zip(&one.mode.shape);
            let shape: Vec<Value> = shape
                .map(|(name, entry)| json!({ "name": name, "re": entry.re, "im": entry.im }))
                .collect();
            let shares: Vec<Value> = one
                .shares
                .iter()
                .map(|(name, share)| json!({ "name": name, "share": share }))
                .collect();
            json!({
                "rate_per_s": { "re": rate.re, "im": rate.im },
                "frequency_Hz": (rate.im != 0.0).then_some(rate.norm() / TAU),
                "damping": (rate.norm() > 0.0).then_some(-rate.re / rate.norm()),
                "free": one.free,
                "residual": one.mode.residual,
                "moves": shares,
                "shape": shape,
            })
        })
        .collect();
    json!({ "model": model, "t_s": t, "free_below_Hz": hidden / TAU, "modes": modes })
}

/// What the shapes have entries for: coordinates along the motion of their velocities, velocities, states of force
/// laws.
fn names(info: &Info) -> Vec<String> {
    let along = info.velocities.iter().map(|name| format!("along {name}"));
    let by = info.velocities.iter().chain(info.auxiliaries);
    along.chain(by.map(|name| format!("by {name}"))).collect()
}

/// The modes at a state of rest.
fn modes_at(
    model: &Evaluated<f64>,
    t: f64,
    state: &[f64],
    mass: &[f64],
) -> Result<Vec<Mode>, Error> {
    let (a, size) = linear(model, t, state);
    modes::modes(&a, size, mass).map_err(|error| {
        Error::failed(match error {
            NoModes::NotFinite => {
                "the linearisation at this state has numbers that are not finite".to_owned()
            }
            NoModes::NotConverged => "the search for the modes did not converge".to_owned(),
        })
    })
}

/// A of ẋ = A x about a state in which nothing turns, by rows, and its size. x has the coordinates along the motion of
/// each velocity, the velocities, and the states of force laws: δq = G ξ, where q̇ = G v. G is constant there, so ξ̇ =
/// δv; the other rows are those of the Jacobian of ẏ, by dual numbers.
fn linear(model: &Evaluated<f64>, t: f64, state: &[f64]) -> (Vec<f64>, usize) {
    let info = model.info();
    let (coordinates, count) = (info.coordinates.len(), info.velocities.len());
    let (length, size) = (state.len(), 2 * count + info.auxiliaries.len());
    let mut jacobian = vec![0.0; length * length];
    if !model.jacobian(t, state, &mut jacobian, &mut vec![0.0; length]) {
        unreachable!("an engine has a Jacobian");
    }
    let mut motions = vec![vec![0.0; length]; count];
    for (velocity, motion) in motions.iter_mut().enumerate() {
        let mut one = state.to_vec();
        one[coordinates..][..count].fill(0.0);
        one[coordinates + velocity] = 1.0;
        model.coordinate_rates(&one, motion);
    }
    let mut a = vec![0.0; size * size];
    for (row, entries) in a.chunks_exact_mut(size).enumerate() {
        let Some(rate) = row.checked_sub(count) else {
            entries[count + row] = 1.0;
            continue;
        };
        let by_state = &jacobian[length * (coordinates + rate)..][..length];
        let (by_place, by_rest) = entries.split_at_mut(count);
        for (entry, motion) in by_place.iter_mut().zip(&motions) {
            let terms = by_state.iter().zip(&motion[..coordinates]);
            *entry = terms.map(|(by, motion)| by * motion).sum();
        }
        by_rest.copy_from_slice(&by_state[coordinates..][..by_rest.len()]);
    }
    (a, size)
}

/// The shares of the kinetic energy by velocity, largest first. Entries of S between two velocities count by half for
/// each; a share that is negative by them counts by its size.
fn shares<'a>(mode: &Mode, mass: &[f64], info: &'a Info) -> Vec<(&'a str, f64)> {
    let count = info.velocities.len();
    let (along, rest) = mode.shape.split_at(count);
    let share = |i: usize| {
        let momentum: Number = (0..count).map(|j| along[j] * mass[count * i + j]).sum();
        (along[i].conj() * momentum).re.abs()
    };
    let mut shares: Vec<(&str, f64)> = (0..count).map(|i| (info.velocities[i], share(i))).collect();
    let sum: f64 = shares.iter().map(|(_, share)| share).sum();
    if sum == 0.0 || mode.moves_nothing(count) {
        // states of force laws, by their size
        let laws = info.auxiliaries.iter().zip(&rest[count.min(rest.len())..]);
        shares = laws.map(|(name, entry)| (*name, entry.norm())).collect();
    } else {
        shares.iter_mut().for_each(|(_, share)| *share /= sum);
    }
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    shares
}

/// Three digits.
fn digits(value: f64) -> String {
    let magnitude = libm::log10(value.abs()).floor() as i32;
    match magnitude {
        -4..=2 => format!("{value:.*}", (2 - magnitude) as usize),
        3..=5 => format!("{value:.0}"),
        _ => format!("{value:.2e}"),
    }
}

impl Shown<'_> {
    /// Whether the state is unstable by this mode.
    fn grows(&self) -> bool {
        self.mode.rate.re > 0.0 && !self.free && !self.is_undamped()
    }

    fn oscillates(&self) -> bool {
        self.mode.rate.im != 0.0 && !self.free
    }

    /// Whether the real part of the rate is no more than rounding of what is not damped.
    fn is_undamped(&self) -> bool {
        self.mode.rate.re.abs() <= 1e-9 * self.mode.rate.norm()
    }

    /// In Hz.
    fn frequency(&self) -> String {
        match self.oscillates() {
            true => digits(self.mode.rate.norm() / TAU),
            false => NONE.to_owned(),
        }
    }

    /// In percent of the critical one.
    fn damping(&self) -> String {
        match self.oscillates() {
            true if self.is_undamped() => "0".to_owned(),
            true => digits(-100.0 * self.mode.rate.re / self.mode.rate.norm()),
            false => NONE.to_owned(),
        }
    }

    /// The time constant \[s\].
    fn time(&self) -> String {
        match self.mode.rate.re {
            _ if self.free => "free".to_owned(),
            _ if self.is_undamped() => NONE.to_owned(),
            rate if rate > 0.0 => format!("{}, grows", digits(1.0 / rate)),
            rate => digits(-1.0 / rate),
        }
    }

    /// The largest shares of the kinetic energy.
    fn moves(&self) -> String {
        let shares = self.shares.iter().filter(|(_, share)| *share >= SMALL);
        let words = shares
            .take(MANY)
            .map(|(name, share)| format!("{name} {:.0} %", 100.0 * share));
        words.collect::<Vec<_>>().join(", ")
    }
}

/// In place of a number that a mode does not have.
const NONE: &str = "-";

/// The modes as aligned columns; those that are free, which come first, in one row.
fn table(shown: &[Shown<'_>], width: Option<usize>) -> String {
    let free = shown.iter().take_while(|one| one.free).count();
    let skipped = free.saturating_sub(1);
    let rows = &shown[skipped..];
    let column = |text: &dyn Fn(&Shown<'_>) -> String| rows.iter().map(text).collect::<Vec<_>>();
    let numbers = (1 + skipped..=shown.len()).map(|number| match number == free && skipped > 0 {
        true => format!("1 to {free}"),
        false => number.to_string(),
    });
    // those that are free share their motions
    let moves = |one: &Shown<'_>| match one.free && skipped > 0 {
        true => String::new(),
        false => one.moves(),
    };
    let columns = [
        Cells::of_words("mode", "", numbers.collect()),
        Cells::of_words("frequency", "Hz", column(&|one| one.frequency())),
        Cells::of_words("damping", "%", column(&|one| one.damping())),
        Cells::of_words("time", "s", column(&|one| one.time())),
        Cells::of_words("moves", "", column(&moves)).left_aligned(),
    ];
    side_by_side(&columns, width)
}
