//! The time loop of a batch: that of a single run ([`crate::simulate`]), with a time and a step for each lane.
//!
//! ```text
//! an idle lane takes the next scenario
//! length of the step ← fixed, or the controller's, cut to meet the next kink in time
//! take it, in all lanes
//!   in which the error is too large, or something is hidden    → again, shorter
//!   in which an event function changed its sign                          → ends there
//! samples, memory of force laws; lanes at the end of their run hand it over
//! ```
//!
//! **Single precision.** Lanes may hold singles. At 0.1 s these resolve 7·10⁻⁹ s, but time does not drift: the length
//! of a step is the difference of the rounded times at its ends, or, with fixed steps, their span over their number.
//! Steps below sixteen times the resolution are refused, and kinks in time are met up to the resolution too early or
//! too late. Singles are meant for tolerances of 10⁻⁴ and more: runs then follow those of doubles, step by step. With
//! far smaller tolerances, rounding is taken for an error of the step, and steps become short.

use super::bend::Bends;
use super::control::{ESTIMATE, Power, first_step};
use super::event::Values;
use super::jump::Sided;
use super::models::Models;
use super::onset::{END_OF_STEP, Onsets};
use super::place::Places;
use super::reach::Grid;
use super::scenario::{Doubt, Ended, Scenarios, Series, Status};
use super::settings::{Pace, Settings};
use super::step::Step;
use super::tolerance::Allowed;
use super::watch::Watch;
use super::{arrays, copies};
use crate::integrate::acceleration::Accelerations;
use crate::integrate::control::Controller;
use crate::model::CurveKind;
use crate::patience::Patience;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several, Task};
use crate::simulate::finest;
use crate::simulate::stuck_events::Standing;
use crate::{Family, Formula, Info, Real, Schedule, Section};

/// Smallest step \[s\].
pub(super) const SMALLEST: f64 = 1e-14;

/// Runs all scenarios with models of a family. The processor must have the instructions of `T`
/// ([`with_width`](crate::real::lanes::with_width)).
pub fn run<T: Several>(
    family: &impl Family,
    settings: &Settings,
    scenarios: &mut dyn Scenarios<T::One>,
) {
    run_models::<T>(Models::of(family), settings, scenarios);
}

/// Runs all scenarios with these models, whatever parameters they have before.
pub(super) fn run_models<T: Several>(
    models: Models<'_, T>,
    settings: &Settings,
    scenarios: &mut dyn Scenarios<T::One>,
) {
    T::dispatch(Run::new(models, settings, scenarios));
}

/// The run in a lane, except for its state.
pub(super) struct Lane<S> {
    pub(super) scenario: Option<usize>,
    /// The next kink in time, or the end \[s\].
    pub(super) stop: f64,
    /// `stop` rounded to the scalar of the lane, with its derivatives.
    pub(super) stops_at: S,
    /// Index of the next sample.
    pub(super) sample: usize,
    pub(super) steps: u32,
    pub(super) rejected: u32,
    pub(super) searches: u32,
    pub(super) standing: Standing,
    /// The limit on the time of computation, counted from the start of the run.
    patience: Patience,
    /// The time of computation when this was last reported \[s\].
    told: f64,
}

impl<S: Real> Lane<S> {
    /// A lane without a scenario, in a batch of this duration \[s\].
    fn idle(duration: f64) -> Self {
        Lane {
            scenario: None,
            stop: duration,
            stops_at: S::from_f64(duration),
            sample: 0,
            steps: 0,
            rejected: 0,
            searches: 0,
            standing: Standing::default(),
            patience: Patience::new(None, [0.0, 0.0]),
            told: 0.0,
        }
    }
}

/// The parameters of all lanes, and workspaces for parameters in other arrangements, in the order of
/// [`Info::parameters`].
pub(super) struct Parameters<T: Several> {
    all: Box<[T]>,
    packed: Box<[T]>,
    /// The lanes whose parameters `packed` holds, if it is up to date.
    packed_lanes: Option<[u8; MOST_LANES]>,
    lane: Box<[f64]>,
    one: Box<[T::One]>,
}

