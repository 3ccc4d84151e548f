//! `bryant compare`: how well a run agrees with a measurement, channel by channel.

use super::Error;
use super::model_argument::nearest;
use super::terminal::Terminal;
use crate::criteria::said;
use crate::quantity;
use bryant_signal::filter::{Class, Standard, class, class_of_code, filtered};
use bryant_signal::rating::{RATE, Rating, RatingError, rate};
use bryant_signal::{Channel, Damaged, NoChannel, ReadError, Recording, Signal, unit};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde_json::json;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Rate how well a run agrees with a measurement, channel by channel, by ISO 18571
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
RUN and MEASURED are tables as `bryant run` writes them (CSV: the time, then columns such as `head acceleration [m/s^2]`), or tests in ISO-MME: a file
TEST.mme with its folder Channel, or the folder that has both.

Channels are those that both have by the same name, or the pairs that --channel names. Units of one quantity are converted. The rating is over the
time that both have, or from --from to --to, of samples at 10 kHz: a coarser recording is refused, for what happens between its samples is not
known. --resample takes straight lines between them all the same.

The rating: corridor (0.4), phase, magnitude and slope (0.2 each), from 0 to 1. Above 0.94 it is excellent, above 0.80 good, above 0.58 fair.

Examples:
  bryant run seat.yaml --every '0.1 ms' --csv run.csv
  bryant compare run.csv test.csv
  bryant compare run.csv TEST.mme --channel 'head acceleration=11HEADCG00H3ACRA' --filter CFC1000 --to '120 ms'")]
pub struct Arguments {
    /// The run
    run: PathBuf,

    /// The measurement that the run is rated by
    measured: PathBuf,

    /// A channel of the run, and the channel of the measurement for it; may be repeated
    #[arg(long = "channel", value_name = "RUN=MEASURED", value_parser = pair)]
    channels: Vec<(String, String)>,

    /// Begin of the rating [default: where both begin]
    #[arg(long, value_name = "TIME", value_parser = quantity::any_time, allow_hyphen_values = true)]
    from: Option<f64>,

    /// End of the rating [default: where one of them ends]
    #[arg(long, value_name = "TIME", value_parser = quantity::any_time, allow_hyphen_values = true)]
    to: Option<f64>,

    /// Filter both by this channel frequency class before they are rated: CFC60, CFC180, CFC600, CFC1000
    #[arg(long, value_name = "CLASS", value_parser = class)]
    filter: Option<Class>,

    /// The standard of the filter
    #[arg(long, value_name = "NAME", default_value = ISO, value_parser = filter_standard())]
    filter_standard: Standard,

    /// Interpolate linearly between samples that are more than 0.1 ms apart
    #[arg(long)]
    resample: bool,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// The names of the standards of filters.
pub(super) const ISO: &str = "iso6487";
const SAE: &str = "sae-j211";

/// A standard of filters by its name.
pub(super) fn filter_standard() -> impl TypedValueParser<Value = Standard> {
    PossibleValuesParser::new([ISO, SAE]).map(|name| match name.as_str() {
        SAE => Standard::SaeJ211,
        _ => Standard::Iso6487,
    })
}

/// Two names, separated by `=`.
pub(super) fn pair(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((run, measured)) if !run.trim().is_empty() && !measured.trim().is_empty() => {
            Ok((run.trim().to_owned(), measured.trim().to_owned()))
        }
        _ => Err("give two names, as 'head acceleration=11HEADCG00H3ACRA'".to_owned()),
    }
}

/// The rating of a channel.
struct Rated {
    run: String,
    measured: String,
    rating: Rating,
    /// Begin and end of the rating \[s\].
    interval: [f64; 2],
}

