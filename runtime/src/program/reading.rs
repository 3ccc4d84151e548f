//! Evaluates responses of a single run.

use crate::batch::rows::Asked;
use crate::response::{Answer, Channel, Response, reduce};
use crate::{Real, Task};

/// The responses, kept channels and works to record over a whole run. They use equidistant samples, in addition to
/// those of the rows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Number of intervals between samples, at least 1. The samples do not change the motion.
    pub intervals: u64,
    /// The responses asked for. Their times are times of the run, whatever time it begins at.
    pub asked: Vec<Asked>,
    /// Channels whose samples are kept.
    pub kept: Vec<Kept>,
    /// Least time between stored works of effects \[s\]; `None`: none are stored.
    pub works_every: Option<f64>,
}

/// A channel whose samples are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kept {
    /// The channel.
    pub channel: Channel,
    /// The output that this channel replaces in what is shown, if any.
    pub in_place_of: Option<usize>,
}

impl Reading {
    /// Number of parts of the run at whose ends there is a sample; 0 where nothing is asked for.
    pub(super) fn parts(&self) -> u64 {
        match self.asked.is_empty() && self.kept.is_empty() {
            true => 0,
            false => self.intervals.max(1),
        }
    }
}

/// The samples of all outputs that a reading needs.
pub(super) struct Signals<'a, T> {
    reading: &'a Reading,
    /// Index and samples of each output that is needed.
    outputs: Vec<(usize, Vec<T>)>,
}

impl<'a, T: Real> Signals<'a, T> {
    /// No samples yet.
    pub fn of(reading: &'a Reading) -> Self {
        let of = |asked: &'a Asked| asked.channel.outputs();
        let mut outputs: Vec<usize> = reading.asked.iter().flat_map(of).copied().collect();
        outputs.extend(reading.kept.iter().flat_map(|kept| kept.channel.outputs()));
        outputs.sort_unstable();
        outputs.dedup();
        let outputs = outputs.into_iter().map(|index| (index, Vec::new()));
        Signals {
            reading,
            outputs: outputs.collect(),
        }
    }

    /// Adds the outputs of the next sample.
    pub fn add(&mut self, outputs: &[T]) {
        for (index, samples) in &mut self.outputs {
            samples.push(outputs[*index]);
        }
    }

    /// The samples of an output; none where it is not needed.
    fn samples(&self, output: usize) -> &[T] {
        let found = self.outputs.iter().find(|(index, _)| *index == output);
        found.map_or(&[], |(_, samples)| samples)
    }

    /// The samples of the kept channels; none of a channel that cannot be filtered.
    pub fn kept(&self, [start, end]: [f64; 2]) -> Vec<Vec<f64>> {
        let every = (end - start) / self.reading.intervals.max(1) as f64;
        let of = |kept: &Kept| {
            let formed = kept
                .channel
                .form(|output| self.samples(output).to_vec(), every);
            let formed = formed.unwrap_or_default();
            formed.iter().map(|sample| sample.to_f64()).collect()
        };
        self.reading.kept.iter().map(of).collect()
    }

    /// The answers for a run from `start` to `end` \[s\].
    pub fn answers(&self, [start, end]: [f64; 2]) -> Vec<Answer> {
        let duration = end - start;
        let every = duration / self.reading.intervals.max(1) as f64;
        let mut scratch = Vec::new();
        let samples = |output: usize| self.samples(output);
        let mut answer = |asked: &Asked| {
            let formed;
            let samples = match asked.channel.plain() {
                Some(output) => samples(output),
                None => {
                    formed = asked
                        .channel
                        .form(|output| samples(output).to_vec(), every)
                        .unwrap_or_default();
                    &formed[..]
                }
            };
            let nothing = T::from_f64(f64::NAN);
            // responses count time from the first sample
            let response = match asked.response {
                Response::Value { at } => Response::Value { at: at - start },
                response => response,
            };
            scratch.resize(response.scratch(samples.len()), nothing);
            let value = T::dispatch(Reduce {
                response,
                samples,
                every,
                scratch: &mut scratch,
            });
            let value = match response {
                Response::TimeOfPeak | Response::TimeOfMinimum => start + value.to_f64(),
                _ => value.to_f64(),
            };
            let largest = samples.iter().map(|sample| sample.to_f64().abs());
            Answer::new(response, value, largest.fold(0.0, f64::max), duration)
        };
        self.reading.asked.iter().map(&mut answer).collect()
    }
}

struct Reduce<'a, T> {
    response: Response,
    samples: &'a [T],
    every: f64,
    scratch: &'a mut [T],
}

impl<T: Real> Task for Reduce<'_, T> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        reduce(self.response, self.samples, self.every, self.scratch)
    }
}
