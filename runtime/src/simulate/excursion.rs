//! Finds event functions that change their sign within a step and change it back, so that the ends of the step do not
//! show this.
//!
//! 1. **Is it possible?** Three values, at the start of the previous step, at the start of this one and at its end,
//!    tell how much the event function bends. Its largest distance from its chord is h²/8 times its second derivative.
//!    The step is not searched if this distance, even with a margin, is less than the distance from zero, and if the
//!    event function would not reach zero on the line that it followed in the previous step ([`overshoot`],
//!    [`heads_for`]).
//! 2. **Does it?** Otherwise the event function is evaluated within the step, at the ends of its quarters, and then
//!    wherever it may be on the other side ([`Excursion`]). Between two places, a concave function is below the lines
//!    through each of them and the next known place beyond. This holds for distances in straight motion, however close
//!    a body passes, and for a parabola with a margin of a factor of four. An interval in which these lines stay on
//!    this side of zero is excluded; in any other the event function is evaluated where the lines meet, or where a
//!    parabola has its vertex, and both parts are examined.
//!
//! The step is then cut at the first sign change, as it is for a change that shows at the end.

use crate::Real;

/// Assumed bound on the second derivative of an event function, over that known from three values.
const MARGIN: f64 = 4.0;
/// Assumed bound on how fast an event function approaches zero, over its rate in the previous step.
const FASTER: f64 = 1.5;
/// Limit of evaluations in a step.
const PATIENCE: u32 = 100;
/// Limit of nested divisions of a quarter.
const LEVELS: usize = 60;
/// Parts of a step no wider than this are not divided.
const NARROW: f64 = 1e-14;
/// Least distance of an evaluation from the ends of its interval, as a part of the interval.
const NEAREST: f64 = 1e-2;

/// Positive if an event function may have reached zero between `before` and `after`, the values at the ends of a step
/// of length `h`, judged by its bend since `past`, the value at the start of the previous step, of length `h_past`.
#[inline(always)]
pub(crate) fn overshoot<T: Real>([past, before, after]: [T; 3], [h_past, h]: [T; 2]) -> T {
    let slopes = [(before - past) / h_past, (after - before) / h];
    // half the second derivative
    let bend = ((slopes[1] - slopes[0]) / (h_past + h)).abs();
    T::from_f64(0.25 * MARGIN) * bend * h * h - before.abs().min(after.abs())
}

/// Positive if an event function with the value `before` would reach zero in a step of length `h` by going on as it did
/// since `past`, in the previous step of length `h_past`. A function that passes zero briefly and straight is
/// recognized at the ends of a step by nothing else.
#[inline(always)]
pub(crate) fn heads_for<T: Real>([past, before]: [T; 2], [h_past, h]: [T; 2]) -> T {
    let approach = (past.abs() - before.abs()) / h_past;
    T::from_f64(FASTER) * approach * h - before.abs()
}

/// A place in a step, as a part of the step, and the value of the event function there, positive on the other side of
/// zero.
#[derive(Clone, Copy, Debug)]
struct ValuePoint {
    theta: f64,
    value: f64,
}

/// The search for a place within a step at which an event function is on the other side of zero, though it is not at
/// the ends. It asks for values and is told them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Excursion {
    /// The values at the start, the ends of the quarters, and the end: negative on this side.
    values: [f64; 5],
    /// The next quarter to examine.
    quarter: usize,
    /// The known place just before the current interval, and the left end of the interval.
    before: Option<ValuePoint>,
    left: ValuePoint,
    /// Right ends of the current interval and of the intervals that contain it; `depth` is their number.
    right: [ValuePoint; LEVELS],
    depth: usize,
    taken: u32,
    /// The place whose value is asked for.
    theta: f64,
    found: Option<f64>,
}

impl Excursion {
    /// A search with the values at the start, the ends of the quarters, and the end.
    pub fn new(values: [f64; 5]) -> Self {
        let seen = values[..4].iter().position(|value| *value > 0.0);
        let begin = ValuePoint {
            theta: 0.0,
            value: values[0],
        };
        Excursion {
            values,
            quarter: 0,
            before: None,
            left: begin,
            right: [begin; LEVELS],
            depth: 0,
            taken: 0,
            theta: 0.0,
            found: seen.map(|k| 0.25 * k as f64),
        }
    }

    /// A place at which the event function is on the other side, if one has been found.
    pub fn found(&self) -> Option<f64> {
        self.found
    }

