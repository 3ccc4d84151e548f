//! Whether a guard changes its sign within a step and changes it back, so that nothing of it shows at the end.
//!
//! 1. **Is it possible?** Three values, a step before, at the beginning and at the end, tell how much the guard bends. A guard that bends so
//!    much cannot come farther off its chord than h²/8 times its second derivative. Where that is less than its distance from zero, even with a
//!    margin, nothing is spent ([`overshoot`]).
//! 2. **Does it?** Otherwise it is evaluated within the step, at the ends of its quarters, and then where parabolas through neighbouring
//!    values have their vertex, each time in a smaller interval, until it is on the other side or cannot be ([`Excursion`]).
//!
//! The step is then cut where the guard changes its sign first, as where the change shows at the end.

use crate::Real;

/// A guard may bend so many times as much as is known.
const MARGIN: f64 = 4.0;
/// Evaluations in one interval at most: each takes the interval to a fraction.
const PATIENCE: u32 = 30;
/// A vertex is looked at no nearer to a known value, as a part of the interval.
const NEAREST: f64 = 1e-3;

/// Positive where a guard may have come to zero between `before` and `after`, a step of length `h` apart, by how much it bends since `past`, a step
/// of length `h_past` before.
#[inline(always)]
pub(crate) fn overshoot<T: Real>([past, before, after]: [T; 3], [h_past, h]: [T; 2]) -> T {
    let slopes = [(before - past) / h_past, (after - before) / h];
    // half of the second derivative
    let bend = ((slopes[1] - slopes[0]) / (h_past + h)).abs();
    T::from_f64(0.25 * MARGIN) * bend * h * h - before.abs().min(after.abs())
}

/// A place in a step, as a part of it, and how far the guard is on the other side there.
#[derive(Clone, Copy, Debug)]
struct Place {
    theta: f64,
    value: f64,
}

/// The search for a place in a step at which a guard is on the other side, which it is not at its ends. It asks for values and is told.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Excursion {
    /// At the beginning, the ends of the quarters, and the end: negative on this side.
    values: [f64; 5],
    /// Which of the quarters' ends is in the middle.
    middle: usize,
    triple: Option<[Place; 3]>,
    taken: u32,
    found: Option<f64>,
}

impl Excursion {
    /// With the values at the beginning, the ends of the quarters, and the end.
    pub fn new(values: [f64; 5]) -> Self {
        let seen = values[..4].iter().position(|value| *value > 0.0);
        Excursion {
            values,
            middle: 0,
            triple: None,
            taken: 0,
            found: seen.map(|k| 0.25 * k as f64),
        }
    }

    /// A place at which it is on the other side.
    pub fn found(&self) -> Option<f64> {
        self.found
    }

    /// Where it is to be evaluated next, as a part of the step; `None` where the search is over.
    pub fn next(&mut self) -> Option<f64> {
        while self.found.is_none() {
            if let Some(theta) = self.triple.and_then(|triple| self.vertex(triple)) {
                return Some(theta);
            }
            if self.middle == 3 {
                return None;
            }
            self.middle += 1;
            self.taken = 0;
            self.triple = Some([0, 1, 2].map(|k| {
                let place = self.middle + k - 1;
                Place {
                    theta: 0.25 * place as f64,
                    value: self.values[place],
                }
            }));
        }
        None
    }

    /// What it is there.
    pub fn tell(&mut self, value: f64) {
        let Some((triple, theta)) = self.triple.and_then(|t| Some((t, self.vertex(t)?))) else {
            return;
        };
        self.taken += 1;
        if value > 0.0 {
            self.found = Some(theta);
            return;
        }
        let place = Place { theta, value };
        let [a, b, c] = triple;
        let (left, right) = match theta < b.theta {
            true => ([a, place, b], [place, b, c]),
            false => ([a, b, place], [b, place, c]),
        };
        // around the higher of the two inside
        self.triple = Some(match left[1].value >= right[1].value {
            true => left,
            false => right,
        });
    }

    /// Where the parabola through three places has its vertex, unless it is no maximum between them, or cannot be above zero even if it bends
    /// more.
    fn vertex(&self, [a, b, c]: [Place; 3]) -> Option<f64> {
        if self.taken == PATIENCE {
            return None;
        }
        let slopes = [
            (b.value - a.value) / (b.theta - a.theta),
            (c.value - b.value) / (c.theta - b.theta),
        ];
        let width = c.theta - a.theta;
        let bend = (slopes[1] - slopes[0]) / width;
        if bend.is_nan() || bend >= 0.0 {
            return None;
        }
        let gap = (b.theta - a.theta).max(c.theta - b.theta);
        let highest = a.value.max(b.value).max(c.value);
        if highest - 0.25 * MARGIN * bend * gap * gap < 0.0 {
            return None;
        }
        let theta = 0.5 * (a.theta + b.theta) - 0.5 * slopes[0] / bend;
        if !(a.theta < theta && theta < c.theta) {
            return None;
        }
        let least = NEAREST * width;
        let apart = match theta < b.theta {
            true => theta.clamp(a.theta + least, (b.theta - least).max(a.theta + least)),
            false => theta.clamp((b.theta + least).min(c.theta - least), c.theta - least),
        };
        // where the middle is nearer to an end than that, the interval is as small as can be told
        (a.theta < apart && apart < c.theta && apart != b.theta).then_some(apart)
    }
}

#[cfg(test)]
mod tests {
    use super::{Excursion, overshoot};

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
    fn what_stays_on_its_side_is_not_found_and_costs_little_unless_it_comes_near() {
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
    fn a_step_is_looked_into_where_the_guard_can_have_come_to_zero() {
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
