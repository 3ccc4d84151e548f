//! Steps of equal length for loops of your own: no samples, no events, no error estimates, and hardly more cost than
//! the evaluations. [`march()`] is the classical Runge–Kutta method, for short steps. [`march_dop853`] is Dormand &
//! Prince's method of order 8, for long steps. [`march_adams`](super::march_adams) takes one evaluation a step, for
//! many short steps of a smooth motion.
//!
//! **Runge and Kutta.** With the states of the stages Y₁ = y, Y₂ = y + h/2 k₁, Y₃ = y + h/2 k₂, Y₄ = y + h k₃ and kᵢ =
//! f(Yᵢ),
//!
//! y⁺ = y + h/6 (k₁ + 2 k₂ + 2 k₃ + k₄) = Y₃ + ((Z₂ − y) + (Y₄ − Y₃)) / 3,  Z₂ = Y₂ + h/2 k₄
//!
//! Derivatives are not stored. Each entry becomes an entry of the next stage's state as soon as it is computed
//! ([`OutputWriter`]), and a step stores four states, with Z₂ in the place of Y₂. With wide registers, the derivatives
//! of a larger model would not fit into the first cache. When k₄ is known, the rest is done entry by entry, in one pass
//! with [`Model::normalize`], which divides while states are fetched. Rounding: to first order in h a step rounds an
//! entry by at most 4/3 ε|y|, where ε is the distance from 1 to the next number: 5/6 because Y₂, Y₃, Y₄ and Z₂ are
//! rounded, and 1/2 for the sum. [`Formula::Rk4`](super::Formula::Rk4) adds four terms one after the other and rounds
//! an entry by at most 2 ε|y|.
//!
//! **Order 8.** The step stores twelve derivatives and combines them as the tableau says
//! ([`Formula::Dop853`](super::Formula::Dop853)).

use super::tableau::Tableau;
use super::tableau::dormand_prince::Dop853;
use super::{Rate, combine_into};
use crate::{Change, Model, OutputWriter, Real, Task, Vector};

/// Takes `steps` steps of length `h` \[s\] from time `t` \[s\] and state `y`. It leaves the last state in `y` and
/// returns its time \[s\].
///
/// As in [`simulate`](crate::simulate()), every step ends on the manifold ([`Model::normalize`]) and begins with
/// discrete updates, repeated until nothing changes ([`Model::renew`]). Steps pass over kinks and events. No check
/// finds a state that is no longer finite, so look at the state. All lanes have the same time and step.
///
/// ```
/// # use bryant_runtime::{Real, Model, integrate::march};
/// fn a_millisecond<M: Model<f64>>(model: &M) -> M::State {
///     let mut y = model.initial_state();
///     march(model, 0.0, 1e-4, 10, &mut y);
///     y
/// }
/// ```
#[inline(always)]
pub fn march<T: Real, M: Model<T>>(model: &M, t: T, h: T, steps: u32, y: &mut M::State) -> T {
    T::dispatch(March {
        model,
        t,
        h,
        steps,
        y,
    })
}

struct March<'a, T, M, S> {
    model: &'a M,
    t: T,
    h: T,
    steps: u32,
    y: &'a mut S,
}

impl<T: Real, M: Model<T>> Task for March<'_, T, M, M::State> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        let March {
            model,
            t: start,
            h,
            steps,
            y,
        } = self;
        let number = T::from_f64;
        // divided here, to the precision of any scalar
        let (half, third) = (number(0.5) * h, number(1.0) / number(3.0));
        let mut t = start;
        if steps > 0 {
            renew(model, start, y);
        }
        let (mut second, mut third_stage, mut fourth) = (*y, *y, *y);
        for step in 0..steps {
            let middle = number(f64::from(step) + 0.5) * h + start;
            let end = number(f64::from(step) + 1.0) * h + start;
            let stage = |t, at: &M::State, from: *const M::State, length, to: *mut M::State| {
                T::dispatch(Stage {
                    model,
                    t,
                    at,
                    from,
                    length,
                    to,
                });
            };
            stage(t, y, &raw const *y, half, &raw mut second);
            stage(middle, &second, &raw const *y, half, &raw mut third_stage);
            stage(middle, &third_stage, &raw const *y, h, &raw mut fourth);
            let second_itself = &raw mut second;
            stage(end, &fourth, second_itself, half, second_itself);
            let sum = Sum {
                third,
                second: &second,
                third_stage: &third_stage,
                fourth: &fourth,
            };
            model.normalize_changed(y, &sum);
            renew(model, end, y);
            t = end;
        }
        t
    }
}

