//! The time loop of a batch: that of a single run ([`crate::simulate`]), with a time and a step for each lane.
//!
//! ```text
//! an idle lane takes the next scenario
//! length of the step ← fixed, or the controller's, cut to meet the next kink in time
//! take it, in all lanes
//!   in which the error is too large, or something is hidden    → again, shorter
//!   in which a guard changed its sign                          → ends there
//! samples, memory of force laws; lanes at the end of their run hand it over
//! ```
//!
//! Lanes may hold singles. At 0.1 s these tell 7·10⁻⁹ s apart, and no clock drifts by it: the length of a step is what the rounded times of
//! its ends differ by, or, where steps are fixed, their span over their number. Steps below sixteen times that are refused, and kinks in time come by it too early or too late. Tolerances from 10⁻⁴ up
//! are for singles: runs are then those of doubles, step by step. Far below, rounding is taken for error of the step, and steps get short.

use super::control::{Controllers, first_step};
use super::enabled;
use super::event::{Sides, Values};
use super::reach::{Grid, Reach};
use super::scenario::{Ended, Scenarios, Series, Status};
use super::settings::{Pace, Settings};
use super::step::Step;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several, Task};
use crate::simulate::finest;
use crate::{Model, ParameterSet, Real, Vector};

/// Smallest step \[s\].
pub(super) const SMALLEST: f64 = 1e-14;

/// Runs all scenarios.
pub fn run<T: Several, M: Model<T>>(settings: &Settings, scenarios: &mut dyn Scenarios<T::One>) {
    T::enable(Run::<T, M>::new(settings, scenarios));
}

/// What is known of a lane apart from its state.
pub(super) struct Lane<M, S> {
    pub(super) scenario: Option<usize>,
    /// The same model by itself: kinks in time and conditions are nobody else's.
    pub(super) model: Option<M>,
    /// The next kink in time, or the end \[s\].
    pub(super) stop: f64,
    /// The same as the lane tells the time, with its derivatives.
    pub(super) stops_at: S,
    /// The next sample.
    pub(super) sample: usize,
    pub(super) steps: u32,
    pub(super) rejected: u32,
    pub(super) searches: u32,
}

/// A batch in progress.
pub(super) struct Run<'a, T: Several, M: Model<T>> {
    pub(super) settings: &'a Settings,
    pub(super) scenarios: &'a mut dyn Scenarios<T::One>,
    pub(super) outputs: Vec<usize>,
    pub(super) parameters: M::Parameters,
    pub(super) model: M,
    pub(super) lanes: Vec<Lane<M::With<f64>, T::One>>,
    pub(super) series: Vec<Series<T::One>>,
    /// The scenario that comes next.
    pub(super) next: usize,
    pub(super) step: Step<T, M::State>,
    pub(super) controllers: Controllers<T::Part>,
    /// What the controller asks for next \[s\].
    pub(super) h: T::Part,
    /// What the tolerances are multiplied by.
    pub(super) level: T::Part,
    /// Of fixed steps.
    pub(super) grid: Grid<T>,
    pub(super) guards: M::Guards,
    /// The outputs that are wanted, at the places that are sampled at once.
    pub(super) found: Vec<[T::One; MOST_LANES]>,
    /// Guards and kinks within steps.
    pub(super) values: Vec<Values<T>>,
    /// Whether jumps of outputs are wanted.
    pub(super) notes_jumps: bool,
}

impl<T: Several, M: Model<T>> Task for Run<'_, T, M> {
    type Output = ();
    #[inline(always)]
    fn run(mut self) {
        while self.refill() {
            self.advance();
        }
    }
}

/// The lanes of a mask, one after the other.
pub(super) fn each(lanes: u32) -> impl Iterator<Item = usize> {
    let mut left = lanes;
    core::iter::from_fn(move || {
        let first = left.trailing_zeros();
        left &= left.wrapping_sub(1);
        (first < u32::BITS).then_some(first as usize)
    })
}

