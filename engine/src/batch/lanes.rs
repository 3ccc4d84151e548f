//! The model over registers of one width: rows become lanes, and lanes rows.

use super::{Hold, Rollout, Rows, Wanted};
use crate::model::{Engine, Evaluated, Varying};
use bryant_generator::program::Method;
use bryant_runtime::real::lanes::{MOST_LANES, OfAnyWidth};
use bryant_runtime::{Adjustable, Dynamics, Real, Section, Several, Task};
use std::ops::Range;

/// The model over registers of one width, which have no name outside of [`with_width`].
pub(super) trait Lanes: Send {
    fn vary(&mut self, parameters: &[usize]);
    fn set_parameters(&mut self, values: &[f64]);
    /// Writes to `results` what is wanted at the rows of a range.
    fn evaluate(
        &mut self,
        wanted: Wanted,
        rows: &Rows<'_>,
        range: Range<usize>,
        results: &mut [f64],
    );
    /// Whether all values of rows are within limits. `limits` are the least and the greatest values of some rows, one
    /// row after the other.
    fn within(&self, values: &[f64], limits: [&[f64]; 2]) -> bool;
    /// Takes steps from the rows of a range, and writes states and outputs.
    fn rollout(
        &mut self,
        rollout: &Rollout,
        rows: &Rows<'_>,
        range: Range<usize>,
        results: [&mut [f64]; 2],
    );
}

/// Makes the model over registers.
pub(super) struct Make<'a>(pub &'a Engine);

impl OfAnyWidth for Make<'_> {
    type Output = Box<dyn Lanes>;
    fn run<T: Several<One = f64>>(self) -> Box<dyn Lanes> {
        let model: Evaluated<T> = self.0.over();
        let info = model.info();
        let zeros = |length| vec![T::from_f64(0.0); length];
        let most = [
            info.state_length(),
            info.velocities.len() * info.velocities.len(),
            Section::ALL
                .iter()
                .map(|of| info.length(*of))
                .max()
                .unwrap_or(0),
        ];
        let functions = super::lengths(self.0.functions());
        let length = info.state_length();
        let mut start = zeros(length);
        model.initial_state(&mut start);
        let most = most.into_iter().chain(functions).max().unwrap_or(0);
        Box::new(Held {
            y: zeros(length),
            rate: zeros(length),
            stage: zeros(length),
            sum: zeros(length),
            before: zeros(length),
            results: zeros(most),
            room: vec![[0.0; MOST_LANES]; most],
            accelerations: zeros(info.velocities.len()),
            given: false,
            values: Vec::new(),
            at_end: Vec::new(),
            defaults: Vec::new(),
            now: Vec::new(),
            varying: Varying::default(),
            start,
            model,
        })
    }
}

/// The model over registers, with room for a register full of rows.
struct Held<T: Real> {
    model: Evaluated<T>,
    /// The state with which a run starts.
    start: Vec<T>,
    y: Vec<T>,
    rate: Vec<T>,
    stage: Vec<T>,
    sum: Vec<T>,
    before: Vec<T>,
    results: Vec<T>,
    /// Given accelerations, and whether there were any the last time; otherwise they are 0.
    accelerations: Vec<T>,
    given: bool,
    varying: Varying,
    /// The values of the varying parameters at the beginning of a step, and at its end; those of the batch.
    values: Vec<T>,
    at_end: Vec<T>,
    defaults: Vec<T>,
    /// Room for the values within a step.
    now: Vec<T>,
    /// Room for numbers on their way into lanes and out of them.
    room: Vec<Numbers>,
}

/// The numbers of the lanes of one entry.
type Numbers = [f64; MOST_LANES];

/// Loads entries of rows into lanes. Lanes beyond the last row have the last row.
struct Load<'a, T> {
    rows: &'a [f64],
    /// Distance of rows.
    stride: usize,
    first: usize,
    end: usize,
    /// As long as `into` at least. All numbers are written before the first register is read: a register that is read
    /// right after its numbers were written waits for them.
    room: &'a mut [Numbers],
    into: &'a mut [T],
}

