//! The times of samples, and the times at which steps must end.

use super::{SampleKind, Settings};
use crate::real::{Mask, Number};
use crate::{Dynamics, Real};

/// Decides how a step of the wanted length `h` approaches a place at the distance `span`: the first mask is true if the
/// step goes all the way; the second, where the first is false, if it goes half of the way. So no tiny rest is ever
/// left.
#[inline(always)]
pub fn to_meet<P: Number>(span: P, h: P) -> [P::Mask; 2] {
    let lands = (P::from_f64(1.05) * h).lt(span).not();
    [lands, span.lt(P::from_f64(2.0) * h)]
}

/// The number of steps of at most length `step` that cover a `way` \[s\], up to a rest of `trifle` steps.
pub fn count_steps(way: f64, step: f64, trifle: f64) -> u64 {
    ((way / step - trifle).max(0.0) as u64).saturating_add(1)
}

/// The times of samples and of the next stop.
pub struct Schedule {
    start: f64,
    duration: f64,
    every: f64,
    /// Indices of the first row, at the start, and of the last row, at the duration.
    first: u64,
    last: u64,
    /// Index of the next row.
    next: u64,
    /// The number of parts at whose ends there are additional samples, and the index of the next of these samples, 0 at
    /// the start.
    parts: u64,
    part: u64,
    /// If samples are asked for one by one: the time of the only one, +∞ once it has been delivered.
    only: Option<f64>,
}

impl Schedule {
    pub fn new(settings: &Settings) -> Self {
        let Settings {
            start,
            duration,
            every,
            ..
        } = *settings;
        // times within rounding of a multiple count as that multiple
        let first = (start / every * (1.0 + 1e-14) + 1e-9) as u64;
        let last = (duration / every * (1.0 - 1e-14) - 1e-9).max(0.0) as u64 + 1;
        Schedule {
            start,
            duration,
            every,
            first,
            last: last.max(first + 1),
            next: first,
            parts: settings.parts,
            part: 0,
            only: None,
        }
    }

    /// Sets the time of the next sample, which is the only one.
    pub fn ask_for(&mut self, t: f64) {
        self.only = Some(t);
    }

    /// Time and kind of the next sample, +∞ after the last. If a row and a part are due at the same time, the row comes
    /// first.
    pub fn next_sample(&self) -> (f64, SampleKind) {
        let (row, part) = (self.next_row(), self.next_part());
        match part < row {
            true => (part, SampleKind::Part),
            false => (row, SampleKind::Row),
        }
    }

    /// Time of the next sample at the end of a part, +∞ after the last.
    fn next_part(&self) -> f64 {
        match self.part {
            _ if self.parts == 0 || self.only.is_some() => f64::INFINITY,
            part if part > self.parts => f64::INFINITY,
            part if part == self.parts => self.duration,
            part => {
                let length = (self.duration - self.start) / self.parts as f64;
                self.start + part as f64 * length
            }
        }
    }

    /// Time of the next row, +∞ after the last.
    pub fn next_row(&self) -> f64 {
        if let Some(only) = self.only {
            return only;
        }
        match self.next {
            next if next > self.last => f64::INFINITY,
            next if next == self.first => self.start,
            next if next == self.last => self.duration,
            next => next as f64 * self.every,
        }
    }

    /// Notes that the next sample of this kind has been delivered.
    pub fn advance(&mut self, kind: SampleKind) {
        match (kind, &mut self.only) {
            (SampleKind::Part, _) => self.part += 1,
            (SampleKind::Row, Some(only)) => *only = f64::INFINITY,
            (SampleKind::Row, None) => self.next += 1,
        }
    }

    /// Time of the first kink after `t`, at most the duration.
    pub fn kink_after<T: Real>(&self, model: &dyn Dynamics<T>, t: f64) -> f64 {
        let breakpoints = model.info().breakpoints;
        let passed = breakpoints.partition_point(|kink| *kink <= t);
        let kink = breakpoints.get(passed).copied();
        let kink = kink
            .unwrap_or(f64::INFINITY)
            .min(model.kink_after(t).to_f64());
        kink.min(self.duration)
    }
}

/// Equal fixed steps from one time that a step must end at to the next. Times between are computed by multiplication: a
/// million additions would accumulate as many roundings, and change the length of the last step.
#[derive(Clone, Copy)]
pub struct Grid {
    start: f64,
    stop: f64,
    /// Length of every step \[s\].
    pub length: f64,
    steps: u64,
    taken: u64,
}

impl Grid {
    /// A grid from `start` to `stop` in steps of at most this length.
    pub fn new(start: f64, stop: f64, step: f64) -> Grid {
        // by rounding, the way may exceed a whole number of steps slightly
        let steps = count_steps(stop - start, step, 1e-9);
        Grid {
            start,
            stop,
            length: (stop - start) / steps as f64,
            steps,
            taken: 0,
        }
    }

    /// Time after this number of steps \[s\].
    fn time(&self, steps: u64) -> f64 {
        match steps == self.steps {
            true => self.stop,
            false => self.start + steps as f64 * self.length,
        }
    }

    /// The grid at `t`, where the step tried last ended or began; `None` if `t` is neither, or if the stop has changed.
    pub fn at(self, t: f64, stop: f64) -> Option<Grid> {
        let taken = [self.taken + 1, self.taken];
        let taken = taken.into_iter().find(|steps| self.time(*steps) == t)?;
        (stop == self.stop && taken < self.steps).then_some(Grid { taken, ..self })
    }

    /// The time at which the next step ends, and true if that is the end of the grid.
    pub fn next(&self) -> (f64, bool) {
        (self.time(self.taken + 1), self.taken + 1 == self.steps)
    }

    /// The number of steps left.
    pub fn left(&self) -> u64 {
        self.steps - self.taken
    }
}

#[cfg(test)]
mod tests {
    use super::Grid;

    #[test]
    fn a_million_steps_end_where_they_should_and_none_is_odd() {
        let (start, stop) = (100.0, 10100.0);
        let mut grid = Grid::new(start, stop, 0.01);
        assert_eq!(grid.left(), 1_000_000);
        let mut t = start;
        loop {
            let (reached, ends) = grid.next();
            // either end is rounded twice, in the product and in the sum, to half of 1.8e-12
            assert!((reached - t - grid.length).abs() <= 4e-12);
            t = reached;
            match grid.at(t, stop) {
                Some(next) => grid = next,
                None => {
                    assert!(ends && t == stop);
                    break;
                }
            }
        }
    }

    #[test]
    fn a_step_that_was_cut_short_needs_another_grid() {
        let grid = Grid::new(0.0, 1.0, 0.3);
        assert_eq!((grid.left(), grid.length), (4, 0.25));
        // the same step again, the next one, another stop, a place between
        assert!(grid.at(0.0, 1.0).is_some_and(|grid| grid.left() == 4));
        assert!(grid.at(0.25, 1.0).is_some_and(|grid| grid.left() == 3));
        assert!(grid.at(0.25, 0.5).is_none() && grid.at(0.1, 1.0).is_none());
    }
}
