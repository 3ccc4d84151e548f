//! A step of an explicit Runge–Kutta method in which every lane has its own time and length:
//! k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),  y⁺ = y + h Σ b_i k_i.
//!
//! Sums are taken in the order of [`Explicit`](crate::integrate::explicit::Explicit): a step is the same to the last bit as that of a
//! single run over the same scalar.
//!
//! Stages and sums are functions of their own, each compiled for the coefficients of one method.

use super::copies;
use super::settings::Method;
use super::tolerance::Allowed;
use crate::integrate::acceleration::{EndDifference, kind};
use crate::integrate::tableau::dormand_prince::Dopri5;
use crate::integrate::tableau::kutta::{Heun, Merson, Rk4};
use crate::integrate::tableau::{Tableau, hermite};
use crate::real::{Mask, Several, Task};
use crate::{Dynamics, Info, Real};
use core::marker::PhantomData;

/// Stages of any method here, those for the inside included, at most.
const STAGES: usize = 7;

/// Where a step begins, how long it is in each lane, and what was found on the way. All states have the same length.
pub struct Step<T> {
    /// How it is taken.
    method: Method,
    /// Its beginning \[s\].
    pub t: T,
    /// Its length \[s\].
    pub h: T,
    /// No stage is evaluated at a later time \[s\]: beyond a kink of a curve of time the equations are others.
    pub latest: T,
    /// The state at the beginning.
    pub y: Box<[T]>,
    /// The derivatives of the stages, the first that of the beginning; behind those of the step stand those that only its inside needs.
    pub k: [Box<[T]>; STAGES],
    /// Where it leads.
    pub end: Box<[T]>,
    /// A state that is needed while stages for the inside are evaluated.
    spare: Box<[T]>,
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

impl<T: Several> Step<T> {
    /// At time 0 and a state of zeros with so many entries.
    pub fn new(method: Method, entries: usize) -> Self {
        let nought = T::from_f64(0.0);
        let zeros = || copies(nought, entries);
        Step {
            method,
            t: nought,
            h: nought,
            latest: nought,
            y: zeros(),
            k: core::array::from_fn(|_| zeros()),
            end: zeros(),
            spare: zeros(),
            complete: false,
        }
    }

    /// Takes it.
    #[inline(always)]
    pub fn take(&mut self, model: &dyn Dynamics<T>) {
        by_tableau!(self.method, B => T::dispatch_apart(Take::<T, B>::new(self, model)));
    }

    /// Evaluates what [`Step::inside`] needs of all lanes, once a step.
    #[inline(always)]
    pub fn complete(&mut self, model: &dyn Dynamics<T>) {
        if !self.complete {
            by_tableau!(self.method, B => T::dispatch_apart(Complete::<T, B>::new(self, model)));
            self.complete = true;
        }
    }

    /// Whether the method has another interpolant than the cubic, which a force that a stage meets may spoil.
    #[inline(always)]
    pub fn has_cubic(&self) -> bool {
        by_tableau!(self.method, B => B::ALL + usize::from(B::LAST_IS_FIRST) - B::STAGES > 1)
    }

    /// Writes the state at t + θh on Hermite's cubic through both ends, on its manifold, of a method that [has](Step::has_cubic) one. Call
    /// [`Step::complete`] before. With an order the lanes stand in it, which is that of the model and of θ.
    #[inline(always)]
    pub fn on_cubic(
        &self,
        model: &dyn Dynamics<T>,
        theta: T,
        order: Option<T::Order>,
        to: &mut [T],
    ) {
        by_tableau!(self.method, B => T::dispatch_apart(Cubic::<T, B> {
            step: self,
            theta,
            order,
            to: &mut *to,
            by: PhantomData,
        }));
        model.normalize(to);
    }

    /// Puts a state near the one that the step leads to into `to`, and the derivative there into `rate`: that of the last stage at the time of the
    /// end, as [`Stepper::neighbour`](crate::integrate::Stepper::neighbour) of a single run.
    #[inline(always)]
    pub fn neighbour(&self, to: &mut [T], rate: &mut [T]) {
        by_tableau!(self.method, B => T::dispatch_apart(Neighbour::<T, B> {
            step: self,
            to: &mut *to,
            rate: &mut *rate,
            by: PhantomData,
        }));
    }

    /// Writes the state at t + θh, θ in 0..=1, on its manifold. Call [`Step::complete`] before, unless every θ is 1.
    #[inline(always)]
    pub fn inside(&self, model: &dyn Dynamics<T>, theta: T, to: &mut [T]) {
        by_tableau!(self.method, B => T::dispatch_apart(Inside::<T, B> {
            step: self,
            theta,
            to: &mut *to,
            by: PhantomData,
        }));
        model.normalize(to);
    }

    /// The same with lanes in another order, which is that of the model and of θ: to look into one lane at several places at once.
    #[inline(always)]
    pub fn inside_in_order(
        &self,
        model: &dyn Dynamics<T>,
        theta: T,
        order: T::Order,
        to: &mut [T],
    ) {
        by_tableau!(self.method, B => T::dispatch_apart(InsideInOrder::<T, B> {
            step: self,
            theta,
            order,
            to: &mut *to,
            by: PhantomData,
        }));
        model.normalize(to);
    }

