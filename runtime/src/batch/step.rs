//! A step of an explicit Runge–Kutta method in which every lane has its own time and length:
//! k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),  y⁺ = y + h Σ b_i k_i.
//!
//! Sums are taken in the order of [`Explicit`](crate::integrate::explicit::Explicit): a step is the same to the last bit as that of a
//! single run over the same scalar.

use super::enabled;
use super::settings::Method;
use crate::integrate::combine_into;
use crate::integrate::control::{Tolerances, kind_of};
use crate::integrate::tableau::Tableau;
use crate::integrate::tableau::dormand_prince::Dopri5;
use crate::integrate::tableau::kutta::{Heun, Merson, Rk4};
use crate::real::{Several, Task};
use crate::{Model, Real, Vector};
use core::marker::PhantomData;

/// Stages of the methods that lanes know, those for the inside included, at most.
const STAGES: usize = 7;

/// Where a step begins, how long it is in each lane, and what was found on the way.
pub struct Step<T, S> {
    /// How it is taken.
    method: Method,
    /// Its beginning \[s\].
    pub t: T,
    /// Its length \[s\].
    pub h: T,
    /// No stage is evaluated at a later time \[s\]: beyond a kink of a curve of time the equations are others.
    pub latest: T,
    /// The state at the beginning.
    pub y: S,
    /// The derivatives of the stages, the first that of the beginning; behind those of the step stand those that only its inside needs.
    pub k: [S; STAGES],
    /// Where it leads.
    pub end: S,
    /// Whether the inside can be had.
    complete: bool,
}

/// What is to be done by the tableau of a method, which it knows when it is compiled.
macro_rules! by_tableau {
    ($method:expr, $tableau:ident => $result:expr) => {
        match $method {
            Method::Heun => {
                type $tableau = Heun;
                $result
            }
            Method::Rk4 => {
                type $tableau = Rk4;
                $result
            }
            Method::Merson => {
                type $tableau = Merson;
                $result
            }
            Method::Dopri5 => {
                type $tableau = Dopri5;
                $result
            }
        }
    };
}

impl<T: Several, S: Vector<T>> Step<T, S> {
    /// At a time, a state and its derivative.
    #[inline(always)]
    pub fn new(method: Method, t: T, y: S, rate: S) -> Self {
        Step {
            method,
            t,
            h: T::from_f64(0.0),
            latest: t,
            y,
            k: [rate; STAGES],
            end: y,
            complete: false,
        }
    }

    /// Takes it.
    #[inline(always)]
    pub fn take<M: Model<T, State = S>>(&mut self, model: &M) {
        by_tableau!(self.method, B => T::enable(Take::<T, M, B>::new(self, model)));
    }

    /// Evaluates what [`Step::inside`] needs of all lanes, once a step.
    #[inline(always)]
    pub fn complete<M: Model<T, State = S>>(&mut self, model: &M) {
        if !self.complete {
            by_tableau!(self.method, B => T::enable(Complete::<T, M, B>::new(self, model)));
            self.complete = true;
        }
    }

    /// The state at t + θh, θ in 0..=1, on its manifold: after [`Step::complete`], but where every θ is 1.
    #[inline(always)]
    pub fn inside<M: Model<T, State = S>>(&self, model: &M, theta: T) -> S {
        by_tableau!(self.method, B => T::enable(Inside::<T, M, B> {
            step: self,
            model,
            theta,
            by: PhantomData,
        }))
    }

    /// The same with lanes in another order, which is that of the model and of θ: to look into one lane at several places at once.
    #[inline(always)]
    pub fn inside_in_order<M: Model<T, State = S>>(
        &self,
        model: &M,
        theta: T,
        order: T::Order,
    ) -> S {
        by_tableau!(self.method, B => T::enable(InsideInOrder::<T, M, B> {
            step: self,
            model,
            theta,
            order,
            by: PhantomData,
        }))
    }

    /// The derivative of stage `I`, whose state is left in `end`.
    #[inline(always)]
    fn stage<M: Model<T, State = S>, B: Tableau, const I: usize>(&mut self, model: &M) {
        self.combine(B::A[I]);
        let t = T::from_f64(B::C[I]) * self.h + self.t;
        enabled::rate(model, t.min(self.latest), &self.end, &mut self.k[I]);
    }

    /// y + h Σ w_j k_j, left in `end`; weights of 0 cost nothing, for they are known to the compiler.
    #[inline(always)]
    fn combine(&mut self, weights: &[f64]) {
        combine_into(&self.y, self.h, weights, &self.k, &mut self.end);
    }

