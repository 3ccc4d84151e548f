//! What lies within the steps just taken, in all lanes: where a guard changes its sign, and what is seen within a step alone.

use super::event::{Functions, PLACES, Probe, Sides, Values, changed, first_change, hidden};
use super::place::Places;
use super::run::{Run, Section, each};
use crate::Real;
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::simulate::{EASY, SEARCHES};

/// [`Run::look_at`]
struct Look<'a>(&'a mut Places<(usize, f64)>);

impl<T: Several> Section<T> for Look<'_> {
    type Output = ();
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) {
        run.look_at(self.0);
    }
}

/// [`Run::look_into`] and what is found there.
struct Search<M>(M);

impl<T: Several> Section<T> for Search<T::Mask> {
    type Output = T::Part;
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> T::Part {
        run.look_into(self.0);
        run.found_inside(self.0)
    }
}

/// [`Run::change`]
struct Change<T: Several> {
    functions: Functions,
    accepted: T::Mask,
    reached: T,
}

impl<T: Several> Section<T> for Change<T> {
    type Output = Option<(Sides<T>, T::Mask)>;
    #[inline(always)]
    fn run(self, run: &mut Run<'_, T>) -> Self::Output {
        run.change(self.functions, self.accepted, self.reached)
    }
}

impl<T: Several> Run<'_, T> {
    /// The part of the step of each lane after which something is seen that is not seen at its end; +∞ where nothing is.
    #[inline(always)]
    pub(super) fn hidden(&mut self, error: T::Part, accepted: T::Mask) -> T::Part {
        let c = T::Part::from_f64;
        let never = c(f64::INFINITY);
        if self.values.is_empty() {
            return never;
        }
        let long = c(self.info.every).lt(self.step.h.part(0));
        let mut blind = accepted.and(error.lt(c(EASY)).or(long));
        for i in each(blind.lanes()) {
            if self.lanes[i].searches >= SEARCHES {
                blind = blind.and(T::Mask::of_lanes(1 << i).not());
            }
        }
        if !blind.any() {
            return never;
        }
        let part = self.apart(Search(blind));
        for i in each(part.lt(never).lanes()) {
            self.lanes[i].searches += 1;
        }
        part
    }

    /// The part of the step of these lanes after which something is seen that is not seen at its end, by what [`Run::look_into`] found;
    /// +∞ where nothing is.
    #[inline(always)]
    fn found_inside(&mut self, blind: T::Mask) -> T::Part {
        let never = T::Part::from_f64(f64::INFINITY);
        let (of_guards, of_kinks) = self.values.split_at(self.info.guards.len());
        let mut part = never;
        for (functions, values) in [(Functions::Guards, of_guards), (Functions::Kinks, of_kinks)] {
            if values.is_empty() {
                continue;
            }
            let mut probe = Probe {
                model: &*self.models.all,
                step: &self.step,
                functions,
                state: &mut self.state,
                values: &mut self.after[..values.len()],
            };
            part = part.min(hidden(&mut probe, values, blind));
        }
        T::Part::select(blind, part, never)
    }

    /// Guards and kinks at five places of the steps of these lanes, into `values`.
    #[inline(always)]
    pub(super) fn look_into(&mut self, lanes: T::Mask) {
        let mut places = Places::new((0, 0.0));
        for i in each(lanes.lanes()) {
            for (k, theta) in PLACES.into_iter().enumerate() {
                places.push(i, (k, theta));
                if places.full(T::LANES) {
                    self.apart(Look(&mut places));
                }
            }
        }
        if !places.is_empty() {
            self.apart(Look(&mut places));
        }
    }

    /// The same at some of the places, which are done with then.
    #[inline(always)]
    fn look_at(&mut self, places: &mut Places<(usize, f64)>) {
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
        let (of_guards, of_kinks) = self.values.split_at_mut(self.info.guards.len());
        for (functions, values) in [(Functions::Guards, of_guards), (Functions::Kinks, of_kinks)] {
            if values.is_empty() {
                continue;
            }
            let found = &mut self.after[..values.len()];
            functions.evaluate(model, t, &self.state, found);
            scatter(found, places, values);
        }
        places.clear();
    }

    /// The part of the step of each lane that counts, which ends just behind an event, the part ahead of that event, and where the
    /// step counts as a whole: steps that reach a time \[s\] and end in the state in `end`.
    #[inline(always)]
    pub(super) fn place(&mut self, accepted: T::Mask, reached: T) -> (Sides<T>, T::Mask) {
        let one = T::from_f64(1.0);
        let mut place = Sides {
            ahead: one,
            behind: one,
        };
        let mut whole = T::Mask::of_lanes(u32::MAX);
        if !self.guards.is_empty() {
            let functions = Functions::Guards;
            if let Some(at) = self.apart(Change {
                functions,
                accepted,
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
                reached,
            }) {
                let first = at.behind.part(0).lt(place.behind.part(0)).and(crossed);
                place = Sides {
                    ahead: T::select(first, at.ahead, place.ahead),
                    behind: T::select(first, at.behind, place.behind),
                };
                whole = whole.and(first.not());
            }
        }
        (place, whole)
    }

    /// Where functions change their sign within the steps of these lanes, and in which lanes they do. Their values at the beginning are
    /// in `guards` or `kinks`.
    #[inline(always)]
    fn change(
        &mut self,
        functions: Functions,
        accepted: T::Mask,
        reached: T,
    ) -> Option<(Sides<T>, T::Mask)> {
        let before = match functions {
            Functions::Guards => &self.guards,
            Functions::Kinks => &self.kinks,
        };
        let model = &*self.models.all;
        let after = &mut self.after[..before.len()];
        functions.evaluate(model, reached, &self.end, after);
        if functions == Functions::Guards {
            self.guards_ahead.copy_from_slice(after);
        }
        let crossed = changed(functions.zero(), before, after).and(accepted);
        if !crossed.any() {
            return None;
        }
        self.step.complete(model);
        let mut probe = Probe {
            model,
            step: &self.step,
            functions,
            state: &mut self.state,
            values: after,
        };
        Some((first_change(&mut probe, before, crossed), crossed))
    }
}

/// Puts what was found at places where it belongs: place by place, function by function.
#[inline(always)]
fn scatter<T: Several>(found: &[T], places: &Places<(usize, f64)>, values: &mut [Values<T>]) {
    // by place within a step: the lanes that have it here, and which of the places it is
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
