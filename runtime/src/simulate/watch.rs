//! The watch of a run: after every step it compares what must agree if the results can be trusted.
//!
//! | what | compared | with |
//! |---|---|---|
//! | energy | \|T(t) − T(0) − Σ W\| | the limit · the largest energy so far, kinetic or exchanged by an effect |
//! | momentum of freely moving bodies | \|p(t) − p(0) − ∫ F dt\|, and that about the origin | the limit · the largest momentum possible at this kinetic energy |
//! | velocities, if steps are fixed | the estimate of their error ([`error`]) | 2.5 times the limit · the largest speed |
//! | coordinates, if steps are fixed | the same | 2.5 times the limit · the largest way from the start |
//! | fixed step | h \|λ\| of the fastest motion | the method's limit of stability |
//! | curves of the state, while their force acts | how far the argument is outside of the points | the interval in which the curve means something |
//! | flexion beyond 90° | by how much the direction of bending leaps | a quarter turn |
//! | bushings beyond 60° about y | by how much the angle about x leaps | a quarter turn |
//! | two ellipsoids that push each other | by how much the direction of the force leaps | a quarter turn |
//!
//! Each disagreement becomes a [`Diagnostic`], which has the words.
//!
//! **Scales.** The largest energy so far is the scale of energy. The sum of all exchanged energies would be no good
//! scale: a pendulum exchanges its energy four times a period, so a small but steady loss would never count. By Cauchy
//! and Schwarz, masses m (moments of inertia I) of the kinetic energy T have at most the momentum √(2 T m) and, about
//! the origin, √(2 T I). A gap that the tolerance explains does not count. With e the kinetic energy of velocities as
//! large as their absolute tolerance, a step may change √T by √e, and the work at kinetic energies below e is not
//! resolved.
//!
//! **A gap is forgotten** when the energy that comes later is so large that the gap is within the limit: at the start
//! there is nothing to compare with.
//!
//! **A flexion through 180°** makes the direction of bending leap by half a turn in no time, and the forces in this
//! direction leap with it. A motion that passes beside 180° turns the direction fast, but continuously. To tell the two
//! apart, the part of the step that has the leap is halved on the step's interpolant until the leap is gone, or the
//! part is a thousandth of the step.
//!
//! **Two ellipsoids that sink through each other** suddenly push in the opposite direction: the direction of least
//! overlap leaps. Bodies that pass each other turn this direction continuously, however deep they overlap. Where the
//! centres coincide there is no direction at all. A step is halved, as above, if the direction differs between its ends
//! or exists at one of them only.
//!
//! **The fastest motion** (Hairer & Wanner, *Solving ODEs II*, IV.2): where a step is unstable, its error soon consists
//! of the fastest motion alone, and so does the difference of two states a, b that are computed for the same time. Then
//! ‖f(a) − f(b)‖/‖a − b‖ is |λ|. The geometric mean of this ratio over coordinates and over velocities is |λ| for an
//! oscillation, too, whatever its phase and whatever the units.

pub(crate) mod account;
pub(crate) mod error;

use super::balance::{NODES, Quadrature, exchange};
use super::event::inside;
use super::time_loop::epsilon_of;
use super::{Balance, Buffer, Diagnostic, Pace, Problem, Settings};
use crate::failure::Reason;
use crate::integrate::workspace::Workspace;
use crate::integrate::{Evaluator, Stepper};
use crate::leap::Turning;
use crate::model::{CurveInfo, CurveKind};
use crate::real::mapped;
use crate::{Dynamics, Formula, Info, Real, Section, StateKind};
use account::{Account, Energies, Entry, Stability, rate_squared};
use error::{Errors, Estimated, over_halves};

/// The default of the share of the energy that may be missing: 2 %.
///
/// An error of 1 % in a velocity is an error of 2 % in the energy. The default tolerance keeps it well below a
/// thousandth (docs/accuracy.md). Crash simulations with finite elements usually accept 10 % over a run (NCHRP Web-Only
/// Document 179, 2010).
pub const ENERGY_LIMIT: f64 = 0.02;

/// A curve whose argument left its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Left {
    /// The curve, an index in [`Info::curves`].
    pub curve: usize,
    /// The time when the argument left the points first \[s\].
    pub since: f64,
    /// The argument that was farthest outside.
    pub argument: f64,
}

