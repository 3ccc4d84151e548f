//! Handles the ends of accepted steps in all lanes: where events cut them, how their memory is renewed, and what the
//! next steps begin with.

use super::control::norm;
use super::event::{Sides, width};
use super::onset::END_OF_STEP;
use super::reach::Reach;
use super::run::{Run, each, replace};
use crate::real::{Mask, Several, mapped};
use crate::simulate::finest;
use crate::{Real, Section};

/// How the steps of all lanes ended.
pub(super) struct Landing<T: Real> {
    /// The lanes whose steps were accepted.
    accepted: T::Mask,
    /// The lanes whose steps went their full length; elsewhere an event ended them.
    whole: T::Mask,
    /// The lanes whose steps ended on a time that they had to meet.
    arrived: T::Mask,
    renewed: Renewed<T>,
    /// The lanes in which the time of the end depends on parameters, and the derivatives of that time, with the value 0
    /// \[s\].
    moves: T::Mask,
    shift: T,
    /// The lanes in which several events ended the step at the same time, but depend differently on parameters.
    at_odds: T::Mask,
}

/// What renewing memory changed.
#[derive(Clone, Copy)]
pub(super) struct Renewed<T: Real> {
    /// The lanes in which memory changed.
    any: T::Mask,
    /// The lanes in which event functions or onsets changed, too.
    other: T::Mask,
}

