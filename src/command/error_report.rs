//! Reports what is known about the error of a run, for people and as JSON.

use super::Error;
use crate::accuracy::cause::Cause;
use crate::accuracy::check::{Certainty, FAR, Verdict};
use crate::accuracy::comparison::PROMISED;
use crate::accuracy::conclusion::percent;
use crate::accuracy::difference::Difference;
use crate::accuracy::setting::{Setting, time};
use bryant_runtime::program::{ErrorKind, Header, RunError};
use serde_json::{Value, json};

/// Largest number of outputs in a list.
const NAMED: usize = 8;
/// A smaller difference is a rounding error, because runs in double precision cannot resolve more.
const ROUNDING: f64 = 1e-12;

/// What is known about the error of a run, and the outputs that it is about.
pub struct ErrorReport {
    outputs: Vec<String>,
    pub known: Certainty,
}

impl ErrorReport {
    /// A report about a run with these outputs.
    pub fn new(header: &Header, known: Certainty) -> Self {
        ErrorReport {
            outputs: header.outputs.iter().map(|o| o.name.clone()).collect(),
            known,
        }
    }

    /// The setting, if the program chose it.
    pub fn setting(&self) -> Option<Setting> {
        self.known.setting
    }

    /// The relative difference of each requested response from the run that this run was compared with; `None` if it
    /// was not compared.
    pub fn responses(&self) -> Option<&[f64]> {
        let checked = match &self.known.check {
            Some((_, Verdict::Apart(difference))) => Some(difference),
            _ => None,
        };
        let difference = checked.or(self.known.estimate.as_ref())?;
        (!difference.responses.is_empty()).then_some(&difference.responses[..])
    }

    /// One line that says how far the outputs can be trusted; [`lines`](Self::lines) says more.
    pub fn summary(&self) -> String {
        let within = |difference: &Difference, who: String| {
            format!(
                "every output within {}, as {who}",
                at_most(difference.worst)
            )
        };
        match (&self.known.check, &self.known.estimate) {
            (Some((opinion, Verdict::Apart(difference))), _) => {
                let who = format!("a second run by {} shows", opinion.scheme().name());
                within(difference, who)
            }
            (Some((opinion, Verdict::Failed(_))), _) => {
                format!("not checked: {} failed", opinion.name())
            }
            (Some((_, Verdict::TooLong(limit))), _) => format!(
                "not checked: a second run takes longer than {} (--verify waits for it)",
                time(*limit)
            ),
            (None, Some(estimate)) => within(estimate, format!("{} runs show", self.known.runs)),
            (None, None) => "not checked".to_owned(),
        }
    }

