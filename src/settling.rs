//! Searches a state of rest: a state in which the forces on every body are in balance.
//!
//! The model is released from its start while time stands still. Its motion is stopped whenever its kinetic energy has
//! passed a maximum (kinetic damping, Cundall 1976; the older method is dynamic relaxation, Day 1965). Each stop
//! removes energy, so the search ends in a position from which nothing moves. This is a state of rest of the unchanged
//! equations, because nothing was added to them. A law that dissipates only during motion, such as damping or friction
//! by speed, does not act there. Memory of a law, such as a permanent set or a hold, has the value that it took on the
//! way to rest.
//!
//! Strongly damped motions creep, and stopping them does not help. So after some stops the model follows its
//! accelerations a(q) by q' = a(q), in implicit steps δ = (1/h − ∂a/∂q)⁻¹ a with the model's Jacobian: pseudo-transient
//! continuation (Kelley and Keyes 1998). The step h grows as the accelerations decrease, so that the last steps are
//! Newton steps.
//!
//! The motion between two stops is integrated by the method of Bogacki and Shampine (1989), of third order with an
//! error estimate of second order. Only the end of the motion must be accurate, and its accelerations are those of the
//! equations.
//!
//! **Motion at the start.** A system that moves along with a vehicle is at rest if it does not move relative to the
//! vehicle. So the velocities of reference joints are kept, and coordinates are those for an observer who moves with
//! these velocities. Angular velocities are not kept.
//!
//! A state of rest may be unstable, such as that of a rod that stands on its end. So the model is pushed slightly at
//! the end, and its motion is checked.

use bryant_runtime::{Dynamics, StateKind};

/// The goal of the search.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    /// The largest acceleration that a state of rest may have \[m/s²\].
    pub acceleration: f64,
    /// Largest number of evaluations of the equations.
    pub evaluations: u64,
}

/// The result of the search.
#[derive(Clone, Debug)]
pub struct Settled {
    /// The state at the end. Velocities are 0, except those of reference joints, which are as at the start.
    pub state: Vec<f64>,
    /// The largest remaining acceleration \[m/s²\].
    pub acceleration: f64,
    /// Number of stops.
    pub stops: u32,
    /// How the search ended.
    pub end: End,
}

/// How a search for a state of rest ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The model rests.
    Rest,
    /// The model rests, but a slight push moves it away.
    Unstable,
    /// The model still moves after all evaluations, or has not come nearer to rest for many stops.
    Moving,
    /// The model still moves, and is too far from its start to go on.
    Lost,
    /// The state is no longer finite.
    NotFinite,
}

/// Allowed error of a step, relative and absolute \[m, rad, m/s, …\]. It is large, because the way to rest need not be
/// accurate.
const RELATIVE: f64 = 1e-4;
const ABSOLUTE: f64 = 1e-6;
/// The longest step of a motion \[s\].
const LONGEST_STEP: f64 = 0.01;
/// Number of stops between two phases of following the accelerations, and largest number of steps in such a phase.
const STOPS: u32 = 10;
const FOLLOWED: u32 = 300;
/// Number of steps between two checks whether the model is still near its start.
const STEPS: u32 = 20;
/// The search ends after this many stops that did not halve the smallest acceleration: something slides or pays out,
/// and will not stop.
const IN_VAIN: u32 = 100;
/// In following the accelerations, length of the first step \[s²\], and longest motion of a coordinate in one step \[m,
/// rad\]: a longer step could pass through a body.
const FIRST: f64 = 1e-5;
const LONGEST: f64 = 0.005;
/// Velocities of the push that tests stability \[m/s, rad/s\], and length of the test \[s\].
const PUSH: f64 = 1e-3;
const WATCH: f64 = 2.0;
/// In the test, a coordinate of a stable state moves at most this many times as far as the push alone would move it.
const DRIFT: f64 = 10.0;