impl<T: Several<One = f64>> Task for Load<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let length = self.into.len();
        let row = |lane: usize| {
            let row = (self.first + lane).min(self.end - 1);
            &self.rows[row * self.stride..][..length]
        };
        if T::LANES == 1 {
            for (into, value) in self.into.iter_mut().zip(row(0)) {
                *into = T::from_f64(*value);
            }
            return;
        }
        let rows: [&[f64]; MOST_LANES] =
            std::array::from_fn(|lane| row(if lane < T::LANES { lane } else { 0 }));
        let room = &mut self.room[..length];
        for (entry, numbers) in room.iter_mut().enumerate() {
            for (number, row) in numbers.iter_mut().zip(&rows).take(T::LANES) {
                *number = row[entry];
            }
        }
        for (into, numbers) in self.into.iter_mut().zip(room) {
            *into = T::of_lanes(numbers);
        }
    }
}

/// Stores lanes as rows, but for those beyond the last row.
struct Store<'a, T> {
    from: &'a [T],
    stride: usize,
    rows: usize,
    /// As long as `from` at least.
    room: &'a mut [Numbers],
    results: &'a mut [f64],
}

impl<T: Several<One = f64>> Task for Store<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        let length = self.from.len();
        let room = &mut self.room[..length];
        for (numbers, from) in room.iter_mut().zip(self.from) {
            *numbers = from.lanes();
        }
        for (entry, numbers) in room.iter().enumerate() {
            let rows = self.results.chunks_mut(self.stride);
            for (row, number) in rows.zip(numbers).take(self.rows) {
                row[entry] = *number;
            }
        }
    }
}

/// Whether values are within limits. NaN is not.
struct Within<'a> {
    values: &'a [f64],
    limits: [&'a [f64]; 2],
}

impl Task for Within<'_> {
    type Output = bool;
    #[inline(always)]
    fn run(self) -> bool {
        let [low, high] = self.limits;
        let mut within = true;
        for values in self.values.chunks(low.len().max(1)) {
            for ((value, low), high) in values.iter().zip(low).zip(high) {
                // without a branch for each value: most are allowed
                within &= (low <= value) & (value <= high);
            }
        }
        within
    }
}

/// to = from + length · rate
struct Ahead<'a, T> {
    from: &'a [T],
    length: T,
    rate: &'a [T],
    to: &'a mut [T],
}

impl<T: Real> Task for Ahead<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        for ((to, from), rate) in self.to.iter_mut().zip(self.from).zip(self.rate) {
            *to = self.length.mul_add(*rate, *from);
        }
    }
}

/// to = to + length · rate
struct Add<'a, T> {
    length: T,
    rate: &'a [T],
    to: &'a mut [T],
}

impl<T: Real> Task for Add<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        for (to, rate) in self.to.iter_mut().zip(self.rate) {
            *to = self.length.mul_add(*rate, *to);
        }
    }
}

/// to = from + share · (end − from)
struct Between<'a, T> {
    from: &'a [T],
    end: &'a [T],
    share: T,
    to: &'a mut [T],
}

impl<T: Real> Task for Between<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(self) {
        for ((to, from), end) in self.to.iter_mut().zip(self.from).zip(self.end) {
            *to = self.share.mul_add(*end - *from, *from);
        }
    }
}

/// Turns the upper triangle of a matrix, by rows, into the whole symmetric matrix, in place.
fn spread<T: Copy>(size: usize, entries: &mut [T]) {
    let mut from = size * (size + 1) / 2;
    for row in (0..size).rev() {
        for column in (row..size).rev() {
            from -= 1;
            entries[row * size + column] = entries[from];
        }
    }
    for row in 0..size {
        for column in 0..row {
            entries[row * size + column] = entries[column * size + row];
        }
    }
}

impl<T: Several<One = f64>> Held<T> {
    /// Loads the states of rows from `first` on.
    fn load(&mut self, rows: &Rows<'_>, first: usize, end: usize) {
        let info = self.model.info();
        let [q, v] = [info.coordinates.len(), info.velocities.len()];
        if rows.states.is_empty() {
            self.y[q + v..].copy_from_slice(&self.start[q + v..]);
        }
        if rows.accelerations.is_empty() && self.given {
            self.accelerations.fill(T::from_f64(0.0));
        }
        self.given = !rows.accelerations.is_empty();
        let (coordinates, rest) = self.y.split_at_mut(q);
        let (velocities, states) = rest.split_at_mut(v);
        for (rows, stride, into) in [
            (rows.coordinates, q, coordinates),
            (rows.velocities, v, velocities),
            (rows.states, states.len(), states),
            (rows.accelerations, v, &mut self.accelerations),
        ] {
            if !rows.is_empty() {
                T::dispatch(Load {
                    rows,
                    stride,
                    first,
                    end,
                    room: &mut self.room,
                    into,
                });
            }
        }
    }

