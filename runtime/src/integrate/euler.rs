//! A step of the semi-implicit Euler method: v⁺ = v + h v̇(t, q, v), q⁺ = q + h q̇(q, v⁺); states of force laws like v.
//!
//! The order is 1, with one evaluation a step. If energy is conserved and q̇ = v, the method is symplectic: it
//! conserves a nearby energy. So programs that need no more than a picture often use it.

use super::workspace::Workspace;
use super::{Evaluator, Span, Stepper, combine};
use crate::Real;
use crate::failure::Reason;

/// A step of the method.
pub(crate) struct SemiImplicitEuler<'w, T> {
    span: Span<'w, T>,
    /// Number of coordinates.
    coordinates: usize,
    /// The derivative at the beginning of the step.
    rate: &'w mut [T],
    /// The old coordinates with the new velocities, then q̇ there.
    between: &'w mut [T],
    coordinate_rates: &'w mut [T],
}

impl<T> SemiImplicitEuler<'_, T> {
    /// Number of scalars of workspace that a step needs for a state of this length.
    pub const fn length(state: usize) -> usize {
        5 * state
    }
}

impl<'w, T: Real> SemiImplicitEuler<'w, T> {
    /// A step for a state of this length, whose first entries are the coordinates.
    pub fn new(state: usize, coordinates: usize, workspace: &mut Workspace<'w, T>) -> Self {
        SemiImplicitEuler {
            span: Span::new(state, workspace),
            coordinates,
            rate: workspace.part(state),
            between: workspace.part(state),
            coordinate_rates: workspace.part(state),
        }
    }
}

impl<T: Real> Stepper<T> for SemiImplicitEuler<'_, T> {
    fn order_of_estimate(&self) -> u32 {
        0
    }

    fn begin(&mut self, t: f64, y: &[T], rate: &[T]) {
        self.span.begin(t, y);
        self.rate.copy_from_slice(rate);
    }

    fn take(&mut self, f: &mut Evaluator<'_, T>, h: f64) -> Result<(), Reason> {
        self.span.h = h;
        let Span { y, end, .. } = &mut self.span;
        combine(y, h, &[1.0], self.rate, end);
        let (coordinates, velocities) = self.between.split_at_mut(self.coordinates);
        coordinates.copy_from_slice(&y[..self.coordinates]);
        velocities.copy_from_slice(&end[self.coordinates..]);
        f.model
            .coordinate_rates(self.between, self.coordinate_rates);
        let h = T::from_f64(h);
        let rates = self.coordinate_rates.iter().take(self.coordinates);
        for ((end, y), rate) in end.iter_mut().zip(&**y).zip(rates) {
            *end = h.mul_add(*rate, *y);
        }
        Ok(())
    }

    fn span(&self) -> &Span<'_, T> {
        &self.span
    }

    fn estimate(&mut self, errors: &mut [T]) {
        errors.fill(T::from_f64(0.0));
    }

    fn complete(&mut self, _: &mut Evaluator<'_, T>) {}

    fn interpolate(&self, theta: f64, inside: &mut [T]) {
        let theta = T::from_f64(theta);
        let ends = self.span.y.iter().zip(&*self.span.end);
        for (inside, (y, end)) in inside.iter_mut().zip(ends) {
            *inside = theta.mul_add(*end - *y, *y);
        }
    }

    fn end_rate(&self) -> Option<&[T]> {
        None
    }

    fn neighbour(&self, state: &mut [T]) -> Option<&[T]> {
        state.copy_from_slice(self.span.y);
        Some(self.rate)
    }
}