/// Searches a state of rest, beginning at the state `start`; time stands still at `time`. `acceleration` returns the
/// largest acceleration of a state \[m/s²\], and whether the state is near enough to the start. `go_on` is called after
/// each stop, and returns false to end the search.
pub fn settle(
    model: &dyn Dynamics<f64>,
    time: f64,
    start: &[f64],
    wanted: Wanted,
    acceleration: &mut dyn FnMut(&[f64]) -> (f64, bool),
    go_on: &mut dyn FnMut(u32, f64) -> bool,
) -> Settled {
    let mut motion = Motion::new(model, time, start);
    motion.stop();
    let mut stops = 0;
    let (mut left, _) = acceleration(&motion.state);
    let mut before = 0.0;
    let mut steps = 0u32;
    // the smallest acceleration so far, and the number of the stop at which it was last halved
    let (mut best, mut nearer) = (left, 0);
    let mut end = End::Moving;
    while motion.evaluations < wanted.evaluations {
        if left <= wanted.acceleration {
            end = End::Rest;
            break;
        }
        if !motion.step() {
            end = End::NotFinite;
            break;
        }
        let energy = motion.energy();
        if !energy.is_finite() {
            end = End::NotFinite;
            break;
        }
        if energy >= before {
            before = energy;
            steps += 1;
            if steps.is_multiple_of(STEPS) && !acceleration(&motion.state).1 {
                end = End::Lost;
                break;
            }
            continue;
        }
        motion.stop();
        stops += 1;
        before = 0.0;
        let near;
        (left, near) = acceleration(&motion.state);
        if !go_on(stops, left) {
            break;
        }
        if !near && left > wanted.acceleration {
            end = End::Lost;
            break;
        }
        if left < 0.5 * best {
            (best, nearer) = (left, stops);
        } else if stops >= nearer + IN_VAIN {
            break;
        }
        if stops.is_multiple_of(STOPS) && left > wanted.acceleration {
            motion.follow(1e-3 * wanted.acceleration);
            (left, _) = acceleration(&motion.state);
        }
    }
    let state = motion.state.clone();
    if end == End::Rest && !stays(model, time, &state) {
        end = End::Unstable;
    }
    Settled {
        state,
        acceleration: left,
        stops,
        end,
    }
}

/// True if the model stays near a state after a push of all its velocities, tested in two opposite directions.
fn stays(model: &dyn Dynamics<f64>, time: f64, state: &[f64]) -> bool {
    [1.0, -1.0].into_iter().all(|sign| {
        let mut motion = Motion::new(model, time, state);
        for index in motion.velocities() {
            // velocities differ irregularly, so that no symmetry cancels the push
            let part = (1.0 + index as f64 * 0.618_033_988_749_895).fract();
            motion.state[index] += sign * PUSH * (0.5 + 0.5 * part);
        }
        let length = motion.coordinates();
        let mut elapsed = 0.0;
        while elapsed < WATCH {
            motion.step_length = motion.step_length.min(WATCH - elapsed).max(1e-12);
            if !motion.step() {
                return false;
            }
            elapsed += motion.last_step;
            let moved = |index: usize| (motion.state[index] - state[index]).abs();
            if (0..length).any(|index| moved(index) > DRIFT * PUSH * WATCH) {
                return false;
            }
        }
        true
    })
}

/// A state during its integration.
struct Motion<'m> {
    model: &'m dyn Dynamics<f64>,
    time: f64,
    state: Vec<f64>,
    /// ẏ at the state, for an observer who moves with the velocities that are kept.
    rate: Vec<f64>,
    /// Velocities that are kept, which are those of reference joints at the start, and the rates of coordinates due to
    /// them.
    kept: Vec<f64>,
    drift: Vec<f64>,
    step_length: f64,
    last_step: f64,
    evaluations: u64,
}

impl<'m> Motion<'m> {
    fn new(model: &'m dyn Dynamics<f64>, time: f64, start: &[f64]) -> Self {
        let mut motion = Motion {
            model,
            time,
            state: start.to_vec(),
            rate: vec![0.0; start.len()],
            kept: Vec::new(),
            drift: vec![0.0; start.len()],
            step_length: 1e-4,
            last_step: 0.0,
            evaluations: 0,
        };
        let of_reference = |index: usize| match model.info().kind(index) {
            StateKind::Velocity => start[index],
            _ => 0.0,
        };
        motion.kept = motion.velocities().map(of_reference).collect();
        let velocities = motion.velocities();
        motion.state[velocities].copy_from_slice(&motion.kept);
        model.coordinate_rates(&motion.state, &mut motion.drift);
        motion.renew();
        motion.look();
        motion
    }