    /// Loads the inputs of the tick `tick` of `ticks` of the rows from `first` on.
    fn load_inputs(&mut self, inputs: &[f64], first: usize, end: usize, [tick, ticks]: [usize; 2]) {
        let width = self.varying.indices().len();
        T::dispatch(Load {
            rows: &inputs[tick * width..],
            stride: ticks * width,
            first,
            end,
            room: &mut self.room,
            into: &mut self.values,
        });
    }

    /// Restores the values of the batch.
    fn forget_inputs(&mut self, rows: &Rows<'_>) {
        if !rows.inputs.is_empty() {
            self.model.set_some(&self.varying, &self.defaults);
        }
    }

    /// Computes what is wanted into `results`, and returns its place there.
    fn compute(&mut self, wanted: Wanted, time: T) -> Range<usize> {
        let info = self.model.info();
        let [q, v] = [info.coordinates.len(), info.velocities.len()];
        let (model, y, results) = (&self.model, &self.y, &mut self.results);
        let by = |method, results: &mut [T]| model.evaluate(method, time, y, results);
        match wanted {
            Wanted::Rates | Wanted::Accelerations => {
                let length = info.state_length();
                model.derivative(time, y, &mut results[..length]);
                match wanted {
                    Wanted::Rates => 0..length,
                    _ => q..q + v,
                }
            }
            Wanted::Section(section) => {
                let length = info.length(section);
                model.section(section, time, y, &mut results[..length]);
                0..length
            }
            Wanted::Function(index) => {
                model.function(index, time, y, &self.accelerations, results);
                0..model.function_length(index)
            }
            Wanted::MassMatrix => {
                let half = v * (v + 1) / 2;
                by(Method::MassMatrix, &mut results[..half]);
                spread(v, results);
                0..v * v
            }
            Wanted::VelocityForces => {
                by(Method::VelocityForces, &mut results[..v]);
                0..v
            }
            Wanted::AppliedForces => {
                by(Method::AppliedForces, &mut results[..v]);
                0..v
            }
        }
    }

    /// Repeats the discrete update until nothing changes, because one switch may wait for another.
    fn renew(&mut self, time: T) {
        let info = self.model.info();
        if info.memory.is_empty() {
            return;
        }
        for _ in 0..=info.event_functions.len() {
            std::mem::swap(&mut self.before, &mut self.y);
            self.model.renewed(time, &self.before, &mut self.y);
            if self.y == self.before {
                break;
            }
        }
    }

    /// Sets the inputs at a share of the step.
    fn turn_inputs(&mut self, share: f64) {
        T::dispatch(Between {
            from: &self.values,
            end: &self.at_end,
            share: T::from_f64(share),
            to: &mut self.now,
        });
        self.model.set_some(&self.varying, &self.now);
    }

    /// Takes a step of Runge and Kutta. `turns` says from which share of an interval of inputs to which the step goes,
    /// if they change within it.
    fn step(&mut self, t: f64, h: f64, turns: Option<[f64; 2]>) {
        let number = T::from_f64;
        if let Some([begin, _]) = turns {
            self.turn_inputs(begin);
        }
        self.model.derivative(number(t), &self.y, &mut self.rate);
        self.sum.copy_from_slice(&self.y);
        // length of the stage, weight of the rate before it, share of the step
        for (length, weight, share) in [(0.5, 1.0, 0.5), (0.5, 2.0, 0.5), (1.0, 2.0, 1.0)] {
            T::dispatch(Add {
                length: number(h * weight / 6.0),
                rate: &self.rate,
                to: &mut self.sum,
            });
            T::dispatch(Ahead {
                from: &self.y,
                length: number(h * length),
                rate: &self.rate,
                to: &mut self.stage,
            });
            if let Some([begin, end]) = turns {
                self.turn_inputs(begin + share * (end - begin));
            }
            let at = number(t + share * h);
            self.model.derivative(at, &self.stage, &mut self.rate);
        }
        T::dispatch(Add {
            length: number(h / 6.0),
            rate: &self.rate,
            to: &mut self.sum,
        });
        std::mem::swap(&mut self.y, &mut self.sum);
        self.model.normalize(&mut self.y);
        self.renew(number(t + h));
    }
}

