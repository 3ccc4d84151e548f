//! What a run is watched for, step by step: whether its end can be trusted, and if not, since when and because of what.
//!
//! | what | compared | with |
//! |---|---|---|
//! | energy | \|T(t) − T(0) − Σ W\| | the limit · the largest energy so far, kinetic or gone through an effect |
//! | momentum of what is free | \|p(t) − p(0) − ∫ F dt\|, and that about the origin | the limit · what masses of this kinetic energy can have |
//! | velocities, where steps are fixed | the estimate of their error ([`error`]) | 2.5 times the limit · the largest speed |
//! | coordinates, likewise | the same | 2.5 times the limit · the largest way from the start |
//! | fixed step | h \|λ\| of the fastest motion | the method's limit of stability |
//! | curves of the state, while their force acts | how far beyond their points | what goes on beyond them |
//! | flexion beyond 90° | by how much the direction of bending leaps | a quarter turn |
//! | two ellipsoids that push each other | by how much the direction of the force leaps | a quarter turn |
//!
//! **Scales.** The largest energy so far is not the sum of all that was exchanged: a pendulum exchanges its energy four times
//! a period, and what it loses little by little would never count. By Cauchy and Schwarz masses of the kinetic energy T have
//! at most the momentum √(2 T m) and, about the origin, √(2 T I). What a tolerance lets pass is no finding: with e the kinetic energy
//! of velocities as large as their absolute tolerance, a step may change √T by √e, and what forces do at kinetic energies below e is
//! not computed at all.
//!
//! **A gap that is overtaken** by the energy that comes later is forgotten: at the start there is nothing to compare with.
//!
//! **A flexion through 180°** makes the direction of bending leap by half a turn within no time, and what pushes in this direction with it. A
//! motion that passes beside 180° turns it fast, but on the way: a leap is halved on the step's interpolant until there is none, or
//! what is left of the step is a thousandth.
//!
//! **Two ellipsoids that sink into each other** so far that one goes through the other push in the opposite direction from one moment to the
//! next: the direction in which they overlap least leaps. Bodies that pass each other, however deep, turn it fast, but on the way. Where the
//! centres coincide there is no direction at all. Such a step is halved like one with a flexion through 180°, where the direction is another
//! at its ends, or is there at one of them alone.
//!
//! **The fastest motion** (Hairer & Wanner, *Solving ODEs II*, IV.2): where a step is unstable, what it errs by is soon its fastest
//! motion and nothing else, and so is the difference of two states a, b that are computed for the same time. Then
//! ‖f(a) − f(b)‖/‖a − b‖ is |λ|; taken as the geometric mean over coordinates and over velocities, it is so for an oscillation too,
//! wherever in its period a − b lies and whatever the units.

pub(crate) mod account;
pub(crate) mod error;
#[cfg(test)]
mod tests;

use super::balance::{NODES, Rule};
use super::event::inside;
use super::{Balance, Buffer, Pace, Settings};
use crate::curve::Extrapolate;
use crate::integrate::workspace::Workspace;
use crate::integrate::{Evaluator, Stepper};
use crate::model::{CurveInfo, CurveKind, Turning};
use crate::{AccountArrival, Dynamics, Formula, Info, Real, StateKind};
use account::{Account, Energies, Entry, Stability, rate_squared};
use core::fmt;
use error::{Errors, Estimated, GAUSS};

/// Share of the energy that may be missing where nothing else is asked for: 2 %.
///
/// A velocity that errs by 1 % is an energy that errs by 2 %. The default tolerance keeps well below a thousandth (docs/accuracy.md);
/// for crash simulations with finite elements ten percent over a run are customarily accepted (NCHRP Web-Only Document 179, 2010).
pub const ENERGY_LIMIT: f64 = 0.02;

/// Why a run that went on cannot be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doubt {
    /// Since when \[s\].
    pub t: f64,
    /// Because of what.
    pub suspicion: Suspicion,
    /// The model, for names.
    pub info: &'static Info,
}