impl Left {
    /// Whether the value of the curve there is made up: a straight line extends over more than the whole width of the
    /// points, or a value other than 0 is held though the model does not ask for it.
    pub fn made_up(&self, info: &Info) -> bool {
        let curve = info.curves.get(self.curve);
        curve.is_some_and(|curve| {
            let [from, to] = curve.trusted();
            self.argument < from || to < self.argument
        })
    }
}

/// The watch of a run: what it compares step by step, and what it found. It borrows the facts of the model.
#[derive(Debug)]
pub struct Watch<'a, T: Real> {
    info: &'a Info<'a>,
    /// The balances of energy and momentum.
    pub balance: Balance<'a, T>,
    account: Account,
    /// The effect whose power was largest when the gap in the energy began.
    effect: Option<usize>,
    /// The entries of the state that were fastest when the gaps in energy and in momentum began.
    fastest: [Option<usize>; 2],
    errors: Errors,
    stability: Stability,
    /// The method, if steps are fixed and so may be above its limit of stability.
    fixed: Option<Formula>,
    /// The first event that a fixed step passed over: its time and its index; and how many steps passed over an event.
    missed: Option<(f64, usize, u64)>,
    /// Whether the run ended in numbers that are not finite.
    failed: bool,
    /// For each curve of the state, the time when its argument left the points; for each bearing or direction, the time
    /// when it leapt. NaN if this never happened.
    since: Buffer<'a, T>,
    /// For each curve of the state, the argument that was farthest outside; for each bearing or direction, its entry at
    /// the start of the step.
    farthest: Buffer<'a, T>,
    /// The arguments of the curves of the state.
    arguments: Buffer<'a, T>,
    /// The arguments at three places within a step.
    within: Buffer<'a, T>,
    /// The powers of all effects, node by node of a step. The first node is the beginning of the step, the last is its
    /// end.
    powers: Buffer<'a, T>,
    /// The smallest value of each event function at the ends of steps.
    nearest: Buffer<'a, T>,
    /// The state at the start.
    start: Buffer<'a, T>,
    /// The difference of each entry of the state from the solution in steps half as long.
    error: Buffer<'a, T>,
    /// Workspace for a derivative.
    rates: Buffer<'a, T>,
    /// Whether the model has coordinates that change their charts, and whether they may have changed in the last step.
    charts: [bool; 2],
    /// The external wrench on the freely moving bodies, at each node of a step.
    external_wrenches: [[T; 6]; NODES],
    /// Kinetic energy and momentum at the end of the step.
    kinetic_ahead: T,
    momentum_ahead: [T; 6],
    /// The quadrature rule over the nodes.
    rule: Quadrature,
    /// The works of effects over time, if they are requested.
    #[cfg(feature = "std")]
    pub history: Option<History>,
}

/// The works of effects over time, at the ends of steps.
#[cfg(feature = "std")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Least time between two entries \[s\].
    pub every: f64,
    /// The times of the entries \[s\].
    pub times: std::vec::Vec<f64>,
    /// Work of each effect up to each of the times \[J\].
    pub works: std::vec::Vec<std::vec::Vec<f64>>,
}

#[cfg(feature = "std")]
impl History {
    /// Adds an entry, if the last one is long enough ago.
    fn note<T: Real>(&mut self, t: f64, works: &[T]) {
        if self.times.last().is_none_or(|last| t >= last + self.every) {
            self.times.push(t);
            self.works
                .push(works.iter().map(|work| work.to_f64()).collect());
        }
    }
}

#[cfg(feature = "std")]
impl<'a, T: Real> Watch<'a, T> {
    /// A watch for one run of this model ([`Model::INFO`](crate::Model::INFO)). `limit` is the share of energy and
    /// momentum that may be missing. The watch allocates its memory here.
    pub fn new(info: &'a Info<'a>, limit: f64) -> Self {
        let buffer = |length| Buffer::Owned(std::vec![T::from_f64(0.0); length]);
        Watch::with(info, limit, buffer)
    }
}

impl<'a, T: Real> Watch<'a, T> {
    /// [`Watch::new`] in the given memory, of at least [`Watch::length`] scalars with any values.
    ///
    /// # Panics
    /// If the memory is too short.
    pub fn within(info: &'a Info<'a>, limit: f64, memory: &'a mut [T]) -> Self {
        let mut workspace = Workspace::new(memory);
        Watch::with(info, limit, |length| Buffer::Lent(workspace.part(length)))
    }