impl<T: Several> Run<'_, T> {
    /// Renews the memory in these lanes until nothing changes. Before and after, event functions and onsets are those
    /// of the states where steps begin.
    #[inline(always)]
    pub(super) fn renew(&mut self, lanes: T::Mask) -> Renewed<T> {
        let mut renewed = Renewed {
            any: T::Mask::of_lanes(0),
            other: T::Mask::of_lanes(0),
        };
        if self.info.memory.is_empty() {
            return renewed;
        }
        for round in 0..=self.event_functions.len() {
            let differs = differ(&self.renewed, &self.step.y).and(lanes);
            if !differs.any() {
                break;
            }
            if round == 0 {
                self.after[..self.event_functions.len()]
                    .copy_from_slice(&self.event_functions_ahead);
                let [.., end, any, _] = &mut self.onsets.values;
                any.copy_from_slice(end);
            }
            replace(differs, &mut self.step.y, &self.renewed);
            renewed.any = renewed.any.or(differs);
            self.look_at_begin();
        }
        if renewed.any.any() {
            let [.., end, any, _] = &self.onsets.values;
            let event_functions = differ(
                &self.after[..self.event_functions.len()],
                &self.event_functions_ahead,
            );
            renewed.other = event_functions.or(differ(any, end)).and(renewed.any);
        }
        renewed
    }

    /// Moves the lanes to the ends of their accepted steps. A step ends where an event function changes its sign.
    #[inline(always)]
    pub(super) fn land(
        &mut self,
        accepted: T::Mask,
        easy: T::Mask,
        reach: &Reach<T>,
    ) -> Landing<T> {
        let t = self.step.t;
        let (sides, whole) = self.place(accepted, easy, reach.reached);
        let Sides {
            ahead,
            behind,
            at_odds,
            ..
        } = sides;
        let whole = whole.or(self.going_on(whole.not().and(accepted), behind));
        let broken = whole.not().and(accepted);
        let arrived = accepted.and(whole).and(reach.lands);
        let nought = T::from_f64(0.0);
        let shift = (behind - behind.frozen()) * self.step.h;
        let shift = T::select(broken, shift, T::select(arrived, reach.shift, nought));
        let (ahead, behind) = (ahead.frozen(), behind.frozen());
        let reached = T::select(whole, reach.reached, behind * self.step.h + t);
        self.deliver(accepted, whole, reached);
        let at_odds = at_odds.and(broken);
        let moves = moving(shift).or(at_odds).and(broken.or(arrived));
        if at_odds.any() {
            self.remember_ahead([ahead, behind]);
        }
        let jumps = self.notes_jumps && broken.or(arrived).any();
        if jumps || moves.any() {
            if broken.any() {
                self.step.inside(&*self.models.all, ahead, &mut self.state);
                replace(broken.not(), &mut self.state, &self.end);
            } else {
                self.state.copy_from_slice(&self.end);
            }
        }
        let ends = reached.min(self.step.latest);
        let short = T::select(broken, ahead * self.step.h + t, ends);
        let leads = moves.any();
        if leads {
            let model = &self.models.all;
            model.derivative(short.min(self.step.latest), &self.state, &mut self.ahead);
        }
        if jumps {
            if leads {
                follow(moves, &mut self.state, &self.ahead, shift);
            }
            self.look_ahead(short + shift);
        }
        if broken.any() {
            self.step.inside(&*self.models.all, behind, &mut self.state);
            replace(whole.not(), &mut self.end, &self.state);
        }
        if leads {
            follow(moves, &mut self.end, &self.ahead, shift);
        }
        if broken.or(moves).any() {
            self.look_at_end(broken.or(moves), reached + shift);
        }
        let part = T::select(whole, T::from_f64(1.0), behind);
        self.advance_bends(accepted, part);
        self.advance_watch(accepted, part, reached);
        exchange(accepted, &mut self.step.y, &mut self.end);
        self.step.t = T::select(accepted, reached + shift, t);
        let renewed = self.renew(accepted);
        self.advance_onsets(accepted);
        if jumps {
            self.note_jumps(broken.or(arrived));
        }
        Landing {
            accepted,
            whole,
            arrived,
            renewed,
            moves,
            at_odds,
            shift,
        }
    }

    /// Finishes accepted steps, and prepares the next ones, which begin where these ended.
    #[inline(always)]
    pub(super) fn leave(&mut self, landing: &Landing<T>) {
        let Landing {
            accepted,
            whole,
            arrived,
            renewed,
            moves,
            at_odds,
            shift,
        } = *landing;
        self.grid.advance(accepted);
        for i in each(accepted.lanes()) {
            self.lanes[i].steps += 1;
            self.lanes[i].searches = 0;
            if whole.lanes() >> i & 1 != 0 {
                self.lanes[i].standing.forget();
            }
        }
        for i in each(arrived.lanes()) {
            self.arrive(i);
        }
        let going = T::Mask::of_lanes(self.busy()).and(accepted);
        if arrived.any() {
            self.step.latest = self.latest();
            self.controller.reset(arrived);
        }
        let mut unknown = going;
        if self.settings.pace.method().ends_with_its_rate() {
            unknown = arrived.or(renewed.any).or(whole.not()).and(going);
            let [first, .., last] = &mut self.step.k;
            exchange(accepted, first, last);
        }
        let whole = whole.and(arrived.not()).and(going);
        let mut goes_on = whole.and(renewed.any.not());
        let alike = whole.and(renewed.any).and(renewed.other.not());
        if unknown.any() {
            self.state.copy_from_slice(&self.step.k[0]);
            self.rate(unknown);
            if alike.any() {
                goes_on = goes_on.or(self.moves_alike().and(alike));
            }
        }
        self.tie(at_odds.and(going));
        self.hold(moves.and(going), shift);
        // where memory stays, they are known
        let known = going.and(renewed.any.not());
        let smooth = known.and(whole);
        let past = T::Part::select(goes_on, self.step.h.part(0), T::Part::from_f64(0.0));
        self.past = T::Part::select(accepted, past, self.past);
        replace(going, &mut self.event_functions_past, &self.event_functions);
        replace(
            going,
            &mut self.event_functions,
            &self.event_functions_ahead,
        );
        self.leave_watch(going, known.and(arrived.not()), smooth);
        self.count_steps(whole.not().and(going));
    }

    /// Makes the start times of the next steps independent of parameters in these lanes, although the previous steps
    /// ended at times that depend on them. Between the two times the state moves at the rate behind the event, as it
    /// moved at the rate ahead of the event in [`Run::land`]. So the derivatives of the state change by (ẏ₋ − ẏ₊)
    /// dτ/dp, with the rates on both sides of the event and its time τ; those of entries that the event does not affect
    /// stay as they are.
    #[inline(always)]
    fn hold(&mut self, lanes: T::Mask, shift: T) {
        if !lanes.any() {
            return;
        }
        let shift = T::select(lanes, shift, T::from_f64(0.0));
        follow(lanes, &mut self.step.y, &self.step.k[0], -shift);
        self.step.t = self.step.t - shift;
        self.hold_memory(lanes);
        self.rate(lanes);
    }

    /// Adapts memory that follows the state, as the foot of a line under load does, to the time at which the next steps
    /// of these lanes begin, instead of the time of the event. Values of memory stay the same, and where the memory
    /// stays as it is, so do its derivatives: if the memory that the state drags along and the one kept before are
    /// equal, laws prefer the dragged one.
    #[inline(always)]
    fn hold_memory(&mut self, lanes: T::Mask) {
        if self.info.memory.is_empty() {
            return;
        }
        self.look_at_begin();
        let same = differ(&self.renewed, &self.step.y).not();
        replace(same.and(lanes), &mut self.step.y, &self.renewed);
    }

    /// Evaluates the memory just ahead of an event: at a place before `ahead` by the distance between the two parts of
    /// the step, because at a function's zero its event may already have happened. Event functions and onsets, which
    /// this overwrites, are evaluated again where steps end.
    #[inline(always)]
    fn remember_ahead(&mut self, [ahead, behind]: [T; 2]) {
        let part = (ahead + (ahead - behind)).max(T::from_f64(0.0));
        self.step.inside(&*self.models.all, part, &mut self.state);
        let t = part * self.step.h + self.step.t;
        let memory = self.info.length(Section::Renewed);
        self.models.all.sections(
            t,
            &self.state,
            &mut [
                (Section::EventFunctions, &mut self.event_functions_ahead),
                (Section::Onsets, &mut self.onsets.values[END_OF_STEP]),
                (Section::Renewed, &mut self.renewed[..memory]),
            ],
        );
        let kept = &self.renewed[self.info.varying_length()..];
        self.memory_ahead.copy_from_slice(kept);
    }

    /// Marks lanes in which several events that depend differently on parameters ended a step as
    /// [tied](super::scenario::Doubt::Tied), unless neither rates nor memory jump there. Of several simultaneous
    /// events, only the one whose function was farthest on the other side gave the time.
    #[inline(always)]
    fn tie(&mut self, at_odds: T::Mask) {
        if !at_odds.any() {
            return;
        }
        let entries = self.info.varying_length();
        let (continuous, memory) = self.step.y.split_at(entries);
        let rates = jump(&self.ahead[..entries], &self.step.k[0][..entries], &[]);
        let jumps = rates.or(jump(&self.memory_ahead, memory, continuous));
        self.tied |= at_odds.and(jumps).lanes();
    }

    /// The lanes in which the motion goes on as in the previous step, whose last derivative is in `state`, although
    /// memory was renewed: the change of the derivative, over a step of that length, makes no more than the allowed
    /// error. This holds for a hysteresis under load, whose memory follows the state. No lane if steps are fixed, for
    /// which no error is allowed.
    #[inline(always)]
    fn moves_alike(&mut self) -> T::Mask {
        if self.allowed.is_empty() {
            return T::Mask::of_lanes(0);
        }
        for (change, rate) in self.state.iter_mut().zip(&self.step.k[0]) {
            *change = self.step.h * (*rate - *change);
        }
        let size = norm::<T>(&self.allowed, &self.step.y, &self.state);
        T::Part::from_f64(1.0).lt(size).not()
    }

    /// The lanes, among these whose steps are cut to `part`, whose steps are to be taken whole anyway, because events
    /// have stopped them too often.
    #[inline(always)]
    fn going_on(&mut self, cut: T::Mask, part: T) -> T::Mask {
        let mut going_on = 0;
        for i in each(cut.lanes()).take_while(|i| *i < T::LANES) {
            let [t, h, part] = mapped([self.step.t, self.step.h, part], |x| x.lane(i).to_f64());
            let finest = T::EPSILON / f64::EPSILON * finest(t);
            let standing = &mut self.lanes[i].standing;
            if standing.goes_on([part * h, h], finest, width::<T>()) {
                going_on |= 1 << i;
            }
        }
        T::Mask::of_lanes(going_on)
    }
}

