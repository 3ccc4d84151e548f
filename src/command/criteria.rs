//! `bryant criteria`: injury criteria of a run or a test beside the limits of a regulation.

use super::Error;
use super::compare::{pair, recording};
use super::terminal::Terminal;
use crate::criteria::limits::{self, Limits};
use crate::criteria::{Judged, Missing, Places, judge};
use serde_json::json;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Judge a run or a test by the injury criteria of a regulation
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
RECORDING is a table as `bryant run` writes it (CSV), or a test in ISO-MME: a file TEST.mme with its folder Channel, or the folder that has both. Channels
with codes of ISO-MME are found by them, others are named: --place 'head=head acceleration'. Places are head, head-x, head-y, head-z, neck-fx, neck-fz,
neck-my, chest, chest-x, chest-y, chest-z, chest-deflection, femur-left, femur-right. Signs are those of SAE J211-1: tension and flexion of the neck are positive.

Every criterion filters its channels as its standard says, components before their resultant, and needs ten samples for a period of its filter: 10 kHz for
CFC1000. A coarser recording is refused.

Examples:
  bryant criteria TEST.mme --standard 'FMVSS 208' --dummy 'Hybrid III 50M'
  bryant criteria run.csv --standard 'FMVSS 208' --dummy 'Hybrid III 3YO' --place 'head=head accelerometer' --place 'chest=chest accelerometer'
  bryant criteria --list")]
pub struct Arguments {
    /// The run or the test
    #[arg(required_unless_present = "list")]
    recording: Option<PathBuf>,

    /// The regulation
    #[arg(long, value_name = "NAME", required_unless_present = "list")]
    standard: Option<String>,

    /// The dummy
    #[arg(long, value_name = "NAME", required_unless_present = "list")]
    dummy: Option<String>,

    /// The channel of a place; may be repeated
    #[arg(long, value_name = "PLACE=CHANNEL", value_parser = pair)]
    place: Vec<(String, String)>,

    /// Nothing moves along y: resultants are of x and z
    #[arg(long)]
    planar: bool,

    /// List regulations and dummies with their limits and sources
    #[arg(long)]
    list: bool,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Reads, and judges.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let all = limits::all();
        let (Some(path), Some(standard), Some(dummy), false) =
            (&self.recording, &self.standard, &self.dummy, self.list)
        else {
            return terminal.print(&listed(&all));
        };
        let limits = find(&all, standard, dummy)?;
        let recording = recording(path)?;
        let places = Places::new(&recording, &self.place, self.planar).map_err(Error::Input)?;
        let judged = judge(limits, &places);
        usable(&judged)?;
        if judged.iter().all(|one| one.value.is_err()) {
            return Err(Error::Input(format!(
                "{} has no channel that a criterion of {standard} is computed from\n  \
                 help: name channels, as --place 'head=head acceleration', or give outputs their `code`",
                path.display()
            )));
        }
        match self.json {
            true => terminal.print_json(&json_of(limits, &judged)),
            false => terminal.print(&text(limits, &judged)),
        }
    }
}

/// An error where a channel cannot be used, so that a criterion would be wrong.
pub(super) fn usable(judged: &[Judged]) -> Result<(), Error> {
    let wrong = judged.iter().find_map(|one| match &one.value {
        Err(Missing::Unusable(why)) => Some((one.criterion.name, why)),
        _ => None,
    });
    match wrong {
        Some((name, why)) => Err(Error::Input(format!(
            "{name}: {why}\n  help: give a recording that the criterion can be computed from, such as of `bryant run --every '0.1 ms'`"
        ))),
        None => Ok(()),
    }
}

/// The limits of a regulation for a dummy, whatever case they are written in.
pub(super) fn find<'l>(
    all: &'l [Limits],
    standard: &str,
    dummy: &str,
) -> Result<&'l Limits, Error> {
    let of_standard = |one: &&Limits| one.standard.eq_ignore_ascii_case(standard.trim());
    let found = all
        .iter()
        .filter(of_standard)
        .find(|one| one.dummy.eq_ignore_ascii_case(dummy.trim()));
    found.ok_or_else(|| {
        let known: Vec<String> = all
            .iter()
            .map(|one| format!("{}, {}", one.standard, one.dummy))
            .collect();
        Error::Input(format!(
            "there are no limits of \"{standard}\" for \"{dummy}\"\n  help: there are those of {}",
            known.join("; ")
        ))
    })
}

fn listed(all: &[Limits]) -> String {
    let mut text = String::new();
    for one in all {
        let _ = writeln!(text, "{}, {}: {}", one.standard, one.dummy, one.source);
        for (name, limit) in &one.limits {
            let criterion = crate::criteria::CRITERIA
                .iter()
                .find(|known| known.name == name);
            let (unit, filter) = criterion.map_or(("", String::new()), |one| {
                (one.unit, one.filter.to_string())
            });
            let _ = writeln!(
                text,
                "  {name:18} {:>16}  {filter}",
                format!("{limit} {unit}").trim_end()
            );
        }
    }
    text
}

/// Criteria as a table for people.
pub(super) fn text(limits: &Limits, judged: &[Judged]) -> String {
    let mut text = format!(
        "{}, {} ({})\n\ncriterion              value     limit  unit  verdict         filter\n",
        limits.standard, limits.dummy, limits.source
    );
    let mut missing = Vec::new();
    for one in judged {
        let criterion = one.criterion;
        match &one.value {
            Ok(value) => {
                let _ = writeln!(
                    text,
                    "{:18} {:>9} {:>9}  {:4}  {:14}  {:7}  {}",
                    criterion.name,
                    number(*value),
                    number(one.limit),
                    criterion.unit,
                    verdict(*value, one.limit),
                    criterion.filter.to_string(),
                    one.detail
                );
            }
            Err(Missing::Channel(place)) => missing.push(format!("{} ({place})", criterion.name)),
            Err(Missing::Unusable(_)) => {}
        }
    }
    if !missing.is_empty() {
        let _ = write!(
            text,
            "\nnot judged, for there is no channel of: {}\n",
            missing.join(", ")
        );
    }
    text
}

/// Four digits.
fn number(value: f64) -> String {
    match value.abs() {
        size if size >= 1000.0 => format!("{value:.0}"),
        size if size >= 100.0 => format!("{value:.1}"),
        size if size >= 10.0 => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}

fn verdict(value: f64, limit: f64) -> String {
    let share = 100.0 * (value / limit - 1.0);
    match value <= limit {
        true => format!("met by {:.0} %", -share),
        false => format!("MISSED by {share:.0} %"),
    }
}

/// Criteria for programs.
pub(super) fn json_of(limits: &Limits, judged: &[Judged]) -> serde_json::Value {
    let criteria = judged.iter().map(|one| {
        let missing = match &one.value {
            Err(Missing::Channel(place)) => Some(place.as_str()),
            _ => None,
        };
        let value = one.value.as_ref().ok();
        json!({
            "criterion": one.criterion.name,
            "value": value,
            "limit": one.limit,
            "unit": one.criterion.unit,
            "met": value.map(|value| *value <= one.limit),
            "filter": one.criterion.filter.to_string(),
            "detail": one.detail,
            "missing": missing,
        })
    });
    json!({
        "standard": limits.standard,
        "dummy": limits.dummy,
        "source": limits.source,
        "criteria": criteria.collect::<Vec<_>>(),
    })
}