impl<T: Several> Parameters<T> {
    /// The default values in all lanes.
    fn defaults(info: &Info) -> Self {
        let defaults = info.parameters.iter().map(|parameter| parameter.default);
        let all: Box<[T]> = defaults.map(T::from_f64).collect();
        Parameters {
            packed: all.clone(),
            packed_lanes: None,
            lane: copies(0.0, all.len()),
            one: copies(T::One::from_f64(0.0), all.len()),
            all,
        }
    }
}

/// Steps between two calls of [`Scenarios::gives_up`].
pub const STEPS_BETWEEN: u64 = 1024;

/// Steps of all lanes between two checks of the clock.
const TURNS: u32 = 16;
/// Seconds after which a lingering run is reported.
const LINGERS: f64 = 10.0;

/// A batch in progress. All memory is allocated when it begins; only the list of events of a series grows.
pub(super) struct Run<'a, T: Several> {
    pub(super) info: &'a Info<'a>,
    pub(super) settings: &'a Settings,
    pub(super) scenarios: &'a mut dyn Scenarios<T::One>,
    pub(super) outputs: Vec<usize>,
    pub(super) parameters: Parameters<T>,
    pub(super) models: Models<'a, T>,
    pub(super) lanes: Vec<Lane<T::One>>,
    pub(super) series: Vec<Series<T::One>>,
    /// The next scenario.
    pub(super) next: usize,
    pub(super) step: Step<T>,
    /// The state at the kept end of the step, on the manifold; and a second state for renewing memory.
    pub(super) end: Box<[T]>,
    pub(super) renewed: Box<[T]>,
    /// Workspace for the rate just ahead of the end of a step.
    pub(super) ahead: Box<[T]>,
    /// Workspace for the memory ahead of the end of a step.
    pub(super) memory_ahead: Box<[T]>,
    /// Workspace for a state.
    pub(super) state: Box<[T]>,
    /// The error allowed in each entry of a state; empty if steps are fixed.
    pub(super) allowed: Vec<Allowed<T::Part>>,
    pub(super) controller: Controller<T::Part>,
    pub(super) accelerations: Accelerations<T::Part>,
    /// The lanes in whose runs events [tied](Doubt::Tied).
    pub(super) tied: u32,
    /// The lanes in which errors of accelerations are controlled.
    controlled: u32,
    /// Workspace for the powers of all effects, twice.
    pub(super) powers: [Box<[T]>; 2],
    /// Length that the controller wants for the next step \[s\].
    pub(super) h: T::Part,
    /// The factor on the tolerances, or on the length of fixed steps.
    pub(super) level: T::Part,
    /// The grid of fixed steps.
    pub(super) grid: Grid<T>,
    /// The event functions at the start of the previous step, at the start of this one, and at its full end.
    pub(super) event_functions_past: Box<[T]>,
    pub(super) event_functions: Box<[T]>,
    pub(super) event_functions_ahead: Box<[T]>,
    /// Length of the previous step \[s\]; 0 if the motion does not continue smoothly from it.
    pub(super) past: T::Part,
    /// The kink functions at the start of the step, if steps end on kinks.
    pub(super) kinks: Box<[T]>,
    pub(super) onsets: Onsets<T>,
    pub(super) bends: Bends<T>,
    /// The watch, if steps are fixed.
    pub(super) watch: Option<Box<Watch<T>>>,
    /// Steps of all lanes since the last check of the clock.
    turns: u32,
    /// Workspace for event functions or kinks.
    pub(super) after: Box<[T]>,
    /// Workspace for all outputs of the model.
    pub(super) of_model: Box<[T]>,
    /// The requested outputs, at the places that are sampled at once.
    pub(super) found: Vec<[T::One; MOST_LANES]>,
    /// The requested outputs on both sides of an event.
    pub(super) sided: Sided<T::One>,
    /// Workspace for event functions or kinks within steps.
    pub(super) values: Vec<Values<T>>,
    /// Whether jumps of outputs are requested.
    pub(super) notes_jumps: bool,
}

impl<T: Several> Task for Run<'_, T> {
    type Output = ();
    #[inline(always)]
    fn run(mut self) {
        while self.refill() {
            self.advance();
        }
    }
}