    /// The stages from `from` to before `to`; the state of the last is left in `end`.
    #[inline(always)]
    fn stages<M: Model<T, State = S>, B: Tableau>(&mut self, model: &M, from: usize, to: usize) {
        // written out, so that every stage knows its coefficients when it is compiled
        macro_rules! stages {
            ($($i:literal)*) => {
                $(if from <= $i && $i < to { self.stage::<M, B, $i>(model); })*
            };
        }
        stages!(1 2 3 4 5 6);
    }

    /// y(t + θh), not on its manifold; θ in the order given, or that of the lanes. To be called with an order, or without, that is
    /// known when this is compiled.
    #[inline(always)]
    fn interpolated<B: Tableau>(&self, theta: T, order: Option<T::Order>) -> S {
        let h = in_order(self.h, order);
        let mut weights = B::weights(theta);
        for weight in weights.as_mut() {
            *weight = *weight * h;
        }
        let within = theta.lt(T::from_f64(1.0));
        let mut y = self.y;
        for i in 0..S::LEN {
            let mut sum = in_order(self.y[i], order);
            for (j, weight) in weights.as_ref().iter().enumerate() {
                if B::counts(j) {
                    sum = weight.mul_add(in_order(self.k[j][i], order), sum);
                }
            }
            // what only the inside needs is of another step where nobody asked for it
            y[i] = match B::ALL > B::STAGES {
                true => T::select(within, sum, in_order(self.end[i], order)),
                false => sum,
            };
        }
        y
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

struct Take<'a, T, M: Model<T>, B>
where
    T: Real,
{
    step: &'a mut Step<T, M::State>,
    model: &'a M,
    by: PhantomData<B>,
}

impl<'a, T: Several, M: Model<T>, B> Take<'a, T, M, B> {
    #[inline(always)]
    fn new(step: &'a mut Step<T, M::State>, model: &'a M) -> Self {
        let by = PhantomData;
        Take { step, model, by }
    }
}

impl<T: Several, M: Model<T>, B: Tableau> Task for Take<'_, T, M, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Take { step, model, .. } = self;
        step.complete = B::STAGES == B::ALL;
        step.stages::<M, B>(model, 1, B::STAGES);
        if !B::LAST_IS_FIRST {
            step.combine(B::B);
        }
    }
}

struct Complete<'a, T, M: Model<T>, B>
where
    T: Real,
{
    step: &'a mut Step<T, M::State>,
    model: &'a M,
    by: PhantomData<B>,
}

impl<'a, T: Several, M: Model<T>, B> Complete<'a, T, M, B> {
    #[inline(always)]
    fn new(step: &'a mut Step<T, M::State>, model: &'a M) -> Self {
        let by = PhantomData;
        Complete { step, model, by }
    }
}

impl<T: Several, M: Model<T>, B: Tableau> Task for Complete<'_, T, M, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Complete { step, model, .. } = self;
        let end = step.end;
        step.stages::<M, B>(model, B::STAGES, B::ALL);
        step.end = end;
    }
}

struct Inside<'a, T, M: Model<T>, B>
where
    T: Real,
{
    step: &'a Step<T, M::State>,
    model: &'a M,
    theta: T,
    by: PhantomData<B>,
}

impl<T: Several, M: Model<T>, B: Tableau> Task for Inside<'_, T, M, B> {
    type Output = M::State;
    #[inline(always)]
    fn run(self) -> M::State {
        let mut y = self.step.interpolated::<B>(self.theta, None);
        self.model.normalize(&mut y);
        y
    }
}

struct InsideInOrder<'a, T, M: Model<T>, B>
where
    T: Several,
{
    step: &'a Step<T, M::State>,
    model: &'a M,
    theta: T,
    order: T::Order,
    by: PhantomData<B>,
}

impl<T: Several, M: Model<T>, B: Tableau> Task for InsideInOrder<'_, T, M, B> {
    type Output = M::State;
    #[inline(always)]
    fn run(self) -> M::State {
        let mut y = self.step.interpolated::<B>(self.theta, Some(self.order));
        self.model.normalize(&mut y);
        y
    }
}

/// The lanes in an order, if there is one.
#[inline(always)]
fn in_order<T: Several>(value: T, order: Option<T::Order>) -> T {
    match order {
        Some(order) => value.ordered(order),
        None => value,
    }
}