    /// The number of scalars that the watch of a model keeps.
    pub const fn length(info: &Info) -> usize {
        (1 + NODES) * info.powers.len()
            + 6 * info.curves.len()
            + 3 * info.state_length()
            + info.event_functions.len()
    }

    /// A watch for one run. `memory` gives a buffer of the length that it is called with.
    fn with(
        info: &'a Info<'a>,
        limit: f64,
        mut memory: impl FnMut(usize) -> Buffer<'a, T>,
    ) -> Self {
        let (powers, curves) = (info.powers.len(), info.curves.len());
        let [mut since, mut farthest] = [memory(curves), memory(curves)];
        let mut nearest = memory(info.event_functions.len());
        nearest.fill(T::from_f64(f64::INFINITY));
        since.fill(T::from_f64(f64::NAN));
        farthest.fill(T::from_f64(f64::NAN));
        Watch {
            info,
            balance: Balance::new(memory(powers)),
            account: Account::new(limit),
            effect: None,
            fastest: [None; 2],
            errors: Errors::new(limit),
            stability: Stability::NONE,
            fixed: None,
            missed: None,
            failed: false,
            since,
            farthest,
            arguments: memory(curves),
            within: memory(3 * curves),
            powers: memory(NODES * powers),
            nearest,
            start: memory(info.state_length()),
            error: memory(info.state_length()),
            rates: memory(info.state_length()),
            charts: [
                info.memory.iter().any(|name| name.ends_with(": chart")),
                false,
            ],
            external_wrenches: [[T::from_f64(0.0); 6]; NODES],
            kinetic_ahead: T::from_f64(0.0),
            momentum_ahead: [T::from_f64(0.0); 6],
            rule: Quadrature::Degree5,
            #[cfg(feature = "std")]
            history: None,
        }
    }

    /// The watched model.
    pub fn info(&self) -> &'a Info<'a> {
        self.info
    }

    /// Whether the watched model has as many effects, curves and entries of the state as this one.
    pub(super) fn fits(&self, info: &Info) -> bool {
        let lengths = |info: &Info| {
            (
                info.powers.len(),
                info.curves.len(),
                info.state_length(),
                info.event_functions.len(),
            )
        };
        lengths(self.info) == lengths(info)
    }

    /// Why the run cannot be trusted. Causes come before their consequences.
    pub fn diagnostics(&self) -> impl Iterator<Item = Diagnostic<'a>> + '_ {
        let curve = self.left().filter(|left| left.made_up(self.info));
        let curve = curve.map(|left| {
            let Left {
                curve, argument, ..
            } = left;
            (left.since, Problem::Curve { curve, argument })
        });
        let missed = (self.missed).map(|(t, onset, steps)| (t, Problem::Missed { onset, steps }));
        let energy = self.account.energy().map(|(since, share)| {
            let problem = Problem::Energy {
                share,
                effect: self.effect,
                index: self.fastest[0],
            };
            (since, problem)
        });
        let bearings = self.info.curves.iter().enumerate();
        let flexions = bearings.filter_map(|(bearing, curve)| {
            let since = self.since[bearing].to_f64();
            if since.is_nan() || self.follows(curve, since) {
                return None;
            }
            let problem = match curve.kind {
                CurveKind::Curve | CurveKind::Volume | CurveKind::Edge => return None,
                CurveKind::Bearing | CurveKind::HalfTurn => Problem::Flexion { bearing },
                CurveKind::Direction(_) if curve.is_of_bushing() => Problem::Flexion { bearing },
                CurveKind::Direction(_) => Problem::Sunk { contact: bearing },
            };
            Some((since, problem))
        });
        let momentum = self.account.momentum().map(|(since, share)| {
            let index = self.fastest[1];
            (since, Problem::Momentum { share, index })
        });
        let found = self.step().into_iter().chain(missed).chain(curve);
        let found = found.chain(flexions).chain(energy);
        let errors = self.errors.found();
        let errors = errors.map(|(since, index)| (since, Problem::Error { index }));
        found
            .chain(momentum)
            .chain(errors)
            .map(|(t, problem)| Diagnostic {
                t,
                problem,
                info: self.info,
            })
    }

