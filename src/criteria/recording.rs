//! The criteria of a recording: a test, or the table of a run.

use super::{Row, Verdict, mode};
use crate::sweep::response_of;
use bryant_runtime::response::channel::Combination;
use bryant_runtime::response::filter::Class;
use bryant_runtime::response::{Response, exceedance_of, reduce};
use bryant_signal::filter::{Standard, class_of_code, filtered, narrow_filter};
use bryant_signal::{Channel, Damaged, NoChannel, Recording, Signal, unit};
use bryant_study::criteria::choice::{self, Asked, Candidate, Choice, Found, choose, is_pattern};
use bryant_study::criteria::limits::Limits;
use bryant_study::criteria::{CRITERIA, Criterion, Formed, Missing, PLACES};

/// The channels of a recording at the places of a dummy.
pub struct Recorded<'a> {
    recording: &'a Recording,
    choice: Choice,
    /// The damaged channels that stand behind the sound ones in the choice.
    damaged: Vec<&'a Damaged>,
    /// True if the motion is planar: quantities across the plane are 0.
    planar: bool,
    /// The standard whose coefficients the filters have.
    standard: Standard,
}

impl<'a> Recorded<'a> {
    /// Finds the channels at the places: those that the user names, else those with the channel code of the place, all
    /// of one `occupant`. If `planar`, nothing moves along y.
    ///
    /// # Errors
    /// There is no such place or no such channel, a channel that is named is damaged, or there are channels of several
    /// occupants.
    pub fn new(
        recording: &'a Recording,
        named: &[(String, String)],
        occupant: Option<&str>,
        planar: bool,
        standard: Standard,
    ) -> Result<Self, String> {
        let mut asked = Asked {
            occupant: occupant.map(str::to_owned),
            how: "--occupant",
            ..Asked::default()
        };
        for (place, name) in named {
            choice::known(place, name)?;
            if let Some(damaged) = recording.damaged(name) {
                return Err(said(damaged));
            }
            match recording.channel(name) {
                Ok(channel) => {
                    let all = &recording.channels;
                    let index = all.iter().position(|one| std::ptr::eq(one, channel));
                    asked
                        .named
                        .extend(index.map(|index| (place.clone(), index)));
                }
                Err(NoChannel::Unknown) if is_pattern(name) => {
                    asked.patterns.push((place.clone(), name.clone()));
                }
                Err(NoChannel::Unknown) => {
                    let channels = recording.channels.iter();
                    let all: Vec<&str> = channels.map(|one| one.name.as_str()).collect();
                    return Err(format!(
                        "the recording has no channel \"{name}\"\n  help: it has {}",
                        all.join(", ")
                    ));
                }
                Err(several) => {
                    return Err(format!(
                        "\"{name}\": {several}\n  help: give every channel a name of its own"
                    ));
                }
            }
        }
        let each = recording.channels.iter().map(|channel| Candidate {
            name: &channel.name,
            code: &channel.name,
            doubt: channel.doubt.as_deref(),
        });
        // a damaged channel might have been used wherever one of its names fits
        let names = |one: &'a Damaged| one.names.iter().map(move |name| (name, one));
        let all = recording.damaged.iter().flat_map(names);
        let (names, damaged): (Vec<&String>, Vec<&Damaged>) = all.unzip();
        let damaged_ones = names.iter().map(|name| Candidate {
            name,
            code: name,
            doubt: None,
        });
        let candidates: Vec<Candidate<'_>> = each.chain(damaged_ones).collect();
        Ok(Recorded {
            recording,
            damaged,
            choice: choose(&candidates, &asked)?,
            planar,
            standard,
        })
    }

