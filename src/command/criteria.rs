//! `bryant criteria`: injury criteria of a run or a test beside the limits of a regulation.

use super::Error;
use super::compare::{ISO, filter_standard, pair, recording};
use super::terminal::Terminal;
use crate::criteria::{Recorded, Verdict, filter, said, verdict};
use bryant_runtime::response::filter::Standard;
use bryant_study::criteria::limits::{self, Limits};
use bryant_study::criteria::{Criterion, Missing};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Judge a run or a test by the injury criteria of a regulation
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
RECORDING is a table as `bryant run` writes it (CSV), or a test in ISO-MME: a file TEST.mme with its folder Channel, or the folder that has both. Channels
with codes of ISO-MME are found by them, others are named: --place 'head=head acceleration'. All channels are of one occupant; if a test has several, --occupant
chooses. If several sensors fit a place, they are listed, and --place chooses. Places are head, head-x, head-y, head-z, neck-fx, neck-fz,
neck-my, chest, chest-x, chest-y, chest-z, chest-deflection, femur-left, femur-right, and more (docs/criteria.md). Signs are those of SAE J211-1: tension and flexion of the neck are positive.

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

    /// The channel of a place of the dummy, or a pattern of codes for a part, 'head=??HEADCGRD*'; may be repeated
    #[arg(long, value_name = "PLACE=CHANNEL", value_parser = pair)]
    place: Vec<(String, String)>,

    /// Test object and position of the occupant, the first two characters of the channel codes
    #[arg(long, value_name = "OCCUPANT", value_parser = occupant)]
    occupant: Option<String>,

    /// Standard whose coefficients the filters have
    #[arg(long, value_name = "NAME", default_value = ISO, value_parser = filter_standard())]
    filter_standard: Standard,

    /// The motion is planar: nothing moves along y, and resultants have the components x and z
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
    /// Reads the recording and judges it.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let (Some(path), Some(standard), Some(dummy), false) =
            (&self.recording, &self.standard, &self.dummy, self.list)
        else {
            return terminal.print(&listed(&limits::all()));
        };
        let limits = limits::find(standard, dummy).map_err(Error::Input)?;
        let recording = recording(path)?;
        let named = places(&self.place);
        let recorded = Recorded::new(
            &recording,
            &named,
            self.occupant.as_deref(),
            self.planar,
            self.filter_standard,
        )
        .map_err(Error::Input)?;
        let verdict = verdict(&limits, &recorded);
        usable(&verdict)?;
        for damaged in &recording.damaged {
            terminal.note(&format!("left out, and not needed: {}", said(damaged)));
        }
        if verdict.rows.iter().all(|row| row.value.is_err()) {
            let lacks = verdict.rows.iter().filter_map(|row| match &row.value {
                Err(Missing::Place(place)) => Some(format!("{} ({place})", row.criterion.name)),
                _ => None,
            });
            return Err(Error::Input(format!(
                "{} has no channel that a criterion of {standard} is computed from, so these have none: {}\n  \
                 help: name channels, as --place 'head=head acceleration', or give outputs their `code`",
                path.display(),
                lacks.collect::<Vec<_>>().join(", ")
            )));
        }
        match self.json {
            true => terminal.print_json(&verdict.json()),
            false => terminal.print(&verdict.text()),
        }
    }
}

/// Reads test object and position of an occupant: two characters.
pub(super) fn occupant(text: &str) -> Result<String, String> {
    let text = text.trim();
    match text.len() == 2 && text.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
        true => Ok(text.to_ascii_uppercase()),
        false => Err("give two characters, test object and position, as 11".to_owned()),
    }
}

/// Converts names of places to their usual form: `head_x` becomes `head-x`.
pub(super) fn places(given: &[(String, String)]) -> Vec<(String, String)> {
    let each = given.iter();
    each.map(|(place, of)| (place.replace('_', "-"), of.clone()))
        .collect()
}

/// Fails if a channel is unusable for a criterion, because the criterion would be wrong.
fn usable(verdict: &Verdict) -> Result<(), Error> {
    let wrong = verdict.rows.iter().find_map(|row| match &row.value {
        Err(Missing::Unusable(why)) => Some((row.criterion.name, why)),
        _ => None,
    });
    match wrong {
        Some((name, why)) => Err(Error::Input(format!(
            "{name}: {why}{}",
            match why.contains("--place") || why.contains("help: ") {
                // this reason already has its remedy
                true => "",
                false =>
                    "\n  help: give a recording that the criterion can be computed from, such as of `bryant run --every '0.1 ms'`",
            }
        ))),
        None => Ok(()),
    }
}

fn listed(all: &[Limits]) -> String {
    let mut text = String::new();
    for limits in all {
        let _ = writeln!(
            text,
            "{}, {}: {}",
            limits.standard, limits.dummy, limits.source
        );
        for (name, limit) in &limits.limits {
            let criterion = Criterion::named(name);
            let (unit, filter) =
                criterion.map_or(("", String::new()), |one| (one.unit, filter(one, limits)));
            let line = format!("  {name:18} {:>16}  {filter}", limit.text(unit));
            let _ = writeln!(text, "{line}");
        }
    }
    text
}