    /// The derivative of stage `I`, whose state is left in `end`.
    #[inline(always)]
    fn stage<B: Tableau, const I: usize>(&mut self, model: &dyn Dynamics<T>) {
        self.combine(B::A[I]);
        let t = T::from_f64(B::C[I]) * self.h + self.t;
        model.derivative(t.min(self.latest), &self.end, &mut self.k[I]);
    }

    /// y + h Σ w_j k_j, left in `end`; weights of 0 cost nothing, for they are known to the compiler.
    #[inline(always)]
    fn combine(&mut self, weights: &[f64]) {
        let mut lengths = [T::from_f64(0.0); STAGES];
        for (length, weight) in lengths.iter_mut().zip(weights) {
            *length = T::from_f64(*weight) * self.h;
        }
        let end = &mut *self.end;
        let y = &self.y[..end.len()];
        let k = stages(&self.k, end.len());
        for i in 0..end.len() {
            let mut sum = y[i];
            for (j, weight) in weights.iter().enumerate() {
                if *weight != 0.0 {
                    sum = lengths[j].mul_add(k[j][i], sum);
                }
            }
            end[i] = sum;
        }
    }

    /// The stages from `from` to before `to`; the state of the last is left in `end`.
    #[inline(always)]
    fn stages<B: Tableau>(&mut self, model: &dyn Dynamics<T>, from: usize, to: usize) {
        // written out, so that every stage knows its coefficients when it is compiled; those that the method lacks are not
        macro_rules! stages {
            ($($i:literal)*) => {
                $(if const { $i < B::ALL } && from <= $i && $i < to { self.stage::<B, $i>(model); })*
            };
        }
        stages!(1 2 3 4 5 6);
    }

    /// y(t + θh), not on its manifold; θ in the order given, or that of the lanes. To be called with an order, or without, that is
    /// known when this is compiled.
    #[inline(always)]
    fn interpolate<B: Tableau>(&self, theta: T, order: Option<T::Order>, to: &mut [T]) {
        // what only the inside needs is of another step where nobody asked for it
        let known = B::ALL == B::STAGES;
        let within = theta.lt(T::from_f64(1.0));
        if !known && !within.any() {
            for (to, end) in to.iter_mut().zip(&self.end) {
                *to = in_order(*end, order);
            }
            return;
        }
        let h = in_order(self.h, order);
        let mut weights = B::weights(theta);
        for weight in weights.as_mut() {
            *weight = *weight * h;
        }
        let (y, end) = (&self.y[..to.len()], &self.end[..to.len()]);
        let k = stages(&self.k, to.len());
        for i in 0..to.len() {
            let mut sum = in_order(y[i], order);
            for (j, weight) in weights.as_ref().iter().enumerate() {
                if B::counts(j) {
                    sum = weight.mul_add(in_order(k[j][i], order), sum);
                }
            }
            to[i] = match known {
                true => sum,
                false => T::select(within, sum, in_order(end[i], order)),
            };
        }
    }

    /// The largest ratio of estimated error to tolerance over all entries, of values and derivatives alike; NaN where anything is not finite.
    #[inline(always)]
    pub fn error(&self, allowed: &[Allowed<T::Part>]) -> T::Part {
        let (mut worst, mut sum) = (T::Part::from_f64(0.0), T::Part::from_f64(0.0));
        let mut of_stage = [T::from_f64(0.0); STAGES];
        for (place, e) in of_stage.iter_mut().zip(Dopri5::E[0]) {
            *place = T::from_f64(*e) * self.h;
        }
        let entries = allowed.len();
        let (y, end) = (&self.y[..entries], &self.end[..entries]);
        let k = stages(&self.k, entries);
        for i in 0..entries {
            let mut estimate = T::from_f64(0.0);
            for j in 0..STAGES {
                estimate = of_stage[j].mul_add(k[j][i], estimate);
            }
            for part in 0..T::PARTS {
                let (y, end) = (y[i].part(part), end[i].part(part));
                let scale = allowed[i].scale(y.abs().max(end.abs()));
                let ratio = estimate.part(part).abs() / scale + end.taint();
                worst = worst.max(ratio);
                // what is no number gets lost in the maximum, not in the sum
                sum += ratio;
            }
        }
        worst + sum.taint()
    }

