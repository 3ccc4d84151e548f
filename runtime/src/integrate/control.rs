//! Step size control: h⁺ = h · s · (err₋/err³)^(1/5k), the controller PI.4.2 (Söderlind 2003) for an error estimate
//! that falls like h^k.
//!
//! err is the largest ratio of estimated error to tolerance, and err₋ that of the step before. The proportional part
//! keeps the step from oscillating where stability, not accuracy, limits it, as in stiff contacts. Only basic
//! arithmetic is used, so a run takes the same steps on every machine if the model gives the same derivatives.

use super::workspace::Workspace;
use super::{Evaluator, combine};
use crate::real::{Mask, Number};
use crate::{Info, Real, StateKind};

/// The error allowed in one step, for each kind of entry of the state. For velocities and states of laws it is
/// absolute + relative · |y|. For positions and angles it is the absolute part alone, because their size says only
/// where the origin is and how often something turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Relative part, below 1.
    pub relative: f64,
    /// Absolute part of positions \[m\].
    pub positions: f64,
    /// Absolute part of angles \[rad\] and of components of quaternions. It is below 1, the size of a quaternion.
    pub angles: f64,
    /// Absolute part of velocities \[m/s\].
    pub velocities: f64,
    /// Absolute part of angular velocities \[rad/s\].
    pub angular_velocities: f64,
    /// Absolute part of states of force laws, in their own units.
    pub laws: f64,
    /// Share of the largest acceleration, linear or angular, up to which an oscillation may grow that is too fast for
    /// the steps; with 1 or more there is no control. All adaptive methods except `rodas5` have the two stages at the
    /// end of a step that this control needs; `rodas5` damps such oscillations.
    pub accelerations: f64,
}

impl Default for Tolerances {
    /// [`Tolerances::of`] 10⁻⁷. With it the outputs of crash scenes are accurate to 0.1 % (docs/accuracy.md).
    fn default() -> Self {
        Tolerances::of(1e-7)
    }
}

/// The smallest relative tolerance of a number, because of rounding: 16 ε.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The share allowed of the largest acceleration over the relative tolerance. The controller aims below it: a motion at
/// the limit settles where its error is 0.95^12.5 = 0.53. Accelerations count by a root, so it settles at 0.28 of the
/// share: a little less than 10⁴ tolerances.
const ACCELERATIONS: f64 = 3e4;

/// The largest share of the largest acceleration that [`Tolerances::calm`] leaves.
const CALM: f64 = 0.3;

impl Tolerances {
    /// A relative tolerance r and the absolute ones that go with it: r/10 for positions \[m\] and angles \[rad\],
    /// because bodies move by decimetres, and r for velocities. 10⁻⁷ stands for 10 nm and 0.002 arc seconds.
    /// Accelerations get 3·10⁴ r, of which the controller uses a third: at 10⁻⁷ it is 0.1 %, the accuracy promised for
    /// outputs.
    pub const fn of(relative: f64) -> Tolerances {
        Tolerances {
            relative,
            positions: 0.1 * relative,
            angles: 0.1 * relative,
            velocities: relative,
            angular_velocities: relative,
            laws: relative,
            accelerations: ACCELERATIONS * relative,
        }
    }

    /// The same tolerance, relative and absolute, for everything; 3·10⁴ times as much for accelerations.
    pub const fn uniform(tolerance: f64) -> Tolerances {
        Tolerances {
            relative: tolerance,
            positions: tolerance,
            angles: tolerance,
            velocities: tolerance,
            angular_velocities: tolerance,
            laws: tolerance,
            accelerations: ACCELERATIONS * tolerance,
        }
    }

    /// These tolerances, but with at most 0.3 of the largest acceleration for an oscillation that is too fast for the
    /// steps. At a tolerance above 10⁻⁵ it would grow further, until belts and contacts turn from loading to unloading
    /// in every step: then a run at 10⁻² takes more steps than one at 10⁻⁷. Two runs with the same share have the same
    /// error in a motion that is so fast, so one of them is no check of the other.
    #[must_use]
    pub const fn calm(self) -> Tolerances {
        Tolerances {
            accelerations: self.accelerations.min(CALM),
            ..self
        }
    }

    /// The absolute part for an entry of this kind.
    #[inline(always)]
    const fn absolute(&self, kind: StateKind) -> f64 {
        match kind {
            StateKind::Position => self.positions,
            StateKind::Angle => self.angles,
            StateKind::Velocity => self.velocities,
            StateKind::AngularVelocity => self.angular_velocities,
            // discrete states do not change in a step
            StateKind::Law | StateKind::Memory => self.laws,
        }
    }