/// What is wrong with a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Suspicion {
    /// Fixed steps are above the limit of stability.
    Step {
        /// The step \[s\].
        step: f64,
        /// The method.
        formula: Formula,
        /// Speed of the fastest motion, |λ| \[1/s\].
        rate: f64,
        /// The entry of the state that it moves most.
        index: usize,
    },
    /// A curve is left so far that what it gives is made up.
    Curve {
        /// Which, an index in [`Info::curves`].
        curve: usize,
        /// The argument farthest away so far.
        argument: f64,
    },
    /// A fixed step went over something that begins and ends within it.
    Missed {
        /// Which, an index in [`Info::onsets`].
        onset: usize,
        /// How many steps did.
        steps: u64,
    },
    /// A flexion went through 180°.
    Flexion {
        /// Whose bearing leapt, an index in [`Info::curves`].
        bearing: usize,
    },
    /// Two ellipsoids sank into each other until the direction of their force leapt.
    Sunk {
        /// Whose direction leapt, an index in [`Info::curves`].
        contact: usize,
    },
    /// The balance of energy.
    Energy {
        /// The largest gap, as a share of the largest energy.
        share: f64,
        /// The effect whose power was largest when this began, an index in [`Info::powers`].
        effect: Option<usize>,
        /// The entry of the state whose velocity was largest then.
        index: Option<usize>,
    },
    /// The balance of momentum of what moves freely.
    Momentum {
        /// The largest gap, as a share of what there can be.
        share: f64,
        /// The entry of the state whose velocity was largest when this began.
        index: Option<usize>,
    },
    /// Fixed steps err by too much, as estimated along with them.
    Error {
        /// The entry of the state that was farthest off when this began.
        index: usize,
    },
}

impl Suspicion {
    /// The largest step that the scene allows \[s\], of a step that is above.
    pub fn largest_stable_step(&self) -> Option<f64> {
        match *self {
            Suspicion::Step { formula, rate, .. } => Some(formula.stability_limit()? / rate),
            _ => None,
        }
    }
}

impl Doubt {
    /// The entry of the state that is named.
    pub fn coordinate(&self) -> Option<&'static str> {
        let index = match self.suspicion {
            Suspicion::Step { index, .. } | Suspicion::Error { index } => Some(index),
            Suspicion::Curve { .. }
            | Suspicion::Missed { .. }
            | Suspicion::Flexion { .. }
            | Suspicion::Sunk { .. } => None,
            Suspicion::Energy { index, .. } | Suspicion::Momentum { index, .. } => index,
        };
        self.info.state_name(index?)
    }

    /// How much: the step over the largest stable one, the argument, the angle, the share that is missing.
    pub fn amount(&self) -> f64 {
        match self.suspicion {
            Suspicion::Step { step, .. } => {
                step / self.suspicion.largest_stable_step().unwrap_or(step)
            }
            Suspicion::Curve { argument, .. } => argument,
            Suspicion::Missed { steps, .. } => steps as f64,
            Suspicion::Flexion { .. } | Suspicion::Sunk { .. } => core::f64::consts::PI,
            Suspicion::Energy { share, .. } | Suspicion::Momentum { share, .. } => share,
            Suspicion::Error { .. } => 1.0,
        }
    }

    /// A word for programs.
    pub fn kind(&self) -> &'static str {
        match self.suspicion {
            Suspicion::Step { .. } => "step",
            Suspicion::Curve { curve, .. } if self.is_volume(curve) => "volume",
            Suspicion::Curve { .. } => "curve",
            Suspicion::Missed { .. } => "missed",
            Suspicion::Flexion { .. } => "flexion",
            Suspicion::Sunk { .. } => "sunk",
            Suspicion::Energy { .. } => "energy",
            Suspicion::Momentum { .. } => "momentum",
            Suspicion::Error { .. } => "error",
        }
    }

    /// Whether an entry of [`Info::curves`] is the volume of an airbag.
    fn is_volume(&self, curve: usize) -> bool {
        let curve = self.info.curves.get(curve);
        curve.is_some_and(|curve| curve.kind == CurveKind::Volume)
    }

    /// What to do.
    pub fn remedy(&self) -> &'static str {
        match self.suspicion {
            Suspicion::Step { .. } => {
                "give a smaller --step; or --tolerance instead, which finds the steps; or --method rodas5, which has no such limit"
            }
            Suspicion::Curve { curve, .. } if self.is_volume(curve) => {
                "give the bag more gas, a smaller vent or more volume, or let a contact stop the bodies before"
            }
            Suspicion::Curve { .. } => {
                "give the curve points as far as it is used; or write `extrapolate: hold` where its last value is meant to go on"
            }
            Suspicion::Missed { .. } | Suspicion::Error { .. } => {
                "give --tolerance instead of --step, which ends steps where something begins; or a smaller --step"
            }
            Suspicion::Flexion { .. } => {
                "let a stop or a stiffer curve end the bending before 180°, start the joint straighter, or give it laws `about` x, y, z"
            }
            Suspicion::Sunk { .. } => {
                "let the force, or something behind, stop the bodies before their middles meet; or give a smaller --step, or --tolerance instead"
            }
            Suspicion::Energy { .. } | Suspicion::Momentum { .. } => {
                "a smaller --tolerance or --step, or another --method, shows whether the gap goes down; if it does not, a \
                 force does not belong to its power; --energy-limit says how much may be missing"
            }
        }
    }
}