/// A number does not jump if it changes by less than this share of itself, or by less than this share of the largest
/// number beside it: between both sides of an event everything moves slightly.
const TRIFLE: f64 = 1e-6;
const NOTHING: f64 = 1e-12;

/// An upper bound of all numbers of a model, except the infinite time of a switch that has not fired.
const MOST: f64 = 1e30;

/// The lanes in which any number jumps between both sides of an event; `beside` are numbers that set the scale.
#[inline(always)]
fn jump<T: Several>(ahead: &[T], behind: &[T], beside: &[T]) -> T::Mask {
    let [trifle, nothing, most] = mapped([TRIFLE, NOTHING, MOST], T::Part::from_f64);
    let mut largest = T::Part::from_f64(0.0);
    let beside = match beside.is_empty() {
        true => behind,
        false => beside,
    };
    for number in beside {
        largest = largest.max(number.part(0).abs()).min(most);
    }
    let mut jumps = T::Mask::of_lanes(0);
    for (ahead, behind) in ahead.iter().zip(behind) {
        let [ahead, behind] = [ahead.part(0), behind.part(0)];
        let size = ahead.abs().max(behind.abs()).min(most);
        let apart = (behind - ahead).abs();
        let more = (trifle * size).lt(apart);
        jumps = jumps.or(more.and((nothing * largest).lt(apart)));
    }
    jumps
}

/// Moves a state in these lanes along its rate for a time \[s\] that consists of derivatives only.
#[inline(always)]
fn follow<T: Several>(lanes: T::Mask, state: &mut [T], rate: &[T], time: T) {
    for (state, rate) in state.iter_mut().zip(rate) {
        *state = T::select(lanes, rate.frozen() * time + *state, *state);
    }
}

/// The lanes in which a number has derivatives that are not 0.
#[inline(always)]
fn moving<T: Several>(number: T) -> T::Mask {
    let mut moving = T::Mask::of_lanes(0);
    for part in 1..T::PARTS {
        moving = moving.or(T::Part::from_f64(0.0).lt(number.part(part).abs()));
    }
    moving
}

/// The lanes in which any of two lists of numbers differ.
#[inline(always)]
fn differ<T: Several>(some: &[T], others: &[T]) -> T::Mask {
    let mut differ = T::Mask::of_lanes(0);
    for (a, b) in some.iter().zip(others) {
        let (a, b) = (a.part(0), b.part(0));
        differ = differ.or(a.lt(b)).or(b.lt(a));
    }
    differ
}

/// Replaces the entries of a state in the lanes of a mask; `new` is not needed afterwards.
#[inline(always)]
fn exchange<T: Several>(lanes: T::Mask, old: &mut Box<[T]>, new: &mut Box<[T]>) {
    if lanes.all() {
        core::mem::swap(old, new);
    } else {
        replace(lanes, old, new);
    }
}
