//! Injury criteria of a run: of a run with the same settings, sampled as they need it, whatever the rows of the table.

use super::{Arguments, Error, Trust};
use crate::accuracy::setting::Setting;
use crate::command::criteria::{find, json_of, text, usable};
use crate::command::model_argument::Found;
use crate::criteria::limits::{self, Limits};
use crate::criteria::{Judged, Places, judge};
use crate::simulation::{self, Recording, Runs};
use bryant_generator::model::{Dimension, Model};
use bryant_runtime::program::Job;
use bryant_signal::{Channel, Recording as Signals, Signal};
use serde_json::Value;

/// Time between the samples \[s\]: what the filter CFC1000 needs.
const EVERY: f64 = 1e-4;

/// What a run is judged by.
pub struct Criteria {
    limits: Limits,
    named: Vec<(String, String)>,
    planar: bool,
}

/// The verdict of a run; none where it did not come to its end.
pub struct Verdict<'c> {
    criteria: &'c Criteria,
    judged: Option<Vec<Judged>>,
}

impl Criteria {
    /// What is asked for, if anything.
    ///
    /// # Errors
    /// There is no such regulation, dummy, place or output, or the run would have too many samples.
    pub fn of(arguments: &Arguments, found: &Found) -> Result<Option<Self>, Error> {
        let Some((standard, dummy)) = &arguments.criteria else {
            return match arguments.place.first() {
                Some((place, _)) => Err(Error::Input(format!(
                    "--place {place}: places are those of criteria\n  help: add --criteria 'REGULATION, DUMMY'; `bryant criteria --list` has them"
                ))),
                None => Ok(None),
            };
        };
        let model = &found.model;
        let criteria = Criteria {
            limits: find(&limits::all(), standard, dummy)?.clone(),
            named: arguments.place.clone(),
            planar: model.dimension == Dimension::Plane,
        };
        let duration = arguments.duration.unwrap_or(model.run.duration);
        if duration / EVERY > super::MOST_ROWS {
            return Err(Error::Input(format!(
                "--criteria: a run of {duration} s has more samples at 10 kHz than are kept\n  help: give a shorter --duration"
            )));
        }
        // wrong names are told before the run
        criteria.places(&signals(model, None))?;
        Ok(Some(criteria))
    }

    fn places<'s>(&self, signals: &'s Signals) -> Result<Places<'s>, Error> {
        Places::new(signals, &self.named, self.planar).map_err(Error::Input)
    }

    /// The verdict of a run, which is made once more with samples at 10 kHz.
    ///
    /// # Errors
    /// A channel cannot be used, or the run with more samples fails or cannot be trusted.
    pub fn verdict(
        &self,
        model: &Model,
        evaluated: &dyn Runs,
        (job, recording, trust): (&Job, &Recording, &Trust),
    ) -> Result<Verdict<'_>, Error> {
        if recording.result.is_err() {
            return Ok(Verdict {
                criteria: self,
                judged: None,
            });
        }
        let setting = trust.setting().unwrap_or(Setting::of(job));
        let mut job = setting.job(job);
        job.reading = Default::default();
        job.every = Some(EVERY);
        let again = simulation::run(evaluated, &job, &mut |_| {});
        // its rows change its steps, so it is another run, as accurate as that of the table; it is trusted as that is
        if let Some(doubt) = again.doubts.first().filter(|_| recording.doubts.is_empty()) {
            return Err(Error::failed(format!(
                "the run that the criteria are read off cannot be trusted: {}\n  help: {}",
                doubt.message, doubt.remedy
            )));
        }
        if let Err(error) = &again.result {
            return Err(Error::failed(format!(
                "the run that the criteria are read off did not come to its end: {}",
                error.message
            )));
        }
        let signals = signals(model, Some(&again));
        let judged = judge(&self.limits, &self.places(&signals)?);
        usable(&judged)?;
        Ok(Verdict {
            criteria: self,
            judged: Some(judged),
        })
    }
}

impl Verdict<'_> {
    /// For people.
    pub fn text(&self) -> String {
        match &self.judged {
            Some(judged) => text(&self.criteria.limits, judged),
            None => "The criteria are not judged: the run did not come to its end.\n".to_owned(),
        }
    }

    /// For programs; null where the run did not come to its end.
    pub fn json(&self) -> Value {
        let judged = self.judged.as_ref();
        judged.map_or(Value::Null, |judged| json_of(&self.criteria.limits, judged))
    }
}

/// The outputs of a run as channels, by their channel codes where they have such; without a run, channels without samples. A code says that nothing is
/// filtered, for nothing is.
fn signals(model: &Model, run: Option<&Recording>) -> Signals {
    let channel = |(index, output): (usize, &bryant_generator::model::Output)| {
        let signal = run.and_then(|run| {
            let [times, columns @ ..] = run.table.columns.as_slice() else {
                return None;
            };
            let (mut times, mut values) = (&times.values[..], &columns[index].values[..]);
            // the last row is that of the end, which may come sooner
            if let [.., before, last] = times
                && last - before < 0.999 * EVERY
            {
                times = &times[..times.len() - 1];
                values = &values[..times.len()];
            }
            Signal::of_samples(times, values)
        });
        let code = output.code.as_ref().map(|code| format!("{}0", &code[..15]));
        Channel {
            title: code.as_ref().map_or(String::new(), |_| output.name.clone()),
            name: code.unwrap_or_else(|| output.name.clone()),
            unit: output.unit.clone(),
            signal: signal.unwrap_or(Signal {
                first: 0.0,
                interval: EVERY,
                values: Vec::new(),
            }),
        }
    };
    Signals {
        channels: model.outputs.iter().enumerate().map(channel).collect(),
    }
}