    /// How the results of its last two stages differ, both for the time of its end.
    #[inline(always)]
    pub fn end_difference(&self, info: &Info) -> EndDifference<T::Part> {
        let coordinates = info.coordinates.len();
        let entries = coordinates + info.velocities.len();
        let (y, end) = (&self.y[..entries], &self.end[..entries]);
        let k = stages(&self.k, entries);
        let [first, .., near, last] = k;
        let mut lengths = [T::from_f64(0.0); STAGES];
        for (length, weight) in lengths.iter_mut().zip(Dopri5::A[STAGES - 2]) {
            *length = T::from_f64(*weight) * self.h;
        }
        let mut difference = EndDifference::new();
        for i in 0..entries {
            let mut state = y[i];
            for j in 0..STAGES - 2 {
                state = lengths[j].mul_add(k[j][i], state);
            }
            let between = [end[i] - state, last[i] - near[i]].map(|value| value.part(0));
            let y = end[i].part(0);
            if i < coordinates {
                difference.coordinate(y, between);
            } else {
                let ends = [first[i], last[i]].map(|value| value.part(0));
                difference.velocity(kind(info, i), y, between, ends);
            }
        }
        difference
    }
}

/// The derivatives of all stages, each with so many entries.
#[inline(always)]
fn stages<T>(k: &[Box<[T]>; STAGES], entries: usize) -> [&[T]; STAGES] {
    let [a, b, c, d, e, f, g] = k;
    [
        &a[..entries],
        &b[..entries],
        &c[..entries],
        &d[..entries],
        &e[..entries],
        &f[..entries],
        &g[..entries],
    ]
}

struct Take<'a, T, B> {
    step: &'a mut Step<T>,
    model: &'a dyn Dynamics<T>,
    by: PhantomData<B>,
}

impl<'a, T: Several, B> Take<'a, T, B> {
    #[inline(always)]
    fn new(step: &'a mut Step<T>, model: &'a dyn Dynamics<T>) -> Self {
        let by = PhantomData;
        Take { step, model, by }
    }
}

impl<T: Several, B: Tableau> Task for Take<'_, T, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Take { step, model, .. } = self;
        step.complete = B::STAGES == B::ALL;
        step.stages::<B>(model, 1, B::STAGES);
        if !B::LAST_IS_FIRST {
            step.combine(B::B);
        }
    }
}

struct Complete<'a, T, B> {
    step: &'a mut Step<T>,
    model: &'a dyn Dynamics<T>,
    by: PhantomData<B>,
}

impl<'a, T: Several, B> Complete<'a, T, B> {
    #[inline(always)]
    fn new(step: &'a mut Step<T>, model: &'a dyn Dynamics<T>) -> Self {
        let by = PhantomData;
        Complete { step, model, by }
    }
}

impl<T: Several, B: Tableau> Task for Complete<'_, T, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Complete { step, model, .. } = self;
        // stages are evaluated in `end`, which must stay as it is
        core::mem::swap(&mut step.end, &mut step.spare);
        step.stages::<B>(model, B::STAGES, B::ALL);
        core::mem::swap(&mut step.end, &mut step.spare);
    }
}

struct Neighbour<'a, T, B> {
    step: &'a Step<T>,
    to: &'a mut [T],
    rate: &'a mut [T],
    by: PhantomData<B>,
}

impl<T: Several, B: Tableau> Task for Neighbour<'_, T, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Neighbour { step, to, rate, .. } = self;
        // the state of a last stage that is the first of the next step is the end itself; the beginning is a neighbour where there is no other
        let before = B::STAGES - usize::from(B::LAST_IS_FIRST);
        let index = (1..before).rev().find(|i| B::C[*i] == 1.0).unwrap_or(0);
        let weights = B::A[index];
        let k = stages(&step.k, to.len());
        let y = &step.y[..to.len()];
        for i in 0..to.len() {
            let mut sum = y[i];
            for (j, weight) in weights.iter().enumerate() {
                sum = (T::from_f64(*weight) * step.h).mul_add(k[j][i], sum);
            }
            to[i] = sum;
        }
        rate.copy_from_slice(k[index]);
    }
}

struct Inside<'a, T, B> {
    step: &'a Step<T>,
    theta: T,
    to: &'a mut [T],
    by: PhantomData<B>,
}

impl<T: Several, B: Tableau> Task for Inside<'_, T, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.step.interpolate::<B>(self.theta, None, self.to);
    }
}

struct Cubic<'a, T: Several, B> {
    step: &'a Step<T>,
    theta: T,
    order: Option<T::Order>,
    to: &'a mut [T],
    by: PhantomData<B>,
}

impl<T: Several, B: Tableau> Task for Cubic<'_, T, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Cubic {
            step,
            theta,
            order,
            to,
            ..
        } = self;
        let [whole, at_first, at_last] = hermite(theta);
        let h = in_order(step.h, order);
        let [at_first, at_last] = [at_first * h, at_last * h];
        let last = B::STAGES - usize::from(B::LAST_IS_FIRST);
        let k = stages(&step.k, to.len());
        let (y, end) = (&step.y[..to.len()], &step.end[..to.len()]);
        for i in 0..to.len() {
            let [y, end] = [y[i], end[i]].map(|value| in_order(value, order));
            let [first, last] = [k[0][i], k[last][i]].map(|value| in_order(value, order));
            let moved = whole.mul_add(end - y, y);
            to[i] = at_last.mul_add(last, at_first.mul_add(first, moved));
        }
    }
}

struct InsideInOrder<'a, T: Several, B> {
    step: &'a Step<T>,
    theta: T,
    order: T::Order,
    to: &'a mut [T],
    by: PhantomData<B>,
}

impl<T: Several, B: Tableau> Task for InsideInOrder<'_, T, B> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        self.step
            .interpolate::<B>(self.theta, Some(self.order), self.to);
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
