//! Finds sign changes of event functions and kinks within the steps just taken, in all lanes, including those that the
//! ends of the steps do not show.

use super::event::{
    Functions, PLACES, Probe, Sides, Values, changed, excursion, first_change, hidden, may_stray,
    width,
};
use super::place::Places;
use super::run::{Run, Work, each};
use crate::Real;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::simulate::excursion::{Excursion, heads_for, overshoot};
use crate::simulate::{EASY, SEARCHES, Zero, opposite};

/// Two events closer than this many times the accuracy of their places count as simultaneous.
const TOGETHER: f64 = 4.0;

/// [`Run::look_at`]
struct Look<'a>(Functions, &'a mut Places<(usize, f64)>);

impl<T: Several> Work<T> for Look<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.look_at(self.0, self.1);
    }
}

/// [`Run::look_into`], followed by [`Run::found_inside`].
struct Hidden<M>(M);

impl<T: Several> Work<T> for Hidden<T::Mask> {
    type Output = T::Part;
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> T::Part {
        run.look_into(Functions::Kinks, self.0);
        run.found_inside(self.0)
    }
}

/// [`Run::change`]
struct Change<T: Several> {
    functions: Functions,
    accepted: T::Mask,
    easy: T::Mask,
    reached: T,
}

impl<T: Several> Work<T> for Change<T> {
    type Output = Option<(Sides<T>, T::Mask)>;
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> Self::Output {
        run.change(self.functions, [self.accepted, self.easy], self.reached)
    }
}

