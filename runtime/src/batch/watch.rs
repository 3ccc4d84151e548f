//! Judges whether lanes with fixed steps can be trusted: the balances of energy and momentum, and the limit of
//! stability, as in the watch of a single run ([`crate::simulate`]). Steps under error control are not watched, and
//! cost nothing here: they have that control, and the estimate of their error.

use super::run::{Run, Work, each, replace};
use super::settings::{Fixed, LaneFormula, Pace};
use super::step::Step;
use super::{arrays, copies};
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several, mapped};
use crate::simulate::balance::{NODES, Quadrature, exchange};
use crate::simulate::watch::account::{
    Account, Energies, Entry, Stability, Unstable, rate_squared,
};
use crate::simulate::watch::error::{Errors, Estimated, over_halves};
use crate::{Info, Real, StateKind};

/// The quadrature of powers; fixed steps may be arbitrarily long.
const RULE: Quadrature = Quadrature::Degree5;
const LAST: usize = NODES - 1;

/// A number for each lane.
type OfLanes = [f64; MOST_LANES];

/// The accounts of all lanes, and what was found.
pub(super) struct Watch<T: Several> {
    account: [Account; MOST_LANES],
    stability: [Stability; MOST_LANES],
    /// The effect whose power was largest when energy began to be missing in each lane.
    effect: [Option<usize>; MOST_LANES],
    errors: [Errors; MOST_LANES],
    /// Kinetic energy at the start, and at the end of the last step \[J\].
    kinetic: [OfLanes; 2],
    /// Work of each effect \[J\].
    works: Box<[OfLanes]>,
    /// Momentum at the start, the momentum given by forces, and the sum of its magnitudes.
    momentum: [[OfLanes; 3]; 6],
    /// The state at the start, and the difference of each entry from the solution in steps half as long.
    start: Box<[T]>,
    error: Box<[T]>,
    /// A step of the solution with halved steps.
    halved: Step<T>,
    /// Whether coordinates may change their charts.
    charts: bool,
    /// The lanes in which powers at the start of the step are known.
    known: T::Mask,
    /// Powers of all effects, and external wrenches on the freely moving bodies, at the nodes of the step and at one
    /// further place.
    powers: [Box<[T]>; NODES + 1],
    external_wrenches: [[T; 6]; NODES + 1],
    /// A state near the end of the step, its rate, and the state at the start of the step.
    near: Box<[T]>,
    near_rate: Box<[T]>,
    before: Box<[T]>,
}

const ANY: usize = NODES;

impl<T: Several> Watch<T> {
    /// A watch for a model, with the share of energy and momentum that may be missing.
    fn new(info: &Info, method: LaneFormula, limit: f64) -> Self {
        let zeros = |length: usize| copies(T::from_f64(0.0), length);
        let entries = info.state_length();
        Watch {
            account: [Account::new(limit); MOST_LANES],
            stability: [Stability::NONE; MOST_LANES],
            effect: [None; MOST_LANES],
            errors: [Errors::new(limit); MOST_LANES],
            kinetic: [[0.0; MOST_LANES]; 2],
            works: copies([0.0; MOST_LANES], info.powers.len()),
            momentum: [[[0.0; MOST_LANES]; 3]; 6],
            start: zeros(entries),
            error: zeros(entries),
            halved: Step::new(method, entries),
            charts: info.memory.iter().any(|name| name.ends_with(": chart")),
            known: T::Mask::of_lanes(0),
            powers: arrays(T::from_f64(0.0), info.powers.len()),
            external_wrenches: [[T::from_f64(0.0); 6]; NODES + 1],
            near: zeros(entries),
            near_rate: zeros(entries),
            before: zeros(entries),
        }
    }

    /// A watch if steps are fixed.
    pub(super) fn of(info: &Info, pace: &Pace, limit: f64) -> Option<Box<Self>> {
        match pace {
            Pace::Fixed(Fixed { method, .. }) => Some(Box::new(Watch::new(info, *method, limit))),
            Pace::Adaptive(_) => None,
        }
    }

    /// The series of steps above the limit of stability in a lane; one step is enough if the run has `failed`.
    pub(super) fn unstable(&self, lane: usize, failed: bool) -> Option<Unstable> {
        self.stability[lane].unstable(failed)
    }

