//! Judges a run or a recording by injury criteria: their values beside the limits of a regulation.
//!
//! | file | what |
//! |---|---|
//! | `recording` | the criteria of a recording: a test, or a table of a run |
//!
//! [`bryant_study::criteria`] defines the criteria.

mod recording;

pub use recording::{Recorded, said, verdict};

use bryant_runtime::response::channel::{ARM, Neck};
use bryant_study::criteria::limits::{Limit, Limits};
use bryant_study::criteria::{Criterion, Missing, choice};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The criteria of a dummy beside the limits of a regulation.
pub struct Verdict {
    /// The limits.
    pub limits: Limits,
    /// Test object and position of the occupant; `None` if no channel code names an occupant.
    pub occupant: Option<String>,
    /// Channels of the occupant that are not used, because their files cast doubt on them, with the reasons, and
    /// damaged channels that are not needed.
    pub left_out: Vec<String>,
    /// The criteria, in their order.
    pub rows: Vec<Row>,
}

/// A criterion with its value.
pub struct Row {
    /// The criterion.
    pub criterion: &'static Criterion,
    /// Its limit, in the criterion's unit; `None` if it has no limit. Of a limit that falls with the duration of a
    /// load, the one for `duration`.
    pub limit: Option<f64>,
    /// Its value, in the criterion's unit; or the reason why there is none.
    pub value: Result<f64, Missing>,
    /// The time for which the value is exceeded in total \[s\], if the limit falls with it.
    pub duration: Option<f64>,
    /// A remark on the value, such as the mode of Nij.
    pub detail: String,
    /// The channels or outputs that it was computed from, each with its place.
    pub channels: Vec<(String, String)>,
}

impl Row {
    /// A criterion with its value \[SI\] or the reason why there is none; `limit` is the limit of the regulation. If it
    /// falls with the duration of the load, the value is the largest ratio to it, and `duration` \[s\] is that of the
    /// largest ratio: the row then has the level and the limit for this duration.
    pub fn new(
        criterion: &'static Criterion,
        limit: Option<&Limit>,
        value: Result<f64, Missing>,
        duration: Option<f64>,
        detail: String,
        channels: Vec<(String, String)>,
    ) -> Row {
        let falling = limit.and_then(|limit| limit.falling(criterion.scale));
        let (limit, duration) = match (limit, falling, duration) {
            (Some(Limit::Constant(limit)), ..) => (Some(*limit), None),
            (_, Some(falling), Some(duration)) => {
                let here = falling.at(duration) / criterion.scale;
                (Some(here), Some(duration))
            }
            _ => (None, None),
        };
        let (value, detail) = match (limit, duration) {
            (Some(limit), Some(duration)) => {
                let held = match duration > 0.0 {
                    true => format!("exceeded for {:.1} ms in total", 1e3 * duration),
                    false => "its peak".to_owned(),
                };
                let both = [held, detail];
                let said: Vec<String> = both.into_iter().filter(|text| !text.is_empty()).collect();
                (value.map(|ratio| ratio * limit), said.join("; "))
            }
            _ => (value.map(|value| value / criterion.scale), detail),
        };
        Row {
            criterion,
            limit,
            value,
            duration,
            detail,
            channels,
        }
    }
}

impl Verdict {
    /// The whole verdict for people: each criterion with its value, its limit, whether it is met, its filter and
    /// remarks; then the channels that were used.
    pub fn text(&self) -> String {
        let mut text = format!("{} ({})", self.heading(), self.limits.source);
        text.push_str("\n\ncriterion              value     limit  unit  verdict         filter\n");
        for (row, value) in self.judged() {
            let filter = filter(row.criterion, &self.limits);
            let line = format!("{:53} {filter:7}  {}", of_row(row, value), row.detail);
            let _ = writeln!(text, "{}", line.trim_end());
        }
        self.name_channels(&mut text);
        text
    }

    /// The verdict in short: each criterion with its value, its limit and whether it is met.
    pub fn summary(&self) -> String {
        let mut text = self.heading();
        text.push('\n');
        for (row, value) in self.judged() {
            let _ = writeln!(text, "{}", of_row(row, value));
        }
        text
    }

    /// The rest of the verdict: filters, remarks, the channels that were used, and criteria that were not judged.
    pub fn remarks(&self) -> String {
        let mut text = format!("criteria: {}\n", self.limits.source);
        for (row, _) in self.judged() {
            let filter = filter(row.criterion, &self.limits);
            let line = format!("{:18} {filter:7}  {}", row.criterion.name, row.detail);
            let _ = writeln!(text, "{}", line.trim_end());
        }
        self.name_channels(&mut text);
        text
    }

    /// Regulation and dummy, and the occupant if it was chosen.
    fn heading(&self) -> String {
        let limits = &self.limits;
        let mut text = format!("{}, {}", limits.standard, limits.dummy);
        if let Some(occupant) = &self.occupant {
            let seat = match choice::seat(occupant) {
                "" => String::new(),
                seat => format!(" ({seat})"),
            };
            let _ = write!(text, ", occupant {occupant}{seat}");
        }
        text
    }

    /// The criteria that have a value.
    fn judged(&self) -> impl Iterator<Item = (&Row, f64)> {
        let value = |row: &'_ Row| row.value.as_ref().ok().copied();
        self.rows
            .iter()
            .filter_map(move |row| Some((row, value(row)?)))
    }