    /// The relative and the absolute part for an entry of this kind.
    #[inline(always)]
    pub(crate) const fn parts(&self, kind: StateKind) -> [f64; 2] {
        let relative = match kind {
            StateKind::Position | StateKind::Angle => self.relative.min(ROUNDING),
            _ => self.relative,
        };
        [relative, self.absolute(kind)]
    }
}

/// The error allowed in each entry of a state.
pub(crate) struct Allowed<'w, T> {
    /// The relative part for each entry.
    relative: &'w mut [T],
    absolute: &'w mut [T],
}

impl<T> Allowed<'_, T> {
    /// Number of scalars of workspace for a state of this length.
    pub const fn length(state: usize) -> usize {
        2 * state
    }
}

impl<'w, T: Real> Allowed<'w, T> {
    /// The errors allowed in the states of a model.
    pub fn new(tolerances: &Tolerances, info: &Info, workspace: &mut Workspace<'w, T>) -> Self {
        let state = info.state_length();
        let allowed = Allowed {
            relative: workspace.part(state),
            absolute: workspace.part(state),
        };
        for (i, kind) in info.kinds.iter().enumerate() {
            let [relative, absolute] = tolerances.parts(*kind);
            allowed.relative[i] = T::from_f64(relative);
            allowed.absolute[i] = T::from_f64(absolute);
        }
        allowed
    }

    /// The error allowed in each entry, given the magnitudes of the entries.
    #[inline(always)]
    fn each(&self, magnitudes: impl Iterator<Item = T>) -> impl Iterator<Item = T> {
        let parts = self.relative.iter().zip(&*self.absolute);
        let each = parts.zip(magnitudes);
        each.map(|((relative, absolute), magnitude)| relative.mul_add(magnitude, *absolute))
    }

    /// The ratio of estimated to allowed error of each entry, for a step from `y` to `end`; NaN where `end` is not
    /// finite.
    #[inline(always)]
    fn ratios(&self, y: &[T], end: &[T], estimate: &[T]) -> impl Iterator<Item = T> {
        let ends = || y.iter().zip(end);
        let scales = self.each(ends().map(|(y, end)| y.abs().max(end.abs())));
        let errors = scales.zip(estimate).zip(end);
        errors.map(|((scale, estimate), end)| estimate.abs() / scale + end.taint())
    }

    /// The largest ratio of estimated to allowed error over all entries (and lanes) of a step from `y` to `end`; `None`
    /// where something is not finite. A good step has at most 1.
    ///
    /// The largest and not the mean ratio counts, because one element with a large error must not hide among thirty
    /// quiet ones.
    pub fn error(&self, y: &[T], end: &[T], estimate: &[T]) -> Option<f64> {
        let (mut worst, mut sum) = (T::from_f64(0.0), T::from_f64(0.0));
        for ratio in self.ratios(y, end, estimate) {
            worst = worst.max(ratio);
            // a value that is not finite may get lost in the maximum, but not in the sum
            sum += ratio;
        }
        sum.is_finite().then(|| worst.to_f64())
    }

    /// The entry with the largest ratio.
    #[cold]
    pub fn worst(&self, y: &[T], end: &[T], estimate: &[T]) -> usize {
        let (mut index, mut largest) = (0, 0.0);
        for (i, ratio) in self.ratios(y, end, estimate).enumerate() {
            let ratio = ratio.to_f64();
            if ratio > largest {
                (index, largest) = (i, ratio);
            }
        }
        index
    }

    /// The largest ratio of an entry of `change` to the error allowed in the same entry of `y`.
    pub fn norm(&self, change: &[T], y: &[T]) -> f64 {
        let mut worst = T::from_f64(0.0);
        for (change, scale) in change.iter().zip(self.each(y.iter().map(|y| y.abs()))) {
            worst = worst.max(change.abs() / scale);
        }
        worst.to_f64()
    }
}

/// Safety factor: the step aims slightly below the tolerance.
const SAFETY: f64 = 0.95;
/// Largest factor on the step in one go, up or down.
const LIMIT: f64 = 5.0;
/// Smaller errors count as this one: they only say that the step may grow.
const SMALLEST_ERROR: f64 = 1e-10;

/// A way to compute roots.
pub(crate) trait Roots<P> {
    /// x^(1/(a b)) of a number that is not negative. To be `#[inline(always)]`.
    fn root(x: P, parts: [u32; 2]) -> P;
}