    /// `Some` if energy is missing in the balance of a lane, with the effect whose power was largest when this began.
    pub(super) fn energy(&self, lane: usize) -> Option<Option<usize>> {
        self.account[lane].energy().map(|_| self.effect[lane])
    }

    /// The entry of the state with the largest error, if the estimated error in a lane is too large.
    pub(super) fn error(&self, lane: usize) -> Option<usize> {
        self.errors[lane].found().map(|(_, index)| index)
    }

    /// True if momentum is missing in the balance of a lane.
    pub(super) fn momentum(&self, lane: usize) -> bool {
        self.account[lane].momentum().is_some()
    }
}

/// [`Run::open_accounts`]
struct Open(u32);

impl<T: Several> Work<T> for Open {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.open_accounts(self.0);
    }
}

/// [`Run::add_work`]
struct AddWork<T: Real> {
    accepted: T::Mask,
    part: T,
    reached: T,
}

impl<T: Several> Work<T> for AddWork<T> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        let Some(mut watch) = run.watch.take() else {
            return;
        };
        run.add_work(&mut watch, self.accepted, self.part, self.reached);
        run.watch = Some(watch);
    }
}

impl<T: Several> Run<'_, T> {
    /// Opens the watch for runs that begin in these lanes.
    #[inline(always)]
    pub(super) fn begin_watch(&mut self, fresh: T::Mask) {
        if self.watch.is_some() {
            self.apart(Open(fresh.lanes()));
        }
    }

    /// Adds the steps of these lanes, which end at `reached` in `end`, and of which only the first `part` is kept.
    #[inline(always)]
    pub(super) fn advance_watch(&mut self, accepted: T::Mask, part: T, reached: T) {
        if self.watch.is_some() {
            self.apart(AddWork {
                accepted,
                part,
                reached,
            });
        }
    }

    /// Begins the next steps of the lanes `going`. In the lanes `same`, they begin exactly as the previous ones ended;
    /// in the lanes `smooth`, moreover, the previous steps were whole: for these, the rate of the fastest motion is
    /// estimated.
    #[inline(always)]
    pub(super) fn leave_watch(&mut self, going: T::Mask, same: T::Mask, smooth: T::Mask) {
        let Some(watch) = &mut self.watch else {
            return;
        };
        watch.known = watch.known.and(going.not()).or(same.and(going));
        if watch.charts {
            // the coordinates may be those of another chart
            let elsewhere = going.and(same.not());
            for error in &mut watch.error {
                *error = T::select(elsewhere, T::from_f64(0.0), *error);
            }
        }
        let [first, .., last, _] = &mut watch.powers;
        replace(same, first, last);
        let [first, .., last, _] = &mut watch.external_wrenches;
        replace(same, first, last);
        let Pace::Fixed(Fixed { method, .. }) = self.settings.pace else {
            return;
        };
        let Some(limit) = method.formula().stability_limit() else {
            return;
        };
        for lane in each(smooth.and(going).lanes()).take_while(|lane| *lane < T::LANES) {
            if watch.stability[lane].known() {
                continue;
            }
            let of = |entries: &[T], i: usize| entries[i].lane(lane).to_f64();
            let entry = |i: usize| Entry {
                before: of(&watch.before, i),
                end: [of(&self.step.y, i), of(&self.step.k[0], i)],
                near: [of(&watch.near, i), of(&watch.near_rate, i)],
            };
            if let Some(found) = rate_squared(self.info, T::EPSILON, entry) {
                let h = self.step.h.lane(lane).to_f64();
                let begin = self.step.t.lane(lane).to_f64() - h;
                watch.stability[lane].observe([begin, h], found, limit);
            }
        }
    }

    /// Opens the accounts of these lanes, at the start of their runs.
    fn open_accounts(&mut self, lanes: u32) {
        let Some(watch) = &mut self.watch else {
            return;
        };
        let (model, info) = (&*self.models.all, self.info);
        let (t, y) = (self.step.t, &self.step.y);
        let energy = model.kinetic_energy(t, y);
        // the kinetic energy of velocities of 1, less that of prescribed motions
        let mut moving = |wanted: StateKind| {
            self.state.copy_from_slice(y);
            let mut energies = [T::from_f64(0.0); 2];
            for (energy, size) in energies.iter_mut().zip([0.0, 1.0]) {
                for i in info.coordinates.len()..y.len() {
                    let kind = info.kind(i);
                    if matches!(kind, StateKind::Velocity | StateKind::AngularVelocity) {
                        let size = if kind == wanted { size } else { 0.0 };
                        self.state[i] = T::from_f64(size);
                    }
                }
                *energy = model.kinetic_energy(t, &self.state);
            }
            energies
        };
        let free = info.free.then(|| {
            let of_one = [
                moving(StateKind::Velocity),
                moving(StateKind::AngularVelocity),
            ];
            (of_one, model.momentum(t, y))
        });
        let limit = self.settings.energy_limit;
        let fresh = T::Mask::of_lanes(lanes);
        watch.known = watch.known.and(fresh.not());
        replace(fresh, &mut watch.start, y);
        for error in &mut watch.error {
            *error = T::select(fresh, T::from_f64(0.0), *error);
        }
        for lane in each(lanes).take_while(|lane| *lane < T::LANES) {
            let of = |value: T| value.lane(lane).to_f64();
            watch.stability[lane] = Stability::NONE;
            watch.effect[lane] = None;
            let kinetic = of(energy);
            (watch.kinetic[0][lane], watch.kinetic[1][lane]) = (kinetic, kinetic);
            for sum in &mut watch.works {
                sum[lane] = 0.0;
            }
            watch.errors[lane] = Errors::new(limit);
            let account = &mut watch.account[lane];
            *account = Account::new(limit);
            account.open(kinetic, 0.0);
            if let Some((of_one, momentum)) = free {
                let of_one = mapped(of_one, |[slow, fast]| (of(fast) - of(slow)).max(0.0));
                account.weigh_at_start(info.dimension, of_one);
                for (sums, start) in watch.momentum.iter_mut().zip(momentum) {
                    (sums[0][lane], sums[1][lane], sums[2][lane]) = (of(start), 0.0, 0.0);
                }
            }
        }
    }

    /// Adds the work of the steps of these lanes, of which only the first `part` is kept, and closes their accounts.
    #[inline(always)]
    fn add_work(&mut self, watch: &mut Watch<T>, accepted: T::Mask, part: T, reached: T) {
        self.step.complete(&*self.models.all);
        let model = &*self.models.all;
        let t = self.step.t;
        let fresh = accepted.and(watch.known.not());
        if fresh.any() {
            exchange(
                model,
                (t, &self.step.y),
                &mut watch.powers[ANY],
                &mut watch.external_wrenches[ANY],
            );
            let [first, .., any] = &mut watch.powers;
            replace(fresh, first, any);
            let [first, .., any] = &mut watch.external_wrenches;
            replace(fresh, first, any);
        }
        for (node, x) in RULE.inner() {
            let theta = part * T::from_f64(x);
            self.step.inside(model, theta, &mut self.state);
            let t = theta * self.step.h + t;
            let (powers, external_wrench) =
                (&mut watch.powers[node], &mut watch.external_wrenches[node]);
            exchange(model, (t, &self.state), powers, external_wrench);
        }
        let ends = reached.min(self.step.latest);
        let kinetic = model.kinetic_energy(ends, &self.end);
        let (powers, external_wrench) =
            (&mut watch.powers[LAST], &mut watch.external_wrenches[LAST]);
        exchange(model, (ends, &self.end), powers, external_wrench);
        let momentum = match self.info.free {
            true => model.momentum(ends, &self.end),
            false => [T::from_f64(0.0); 6],
        };
        self.step.neighbour(&mut watch.near, &mut watch.near_rate);
        watch.before.copy_from_slice(&self.step.y);

        let mut weights = [T::from_f64(0.0); NODES];
        for (place, weight) in weights.iter_mut().zip(RULE.weights()) {
            *place = part * self.step.h * T::from_f64(weight);
        }
        let lanes = accepted.lanes() & ((1 << T::LANES) - 1);
        for (i, works) in watch.works.iter_mut().enumerate() {
            let mut work = T::from_f64(0.0);
            for (weight, powers) in weights.iter().zip(&watch.powers) {
                work = weight.mul_add(powers[i], work);
            }
            for lane in each(lanes) {
                works[lane] += work.lane(lane).to_f64();
            }
        }
        if self.info.free {
            for (i, [_, given, exchanged]) in watch.momentum.iter_mut().enumerate() {
                let (mut sum, mut size) = (T::from_f64(0.0), T::from_f64(0.0));
                for (weight, external_wrenches) in weights.iter().zip(&watch.external_wrenches) {
                    sum = weight.mul_add(external_wrenches[i], sum);
                    size = weight.mul_add(external_wrenches[i].abs(), size);
                }
                for lane in each(lanes) {
                    given[lane] += sum.lane(lane).to_f64();
                    exchanged[lane] += size.lane(lane).to_f64();
                }
            }
        }
        self.estimate_error(watch, accepted, part);
        for lane in each(lanes) {
            let kinetic = kinetic.lane(lane).to_f64();
            self.close(watch, lane, kinetic, momentum);
        }
    }

    /// Continues the error estimate over the steps of these lanes, of which only the first `part` is kept.
    #[inline(always)]
    fn estimate_error(&mut self, watch: &mut Watch<T>, accepted: T::Mask, part: T) {
        let model = &*self.models.all;
        let method = self.settings.pace.method();
        let step = &mut watch.halved;
        let half = T::from_f64(0.5) * part * self.step.h;
        (step.t, step.h, step.latest) = (self.step.t, half, self.step.latest);
        for ((state, y), error) in step.y.iter_mut().zip(&self.step.y).zip(&watch.error) {
            *state = *y - *error;
        }
        model.normalize(&mut step.y);
        let [first, ..] = &mut step.k;
        model.derivative(step.t.min(step.latest), &step.y, first);
        step.take(model);
        step.t += half;
        step.y.copy_from_slice(&step.end);
        model.normalize(&mut step.y);
        let [first, .., last] = &mut step.k;
        match method.ends_with_its_rate() {
            true => first.copy_from_slice(last),
            false => model.derivative(step.t.min(step.latest), &step.y, first),
        }
        step.take(model);
        model.normalize(&mut step.end);
        let integrated = self.info.varying_length();
        for (i, error) in watch.error.iter_mut().enumerate().take(integrated) {
            *error = T::select(accepted, self.end[i] - step.end[i], *error);
        }
        let coordinates = self.info.coordinates.len();
        let over = over_halves(method.formula().order());
        for lane in each(accepted.lanes()).take_while(|lane| *lane < T::LANES) {
            let of = |value: T| value.lane(lane).to_f64();
            let entry = |i: usize| Estimated {
                size: match i < coordinates {
                    true => of(self.end[i] - watch.start[i]),
                    false => of(self.end[i]),
                },
                error: over * of(watch.error[i]),
            };
            watch.errors[lane].observe(of(self.step.t), self.info, entry);
        }
    }

    /// Closes the accounts of a step in a lane, with the kinetic energy and the momentum at its end.
    fn close(&self, watch: &mut Watch<T>, lane: usize, kinetic: f64, momentum: [T; 6]) {
        let info = self.info;
        let t = self.step.t.lane(lane).to_f64();
        let works = watch.works.iter().map(|work| work[lane]);
        let start = watch.kinetic[0][lane];
        let gap = works.clone().fold(kinetic - start, |gap, work| gap - work);
        let energies = Energies {
            kinetic: [watch.kinetic[1][lane], kinetic],
            exchanged: 0.0,
            // a model without effects has no balance of energy
            gap: if info.powers.is_empty() {
                0.0
            } else {
                gap.abs()
            },
        };
        watch.kinetic[1][lane] = kinetic;
        if watch.account[lane].close(t, energies, works) {
            let size = |i: &usize| watch.powers[LAST][*i].lane(lane).to_f64().abs();
            let effects = 0..info.powers.len();
            watch.effect[lane] = effects.max_by(|a, b| size(a).total_cmp(&size(b)));
        }
        if !info.free {
            return;
        }
        let places = (0..info.coordinates.len())
            .filter(|&i| info.kinds.get(i) == Some(&StateKind::Position));
        let place = |i: usize| self.end[i].lane(lane).to_f64();
        let distance = places.map(|i| place(i) * place(i)).sum();
        let (mut missing, mut size) = ([0.0_f64; 2], 0.0_f64);
        for (i, (sums, end)) in watch.momentum.iter().zip(momentum).enumerate() {
            let [start, given, exchanged] = [sums[0][lane], sums[1][lane], sums[2][lane]];
            let end = end.lane(lane).to_f64();
            missing[i / 3] = missing[i / 3].max((end - start - given).abs());
            size = size.max(start.abs()).max(end.abs()).max(exchanged);
        }
        watch.account[lane].weigh(t, missing, [size, T::EPSILON], distance);
    }
}