    /// The report for people, line by line.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.known.wanted.is_some()
            && let Some(setting) = &self.known.setting
        {
            let error = match &self.known.estimate {
                Some(estimate) => format!("estimated error at most {}", worst(estimate)),
                None => "its error is not known".to_owned(),
            };
            lines.push(format!(
                "{error}, by {} ({} runs)",
                setting.name(),
                self.known.runs
            ));
            lines.extend(self.known.estimate.iter().flat_map(vanishing));
        }
        if let (Some(first), Some(setting)) = (&self.known.first, &self.known.setting) {
            // the difference that was the reason for sharper runs
            let away = match first.worst <= PROMISED && first.worst_response > PROMISED {
                true => format!("{} of a response", percent(first.worst_response)),
                false => worst(first),
            };
            lines.push(format!(
                "sharpened to {} ({} runs): the first run differed by {away}",
                setting.name(),
                self.known.runs,
            ));
        }
        lines.extend(self.by_response());
        match &self.known.check {
            Some((opinion, Verdict::Apart(difference))) => {
                lines.push(format!(
                    "checked by {}: differs by {}",
                    opinion.name(),
                    worst(difference)
                ));
                lines.extend(self.by_output(difference));
                lines.extend(vanishing(difference));
            }
            Some((opinion, Verdict::Failed(message))) => {
                lines.push(format!("not checked: {} failed: {message}", opinion.name()));
            }
            Some((opinion, Verdict::TooLong(limit))) => {
                lines.push(format!(
                    "not checked: {} takes longer than {} (--verify waits for it)",
                    opinion.name(),
                    time(*limit)
                ));
            }
            None => {}
        }
        lines
    }

    /// A line that says that responses are less accurate than they should be; `None` if they are accurate.
    fn by_response(&self) -> Option<String> {
        let estimated = self.known.estimate.as_ref().map(|e| e.worst_response);
        let checked = match &self.known.check {
            Some((_, Verdict::Apart(difference))) => Some(difference.worst_response),
            _ => None,
        };
        let limit = self.known.wanted.unwrap_or(self.known.limit);
        let worst = checked.into_iter().chain(estimated).fold(0.0, f64::max);
        (worst > limit).then(|| {
            format!(
                "responses are not as accurate as {}: one of them differs by {}, although the outputs may be accurate enough",
                percent(limit),
                percent(worst)
            )
        })
    }

    /// The outputs that differ most, a line each, then a line for all others; empty if no output differs noticeably, or
    /// if there is only one.
    fn by_output(&self, difference: &Difference) -> Vec<String> {
        let mut apart: Vec<(&String, f64)> = self
            .outputs
            .iter()
            .zip(difference.outputs.iter().copied())
            .collect();
        apart.sort_by(|a, b| b.1.total_cmp(&a.1));
        let lines = apart.iter().filter(|(_, error)| *error > 0.1 * PROMISED);
        let lines: Vec<String> = lines
            .take(NAMED)
            .map(|(name, error)| format!("  {name}: {}", share(*error)))
            .collect();
        match apart.get(lines.len()) {
            Some((_, next)) if !lines.is_empty() => {
                let others = apart.len() - lines.len();
                let others = format!("  {others} more: {} at most", share(*next));
                lines.into_iter().chain([others]).collect()
            }
            _ if lines.len() < 2 => Vec::new(),
            _ => lines,
        }
    }

    /// Fails if the run is less accurate than requested or promised.
    pub fn check(&self) -> Result<(), Error> {
        let error = |message| {
            Err(Error::Run(RunError {
                kind: ErrorKind::Run,
                t: None,
                coordinate: None,
                cause: String::new(),
                message,
            }))
        };
        if let (Some(wanted), Some(setting)) = (self.known.wanted, &self.known.setting)
            && !self
                .known
                .estimate
                .as_ref()
                .is_some_and(|e| e.worst <= wanted)
        {
            return error(format!(
                "an accuracy of {} is not reached, not even by {}\n  help: ask for less, or look at `bryant accuracy`: \
                 rounding, friction or a chaotic motion may not allow more",
                percent(wanted),
                setting.name()
            ));
        }
        match &self.known.check {
            Some((opinion, Verdict::Apart(difference)))
                if difference.worst > self.known.limit || difference.worst.is_nan() =>
            {
                let help = match (self.known.limit == FAR, self.known.out_of_time) {
                    (true, _) => {
                        "give a smaller --step or --tolerance, or leave the choice of the method to the program".into()
                    }
                    (false, true) => {
                        format!("--accuracy {} repeats the run as long as necessary", percent(PROMISED))
                    }
                    (false, false) => self.explained(),
                };
                error(format!(
                    "the outputs are not as accurate as {}: a run by {} differs by {}\n  help: {help}",
                    percent(self.known.limit),
                    opinion.name(),
                    worst(difference)
                ))
            }
            Some((opinion, Verdict::Failed(message))) => error(format!(
                "the outputs could not be checked: a second run, by {}, failed: {message}\n  help: the first run may be as wrong as the second; \
                 --no-verify accepts it unchecked",
                opinion.name()
            )),
            _ => Ok(()),
        }
    }

    /// What the user can do if sharper runs do not agree, by the cause that was measured.
    fn explained(&self) -> String {
        match &self.known.cause {
            Some(Cause::Rounding { coordinate, size }) => format!(
                "rounding explains this: \"{coordinate}\" is {} from the origin, where a double tells {:.0e} m apart, and that adds up from step to \
                 step; describe the motion from a moving origin: leave the velocity and the distance away that all bodies have in common",
                length(*size),
                size * f64::EPSILON
            ),
            Some(Cause::Growth(factor)) => format!(
                "errors grow: a change of the start grows by a factor of {factor:.0e}: the motion is chaotic, or about to tip over; shorten the run, \
                 or ask for outputs that do not depend on it"
            ),
            Some(Cause::Stiff) => "errors do not grow, but the scene is stiff: the output may be that of a force that is far stiffer than the rest; \
                 `bryant accuracy` compares all methods"
                .into(),
            _ => "look at `bryant accuracy`, which compares all methods".into(),
        }
    }

    pub fn json(&self) -> Value {
        let errors = |difference: &Difference| {
            let outputs = self.outputs.iter().zip(&difference.outputs);
            let outputs = outputs.map(|(output, error)| (output.clone(), json!(error)));
            let vanishing = difference.vanishing.iter();
            let vanishing = vanishing.map(|v| {
                (
                    v.output.clone(),
                    json!({ "bound": v.bound, "unit": v.unit }),
                )
            });
            json!({
                "worst": difference.worst,
                "output": difference.output,
                "outputs": outputs.collect::<serde_json::Map<_, _>>(),
                "vanishing": vanishing.collect::<serde_json::Map<_, _>>(),
            })
        };
        let verified = self
            .known
            .check
            .as_ref()
            .map(|(opinion, verdict)| match verdict {
                Verdict::Apart(difference) => {
                    json!({ "by": opinion.name(), "difference": errors(difference) })
                }
                Verdict::Failed(message) => json!({ "by": opinion.name(), "failure": message }),
                Verdict::TooLong(limit) => {
                    json!({ "by": opinion.name(), "failure": "too long", "limit_s": limit })
                }
            });
        json!({
            "wanted": self.known.wanted,
            "by": self.known.setting.map(|setting| setting.name()),
            "runs": self.known.runs,
            "estimated": self.known.estimate.as_ref().map(errors),
            "before": self.known.first.as_ref().map(errors),
            "verified": verified,
        })
    }
}