impl<T: Several> Run<'_, T> {
    /// The lanes in which something other than accuracy decides the length of a step of this error.
    #[inline(always)]
    pub(super) fn is_easy(&self, error: Option<T::Part>) -> T::Mask {
        let c = T::Part::from_f64;
        let long = c(self.info.every).lt(self.step.h.part(0));
        error.map_or(long, |error| error.lt(c(EASY)).or(long))
    }

    /// The part of each lane's step at which a kink has been crossed that is not crossed at the end of the step; +∞ if
    /// there is none.
    #[inline(always)]
    pub(super) fn hidden(&mut self, easy: T::Mask, accepted: T::Mask) -> T::Part {
        let never = T::Part::from_f64(f64::INFINITY);
        if self.info.kinks.is_empty() {
            return never;
        }
        let mut blind = accepted.and(easy);
        for i in each(blind.lanes()) {
            if self.lanes[i].searches >= SEARCHES {
                blind = blind.and(T::Mask::of_lanes(1 << i).not());
            }
        }
        if !blind.any() {
            return never;
        }
        let part = self.apart(Hidden(blind));
        for i in each(part.lt(never).lanes()) {
            self.lanes[i].searches += 1;
        }
        part
    }

    /// [`Run::hidden`] for these lanes, from the values that [`Run::look_into`] found.
    #[inline(always)]
    fn found_inside(&mut self, blind: T::Mask) -> T::Part {
        let never = T::Part::from_f64(f64::INFINITY);
        let count = self.info.kinks.len();
        let mut probe = Probe {
            model: &*self.models.all,
            step: &self.step,
            functions: Functions::Kinks,
            state: &mut self.state,
            values: &mut self.after[..count],
        };
        let part = hidden(&mut probe, &self.values[..count], blind);
        T::Part::select(blind, part, never)
    }

    /// Evaluates kinks at five places of the steps of these lanes, or event functions at the three inner places, into
    /// `values`.
    #[inline(always)]
    pub(super) fn look_into(&mut self, functions: Functions, lanes: T::Mask) {
        let between = functions == Functions::EventFunctions;
        let mut places = Places::new((0, 0.0));
        for i in each(lanes.lanes()) {
            for (k, theta) in PLACES.into_iter().enumerate() {
                if between && (k == 0 || k == PLACES.len() - 1) {
                    continue;
                }
                places.push(i, (k, theta));
                if places.full(T::LANES) {
                    self.apart(Look(functions, &mut places));
                }
            }
        }
        if !places.is_empty() {
            self.apart(Look(functions, &mut places));
        }
    }

    /// [`Run::look_into`] for the places of one register, which are cleared afterwards.
    #[inline(always)]
    fn look_at(&mut self, functions: Functions, places: &mut Places<(usize, f64)>) {
        let count = self.evaluate_at(functions, places);
        scatter(&self.after[..count], places, &mut self.values[..count]);
        places.clear();
    }

    /// Evaluates the functions at several places, one in each lane, into `after`. Returns the number of functions.
    #[inline(always)]
    fn evaluate_at(&mut self, functions: Functions, places: &mut Places<(usize, f64)>) -> usize {
        let order = self.pack(places);
        let step = &self.step;
        let mut theta = [T::One::from_f64(0.0); MOST_LANES];
        for (theta, wanted) in theta.iter_mut().zip(places.wanted()) {
            *theta = T::One::from_f64(wanted.1);
        }
        let theta = T::of_lanes(&theta);
        let model = &*self.models.packed;
        step.inside_in_order(model, theta, order, &mut self.state);
        let t = theta * step.h.ordered(order) + step.t.ordered(order);
        let count = match functions {
            Functions::EventFunctions => self.info.event_functions.len(),
            Functions::Kinks => self.info.kinks.len(),
        };
        functions.evaluate(model, t, &self.state, &mut self.after[..count]);
        count
    }

    /// The part of each lane's step that is kept, which ends just behind the first event; the part just ahead of that
    /// event; and the lanes in which the whole step is kept. The steps end at the times `reached` \[s\], in the state
    /// in `end`.
    #[inline(always)]
    pub(super) fn place(
        &mut self,
        accepted: T::Mask,
        easy: T::Mask,
        reached: T,
    ) -> (Sides<T>, T::Mask) {
        let one = T::from_f64(1.0);
        let none = T::Mask::of_lanes(0);
        let mut place = Sides {
            ahead: one,
            behind: one,
            at_odds: none,
            jumps: none,
        };
        let mut whole = T::Mask::of_lanes(u32::MAX);
        if !self.event_functions.is_empty() {
            let functions = Functions::EventFunctions;
            if let Some(at) = self.apart(Change {
                functions,
                accepted,
                easy,
                reached,
            }) {
                place = at.0;
                let within = place.behind.part(0).lt(one.part(0));
                whole = whole.and(within.and(at.1).not());
            }
        }
        if !self.kinks.is_empty() && self.settings.locate {
            let (t, y) = (self.step.t, &self.step.y);
            self.models.all.kinks(t, y, &mut self.kinks);
            let functions = Functions::Kinks;
            if let Some((at, crossed)) = self.apart(Change {
                functions,
                accepted,
                easy,
                reached,
            }) {
                let first = at.behind.part(0).lt(place.behind.part(0)).and(crossed);
                let apart = (at.behind.part(0) - place.behind.part(0)).abs();
                let together = T::Part::from_f64(TOGETHER * width::<T>()).lt(apart).not();
                let both = together.and(crossed).and(whole.not());
                let by_themselves = both.and(at.jumps.not()).and(place.jumps.not());
                let odd = Sides::differ(at.behind, place.behind).and(by_themselves);
                let at_odds = T::Mask::or(first.and(at.at_odds), first.not().and(place.at_odds));
                // if one of both events is only a consequence of the other, the time of the other counts
                let by_place = both.and(at.jumps).and(place.jumps.not());
                let by_at = both.and(place.jumps).and(at.jumps.not());
                let of_at = first.and(by_place.not()).or(by_at);
                let time = T::select(of_at, at.behind, place.behind);
                place = Sides {
                    at_odds: at_odds.or(odd),
                    ahead: T::select(first, at.ahead, place.ahead).moving_as(time),
                    behind: T::select(first, at.behind, place.behind).moving_as(time),
                    jumps: none,
                };
                whole = whole.and(first.not());
            }
        }
        (place, whole)
    }

    /// The places of sign changes within the accepted steps, and the lanes that have one. Event functions are also
    /// searched for changes that are undone within the step. Values at the starts of the steps are in `event_functions`
    /// or `kinks`.
    #[inline(always)]
    fn change(
        &mut self,
        functions: Functions,
        [accepted, easy]: [T::Mask; 2],
        reached: T,
    ) -> Option<(Sides<T>, T::Mask)> {
        let before = match functions {
            Functions::EventFunctions => &self.event_functions,
            Functions::Kinks => &self.kinks,
        };
        let after = match functions {
            Functions::EventFunctions => &self.event_functions_ahead[..],
            Functions::Kinks => {
                let after = &mut self.after[..before.len()];
                self.models.all.kinks(reached, &self.end, after);
                after
            }
        };
        let mut crossed = changed(functions.zero(), before, after).and(accepted);
        let mut end = T::Part::from_f64(1.0);
        if functions == Functions::EventFunctions {
            let hidden = self.may_turn(easy).and(accepted).and(crossed.not());
            if hidden.any() {
                let (turned, at) = self.excursions(hidden);
                crossed = crossed.or(turned);
                end = T::Part::select(turned, at, end);
            }
        }
        if !crossed.any() {
            return None;
        }
        self.step.complete(&*self.models.all);
        let before = match functions {
            Functions::EventFunctions => &self.event_functions,
            Functions::Kinks => &self.kinks,
        };
        let mut probe = Probe {
            model: &*self.models.all,
            step: &self.step,
            functions,
            state: &mut self.state,
            values: &mut self.after[..before.len()],
        };
        let sides = first_change(&mut probe, before, crossed, end);
        Some((sides, crossed))
    }

    /// The lanes in which an event function may change its sign within the step and change it back.
    #[inline(always)]
    fn may_turn(&self, easy: T::Mask) -> T::Mask {
        let nought = T::Part::from_f64(0.0);
        let lengths = [self.past, self.step.h.part(0)];
        let mut may = easy.or(nought.lt(self.past).not());
        let event_functions = self.event_functions_past.iter().zip(&self.event_functions);
        for ((past, before), after) in event_functions.zip(&self.event_functions_ahead) {
            let values = [past.part(0), before.part(0), after.part(0)];
            may = may.or(nought.lt(overshoot(values, lengths)));
            may = may.or(nought.lt(heads_for([values[0], values[1]], lengths)));
        }
        may
    }

    /// The lanes, among these, in which an event function changes its sign within the step and changes it back, and a
    /// part of the step at which the sign is changed; 1 in the other lanes. The searches of all lanes and event
    /// functions go on side by side, each in a lane of a register.
    #[inline(always)]
    fn excursions(&mut self, lanes: T::Mask) -> (T::Mask, T::Part) {
        self.step.complete(&*self.models.all);
        self.look_into(Functions::EventFunctions, lanes);
        let zero = Functions::EventFunctions.zero();
        let ends = self.event_functions.iter().zip(&self.event_functions_ahead);
        for (values, (before, after)) in self.values.iter_mut().zip(ends) {
            (values[0], values[4]) = (*before, *after);
        }
        let mut waiting = Waiting {
            among: lanes.lanes() & ((1 << T::LANES) - 1),
            lanes: 0,
            event_function: 0,
        };
        let mut searches = [None; MOST_LANES];
        let mut first = [None; MOST_LANES];
        loop {
            let mut places = Places::new((0, 0.0));
            for (index, place) in searches.iter_mut().enumerate().take(T::LANES) {
                loop {
                    let started = match place {
                        Some(search) => Some(*search),
                        None => self.next_excursion(zero, &mut waiting),
                    };
                    let Some(mut search) = started else {
                        break;
                    };
                    if let Some(theta) = search.excursion.next() {
                        places.push(search.lane, (index, theta));
                        *place = Some(search);
                        break;
                    }
                    if let Some(theta) = search.excursion.found() {
                        let earliest = first[search.lane].unwrap_or(1.0f64);
                        first[search.lane] = Some(earliest.min(theta));
                    }
                    *place = None;
                }
            }
            if places.is_empty() {
                break;
            }
            self.evaluate_at(Functions::EventFunctions, &mut places);
            for (position, (_, (index, _))) in places.each().enumerate() {
                if let Some(Search {
                    lane,
                    event_function,
                    excursion,
                }) = &mut searches[index]
                {
                    let before = self.event_functions[*event_function].lane(*lane);
                    let value = self.after[*event_function].lane(position);
                    excursion.tell(opposite(zero, before, value).to_f64());
                }
            }
        }
        let (mut found, mut parts) = (0, [T::One::from_f64(1.0); MOST_LANES]);
        for (lane, first) in first.into_iter().enumerate() {
            if let Some(theta) = first {
                found |= 1 << lane;
                parts[lane] = T::One::from_f64(theta);
            }
        }
        (T::Mask::of_lanes(found), T::of_lanes(&parts).part(0))
    }

    /// The next waiting search that may find an excursion.
    #[inline(always)]
    fn next_excursion(&self, zero: Zero, waiting: &mut Waiting) -> Option<Search> {
        while waiting.lanes == 0 {
            if waiting.event_function == self.event_functions.len() {
                return None;
            }
            let values = &self.values[waiting.event_function];
            waiting.lanes = may_stray(zero, values, waiting.among);
            waiting.event_function += 1;
        }
        let lane = waiting.lanes.trailing_zeros() as usize;
        waiting.lanes &= waiting.lanes - 1;
        let event_function = waiting.event_function - 1;
        Some(Search {
            lane,
            event_function,
            excursion: excursion(zero, &self.values[event_function], lane),
        })
    }
}

