//! Responses: each is one number that is computed from the time series of outputs of a run. This file has their names
//! and units; the engine computes them.
//! them.

use crate::facts::OutputFact;
use crate::quantity::dimension;
use bryant_generator::description::unit::Dimension;
use bryant_generator::diagnostic::quoted;
use bryant_generator::model::units::Unit;
use bryant_runtime::response::filter::Filter;
use bryant_runtime::response::{Channel, FallingLimit};
use serde::Serialize;

/// Version of the computation of responses. It is raised when results change by more than rounding, so that results of
/// two versions are never mixed. 2: clips use the straight lines between samples.
pub const REVISION: u32 = 2;

/// A number read off each run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Response {
    /// Heading of its column; no other response has it.
    pub name: String,
    /// The channel that it is computed from: outputs of the model, by their indices.
    #[serde(rename = "output", serialize_with = "as_text")]
    pub channel: Channel,
    /// Names of the outputs.
    pub of: String,
    /// The kind of response.
    pub what: What,
    /// The unit of the number.
    #[serde(flatten)]
    pub unit: Unit,
}

impl Response {
    /// The warning about a response of an acceleration that no instrument reads, with a remedy.
    pub fn caution(&self, outputs: &[OutputFact]) -> Option<String> {
        let mut of = self.channel.outputs().iter();
        of.find_map(|index| self.what.caution(outputs.get(*index)?))
    }

    /// The longest time between samples that its filter allows \[s\], if it has a filter.
    pub fn longest_interval(&self) -> Option<f64> {
        self.channel
            .filter
            .map(|filter| filter.class.longest_interval())
    }
}

/// Stores a channel of one output without a filter as the index of the output, and other channels with all their parts.
fn as_text<S: serde::Serializer>(channel: &Channel, to: S) -> Result<S::Ok, S::Error> {
    match channel.plain() {
        Some(output) => to.serialize_u64(output as u64),
        None => to.serialize_str(&format!("{channel:?}")),
    }
}

/// The channel of an output, filtered if the name of a filter is given.
pub fn channel_of(output: usize, filter: Option<&str>) -> Channel {
    let mut channel = Channel::output(output);
    channel.filter = filter.and_then(Filter::named);
    channel
}

/// The kind of number that is computed from a series x(t), 0 ≤ t ≤ T.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum What {
    /// max x
    Peak,
    /// min x
    Minimum,
    /// max |x|
    Magnitude,
    /// Time of the largest x \[s\].
    TimeOfPeak,
    /// Time of the least x \[s\].
    TimeOfMinimum,
    /// max x − min x
    Range,
    /// ∫ x dt / T
    Mean,
    /// x(T)
    Final,
    /// x at a time \[s\].
    Value {
        /// \[s\]
        at: f64,
    },
    /// Head injury criterion over at most 15 ms.
    Hic15,
    /// Head injury criterion over at most 36 ms.
    Hic36,
    /// The largest value that x exceeds for this total time, in one or several parts, as in FMVSS 208.
    Clip {
        /// \[s\]
        duration: f64,
    },
    /// The largest value that x exceeds for this long without a break.
    ContiguousClip {
        /// \[s\]
        duration: f64,
    },
    /// max |x − x(0)|
    Excursion,
    /// ∫ x dt
    Integral,
    /// The occupant load criterion of a vehicle's pulse.
    Olc,
    /// The largest ratio of |x| to a limit that falls with the total time for which a level is exceeded. It belongs to
    /// criteria, and has no name of its own.
    Exceedance {
        /// In SI.
        #[serde(serialize_with = "corners")]
        limit: FallingLimit,
    },
}

/// Stores a limit as its corners.
fn corners<S: serde::Serializer>(limit: &FallingLimit, to: S) -> Result<S::Ok, S::Error> {
    limit.corners().serialize(to)
}