/// Roots by basic arithmetic alone: [`root`].
pub(crate) struct Basic;

impl Roots<f64> for Basic {
    #[inline(always)]
    fn root(x: f64, [a, b]: [u32; 2]) -> f64 {
        match a * b {
            2 => square_root(x),
            _ => root(root(x, a), b),
        }
    }
}

/// √x of a number that is not negative.
#[inline(always)]
pub(super) fn square_root(x: f64) -> f64 {
    #[cfg(feature = "std")]
    return x.sqrt();
    #[cfg(not(feature = "std"))]
    return root(x, 2);
}

/// The step size controller of a single run or of each lane, with the error of the step before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Controller<P: Number> {
    /// The error estimate falls like this power of the step.
    estimate: u32,
    previous_error: P,
    just_rejected: P::Mask,
}

impl<P: Number> Controller<P> {
    /// The controller at the start, and wherever the derivative jumps.
    #[inline(always)]
    pub fn new(estimate: u32) -> Self {
        Controller {
            estimate,
            previous_error: P::from_f64(1.0),
            just_rejected: P::Mask::of_lanes(0),
        }
    }

    /// Factor on the step after one with this error, which is at least [`SMALLEST_ERROR`], was accepted.
    #[inline(always)]
    fn grown<R: Roots<P>>(&self, error: P) -> P {
        let c = P::from_f64;
        let quotient = self.previous_error / (error * error * error);
        let grown = c(SAFETY) * R::root(quotient, [5, self.estimate]);
        let largest = P::select(self.just_rejected, c(1.0), c(LIMIT));
        grown.max(c(1.0 / LIMIT)).min(largest)
    }

    /// Factor on the step after one with this error, which is at least 1, was rejected.
    #[inline(always)]
    fn shrunk<R: Roots<P>>(&self, error: P) -> P {
        let c = P::from_f64;
        let shrunk = c(SAFETY) / R::root(error, [1, self.estimate]);
        shrunk.max(c(1.0 / LIMIT)).min(c(0.9))
    }

    /// Resets these lanes to the controller at the start: where a run begins, and where the derivative jumps.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn reset(&mut self, lanes: P::Mask) {
        self.previous_error = P::select(lanes, P::from_f64(1.0), self.previous_error);
        self.just_rejected = self.just_rejected.and(lanes.not());
    }

    /// Factor on the step after one with these errors. Of the lanes in `taken`, the step was accepted in `accepted` and
    /// rejected in the others. Lanes outside of `taken` do not change.
    #[cfg(feature = "std")]
    #[inline(always)]
    pub fn factor<R: Roots<P>>(&mut self, error: P, accepted: P::Mask, taken: P::Mask) -> P {
        let c = P::from_f64;
        let finite = error.lt(c(f64::INFINITY));
        let number = P::select(finite, error, c(1.0));
        let small = number.max(c(SMALLEST_ERROR));
        let grown = self.grown::<R>(small);
        let shrunk = self.shrunk::<R>(number.max(c(1.0)));
        let shrunk = P::select(finite, shrunk, c(1.0 / LIMIT));

        let good = accepted.and(taken);
        self.previous_error = P::select(good, small, self.previous_error);
        let untouched = self.just_rejected.and(taken.not());
        self.just_rejected = untouched.or(taken.and(accepted.not()));
        P::select(accepted, grown, shrunk)
    }
}

impl Controller<f64> {
    /// Factor on the step after an accepted step, whose `error` is ≤ 1.
    pub fn accepted(&mut self, error: f64) -> f64 {
        let error = error.max(SMALLEST_ERROR);
        let factor = self.grown::<Basic>(error);
        (self.previous_error, self.just_rejected) = (error, false);
        factor
    }

    /// Factor on the step after a rejected step: its `error` is > 1, or its end is not finite (`None`).
    pub fn rejected(&mut self, error: Option<f64>) -> f64 {
        self.just_rejected = true;
        error.map_or(1.0 / LIMIT, |error| self.shrunk::<Basic>(error))
    }
}

/// A first guess of the step by the sizes of y and ẏ, each over the error allowed. At most `largest`.
#[inline(always)]
pub(crate) fn first_guess<P: Number>([d0, d1]: [P; 2], largest: P) -> P {
    let c = P::from_f64;
    let few = d0.lt(c(1e-5)).or(d1.lt(c(1e-5)));
    let quotient = c(0.01) * d0 / d1.max(c(1e-5));
    P::select(few, c(1e-6), quotient).min(largest)
}