/// A number to three digits, without an exponent where it can be read without.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        match size {
            0.0 => f.write_str("0"),
            s if !(1e-3..1e6).contains(&s) => write!(f, "{:.2e}", self.0),
            s => {
                let decimals = [100.0, 10.0, 1.0, 0.1, 0.01].iter().take_while(|x| s < **x);
                write!(f, "{:.*}", decimals.count(), self.0)
            }
        }
    }
}

/// A length of time in the unit in which it is read most easily.
pub(crate) struct Time(pub f64);

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            s if s >= 1.0 || s == 0.0 => write!(f, "{} s", Short(s)),
            s if s >= 1e-3 => write!(f, "{} ms", Short(s * 1e3)),
            s if s >= 1e-6 => write!(f, "{} µs", Short(s * 1e6)),
            s => write!(f, "{} ns", Short(s * 1e9)),
        }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let since = Time(self.t);
        let name = self.coordinate().unwrap_or("?");
        match self.suspicion {
            Suspicion::Step {
                step,
                formula,
                rate,
                ..
            } => {
                let largest = self.suspicion.largest_stable_step().unwrap_or(step);
                write!(
                    f,
                    "since t = {since} the step of {} is above the stability limit of {formula} in this scene, about {} (a motion \
                     of {} 1/s, most in \"{name}\")",
                    Time(step),
                    Time(largest),
                    Short(rate)
                )
            }
            Suspicion::Curve { curve, argument } => match self.info.curves.get(curve) {
                Some(curve) => write!(f, "since t = {since} {}", Beyond { curve, argument }),
                None => write!(
                    f,
                    "since t = {since} the argument of a curve is outside of its points"
                ),
            },
            Suspicion::Missed { onset, steps } => {
                let onset = self.info.onsets.get(onset).copied().unwrap_or("?");
                let which = match steps {
                    1 => "a step",
                    _ => "the first of several steps",
                };
                write!(
                    f,
                    "at t = {since} {which} passed over an event that begins and ends within the step: \"{onset}\""
                )
            }
            Suspicion::Flexion { bearing } => {
                let name = self
                    .info
                    .curves
                    .get(bearing)
                    .map_or("?", |curve| curve.name);
                write!(
                    f,
                    "since t = {since} \"{name}\" is bent through 180°, where flexion has no direction and torsion no angle"
                )
            }
            Suspicion::Sunk { contact } => {
                let name = self
                    .info
                    .curves
                    .get(contact)
                    .map_or("?", |curve| curve.name);
                write!(
                    f,
                    "since t = {since} the bodies of \"{name}\" have sunk into each other so far that the direction of the force is not \
                     determined"
                )
            }
            Suspicion::Energy { share, effect, .. } => {
                write!(
                    f,
                    "since t = {since} the balance of energy has a gap of {} % of the largest energy in it",
                    Short(100.0 * share)
                )?;
                match effect.and_then(|effect| self.info.powers.get(effect)) {
                    Some(effect) => write!(
                        f,
                        "; the largest power at that time is that of \"{effect}\""
                    ),
                    None => write!(f, "; \"{name}\" moves fastest at that time"),
                }
            }
            Suspicion::Error { .. } => write!(
                f,
                "since t = {since} \"{name}\" errs by too much, as estimated from the rates within the steps: they are too long for this motion"
            ),
            Suspicion::Momentum { share, .. } => write!(
                f,
                "since t = {since} the balance of momentum of freely moving bodies has a gap of {} % of the largest possible momentum; \
                 \"{name}\" moves fastest at that time",
                Short(100.0 * share)
            ),
        }
    }
}