/// The names of all kinds in a study. Their times are filled in later.
pub const NAMES: [(&str, What); 16] = [
    ("peak", What::Peak),
    ("minimum", What::Minimum),
    ("magnitude", What::Magnitude),
    ("time of peak", What::TimeOfPeak),
    ("time of minimum", What::TimeOfMinimum),
    ("range", What::Range),
    ("mean", What::Mean),
    ("final", What::Final),
    ("value", What::Value { at: 0.0 }),
    ("HIC15", What::Hic15),
    ("HIC36", What::Hic36),
    ("clip", What::Clip { duration: 0.0 }),
    ("contiguous clip", What::ContiguousClip { duration: 0.0 }),
    ("excursion", What::Excursion),
    ("integral", What::Integral),
    ("OLC", What::Olc),
];

/// Synonyms: the name of a kind, and other words for it.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub const MEANT: [(&str, &[&str]); 12] = [
    (
        "peak",
        &[
            "max",
            "maximum",
            "largest",
            "highest",
            "peak value",
            "maximal",
        ],
    ),
    (
        "minimum",
        &["min", "least", "lowest", "smallest", "minimal"],
    ),
    (
        "magnitude",
        &[
            "abs",
            "absolute",
            "absolute maximum",
            "absolute peak",
            "abs max",
            "max abs",
            "maximum absolute",
            "absmax",
            "modulus",
        ],
    ),
    (
        "time of peak",
        &[
            "time of maximum",
            "time of max",
            "time of the peak",
            "argmax",
        ],
    ),
    ("time of minimum", &["time of min", "argmin"]),
    ("range", &["span", "peak to peak", "amplitude", "spread"]),
    ("mean", &["average", "avg", "mean value"]),
    ("final", &["last", "end", "end value", "final value"]),
    ("clip", &["3 ms", "3ms", "a3ms"]),
    ("HIC15", &["hic", "head injury criterion"]),
    ("excursion", &["travel", "movement"]),
    ("integral", &["impulse", "area", "time integral"]),
];

/// The name of the kind that a synonym stands for.
pub fn meant(word: &str) -> Option<&'static str> {
    let word = word.trim().to_lowercase().replace(['_', '-'], " ");
    let of = MEANT
        .iter()
        .find(|(_, words)| words.contains(&word.as_str()));
    of.map(|(name, _)| *name)
}

impl What {
    /// The kind with this name; its time is still 0.
    pub fn named(name: &str) -> Option<What> {
        NAMES
            .iter()
            .find(|(n, _)| *n == name)
            .map(|(_, what)| *what)
    }

    /// True if it needs an acceleration.
    pub fn is_injury_criterion(self) -> bool {
        matches!(self, What::Hic15 | What::Hic36 | What::Olc)
    }

    /// True if it is meant for readings of accelerometers.
    fn is_of_instrument(self) -> bool {
        self.is_injury_criterion()
            || matches!(self, What::Clip { .. } | What::ContiguousClip { .. })
    }

    /// The warning, with a remedy, if this response is meant for readings of instruments and the output is an
    /// acceleration that none can measure.
    pub fn caution(self, of: &OutputFact) -> Option<String> {
        let why = of.unread.as_ref().filter(|_| self.is_of_instrument())?;
        Some(format!(
            "{} is no reading of an instrument: {why}\n  help: take `what: accelerometer` for criteria",
            quoted(&of.name)
        ))
    }

    /// The length of its time window \[s\], if it has one.
    pub fn window(self) -> Option<f64> {
        match self {
            What::Hic15 => Some(15e-3),
            What::Hic36 => Some(36e-3),
            What::Clip { duration } | What::ContiguousClip { duration } => Some(duration),
            _ => None,
        }
    }

    /// Its unit, for an output in `unit`.
    pub fn unit(self, unit: &str) -> String {
        match self {
            What::TimeOfPeak | What::TimeOfMinimum => "s".into(),
            What::Hic15 | What::Hic36 | What::Exceedance { .. } => String::new(),
            What::Integral => {
                let product =
                    dimension(unit).unwrap_or(Dimension::ONE) * Dimension::new(0, 0, 1, 0);
                product.to_string()
            }
            _ => unit.to_owned(),
        }
    }
}