/// Iterates over the lanes of a mask.
pub(super) fn each(lanes: u32) -> impl Iterator<Item = usize> {
    let mut left = lanes;
    core::iter::from_fn(move || {
        let first = left.trailing_zeros();
        left &= left.wrapping_sub(1);
        (first < u32::BITS).then_some(first as usize)
    })
}

/// A piece of work of the loop that is compiled as a function of its own, because it is long and called from several
/// places, or rarely.
pub(super) trait Work<T: Several> {
    /// The result.
    type Output;
    /// Does the work. Must be `#[inline(always)]`.
    fn run(self, run: &mut Run<'_, T>) -> Self::Output;
}

struct Apart<'a, 'b, T: Several, S> {
    run: &'a mut Run<'b, T>,
    work: S,
}

impl<T: Several, S: Work<T>> Task for Apart<'_, '_, T, S> {
    type Output = S::Output;
    #[inline(always)]
    fn run(self) -> S::Output {
        self.work.run(self.run)
    }
}

/// [`Run::start`]
struct Start<M>(M);

impl<T: Several> Work<T> for Start<T::Mask> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.start(self.0);
    }
}

impl<'a, T: Several> Run<'a, T> {
    /// Does a piece of work as a function of its own.
    #[inline(always)]
    pub(super) fn apart<S: Work<T>>(&mut self, work: S) -> S::Output {
        T::dispatch_apart(Apart { run: self, work })
    }

    fn new(
        mut models: Models<'a, T>,
        settings: &'a Settings,
        scenarios: &'a mut dyn Scenarios<T::One>,
    ) -> Self {
        let info = models.info;
        let outputs = scenarios.outputs().to_vec();
        let (nought, one) = (T::from_f64(0.0), T::Part::from_f64(1.0));
        let zeros = |count: usize| copies(nought, count);
        let parameters = Parameters::defaults(info);
        let entries = info.state_length();
        let mut step = Step::new(settings.pace.method(), entries);
        // lanes without a scenario stand still at the start
        models.all.set_parameters(&parameters.all);
        models.all.initial_state(&mut step.y);
        models.all.want_outputs(&outputs);
        models.packed.want_outputs(&outputs);
        step.end.copy_from_slice(&step.y);
        let (event_functions, kinks) = (info.event_functions.len(), info.kinks.len());
        let blank = Series {
            samples: settings.samples,
            values: copies(T::One::from_f64(f64::NAN), settings.samples * outputs.len()).into_vec(),
            events: Vec::new(),
            sides: Vec::new(),
        };
        let nothing = || copies([T::One::from_f64(0.0); MOST_LANES], outputs.len());
        Run {
            step,
            end: zeros(entries),
            renewed: zeros(entries),
            ahead: zeros(if T::PARTS > 1 { entries } else { 0 }),
            memory_ahead: zeros(entries - info.varying_length()),
            state: zeros(entries),
            allowed: match &settings.pace {
                Pace::Adaptive(tolerances) => Allowed::of(tolerances, info),
                Pace::Fixed(_) => Vec::new(),
            },
            event_functions_past: zeros(event_functions),
            past: T::Part::from_f64(0.0),
            event_functions: zeros(event_functions),
            event_functions_ahead: zeros(event_functions),
            kinks: zeros(kinks),
            onsets: Onsets::new(info, matches!(settings.pace, Pace::Adaptive(_))),
            bends: Bends::new(info),
            watch: Watch::of(info, &settings.pace, settings.energy_limit),
            turns: 0,
            after: zeros(event_functions.max(kinks)),
            of_model: zeros(info.outputs.len()),
            lanes: (0..T::LANES)
                .map(|_| Lane::idle(settings.duration))
                .collect(),
            series: vec![blank; T::LANES],
            next: 0,
            controller: Controller::new(ESTIMATE),
            accelerations: Accelerations::new(
                Formula::Dopri5,
                match &settings.pace {
                    Pace::Adaptive(tolerances) => tolerances.accelerations,
                    Pace::Fixed(_) => f64::INFINITY,
                },
            ),
            tied: 0,
            controlled: 0,
            powers: arrays(nought, info.powers.len()),
            h: one,
            level: one,
            grid: Grid::new(),
            sided: Sided {
                ahead: nothing(),
                behind: nothing(),
            },
            found: nothing().into_vec(),
            values: copies([nought; 5], event_functions.max(kinks)).into_vec(),
            notes_jumps: scenarios.wants_jumps(),
            info,
            settings,
            scenarios,
            outputs,
            parameters,
            models,
        }
    }

