//! One step of the embedded pair 5(4), with its error and its interpolant.

use super::control::Tolerances;
use super::tableau::dormand_prince::{A, C, E, interpolation_weights};
use super::{Evaluator, NotFinite, combine, first_non_finite};
use crate::{Model, Real, Vector};

/// A step: where it begins, where it leads, and everything needed to judge it and to look inside it.
///
/// It is kept from one step to the next and filled in place, for it is some ten states large.
pub(crate) struct Step<S> {
    /// Where it begins.
    pub t: f64,
    /// Its length.
    pub h: f64,
    /// The state at its beginning.
    pub y: S,
    /// The state at its end, order 5, not normalised.
    pub end: S,
    /// k₁ … k₇: the first is the derivative at the beginning, given; the last that at the end.
    pub k: [S; 7],
}

impl<S> Step<S> {
    /// About to begin at (`t`, `y`), where the derivative is `rate`.
    #[inline(always)]
    pub fn new<T: Real>(t: f64, y: S, rate: S) -> Self
    where
        S: Vector<T>,
    {
        let k = [rate; 7];
        Step {
            t,
            h: 0.0,
            y,
            end: y,
            k,
        }
    }

    /// Goes the length `h`: six evaluations.
    #[inline(always)]
    pub fn take<T: Real, M: Model<T, State = S>>(&mut self, f: &mut Evaluator<'_, M>, h: f64)
    where
        S: Vector<T>,
    {
        let [
            second,
            third,
            fourth,
            fifth,
            sixth,
            [a71, _, a73, a74, a75, a76],
        ] = A;
        let [a21, ..] = second;
        let [a31, a32, ..] = third;
        let [a41, a42, a43, ..] = fourth;
        let [a51, a52, a53, a54, ..] = fifth;
        let [a61, a62, a63, a64, a65, _] = sixth;

        self.h = h;
        let (t, y) = (self.t, &self.y);
        let [k1, k2, k3, k4, k5, k6, k7] = &mut self.k;
        *k2 = f.at(t + C[1] * h, &combine(y, h, [a21], [k1]));
        *k3 = f.at(t + C[2] * h, &combine(y, h, [a31, a32], [k1, k2]));
        *k4 = f.at(t + C[3] * h, &combine(y, h, [a41, a42, a43], [k1, k2, k3]));
        *k5 = f.at(
            t + C[4] * h,
            &combine(y, h, [a51, a52, a53, a54], [k1, k2, k3, k4]),
        );
        *k6 = f.at(
            t + C[5] * h,
            &combine(y, h, [a61, a62, a63, a64, a65], [k1, k2, k3, k4, k5]),
        );
        self.end = combine(y, h, [a71, a73, a74, a75, a76], [k1, k3, k4, k5, k6]);
        *k7 = f.at(t + C[6] * h, &self.end);
    }

    /// Largest ratio of estimated error to tolerance over all coordinates (and lanes), `None` where something is not
    /// finite. At most 1 is a good step.
    ///
    /// The largest, not the mean: one element gone astray must not hide among thirty quiet ones.
    #[inline(always)]
    pub fn error<T: Real>(&self, tolerances: &Tolerances, coordinates: usize) -> Option<f64>
    where
        S: Vector<T>,
    {
        let ratios = self.ratios(tolerances, coordinates);
        let (mut worst, mut sum) = (T::from_f64(0.0), T::from_f64(0.0));
        for i in 0..S::LEN {
            worst = worst.max(ratios[i]);
            // what is not finite gets lost in the maximum, not in the sum
            sum += ratios[i];
        }
        sum.is_finite().then(|| worst.to_f64())
    }

    /// The coordinate with the largest ratio.
    pub fn worst<T: Real>(&self, tolerances: &Tolerances, coordinates: usize) -> usize
    where
        S: Vector<T>,
    {
        let ratios = self.ratios(tolerances, coordinates);
        let (mut index, mut largest) = (0, 0.0);
        for i in 0..S::LEN {
            let ratio = ratios[i].to_f64();
            if ratio > largest {
                (index, largest) = (i, ratio);
            }
        }
        index
    }

    /// The state at t + θh by the interpolant, θ in 0..=1, not normalised.
    #[inline(always)]
    pub fn interpolate<T: Real>(&self, theta: f64) -> S
    where
        S: Vector<T>,
    {
        let [k1, _, k3, k4, k5, k6, k7] = &self.k;
        let [b1, _, b3, b4, b5, b6, b7] = interpolation_weights(theta);
        combine(
            &self.y,
            self.h,
            [b1, b3, b4, b5, b6, b7],
            [k1, k3, k4, k5, k6, k7],
        )
    }

    /// The first stage of the step that is not finite.
    pub fn not_finite<T: Real>(&self) -> Option<NotFinite<S>>
    where
        S: Vector<T>,
    {
        for (stage, k) in self.k.iter().enumerate() {
            let y = self.stage_state(stage);
            let t = self.t + C[stage] * self.h;
            if let Some(index) = first_non_finite(&y) {
                return Some(NotFinite {
                    t,
                    y,
                    index,
                    in_derivative: false,
                });
            }
            if let Some(index) = first_non_finite(k) {
                return Some(NotFinite {
                    t,
                    y,
                    index,
                    in_derivative: true,
                });
            }
        }
        None
    }

    /// The state at which a stage was evaluated.
    fn stage_state<T: Real>(&self, stage: usize) -> S
    where
        S: Vector<T>,
    {
        let row = if stage == 0 { [0.0; 6] } else { A[stage - 1] };
        let earlier = row.iter().zip(&self.k).take(stage);
        earlier.fold(self.y, |y, (a, k)| combine(&y, self.h, [*a], [k]))
    }

    /// Estimated error over tolerance of each entry; NaN where the end is not finite.
    #[inline(always)]
    fn ratios<T: Real>(&self, tolerances: &Tolerances, coordinates: usize) -> S
    where
        S: Vector<T>,
    {
        let [k1, _, k3, k4, k5, k6, k7] = &self.k;
        let [e1, _, e3, e4, e5, e6, e7] = E;
        let zero = S::splat(T::from_f64(0.0));
        let weights = [e1, e3, e4, e5, e6, e7];
        let mut ratios = combine(&zero, self.h, weights, [k1, k3, k4, k5, k6, k7]);
        for i in 0..S::LEN {
            let magnitude = self.y[i].abs().max(self.end[i].abs());
            let scale = tolerances.scale(i < coordinates, magnitude);
            ratios[i] = ratios[i].abs() / scale + self.end[i].taint();
        }
        ratios
    }
}
