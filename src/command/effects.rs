//! `bryant effects`: what of a scene is in, what is out, why, and what each effect costs.

use super::Error;
use super::model_argument::find;
use super::prepare::users_of;
use super::terminal::Terminal;
use crate::build_on_demand::UserForces;
use crate::equations;
use crate::parallel;
use crate::timing::{self, Measured, Method};
use bryant_generator::effect::{self, Cost, Effect, Entry, Reason, Variant};
use bryant_generator::expression::count::Count;
use bryant_generator::model::Model;
use bryant_generator::program::Lists;
use clap::Args;
use serde_json::{Value, json};
use std::sync::Arc;

/// List the effects of a scene: in or out, why, and what each costs
#[derive(Debug, Args)]
#[command(after_long_help = "\
An effect is a term of the equations that may be in or out: a force and each of its terms, translation of a reference
joint, effects of inertia of each element, the dimension y, a parameter, an output. What is out leaves no trace in the
generated source.

For each effect that is in, the equations are derived once more without it, as if it had never been mentioned, and timed in
turn with those of the scene itself. The effects that cost most operations come first.

  operations  of one evaluation of the accelerations, all less those without the effect; of a parameter, those that its
              default value folded in would save; of an output, those of the outputs. Effects share geometry, so
              these do not add up. A sine, a cosine or a call of a curve or law is no operation and stands beside: +2
  with        time of one evaluation of the derivative with all effects; of outputs, of the outputs
  without     the same without this effect: medians of 101 rounds
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
    /// Name of a bundled model, or path of a YAML file
    model: String,

    /// Time nothing: operations only
    #[arg(long)]
    no_time: bool,

    /// Only the effects whose names contain this; may be repeated
    #[arg(long, value_name = "TEXT")]
    only: Vec<String>,

    /// List also the terms of forces that the text does not mention
    #[arg(long)]
    all: bool,

    /// Print JSON: every effect, mentioned or not
    #[arg(long)]
    json: bool,
}

/// A variant to be generated.
struct Task {
    variant: Variant,
    method: Method,
}

/// What is known of a variant.
struct Generated {
    cost: Cost,
    lists: Lists,
}

/// An effect with what it costs.
struct Row<'a> {
    entry: &'a Entry,
    method: Method,
    /// All, less those without it.
    operations: Option<Difference>,
    /// With it and without.
    measured: Option<(Measured, Measured)>,
}

/// Operations that an effect adds; fewer than none where without it nothing is shared any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Difference {
    operations: i64,
    /// Sines, cosines, angles and calls.
    calls: i64,
}

impl Arguments {
    /// Lists, derives, times.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let found = find(&self.model)?;
        let model = &found.scene.model;
        let users = match self.no_time {
            true => None,
            false => users_of(&found, model, terminal)?,
        };
        let entries = effect::of_scene(&found.scene);
        let entries: Vec<Entry> = entries.into_iter().filter(|e| self.wants(e)).collect();

        // The scene twice, to see how much of a difference is noise; its outputs; without anything left out; variants.
        let all = Variant::of(model);
        let of_accelerations = |variant: &Variant| Task {
            variant: variant.clone().without_outputs(),
            method: Method::Accelerations,
        };
        let mut tasks = vec![
            of_accelerations(&all),
            of_accelerations(&all),
            Task {
                variant: all.clone(),
                method: Method::Outputs,
            },
            of_accelerations(&Variant::of(&effect::general(&found.scene.written))),
        ];
        let mut task_of = Vec::new();
        for entry in &entries {
            task_of.push(task(model, entry).map(|task| {
                tasks.push(task);
                tasks.len() - 1
            }));
        }

        let mut progress = terminal.progress(format!("deriving {} variants", tasks.len()));
        let generated = generate(&tasks, &mut |part| progress.set(part));
        progress.finish();
        let (costs, lists): (Vec<Cost>, Vec<Lists>) = generated
            .into_iter()
            .map(|Generated { cost, lists }| (cost, lists))
            .unzip();
        let measured = self.measure(&tasks, lists, users, terminal)?;