impl<'a, T: Several, M: Model<T>> Run<'a, T, M> {
    #[inline(always)]
    fn new(settings: &'a Settings, scenarios: &'a mut dyn Scenarios<T::One>) -> Self {
        let outputs = scenarios.outputs().to_vec();
        let parameters = M::Parameters::defaults();
        let (model, y) = enabled::begin::<T, M>(parameters.clone());
        let (nought, one) = (T::from_f64(0.0), T::Part::from_f64(1.0));
        let method = settings.pace.method();
        let blank = Series {
            samples: settings.samples,
            values: vec![T::One::from_f64(f64::NAN); settings.samples * outputs.len()],
            events: Vec::new(),
            sides: Vec::new(),
        };
        Run {
            step: Step::new(method, nought, y, M::State::splat(nought)),
            guards: M::Guards::splat(nought),
            lanes: (0..T::LANES)
                .map(|_| Lane {
                    scenario: None,
                    model: None,
                    stop: settings.duration,
                    stops_at: T::One::from_f64(settings.duration),
                    sample: 0,
                    steps: 0,
                    rejected: 0,
                    searches: 0,
                })
                .collect(),
            series: vec![blank; T::LANES],
            next: 0,
            controllers: Controllers::new(),
            h: one,
            level: one,
            grid: Grid::new(),
            found: vec![[T::One::from_f64(0.0); MOST_LANES]; outputs.len()],
            values: vec![[nought; 5]; M::Guards::LEN + M::Kinks::LEN],
            notes_jumps: scenarios.wants_jumps(),
            settings,
            scenarios,
            outputs,
            parameters,
            model,
        }
    }

    /// The lanes that are at work.
    #[inline(always)]
    fn busy(&self) -> u32 {
        let busy = |(i, lane): (usize, &Lane<_, _>)| u32::from(lane.scenario.is_some()) << i;
        self.lanes.iter().enumerate().map(busy).sum()
    }

    /// Gives idle lanes something to do; false when there is nothing left.
    #[inline(always)]
    fn refill(&mut self) -> bool {
        let mut fresh = 0;
        for i in each(!self.busy()).take_while(|i| *i < T::LANES) {
            if self.take_next(i) {
                fresh |= 1 << i;
            }
        }
        if fresh != 0 {
            self.start(T::Mask::of_lanes(fresh));
        }
        self.busy() != 0
    }

    /// Puts the next scenario that can be run into a lane.
    #[inline(always)]
    fn take_next(&mut self, i: usize) -> bool {
        while self.next < self.scenarios.count() {
            let scenario = self.next;
            self.next += 1;
            let mut alone = <M::With<f64> as Model<f64>>::Parameters::defaults();
            let mut index = 0;
            while let Some(all) = self.parameters.get(index) {
                let value = self.scenarios.parameter(scenario, index);
                self.parameters.set(index, all.with_lane(i, value));
                alone.set(index, value.to_f64());
                index += 1;
            }
            let alone = <M::With<f64> as Model<f64>>::new(alone);
            let refused = alone.violated().is_some();
            let lane = &mut self.lanes[i];
            lane.scenario = Some(scenario);
            lane.model = Some(alone);
            lane.sample = 0;
            self.series[i].forget_jumps();
            (lane.steps, lane.rejected, lane.searches) = (0, 0, 0);
            self.find_stop(i, 0.0);
            let level = self.scenarios.level(scenario);
            self.level = with(self.level, i, level);
            if refused {
                self.hand_over(i, Status::Refused, 0.0);
                continue;
            }
            return true;
        }
        false
    }

    /// Begins the runs in these lanes.
    #[inline(always)]
    fn start(&mut self, fresh: T::Mask) {
        let (model, y) = enabled::begin::<T, M>(self.parameters.clone());
        self.model = model;
        let nought = T::from_f64(0.0);
        self.step.t = T::select(fresh, nought, self.step.t);
        self.step.y = select(fresh, &y, &self.step.y);
        self.renew(fresh);
        self.step.latest = self.latest();
        self.controllers.reset(fresh);
        self.rate(fresh);
        self.look(fresh);
        if let Pace::Adaptive(tolerances) = self.settings.pace {
            let largest = self.stops();
            let Step { t, y, k, .. } = &self.step;
            let h = first_step(&self.model, *t, y, &k[0], &tolerances, largest.part(0));
            self.h = T::Part::select(fresh, h, self.h);
        }
        self.count_steps(fresh);
    }

    /// The derivative where a step begins, in these lanes.
    #[inline(always)]
    fn rate(&mut self, lanes: T::Mask) {
        let Step {
            t, latest, y, k, ..
        } = &mut self.step;
        // the last stage is done with
        enabled::rate(&self.model, t.min(*latest), y, &mut k[6]);
        let [first, .., last] = k;
        for i in 0..M::State::LEN {
            first[i] = T::select(lanes, last[i], first[i]);
        }
    }

    /// The guards where a step begins, in these lanes.
    #[inline(always)]
    fn look(&mut self, lanes: T::Mask) {
        if M::Guards::LEN > 0 {
            let guards = enabled::guards(&self.model, self.step.t, &self.step.y);
            self.guards = select(lanes, &guards, &self.guards);
        }
    }