/// Takes steps as [`march()`] does, by Dormand & Prince's method of order 8, twelve evaluations each.
///
/// Where a motion is smooth, its steps may be many times as long as those of [`march()`] for the same error. Across a
/// kink nothing is gained. The method keeps thirteen states on the stack: half a megabyte for a large model in wide
/// registers. Coefficients: [`Formula::Dop853`](super::Formula::Dop853).
///
/// ```
/// # use bryant_runtime::{Real, Model, integrate::march_dop853};
/// fn a_tenth_of_a_second<M: Model<f64>>(model: &M) -> M::State {
///     let mut y = model.initial_state();
///     march_dop853(model, 0.0, 0.01, 10, &mut y);
///     y
/// }
/// ```
#[inline(always)]
pub fn march_dop853<T: Real, M: Model<T>>(
    model: &M,
    t: T,
    h: T,
    steps: u32,
    y: &mut M::State,
) -> T {
    T::dispatch(MarchDop853 {
        model,
        t,
        h,
        steps,
        y,
    })
}

struct MarchDop853<'a, T, M, S> {
    model: &'a M,
    t: T,
    h: T,
    steps: u32,
    y: &'a mut S,
}

impl<T: Real, M: Model<T>> Task for MarchDop853<'_, T, M, M::State> {
    type Output = T;
    #[inline(always)]
    fn run(self) -> T {
        let MarchDop853 {
            model,
            t: start,
            h,
            steps,
            y,
        } = self;
        let number = T::from_f64;
        let mut t = start;
        if steps > 0 {
            renew(model, start, y);
        }
        let mut k = [*y; Dop853::STAGES];
        let mut at = *y;
        for step in 0..steps {
            // written out, so that the compiler knows the coefficients of every stage; the equations are compiled once
            macro_rules! stages {
                ($($i:literal)*) => {$({
                    combine_into(y, h, Dop853::A[$i], &k, &mut at);
                    let (t, y, rate) = (number(Dop853::C[$i]).mul_add(h, t), &at, &mut k[$i]);
                    T::dispatch_apart(Rate { model, t, y, rate });
                })*};
            }
            stages!(0 1 2 3 4 5 6 7 8 9 10 11);
            combine_into(y, h, Dop853::B, &k, &mut at);
            *y = at;
            model.normalize(y);
            t = number(f64::from(step) + 1.0) * h + start;
            renew(model, t, y);
        }
        t
    }
}

/// Coefficients of an explicit method, for tests.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct Coefficients {
    /// Nodes of the stages.
    pub c: &'static [f64],
    /// Row i: a_ij for j < i.
    pub a: &'static [&'static [f64]],
    /// Weights of the result.
    pub b: &'static [f64],
}

/// The coefficients of the stages of [`march_dop853`].
#[doc(hidden)]
pub const DOP853: Coefficients = Coefficients {
    c: Dop853::C.split_at(Dop853::STAGES).0,
    a: Dop853::A.split_at(Dop853::STAGES).0,
    b: Dop853::B,
};

/// Repeats the discrete update until nothing changes, because one switch may wait for another. A chain of such switches
/// has at most one link for each event function.
#[inline(always)]
fn renew<T: Real, M: Model<T>>(model: &M, t: T, y: &mut M::State) {
    if M::INFO.memory.is_empty() {
        return;
    }
    for _ in 0..=M::INFO.event_functions.len() {
        let before = *y;
        model.renew(t, y);
        if y.as_ref() == before.as_ref() {
            break;
        }
    }
}

/// Computes to = from + length · f(t, at). `from` and `to` may be the same state, which is then updated in place. A
/// type parameter for this case would compile the equations twice, and they are larger than the first instruction
/// cache.
struct Stage<'a, T, M, S> {
    model: &'a M,
    t: T,
    at: &'a S,
    from: *const S,
    length: T,
    to: *mut S,
}

impl<T: Real, M: Model<T>> Task for Stage<'_, T, M, M::State> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let Stage {
            model,
            t,
            at,
            from,
            length,
            to,
        } = self;
        model.each_rate(t, at, &mut Ahead { from, length, to });
    }
}

/// Turns each rate into the entry of the next state.
struct Ahead<T, S> {
    from: *const S,
    length: T,
    to: *mut S,
}

impl<T: Real, S: Vector<T>> OutputWriter<T> for Ahead<T, S> {
    #[inline(always)]
    #[expect(unsafe_code, reason = "both may be one state")]
    fn put(&mut self, index: usize, rate: T) {
        // SAFETY: both are states of the step that made this. No reference to the state that is written is kept while a
        // stage runs.
        unsafe {
            let from = (&*self.from)[index];
            (&mut *self.to)[index] = self.length.mul_add(rate, from);
        }
    }
}

/// y⁺ from y and the states of the stages, with Z₂ in the place of Y₂.
struct Sum<'a, T, S> {
    third: T,
    second: &'a S,
    third_stage: &'a S,
    fourth: &'a S,
}

impl<T: Real, S: Vector<T>> Change<T> for Sum<'_, T, S> {
    #[inline(always)]
    fn of(&self, i: usize, y: T) -> T {
        let sum = (self.second[i] - y) + (self.fourth[i] - self.third_stage[i]);
        self.third.mul_add(sum, self.third_stage[i])
    }
}