    fn renew(&mut self) {
        let state = self.state.clone();
        self.model.renewed(self.time, &state, &mut self.state);
    }

    fn coordinates(&self) -> usize {
        self.model.info().coordinates.len()
    }

    fn velocities(&self) -> std::ops::Range<usize> {
        let first = self.coordinates();
        first..first + self.model.info().velocities.len()
    }

    fn look(&mut self) {
        let mut rate = std::mem::take(&mut self.rate);
        self.rate_at(&self.state, &mut rate);
        self.rate = rate;
        self.evaluations += 1;
    }

    /// ẏ of a state, for an observer who moves with the velocities that are kept.
    fn rate_at(&self, state: &[f64], rate: &mut [f64]) {
        self.model.derivative(self.time, state, rate);
        for (rate, drift) in rate.iter_mut().zip(&self.drift) {
            *rate -= drift;
        }
    }

    /// Sets all velocities to those that are kept.
    fn stop(&mut self) {
        let velocities = self.velocities();
        self.state[velocities].copy_from_slice(&self.kept);
        self.look();
    }

    /// The kinetic energy of the motion relative to the velocities that are kept: the first term of T = ½ uᵀMu + bᵀu +
    /// c, with the relative velocities u.
    fn energy(&self) -> f64 {
        let first = self.coordinates();
        let of = |share: f64| {
            let mut state = self.state.clone();
            for (k, kept) in self.kept.iter().enumerate() {
                state[first + k] = kept + share * (self.state[first + k] - kept);
            }
            self.model.kinetic_energy(self.time, &state)
        };
        0.5 * (of(1.0) + of(-1.0)) - of(0.0)
    }

    /// Follows the accelerations by implicit steps of growing length, until their norm is at most `small` or all steps
    /// are used.
    fn follow(&mut self, small: f64) {
        let (count, first) = (self.state.len(), self.coordinates());
        let freedoms = self.velocities().len();
        let (mut by_state, mut by_time) = (vec![0.0; count * count], vec![0.0; count]);
        let size = |rate: &[f64]| {
            rate[first..first + freedoms]
                .iter()
                .map(|a| a * a)
                .sum::<f64>()
                .sqrt()
        };
        let mut length = FIRST;
        for _ in 0..FOLLOWED {
            let before = size(&self.rate);
            let there = self
                .model
                .jacobian(self.time, &self.state, &mut by_state, &mut by_time);
            if !there || before <= small {
                return;
            }
            self.evaluations += count as u64;
            let pull = self.rate[first..first + freedoms]
                .iter()
                .fold(0.0, |most: f64, a| most.max(a.abs()));
            length = length.min(LONGEST / pull);
            let columns = self.directions();
            let entry = |row: usize, k: usize| -> f64 {
                let of_row = &by_state[(first + row) * count..][..first];
                columns[k].iter().map(|(i, rate)| of_row[*i] * rate).sum()
            };
            let pulled: Vec<Vec<f64>> = (0..freedoms)
                .map(|row| (0..freedoms).map(|k| entry(row, k)).collect())
                .collect();
            loop {
                let mut matrix = pulled.clone();
                for (i, row) in matrix.iter_mut().enumerate() {
                    row.iter_mut().for_each(|entry| *entry = -*entry);
                    row[i] += 1.0 / length;
                }
                let step = solved(matrix, self.rate[first..first + freedoms].to_vec());
                let longest = step
                    .iter()
                    .fold(0.0, |most: f64, step| most.max(step.abs()));
                let moved = (longest <= 2.0 * LONGEST).then(|| self.moved(&columns, &step));
                let after = moved
                    .as_ref()
                    .map_or(f64::INFINITY, |moved| size(&moved.rate));
                if let Some(moved) = moved.filter(|_| after < 2.0 * before) {
                    (self.state, self.rate, self.evaluations) =
                        (moved.state, moved.rate, moved.evaluations);
                    length *= (before / after).clamp(0.5, 4.0) * 1.1;
                    break;
                }
                length *= 0.25;
                if length < 1e-20 {
                    return;
                }
            }
        }
    }

