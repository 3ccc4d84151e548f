//! `bryant effects`: lists which effects of a scene are in and out, why, and what each costs.

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod table;

use super::Error;
use super::model_argument::find;
use super::prepare::users_of;
use super::progress::{Progress, Whole};
use super::terminal::Terminal;
use crate::build_on_demand::UserForces;
use crate::equations::{self, Engine};
use crate::timing::{self, TimedMethod};
use crate::{interrupt, parallel};
use bryant_generator::effect::{self, Cost, Effect, Entry, Reason, Variant};
use bryant_generator::expression::count::Count;
use bryant_generator::model::Model;
use bryant_generator::program::Lists;
use clap::Args;
use std::sync::Arc;
use std::time::Instant;
use table::{Difference, Row, Table, Total, as_json};

/// List the effects of a scene: in or out, why, and what each costs
#[derive(Debug, Args)]
#[command(after_long_help = "\
An effect is a term of the equations that may be in or out: a force and each of its terms, translation of a reference
joint, effects of inertia of each element, the dimension y, a parameter, an output. What is out leaves no trace in the
generated source.

For each effect that is in, the equations are derived once more without it, as if it had never been mentioned, and timed in
turn with those of the scene itself. The effects that cost most operations come first, and rows appear as they are timed.
Equations are derived on all processors and timed on one, where nothing disturbs them.

Ctrl-C ends it: the table of what was computed is printed, what is missing is said, and the exit code is 130.

  operations  of one evaluation of the accelerations, all less those without the effect; of a parameter, those that its
              default value folded in would save; of an output, those of the outputs. Effects share geometry, so
              these do not add up. Sines, cosines and calls of curves or laws are counted apart and stand beside: +2
  with        time of one evaluation of the derivative with all effects; of outputs, of the outputs
  without     the same without this effect: medians of 51 rounds
  code        machine code that the effect adds, without the functions that it calls

The last row is the same scene with nothing left out: every force that the text mentions acts, the motion is in space,
every element has three principal moments in axes of its own, every number is a run-time parameter (nothing folds), every
term of every force is there, with the coefficient 0 where the scene does not have it, a field acts on each element by
itself, and a fixed reference joint is accelerated as prescribed, by 0. It is really derived and timed.

Examples:
  bryant effects child-seat
  bryant effects my.yaml --no-time
  bryant effects my.yaml --only belt --all
  bryant effects child-seat --json > effects.json")]
pub struct Arguments {
    /// Name of a bundled model, or path of a YAML or URDF file
    model: String,

    /// Count operations only, and time nothing
    #[arg(long)]
    no_time: bool,

    /// Show only the effects whose names contain this; may be repeated
    #[arg(long, value_name = "TEXT")]
    only: Vec<String>,

    /// Also list the terms of forces that the text does not mention
    #[arg(long)]
    all: bool,

    /// Print JSON, with every effect, also those that the text does not mention
    #[arg(long)]
    json: bool,
}

/// A variant of the scene whose equations are derived, and the method whose cost counts.
struct Derivation {
    variant: Variant,
    method: TimedMethod,
}

impl Arguments {
    /// Lists the effects, derives the equations without each, and times them.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        found.tell(terminal);
        let model = &found.scene.model;
        let users = match self.no_time {
            true => None,
            false => users_of(&found, model, terminal)?,
        };
        let entries = effect::of_annotated_model(&found.scene);
        let entries: Vec<Entry> = entries.into_iter().filter(|e| self.wants(e)).collect();
        let (derivations, derivation_of) = derivations(model, &found.scene.written, &entries);

        interrupt::watch();
        let whole = Whole::Count(derivations.len() as u64, "variants");
        let progress = Progress::new(terminal, "deriving".into(), whole);
        if !self.no_time {
            progress
                .later(derivations.len() as f64 * time_of_one(&derivations[SCENE], users.clone())?);
        }
        let generated = generate(&derivations, !self.no_time, &mut |done| {
            progress.set(done as f64);
        });
        let generated = generated.into_iter().map(Option::unzip);
        let generated = generated.map(|(cost, lists)| (cost, lists.flatten()));
        let (costs, mut lists): (Vec<Option<Cost>>, Vec<Option<Lists>>) = generated.unzip();
        let of = |index: usize| costs[index].as_ref();
        let (Some(scene), Some(_), Some(general)) = (of(SCENE), of(OUTPUTS), of(GENERAL)) else {
            return Err(Error::Interrupted("no equations were derived yet".into()));
        };
        let mut rows: Vec<(Row<'_>, Option<usize>)> = entries
            .iter()
            .zip(&derivation_of)
            .map(|(entry, derivation)| (row(entry, *derivation, &costs), *derivation))
            .collect();
        // costliest effects first; effects that are out cost nothing and keep the order of the scene
        rows.sort_by_key(|(row, _)| std::cmp::Reverse(cost(row)));
        let mut total = Total {
            scene: (scene.accelerations.clone(), None),
            again: None,
            general: (general.accelerations.clone(), None),
            parameters: derivations[GENERAL].variant.model.parameters.len(),
        };

        let room = terminal.width();
        let table = Table::new(rows.iter().map(|(row, _)| row), &total, !self.no_time, room);
        let mut show = |text: &str| -> Result<(), Error> {
            if self.json {
                return Ok(());
            }
            progress.beside(|| terminal.print(text).and_then(|()| terminal.flush()))
        };
        show(&format!("{}: effects\n\n{}", model.name, table.heading()))?;
        let mut shown = 0;
        if !self.no_time {
            progress.next("timing".into(), whole);
            let mut bench = Bench::new(&mut lists, users)?;
            for group in rows.chunks_mut(GROUP) {
                if interrupt::asked() {
                    break;
                }
                bench.time(group, &derivations, &mut total)?;
                shown += group.len();
                for (row, _) in group {
                    show(&table.row(row))?;
                }
                progress.set((GENERAL + 1 + bench.timed) as f64);
            }
        }
        for (row, _) in &rows[shown..] {
            show(&table.row(row))?;
        }
        show(&table.totals(&total))?;
        drop(progress);
        let missing = missing(&rows, !self.no_time);
        if self.json {
            let rows: Vec<Row<'_>> = rows.into_iter().map(|(row, _)| row).collect();
            terminal.print_json(&as_json(model, &rows, &total, missing.is_none()))?;
        }
        match missing {
            Some(missing) => Err(Error::Interrupted(missing)),
            None => Ok(()),
        }
    }