        let of = |index: usize| measured.as_ref().map(|measured| measured[index]);
        let mut rows: Vec<Row> = entries
            .iter()
            .zip(&task_of)
            .map(|(entry, task)| {
                let method = method(entry.effect);
                let base = match method {
                    Method::Accelerations => 0,
                    Method::Outputs => 2,
                };
                let difference = |index: usize| {
                    let with = count(&costs[base], method);
                    Difference::between(with, count(&costs[index], method))
                };
                Row {
                    entry,
                    method,
                    operations: task.map(difference),
                    measured: task.and_then(|index| Some((of(base)?, of(index)?))),
                }
            })
            .collect();
        // the costliest first; what is out, and costs nothing, stays in the order of the scene behind them
        let cost = |row: &Row| {
            row.operations
                .map_or(i64::MIN, |d| d.operations + CALL * d.calls)
        };
        rows.sort_by_key(|row| std::cmp::Reverse(cost(row)));
        let total = Total {
            scene: (costs[0].accelerations.clone(), of(0)),
            again: of(1),
            general: (costs[3].accelerations.clone(), of(3)),
            parameters: tasks[3].variant.model.parameters.len(),
        };
        if self.json {
            terminal.print_json(&as_json(model, &rows, &total))
        } else {
            terminal.print(&as_text(model, &rows, &total))
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

    /// Times of all tasks; `None` where none are wanted.
    fn measure(
        &self,
        tasks: &[Task],
        lists: Vec<Lists>,
        users: Option<Arc<UserForces>>,
        terminal: &Terminal,
    ) -> Result<Option<Vec<Measured>>, Error> {
        if self.no_time {
            return Ok(None);
        }
        let mut engines = Vec::new();
        for (task, lists) in tasks.iter().zip(lists) {
            let engine = equations::of_lists(lists, users.clone()).map_err(Error::system)?;
            engines.push((engine, task.method));
        }
        let what = format!("timing {} variants", engines.len());
        let mut progress = terminal.progress(what);
        let measured = timing::time(&engines, &mut |part| progress.set(part));
        progress.finish();
        Ok(Some(measured))
    }
}

/// A sine, a cosine or a call costs about as much as so many operations, where effects are put in order.
const CALL: i64 = 20;

/// The method in which an effect shows.
fn method(effect: Option<Effect>) -> Method {
    match effect {
        Some(Effect::Output(_)) => Method::Outputs,
        _ => Method::Accelerations,
    }
}

/// What is to be generated for an effect; `None` for what is out, or cannot be left out.
fn task(model: &Model, entry: &Entry) -> Option<Task> {
    let effect = entry.effect.filter(|_| entry.is_in)?;
    let variant = effect::without(model, effect)?;
    Some(match method(entry.effect) {
        Method::Accelerations => Task {
            variant: variant.without_outputs(),
            method: Method::Accelerations,
        },
        Method::Outputs => Task {
            variant,
            method: Method::Outputs,
        },
    })
}

/// Costs and lists of variants.
fn generate(tasks: &[Task], progress: &mut dyn FnMut(f64)) -> Vec<Generated> {
    let generated = |task: &Task| {
        let (cost, lists) = effect::counted(&task.variant);
        Generated { cost, lists }
    };
    parallel::map(tasks, generated, progress)
}

fn count(cost: &Cost, method: Method) -> &Count {
    match method {
        Method::Accelerations => &cost.accelerations,
        Method::Outputs => &cost.outputs,
    }
}

fn calls(count: &Count) -> usize {
    count.trigonometric() + count.called()
}

impl Difference {
    fn between(with: &Count, without: &Count) -> Self {
        Difference {
            operations: with.total() as i64 - without.total() as i64,
            calls: calls(with) as i64 - calls(without) as i64,
        }
    }
}

/// This scene, and the same with nothing left out.
struct Total {
    scene: (Count, Option<Measured>),
    /// The scene timed once more.
    again: Option<Measured>,
    general: (Count, Option<Measured>),
    /// Run-time parameters where nothing is left out.
    parameters: usize,
}

impl Total {
    /// A difference of times that is noise \[s\].
    fn noise(&self) -> Option<f64> {
        Some((self.scene.1?.time - self.again?.time).abs())
    }
}

fn as_text(model: &Model, rows: &[Row<'_>], total: &Total) -> String {
    let mut lines: Vec<[String; 7]> = vec![
        ["effect", "", "operations", "with", "without", "code", "why"].map(str::to_owned),
        ["", "", "", "[ns]", "[ns]", "[B]", ""].map(str::to_owned),
    ];
    for row in rows {
        let (with, without, code) = match row.measured {
            Some((with, without)) => (
                nanoseconds(with.time),
                nanoseconds(without.time),
                bytes(with.bytes, without.bytes),
            ),
            None => Default::default(),
        };
        let state = if row.entry.is_in { "in" } else { "out" };
        lines.push([
            row.entry.name.clone(),
            state.to_owned(),
            row.operations.map(difference).unwrap_or_default(),
            with,
            without,
            code,
            why(row.entry),
        ]);
    }
    let of = |name: &str, count: &Count, measured: Option<Measured>, why: String| {
        let operations = Difference {
            operations: count.total() as i64,
            calls: calls(count) as i64,
        };
        let time = measured.map_or_else(String::new, |m| nanoseconds(m.time));
        let code = measured.map_or_else(String::new, |m| bytes(m.bytes, Some(0)));
        let operations = difference(operations);
        [
            name.to_owned(),
            String::new(),
            operations,
            time,
            String::new(),
            code,
            why,
        ]
    };
    lines.push(Default::default());
    let (count, measured) = &total.scene;
    lines.push(of("this scene", count, *measured, String::new()));
    let (count, measured) = &total.general;
    let why = format!("in space, {} run-time parameters", total.parameters);
    lines.push(of("with nothing left out", count, *measured, why));

    let mut text = format!("{}: effects\n\n", model.name);
    text += &aligned(&lines, total.scene.1.is_some());
    if let Some(noise) = total.noise() {
        text += &format!(
            "\nThis scene, timed twice, differs by {} ns from itself; smaller differences mean nothing.\n\
             Larger ones that no operation explains come of registers, which every change of the equations assigns anew.\n",
            nanoseconds(noise)
        );
    }
    text
}

/// Columns side by side, numbers to the right; columns of times only where there are any.
fn aligned(lines: &[[String; 7]], timed: bool) -> String {
    let shown = |column: usize| timed || !(3..6).contains(&column);
    let width = |column: usize| {
        let cells = lines.iter().map(|line| line[column].chars().count());
        cells.max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..7).map(width).collect();
    let mut text = String::new();
    for line in lines {
        let mut row = String::new();
        for (column, cell) in line.iter().enumerate().filter(|(column, _)| shown(*column)) {
            let width = widths[column];
            row += &match column {
                0 => format!("{cell:width$}"),
                2..6 => format!("  {cell:>width$}"),
                _ => format!("  {cell:width$}"),
            };
        }
        text += row.trim_end();
        text.push('\n');
    }
    text
}

/// "10", "10 + 2" with calls, "-3"
fn difference(difference: Difference) -> String {
    match difference.calls {
        0 => difference.operations.to_string(),
        calls if calls < 0 => format!("{} - {}", difference.operations, -calls),
        calls => format!("{} + {calls}", difference.operations),
    }
}

fn nanoseconds(seconds: f64) -> String {
    format!("{:.1}", seconds * 1e9)
}

fn bytes(with: Option<u64>, without: Option<u64>) -> String {
    match (with, without) {
        (Some(with), Some(without)) => (with as i64 - without as i64).to_string(),
        _ => String::new(),
    }
}

/// The reason, and the line.
fn why(entry: &Entry) -> String {
    let mut text = entry.why.clone();
    if let Some(place) = entry
        .place
        .as_ref()
        .filter(|_| entry.reason != Reason::Absent)
    {
        let line = match place.text.as_str() {
            "" => place.to_string(),
            text => format!("{place} {text}"),
        };
        text = match text.as_str() {
            "" => line,
            text => format!("{text} ({line})"),
        };
    }
    text
}

fn as_json(model: &Model, rows: &[Row<'_>], total: &Total) -> Value {
    let effects: Vec<Value> = rows
        .iter()
        .map(|row| {
            let entry = row.entry;
            let place = entry.place.as_ref();
            let place = place.map(|p| json!({ "file": p.file, "line": p.line, "text": p.text }));
            json!({
                "effect": entry.name,
                "in": entry.is_in,
                "reason": entry.reason.word(),
                "why": entry.why,
                "place": place,
                "method": row.method.name(),
                "operations": row.operations.map(|d| d.operations),
                "calls": row.operations.map(|d| d.calls),
                "time_with_s": row.measured.map(|(with, _)| with.time),
                "time_without_s": row.measured.map(|(_, without)| without.time),
                "code_bytes": row.measured.and_then(|(with, without)| {
                    Some(with.bytes? as i64 - without.bytes? as i64)
                }),
            })
        })
        .collect();
    let of = |(count, measured): &(Count, Option<Measured>)| {
        json!({
            "operations": count.total(),
            "calls": calls(count),
            "time_s": measured.map(|m| m.time),
            "code_bytes": measured.and_then(|m| m.bytes),
        })
    };
    let mut general = of(&total.general);
    general["parameters"] = json!(total.parameters);
    json!({
        "model": model.name,
        "digest": model.digest,
        "effects": effects,
        "scene": of(&total.scene),
        "nothing_left_out": general,
        "noise_s": total.noise(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_show_calls_beside() {
        let of = |operations, calls| difference(Difference { operations, calls });
        assert_eq!(
            [of(10, 0), of(10, 2), of(-3, -1)],
            ["10", "10 + 2", "-3 - 1"]
        );
    }

    #[test]
    fn columns_are_aligned() {
        let lines = [
            ["effect", "", "operations", "with", "without", "code", "why"].map(str::to_owned),
            ["a long one", "in", "7", "1.5", "1.0", "8", "here"].map(str::to_owned),
        ];
        assert_eq!(
            aligned(&lines, true),
            "effect          operations  with  without  code  why\n\
             a long one  in           7   1.5      1.0     8  here\n"
        );
        assert_eq!(
            aligned(&lines, false),
            "effect          operations  why\na long one  in           7  here\n"
        );
    }
}