    /// Renews the memory in these lanes until that changes nothing; where anything did.
    #[inline(always)]
    fn renew(&mut self, lanes: T::Mask) -> T::Mask {
        let mut any = T::Mask::of_lanes(0);
        if M::INFO.memory.is_empty() {
            return any;
        }
        for _ in 0..=M::Guards::LEN {
            let renewed = enabled::renewed(&self.model, self.step.t, &self.step.y);
            let mut differs = T::Mask::of_lanes(0);
            for i in 0..M::State::LEN {
                let (new, old) = (renewed[i].part(0), self.step.y[i].part(0));
                differs = differs.or(new.lt(old)).or(old.lt(new));
            }
            let differs = differs.and(lanes);
            self.step.y = select(differs, &renewed, &self.step.y);
            any = any.or(differs);
            if !differs.any() {
                break;
            }
        }
        any
    }

    /// One step in every lane that is at work.
    #[inline(always)]
    fn advance(&mut self) {
        let c = T::Part::from_f64;
        let busy = T::Mask::of_lanes(self.busy());
        let t = self.step.t;
        let stops = self.stops();
        let Reach {
            lands,
            reached,
            length,
        } = self.reach(stops);
        // a lane with nothing to do stands still
        self.step.h = T::select(busy, length, T::from_f64(0.0));
        self.step.take(&self.model);

        let (error, adaptive) = match self.settings.pace {
            Pace::Adaptive(tolerances) => (self.step.error::<M>(&tolerances) / self.level, true),
            Pace::Fixed(_) => (self.finite(), false),
        };
        let finite = error.abs().lt(c(f64::INFINITY));
        let mut accepted = busy.and(finite).and(c(1.0).lt(error).not());
        let mut shorter = c(1.0);
        let mut searched = T::Mask::of_lanes(0);
        if adaptive {
            let part = self.hidden(error, accepted);
            searched = part.lt(c(f64::INFINITY)).and(accepted);
            shorter = T::Part::select(searched, part, shorter);
        }
        accepted = accepted.and(searched.not());
        let rejected = busy.and(accepted.not());

        // how long the next step is to be
        if adaptive {
            let length = self.step.h.part(0);
            let taken = accepted.or(rejected.and(searched.not()));
            let factor = self.controllers.factor(error, accepted, taken);
            let grown = length * factor;
            // a step cut short to meet a kink says little of the next
            let cut = length.lt(self.h);
            let next = T::Part::select(cut, self.h.max(grown), grown);
            let again = T::Part::select(searched, shorter * length, length * factor);
            let next = T::Part::select(accepted, next, again);
            self.h = T::Part::select(busy, next, self.h);
        }
        for i in each(rejected.lanes()) {
            self.turn_down(i, finite.lanes() >> i & 1 != 0);
        }

        // a step ends where a guard changes its sign
        let mut end = enabled::normalized(&self.model, &self.step.end);
        let (Sides { ahead, behind }, whole) = self.place(accepted, reached, &end);
        let reached = T::select(whole, reached, behind * self.step.h + t);
        self.deliver(accepted, whole, reached);
        let broken = whole.not().and(accepted);
        let arrived = accepted.and(whole).and(lands);
        let mut before = None;
        if self.notes_jumps && broken.or(arrived).any() {
            let mut y = end;
            if broken.any() {
                let inside = self.step.inside(&self.model, ahead);
                y = select(broken, &inside, &end);
            }
            let short = ahead * self.step.h + t;
            let t = T::select(broken, short, reached.min(self.step.latest));
            before = Some(self.outputs_at(t, &y));
        }
        if broken.any() {
            let inside = self.step.inside(&self.model, behind);
            end = select(whole, &end, &inside);
        }
        self.step.y = select(accepted, &end, &self.step.y);
        self.step.t = T::select(accepted, reached, t);
        let renewed = self.renew(accepted);
        if let Some(before) = before {
            self.note_jumps(broken.or(arrived), &before);
        }

        // the next step begins where this one ended
        self.grid.advance(accepted);
        for i in each(accepted.lanes()) {
            self.lanes[i].steps += 1;
            self.lanes[i].searches = 0;
        }
        for i in each(arrived.lanes()) {
            self.arrive(i);
        }
        let going = T::Mask::of_lanes(self.busy()).and(accepted);
        if arrived.any() {
            self.step.latest = self.latest();
            self.controllers.reset(arrived);
        }
        let mut unknown = going;
        if self.settings.pace.method().ends_with_its_rate() {
            unknown = arrived.or(renewed).or(whole.not()).and(going);
            let [first, .., last] = &mut self.step.k;
            for i in 0..M::State::LEN {
                first[i] = T::select(accepted, last[i], first[i]);
            }
        }
        if unknown.any() {
            self.rate(unknown);
        }
        self.look(going);
        self.count_steps(arrived.or(whole.not()).and(going));
        for i in each(T::Mask::of_lanes(self.busy()).lanes()) {
            let lane = &self.lanes[i];
            if lane.steps.saturating_add(lane.rejected) >= self.settings.max_steps {
                let t = self.step.t.lane(i).to_f64();
                self.hand_over(i, Status::TooManySteps, t);
            }
        }
    }

