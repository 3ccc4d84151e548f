//! The criteria of a recording: a test, or a table of a run.

use super::{Row, Verdict, mode};
use crate::sweep::response_of;
use bryant_runtime::response::channel::Combination;
use bryant_runtime::response::filter::Class;
use bryant_runtime::response::reduce;
use bryant_signal::filter::{Standard, class_of_code, filtered};
use bryant_signal::{Channel, Recording, Signal, unit};
use bryant_study::criteria::limits::Limits;
use bryant_study::criteria::{CRITERIA, Criterion, Formed, Missing, PLACES, Place, fits};

/// The places that a recording has channels for.
pub struct Recorded<'a> {
    recording: &'a Recording,
    /// Channels that the user named for places.
    named: Vec<(String, String)>,
    /// The motion is planar: quantities across the plane are 0.
    planar: bool,
    /// The standard whose coefficients the filters have.
    standard: Standard,
}

impl<'a> Recorded<'a> {
    /// The places of a recording: their channels are found by the names that the user gives, else by their codes. `planar` says that
    /// nothing moves along y.
    ///
    /// # Errors
    /// There is no such place, or no such channel.
    pub fn new(
        recording: &'a Recording,
        named: &[(String, String)],
        planar: bool,
        standard: Standard,
    ) -> Result<Self, String> {
        for (place, name) in named {
            if PLACES.iter().all(|known| known.name != place) {
                let all: Vec<&str> = PLACES.iter().map(|place| place.name).collect();
                return Err(format!(
                    "there is no place \"{place}\"\n  help: one of {}",
                    all.join(", ")
                ));
            }
            if recording.channel(name).is_none() {
                let channels = recording.channels.iter();
                let all: Vec<&str> = channels.map(|one| one.name.as_str()).collect();
                return Err(format!(
                    "the recording has no channel \"{name}\"\n  help: it has {}",
                    all.join(", ")
                ));
            }
        }
        Ok(Recorded {
            recording,
            named: named.to_vec(),
            planar,
            standard,
        })
    }

    fn channel(&self, place: &Place) -> Option<&'a Channel> {
        let named = self.named.iter().find(|(known, _)| known == place.name);
        match named {
            Some((_, name)) => self.recording.channel(name),
            None => {
                let mut channels = self.recording.channels.iter();
                channels.find(|channel| fits(&channel.name, place.code))
            }
        }
    }

    /// The signal of a place \[SI\], filtered if a class is given.
    fn filtered(&self, place: &str, class: Option<Class>) -> Result<Signal, Missing> {
        let missing = || Missing::Place(place.to_owned());
        let place = PLACES.iter().find(|known| known.name == place);
        let place = place.ok_or_else(missing)?;
        let channel = self.channel(place).ok_or_else(missing)?;
        let wrong =
            |message: String| Missing::Unusable(format!("channel \"{}\": {message}", channel.name));
        let factor = unit::factor(&channel.unit, place.unit).ok_or_else(|| {
            wrong(format!(
                "its unit is `{}`, and {} is in {}",
                channel.unit, place.name, place.unit
            ))
        })?;
        let mut signal = channel.signal.clone();
        signal.values.iter_mut().for_each(|value| *value *= factor);
        let Some(class) = class else {
            let missing = signal.values.iter().position(|value| !value.is_finite());
            return match missing {
                Some(index) => Err(wrong(format!(
                    "the sample at {} s is missing",
                    signal.time(index)
                ))),
                None => Ok(signal),
            };
        };
        // frequencies that a filter has removed cannot be restored for a wider filter
        let before = class_of_code(&channel.name);
        if let Some(before) = before.filter(|before| before.frequency() < class.frequency()) {
            return Err(wrong(format!(
                "it is filtered by {before} already, and {class} is wanted"
            )));
        }
        if before == Some(class) {
            return Ok(signal);
        }
        filtered(&signal, class, self.standard).map_err(|error| wrong(error.to_string()))
    }

    /// The signals of a criterion, and how they are combined.
    fn formed(&self, criterion: &Criterion, limits: &Limits) -> Result<Formed, Missing> {
        let has = |place: &str| {
            let place = PLACES.iter().find(|known| known.name == place);
            place.is_some_and(|place| self.channel(place).is_some())
        };
        criterion.formed(limits, &has, self.planar)
    }

    /// The value of a criterion \[SI\], with a remark on it.
    fn value(&self, criterion: &Criterion, limits: &Limits) -> Result<(f64, String), Missing> {
        let formed = self.formed(criterion, limits)?;
        let signals = formed.places.iter();
        let signals: Result<Vec<Signal>, Missing> = signals
            .map(|place| self.filtered(place, criterion.filter))
            .collect();
        let signals = together(signals?)?;
        let (first, every) = (signals[0].first, signals[0].interval);
        let values: Vec<Vec<f64>> = signals.into_iter().map(|signal| signal.values).collect();
        let short = || Missing::Unusable("the recording is too short for it".to_owned());
        let samples = formed.combination.form(&values, every).ok_or_else(short)?;
        let response = response_of(formed.what);
        let mut scratch = vec![0.0; response.scratch(samples.len())];
        let value = reduce(response, &samples, every, &mut scratch);
        if !value.is_finite() {
            return Err(short());
        }
        let detail = match (formed.combination, &values[..]) {
            (Combination::Nij(neck), [fx, fz, my]) => mode([fx, fz, my], &neck, [first, every]),
            _ => formed.detail.to_owned(),
        };
        Ok((value, detail))
    }
}

/// The verdict on a recording: all criteria that the regulation limits, and the criteria at places for which it limits none.
pub fn verdict(limits: &Limits, recorded: &Recorded<'_>) -> Verdict {
    let limit = |criterion: &Criterion| limits.limits.get(criterion.name).copied();
    let places = |criterion: &Criterion| {
        recorded
            .formed(criterion, limits)
            .map_or(vec![], |formed| formed.places)
    };
    let limited = CRITERIA.iter().filter(|one| limit(one).is_some());
    let limited: Vec<String> = limited.flat_map(places).collect();
    let shown = CRITERIA.iter().filter(|one| {
        let places = places(one);
        let apart = !places.is_empty() && places.iter().all(|place| !limited.contains(place));
        limit(one).is_some() || apart
    });
    let rows = shown.map(|criterion| {
        let value = recorded.value(criterion, limits);
        let (value, detail) = match value {
            Ok((value, detail)) => (Ok(value / criterion.scale), detail),
            Err(missing) => (Err(missing), String::new()),
        };
        Row {
            criterion,
            limit: limit(criterion),
            value,
            detail,
        }
    });
    Verdict {
        rows: rows.collect(),
        limits: limits.clone(),
    }
}

/// The signals, if they have the same times.
fn together(signals: Vec<Signal>) -> Result<Vec<Signal>, Missing> {
    let first = &signals[0];
    let same = |other: &Signal| {
        let rounding = 1e-3 * first.interval;
        other.values.len() == first.values.len()
            && (other.first - first.first).abs() < rounding
            && (other.last() - first.last()).abs() < rounding
    };
    match signals.iter().all(same) {
        true => Ok(signals),
        false => Err(Missing::Unusable(
            "its channels have samples at different times".to_owned(),
        )),
    }
}