/// The search for an excursion of an event function in a lane.
#[derive(Clone, Copy)]
struct Search {
    lane: usize,
    event_function: usize,
    excursion: Excursion,
}

/// Searches that have not begun: in `lanes`, those for the event function before `event_function`; and all for
/// `event_function` and later ones.
struct Waiting {
    /// The lanes that are searched.
    among: u32,
    lanes: u32,
    event_function: usize,
}

/// Distributes the values found at packed places to their lane, place and function in `values`.
#[inline(always)]
fn scatter<T: Several>(found: &[T], places: &Places<(usize, f64)>, values: &mut [Values<T>]) {
    // for each of the five places: the lanes that have it in this register, and the position of each
    let (mut lanes, mut from) = ([0; PLACES.len()], [[0; MOST_LANES]; PLACES.len()]);
    for (position, (lane, (k, _))) in places.each().enumerate() {
        lanes[k] |= 1 << lane;
        from[k][lane] = position as u8;
    }
    for (k, (lanes, from)) in lanes.into_iter().zip(&from).enumerate() {
        if lanes == 0 {
            continue;
        }
        let (here, order) = (T::Mask::of_lanes(lanes), T::order(from));
        for (values, found) in values.iter_mut().zip(found) {
            values[k] = T::select(here, found.ordered(order), values[k]);
        }
    }
}