    /// For each freedom, the coordinates that change with it, and their rates at a velocity of 1.
    fn directions(&self) -> Vec<Vec<(usize, f64)>> {
        let velocities = self.velocities();
        let column = |index: usize| {
            let (mut moving, mut column) = (self.state.clone(), vec![0.0; self.state.len()]);
            moving[velocities.clone()].fill(0.0);
            moving[index] = 1.0;
            self.model.coordinate_rates(&moving, &mut column);
            column.truncate(self.coordinates());
            let rates = column.into_iter().enumerate();
            rates.filter(|(_, rate)| *rate != 0.0).collect()
        };
        velocities.clone().map(column).collect()
    }

    /// The motion after a change of the coordinates by `step` in each freedom.
    fn moved(&self, columns: &[Vec<(usize, f64)>], step: &[f64]) -> Motion<'m> {
        let mut moved = Motion {
            state: self.state.clone(),
            rate: self.rate.clone(),
            kept: self.kept.clone(),
            drift: self.drift.clone(),
            ..*self
        };
        for (column, step) in columns.iter().zip(step) {
            for (coordinate, along) in column {
                moved.state[*coordinate] += step * along;
            }
        }
        self.model.normalize(&mut moved.state);
        moved.renew();
        moved.look();
        moved
    }

    /// Takes one time step; false if the step would become too short.
    fn step(&mut self) -> bool {
        let count = self.state.len();
        let (mut second, mut third, mut last) =
            (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
        loop {
            let h = self.step_length;
            let first = &self.rate;
            let at = |parts: &dyn Fn(usize) -> f64| -> Vec<f64> {
                (0..count).map(|i| self.state[i] + h * parts(i)).collect()
            };
            self.rate_at(&at(&|i| 0.5 * first[i]), &mut second);
            self.rate_at(&at(&|i| 0.75 * second[i]), &mut third);
            let mut next = at(&|i| (2.0 * first[i] + 3.0 * second[i] + 4.0 * third[i]) / 9.0);
            self.rate_at(&next, &mut last);
            self.evaluations += 3;
            let error = |i: usize| {
                let error = h
                    * (-5.0 * first[i] / 72.0 + second[i] / 12.0 + third[i] / 9.0 - last[i] / 8.0);
                error / (ABSOLUTE + RELATIVE * self.state[i].abs().max(next[i].abs()))
            };
            let integrated = (0..count).filter(|i| self.model.info().kind(*i) != StateKind::Memory);
            let worst = integrated
                .map(error)
                .fold(0.0, |worst: f64, e| match e.is_finite() {
                    true => worst.max(e.abs()),
                    false => f64::INFINITY,
                });
            let change = 0.9 * libm::pow(worst.max(1e-6), -1.0 / 3.0);
            if worst <= 1.0 {
                self.last_step = h;
                self.step_length = (h * change.clamp(0.2, 5.0)).min(LONGEST_STEP);
                self.model.normalize(&mut next);
                self.model.renewed(self.time, &next, &mut self.state);
                self.look();
                return true;
            }
            self.step_length = h * change.clamp(0.1, 0.9);
            if self.step_length < 1e-13 {
                return false;
            }
        }
    }
}

/// A⁻¹ b by elimination with pivoting; not finite if A is singular.
fn solved(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let count = b.len();
    for k in 0..count {
        let pivot = (k..count).max_by(|i, j| a[*i][k].abs().total_cmp(&a[*j][k].abs()));
        let pivot = pivot.unwrap_or(k);
        a.swap(k, pivot);
        b.swap(k, pivot);
        let row = a[k].clone();
        for i in k + 1..count {
            let factor = a[i][k] / row[k];
            if factor == 0.0 {
                continue;
            }
            for (entry, above) in a[i][k..].iter_mut().zip(&row[k..]) {
                *entry -= factor * above;
            }
            b[i] -= factor * b[k];
        }
    }
    for k in (0..count).rev() {
        let rest: f64 = (k + 1..count).map(|j| a[k][j] * b[j]).sum();
        b[k] = (b[k] - rest) / a[k][k];
    }
    b
}