/// By how much the argument of a curve exceeds its points, and how the curve is extended, in words.
pub(crate) struct Beyond<'a> {
    pub curve: &'a CurveInfo,
    pub argument: f64,
}

impl fmt::Display for Beyond<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Beyond { curve, argument } = self;
        if curve.kind == CurveKind::Volume {
            let (name, left) = (curve.name, 100.0 * (1.0 - curve.last));
            return write!(
                f,
                "the {name} is compressed to less than {} % of its volume, where its law is no longer valid",
                Short(left)
            );
        }
        let how = match curve.extrapolate {
            Extrapolate::Linear => "the curve is extended as a straight line",
            Extrapolate::Hold => "the curve keeps its outermost value",
            Extrapolate::Error => "the curve may not be extended",
        };
        let (side, end) = match *argument < curve.first {
            true => ("is below the first point", curve.first),
            false => ("exceeds the last point", curve.last),
        };
        let (name, beyond) = (curve.name, (argument - end).abs());
        write!(
            f,
            "the argument of the curve \"{name}\" {side} ({}) by {}, and {how}",
            Short(end),
            Short(beyond)
        )
    }
}

/// How far a curve was left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Left {
    /// Which, an index in [`Info::curves`].
    pub curve: usize,
    /// Since when \[s\].
    pub since: f64,
    /// The argument farthest away.
    pub argument: f64,
}

impl Left {
    /// Whether what the curve gives there is made up: a line that goes on over more than the whole width of the points, a value
    /// other than 0 that is held though nobody asked for it.
    pub fn made_up(&self, info: &Info) -> bool {
        let curve = info.curves.get(self.curve);
        curve.is_some_and(|curve| {
            let [from, to] = curve.trusted();
            self.argument < from || to < self.argument
        })
    }
}

/// What a run is watched for, and what was found.
#[derive(Debug)]
pub struct Watch<'a, T: Real> {
    info: &'static Info,
    /// Where energy and momentum went.
    pub balance: Balance<'a, T>,
    account: Account,
    /// The effect whose power was largest when energy began to be missing, and the entries of the state that were fastest when energy and momentum
    /// did.
    effect: Option<usize>,
    fastest: [Option<usize>; 2],
    errors: Errors,
    stability: Stability,
    /// The method, where steps are fixed and so may be above its limit.
    fixed: Option<Formula>,
    /// When a fixed step went over something first, what, and how many steps did.
    missed: Option<(f64, usize, u64)>,
    /// Whether the run ended in numbers that are not finite.
    failed: bool,
    /// Since when each curve of the state is left, or bearing has leapt, NaN where it is not, and the argument farthest away; the bearing
    /// where the step begins.
    since: Buffer<'a, T>,
    farthest: Buffer<'a, T>,
    /// The arguments of the curves of the state.
    arguments: Buffer<'a, T>,
    /// The same at three places within a step.
    within: Buffer<'a, T>,
    /// Powers of all effects at one node of a step after the other. Those of the first are known when it begins, those of the last when it
    /// ends.
    powers: Buffer<'a, T>,
    /// The start, how far each entry is off by the estimate, what the step leaves unexplained of it, and a derivative.
    start: Buffer<'a, T>,
    error: Buffer<'a, T>,
    defect: Buffer<'a, T>,
    rates: Buffer<'a, T>,
    /// Whether coordinates may change their charts, and whether they just may have.
    charts: [bool; 2],
    /// The forces on what moves freely there.
    external_wrenches: [[T; 6]; NODES],
    /// Kinetic energy and momentum where a step leads.
    kinetic_ahead: T,
    momentum_ahead: [T; 6],
    /// How they are summed up.
    rule: Rule,
    /// The works of effects over time, where they are wanted.
    #[cfg(feature = "std")]
    pub history: Option<History>,
}

/// The works of effects over time, at the ends of steps.
#[cfg(feature = "std")]
#[derive(Clone, Debug, Default, PartialEq)]
pub struct History {
    /// Least time between two of them \[s\].
    pub every: f64,
    /// \[s\]
    pub times: std::vec::Vec<f64>,
    /// Work of each effect up to each of the times \[J\].
    pub works: std::vec::Vec<std::vec::Vec<f64>>,
}

