//! Finds kinks of force laws and event functions within a step, and decides what to do about them.
//!
//! **Kinks.** A step that crosses a kink has stages on both sides of it, so its result and its interpolant are of order
//! 1 or 2 only. Such a step is taken again so that it ends slightly before the place where the interpolant has the
//! kink, and the next step crosses the kink. Each repetition shrinks the rest of the way by a large factor, and the
//! error of crossing with it, until this error no longer matters: compared with the tolerance, or, with fixed steps, by
//! the length of the crossing step.

use super::{TimeLoop, finest_of};
use crate::Real;
use crate::integrate::Stepper;
use crate::real::mapped;
use crate::simulate::Pace;
use crate::simulate::event::{self, WIDTH, Which, Within};
use crate::simulate::excursion::{heads_for, overshoot};

/// Share of a fixed step that may cross a kink; then that for a scalar with few digits, whose state a shorter step
/// would not change.
pub(super) const HOP: f64 = 1e-9;
pub(super) const HOP_OF_FEW_DIGITS: f64 = 1e-4;
/// Distance from the kink at which a step ends, as a share of the way to the kink, for each round: small enough to be
/// worth a repetition, and larger than the error of the interpolant, which decreases from round to round.
const MARGINS: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Rounds of approach before a kink is crossed anyway.
const ROUNDS: usize = 12;
/// Kinks in a row, with no whole step between them, before kinks are left to the error control: a motion that rests on
/// a kink would otherwise hardly advance.
pub(super) const RESTLESS: u32 = 50;

/// A step is easy if its estimated error is below this share of the tolerance: something other than accuracy decides
/// its length. Such steps may grow past anything that their stages do not meet, so they are searched for hidden kinks.
/// Steps longer than the time between samples are searched whatever their error: Dormand & Prince 5(4), for one, does
/// not notice anything that only its second stage meets, since this stage and all that depends on it have weight 0.
pub(crate) const EASY: f64 = 1e-2;
/// Limit of tries in a row that are repeated because of a kink hidden in the step.
pub(crate) const SEARCHES: u32 = 8;

/// An approach to a kink.
#[derive(Clone, Copy)]
pub(super) struct Approach {
    /// The kink, an index in [`Info::kinks`](crate::Info::kinks).
    pub kink: usize,
    /// The time at which the kink is expected \[s\].
    pub at: f64,
    /// Length of the next step \[s\].
    pub length: f64,
    /// Rounds so far.
    pub round: usize,
}

/// True if crossing a kink in a step of this length and error would matter.
pub(super) fn matters(pace: Pace, error: Option<f64>, length: f64, hop: f64) -> bool {
    match (pace, error) {
        (_, None) => false,
        (Pace::Fixed(step), Some(_)) => length > hop * step,
        (Pace::Adaptive(_), Some(error)) => error > 1.0,
    }
}

impl<T: Real> TimeLoop<'_, '_, T> {
    /// The event functions or kinks within a complete step, to be evaluated.
    fn within<'s>(&'s mut self, step: &'s dyn Stepper<T>, which: Which) -> Within<'s, T> {
        Within {
            model: self.model,
            step,
            which,
            before: match which {
                Which::EventFunctions => self.event_functions,
                Which::Kinks => self.kinks,
            },
            state: self.inside,
            values: self.values,
        }
    }

    /// The approach to take instead of a step that crosses a kink that matters; `None` if it crosses none, or has to
    /// cross.
    pub(super) fn approach(
        &mut self,
        step: &mut dyn Stepper<T>,
        error: Option<f64>,
    ) -> Option<Approach> {
        self.know_kinks();
        let round = self.approach.map_or(0, |approach| approach.round);
        if round >= ROUNDS {
            return None;
        }
        let kink = self.kink_within(step)?;
        let (t, length) = (step.span().t, step.span().h);
        let margin = MARGINS[round.min(MARGINS.len() - 1)];
        step.complete(&mut self.f);
        let share = self
            .within(step, Which::Kinks)
            .first_change(1.0, 0.3 * margin);
        let way = length * share;
        // The length left for crossing. The error of crossing falls at least linearly with this length, so it becomes
        // at most a fifth of the tolerance.
        let left = match (self.settings.method.pace, error) {
            (Pace::Adaptive(_), Some(error)) => 0.2 * length / error,
            _ => 0.0,
        };
        let left = left.max(margin * way).min(0.25 * way);
        // a kink closer than the resolution of time is stepped over: a step that begins on a kink does not cross it
        let finest = finest_of::<T>(t);
        let to = match way - left > finest {
            true => way - left,
            false => 2.0 * way.max(finest),
        };
        (to < length).then_some(Approach {
            kink,
            at: t + way,
            length: to,
            round: round + 1,
        })
    }

