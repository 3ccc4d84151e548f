//! One step of the embedded pair 5(4), with its error and its interpolant.

use super::control::Tolerances;
use super::tableau::dormand_prince::{A, C, E, interpolation_weights};
use super::{Evaluator, NotFinite, combine, first_non_finite};
use crate::{Model, Real, Vector};

/// A step tried: where it leads, and everything needed to judge it and to look inside it.
pub(crate) struct Trial<S> {
    /// Where it starts.
    pub t: f64,
    /// Its length.
    pub h: f64,
    /// The state at its start.
    pub y: S,
    /// The state at its end, order 5, not normalised.
    pub end: S,
    /// k₁ … k₇; the last is the derivative at the end.
    pub k: [S; 7],
}

/// Takes a step from (`t`, `y`) where the derivative is `k1`: six evaluations.
#[inline(always)]
pub(crate) fn attempt<T: Real, M: Model<T>>(
    f: &mut Evaluator<'_, M>,
    t: f64,
    y: &M::State,
    k1: M::State,
    h: f64,
) -> Trial<M::State> {
    let [
        [a21, ..],
        [a31, a32, ..],
        [a41, a42, a43, ..],
        [a51, a52, a53, a54, ..],
        sixth,
        seventh,
    ] = A;
    let [a61, a62, a63, a64, a65, _] = sixth;
    let [a71, _, a73, a74, a75, a76] = seventh;

    let k2 = f.at(t + C[1] * h, &combine(y, h, [a21], [&k1]));
    let k3 = f.at(t + C[2] * h, &combine(y, h, [a31, a32], [&k1, &k2]));
    let k4 = f.at(
        t + C[3] * h,
        &combine(y, h, [a41, a42, a43], [&k1, &k2, &k3]),
    );
    let k5 = f.at(
        t + C[4] * h,
        &combine(y, h, [a51, a52, a53, a54], [&k1, &k2, &k3, &k4]),
    );
    let y6 = combine(y, h, [a61, a62, a63, a64, a65], [&k1, &k2, &k3, &k4, &k5]);
    let k6 = f.at(t + C[5] * h, &y6);
    let end = combine(y, h, [a71, a73, a74, a75, a76], [&k1, &k3, &k4, &k5, &k6]);
    let k7 = f.at(t + C[6] * h, &end);
    Trial {
        t,
        h,
        y: *y,
        end,
        k: [k1, k2, k3, k4, k5, k6, k7],
    }
}

impl<S> Trial<S> {
    /// Largest ratio of estimated error to tolerance over all coordinates (and lanes), `None` where something is not
    /// finite. At most 1 is a good step.
    ///
    /// The largest, not the mean: one element gone astray must not hide among thirty quiet ones.
    #[inline(always)]
    pub fn error<T: Real>(&self, tolerances: &Tolerances, coordinates: usize) -> Option<f64>
    where
        S: Vector<T>,
    {
        let mut worst = T::from_f64(0.0);
        let mut finite = true;
        for i in 0..S::LEN {
            let error = self.error_of(i);
            finite &= (error + self.end[i]).is_finite();
            worst = worst.max(self.ratio(i, error, tolerances, coordinates));
        }
        let worst = worst.to_f64();
        (finite && worst.is_finite()).then_some(worst)
    }

    /// The coordinate with the largest ratio.
    pub fn worst<T: Real>(&self, tolerances: &Tolerances, coordinates: usize) -> usize
    where
        S: Vector<T>,
    {
        let (mut index, mut largest) = (0, 0.0);
        for i in 0..S::LEN {
            let ratio = self
                .ratio(i, self.error_of(i), tolerances, coordinates)
                .to_f64();
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

    /// The first stage of the trial that is not finite.
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

    #[inline(always)]
    fn error_of<T: Real>(&self, i: usize) -> T
    where
        S: Vector<T>,
    {
        let mut error = T::from_f64(0.0);
        for (e, k) in E.iter().zip(&self.k) {
            if *e != 0.0 {
                error = T::from_f64(self.h * e).mul_add(k[i], error);
            }
        }
        error
    }

    #[inline(always)]
    fn ratio<T: Real>(&self, i: usize, error: T, tolerances: &Tolerances, coordinates: usize) -> T
    where
        S: Vector<T>,
    {
        error.abs() / tolerances.scale(i < coordinates, self.y[i].abs().max(self.end[i].abs()))
    }
}