    /// The next place to evaluate, as a part of the step; `None` when the search is over.
    pub fn next(&mut self) -> Option<f64> {
        while self.found.is_none() && self.taken < PATIENCE {
            if self.depth == 0 {
                let right = self.end_of_quarter(self.quarter + 1)?;
                self.before = self
                    .quarter
                    .checked_sub(1)
                    .and_then(|k| self.end_of_quarter(k));
                self.left = self.end_of_quarter(self.quarter)?;
                (self.right[0], self.depth) = (right, 1);
                self.quarter += 1;
            }
            let right = self.right[self.depth - 1];
            let width = right.theta - self.left.theta;
            let meet = self.meet(right);
            if meet.value > 0.0 && self.depth < LEVELS && width > NARROW {
                self.theta = self.choose(meet, right);
                return Some(self.theta);
            }
            (self.before, self.left) = (Some(self.left), right);
            self.depth -= 1;
        }
        None
    }

    /// Takes the value at that place.
    pub fn tell(&mut self, value: f64) {
        self.taken += 1;
        let theta = self.theta;
        match value > 0.0 {
            true => self.found = Some(theta),
            false => {
                self.right[self.depth] = ValuePoint { theta, value };
                self.depth += 1;
            }
        }
    }

    fn end_of_quarter(&self, k: usize) -> Option<ValuePoint> {
        let value = *self.values.get(k)?;
        let theta = 0.25 * k as f64;
        Some(ValuePoint { theta, value })
    }

    /// The known place just beyond the current interval.
    fn beyond(&self) -> Option<ValuePoint> {
        match self.depth {
            0 | 1 => self.end_of_quarter(self.quarter + 1),
            depth => Some(self.right[depth - 2]),
        }
    }

    /// The place in the interval where the lower one of the lines from both sides is highest, with its value.
    fn meet(&self, right: ValuePoint) -> ValuePoint {
        let slope = |a: ValuePoint, b: ValuePoint| (b.value - a.value) / (b.theta - a.theta);
        let left = self.left;
        let width = right.theta - left.theta;
        let up = self.before.map(|before| slope(before, left));
        let down = self.beyond().map(|beyond| slope(right, beyond));
        match (up, down) {
            // NaN is not above anything
            (Some(up), _) if up <= 0.0 || up.is_nan() => left,
            (_, Some(down)) if down >= 0.0 || down.is_nan() => right,
            (Some(up), Some(down)) => {
                let way = (right.value - down * width - left.value) / (up - down);
                let way = way.clamp(0.0, width);
                ValuePoint {
                    theta: left.theta + way,
                    value: left.value + up * way,
                }
            }
            (Some(up), None) => ValuePoint {
                theta: right.theta,
                value: left.value + up * width,
            },
            (None, Some(down)) => ValuePoint {
                theta: left.theta,
                value: right.value - down * width,
            },
            (None, None) => ValuePoint {
                theta: left.theta + 0.5 * width,
                value: f64::INFINITY,
            },
        }
    }

    /// The place in the interval to evaluate: where the lines meet, which is the peak of a function that goes straight
    /// up and down; and, in turns, the vertex of a parabola.
    fn choose(&self, meet: ValuePoint, right: ValuePoint) -> f64 {
        let left = self.left;
        let vertex = match self.taken.is_multiple_of(2) {
            true => self.vertex(right),
            false => None,
        };
        let inside = |theta: &f64| left.theta < *theta && *theta < right.theta;
        let theta = vertex.filter(inside).unwrap_or(meet.theta);
        let least = NEAREST * (right.theta - left.theta);
        theta.clamp(left.theta + least, right.theta - least)
    }

    /// The vertex of the parabola through both ends of the interval and the higher of the known places beyond.
    fn vertex(&self, right: ValuePoint) -> Option<f64> {
        let left = self.left;
        let [a, b, c] = match (self.before, self.beyond()) {
            (Some(before), Some(beyond)) if before.value > beyond.value => [before, left, right],
            (_, Some(beyond)) => [left, right, beyond],
            (Some(before), None) => [before, left, right],
            (None, None) => return None,
        };
        let slopes = [
            (b.value - a.value) / (b.theta - a.theta),
            (c.value - b.value) / (c.theta - b.theta),
        ];
        let bend = (slopes[1] - slopes[0]) / (c.theta - a.theta);
        (bend < 0.0).then(|| 0.5 * (a.theta + b.theta) - 0.5 * slopes[0] / bend)
    }
}

#[cfg(test)]
mod tests {
    use super::{Excursion, heads_for, overshoot};