impl Arguments {
    /// Reads the two files and rates their channels.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let run = recording(&self.run)?;
        let measured = recording(&self.measured)?;
        let pairs = self.pairs(&run, &measured)?;
        for damaged in run.damaged.iter().chain(&measured.damaged) {
            terminal.note(&format!("left out, and not needed: {}", said(damaged)));
        }
        let mut rated = Vec::new();
        let mut failed = Vec::new();
        for (run, measured) in pairs {
            if let Some(doubt) = [(run, &self.run), (measured, &self.measured)]
                .into_iter()
                .find_map(|(channel, path)| doubt(channel, path))
            {
                if self.channels.is_empty() {
                    terminal.note(&format!("\"{}\" is not rated: {doubt}", run.name));
                    failed.push(doubt);
                    continue;
                }
                terminal.note(&doubt);
            }
            match self.rated(run, measured)? {
                Some(one) => rated.push(one),
                None => terminal.note(&format!(
                    "\"{}\" is not rated: the measurement does not change",
                    run.name
                )),
            }
        }
        if let (true, Some(doubt)) = (rated.is_empty(), failed.first()) {
            return Err(Error::Input(format!(
                "no channel is left to be rated: {doubt}\n  help: name it, --channel RUN=MEASURED, to rate it all the same"
            )));
        }
        match self.json {
            true => terminal.print_json(&rated.iter().map(json).collect::<Vec<_>>()),
            false => terminal.print(&text(&rated)),
        }
    }

    /// The pairs of channels that are compared: those of the user, or all with the same name.
    fn pairs<'r>(
        &self,
        run: &'r Recording,
        measured: &'r Recording,
    ) -> Result<Vec<(&'r Channel, &'r Channel)>, Error> {
        let named = self.channels.iter().map(|(ours, theirs)| {
            Ok((
                channel(run, &self.run, ours)?,
                channel(measured, &self.measured, theirs)?,
            ))
        });
        if !self.channels.is_empty() {
            return named.collect();
        }
        // a damaged channel would have been compared with the one of its name
        let has = |of: &Recording, name: &String| {
            of.channel(name) != Err(NoChannel::Unknown) || of.damaged(name).is_some()
        };
        for (one, other) in [(run, measured), (measured, run)] {
            let compared = |damaged: &&Damaged| damaged.names.iter().any(|name| has(other, name));
            if let Some(damaged) = one.damaged.iter().find(compared) {
                return Err(Error::Input(said(damaged)));
            }
        }
        let mut pairs = Vec::new();
        for ours in &run.channels {
            match measured.channel(&ours.name) {
                Err(NoChannel::Unknown) => {}
                found => {
                    let theirs = found
                        .map_err(|error| no_channel(error, measured, &self.measured, &ours.name))?;
                    pairs.push((channel(run, &self.run, &ours.name)?, theirs));
                }
            }
        }
        match pairs.is_empty() {
            true => Err(Error::Input(format!(
                "{} and {} have no channel of the same name\n  help: say which are the same: --channel '{}={}'",
                self.run.display(),
                self.measured.display(),
                run.channels.first().map_or("RUN", |channel| &channel.name),
                measured
                    .channels
                    .first()
                    .map_or("MEASURED", |channel| &channel.name),
            ))),
            false => Ok(pairs),
        }
    }

    /// The rating of a pair of channels; `None` if the user did not name the pair and the channels do not change.
    fn rated(&self, run: &Channel, measured: &Channel) -> Result<Option<Rated>, Error> {
        let wrong = |message: String| Error::Input(format!("channel \"{}\": {message}", run.name));
        let factor = unit::factor(&run.unit, &measured.unit).ok_or_else(|| {
            wrong(format!(
                "its unit is `{}`, and that of \"{}\" is `{}`\n  help: compare channels of one quantity, with units that are known",
                run.unit, measured.name, measured.unit
            ))
        })?;
        let mut ours = run.signal.clone();
        ours.values.iter_mut().for_each(|value| *value *= factor);
        let ours = self.prepared(&run.name, &ours, &self.run).map_err(wrong)?;
        let theirs = self
            .prepared(&measured.name, &measured.signal, &self.measured)
            .map_err(wrong)?;
        let begin = self.from.unwrap_or(ours.first.max(theirs.first));
        let end = self.to.unwrap_or(ours.last().min(theirs.last()));
        let there = [ours.first.max(theirs.first), ours.last().min(theirs.last())];
        // a smaller difference is due to rounding
        let rounding = 1e-3 / RATE;
        if begin < there[0] - rounding || end > there[1] + rounding || begin >= end {
            return Err(wrong(format!(
                "it cannot be rated from {begin} s to {end} s: both have samples from {} s to {} s\n  help: give other --from and --to",
                there[0], there[1]
            )));
        }
        let samples = |signal: &Signal| signal.resampled(begin, end, 1.0 / RATE).values;
        let rating = match rate(&samples(&theirs), &samples(&ours)) {
            Err(RatingError::Constant) if self.channels.is_empty() => return Ok(None),
            rating => rating.map_err(|error| wrong(error.to_string()))?,
        };
        Ok(Some(Rated {
            run: run.name.clone(),
            measured: measured.name.clone(),
            rating,
            interval: [begin, end],
        }))
    }

    /// The signal for the rating: its samples are close enough, and it is filtered if requested.
    fn prepared(&self, name: &str, signal: &Signal, path: &Path) -> Result<Signal, String> {
        let coarse = signal.interval * RATE > 1.0 + 1e-6;
        if coarse && !self.resample {
            return Err(format!(
                "{} has a sample every {:.3} ms, and ISO 18571 wants 10 kHz, one every 0.1 ms\n  \
                 help: write the run with --every '0.1 ms'; or --resample, which takes straight lines between the samples",
                path.display(),
                1e3 * signal.interval
            ));
        }
        let Some(class) = self.filter else {
            return Ok(signal.clone());
        };
        match class_of_code(name) {
            Some(before) if before == class => return Ok(signal.clone()),
            // frequencies that an earlier filter removed cannot be restored for a wider filter
            Some(before) if before.frequency() < class.frequency() => {
                return Err(format!(
                    "the channel {name} of {} is filtered by {before} already, and {class} is wanted\n  help: give --filter {before}",
                    path.display()
                ));
            }
            _ => {}
        }
        filtered(signal, class, self.filter_standard)
            .map_err(|error| format!("{}: {error}", path.display()))
    }
}