    /// The first kink that a step crosses at its end, or would cross if it went slightly farther. The last stages are
    /// evaluated at the end time, but not exactly at the resulting state, so they may be beyond a kink that the result
    /// has not crossed. The kinks at the start of the step must be known.
    pub(super) fn kink_within(&mut self, step: &dyn Stepper<T>) -> Option<usize> {
        // smaller than any of `MARGINS`
        const FURTHER: f64 = 1e-5;
        let span = step.span();
        self.inside.copy_from_slice(span.end);
        self.model.normalize(self.inside);
        let there = &mut self.values[..self.kinks.len()];
        let t = T::from_f64(span.t + span.h);
        self.model.kinks(t, self.inside, there);
        for (there, before) in there.iter_mut().zip(&*self.kinks) {
            *there = T::from_f64(FURTHER).mul_add(*there - *before, *there);
        }
        event::changed(Which::Kinks.zero(), self.kinks, there)
    }

    /// True if something other than accuracy decides the length of a step of this error and length ([`EASY`]).
    pub(super) fn is_easy(&self, error: Option<f64>, length: f64) -> bool {
        let adaptive = matches!(self.settings.method.pace, Pace::Adaptive(_));
        match error {
            Some(error) => {
                (adaptive && error < EASY) || (error <= 1.0 && length > self.settings.every)
            }
            None => false,
        }
    }

    /// True if a kink may be hidden within the step, and the limit of searches is not reached.
    pub(super) fn may_hide(&self) -> bool {
        let adaptive = matches!(self.settings.method.pace, Pace::Adaptive(_));
        adaptive && !self.kinks.is_empty() && self.easy && self.searches < SEARCHES
    }

    /// The part of a step at which a kink has been crossed that is not crossed at the end of the step.
    pub(super) fn hidden(&mut self, step: &mut dyn Stepper<T>) -> Option<f64> {
        step.complete(&mut self.f);
        self.know_kinks();
        self.within(step, Which::Kinks).hidden()
    }

    /// An event function that changes its sign within a step, and a part of the step at which its sign is changed: 1 if
    /// it still is at the end.
    pub(super) fn event_function_within(
        &mut self,
        step: &mut dyn Stepper<T>,
    ) -> Option<(usize, f64)> {
        let zero = Which::EventFunctions.zero();
        if let Some(event_function) =
            event::changed(zero, self.event_functions, self.event_functions_ahead)
        {
            return Some((event_function, 1.0));
        }
        let lengths = [self.past, step.span().h];
        let event_functions = self.event_functions_past.iter().zip(&*self.event_functions);
        let mut event_functions = event_functions.zip(&*self.event_functions_ahead);
        let may_turn = event_functions.any(|((past, before), after)| {
            let lengths = mapped(lengths, T::from_f64);
            overshoot([*past, *before, *after], lengths).to_f64() > 0.0
                || heads_for([*past, *before], lengths).to_f64() > 0.0
        });
        let known = self.past > 0.0 && !self.easy;
        if self.event_functions.is_empty() || (known && !may_turn) {
            return None;
        }
        step.complete(&mut self.f);
        let mut within = Within {
            model: self.model,
            step,
            which: Which::EventFunctions,
            before: self.event_functions,
            state: self.inside,
            values: self.values,
        };
        within.excursion(self.event_functions_ahead)
    }

    /// The part of a step that ends just behind the first sign change of an event function, where some sign is changed
    /// at `end`.
    pub(super) fn way_to_event_function(&mut self, step: &mut dyn Stepper<T>, end: f64) -> f64 {
        step.complete(&mut self.f);
        self.within(step, Which::EventFunctions)
            .first_change(end, WIDTH)
    }
}