    /// What a search finds of a function, and how often it asks.
    fn search(f: impl Fn(f64) -> f64) -> (Option<f64>, u32) {
        let mut search = Excursion::new([0.0, 0.25, 0.5, 0.75, 1.0].map(&f));
        let mut asked = 0;
        while let Some(theta) = search.next() {
            assert!((0.0..=1.0).contains(&theta));
            search.tell(f(theta));
            asked += 1;
        }
        (search.found(), asked)
    }

    #[test]
    fn a_peak_is_found_wherever_it_is_and_however_low() {
        for place in [0.01, 0.1, 0.24, 0.25, 0.31, 0.5, 0.62, 0.8, 0.97] {
            for height in [1e-1, 1e-4, 1e-8, 1e-12] {
                for bend in [1.0, 30.0] {
                    let peak = |theta: f64| {
                        let x = theta - place;
                        height * 0.01 - bend * x * x * (1.0 + 0.3 * x - 0.2 * x * x)
                    };
                    if peak(0.0) > 0.0 || peak(1.0) > 0.0 {
                        continue;
                    }
                    let (found, asked) = search(peak);
                    let found = found.unwrap_or_else(|| panic!("{place} {height} {bend}"));
                    assert!(peak(found) > 0.0);
                    assert!(asked <= 40, "{asked} for {place} {height} {bend}");
                }
            }
        }
    }

    #[test]
    fn a_event_function_that_keeps_its_sign_is_not_found_and_costs_little() {
        // a quarter is 0.25 long, so that the parabola bends by 0.0625 in it
        for depth in [1e-12, 1e-6, 1e-2, 0.1, 1.0] {
            let (found, asked) = search(|theta| -depth - (theta - 0.37) * (theta - 0.37));
            assert_eq!(found, None);
            assert!(
                asked <= if depth < 0.0625 { 40 } else { 0 },
                "{asked} at {depth}"
            );
        }
        assert_eq!(search(|theta| -theta), (None, 0));
        assert_eq!(search(|theta| theta - 1.0), (None, 0));
        assert_eq!(search(|_| -1.0), (None, 0));
        assert_eq!(search(|_| 0.0), (None, 0));
        assert_eq!(search(|_| f64::NAN), (None, 0));
    }

    #[test]
    fn what_passes_close_by_is_found_however_close_and_however_fast() {
        // straight past a point: near − √(u² (θ − p)² + a²)
        for near in [1e-5, 1e-3, 0.1] {
            for share in [0.0, 0.5, 0.99, 1.01] {
                for k in 1..100 {
                    let (place, speed) = (0.01 * f64::from(k) + 1e-3, 3.7f64);
                    let event_function =
                        |theta: f64| near - (speed * (theta - place)).hypot(share * near);
                    if event_function(0.0) > 0.0 || event_function(1.0) > 0.0 {
                        continue;
                    }
                    let (found, asked) = search(event_function);
                    assert_eq!(found.is_some(), share < 1.0, "{near} {share} {place}");
                    assert!(asked <= 40, "{asked} for {near} {share} {place}");
                }
            }
        }
        // and a step is looked into if it has such a place, whatever the one before
        for place in [0.1, 0.4, 0.6, 0.9] {
            for past in [0.3, 1.0, 3.0] {
                let event_function = |theta: f64| 1e-3 - (theta - place).abs();
                let values = [event_function(-past), event_function(0.0)];
                assert!(heads_for(values, [past, 1.0]) > 0.0, "{place} {past}");
            }
        }
        // what leaves, or is still far, does not head for it
        assert!(heads_for([-1.0, -2.0], [1.0, 1.0]) < 0.0);
        assert!(heads_for([-10.0, -9.0], [1.0, 1.0]) < 0.0);
    }

    #[test]
    fn a_step_is_looked_into_where_the_event_function_can_have_come_to_zero() {
        // cos t above a level close to 1, in steps that have the peak anywhere within
        for step in [0.1, 0.3, 1.0] {
            for k in 0..=20 {
                let begin = -step * k as f64 / 20.0;
                let level: f64 = begin.cos().max((begin + step).cos());
                let level = level + 1e-3 * (1.0 - level);
                let values = [begin - step, begin, begin + step].map(|t| t.cos() - level);
                if level < 1.0 {
                    assert!(overshoot(values, [step, step]) > 0.0, "{step} {begin}");
                }
            }
        }
        // far from any
        assert!(overshoot([5.0, 4.0, 3.0], [1.0, 1.0]) < 0.0);
        assert!(overshoot([5.2, 4.0, 3.0], [1.0, 1.0]) < 0.0);
        assert!(overshoot([0.0, 0.0, 0.0], [1.0, 1.0]) <= 0.0);
    }
}