/// Reads a recording.
pub(super) fn recording(path: &Path) -> Result<Recording, Error> {
    of_file(path, Recording::read)
}

/// Reads a file that must exist.
pub(super) fn of_file<R>(
    path: &Path,
    read: impl FnOnce(&Path) -> Result<R, ReadError>,
) -> Result<R, Error> {
    if !path.exists() {
        return Err(Error::Input(format!(
            "there is no file {}\n  help: name a table of `bryant run`, or a test in ISO-MME: its folder or its .mme file",
            path.display()
        )));
    }
    read(path).map_err(|error| match error {
        ReadError::Io { .. } => Error::system(error),
        ReadError::Content { .. } => Error::input(error),
    })
}

/// The channel of a recording by its name.
pub(super) fn channel<'r>(
    recording: &'r Recording,
    path: &Path,
    name: &str,
) -> Result<&'r Channel, Error> {
    if let Some(damaged) = recording.damaged(name) {
        return Err(Error::Input(said(damaged)));
    }
    let found = recording.channel(name);
    found.map_err(|error| no_channel(error, recording, path, name))
}

/// The error for a name that no channel, or several channels, of a recording have.
fn no_channel(error: NoChannel, recording: &Recording, path: &Path, name: &str) -> Error {
    if let NoChannel::Several(count) = error {
        return Error::Input(format!(
            "{} has {count} channels \"{name}\"\n  help: give every channel a name of its own",
            path.display()
        ));
    }
    let names: Vec<&str> = recording
        .channels
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let help = match nearest(name, &names) {
        Some(near) => format!("did you mean \"{near}\"?"),
        None => format!("it has: {}", names.join(", ")),
    };
    Error::Input(format!(
        "{} has no channel \"{name}\"\n  help: {help}",
        path.display()
    ))
}

/// A sentence about the status that casts doubt on a channel's data; `None` if there is no doubt.
pub(super) fn doubt(channel: &Channel, path: &Path) -> Option<String> {
    let doubt = channel.doubt.as_ref()?;
    Some(format!(
        "the channel {} of {} says of its data: \"{doubt}\"",
        channel.name,
        path.display()
    ))
}

fn text(rated: &[Rated]) -> String {
    let name = |one: &Rated| match one.run == one.measured {
        true => one.run.clone(),
        false => format!("{} ({})", one.run, one.measured),
    };
    let width = rated
        .iter()
        .map(|one| name(one).chars().count())
        .max()
        .unwrap_or(0)
        .max(7);
    let mut text = format!(
        "{:width$}  corridor  phase  magnitude  slope  rating  grade      late        from      to\n",
        "channel"
    );
    for one in rated {
        let Rating {
            corridor,
            phase,
            magnitude,
            slope,
            late,
        } = one.rating;
        let _ = writeln!(
            text,
            "{:width$}  {corridor:8.3}  {phase:5.3}  {magnitude:9.3}  {slope:5.3}  {:6.3}  {:9}  {:>6.1} ms  {:>5.1} ms  {:>5.1} ms",
            name(one),
            one.rating.overall(),
            one.rating.grade(),
            late as f64 / RATE * 1e3,
            one.interval[0] * 1e3,
            one.interval[1] * 1e3,
        );
    }
    text
}

fn json(rated: &Rated) -> serde_json::Value {
    let rating = &rated.rating;
    json!({
        "run": rated.run,
        "measured": rated.measured,
        "from": rated.interval[0],
        "to": rated.interval[1],
        "corridor": rating.corridor,
        "phase": rating.phase,
        "magnitude": rating.magnitude,
        "slope": rating.slope,
        "rating": rating.overall(),
        "grade": rating.grade().to_string(),
        "late": rating.late as f64 / RATE,
    })
}