    fn wants(&self, entry: &Entry) -> bool {
        let mentioned = self.json || self.all || entry.reason != Reason::Absent;
        let named = self
            .only
            .iter()
            .any(|text| entry.name.contains(text.as_str()));
        mentioned && (named || self.only.is_empty())
    }
}

/// Indices of the first derivations: the scene itself, its outputs, and the scene with all effects in.
const SCENE: usize = 0;
const OUTPUTS: usize = 1;
const GENERAL: usize = 2;

/// The variants to derive, and for each effect the index of its variant; `None` for an effect that is out or cannot be
/// left out.
fn derivations(
    model: &Model,
    written: &Model,
    entries: &[Entry],
) -> (Vec<Derivation>, Vec<Option<usize>>) {
    let all = Variant::of(model);
    let of_accelerations = |variant: &Variant| Derivation {
        variant: variant.clone().without_outputs(),
        method: TimedMethod::Accelerations,
    };
    let mut derivations = vec![
        of_accelerations(&all),
        Derivation {
            variant: all.clone(),
            method: TimedMethod::Outputs,
        },
        of_accelerations(&Variant::of(&effect::general(written))),
    ];
    let without = parallel::map(entries, |entry| derivation(model, entry), &mut |_| {});
    let mut numbered = |derivation| {
        derivations.push(derivation);
        derivations.len() - 1
    };
    let derivation_of = without.into_iter();
    let derivation_of = derivation_of.map(|of| of.flatten().map(&mut numbered));
    let derivation_of = derivation_of.collect();
    (derivations, derivation_of)
}

/// The row of an effect, with its operations if they are known.
fn row<'a>(entry: &'a Entry, derivation: Option<usize>, costs: &[Option<Cost>]) -> Row<'a> {
    let method = method(entry.effect);
    let base = costs[base(method)].as_ref();
    let without = derivation.and_then(|index| costs[index].as_ref());
    let difference = |(with, without): (&Cost, &Cost)| {
        Difference::between(count(with, method), count(without, method))
    };
    Row {
        entry,
        method,
        operations: base.zip(without).map(difference),
        measured: None,
    }
}

/// The cost by which effects are sorted: operations, and calls weighted by [`CALL`].
fn cost(row: &Row<'_>) -> i64 {
    row.operations
        .map_or(i64::MIN, |d| d.operations + CALL * d.calls)
}

/// The index of the derivation that an effect is compared with.
fn base(method: TimedMethod) -> usize {
    match method {
        TimedMethod::Accelerations => SCENE,
        TimedMethod::Outputs => OUTPUTS,
    }
}

/// Number of effects that are timed together, in turn with the scene; their rows appear together.
const GROUP: usize = 16;

/// Times the variants.
struct Bench<'a> {
    lists: &'a mut [Option<Lists>],
    users: Option<Arc<UserForces>>,
    /// The engines of the scene and of its outputs.
    bases: [Engine; 2],
    /// Number of effects that were timed so far.
    timed: usize,
}

impl<'a> Bench<'a> {
    fn new(lists: &'a mut [Option<Lists>], users: Option<Arc<UserForces>>) -> Result<Self, Error> {
        let mut of = |index: usize| engine(lists, index, users.clone());
        let bases = [of(SCENE)?, of(OUTPUTS)?];
        let [Some(scene), Some(outputs)] = bases else {
            return Err(Error::Interrupted("no equations were derived yet".into()));
        };
        Ok(Bench {
            lists,
            users,
            bases: [scene, outputs],
            timed: 0,
        })
    }

