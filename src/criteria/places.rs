//! Which channel of a recording is which place of a dummy.

use super::{Missing, unusable};
use bryant_signal::filter::{Class, Standard, filtered};
use bryant_signal::{Channel, Recording, Signal, unit};

/// A place where a dummy measures: its name, the channel codes of ISO-MME that mean it, with `?` for any character, and its SI unit.
pub const PLACES: [(&str, &str, &str); 14] = [
    ("head", "??HEADCG????ACR?", "m/s^2"),
    ("head-x", "??HEADCG????ACX?", "m/s^2"),
    ("head-y", "??HEADCG????ACY?", "m/s^2"),
    ("head-z", "??HEADCG????ACZ?", "m/s^2"),
    ("neck-fx", "??NECKUP????FOX?", "N"),
    ("neck-fz", "??NECKUP????FOZ?", "N"),
    ("neck-my", "??NECKUP????MOY?", "N*m"),
    ("chest", "??CHST??????ACR?", "m/s^2"),
    ("chest-x", "??CHST??????ACX?", "m/s^2"),
    ("chest-y", "??CHST??????ACY?", "m/s^2"),
    ("chest-z", "??CHST??????ACZ?", "m/s^2"),
    ("chest-deflection", "??CHST??????DSX?", "m"),
    ("femur-left", "??FEMRLE????FOZ?", "N"),
    ("femur-right", "??FEMRRI????FOZ?", "N"),
];

/// The places of a recording.
pub struct Places<'a> {
    recording: &'a Recording,
    /// Channels that were named for places.
    named: Vec<(String, String)>,
    /// What is across the plane is 0.
    planar: bool,
}

impl<'a> Places<'a> {
    /// The places of a recording: by the channels that are named for them, else by their codes. `planar` says that nothing moves along y.
    ///
    /// # Errors
    /// A name is that of no place, or of no channel.
    pub fn new(
        recording: &'a Recording,
        named: &[(String, String)],
        planar: bool,
    ) -> Result<Self, String> {
        for (place, name) in named {
            if PLACES.iter().all(|(known, ..)| known != place) {
                let all: Vec<&str> = PLACES.iter().map(|(place, ..)| *place).collect();
                return Err(format!(
                    "there is no place \"{place}\"\n  help: one of {}",
                    all.join(", ")
                ));
            }
            if recording.channel(name).is_none() {
                let all: Vec<&str> = recording
                    .channels
                    .iter()
                    .map(|one| one.name.as_str())
                    .collect();
                return Err(format!(
                    "the recording has no channel \"{name}\"\n  help: it has {}",
                    all.join(", ")
                ));
            }
        }
        Ok(Places {
            recording,
            named: named.to_vec(),
            planar,
        })
    }

    fn channel(&self, place: &str) -> Option<&'a Channel> {
        if let Some((_, name)) = self.named.iter().find(|(known, _)| known == place) {
            return self.recording.channel(name);
        }
        let (_, code, _) = PLACES.iter().find(|(known, ..)| *known == place)?;
        self.recording
            .channels
            .iter()
            .find(|channel| fits(&channel.name, code))
    }

    /// The signal of a place \[SI\], filtered.
    pub fn filtered(&self, place: &str, class: Class) -> Result<Signal, Missing> {
        let channel = self
            .channel(place)
            .ok_or_else(|| Missing::Channel(place.to_owned()))?;
        let wrong =
            |message: String| Missing::Unusable(format!("channel \"{}\": {message}", channel.name));
        let wanted = PLACES
            .iter()
            .find(|(known, ..)| *known == place)
            .map_or("", |known| known.2);
        let factor = unit::factor(&channel.unit, wanted).ok_or_else(|| {
            wrong(format!(
                "its unit is `{}`, and {place} is in {wanted}",
                channel.unit
            ))
        })?;
        // what a filter has taken away is not there for a wider one
        let before = Class::of_code(&channel.name);
        if let Some(before) = before.filter(|before| before.frequency() < class.frequency()) {
            return Err(wrong(format!(
                "it is filtered by {before} already, and {class} is wanted"
            )));
        }
        let mut signal = channel.signal.clone();
        signal.values.iter_mut().for_each(|value| *value *= factor);
        if before == Some(class) {
            return Ok(signal);
        }
        filtered(&signal, class, Standard::Iso6487).map_err(|error| match unusable(&error) {
            Missing::Unusable(message) => wrong(message),
            missing => missing,
        })
    }

    /// The resultant of a place \[SI\]: of its filtered components, or, where there are none, of its own channel; with what is to be said of that.
    pub fn resultant(&self, place: &str, class: Class) -> Result<(Signal, String), Missing> {
        let component = |axis: &str| self.filtered(&format!("{place}-{axis}"), class);
        let along_x = match component("x") {
            Err(Missing::Channel(_)) if self.channel(place).is_some() => {
                let signal = self.filtered(place, class)?;
                return Ok((signal, "filtered as a resultant".to_owned()));
            }
            found => found?,
        };
        let along_y = match component("y") {
            Err(Missing::Channel(_)) if self.planar => Signal {
                values: vec![0.0; along_x.values.len()],
                ..along_x
            },
            found => found?,
        };
        let [mut x, y, z] = together([along_x, along_y, component("z")?])?;
        for (x, (y, z)) in x.values.iter_mut().zip(y.values.iter().zip(&z.values)) {
            *x = (*x * *x + y * y + z * z).sqrt();
        }
        Ok((x, String::new()))
    }
}

/// Signals of one time: with the same samples.
pub fn together<const N: usize>(signals: [Signal; N]) -> Result<[Signal; N], Missing> {
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

/// Whether a channel code fits one with wild cards.
fn fits(code: &str, pattern: &str) -> bool {
    code.len() == pattern.len()
        && code
            .chars()
            .zip(pattern.chars())
            .all(|(a, b)| b == '?' || a == b)
}
