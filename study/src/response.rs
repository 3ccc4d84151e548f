//! Responses: one number per run, read off the time series of an output. Here is what they are called and measured in; how
//! they are computed is the engine's.

use crate::quantity::dimension;
use bryant_generator::description::unit::Dimension;
use bryant_runtime::response::Channel;
use bryant_runtime::response::filter::Filter;
use serde::Serialize;

/// Raised whenever what a response is computed as changes beyond rounding, or what it is computed from: results of both kinds are
/// then never mixed. 2: clips are those of the line through the samples.
pub const REVISION: u32 = 2;

/// A number read off each run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Response {
    /// Heading of its column, unique.
    pub name: String,
    /// What it is read off: outputs of the model, by their indices.
    #[serde(rename = "output", serialize_with = "as_text")]
    pub channel: Channel,
    /// Names of the outputs.
    pub of: String,
    /// What is read off.
    pub what: What,
    /// SI unit of the number, "" for a pure one.
    pub unit: String,
}

impl Response {
    /// The time between samples that its filter needs at most \[s\], where it has one.
    pub fn longest_interval(&self) -> Option<f64> {
        self.channel
            .filter
            .map(|filter| filter.class.longest_interval())
    }
}

/// An output as it is by its number, a channel of others by all that it is.
fn as_text<S: serde::Serializer>(channel: &Channel, to: S) -> Result<S::Ok, S::Error> {
    match channel.plain() {
        Some(output) => to.serialize_u64(output as u64),
        None => to.serialize_str(&format!("{channel:?}")),
    }
}

/// The channel of an output, filtered where the filter of a name is given.
pub fn channel_of(output: usize, filter: Option<&str>) -> Channel {
    let mut channel = Channel::output(output);
    channel.filter = filter.and_then(Filter::named);
    channel
}

/// What is read off a series x(t), t from 0 to the end T.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum What {
    /// max x
    Peak,
    /// min x
    Minimum,
    /// max |x|
    Magnitude,
    /// When x is largest \[s\].
    TimeOfPeak,
    /// When x is least \[s\].
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
    /// The largest value that x exceeds for this long, all parts together, as in FMVSS 208.
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
    /// The occupant load criterion of the pulse of a vehicle.
    Olc,
}

/// Every kind by the name that a study gives it; times of those that need one are filled in later.
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

impl What {
    /// The kind by its name, with its time still 0.
    pub fn named(name: &str) -> Option<What> {
        NAMES
            .iter()
            .find(|(n, _)| *n == name)
            .map(|(_, what)| *what)
    }

    /// Whether it is of accelerations alone.
    pub fn is_injury_criterion(self) -> bool {
        matches!(self, What::Hic15 | What::Hic36 | What::Olc)
    }

    /// The window that it looks at \[s\], where it does.
    pub fn window(self) -> Option<f64> {
        match self {
            What::Hic15 => Some(15e-3),
            What::Hic36 => Some(36e-3),
            What::Clip { duration } | What::ContiguousClip { duration } => Some(duration),
            _ => None,
        }
    }

    /// Its unit, of an output in `unit`.
    pub fn unit(self, unit: &str) -> String {
        match self {
            What::TimeOfPeak | What::TimeOfMinimum => "s".into(),
            What::Hic15 | What::Hic36 => String::new(),
            What::Integral => {
                let product =
                    dimension(unit).unwrap_or(Dimension::ONE) * Dimension::new(0, 0, 1, 0);
                product.to_string()
            }
            _ => unit.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_follow_from_the_output() {
        assert_eq!(What::Integral.unit("N"), "kg*m/s");
        assert_eq!(What::Integral.unit(""), "s");
        assert_eq!(What::Peak.unit("m/s^2"), "m/s^2");
        assert_eq!(What::TimeOfPeak.unit("m/s^2"), "s");
        assert_eq!(What::Hic15.unit("m/s^2"), "");
    }
}