/// The first step of a method of this order, by that guess and by the sizes of ẏ and of its change over the guess.
/// Positive and at most `largest`.
#[inline(always)]
pub(crate) fn first_length<P: Number, R: Roots<P>>(
    guess: P,
    [d1, change]: [P; 2],
    largest: P,
    order: u32,
) -> P {
    let c = P::from_f64;
    let steepest = d1.max(change / guess);
    let flat = (c(1e-3) * guess).max(c(1e-6));
    let by_curvature = R::root(c(0.01) / steepest.max(c(1e-15)), [1, order + 1]);
    let by_curvature = P::select(c(1e-15).lt(steepest), by_curvature, flat);
    let h = (c(100.0) * guess).min(by_curvature).min(largest);
    // near the ends of the range of numbers: begin with a small step; the controller corrects it
    P::select(c(0.0).lt(h), h, largest.min(c(1e-6)))
}

/// The first step of a method of this order from `y` at time `t` with the derivative `k1`. It compares y, ẏ and ÿ
/// (Hairer, Nørsett & Wanner, *Solving ODEs I*, II.4) and takes one evaluation. The result is positive and at most
/// `largest`. The last two slices are scratch.
pub(crate) fn first_step<T: Real>(
    f: &mut Evaluator<'_, T>,
    t: f64,
    [y, k1]: [&[T]; 2],
    allowed: &Allowed<'_, T>,
    largest: f64,
    order: u32,
    [between, k2]: [&mut [T]; 2],
) -> f64 {
    let (d0, d1) = (allowed.norm(y, y), allowed.norm(k1, y));
    let guess = first_guess([d0, d1], largest);
    // an Euler step gives the second derivative
    combine(y, guess, &[1.0], k1, between);
    f.at(t + guess, between, k2);
    for (k2, k1) in k2.iter_mut().zip(k1) {
        *k2 = *k2 - *k1;
    }
    let change = allowed.norm(k2, y);
    first_length::<_, Basic>(guess, [d1, change], largest, order)
}

/// x^(1/n) of a positive finite number by basic arithmetic alone, to a few rounding errors; 0 where x is not positive.
pub(crate) fn root(x: f64, n: u32) -> f64 {
    if x.is_nan() || x < f64::MIN_POSITIVE {
        return 0.0;
    }
    if x == f64::INFINITY || n < 2 {
        return x;
    }
    // divides the exponent by n, then takes Newton's iteration for yⁿ = x
    let parts = u64::from(n);
    let mut y = f64::from_bits(x.to_bits() / parts + ONE_BITS / parts * (parts - 1));
    let share = 1.0 / f64::from(n);
    for _ in 0..8 {
        let mut power = y;
        for _ in 2..n {
            power *= y;
        }
        let next = y - share * (y - x / power);
        if next == y {
            break;
        }
        y = next;
    }
    y
}

const ONE_BITS: u64 = 1.0_f64.to_bits();

#[cfg(test)]
mod tests {
    use super::{Controller, root};

    #[test]
    fn a_root_to_its_power_is_the_number() {
        for n in 2..=9 {
            for exponent in -300..300 {
                let x = 10.0_f64.powi(exponent) * 1.7;
                let y = root(x, n);
                // n roundings in the power, and the root's own times n
                let bound = 4.0 * f64::from(n) * f64::EPSILON;
                assert!((y.powi(n as i32) / x - 1.0).abs() < bound, "{x} {n}");
            }
        }
        assert_eq!(root(32.0, 5), 2.0);
        assert_eq!(root(0.0, 5), 0.0);
        assert_eq!(root(f64::INFINITY, 5), f64::INFINITY);
    }

    #[test]
    fn steps_settle_where_the_error_is_a_little_below_tolerance() {
        // a problem whose error is (h/0.01)⁵ tolerances
        let mut controller = Controller::new(5);
        let mut h = 1e-3;
        for _ in 0..100 {
            h *= controller.accepted((h / 0.01_f64).powi(5));
        }
        // at rest s · err^(−2/25) = 1: err = 0.95^12.5
        let error = (h / 0.01_f64).powi(5);
        assert!((error / 0.95_f64.powf(12.5) - 1.0).abs() < 1e-3, "{error}");
    }

    #[test]
    fn a_rejected_step_shrinks_and_the_next_does_not_grow() {
        let mut controller = Controller::new(5);
        assert!(controller.rejected(Some(1.0001)) <= 0.9);
        assert_eq!(controller.rejected(None), 0.2);
        assert_eq!(controller.accepted(0.0), 1.0);
        assert_eq!(controller.accepted(0.0), 5.0);
    }
}