    /// Whether an angle leapt in the step from `since` because the bearing of its law did.
    fn follows(&self, angle: &CurveInfo, since: f64) -> bool {
        let mut others = self.info.curves.iter().zip(&*self.since);
        others.any(|(other, leapt)| leapt.to_f64() == since && angle.leaps_with(other))
    }

    /// Notes that a fixed step from `t` passed over an event.
    pub(super) fn step_over(&mut self, t: f64, onset: usize) {
        let (.., steps) = self.missed.get_or_insert((t, onset, 0));
        *steps += 1;
    }

    /// Notes the event functions at the end of a step.
    pub(super) fn look_at_event_functions(&mut self, values: &[T]) {
        for (nearest, value) in self.nearest.iter_mut().zip(values) {
            *nearest = nearest.min(*value);
        }
    }

    /// The smallest value of an event function at the start and at the ends of steps; infinite before the run.
    pub fn nearest(&self, event_function: usize) -> Option<f64> {
        self.nearest.get(event_function).map(|value| value.to_f64())
    }

    /// The curves of the state whose arguments left their points.
    pub fn left(&self) -> impl Iterator<Item = Left> + '_ {
        (0..self.info.curves.len()).filter_map(|curve| {
            let (since, argument) = (self.since[curve].to_f64(), self.farthest[curve].to_f64());
            let left = Left {
                curve,
                since,
                argument,
            };
            (!since.is_nan() && self.info.curves[curve].kind.may_be_left()).then_some(left)
        })
    }

    /// Begins to watch a run at its start. The last argument is room for two states.
    pub(super) fn open(
        &mut self,
        model: &dyn Dynamics<T>,
        y: &[T],
        settings: &Settings,
        [slow, fast]: [&mut [T]; 2],
    ) {
        let (info, start) = (self.info, T::from_f64(settings.start));
        let energy = |y: &[T]| model.kinetic_energy(start, y).to_f64();
        // the kinetic energy of velocities of a certain size, less that of prescribed motions
        let mut moving = |size: &dyn Fn(StateKind) -> f64| {
            slow.copy_from_slice(y);
            fast.copy_from_slice(y);
            for i in info.coordinates.len()..y.len() {
                let kind = info.kind(i);
                if matches!(kind, StateKind::Velocity | StateKind::AngularVelocity) {
                    (slow[i], fast[i]) = (T::from_f64(0.0), T::from_f64(size(kind)));
                }
            }
            (energy(fast) - energy(slow)).max(0.0)
        };
        let tolerated = match settings.method.pace {
            Pace::Fixed(_) => {
                self.fixed = Some(settings.method.formula);
                0.0
            }
            Pace::Adaptive(adaptive) => {
                self.rule = Quadrature::of(settings.method.formula);
                let tolerances = adaptive.tolerances;
                moving(&|kind| match kind {
                    StateKind::Velocity => tolerances.velocities,
                    _ => tolerances.angular_velocities,
                })
            }
        };
        self.start.copy_from_slice(y);
        self.error.fill(T::from_f64(0.0));
        self.balance.start = model.kinetic_energy(start, y);
        self.balance.end = self.balance.start;
        self.account.open(self.balance.start.to_f64(), tolerated);
        if info.free {
            let momentum = &mut self.balance.momentum;
            momentum.start = model.momentum(start, y);
            momentum.end = momentum.start;
            let both = [StateKind::Velocity, StateKind::AngularVelocity];
            let of_one = mapped(both, |wanted| {
                moving(&|kind| if kind == wanted { 1.0 } else { 0.0 })
            });
            self.account.weigh_at_start(info.dimension, of_one);
        }
        self.begin(model, settings.start, y);
        if !info.curves.is_empty() {
            model.curves(start, y, &mut self.arguments);
            self.look_at_curves(settings.start);
        }
    }

    /// Evaluates the powers at the start of a step, at `t` and `y`, if they differ from those at the end of the
    /// previous step.
    pub(super) fn begin(&mut self, model: &dyn Dynamics<T>, t: f64, y: &[T]) {
        let powers = &mut self.powers[..self.info.powers.len()];
        exchange(
            model,
            (T::from_f64(t), y),
            powers,
            &mut self.external_wrenches[0],
        );
    }

    /// Notes a discrete update at the end of a step that began at `before`. The next step begins with the values that
    /// [`Watch::arrival`] received last.
    pub(super) fn renew(&mut self, before: f64) {
        self.charts[1] = self.charts[0];
        self.advance();
        self.look_at_curves(before);
    }

    /// The next step begins where this one ended.
    fn advance(&mut self) {
        let last = NODES - 1;
        self.powers.copy_within(last * self.info.powers.len().., 0);
        self.external_wrenches[0] = self.external_wrenches[last];
    }

    /// The sections that a watch needs at the end of a step, before a kink there and before the discrete update, each
    /// with the place that receives it.
    pub(super) fn arrival(&mut self) -> [(Section, &mut [T]); 5] {
        let (last, six) = (NODES - 1, self.info.length(Section::Momentum));
        let powers = &mut self.powers[last * self.info.powers.len()..];
        [
            (Section::Curves, &mut self.arguments),
            (
                Section::KineticEnergy,
                core::slice::from_mut(&mut self.kinetic_ahead),
            ),
            (Section::Powers, powers),
            (Section::Momentum, &mut self.momentum_ahead[..six]),
            (
                Section::ExternalWrench,
                &mut self.external_wrenches[last][..six],
            ),
        ]
    }

    /// Adds the work of a step, or of its first part of the given length, whose end has been evaluated
    /// ([`Watch::arrival`]). Returns the kinetic energy before the step and the energy exchanged in it \[J\]. `state`
    /// is room for a state.
    pub(super) fn add_work(
        &mut self,
        model: &dyn Dynamics<T>,
        step: &dyn Stepper<T>,
        length: f64,
        state: &mut [T],
    ) -> [f64; 2] {
        let before = self.balance.exchanged;
        let kinetic = core::mem::replace(&mut self.balance.end, self.kinetic_ahead);
        self.balance.momentum.end = self.momentum_ahead;
        let effects = self.info.powers.len();
        let span = step.span();
        let part = length / span.h;
        self.look_at_bearings(model, step, part, state);
        for (node, x) in self.rule.inner() {
            inside(model, step, x * part, state);
            let t = T::from_f64(span.t + x * length);
            let powers = &mut self.powers[node * effects..][..effects];
            exchange(model, (t, state), powers, &mut self.external_wrenches[node]);
        }
        if self.info.free {
            self.balance
                .push(self.rule, length, &self.external_wrenches);
        }
        self.balance.add(self.rule, length, &self.powers);
        #[cfg(feature = "std")]
        if let Some(history) = &mut self.history {
            history.note(span.t + length, &self.balance.works);
        }
        [kinetic.to_f64(), (self.balance.exchanged - before).to_f64()]
    }

    /// Continues the error estimate over a step of this length, which ended at `y`. It overwrites the step. `state` is
    /// room for a state.
    pub(super) fn estimate_error(
        &mut self,
        step: &mut dyn Stepper<T>,
        f: &mut Evaluator<'_, T>,
        length: f64,
        y: &[T],
        state: &mut [T],
    ) {
        let Some(formula) = self.fixed else {
            return;
        };
        let integrated = self.info.varying_length();
        let t = step.span().t;
        if core::mem::take(&mut self.charts[1]) {
            // the coordinates may be those of another chart
            self.error.fill(T::from_f64(0.0));
            return;
        }
        state.copy_from_slice(step.span().y);
        for (state, error) in state.iter_mut().zip(&self.error[..integrated]) {
            *state = *state - *error;
        }
        f.model.normalize(state);
        let counts = (f.count, f.jacobians);
        let taken = self.step_twice(step, f, [t, length], state);
        (f.count, f.jacobians) = counts;
        if taken.is_err() {
            return;
        }
        for (i, error) in self.error.iter_mut().enumerate().take(integrated) {
            *error = y[i] - state[i];
        }
        let coordinates = self.info.coordinates.len();
        let over = over_halves(formula.order());
        let entry = |i: usize| Estimated {
            size: match i < coordinates {
                true => (y[i] - self.start[i]).to_f64(),
                false => y[i].to_f64(),
            },
            error: over * self.error[i].to_f64(),
        };
        self.errors.observe(t, self.info, entry);
    }

    /// The estimated error of an entry of the state at the end of a run in fixed steps, for tests.
    #[doc(hidden)]
    pub fn error_of_entry(&self, index: usize) -> Option<f64> {
        let over = over_halves(self.fixed?.order());
        Some(over * self.error[index].to_f64())
    }

    /// Integrates a state from `t` over `length` in two steps.
    fn step_twice(
        &mut self,
        step: &mut dyn Stepper<T>,
        f: &mut Evaluator<'_, T>,
        [t, length]: [f64; 2],
        state: &mut [T],
    ) -> Result<(), Reason> {
        let half = 0.5 * length;
        f.at(t, state, &mut self.rates);
        step.begin(t, state, &self.rates);
        step.take(f, half)?;
        state.copy_from_slice(step.span().end);
        f.model.normalize(state);
        match step.end_rate() {
            // normalizing a state moves it by no more than the error of the step
            Some(rate) => self.rates.copy_from_slice(rate),
            None => f.at(t + half, state, &mut self.rates),
        }
        step.begin(t + half, state, &self.rates);
        step.take(f, half)?;
        state.copy_from_slice(step.span().end);
        f.model.normalize(state);
        Ok(())
    }

    /// Closes a step that began at `t` and ended at `y`, after [`Watch::add_work`]. The last argument has the kinetic
    /// energy at its beginning and the energy that was exchanged in it \[J\]. The next step begins with the powers that
    /// this one ended with.
    pub(super) fn close(&mut self, t: f64, y: &[T], [before, exchanged]: [f64; 2]) {
        let effects = self.info.powers.len();
        let energies = Energies {
            kinetic: [before, self.balance.end.to_f64()],
            exchanged,
            // a model without effects has no balance of energy
            gap: match effects {
                0 => 0.0,
                _ => self.balance.gap().abs().to_f64(),
            },
        };
        self.advance();
        let works = self.balance.works.iter().map(|work| work.to_f64());
        if self.account.close(t, energies, works) {
            self.effect = largest(self.powers[..effects].iter().copied());
            self.fastest[0] = fastest(self.info, y);
        }
        if self.info.free {
            self.weigh(t, y);
        }
        self.look_at_curves(t);
    }

    /// The balance of momentum at the end of a step that began at `t`.
    fn weigh(&mut self, t: f64, y: &[T]) {
        let places = (0..self.info.coordinates.len())
            .filter(|&i| self.info.kinds.get(i) == Some(&StateKind::Position));
        let distance = places.map(|i| y[i].to_f64() * y[i].to_f64()).sum();
        let momentum = &self.balance.momentum;
        let size = [momentum.size(), f64::EPSILON];
        if self.account.weigh(t, momentum.missing(), size, distance) {
            self.fastest[1] = fastest(self.info, y);
        }
    }

    /// Notes which arguments are outside of the points of their curves at the end of a step that began at `t`.
    fn look_at_curves(&mut self, t: f64) {
        for (i, curve) in self.info.curves.iter().enumerate() {
            if !curve.kind.may_be_left() {
                self.farthest[i] = self.arguments[i];
                continue;
            }
            let (argument, farthest) = (self.arguments[i].to_f64(), self.farthest[i].to_f64());
            let beyond = curve.beyond(argument);
            if beyond > 0.0 {
                if self.since[i].to_f64().is_nan() {
                    self.since[i] = T::from_f64(t);
                }
                if farthest.is_nan() || beyond > curve.beyond(farthest) {
                    self.farthest[i] = self.arguments[i];
                }
            }
        }
    }

    /// Looks for leaps of bearings and directions in the first `part` of a step. `state` is room for a state.
    fn look_at_bearings(
        &mut self,
        model: &dyn Dynamics<T>,
        step: &dyn Stepper<T>,
        part: f64,
        state: &mut [T],
    ) {
        let info = self.info;
        let span = step.span();
        let entries = |of: &[T], i: usize, count: usize| turning(&of[i..][..count]);
        let mut suspected = false;
        for (i, curve) in info.curves.iter().enumerate() {
            if let Some(count) = curve.turning(info.dimension) {
                let ends = [
                    entries(&self.farthest, i, count),
                    entries(&self.arguments, i, count),
                ];
                suspected |= match curve.kind {
                    // A joint may pass its singular position and come back within one step. If it is far from this
                    // position at both ends, this is possible in a fixed step only: otherwise the error would be too
                    // large.
                    CurveKind::Bearing => {
                        self.fixed.is_some() || ends.iter().any(|end| end[0] < curve.last)
                    }
                    _ => curve.may_leap(ends),
                };
            }
        }
        if !suspected {
            return;
        }
        let mut look = |place: f64, arguments: &mut [T]| {
            inside(model, step, part * place, state);
            let t = span.t + part * place * span.h;
            model.curves(T::from_f64(t), state, arguments);
        };
        let (before, rest) = self.within.split_at_mut(info.curves.len());
        let (now, middle) = rest.split_at_mut(info.curves.len());
        before.copy_from_slice(&self.farthest);
        for piece in 1..=CurveInfo::PIECES {
            let places = mapped([piece - 1, piece], |k| {
                f64::from(k) / f64::from(CurveInfo::PIECES)
            });
            match piece < CurveInfo::PIECES {
                true => look(places[1], now),
                false => now.copy_from_slice(&self.arguments),
            }
            for (i, curve) in info.curves.iter().enumerate() {
                let Some(count) = curve.turning(info.dimension) else {
                    continue;
                };
                let ends = [
                    entries(&self.farthest, i, count),
                    entries(&self.arguments, i, count),
                ];
                if curve.kind != CurveKind::Bearing && !curve.may_leap(ends) {
                    continue;
                }
                let mut apart = [
                    (places[0], entries(before, i, count)),
                    (places[1], entries(now, i, count)),
                ];
                let mut halvings = 0;
                while curve.leaps(apart) && halvings < CurveInfo::HALVINGS {
                    let place = 0.5 * (apart[0].0 + apart[1].0);
                    look(place, middle);
                    apart = curve.half(apart, (place, entries(middle, i, count)));
                    halvings += 1;
                }
                if curve.leaps(apart) && self.since[i].to_f64().is_nan() {
                    self.since[i] = T::from_f64(span.t);
                }
            }
            before.copy_from_slice(now);
        }
    }

    /// Estimates |λ| of the fastest motion from a step that ends at `y` with the derivative `rate`. `near` is room for
    /// a state.
    pub(super) fn compare(&mut self, step: &dyn Stepper<T>, y: &[T], rate: &[T], near: &mut [T]) {
        let Some(limit) = self.fixed.and_then(Formula::stability_limit) else {
            return;
        };
        let Some(near_rate) = step.neighbour(near) else {
            return;
        };
        let span = step.span();
        let epsilon = epsilon_of::<T>();
        let entry = |i: usize| Entry {
            before: span.y[i].to_f64(),
            end: [y[i].to_f64(), rate[i].to_f64()],
            near: [near[i].to_f64(), near_rate[i].to_f64()],
        };
        if let Some(found) = rate_squared(self.info, epsilon, entry) {
            self.stability.observe([span.t, span.h], found, limit);
        }
    }

    /// Notes that the run ended in numbers that are not finite.
    pub(super) fn fail(&mut self) {
        self.failed = true;
    }

    /// The step above the limit of stability, and the time when it began.
    fn step(&self) -> Option<(f64, Problem)> {
        let unstable = self.stability.unstable(self.failed)?;
        let problem = Problem::Step {
            step: unstable.step,
            formula: self.fixed?,
            rate: unstable.rate,
            index: unstable.index,
        };
        Some((unstable.since, problem))
    }
}

/// The components of a bearing or a direction.
fn turning<T: Real>(entries: &[T]) -> Turning {
    let mut turning = [0.0; 3];
    for (of, entry) in turning.iter_mut().zip(entries) {
        *of = entry.to_f64();
    }
    turning
}

/// Index of the largest magnitude; `None` if all are 0.
fn largest<T: Real>(values: impl Iterator<Item = T>) -> Option<usize> {
    let (mut found, mut most) = (None, 0.0);
    for (i, value) in values.enumerate() {
        let size = value.abs().to_f64();
        if size > most {
            (found, most) = (Some(i), size);
        }
    }
    found
}

/// The entry of the state with the largest velocity.
fn fastest<T: Real>(info: &Info, y: &[T]) -> Option<usize> {
    let from = info.coordinates.len();
    let to = from + info.velocities.len();
    let velocities = y.get(from..to)?;
    largest(velocities.iter().copied()).map(|i| from + i)
}
