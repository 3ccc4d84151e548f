//! Several states at once, one in each lane of a register.

use crate::fall::StepFormula;
use crate::time;
use bryant_runtime::real::lanes::{MOST_LANES, OfAnyWidth};
use bryant_runtime::{Model, ParameterSet, Real, Several, Task, Vector};
use std::marker::PhantomData;

/// Gives the times of batches \[ns per state\] and the derivatives of the velocities at states.
pub struct Accelerations<'a, M> {
    pub states: &'a [Vec<f64>],
    pub of: PhantomData<M>,
}

/// Gives the times of runs \[ns per run\] and the end of the first one. The lanes have slightly different starts.
pub struct Fall<'a, M> {
    pub start: &'a [f64],
    pub rule: StepFormula,
    pub steps: u32,
    pub step: f64,
    pub of: PhantomData<M>,
}

/// Computes ẏ in place.
struct Rate<'a, M, S> {
    model: &'a M,
    y: &'a S,
    rate: &'a mut S,
}

impl<T: Real, M: Model<T>> Task for Rate<'_, (M, PhantomData<T>), M::State> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let t = T::from_f64(0.0);
        self.model.0.each_rate(t, self.y, self.rate);
    }
}

/// The model over a scalar, with that scalar.
type Over<T, M> = (<M as Model<f64>>::With<T>, PhantomData<T>);

fn over<T: Real, M: Model<f64>>() -> Over<T, M> {
    let parameters = <M::With<T> as Model<T>>::Parameters::defaults();
    (M::With::<T>::new(parameters), PhantomData)
}

/// States in lanes; the last register is filled with copies of the first state.
pub fn registers<T: Several<One = f64>>(states: &[Vec<f64>], length: usize) -> Vec<Vec<T>> {
    let register = |states: &[Vec<f64>]| {
        let entry = |i: usize| {
            let mut lanes = [states[0][i]; MOST_LANES];
            for (lane, state) in lanes.iter_mut().zip(states) {
                *lane = state[i];
            }
            T::of_lanes(&lanes)
        };
        (0..length).map(entry).collect()
    };
    states.chunks(T::LANES).map(register).collect()
}

/// The same as states of a model.
fn of_model<T: Several<One = f64>, S: Vector<T>>(states: &[Vec<f64>]) -> Vec<S> {
    let rows = registers::<T>(states, S::LEN).into_iter();
    let state = |row: Vec<T>| {
        let mut y = S::splat(T::from_f64(0.0));
        (0..S::LEN).for_each(|i| y[i] = row[i]);
        y
    };
    rows.map(state).collect()
}

impl<M: Model<f64>> OfAnyWidth for Accelerations<'_, M> {
    type Output = (Vec<f64>, Vec<Vec<f64>>);
    fn run<T: Several<One = f64>>(self) -> Self::Output {
        let model = over::<T, M>();
        let y: Vec<<M::With<T> as Model<T>>::State> = of_model(self.states);
        let mut rates = y.clone();
        // the number of states in a batch includes the copies that fill the last register
        let times = time::batches(y.len() * T::LANES, || {
            for (y, rate) in y.iter().zip(&mut rates) {
                let model = &model;
                T::dispatch(Rate { model, y, rate });
            }
            std::hint::black_box(&mut rates);
        });
        let (first, count) = (M::INFO.coordinates.len(), M::INFO.velocities.len());
        let row = |k: usize| {
            let rate = &rates[k / T::LANES];
            let entries = first..first + count;
            entries.map(|i| rate[i].lane(k % T::LANES)).collect()
        };
        (times, (0..self.states.len()).map(row).collect())
    }
}

impl<M: Model<f64>> OfAnyWidth for Fall<'_, M> {
    type Output = (Vec<f64>, Vec<f64>);
    fn run<T: Several<One = f64>>(self) -> Self::Output {
        let model = over::<T, M>();
        let starts: Vec<Vec<f64>> = (0..T::LANES)
            .map(|lane| {
                let off = 1.0 + 1e-3 * lane as f64;
                self.start.iter().map(|x| x * off).collect()
            })
            .collect();
        let mut y: Vec<<M::With<T> as Model<T>>::State> = of_model(&starts);
        let mut start = y.remove(0);
        model.0.normalize(&mut start);
        let mut end = start;
        let times = time::runs(|| {
            end = start;
            self.rule
                .march(&model.0, T::from_f64(self.step), self.steps, &mut end);
        });
        let times = times.into_iter().map(|ns| ns / T::LANES as f64);
        let end = (0..<M::With<T> as Model<T>>::State::LEN).map(|i| end[i].lane(0));
        (times.collect(), end.collect())
    }
}
