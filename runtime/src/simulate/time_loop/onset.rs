//! Whether a step of a run went over something that begins and ends in it.

use super::{TimeLoop, finest};
use crate::Real;
use crate::integrate::Stepper;
use crate::simulate::Pace;
use crate::simulate::onset::{Course, Hunt, NEAR, QUARTERS, excluded, finest_gap, limit};

/// Steps whose lengths differ by less, as a share, are one.
const SAME: f64 = 1e-9;

/// What is known of the onsets in a step: gaps and speeds where it begins, where it ends, and at the ends of its quarters between; and at
/// one place more.
pub(super) struct Onsets<'w, T> {
    /// By place: beginning, end, three between, any. Each gaps, then speeds.
    values: &'w mut [T],
    count: usize,
    /// Whether those where the step begins are known.
    pub known: bool,
    finest: f64,
}

/// Places at which values are kept, and the last of them.
pub(super) const KEPT: usize = 6;
const ANY: usize = 5;
/// The places from the beginning to the end of a step.
const IN_ORDER: [usize; QUARTERS + 1] = [0, 2, 3, 4, 1];

impl<'w, T: Real> Onsets<'w, T> {
    /// Of so many laws, with 2 [`KEPT`] times as many scalars of memory.
    pub fn new(count: usize, values: &'w mut [T]) -> Self {
        Onsets {
            values,
            count,
            known: false,
            finest: finest_gap(T::from_f64(1.0 + 1e-10).to_f64() == 1.0),
        }
    }

    fn at(&mut self, place: usize) -> &mut [T] {
        &mut self.values[2 * place * self.count..][..2 * self.count]
    }

    /// The gap of a law, of lanes the smallest.
    fn gap(&self, place: usize, law: usize) -> f64 {
        -(-self.values[2 * place * self.count + law]).to_f64()
    }

    fn speed(&self, place: usize, law: usize) -> f64 {
        self.values[(2 * place + 1) * self.count + law].to_f64()
    }

    /// The next step begins where this one ended.
    pub fn advance(&mut self, same: bool) {
        if self.count > 0 {
            let (begin, end) = self.values.split_at_mut(2 * self.count);
            begin.copy_from_slice(&end[..2 * self.count]);
        }
        self.known = same;
    }

    fn course(&self, law: usize) -> Course {
        let speeds = IN_ORDER.map(|place| self.speed(place, law));
        Course {
            gaps: IN_ORDER.map(|place| self.gap(place, law)),
            speed: speeds.into_iter().fold(0.0, f64::max),
        }
    }

    /// Whether nothing can have happened to a law, by what is known at the ends of the step alone.
    fn quiet(&self, law: usize, length: f64) -> bool {
        let gaps = [self.gap(0, law), self.gap(1, law)];
        let speed = NEAR * self.speed(0, law).max(self.speed(1, law));
        excluded(gaps, speed, length, limit(gaps, self.finest))
    }
}

impl<T: Real> TimeLoop<'_, '_, T> {
    /// The part of a step that is to be taken instead, because a law begins to act behind it and shows nothing of it where the step ends,
    /// and which law that is.
    pub(super) fn stepped_over(&mut self, step: &mut dyn Stepper<T>) -> Option<(f64, usize)> {
        let count = self.onsets.count;
        if count == 0 {
            return None;
        }
        if !self.onsets.known {
            let t = T::from_f64(self.report.t);
            self.model.onsets(t, self.y, self.onsets.at(0));
            self.onsets.known = true;
        }
        let (begin, length) = (step.span().t, step.span().h);
        self.inside.copy_from_slice(step.span().end);
        self.model.normalize(self.inside);
        let end = T::from_f64(begin + length);
        self.model.onsets(end, self.inside, self.onsets.at(1));
        let short = length <= self.settings.every;
        if short && (0..count).all(|law| self.onsets.quiet(law, length)) {
            return None;
        }
        self.search(step, length)
    }

    /// Whether a step is taken again that went over a law, as long as `length`. Fixed steps are not: it is told.
    pub(super) fn turns_back(&mut self, step: &dyn Stepper<T>, length: f64, law: usize) -> bool {
        let span = step.span();
        match self.settings.method.pace {
            Pace::Fixed(_) => {
                if let Some(watch) = &mut self.watch {
                    watch.step_over(span.t, law);
                }
                false
            }
            Pace::Adaptive(adaptive) => {
                let smallest = adaptive.smallest_step.max(finest(span.t));
                if span.h <= smallest || length > (1.0 - SAME) * span.h {
                    return false;
                }
                (self.h, self.approach) = (length, None);
                true
            }
        }
    }

    /// Looks at the quarters of a step, and between them where that is not enough. An interpolant that a force may have spoiled is not the only one
    /// that is looked at.
    #[inline(never)]
    fn search(&mut self, step: &mut dyn Stepper<T>, length: f64) -> Option<(f64, usize)> {
        step.complete(&mut self.f);
        let found = self.search_on(&|theta, state| step.interpolate(theta, state), length);
        if found.is_some() || !step.cubic(0.5, self.inside) {
            return found;
        }
        let cubic = |theta: f64, state: &mut [T]| {
            step.cubic(theta, state);
        };
        self.search_on(&cubic, length)
    }

    /// The same on one interpolant.
    fn search_on(
        &mut self,
        interpolant: &dyn Fn(f64, &mut [T]),
        length: f64,
    ) -> Option<(f64, usize)> {
        for quarter in 1..QUARTERS {
            self.onsets_within(interpolant, length, 0.25 * quarter as f64, 1 + quarter);
        }
        let mut hunt = Hunt::new(length, self.onsets.count, self.onsets.finest);
        while let Some(theta) = hunt.next(|law| self.onsets.course(law)) {
            self.onsets_within(interpolant, length, theta, ANY);
            hunt.tell(self.onsets.gap(ANY, hunt.law()));
        }
        hunt.best()
    }

    /// The onsets within a step of this length.
    fn onsets_within(
        &mut self,
        interpolant: &dyn Fn(f64, &mut [T]),
        length: f64,
        theta: f64,
        place: usize,
    ) {
        interpolant(theta, self.inside);
        self.model.normalize(self.inside);
        let t = T::from_f64(self.report.t + theta * length);
        self.model.onsets(t, self.inside, self.onsets.at(place));
    }
}
