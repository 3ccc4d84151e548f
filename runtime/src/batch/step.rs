//! A step of Dormand & Prince's pair 5(4) in which every lane has its own time and length.

use super::enabled;
use crate::integrate::control::{Tolerances, kind_of};
use crate::integrate::tableau::Tableau;
use crate::integrate::tableau::dormand_prince::{D5, Dopri5};
use crate::real::{Several, Task};
use crate::{Model, Real, Vector};

/// Where a step begins, how long it is in each lane, and what was found on the way.
pub struct Step<T, S> {
    /// Its beginning \[s\].
    pub t: T,
    /// Its length \[s\].
    pub h: T,
    /// No stage is evaluated at a later time \[s\]: beyond a kink of a curve of time the equations are others.
    pub latest: T,
    /// The state at the beginning.
    pub y: S,
    /// The derivatives of the stages; the first is that of the beginning, the last that of the end.
    pub k: [S; 7],
    /// Where it leads.
    pub end: S,
}

impl<T: Several, S: Vector<T>> Step<T, S> {
    /// At a time, a state and its derivative.
    #[inline(always)]
    pub fn new(t: T, y: S, rate: S) -> Self {
        Step {
            t,
            h: T::from_f64(0.0),
            latest: t,
            y,
            k: [rate; 7],
            end: y,
        }
    }

    /// Takes it.
    #[inline(always)]
    pub fn take<M: Model<T, State = S>>(&mut self, model: &M) {
        T::enable(Take { step: self, model });
    }

    /// y(t + θh), not on its manifold.
    #[inline(always)]
    fn interpolated(&self, theta: T) -> S {
        let c = T::from_f64;
        let rest = c(1.0) - theta;
        let mut y = self.y;
        // as `Dopri5::weights`, with a θ for each lane
        let mut weights = [c(0.0); 7];
        for i in 0..7 {
            let b = Dopri5::B.get(i).copied().unwrap_or(0.0);
            let first = if i == 0 { 1.0 } else { 0.0 };
            let last = if i == 6 { 1.0 } else { 0.0 };
            let quartic = rest.mul_add(c(D5[i]), c(2.0 * b - first - last));
            let cubic = theta.mul_add(quartic, c(first - b));
            weights[i] = self.h * theta * rest.mul_add(cubic, c(b));
        }
        for i in 0..S::LEN {
            let mut sum = self.y[i];
            for (weight, k) in weights.iter().zip(&self.k) {
                sum = weight.mul_add(k[i], sum);
            }
            y[i] = sum;
        }
        y
    }

    /// Becomes another step with its lanes in another order, as far as its inside goes: to look into one lane at several places at once.
    #[inline(always)]
    pub fn order(&mut self, of: &Self, order: T::Order) {
        self.t = of.t.ordered(order);
        self.h = of.h.ordered(order);
        for i in 0..S::LEN {
            self.y[i] = of.y[i].ordered(order);
        }
        for (stage, of) in self.k.iter_mut().zip(&of.k) {
            for i in 0..S::LEN {
                stage[i] = of[i].ordered(order);
            }
        }
    }

    /// The state at t + θh, θ in 0..=1, on its manifold.
    #[inline(always)]
    pub fn inside<M: Model<T, State = S>>(&self, model: &M, theta: T) -> S {
        T::enable(Inside {
            step: self,
            model,
            theta,
        })
    }

    /// The largest ratio of estimated error to tolerance over all entries, of values and derivatives alike; NaN where anything is not finite.
    #[inline(always)]
    pub fn error<M: Model<T, State = S>>(&self, tolerances: &Tolerances) -> T::Part {
        let (mut worst, mut sum) = (T::Part::from_f64(0.0), T::Part::from_f64(0.0));
        let mut of_stage = [T::from_f64(0.0); 7];
        for (place, e) in of_stage.iter_mut().zip(Dopri5::E[0]) {
            *place = T::from_f64(*e) * self.h;
        }
        for i in 0..S::LEN {
            let mut estimate = T::from_f64(0.0);
            for (weight, k) in of_stage.iter().zip(&self.k) {
                estimate = weight.mul_add(k[i], estimate);
            }
            for part in 0..T::PARTS {
                let (y, end) = (self.y[i].part(part), self.end[i].part(part));
                let scale = tolerances.scale(kind_of::<T, M>(i), y.abs().max(end.abs()));
                let ratio = estimate.part(part).abs() / scale + end.taint();
                worst = worst.max(ratio);
                // what is no number gets lost in the maximum, not in the sum
                sum += ratio;
            }
        }
        worst + sum.taint()
    }
}

struct Take<'a, T, S, M> {
    step: &'a mut Step<T, S>,
    model: &'a M,
}

impl<T: Several, M: Model<T>> Task for Take<'_, T, M::State, M> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Take { step, model } = self;
        let h = step.h;
        for stage in 1..7 {
            let mut weights = [T::from_f64(0.0); 7];
            for (place, a) in weights.iter_mut().zip(Dopri5::A[stage]) {
                *place = T::from_f64(*a) * h;
            }
            for i in 0..M::State::LEN {
                let mut sum = step.y[i];
                for (weight, k) in weights.iter().zip(&step.k).take(stage) {
                    sum = weight.mul_add(k[i], sum);
                }
                step.end[i] = sum;
            }
            let t = T::from_f64(Dopri5::C[stage]).mul_add(h, step.t);
            enabled::rate(model, t.min(step.latest), &step.end, &mut step.k[stage]);
        }
    }
}

struct Inside<'a, T, S, M> {
    step: &'a Step<T, S>,
    model: &'a M,
    theta: T,
}

impl<T: Several, M: Model<T>> Task for Inside<'_, T, M::State, M> {
    type Output = M::State;
    #[inline(always)]
    fn run(self) -> M::State {
        let mut y = self.step.interpolated(self.theta);
        self.model.normalize(&mut y);
        y
    }
}