    /// 0 where the end of the step is finite, NaN elsewhere.
    #[inline(always)]
    fn finite(&self) -> T::Part {
        let mut sum = T::Part::from_f64(0.0);
        for i in 0..M::State::LEN {
            for part in 0..T::PARTS {
                sum += self.step.end[i].part(part).taint();
            }
        }
        sum
    }

    /// A step was rejected: the run fails where no shorter one is possible.
    #[inline(always)]
    fn turn_down(&mut self, i: usize, finite: bool) {
        self.lanes[i].rejected += 1;
        let t = self.step.t.lane(i).to_f64();
        let h = T::of_part(self.h).lane(i).to_f64();
        let fixed = matches!(self.settings.pace, Pace::Fixed(_));
        // of doubles this is 1
        let coarser = T::EPSILON / f64::EPSILON;
        if fixed || h < (coarser * finest(t)).max(SMALLEST) {
            let status = match finite {
                true => Status::StepTooSmall,
                false => Status::NonFinite,
            };
            self.hand_over(i, status, t);
        }
    }

    /// A lane came to where it had to stop.
    #[inline(always)]
    fn arrive(&mut self, i: usize) {
        let duration = self.settings.duration;
        let t = self.lanes[i].stop;
        if t >= duration {
            self.hand_over(i, Status::Done, duration);
        } else {
            self.find_stop(i, t);
        }
    }

    /// Where a lane stops next, behind a time \[s\].
    #[inline(always)]
    fn find_stop(&mut self, i: usize, t: f64) {
        let duration = self.settings.duration;
        let Some(model) = &self.lanes[i].model else {
            return;
        };
        let stop = next_kink::<f64, M::With<f64>>(model, t, duration);
        let stops_at = match T::PARTS {
            1 => T::One::from_f64(stop),
            _ => next_kink::<T::One, M::With<T::One>>(&self.alone(i), t, duration),
        };
        self.lanes[i].stop = stop;
        self.lanes[i].stops_at = stops_at;
    }

    /// The model of a lane, with the derivatives of its parameters.
    fn alone(&self, i: usize) -> M::With<T::One> {
        let mut parameters = <M::With<T::One> as Model<T::One>>::Parameters::defaults();
        let mut index = 0;
        while let Some(all) = self.parameters.get(index) {
            parameters.set(index, all.lane(i));
            index += 1;
        }
        <M::With<T::One> as Model<T::One>>::new(parameters)
    }

    /// A run is over.
    #[inline(always)]
    fn hand_over(&mut self, i: usize, status: Status, t: f64) {
        let Lane {
            scenario,
            sample,
            steps,
            rejected,
            ..
        } = &mut self.lanes[i];
        let series = &mut self.series[i];
        for samples in series.values.chunks_mut(series.samples) {
            for missing in samples.iter_mut().skip(*sample) {
                *missing = T::One::from_f64(f64::NAN);
            }
        }
        let finite = series.values.iter().all(|value| value.is_finite());
        let status = match status {
            Status::Done if !finite => Status::NonFinite,
            status => status,
        };
        let ended = Ended {
            status,
            t,
            steps: *steps,
            rejected: *rejected,
        };
        if let Some(scenario) = scenario.take() {
            self.scenarios.ended(scenario, &ended, series);
        }
    }
}

/// The first kink of a curve of time after `t`, at most the duration \[s\].
fn next_kink<S: Real, M: Model<S>>(model: &M, t: f64, duration: f64) -> S {
    let passed = M::INFO.breakpoints.partition_point(|kink| *kink <= t);
    let kink = M::INFO.breakpoints.get(passed).copied();
    let kink = S::from_f64(kink.unwrap_or(f64::INFINITY));
    kink.min(model.kink_after(t)).min(S::from_f64(duration))
}

/// Entry by entry.
#[inline(always)]
fn select<T: Several, S: Vector<T>>(mask: T::Mask, then: &S, otherwise: &S) -> S {
    let mut result = *otherwise;
    for i in 0..S::LEN {
        result[i] = T::select(mask, then[i], otherwise[i]);
    }
    result
}

/// The same, with another number in a lane.
#[inline(always)]
fn with<P: Real>(all: P, lane: usize, value: f64) -> P {
    P::select(P::Mask::of_lanes(1 << lane), P::from_f64(value), all)
}
