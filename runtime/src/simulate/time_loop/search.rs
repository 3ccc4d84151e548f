//! Kinks of force laws and event functions: where in a step they are, and what to do about it.
//!
//! **Kinks.** A step that crosses a kink has stages on both sides of it, and whatever is made of them, its result and its
//! interpolant alike, is of order 1 or 2 only. It is taken again so that it ends a little before the place where the
//! interpolant has the kink, and the next goes over it: as the rest of the way shrinks by a large factor each time, so does the error of crossing,
//! until it no longer matters: against the tolerance where there is one, in length where steps are fixed.

use super::{TimeLoop, finest_of};
use crate::Real;
use crate::integrate::Stepper;
use crate::simulate::Pace;
use crate::simulate::event::{self, WIDTH, Which, Within};
use crate::simulate::excursion::{heads_for, overshoot};

/// Share of a fixed step that may cross a kink, and that of a scalar with few digits, whose state a shorter step does not move.
pub(super) const HOP: f64 = 1e-9;
pub(super) const HOP_OF_FEW_DIGITS: f64 = 1e-4;
/// How far before a kink a step ends, as a share of the way to it: little enough that it is worth it, and more than what the
/// interpolant errs by, which is less each time.
const MARGINS: [f64; 3] = [1e-2, 1e-3, 1e-4];
/// Tries to come near a kink before it is crossed all the same.
const ROUNDS: usize = 12;
/// Kinks in a row, with no whole step between them, before they are left to the control of the error: a motion that
/// rests on a kink would never get on.
pub(super) const RESTLESS: u32 = 50;

/// Where the estimated error is as much smaller than the tolerance, it is not accuracy that decides the length of steps: they
/// may grow over whatever they do not meet, and what lies within them is looked for. So it is within steps longer than the time
/// between samples, whatever their error: Dormand & Prince 5(4), for one, does not see at all what its second stage meets alone,
/// since that stage and all it leads to have weight 0.
pub(crate) const EASY: f64 = 1e-2;
/// Times in a row that a step is taken again because of something within it.
pub(crate) const SEARCHES: u32 = 8;

/// On the way to a kink.
#[derive(Clone, Copy)]
pub(super) struct Approach {
    /// Which.
    pub kink: usize,
    /// Where it is expected \[s\].
    pub at: f64,
    /// Length of the next step \[s\].
    pub length: f64,
    /// Tries so far.
    pub round: usize,
}

/// Whether crossing a kink in a step of this length and error would matter.
pub(super) fn matters(pace: Pace, error: Option<f64>, length: f64, hop: f64) -> bool {
    match (pace, error) {
        (_, None) => false,
        (Pace::Fixed(step), Some(_)) => length > hop * step,
        (Pace::Adaptive(_), Some(error)) => error > 1.0,
    }
}

impl<T: Real> TimeLoop<'_, '_, T> {
    /// Event functions or kinks within a step that is complete.
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

    /// What to do instead of a step that crosses a kink that matters; `None` where it crosses none, or has to.
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
        // what is left to cross in: as short as makes the error of crossing, which falls with it at least linearly, a third
        // of the tolerance
        let left = match (self.settings.method.pace, error) {
            (Pace::Adaptive(_), Some(error)) => 0.2 * length / error,
            _ => 0.0,
        };
        let left = left.max(margin * way).min(0.25 * way);
        // where the kink is at hand, over it: one that matters is not crossed by a step that begins there
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

    /// The first of the kinks that a step has crossed when it arrives, or would have, had it gone a trifle further: its last
    /// stages are at its end, but not quite where it leads, and may be beyond. The kinks at its beginning are known.
    pub(super) fn kink_within(&mut self, step: &dyn Stepper<T>) -> Option<usize> {
        // less than any margin
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

    /// Whether it is not accuracy that decides the length of a step of this error and length.
    pub(super) fn is_easy(&self, error: Option<f64>, length: f64) -> bool {
        let adaptive = matches!(self.settings.method.pace, Pace::Adaptive(_));
        match error {
            Some(error) => {
                (adaptive && error < EASY) || (error <= 1.0 && length > self.settings.every)
            }
            None => false,
        }
    }

    /// Whether a kink may be hidden within a step.
    pub(super) fn may_hide(&self) -> bool {
        let adaptive = matches!(self.settings.method.pace, Pace::Adaptive(_));
        adaptive && !self.kinks.is_empty() && self.easy && self.searches < SEARCHES
    }

    /// The part of a step after which a kink is seen that is not seen at its end.
    pub(super) fn hidden(&mut self, step: &mut dyn Stepper<T>) -> Option<f64> {
        step.complete(&mut self.f);
        self.know_kinks();
        self.within(step, Which::Kinks).hidden()
    }

    /// An event function that changes its sign within a step, with a part of the step at which it has, 1 where it shows at the end.
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
            let lengths = lengths.map(T::from_f64);
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

    /// The part of a step that lies before the first change of an event function, which has changed at `end`, and a trifle.
    pub(super) fn way_to_event_function(&mut self, step: &mut dyn Stepper<T>, end: f64) -> f64 {
        step.complete(&mut self.f);
        self.within(step, Which::EventFunctions)
            .first_change(end, WIDTH)
    }
}