impl<T: Several<One = f64>> Lanes for Held<T> {
    fn vary(&mut self, parameters: &[usize]) {
        self.varying = self.model.varying(parameters);
        let zero = T::from_f64(0.0);
        for values in [
            &mut self.values,
            &mut self.at_end,
            &mut self.now,
            &mut self.defaults,
        ] {
            values.clear();
            values.resize(parameters.len(), zero);
        }
        if self.room.len() < parameters.len() {
            self.room.resize(parameters.len(), [0.0; MOST_LANES]);
        }
    }

    fn set_parameters(&mut self, values: &[f64]) {
        let all: Vec<T> = values.iter().map(|value| T::from_f64(*value)).collect();
        self.model.set_parameters(&all);
        for (default, index) in self.defaults.iter_mut().zip(self.varying.indices()) {
            *default = all[*index];
        }
        self.model.initial_state(&mut self.start);
    }

    fn within(&self, values: &[f64], limits: [&[f64]; 2]) -> bool {
        T::dispatch(Within { values, limits })
    }

    fn evaluate(
        &mut self,
        wanted: Wanted,
        rows: &Rows<'_>,
        range: Range<usize>,
        results: &mut [f64],
    ) {
        for first in range.clone().step_by(T::LANES) {
            self.load(rows, first, range.end);
            if !rows.inputs.is_empty() {
                self.load_inputs(rows.inputs, first, range.end, [0, 1]);
                self.model.set_some(&self.varying, &self.values);
            }
            let found = self.compute(wanted, T::from_f64(rows.time));
            let stride = found.len();
            T::dispatch(Store {
                from: &self.results[found],
                stride,
                rows: T::LANES.min(range.end - first),
                room: &mut self.room,
                results: &mut results[(first - range.start) * stride..],
            });
        }
        self.forget_inputs(rows);
    }

    fn rollout(
        &mut self,
        rollout: &Rollout,
        rows: &Rows<'_>,
        range: Range<usize>,
        [states, outputs]: [&mut [f64]; 2],
    ) {
        let Rollout {
            step,
            steps,
            parts,
            hold,
        } = *rollout;
        let parts = parts.max(1);
        let linear = hold == Hold::Linear && !rows.inputs.is_empty();
        let ticks = steps + usize::from(hold == Hold::Linear);
        let info = self.model.info();
        let lengths = [info.state_length(), info.outputs.len()];
        for first in range.clone().step_by(T::LANES) {
            self.load(rows, first, range.end);
            self.forget_inputs(rows);
            let lanes = T::LANES.min(range.end - first);
            let mut begun = false;
            for k in 0..steps {
                let begin = rows.time + step * k as f64;
                if !rows.inputs.is_empty() {
                    self.load_inputs(rows.inputs, first, range.end, [k, ticks]);
                    self.model.set_some(&self.varying, &self.values);
                }
                if linear {
                    let next = &rows.inputs[(k + 1) * self.varying.indices().len()..];
                    T::dispatch(Load {
                        rows: next,
                        stride: ticks * self.varying.indices().len(),
                        first,
                        end: range.end,
                        room: &mut self.room,
                        into: &mut self.at_end,
                    });
                }
                if !begun {
                    // switches that are past their thresholds act at once
                    self.renew(T::from_f64(begin));
                    begun = true;
                }
                let h = step / parts as f64;
                for part in 0..parts {
                    let share = |part: usize| part as f64 / parts as f64;
                    let turns = linear.then(|| [share(part), share(part + 1)]);
                    self.step(begin + h * part as f64, h, turns);
                }
                let time = T::from_f64(rows.time + step * (k + 1) as f64);
                for (section, length, results) in [
                    (None, lengths[0], &mut *states),
                    (Some(Section::Outputs), lengths[1], &mut *outputs),
                ] {
                    if results.is_empty() {
                        continue;
                    }
                    let from = match section {
                        None => &self.y[..],
                        Some(section) => {
                            let results = &mut self.results[..length];
                            self.model.section(section, time, &self.y, results);
                            results
                        }
                    };
                    let row = (first - range.start) * steps + k;
                    T::dispatch(Store {
                        from,
                        stride: steps * length,
                        rows: lanes,
                        room: &mut self.room,
                        results: &mut results[row * length..],
                    });
                }
            }
        }
        self.forget_inputs(rows);
    }
}
