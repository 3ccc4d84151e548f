//! A step of an explicit Runge–Kutta method in which every lane has its own time and length:
//! k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),  y⁺ = y + h Σ b_i k_i.
//!
//! Sums are computed in the order of [`Explicit`](crate::integrate::explicit::Explicit), so a step equals that of a
//! single run over the same scalar to the last bit.
//!
//! Stages and sums are separate functions, each compiled for the coefficients of one method.

use super::settings::LaneFormula;
use super::tolerance::Allowed;
use super::{arrays, copies};
use crate::integrate::acceleration::{EndDifference, kind};
use crate::integrate::tableau::dormand_prince::Dopri5;
use crate::integrate::tableau::kutta::{Heun, Merson, Rk4};
use crate::integrate::tableau::{Tableau, hermite};
use crate::real::{Mask, Several, Task};
use crate::{Dynamics, Info, Real};
use core::marker::PhantomData;

/// Largest number of stages of a method, with those for the interpolant.
const STAGES: usize = 7;

/// A step in every lane: its start, its length and its stages. All states have the same length.
pub struct Step<T> {
    /// The method.
    method: LaneFormula,
    /// Start of the step \[s\].
    pub t: T,
    /// Length of the step \[s\].
    pub h: T,
    /// The latest time at which a stage is evaluated \[s\]: the equations change beyond a kink of a curve of time.
    pub latest: T,
    /// The state at the start of the step.
    pub y: Box<[T]>,
    /// The derivatives of the stages, the first at the start of the step; behind those of the step are the stages that
    /// only its interpolant needs.
    pub k: [Box<[T]>; STAGES],
    /// The state at the end of the step.
    pub end: Box<[T]>,
    /// A spare state for evaluating the stages of the interpolant.
    spare: Box<[T]>,
    /// True if the interpolant is available.
    complete: bool,
}

/// Evaluates an expression with the tableau of a method as a type known at compile time.
macro_rules! by_tableau {
    ($method:expr, $tableau:ident => $result:expr) => {
        match $method {
            LaneFormula::Heun => {
                type $tableau = Heun;
                $result
            }
            LaneFormula::Rk4 => {
                type $tableau = Rk4;
                $result
            }
            LaneFormula::Merson => {
                type $tableau = Merson;
                $result
            }
            LaneFormula::Dopri5 => {
                type $tableau = Dopri5;
                $result
            }
        }
    };
}

impl<T: Several> Step<T> {
    /// A step at time 0 from a state of zeros with this number of entries.
    pub fn new(method: LaneFormula, entries: usize) -> Self {
        let nought = T::from_f64(0.0);
        let zeros = || copies(nought, entries);
        Step {
            method,
            t: nought,
            h: nought,
            latest: nought,
            y: zeros(),
            k: arrays(nought, entries),
            end: zeros(),
            spare: zeros(),
            complete: false,
        }
    }

    /// Takes the step in all lanes.
    #[inline(always)]
    pub fn take(&mut self, model: &dyn Dynamics<T>) {
        by_tableau!(self.method, B => T::dispatch_apart(Take::<T, B>::new(self, model)));
    }

    /// Evaluates the stages that [`Step::inside`] needs, in all lanes, once per step.
    #[inline(always)]
    pub fn complete(&mut self, model: &dyn Dynamics<T>) {
        if !self.complete {
            by_tableau!(self.method, B => T::dispatch_apart(Complete::<T, B>::new(self, model)));
            self.complete = true;
        }
    }

    /// True if the method has an interpolant other than the cubic. Such an interpolant may be spoiled by a force that
    /// an inner stage meets.
    #[inline(always)]
    pub fn has_cubic(&self) -> bool {
        by_tableau!(self.method, B => B::ALL + usize::from(B::LAST_IS_FIRST) - B::STAGES > 1)
    }

    /// Writes the state at t + θh on Hermite's cubic through both ends, on its manifold, for a method that
    /// [has](Step::has_cubic) one. Call [`Step::complete`] before. With an `order`, the lanes of the model and of θ are
    /// in that order.
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

    /// Writes a state near the end of the step into `to`, and the derivative there into `rate`: those of the last stage
    /// at the end time, as [`Stepper::neighbour`](crate::integrate::Stepper::neighbour) does in a single run.
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

    /// [`Step::inside`] with the lanes of the model and of θ in another order: to evaluate one lane at several places
    /// at once.
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

    /// Evaluates the derivative of stage `I`, whose state is left in `end`.
    #[inline(always)]
    fn stage<B: Tableau, const I: usize>(&mut self, model: &dyn Dynamics<T>) {
        self.combine(B::A[I]);
        let t = T::from_f64(B::C[I]) * self.h + self.t;
        model.derivative(t.min(self.latest), &self.end, &mut self.k[I]);
    }

    /// Computes y + h Σ w_j k_j into `end`; weights of 0 cost nothing, since the compiler knows them.
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

    /// Evaluates the stages from `from` to before `to`; the state of the last is left in `end`.
    #[inline(always)]
    fn stages<B: Tableau>(&mut self, model: &dyn Dynamics<T>, from: usize, to: usize) {
        // written out, so that every stage knows its coefficients at compile time; stages that a method lacks are not
        // compiled
        macro_rules! stages {
            ($($i:literal)*) => {
                $(if const { $i < B::ALL } && from <= $i && $i < to { self.stage::<B, $i>(model); })*
            };
        }
        stages!(1 2 3 4 5 6);
    }

    /// Computes y(t + θh), not normalized to its manifold; the lanes of θ are in `order`, if there is one. Whether
    /// there is an order should be known at compile time.
    #[inline(always)]
    fn interpolate<B: Tableau>(&self, theta: T, order: Option<T::Order>, to: &mut [T]) {
        // if nobody asked for the interpolant, its additional stages are those of another step
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

    /// The largest ratio of estimated error to tolerance over all entries, for values and derivatives alike; NaN if any
    /// is not finite.
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
                // a maximum loses a NaN, a sum does not
                sum += ratio;
            }
        }
        worst + sum.taint()
    }

    /// The difference between the last two stages of a step, both at its end time.
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
            let between = [(end[i] - state).part(0), (last[i] - near[i]).part(0)];
            let y = end[i].part(0);
            if i < coordinates {
                difference.coordinate(y, between);
            } else {
                let ends = [first[i].part(0), last[i].part(0)];
                difference.velocity(kind(info, i), y, between, ends);
            }
        }
        difference
    }
}

/// The derivatives of all stages, each cut to this number of entries.
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
        // stages are evaluated in `end`, so the end of the step is kept in `spare` meanwhile
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
        // if the last stage is the first of the next step, its state is the end itself; if no other stage is at the end
        // time, the start of the step is the neighbour
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
            let [y, end] = [in_order(y[i], order), in_order(end[i], order)];
            let [first, last] = [in_order(k[0][i], order), in_order(k[last][i], order)];
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

/// A value with its lanes in `order`, if there is one.
#[inline(always)]
fn in_order<T: Several>(value: T, order: Option<T::Order>) -> T {
    match order {
        Some(order) => value.ordered(order),
        None => value,
    }
}