    /// A damaged channel that might have been used at a place.
    fn damaged_at(&self, place: &str) -> Option<&'a Damaged> {
        let all = match self.choice.at(place)? {
            Found::Named(_) => return None,
            Found::Coded(all) | Found::Doubtful(all) | Found::Several(all) => all,
        };
        let behind = |index: &usize| index.checked_sub(self.recording.channels.len());
        let mut damaged = all.iter().filter_map(behind);
        damaged.find_map(|index| self.damaged.get(index).copied())
    }

    /// The channel at a place for a criterion with this filter. If there are channels with several filters, it is the
    /// one with this filter, else the one with the widest.
    fn channel(&self, place: &str, class: Option<Class>) -> Result<&'a Channel, Missing> {
        if let Some(damaged) = self.damaged_at(place) {
            return Err(Missing::Unusable(said(damaged)));
        }
        let channel = |index: &usize| &self.recording.channels[*index];
        let names = |all: &[usize]| {
            all.iter()
                .map(|index| channel(index).name.as_str())
                .collect()
        };
        match self.choice.at(place) {
            None => Err(Missing::Place(place.to_owned())),
            Some(Found::Named(index)) => Ok(channel(index)),
            Some(Found::Coded(all)) => {
                let width = |index: &&usize| {
                    let name = &channel(index).name;
                    match (class_of_code(name), narrow_filter(name)) {
                        (Some(own), _) if Some(own) == class => f64::INFINITY,
                        (Some(own), _) => own.frequency(),
                        (None, Some(_)) => 0.0,
                        // the channel has no filter, or a wide one
                        (None, None) => f64::MAX,
                    }
                };
                let widest = all.iter().max_by(|a, b| width(a).total_cmp(&width(b)));
                Ok(channel(widest.unwrap_or(&all[0])))
            }
            Some(Found::Doubtful(all)) => {
                let channel = channel(&all[0]);
                let doubt = channel.doubt.as_deref().unwrap_or_default();
                Err(Missing::Unusable(format!(
                    "channel \"{}\": its file says \"{doubt}\"; a channel that is named by --place {place}=CHANNEL is used all the same",
                    channel.name
                )))
            }
            Some(Found::Several(all)) => {
                let names: Vec<&str> = names(all);
                let begin = names[0].get(2..10).unwrap_or_default();
                Err(Missing::Unusable(format!(
                    "{}; choose a sensor, such as --place '{}=??{begin}*', or name a channel for each place",
                    choice::ambiguous(place, &names),
                    choice::part(place)
                )))
            }
        }
    }

    /// The signal at a place \[SI\] with the filter of the criterion, its channel, and a remark on it.
    fn filtered(
        &self,
        place: &str,
        criterion: &Criterion,
        class: Option<Class>,
    ) -> Result<(Signal, &'a Channel, String), Missing> {
        let missing = || Missing::Place(place.to_owned());
        let channel = self.channel(place, class)?;
        let place = PLACES.iter().find(|known| known.name == place);
        let place = place.ok_or_else(missing)?;
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
        let remark = channel.doubt.as_ref();
        let remark = remark.map_or(String::new(), |doubt| {
            format!("{}: its file says \"{doubt}\"", channel.name)
        });
        let Some(class) = class else {
            let missing = signal.values.iter().position(|value| !value.is_finite());
            return match missing {
                Some(index) => Err(wrong(format!(
                    "the sample at {} s is missing",
                    signal.time(index)
                ))),
                None => Ok((signal, channel, remark)),
            };
        };
        if let Some(before) = narrow_filter(&channel.name) {
            return Err(wrong(format!(
                "it is filtered by {before} already, and {class} is wanted"
            )));
        }
        match class_of_code(&channel.name) {
            Some(before) if before == class => return Ok((signal, channel, remark)),
            Some(before) if criterion.allows(before) => {
                return Ok((signal, channel, format!("filtered by {before} before")));
            }
            // frequencies that an earlier filter removed cannot be restored for a wider filter
            Some(before) if before.frequency() < class.frequency() => {
                return Err(wrong(format!(
                    "it is filtered by {before} already, and {class} is wanted"
                )));
            }
            _ => {}
        }
        match filtered(&signal, class, self.standard) {
            Ok(signal) => Ok((signal, channel, remark)),
            Err(error) => Err(wrong(error.to_string())),
        }
    }

    /// The places whose signals the criterion needs, and how they are combined.
    fn formed(&self, criterion: &Criterion, limits: &Limits) -> Result<Formed, Missing> {
        criterion.formed(
            limits,
            &|place| self.choice.at(place).is_some(),
            self.planar,
        )
    }

    /// The value of a criterion \[SI\]. Places and names of the channels that it uses are added to `channels`.
    fn value(
        &self,
        criterion: &Criterion,
        limits: &Limits,
        channels: &mut Vec<(String, String)>,
    ) -> Result<Value, Missing> {
        let formed = self.formed(criterion, limits)?;
        let mut signals = Vec::new();
        let mut remarks = vec![formed.detail.to_owned()];
        for place in &formed.places {
            let (signal, channel, remark) =
                self.filtered(place, criterion, criterion.class(limits))?;
            channels.push((place.clone(), channel.name.clone()));
            signals.push(signal);
            if !remarks.contains(&remark) {
                remarks.push(remark);
            }
        }
        let signals = together(signals)?;
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
        if let (Combination::Nij(neck), [fx, fz, my]) = (formed.combination, &values[..]) {
            remarks.insert(0, mode([fx, fz, my], &neck, [first, every]));
        }
        remarks.retain(|remark| !remark.is_empty());
        let duration = match response {
            Response::Exceedance { limit } => {
                Some(exceedance_of(&samples, &limit, every, &mut scratch).duration)
            }
            _ => None,
        };
        Ok(Value {
            value,
            duration,
            detail: remarks.join("; "),
        })
    }

    /// True if several sensors fit a place of the criterion, or a damaged channel might have been used there.
    fn is_unclear(&self, criterion: &Criterion, limits: &Limits) -> bool {
        let places = self
            .formed(criterion, limits)
            .map_or(vec![], |formed| formed.places);
        let unclear = |place: &String| {
            matches!(self.choice.at(place), Some(Found::Several(_)))
                || self.damaged_at(place).is_some()
        };
        places.iter().any(unclear)
    }

    /// Channels of the occupant whose files cast doubt on them, with the reasons, and damaged channels.
    fn left_out(&self) -> Vec<String> {
        let occupant = self.choice.occupant.as_deref().unwrap_or_default();
        let all = self.recording.channels.iter();
        let own = all.filter(|channel| channel.name.starts_with(occupant));
        let each = own.filter_map(|channel| {
            let doubt = channel.doubt.as_ref()?;
            Some(format!("{} (\"{doubt}\")", channel.name))
        });
        let damaged = self.recording.damaged.iter();
        let damaged = damaged.map(|one| format!("{} (damaged)", one.names.join(" or ")));
        each.chain(damaged).collect()
    }
}

