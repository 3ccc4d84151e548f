//! A step of an explicit Runge–Kutta method:  k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),  y⁺ = y + h Σ b_i k_i.

use super::tableau::Tableau;
use super::workspace::Workspace;
use super::{Evaluator, Span, Stepper, combine};
use crate::Real;
use crate::failure::Reason;
use core::marker::PhantomData;

/// A step of the method of a tableau.
pub(crate) struct Explicit<'w, T, B> {
    span: Span<'w, T>,
    /// The derivatives k₁, k₂, … one after the other. The first is the derivative at the beginning, which is given.
    /// Behind those of the step stand those that only the interpolant needs.
    k: &'w mut [T],
    /// The state of a stage.
    stage: &'w mut [T],
    /// Number of stages that have been evaluated.
    known: usize,
    by: PhantomData<B>,
}

impl<T, B: Tableau> Explicit<'_, T, B> {
    /// Number of scalars of workspace that a step needs for a state of this length.
    pub const fn length(state: usize) -> usize {
        (3 + B::ALL) * state
    }
}

impl<'w, T: Real, B: Tableau> Explicit<'w, T, B> {
    /// A step for a state of this length.
    pub fn new(state: usize, workspace: &mut Workspace<'w, T>) -> Self {
        Explicit {
            span: Span::new(state, workspace),
            k: workspace.part(B::ALL * state),
            stage: workspace.part(state),
            known: 0,
            by: PhantomData,
        }
    }

    /// Evaluates a stage. Where the last stage is the first of the next step, its state is the end of the step.
    #[inline(always)]
    fn stage<const I: usize>(&mut self, f: &mut Evaluator<'_, T>) {
        let Span { t, h, y, end } = &mut self.span;
        let (before, rest) = self.k.split_at_mut(I * y.len());
        let state = match B::LAST_IS_FIRST && I + 1 == B::STAGES {
            true => &mut **end,
            false => &mut *self.stage,
        };
        combine(y, *h, B::A[I], before, state);
        f.at(*t + B::C[I] * *h, state, &mut rest[..y.len()]);
    }

    /// Evaluates the stages from `from` to before `to`.
    #[inline(always)]
    fn stages(&mut self, f: &mut Evaluator<'_, T>, from: usize, to: usize) {
        // written out, so that the compiler knows the coefficients of every stage; those that the method lacks are not
        // compiled
        macro_rules! stages {
            ($($i:literal)*) => {
                $(if const { $i < B::ALL } && from <= $i && $i < to { self.stage::<$i>(f); })*
            };
        }
        stages!(1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
    }
}

impl<T: Real, B: Tableau> Stepper<T> for Explicit<'_, T, B> {
    fn order_of_estimate(&self) -> u32 {
        B::ESTIMATE
    }

    fn begin(&mut self, t: f64, y: &[T], rate: &[T]) {
        self.span.begin(t, y);
        self.k[..rate.len()].copy_from_slice(rate);
    }

    fn take(&mut self, f: &mut Evaluator<'_, T>, h: f64) -> Result<(), Reason> {
        self.span.h = h;
        self.stages(f, 1, B::STAGES);
        self.known = B::STAGES;
        if !B::LAST_IS_FIRST {
            let Span { y, end, .. } = &mut self.span;
            combine(y, h, B::B, self.k, end);
        }
        Ok(())
    }

    fn span(&self) -> &Span<'_, T> {
        &self.span
    }

    fn finish(&mut self, f: &mut Evaluator<'_, T>) {
        if !B::LAST_IS_FIRST && self.known == B::STAGES && B::STAGES < B::ALL {
            self.stages(f, B::STAGES, B::STAGES + 1);
            self.known = B::STAGES + 1;
        }
    }

    fn estimate(&mut self, errors: &mut [T]) {
        let [first, second] = B::E;
        // h Σ e_i k_i begins with 0
        self.stage.fill(T::from_f64(0.0));
        combine(self.stage, self.span.h, first, self.k, errors);
        if const { !B::E[1].is_empty() } {
            let h = self.span.h;
            let state = errors.len();
            // |e|²/√(e² + ē²/100): of the order of e²/ē (Hairer, Nørsett & Wanner, Solving ODEs I, II.10), entry by
            // entry
            let tiny = T::from_f64(f64::from(f32::MIN_POSITIVE));
            for (i, error) in errors.iter_mut().enumerate() {
                let mut coarse = T::from_f64(0.0);
                for (j, weight) in second.iter().enumerate() {
                    if *weight != 0.0 {
                        coarse = T::from_product(h, *weight).mul_add(self.k[j * state + i], coarse);
                    }
                }
                let (e, c) = (error.abs(), coarse.abs() * T::from_f64(0.1));
                let larger = e.max(c).max(tiny);
                let (e, c) = (e / larger, c / larger);
                *error = larger * (e * e / (e * e + c * c).sqrt().max(tiny));
            }
        }
    }

    fn complete(&mut self, f: &mut Evaluator<'_, T>) {
        self.stages(f, self.known, B::ALL);
        self.known = B::ALL;
    }

    fn interpolate(&self, theta: f64, inside: &mut [T]) {
        let Span { h, y, end, .. } = &self.span;
        if theta == 1.0 {
            inside.copy_from_slice(end);
            return;
        }
        let length = inside.len();
        let mut weights = B::weights(T::from_f64(theta));
        let mut rows = B::splat(&self.k[..length]);
        for (j, weight) in weights.as_mut().iter_mut().enumerate() {
            *weight = *weight * T::from_f64(*h);
            rows.as_mut()[j] = &self.k[j * length..][..length];
        }
        let (weights, rows) = (weights.as_ref(), rows.as_ref());
        let y = &y[..length];
        for i in 0..length {
            let mut sum = y[i];
            for j in 0..B::ALL {
                if B::counts(j) {
                    sum = weights[j].mul_add(rows[j][i], sum);
                }
            }
            inside[i] = sum;
        }
    }

    fn cubic(&self, theta: f64, inside: &mut [T]) -> bool {
        let own = B::ALL + usize::from(B::LAST_IS_FIRST) - B::STAGES;
        match self.end_rate() {
            Some(last) if own > 1 => self.span.cubic([self.k, last], theta, inside),
            _ => return false,
        }
        true
    }

    fn end_rate(&self) -> Option<&[T]> {
        // the last stage of the step, or the first stage for the interpolant, is at the end
        let index = B::STAGES - usize::from(B::LAST_IS_FIRST);
        if index >= self.known {
            return None;
        }
        let length = self.span.y.len();
        Some(&self.k[index * length..][..length])
    }

    fn neighbour(&self, state: &mut [T]) -> Option<&[T]> {
        // where the last stage is the first of the next step, its state is the end itself
        let index = const {
            let mut i = B::STAGES - B::LAST_IS_FIRST as usize;
            loop {
                i -= 1;
                if i == 0 {
                    break None;
                }
                if B::C[i] == 1.0 {
                    break Some(i);
                }
            }
        }?;
        let Span { h, y, .. } = &self.span;
        combine(y, *h, B::A[index], self.k, state);
        Some(&self.k[index * y.len()..][..y.len()])
    }
}