    /// The lanes that have a scenario.
    #[inline(always)]
    pub(super) fn busy(&self) -> u32 {
        let busy = |(i, lane): (usize, &Lane<_>)| u32::from(lane.scenario.is_some()) << i;
        self.lanes.iter().enumerate().map(busy).sum()
    }

    /// Gives idle lanes new scenarios; false when none is left and all lanes are idle.
    #[inline(always)]
    fn refill(&mut self) -> bool {
        let mut fresh = 0;
        for i in each(!self.busy()).take_while(|i| *i < T::LANES) {
            if self.take_next(i) {
                fresh |= 1 << i;
            }
        }
        if fresh != 0 {
            self.apart(Start(T::Mask::of_lanes(fresh)));
        }
        self.busy() != 0
    }

    /// Puts the next scenario that can be run into a lane; false if there is none.
    #[inline(never)]
    fn take_next(&mut self, i: usize) -> bool {
        while self.next < self.scenarios.count() {
            let scenario = self.next;
            self.next += 1;
            self.parameters.packed_lanes = None;
            let Parameters { all, lane, .. } = &mut self.parameters;
            for (index, (all, lane)) in all.iter_mut().zip(lane.iter_mut()).enumerate() {
                let value = self.scenarios.parameter(scenario, index);
                *all = all.with_lane(i, value);
                *lane = value.to_f64();
            }
            let model = &mut self.models.lanes[i];
            model.set_parameters(lane);
            let finite = lane.iter().all(|value| value.is_finite());
            let refused = !finite || model.violated().is_some();
            let lane = &mut self.lanes[i];
            lane.scenario = Some(scenario);
            lane.sample = 0;
            self.series[i].forget_jumps();
            self.bends.forget(i);
            self.onsets.missed[i] = None;
            self.tied &= !(1 << i);
            (lane.steps, lane.rejected, lane.searches) = (0, 0, 0);
            lane.standing.forget();
            lane.patience = Patience::new(self.settings.time_limit, [0.0, self.settings.duration]);
            lane.told = 0.0;
            self.find_stop(i, 0.0);
            let controls = self.scenarios.controls_accelerations(scenario);
            self.controlled = self.controlled & !(1 << i) | u32::from(controls) << i;
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
        self.models.all.set_parameters(&self.parameters.all);
        self.models.all.initial_state(&mut self.state);
        let nought = T::from_f64(0.0);
        self.step.t = T::select(fresh, nought, self.step.t);
        replace(fresh, &mut self.step.y, &self.state);
        self.look_at_begin();
        self.renew(fresh);
        self.step.latest = self.latest();
        self.controller.reset(fresh);
        self.accelerations.reset(fresh);
        self.advance_onsets(fresh);
        replace(
            fresh,
            &mut self.event_functions,
            &self.event_functions_ahead,
        );
        self.past = T::Part::select(fresh, T::Part::from_f64(0.0), self.past);
        self.begin_bends(fresh);
        self.begin_watch(fresh);
        self.rate(fresh);
        if let Pace::Adaptive(_) = self.settings.pace {
            let largest = self.stops();
            let Step { t, y, k, .. } = &self.step;
            let h = first_step(
                &*self.models.all,
                *t,
                (y, &k[0]),
                &self.allowed,
                largest.part(0),
                (&mut self.state, &mut self.end),
            );
            self.h = T::Part::select(fresh, h, self.h);
        }
        self.count_steps(fresh);
    }

    /// Evaluates the derivative at the start of a step, in these lanes.
    #[inline(always)]
    pub(super) fn rate(&mut self, lanes: T::Mask) {
        let Step {
            t, latest, y, k, ..
        } = &mut self.step;
        // the last stage is not needed any more
        let [first, .., last] = k;
        self.models.all.derivative(t.min(*latest), y, last);
        replace(lanes, first, last);
    }

    /// Evaluates event functions, onsets and memory at the states where steps begin.
    #[inline(always)]
    pub(super) fn look_at_begin(&mut self) {
        let memory = self.info.length(Section::Renewed);
        self.models.all.sections(
            self.step.t,
            &self.step.y,
            &mut [
                (Section::EventFunctions, &mut self.event_functions_ahead),
                (Section::Onsets, &mut self.onsets.values[END_OF_STEP]),
                (Section::Renewed, &mut self.renewed[..memory]),
            ],
        );
    }

    /// Evaluates event functions, onsets, memory and arguments of curves at the state in `end`, for steps that end at
    /// the times `t`, if any of these lanes needs it.
    #[inline(always)]
    pub(super) fn look_at_end(&mut self, lanes: T::Mask, t: T) {
        if !lanes.any() {
            return;
        }
        let memory = self.info.length(Section::Renewed);
        self.models.all.sections(
            t,
            &self.end,
            &mut [
                (Section::EventFunctions, &mut self.event_functions_ahead),
                (Section::Onsets, &mut self.onsets.values[END_OF_STEP]),
                (Section::Renewed, &mut self.renewed[..memory]),
                (Section::Curves, &mut self.bends.arguments),
            ],
        );
    }

    /// Takes one step in every lane that has a scenario.
    #[inline(always)]
    fn advance(&mut self) {
        let busy = T::Mask::of_lanes(self.busy());
        let reach = self.reach(self.stops());
        // a lane without a scenario stands still
        self.step.h = T::select(busy, reach.length, T::from_f64(0.0));
        self.step.take(&*self.models.all);
        self.end.copy_from_slice(&self.step.end);
        self.models.all.normalize(&mut self.end);
        let [accepted, easy] = self.judge(busy, reach.reached);
        let landing = self.land(accepted, easy, &reach);
        self.leave(&landing);
        self.give_up();
    }

    /// The lanes in which the step just taken is accepted, and the lanes in which something other than accuracy decides
    /// its length. Sets the length of the next try or the next step.
    #[inline(always)]
    fn judge(&mut self, busy: T::Mask, reached: T) -> [T::Mask; 2] {
        let c = T::Part::from_f64;
        let (mut error, adaptive) = match self.settings.pace {
            Pace::Adaptive(_) => (self.step.error(&self.allowed) / self.level, true),
            Pace::Fixed(_) => (self.finite(), false),
        };
        let finite = error.abs().lt(c(f64::INFINITY));
        let mut accepted = busy.and(finite).and(c(1.0).lt(error).not());
        if adaptive && self.controlled != 0 && self.accelerations.controlled() {
            let looks = accepted.and(T::Mask::of_lanes(self.controlled));
            if looks.any() {
                error = self.with_accelerations(error, looks);
            }
            accepted = accepted.and(c(1.0).lt(error).not());
        }
        let easy = self.is_easy(adaptive.then_some(error));
        self.look_at_end(accepted, reached);
        if adaptive {
            let (searched, shorter) = self.search(accepted, easy);
            accepted = accepted.and(searched.not());
            let length = self.step.h.part(0);
            let factor =
                (self.controller).factor::<Power>(error, accepted, busy.and(searched.not()));
            let grown = length * factor;
            // the length of a step cut short to meet a kink says little about the next one
            let cut = length.lt(self.h);
            let next = T::Part::select(cut, self.h.max(grown), grown);
            let again = T::Part::select(searched, shorter * length, length * factor);
            let next = T::Part::select(accepted, next, again);
            self.h = T::Part::select(busy, next, self.h);
        } else {
            self.tell_missed(accepted);
        }
        for i in each(busy.and(accepted.not()).lanes()) {
            self.turn_down(i, finite.lanes() >> i & 1 != 0);
        }
        [accepted, easy]
    }

    /// The lanes in which something is hidden in the step, so that it is to be taken again, and the part of it to take.
    #[inline(always)]
    fn search(&mut self, accepted: T::Mask, easy: T::Mask) -> (T::Mask, T::Part) {
        let c = T::Part::from_f64;
        let part = self.hidden(easy, accepted);
        let hidden = part.lt(c(f64::INFINITY)).and(accepted);
        let shorter = T::Part::select(hidden, part, c(1.0));
        let left = accepted.and(hidden.not());
        let part = self.stepped_over(left);
        let smallest = c(SMALLEST).max(c(2.0 * T::EPSILON) * self.step.t.part(0));
        let over = part.lt(c(1.0 - 1e-6));
        let over = (over.and(smallest.lt(part * self.step.h.part(0)))).and(left);
        (hidden.or(over), T::Part::select(over, part, shorter))
    }

    /// Gives up runs that take too many steps, or too much time.
    #[inline(always)]
    fn give_up(&mut self) {
        self.turns += 1;
        let look = self.turns >= TURNS;
        if look {
            self.turns = 0;
        }
        for i in each(T::Mask::of_lanes(self.busy()).lanes()) {
            if look {
                self.look_at_clock(i);
            }
            let lane = &self.lanes[i];
            let steps = lane.steps.saturating_add(lane.rejected);
            let asked = u64::from(steps).is_multiple_of(STEPS_BETWEEN);
            let scenario = lane.scenario.filter(|_| asked);
            let given_up =
                scenario.is_some_and(|scenario| self.scenarios.gives_up(scenario, steps.into()));
            if steps >= self.settings.max_steps || given_up {
                let t = self.step.t.lane(i).to_f64();
                self.hand_over(i, Status::TooManySteps, t);
            }
        }
    }

    /// Gives up the run of a lane that takes too much time, and reports one that takes long.
    #[inline(never)]
    fn look_at_clock(&mut self, i: usize) {
        let t = self.step.t.lane(i).to_f64();
        let lane = &mut self.lanes[i];
        let Some(scenario) = lane.scenario else {
            return;
        };
        if lane.patience.ends_at(t) {
            self.hand_over(i, Status::Slow, t);
            return;
        }
        let elapsed = lane.patience.elapsed();
        if elapsed > lane.told + LINGERS {
            lane.told = elapsed;
            self.scenarios.lingers(scenario, elapsed, t);
        }
    }

    /// 0 in lanes where the end of the step is finite, NaN elsewhere.
    #[inline(always)]
    fn finite(&self) -> T::Part {
        let mut sum = T::Part::from_f64(0.0);
        for entry in &self.step.end {
            for part in 0..T::PARTS {
                sum += entry.part(part).taint();
            }
        }
        sum
    }

    /// Counts a rejected step in a lane; the run fails if no shorter step is possible.
    #[inline(always)]
    fn turn_down(&mut self, i: usize, finite: bool) {
        self.lanes[i].rejected += 1;
        let t = self.step.t.lane(i).to_f64();
        let h = T::of_part(self.h).lane(i).to_f64();
        let fixed = matches!(self.settings.pace, Pace::Fixed(_));
        // 1 for doubles
        let coarser = T::EPSILON / f64::EPSILON;
        if fixed || h < (coarser * finest(t)).max(SMALLEST) {
            let status = match finite {
                true => Status::StepTooSmall,
                false => Status::NonFinite,
            };
            self.hand_over(i, status, t);
        }
    }

    /// Ends the run of a lane that has reached its stop, or finds the next stop.
    #[inline(always)]
    pub(super) fn arrive(&mut self, i: usize) {
        let duration = self.settings.duration;
        let t = self.lanes[i].stop;
        if t >= duration {
            self.hand_over(i, Status::Done, duration);
        } else {
            self.find_stop(i, t);
        }
    }

    /// Finds the next stop of a lane after a time \[s\].
    #[inline(never)]
    fn find_stop(&mut self, i: usize, t: f64) {
        let duration = self.settings.duration;
        let stop = next_kink(self.info, &*self.models.lanes[i], t, duration);
        let mut stops_at = T::One::from_f64(stop);
        if let Some(model) = &mut self.models.one {
            let Parameters { all, one, .. } = &mut self.parameters;
            for (one, all) in one.iter_mut().zip(all.iter()) {
                *one = all.lane(i);
            }
            model.set_parameters(one);
            stops_at = next_kink(self.info, &**model, t, duration);
        }
        self.lanes[i].stop = stop;
        self.lanes[i].stops_at = stops_at;
    }

    /// The permutation of lanes to the given places; the model in `packed` gets parameters in that order.
    #[inline(always)]
    pub(super) fn pack<X: Copy>(&mut self, places: &mut Places<X>) -> T::Order {
        let order = places.pack::<T>();
        let lanes = Some(*places.lanes());
        let parameters = &mut self.parameters;
        if parameters.packed_lanes != lanes {
            parameters.packed_lanes = lanes;
            let Parameters { all, packed, .. } = parameters;
            for (packed, all) in packed.iter_mut().zip(all.iter()) {
                *packed = all.ordered(order);
            }
            self.models.packed.set_parameters(packed);
        }
        order
    }

    /// Ends the run in a lane and hands over its results.
    #[inline(never)]
    fn hand_over(&mut self, i: usize, status: Status, t: f64) {
        let step = T::of_part(self.h).lane(i).to_f64();
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
        // without an early exit, so that the compiler can check several values at once
        let mut finite = true;
        for value in &series.values {
            finite &= value.is_finite();
        }
        let bent = self.bends.leapt[i].map(|index| match self.info.curves[index].kind {
            CurveKind::Direction(_) if !self.info.curves[index].is_of_bushing() => {
                Doubt::Sunk(index)
            }
            _ => Doubt::Bent(index),
        });
        let missed = self.onsets.missed[i].map(Doubt::Missed);
        let left = self.bends.left[i].map(Doubt::Left);
        let (unstable, balance) = match &self.watch {
            Some(watch) => {
                let unstable = watch.unstable(i, status != Status::Done || !finite);
                let unstable = unstable.map(|found| Doubt::Unstable(found.index));
                let momentum = watch.momentum(i).then_some(Doubt::Momentum);
                let errs = watch.error(i).map(Doubt::Error);
                let energy = watch.energy(i).map(Doubt::Energy);
                (unstable, energy.or(momentum).or(errs))
            }
            None => (None, None),
        };
        let tied = (self.tied >> i & 1 != 0).then_some(Doubt::Tied);
        let doubt = unstable.or(bent).or(missed).or(left).or(balance).or(tied);
        let status = match status {
            Status::Done if !finite => Status::NonFinite,
            Status::Done if doubt.is_some() => Status::Doubtful,
            status => status,
        };
        let ended = Ended {
            status,
            t,
            steps: *steps,
            rejected: *rejected,
            step,
            doubt,
        };
        if let Some(scenario) = scenario.take() {
            self.scenarios.ended(scenario, &ended, series);
        }
    }
}

/// The first kink of a curve of time after `t`, at most the duration \[s\].
fn next_kink<S: Real>(info: &Info, model: &dyn Schedule<S>, t: f64, duration: f64) -> S {
    let passed = info.breakpoints.partition_point(|kink| *kink <= t);
    let kink = info.breakpoints.get(passed).copied();
    let kink = S::from_f64(kink.unwrap_or(f64::INFINITY));
    // a user force must be evaluated once per sample at least
    let sample = match info.longest_step.is_finite() {
        true => ((t / info.every + 1e-9).floor() + 1.0) * info.every,
        false => f64::INFINITY,
    };
    let last = S::from_f64(duration.min(sample));
    kink.min(model.kink_after(t)).min(last)
}

/// Replaces the entries of a state in the lanes of a mask.
#[inline(always)]
pub(super) fn replace<T: Several>(lanes: T::Mask, old: &mut [T], new: &[T]) {
    for (old, new) in old.iter_mut().zip(new) {
        *old = T::select(lanes, *new, *old);
    }
}

/// Numbers with the entry of one lane replaced.
#[inline(always)]
fn with<P: Real>(all: P, lane: usize, value: f64) -> P {
    P::select(P::Mask::of_lanes(1 << lane), P::from_f64(value), all)
}