/// The value of a criterion.
struct Value {
    /// \[SI\]; the largest ratio of the load to its limit, if that falls with the duration of the load.
    value: f64,
    /// The duration of the largest ratio \[s\], if there is one.
    duration: Option<f64>,
    /// A remark on it.
    detail: String,
}

/// The verdict on a recording: all criteria that the regulation limits, and others for which there are channels that no
/// limited criterion uses.
pub fn verdict(limits: &Limits, recorded: &Recorded<'_>) -> Verdict {
    let is_limited = |criterion: &Criterion| limits.of(criterion).is_some();
    let places = |criterion: &Criterion| {
        recorded
            .formed(criterion, limits)
            .map_or(vec![], |formed| formed.places)
    };
    let limited = CRITERIA.iter().filter(|one| is_limited(one));
    let limited: Vec<String> = limited.flat_map(places).collect();
    let shown = CRITERIA.iter().filter(|one| {
        let places = places(one);
        let apart = !places.is_empty() && places.iter().all(|place| !limited.contains(place));
        // a criterion without a limit is shown only if it is clear which sensor it belongs to
        is_limited(one) || apart && !recorded.is_unclear(one, limits)
    });
    let rows = shown.map(|criterion| {
        let mut channels = Vec::new();
        let value = recorded.value(criterion, limits, &mut channels);
        let (value, duration, detail) = match value {
            Ok(found) => (Ok(found.value), found.duration, found.detail),
            Err(missing) => (Err(missing), None, String::new()),
        };
        Row::new(
            criterion,
            limits.of(criterion),
            value,
            duration,
            detail,
            channels,
        )
    });
    let rows: Vec<Row> = rows.collect();
    let used = |name: &String| {
        let mut all = rows.iter().flat_map(|row| &row.channels);
        all.any(|(_, channel)| name.starts_with(channel.as_str()))
    };
    let left_out = recorded.left_out().into_iter().filter(|one| !used(one));
    Verdict {
        left_out: left_out.collect(),
        occupant: recorded.choice.occupant.clone(),
        limits: limits.clone(),
        rows,
    }
}

/// A damaged channel in words, with its damage.
pub fn said(damaged: &Damaged) -> String {
    format!(
        "channel \"{}\" is damaged: {}",
        damaged.names.join("\" or \""),
        damaged.error
    )
}

/// Returns the signals if all have the same times; else an error.
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
