//! When to sample and where to stop.

use super::{SampleKind, Settings};
use crate::real::{Mask, Number};
use crate::{Dynamics, Real};

/// Whether the step that is to go towards a place at the distance `span`, when `h` is wanted, goes all the way, and, where not, whether it goes
/// half of it: never is a tiny rest left.
#[inline(always)]
pub fn to_meet<P: Number>(span: P, h: P) -> [P::Mask; 2] {
    let lands = (P::from_f64(1.05) * h).lt(span).not();
    [lands, span.lt(P::from_f64(2.0) * h)]
}

/// How many steps of at most this length go a way \[s\], of which a trifle may be left.
pub fn count_steps(way: f64, step: f64, trifle: f64) -> u64 {
    ((way / step - trifle).max(0.0) as u64).saturating_add(1)
}

/// When to sample and where to stop.
pub struct Schedule {
    start: f64,
    duration: f64,
    every: f64,
    /// Indices of the first sample, which is due at the start, and of the last, which is due at the duration.
    first: u64,
    last: u64,
    /// Index of the next sample.
    next: u64,
    /// Parts at whose ends there are samples besides, and the index of the next such, 0 at the start.
    parts: u64,
    part: u64,
    /// The only sample, where samples are asked for one by one: its time, +∞ once it has been delivered.
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
        // times within rounding of a multiple are one
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

    /// The next sample is at this time, and there is none after it.
    pub fn ask_for(&mut self, t: f64) {
        self.only = Some(t);
    }

    /// Time of the next sample of any kind, +∞ after the last, and its kind. Where there are two, the row is first.
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

    /// The next sample of this kind has been delivered.
    pub fn advance(&mut self, kind: SampleKind) {
        match (kind, &mut self.only) {
            (SampleKind::Part, _) => self.part += 1,
            (SampleKind::Row, Some(only)) => *only = f64::INFINITY,
            (SampleKind::Row, None) => self.next += 1,
        }
    }

    /// The first kink after `t`, at most the duration.
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

/// Fixed steps from one time that they must meet to the next, all equally long. The times between are counted, not added up: a
/// million additions would be off by as many roundings, and the last step would be another one.
#[derive(Clone, Copy)]
pub struct Grid {
    start: f64,
    stop: f64,
    /// Of every step \[s\].
    pub length: f64,
    steps: u64,
    taken: u64,
}

impl Grid {
    /// From `start` to `stop` in steps of at most this length.
    pub fn new(start: f64, stop: f64, step: f64) -> Grid {
        // rounding may leave a hair more than a whole number of steps
        let steps = count_steps(stop - start, step, 1e-9);
        Grid {
            start,
            stop,
            length: (stop - start) / steps as f64,
            steps,
            taken: 0,
        }
    }

    /// Time after so many steps \[s\].
    fn time(&self, steps: u64) -> f64 {
        match steps == self.steps {
            true => self.stop,
            false => self.start + steps as f64 * self.length,
        }
    }

    /// The grid where its last step, or the one before, ended at `t`; `None` where `t` is not on it.
    pub fn at(self, t: f64, stop: f64) -> Option<Grid> {
        let taken = [self.taken + 1, self.taken];
        let taken = taken.into_iter().find(|steps| self.time(*steps) == t)?;
        (stop == self.stop && taken < self.steps).then_some(Grid { taken, ..self })
    }

    /// Where the next step ends, and whether the grid does.
    pub fn next(&self) -> (f64, bool) {
        (self.time(self.taken + 1), self.taken + 1 == self.steps)
    }

    /// Steps that are left.
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