    /// Times a group of effects together with the scene. The first group also times the scene once more, and the scene
    /// with all effects in.
    fn time(
        &mut self,
        group: &mut [(Row<'_>, Option<usize>)],
        derivations: &[Derivation],
        total: &mut Total,
    ) -> Result<(), Error> {
        let first = total.scene.1.is_none();
        let mut places = Vec::new();
        let mut engines = Vec::new();
        for (place, (_, derivation)) in group.iter().enumerate() {
            let Some(derivation) = *derivation else {
                continue;
            };
            if let Some(engine) = engine(self.lists, derivation, self.users.clone())? {
                places.push(place);
                engines.push((engine, derivations[derivation].method));
            }
        }
        let general = match first {
            true => engine(self.lists, GENERAL, self.users.clone())?,
            false => None,
        };
        if engines.is_empty() && !first {
            return Ok(());
        }
        let [scene, outputs] = &self.bases;
        let mut all = vec![
            (scene, TimedMethod::Accelerations),
            (outputs, TimedMethod::Outputs),
        ];
        all.extend(engines.iter().map(|(engine, method)| (engine, *method)));
        if let Some(general) = &general {
            all.push((scene, TimedMethod::Accelerations));
            all.push((general, TimedMethod::Accelerations));
        }
        let measured = timing::time(&all);
        for ((place, (_, method)), without) in places.iter().zip(&engines).zip(&measured[2..]) {
            let with = measured[base(*method)];
            group[*place].0.measured = Some((with, *without));
        }
        if let (true, [.., again, general]) = (general.is_some(), &measured[..]) {
            total.scene.1 = Some(measured[SCENE]);
            total.again = Some(*again);
            total.general.1 = Some(*general);
        }
        self.timed += places.len();
        Ok(())
    }
}

/// Estimate of the time needed to time one effect \[s\], with its share of timing the scene; from timing the scene
/// once.
fn time_of_one(scene: &Derivation, users: Option<Arc<UserForces>>) -> Result<f64, Error> {
    let (_, lists) = effect::counted(&scene.variant);
    let begin = Instant::now();
    let engine = equations::of_lists(lists, users).map_err(Error::system)?;
    timing::time(&[(&engine, scene.method)]);
    let bases = 2.0;
    Ok(begin.elapsed().as_secs_f64() * (1.0 + bases / GROUP as f64))
}

/// The engine of a derivation, which can be taken only once; `None` if its equations were not derived.
fn engine(
    lists: &mut [Option<Lists>],
    index: usize,
    users: Option<Arc<UserForces>>,
) -> Result<Option<Engine>, Error> {
    let engine = lists[index]
        .take()
        .map(|lists| equations::of_lists(lists, users));
    engine.transpose().map_err(Error::system)
}

/// A sentence about what an interruption left out; `None` if nothing.
fn missing(rows: &[(Row<'_>, Option<usize>)], timed: bool) -> Option<String> {
    let derivations = || rows.iter().filter(|(_, derivation)| derivation.is_some());
    let all = derivations().count();
    let derived = derivations()
        .filter(|(row, _)| row.operations.is_none())
        .count();
    let times = derivations()
        .filter(|(row, _)| row.measured.is_none())
        .count();
    match (derived, times) {
        (0, 0) => None,
        (0, _) if !timed => None,
        (0, times) => Some(format!("of {all} effects {times} were not timed")),
        (operations, _) => Some(format!(
            "of {all} effects {operations} were not derived{}",
            if timed { ", and none was timed" } else { "" }
        )),
    }
}

/// Number of operations that a sine, a cosine or a call counts as when effects are sorted.
const CALL: i64 = 20;

/// The method whose cost an effect changes.
fn method(effect: Option<Effect>) -> TimedMethod {
    match effect {
        Some(Effect::Output(_)) => TimedMethod::Outputs,
        _ => TimedMethod::Accelerations,
    }
}

/// The variant without an effect; `None` for an effect that is out or cannot be left out.
fn derivation(model: &Model, entry: &Entry) -> Option<Derivation> {
    let effect = entry.effect.filter(|_| entry.is_in)?;
    let variant = effect::without(model, effect)?;
    Some(match method(entry.effect) {
        TimedMethod::Accelerations => Derivation {
            variant: variant.without_outputs(),
            method: TimedMethod::Accelerations,
        },
        TimedMethod::Outputs => Derivation {
            variant,
            method: TimedMethod::Outputs,
        },
    })
}

/// The costs of the variants, and their lists if they are to be timed; `None` for variants that were not derived before
/// an interruption.
fn generate(
    derivations: &[Derivation],
    timed: bool,
    progress: &mut dyn FnMut(usize),
) -> Vec<Option<(Cost, Option<Lists>)>> {
    let work = |Derivation { variant, .. }: &Derivation| match timed {
        true => {
            let (cost, lists) = effect::counted(variant);
            (cost, Some(lists))
        }
        false => (effect::cost(variant), None),
    };
    parallel::map(derivations, work, progress)
}

fn count(cost: &Cost, method: TimedMethod) -> &Count {
    match method {
        TimedMethod::Accelerations => &cost.accelerations,
        TimedMethod::Outputs => &cost.outputs,
    }
}