#[cfg(feature = "std")]
impl History {
    /// Notes works at a time, where that is late enough.
    fn note<T: Real>(&mut self, t: f64, works: &[T]) {
        if self.times.last().is_none_or(|last| t >= last + self.every) {
            self.times.push(t);
            self.works
                .push(works.iter().map(|work| work.to_f64()).collect());
        }
    }
}

#[cfg(feature = "std")]
impl<T: Real> Watch<'static, T> {
    /// Before a run of this model ([`Model::INFO`](crate::Model::INFO)), with this limit on the share of energy and momentum that may be
    /// missing. It allocates its memory here.
    pub fn new(info: &'static Info, limit: f64) -> Self {
        let buffer = |length| Buffer::Owned(std::vec![T::from_f64(0.0); length]);
        Watch::with(info, limit, buffer)
    }
}

impl<'a, T: Real> Watch<'a, T> {
    /// [`Watch::new`] in memory that is given, of which [`Watch::length`] says how much there has to be. What it holds before does not
    /// matter.
    ///
    /// # Panics
    /// Where the memory is too short.
    pub fn within(info: &'static Info, limit: f64, memory: &'a mut [T]) -> Self {
        let mut workspace = Workspace::new(memory);
        Watch::with(info, limit, |length| Buffer::Lent(workspace.part(length)))
    }

    /// How many scalars the watch of a model keeps.
    pub const fn length(info: &Info) -> usize {
        (1 + NODES) * info.powers.len() + 6 * info.curves.len() + 4 * info.state_length()
    }