/// A length in metres or kilometres.
fn length(metres: f64) -> String {
    match metres >= 1e4 {
        true => format!("{:.0} km", metres / 1e3),
        false => format!("{metres:.0} m"),
    }
}

/// A difference, with the output that differs most.
fn worst(difference: &Difference) -> String {
    match difference.output.as_str() {
        _ if difference.worst < ROUNDING => share(difference.worst),
        "" => share(difference.worst),
        output => format!("{} of the largest {output}", share(difference.worst)),
    }
}

/// The outputs for which only a bound is known, a line each.
fn vanishing(difference: &Difference) -> Vec<String> {
    let lines = difference.vanishing.iter().map(|vanishing| {
        format!(
            "  {} may consist of errors alone: it is only known to be at most {:.1e} {}",
            vanishing.output, vanishing.bound, vanishing.unit
        )
    });
    lines.collect()
}

/// An error as a share of the largest value of an output, rounded up, in per cent.
pub fn at_most(share: f64) -> String {
    if share < ROUNDING {
        return "rounding".to_owned();
    }
    // one digit
    let power = bryant_picture::chart::power_of_ten(libm::log10(share).floor() as i32);
    let rounded = (share / power * (1.0 - 1e-12)).ceil() * power;
    let percent = 100.0 * rounded;
    match percent < 1e-4 {
        true => format!("{percent:.0e} %"),
        false => format!(
            "{} %",
            format!("{percent:.4}")
                .trim_end_matches('0')
                .trim_end_matches('.')
        ),
    }
}

/// An error as a share; if it is below the precision of doubles, as a bound.
fn share(error: f64) -> String {
    match error < ROUNDING {
        true => format!("less than {} (rounding)", percent(ROUNDING)),
        false => percent(error),
    }
}
