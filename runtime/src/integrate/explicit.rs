//! A step of an explicit Runge–Kutta method:  k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),  y⁺ = y + h Σ b_i k_i.

use super::tableau::Tableau;
use super::{Evaluator, Span, Stepper, combine};
use crate::{Model, Real, Vector};

/// A step of the method of a tableau.
pub(crate) struct Explicit<S: Copy, B: Tableau> {
    span: Span<S>,
    /// k₁ …: the first is the derivative at the beginning, given; behind those of the step stand those that only the
    /// interpolant needs.
    k: B::Stages<S>,
    /// Whether these have been evaluated.
    complete: bool,
}

impl<S: Copy, B: Tableau> Explicit<S, B> {
    /// The state of stage `I`, whose derivative is put in its place.
    #[inline(always)]
    fn stage<T: Real, M: Model<T, State = S>, const I: usize>(
        &mut self,
        f: &mut Evaluator<'_, T, M>,
    ) -> S
    where
        S: Vector<T>,
    {
        let Span { t, h, y, .. } = &self.span;
        let state = combine(y, *h, B::A[I], self.k.as_ref());
        let rate = f.at(t + B::C[I] * h, &state);
        self.k.as_mut()[I] = rate;
        state
    }

    /// The stages from `FROM` to before `TO`; the state of the last.
    #[inline(always)]
    fn stages<T: Real, M: Model<T, State = S>>(
        &mut self,
        f: &mut Evaluator<'_, T, M>,
        from: usize,
        to: usize,
    ) -> S
    where
        S: Vector<T>,
    {
        let mut last = self.span.y;
        // written out, so that every stage knows its coefficients when it is compiled
        macro_rules! stages {
            ($($i:literal)*) => {
                $(if from <= $i && $i < to { last = self.stage::<T, M, $i>(f); })*
            };
        }
        stages!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
        last
    }
}

impl<T: Real, M: Model<T>, B: Tableau> Stepper<T, M> for Explicit<M::State, B> {
    const ESTIMATE: u32 = B::ESTIMATE;

    #[inline(always)]
    fn new(_: &M, t: f64, y: M::State, rate: M::State) -> Self {
        Explicit {
            span: Span {
                t,
                h: 0.0,
                y,
                end: y,
            },
            k: B::splat(rate),
            complete: false,
        }
    }

    #[inline(always)]
    fn begin(&mut self, t: f64, y: M::State, rate: M::State) {
        self.span.t = t;
        self.span.y = y;
        self.k.as_mut()[0] = rate;
    }

    #[inline(always)]
    fn take(&mut self, f: &mut Evaluator<'_, T, M>, h: f64) {
        self.span.h = h;
        self.complete = B::STAGES == B::ALL;
        let last = self.stages::<T, M>(f, 1, B::STAGES);
        self.span.end = if B::LAST_IS_FIRST {
            last
        } else {
            combine(&self.span.y, h, B::B, self.k.as_ref())
        };
    }

    #[inline(always)]
    fn span(&self) -> &Span<M::State> {
        &self.span
    }

    #[inline(always)]
    fn estimate(&self) -> M::State {
        let zero = M::State::splat(T::from_f64(0.0));
        let estimate = |weights| combine(&zero, self.span.h, weights, self.k.as_ref());
        let [first, second] = B::E;
        let mut errors = estimate(first);
        if !second.is_empty() {
            // |e|²/√(e² + ē²/100): of the order of e²/ē (Hairer, Nørsett & Wanner, Solving ODEs I, II.10), entry by entry
            let tiny = T::from_f64(f64::from(f32::MIN_POSITIVE));
            let coarse = estimate(second);
            for i in 0..M::State::LEN {
                let (e, c) = (errors[i].abs(), coarse[i].abs() * T::from_f64(0.1));
                let larger = e.max(c).max(tiny);
                let (e, c) = (e / larger, c / larger);
                errors[i] = larger * (e * e / (e * e + c * c).sqrt().max(tiny));
            }
        }
        errors
    }

    #[inline(always)]
    fn complete(&mut self, f: &mut Evaluator<'_, T, M>) {
        if !self.complete {
            self.stages::<T, M>(f, B::STAGES, B::ALL);
            self.complete = true;
        }
    }

    #[inline(always)]
    fn interpolate(&self, theta: f64) -> M::State {
        let Span { h, y, end, .. } = &self.span;
        if theta == 1.0 {
            return *end;
        }
        let mut weights = B::weights(T::from_f64(theta));
        for weight in weights.as_mut() {
            *weight = *weight * T::from_f64(*h);
        }
        let mut inside = *y;
        for i in 0..M::State::LEN {
            for (j, (weight, k)) in weights.as_ref().iter().zip(self.k.as_ref()).enumerate() {
                if B::counts(j) {
                    inside[i] = weight.mul_add(k[i], inside[i]);
                }
            }
        }
        inside
    }

    #[inline(always)]
    fn end_rate(&self) -> Option<&M::State> {
        // the last stage of the step, or the first of those for the interpolant, is at the end
        let index = B::STAGES - usize::from(B::LAST_IS_FIRST);
        match self.complete || B::LAST_IS_FIRST {
            true => self.k.as_ref().get(index),
            false => None,
        }
    }

    #[inline(never)]
    fn neighbour(&self) -> Option<(M::State, M::State)> {
        // the state of a last stage that is the first of the next step is the end itself
        let before = B::STAGES - usize::from(B::LAST_IS_FIRST);
        let index = (1..before).rev().find(|&i| B::C[i] == 1.0)?;
        let Span { h, y, .. } = &self.span;
        let state = combine(y, *h, B::A[index], self.k.as_ref());
        Some((state, *self.k.as_ref().get(index)?))
    }
}
