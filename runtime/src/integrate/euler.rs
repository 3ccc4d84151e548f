//! A step of the semi-implicit Euler method:  v⁺ = v + h v̇(t, q, v),  q⁺ = q + h q̇(q, v⁺);  states of force laws like v.
//!
//! Order 1, one evaluation. Of a system whose energy is conserved it keeps a nearby one (it is symplectic where q̇ = v), which
//! is why programs that need no more than a picture like it.

use super::{Evaluator, Span, Stepper, combine};
use crate::{Model, Real, Vector};

/// A step of the method.
pub(crate) struct SemiImplicitEuler<S> {
    span: Span<S>,
    rate: S,
}

impl<T: Real, M: Model<T>> Stepper<T, M> for SemiImplicitEuler<M::State> {
    const ESTIMATE: u32 = 0;

    #[inline(always)]
    fn new(_: &M, t: f64, y: M::State, rate: M::State) -> Self {
        let span = Span {
            t,
            h: 0.0,
            y,
            end: y,
        };
        SemiImplicitEuler { span, rate }
    }

    #[inline(always)]
    fn begin(&mut self, t: f64, y: M::State, rate: M::State) {
        (self.span.t, self.span.y, self.rate) = (t, y, rate);
    }

    #[inline(always)]
    fn take(&mut self, f: &mut Evaluator<'_, T, M>, h: f64) {
        let coordinates = M::INFO.coordinates.len();
        let mut end = combine(&self.span.y, h, &[1.0], &[self.rate]);
        // old coordinates, new velocities
        let mut between = end;
        between.as_mut()[..coordinates].copy_from_slice(&self.span.y.as_ref()[..coordinates]);
        let mut rate = self.rate;
        f.model.coordinate_rates(&between, &mut rate);
        let h_t = T::from_f64(h);
        for i in 0..coordinates {
            end[i] = h_t.mul_add(rate[i], self.span.y[i]);
        }
        (self.span.h, self.span.end) = (h, end);
    }

    #[inline(always)]
    fn span(&self) -> &Span<M::State> {
        &self.span
    }

    #[inline(always)]
    fn estimate(&self) -> M::State {
        M::State::splat(T::from_f64(0.0))
    }

    #[inline(always)]
    fn complete(&mut self, _: &mut Evaluator<'_, T, M>) {}

    #[inline(always)]
    fn interpolate(&self, theta: f64) -> M::State {
        let Span { y, end, .. } = &self.span;
        let (theta, mut between) = (T::from_f64(theta), *y);
        for i in 0..M::State::LEN {
            between[i] = theta.mul_add(end[i] - y[i], y[i]);
        }
        between
    }

    #[inline(always)]
    fn end_rate(&self) -> Option<&M::State> {
        None
    }

    #[inline(always)]
    fn neighbour(&self) -> Option<(M::State, M::State)> {
        Some((self.span.y, self.rate))
    }
}
