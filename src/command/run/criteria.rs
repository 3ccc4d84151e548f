//! Injury criteria of a run. They are responses with samples of their own, which do not depend on the rows of the
//! table.

use super::{Arguments, Error};
use crate::command::criteria::places;
use crate::command::response::Requested;
use crate::criteria::{Row, Verdict, mode};
use crate::simulation::Recording;
use bryant_runtime::Response;
use bryant_runtime::program::Kept;
use bryant_runtime::response::channel::Combination;
use bryant_runtime::response::filter::Standard;
use bryant_runtime::response::{Channel, exceedance_of};
use bryant_study::criteria::limits::Limits;
use bryant_study::criteria::{Judged, Missing, judge};
use bryant_study::facts::{CriteriaFact, ModelFacts};
use bryant_study::response::What;

/// The criteria that a run is judged by.
pub struct Criteria {
    limits: Limits,
    judged: Vec<Judged>,
}

impl Criteria {
    /// The criteria that the command line or the model requests; `None` if there are none.
    ///
    /// # Errors
    /// There is no such regulation, dummy, place or output, or there are outputs for none of the criteria.
    pub fn of(arguments: &Arguments, facts: &ModelFacts) -> Result<Option<Self>, Error> {
        let named = places(&arguments.place);
        let asked = match (&arguments.criteria, &facts.criteria) {
            (Some((standard, dummy)), own) => {
                let sae = match arguments.filter_standard {
                    Some(of) => of == Standard::SaeJ211,
                    None => own.as_ref().is_some_and(|own| own.sae),
                };
                let occupant = own.as_ref().and_then(|own| own.occupant.clone());
                let own = own.iter().flat_map(|own| own.places.iter().cloned());
                let others = own.filter(|(place, _)| named.iter().all(|(name, _)| name != place));
                CriteriaFact {
                    standard: standard.clone(),
                    dummy: dummy.clone(),
                    sae,
                    occupant: arguments.occupant.clone().or(occupant),
                    places: others.chain(named.iter().cloned()).collect(),
                }
            }
            (None, Some(own)) if named.is_empty() => CriteriaFact {
                occupant: arguments.occupant.clone().or(own.occupant.clone()),
                sae: arguments
                    .filter_standard
                    .map_or(own.sae, |of| of == Standard::SaeJ211),
                ..own.clone()
            },
            (None, _) => {
                if arguments.occupant.is_some() {
                    return Err(Error::Input(
                        "--occupant: an occupant belongs to criteria, and there are none\n  help: add --criteria 'REGULATION, DUMMY'; `bryant criteria --list` has them".to_owned(),
                    ));
                }
                return match named.first() {
                    Some((place, _)) => Err(Error::Input(format!(
                        "--place {place}: a place belongs to criteria, and there are none\n  help: add --criteria 'REGULATION, DUMMY'; `bryant criteria --list` has them"
                    ))),
                    None => Ok(None),
                };
            }
        };
        let (limits, judged) = judge(facts, &asked).map_err(Error::Input)?;
        if judged.iter().all(|one| one.response.is_err()) {
            return Err(Error::Input(format!(
                "the model has no output that a criterion of {} is computed from\n  \
                 help: name outputs, as --place 'head=head acceleration', or give them their `code`",
                limits.standard
            )));
        }
        Ok(Some(Criteria { limits, judged }))
    }

    /// The responses of the criteria, in their order.
    pub fn responses(&self) -> impl Iterator<Item = Requested> {
        let there = self
            .judged
            .iter()
            .filter_map(|one| one.response.as_ref().ok());
        there.map(Requested::of_study)
    }

    /// Channels whose samples are kept for more than one number, in the order of the criteria: the filtered signals of
    /// the neck, for the mode of Nij, and those whose limit falls with the duration of the load.
    pub fn kept(&self) -> Vec<Kept> {
        let of = |one: &Judged| {
            let Ok(response) = &one.response else {
                return Vec::new();
            };
            let channel = response.channel;
            match (channel.combination, response.what) {
                (Combination::Nij(_), _) => {
                    let each = channel.outputs().iter();
                    let itself = |output: &usize| {
                        Channel::of(&[*output], channel.filter, Combination::Itself)
                    };
                    each.filter_map(itself).collect()
                }
                (_, What::Exceedance { .. }) => vec![channel],
                _ => Vec::new(),
            }
        };
        let kept = self.judged.iter().flat_map(of).map(|channel| Kept {
            channel,
            in_place_of: None,
        });
        kept.collect()
    }

    /// The verdict on a run. The values of its responses begin at index `first`, the kept signals at index `kept`.
    /// `None` if the run did not reach its end, or cannot be trusted.
    pub fn verdict(
        &self,
        recording: &Recording,
        [first, kept]: [usize; 2],
        every: f64,
    ) -> Option<Verdict> {
        if recording.answers.is_empty() {
            return None;
        }
        let mut answers = recording.answers.iter().skip(first);
        let mut kept = recording.kept.iter().skip(kept).map(Vec::as_slice);
        let rows = self.judged.iter().map(|one| {
            let (mut detail, mut duration) = (one.detail.clone(), None);
            let value = one
                .response
                .as_ref()
                .map_err(Missing::clone)
                .and_then(|response| {
                    if let Combination::Nij(neck) = response.channel.combination
                        && let (Some(fx), Some(fz), Some(my)) =
                            (kept.next(), kept.next(), kept.next())
                    {
                        let mode = mode([fx, fz, my], &neck, [recording.first_time(), every]);
                        let both = [mode, std::mem::take(&mut detail)];
                        let both: Vec<String> =
                            both.into_iter().filter(|text| !text.is_empty()).collect();
                        detail = both.join("; ");
                    }
                    let value = answers.next().map_or(f64::NAN, |answer| answer.value);
                    if let What::Exceedance { limit } = response.what
                        && let Some(samples) = kept.next()
                    {
                        let scratch = Response::Exceedance { limit }.scratch(samples.len());
                        let mut scratch = vec![0.0; scratch];
                        let worst = exceedance_of(samples, &limit, every, &mut scratch);
                        duration = Some(worst.duration);
                    }
                    match value.is_finite() {
                        true => Ok(value),
                        false => Err(Missing::Unusable("the run has no answer to it".to_owned())),
                    }
                });
            Row::new(
                one.criterion,
                one.limit.as_ref(),
                value,
                duration,
                detail,
                one.channels.clone(),
            )
        });
        Some(Verdict {
            // outputs already show their codes, so the occupant need not be named
            occupant: None,
            left_out: Vec::new(),
            rows: rows.collect(),
            limits: self.limits.clone(),
        })
    }
}