    /// Before a run, with memory of the lengths asked for.
    fn with(
        info: &'static Info,
        limit: f64,
        mut memory: impl FnMut(usize) -> Buffer<'a, T>,
    ) -> Self {
        let (powers, curves) = (info.powers.len(), info.curves.len());
        let [mut since, mut farthest] = [memory(curves), memory(curves)];
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
            start: memory(info.state_length()),
            error: memory(info.state_length()),
            defect: memory(info.state_length()),
            rates: memory(info.state_length()),
            charts: [
                info.memory.iter().any(|name| name.ends_with(": chart")),
                false,
            ],
            external_wrenches: [[T::from_f64(0.0); 6]; NODES],
            kinetic_ahead: T::from_f64(0.0),
            momentum_ahead: [T::from_f64(0.0); 6],
            rule: Rule::Five,
            #[cfg(feature = "std")]
            history: None,
        }
    }

    /// The model that it is for.
    pub fn info(&self) -> &'static Info {
        self.info
    }

    /// Whether it is for a model with as many effects, curves and entries of the state.
    pub(super) fn fits(&self, info: &Info) -> bool {
        let lengths = |info: &Info| (info.powers.len(), info.curves.len(), info.state_length());
        lengths(self.info) == lengths(info)
    }

    /// Why the run cannot be trusted, what causes the rest first.
    pub fn doubts(&self) -> impl Iterator<Item = Doubt> + '_ {
        let curve = self.left().filter(|left| left.made_up(self.info));
        let curve = curve.map(|left| {
            let Left {
                curve, argument, ..
            } = left;
            (left.since, Suspicion::Curve { curve, argument })
        });
        let missed = (self.missed).map(|(t, onset, steps)| (t, Suspicion::Missed { onset, steps }));
        let energy = self.account.energy().map(|(since, share)| {
            let suspicion = Suspicion::Energy {
                share,
                effect: self.effect,
                index: self.fastest[0],
            };
            (since, suspicion)
        });
        let bearings = self.info.curves.iter().enumerate();
        let flexions = bearings.filter_map(|(bearing, curve)| {
            let since = self.since[bearing].to_f64();
            if since.is_nan() {
                return None;
            }
            let suspicion = match curve.kind {
                CurveKind::Curve | CurveKind::Volume => return None,
                CurveKind::Bearing => Suspicion::Flexion { bearing },
                CurveKind::Direction(_) => Suspicion::Sunk { contact: bearing },
            };
            Some((since, suspicion))
        });
        let momentum = self.account.momentum().map(|(since, share)| {
            let index = self.fastest[1];
            (since, Suspicion::Momentum { share, index })
        });
        let found = self.step().into_iter().chain(missed).chain(curve);
        let found = found.chain(flexions).chain(energy);
        let errs = self.errors.found();
        let errs = errs.map(|(since, index)| (since, Suspicion::Error { index }));
        found
            .chain(momentum)
            .chain(errs)
            .map(|(t, suspicion)| Doubt {
                t,
                suspicion,
                info: self.info,
            })
    }

    /// A fixed step from `t` went over something.
    pub(super) fn step_over(&mut self, t: f64, onset: usize) {
        let (.., steps) = self.missed.get_or_insert((t, onset, 0));
        *steps += 1;
    }

    /// The curves of the state that were left, and how far.
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

    /// The start of a run, with place for two states.
    pub(super) fn open(
        &mut self,
        model: &dyn Dynamics<T>,
        y: &[T],
        settings: &Settings,
        [slow, fast]: [&mut [T]; 2],
    ) {
        let (info, start) = (self.info, T::from_f64(settings.start));
        let energy = |y: &[T]| model.kinetic_energy(start, y).to_f64();
        // that of velocities of a certain size, beyond what moves by itself
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
                self.rule = Rule::of(settings.method.formula);
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
            let of_one = [StateKind::Velocity, StateKind::AngularVelocity]
                .map(|wanted| moving(&|kind| if kind == wanted { 1.0 } else { 0.0 }));
            self.account.weigh_at_start(info.dimension, of_one);
        }
        self.begin(model, settings.start, y);
        if !info.curves.is_empty() {
            model.curves(start, y, &mut self.arguments);
            self.look_at_curves(settings.start);
        }
    }

    /// A step begins at `t` and `y` otherwise than the one before ended.
    pub(super) fn begin(&mut self, model: &dyn Dynamics<T>, t: f64, y: &[T]) {
        let powers = &mut self.powers[..self.info.powers.len()];
        model.exchange(T::from_f64(t), y, powers, &mut self.external_wrenches[0]);
    }

    /// Memory was renewed at the end of a step that began at `before`. The next step begins with what [`Watch::arrival`] received last.
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

    /// Places for what is wanted where a step ends, or may end, on this side of a kink there and before memory is renewed: the arguments of
    /// curves, and what balances are made of.
    pub(super) fn arrival(&mut self) -> (&mut [T], AccountArrival<'_, T>) {
        let last = NODES - 1;
        let account = AccountArrival {
            kinetic_energy: &mut self.kinetic_ahead,
            powers: &mut self.powers[last * self.info.powers.len()..],
            momentum: &mut self.momentum_ahead,
            external_wrench: &mut self.external_wrenches[last],
        };
        (&mut self.arguments, account)
    }

    /// Adds the work of a step that is complete, or of its first part of this length, whose end is known ([`Watch::arrival`]); the kinetic
    /// energy before it, and what was exchanged in it \[J\]. `state` is place for a state.
    pub(super) fn add_work(
        &mut self,
        model: &dyn Dynamics<T>,
        step: &dyn Stepper<T>,
        length: f64,
        y: &[T],
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
            model.exchange(t, state, powers, &mut self.external_wrenches[node]);
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
        if self.fixed.is_some() {
            self.look_at_defect(model, step, length, y, state);
        }
        [kinetic, self.balance.exchanged - before].map(T::to_f64)
    }

    /// What a step of this length, which ends at `y`, leaves unexplained. `state` is place for a state.
    fn look_at_defect(
        &mut self,
        model: &dyn Dynamics<T>,
        step: &dyn Stepper<T>,
        length: f64,
        y: &[T],
        state: &mut [T],
    ) {
        let span = step.span();
        let changes = self.defect.iter_mut().zip(span.y.iter().zip(y));
        for (defect, (begin, end)) in changes {
            *defect = *end - *begin;
        }
        for (x, weight) in GAUSS {
            inside(model, step, x * length / span.h, state);
            let weight = T::from_f64(weight * length);
            model.derivative(T::from_f64(span.t + x * length), state, &mut self.rates);
            for (defect, rate) in self.defect.iter_mut().zip(self.rates.iter()) {
                *defect += -(weight * *rate);
            }
        }
    }

    /// Carries the estimate of the error over a step of this length, which ended at `y`. The step is done with. `state` is place for a state.
    pub(super) fn estimate_error(
        &mut self,
        step: &mut dyn Stepper<T>,
        f: &mut Evaluator<'_, T>,
        length: f64,
        y: &[T],
        state: &mut [T],
    ) {
        let integrated = self.info.varying_length();
        let t = step.span().t;
        if core::mem::take(&mut self.charts[1]) {
            // the coordinates are others
            self.error.fill(T::from_f64(0.0));
            return;
        }
        state.copy_from_slice(step.span().y);
        for (state, error) in state.iter_mut().zip(&self.error[..integrated]) {
            *state = *state - *error;
        }
        f.model.normalize(state);
        let counts = (f.count, f.jacobians);
        f.at(t, state, &mut self.rates);
        step.begin(t, state, &self.rates);
        let taken = step.take(f, length);
        (f.count, f.jacobians) = counts;
        if taken.is_err() {
            return;
        }
        for (i, error) in self.error.iter_mut().enumerate().take(integrated) {
            *error = y[i] - (step.span().end[i] - self.defect[i]);
        }
        let coordinates = self.info.coordinates.len();
        let entry = |i: usize| Estimated {
            size: match i < coordinates {
                true => (y[i] - self.start[i]).to_f64(),
                false => y[i].to_f64(),
            },
            error: self.error[i].to_f64(),
        };
        self.errors.observe(t, self.info, entry);
    }

    /// The state at the end of a step that began at `t`, with the kinetic energy that it began with and what was exchanged in it \[J\]. The next
    /// begins as this one ended.
    pub(super) fn close(&mut self, t: f64, y: &[T], [before, exchanged]: [f64; 2]) {
        let effects = self.info.powers.len();
        let energies = Energies {
            kinetic: [before, self.balance.end.to_f64()],
            exchanged,
            // without an effect nothing is said of energy
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

    /// Whether curves are left at their arguments, which are known, at the end of a step that began at `t`.
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

    /// Looks for leaps of bearings and directions in the first `part` of a step; `state` is place for a state.
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
                // of a joint all steps are looked into, which bends through 180° and back
                suspected |= curve.kind == CurveKind::Bearing || {
                    let ends = [&self.farthest, &self.arguments];
                    curve.may_leap(ends.map(|of| entries(of, i, count)))
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
            let places = [piece - 1, piece].map(|k| f64::from(k) / f64::from(CurveInfo::PIECES));
            match piece < CurveInfo::PIECES {
                true => look(places[1], now),
                false => now.copy_from_slice(&self.arguments),
            }
            for (i, curve) in info.curves.iter().enumerate() {
                let Some(count) = curve.turning(info.dimension) else {
                    continue;
                };
                let ends = [&self.farthest, &self.arguments].map(|of| entries(of, i, count));
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

    /// A step just taken, whose end is `y` with the derivative `rate`; `near` is place for a state.
    pub(super) fn compare(&mut self, step: &dyn Stepper<T>, y: &[T], rate: &[T], near: &mut [T]) {
        let Some(limit) = self.fixed.and_then(Formula::stability_limit) else {
            return;
        };
        let Some(near_rate) = step.neighbour(near) else {
            return;
        };
        let span = step.span();
        let epsilon = match T::from_f64(1.0 + 1e-10).to_f64() == 1.0 {
            true => f64::from(f32::EPSILON),
            false => f64::EPSILON,
        };
        let entry = |i: usize| Entry {
            before: span.y[i].to_f64(),
            end: [y[i], rate[i]].map(T::to_f64),
            near: [near[i], near_rate[i]].map(T::to_f64),
        };
        if let Some(found) = rate_squared(self.info, epsilon, entry) {
            self.stability.observe([span.t, span.h], found, limit);
        }
    }

    /// The run has ended in numbers that are not finite.
    pub(super) fn fail(&mut self) {
        self.failed = true;
    }

    /// The step that is above the limit of stability, and since when.
    fn step(&self) -> Option<(f64, Suspicion)> {
        let unstable = self.stability.unstable(self.failed)?;
        let suspicion = Suspicion::Step {
            step: unstable.step,
            formula: self.fixed?,
            rate: unstable.rate,
            index: unstable.index,
        };
        Some((unstable.since, suspicion))
    }
}

/// The entries of a bearing or a direction.
fn turning<T: Real>(entries: &[T]) -> Turning {
    let mut turning = [0.0; 3];
    for (of, entry) in turning.iter_mut().zip(entries) {
        *of = entry.to_f64();
    }
    turning
}

/// Index of the largest magnitude, where one is not 0.
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