    /// Writes which channels were used, and which were not.
    fn name_channels(&self, text: &mut String) {
        for (index, (row, _)) in self.judged().enumerate() {
            let names: Vec<&str> = row.channels.iter().map(|(_, name)| name.as_str()).collect();
            let begin = if index == 0 { "\nread from\n" } else { "" };
            let _ = writeln!(
                text,
                "{begin}{:18} {}",
                row.criterion.name,
                names.join(", ")
            );
        }
        if !self.left_out.is_empty() {
            let all = self.left_out.join(", ");
            let _ = write!(text, "\nleft out, because of what their files say: {all}\n");
        }
        if let Some((name, code)) = self.other_dummy() {
            let _ = write!(
                text,
                "\nthe code {name} is of another dummy, {code}: the limits are those of {}\n",
                self.limits.dummy
            );
        }
        let missing = self.rows.iter().filter_map(|row| match &row.value {
            Ok(_) => None,
            Err(Missing::Place(why) | Missing::Unusable(why)) => {
                Some(format!("{} ({why})", row.criterion.name))
            }
        });
        let missing: Vec<String> = missing.collect();
        if !missing.is_empty() {
            let _ = write!(
                text,
                "\nnot judged, because there is no channel of: {}\n",
                missing.join(", ")
            );
        }
    }

    /// A channel whose code names another dummy than the limits, and the code of that dummy; `None` if there is no such
    /// channel.
    fn other_dummy(&self) -> Option<(&str, &str)> {
        let own = self.limits.code.as_deref()?;
        let mut all = self.rows.iter().flat_map(|row| &row.channels);
        all.find_map(|(_, name)| {
            let says = name.get(10..12).filter(|_| name.len() == 16)?;
            (says != own && says != "00").then_some((name.as_str(), says))
        })
    }

    /// The verdict as JSON.
    pub fn json(&self) -> Value {
        let criteria = self.rows.iter().map(|row| {
            let missing = match &row.value {
                Ok(_) => None,
                Err(Missing::Place(text) | Missing::Unusable(text)) => Some(text.as_str()),
            };
            let value = row.value.as_ref().ok();
            json!({
                "criterion": row.criterion.name,
                "value": value,
                "limit": row.limit,
                "unit": row.criterion.unit,
                "met": value.zip(row.limit).map(|(value, limit)| *value <= limit),
                "filter": row.criterion.class(&self.limits).map(|class| class.to_string()),
                "duration": row.duration,
                "detail": row.detail,
                "channels": row.channels.iter().cloned().collect::<std::collections::BTreeMap<_, _>>(),
                "missing": missing,
            })
        });
        json!({
            "standard": self.limits.standard,
            "dummy": self.limits.dummy,
            "source": self.limits.source,
            "occupant": self.occupant,
            "left_out": self.left_out,
            "criteria": criteria.collect::<Vec<_>>(),
        })
    }
}

/// The line of a criterion: its value, its limit and whether it is met.
fn of_row(row: &Row, value: f64) -> String {
    let criterion = row.criterion;
    let verdict = row.limit.map(|limit| verdict_of(value, limit));
    let line = format!(
        "{:18} {:>9} {:>9}  {:4}  {}",
        criterion.name,
        number(value),
        row.limit.map_or("none".to_owned(), number),
        criterion.unit,
        verdict.unwrap_or_default()
    );
    line.trim_end().to_owned()
}

/// The name of the filter of a criterion, for a table.
pub fn filter(criterion: &Criterion, limits: &Limits) -> String {
    let class = criterion.class(limits).map(|class| class.to_string());
    class.unwrap_or_else(|| "none".to_owned())
}

/// A number with about four digits.
fn number(value: f64) -> String {
    match value.abs() {
        size if size >= 1000.0 => format!("{value:.0}"),
        size if size >= 100.0 => format!("{value:.1}"),
        size if size >= 10.0 => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}

fn verdict_of(value: f64, limit: f64) -> String {
    let share = 100.0 * (value / limit - 1.0).abs();
    let share = match share < 0.95 {
        true => format!("{share:.1}"),
        false => format!("{share:.0}"),
    };
    match value <= limit {
        true => format!("met by {share} %"),
        false => format!("MISSED by {share} %"),
    }
}

/// The mode of Nij at its maximum, with its time. The filtered signals are the shear force, the axial force and the
/// moment of the neck's load cell; their samples are `interval` \[s\] apart, and the first is at `first` \[s\].
pub fn mode([fx, fz, my]: [&[f64]; 3], critical: &Neck, [first, interval]: [f64; 2]) -> String {
    let mut worst = (0.0, String::new());
    for (index, ((fx, fz), my)) in fx.iter().zip(fz).zip(my).enumerate() {
        let moment = my - ARM * fx;
        let (force, axial) = match *fz >= 0.0 {
            true => (fz / critical.tension, "tension"),
            false => (-fz / critical.compression, "compression"),
        };
        let (bent, bending) = match moment >= 0.0 {
            true => (moment / critical.flexion, "flexion"),
            false => (-moment / critical.extension, "extension"),
        };
        if force + bent > worst.0 {
            let time = 1e3 * (first + index as f64 * interval);
            let text = format!("{axial} and {bending} at {time:.1} ms");
            worst = (force + bent, text);
        }
    }
    worst.1
}
