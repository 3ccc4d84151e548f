//! What lies within the steps just taken, in all lanes: where a guard changes its sign, and what is seen within a step alone.

use super::enabled;
use super::event::{PLACES, Sides, Values, changed, first_change, hidden};
use super::place::Places;
use super::run::{Run, each};
use crate::real::lanes::MOST_LANES;
use crate::real::{Mask, Several};
use crate::simulate::{EASY, SEARCHES, Zero};
use crate::{Model, Real, Vector};

impl<T: Several, M: Model<T>> Run<'_, T, M> {
    /// The part of the step of each lane after which something is seen that is not seen at its end; +∞ where nothing is.
    #[inline(always)]
    pub(super) fn hidden(&mut self, error: T::Part, accepted: T::Mask) -> T::Part {
        let c = T::Part::from_f64;
        let never = c(f64::INFINITY);
        if M::Kinks::LEN + M::Guards::LEN == 0 {
            return never;
        }
        let long = c(M::INFO.every).lt(self.step.h.part(0));
        let mut blind = accepted.and(error.lt(c(EASY)).or(long));
        for i in each(blind.lanes()) {
            if self.lanes[i].searches >= SEARCHES {
                blind = blind.and(T::Mask::of_lanes(1 << i).not());
            }
        }
        if !blind.any() {
            return never;
        }
        self.look_into(blind);
        let (of_guards, of_kinks) = self.values.split_at(M::Guards::LEN);
        let (model, step) = (&self.model, &self.step);
        let mut part = never;
        if M::Guards::LEN > 0 {
            let guards = |t, y: &M::State| enabled::guards(model, t, y);
            part = hidden(model, step, guards, of_guards, Zero::Positive, blind);
        }
        if M::Kinks::LEN > 0 {
            let kinks = |t, y: &M::State| enabled::kinks(model, t, y);
            let of_kinks = hidden(model, step, kinks, of_kinks, Zero::Neither, blind);
            part = part.min(of_kinks);
        }
        let part = T::Part::select(blind, part, never);
        for i in each(part.lt(never).lanes()) {
            self.lanes[i].searches += 1;
        }
        part
    }

    /// Guards and kinks at five places of the steps of these lanes, into `values`.
    #[inline(always)]
    pub(super) fn look_into(&mut self, lanes: T::Mask) {
        let mut places = Places::new((0, 0.0));
        for i in each(lanes.lanes()) {
            for (k, theta) in PLACES.into_iter().enumerate() {
                places.push(i, (k, theta));
                if places.full(T::LANES) {
                    self.look_at(&mut places);
                }
            }
        }
        if !places.is_empty() {
            self.look_at(&mut places);
        }
    }

    /// The same at some of the places, which are done with then.
    #[inline(always)]
    fn look_at(&mut self, places: &mut Places<(usize, f64)>) {
        let (order, model) = places.pack::<T, M>(&self.parameters);
        let step = &self.step;
        let mut theta = [T::One::from_f64(0.0); MOST_LANES];
        for (theta, wanted) in theta.iter_mut().zip(places.wanted()) {
            *theta = T::One::from_f64(wanted.1);
        }
        let theta = T::of_lanes(&theta);
        let y = step.inside_in_order(&model, theta, order);
        let t = theta * step.h.ordered(order) + step.t.ordered(order);
        if M::Guards::LEN > 0 {
            let guards = enabled::guards(&model, t, &y);
            let values = &mut self.values[..M::Guards::LEN];
            scatter::<T, _>(&guards, places, values);
        }
        if M::Kinks::LEN > 0 {
            let kinks = enabled::kinks(&model, t, &y);
            let values = &mut self.values[M::Guards::LEN..];
            scatter::<T, _>(&kinks, places, values);
        }
        places.clear();
    }

    /// The part of the step of each lane that counts, which ends just behind an event, the part ahead of that event, and where the
    /// step counts as a whole: steps that reach a time \[s\] and end in a state on its manifold.
    #[inline(always)]
    pub(super) fn place(
        &mut self,
        accepted: T::Mask,
        reached: T,
        end: &M::State,
    ) -> (Sides<T>, T::Mask) {
        let one = T::from_f64(1.0);
        let mut place = Sides {
            ahead: one,
            behind: one,
        };
        let mut whole = T::Mask::of_lanes(u32::MAX);
        if M::Guards::LEN + M::Kinks::LEN == 0 {
            return (place, whole);
        }
        let model = &self.model;
        if M::Guards::LEN > 0 {
            let guards = |t, y: &M::State| enabled::guards(model, t, y);
            let after = enabled::guards(model, reached, end);
            let crossed = changed(Zero::Positive, &self.guards, &after).and(accepted);
            if crossed.any() {
                self.step.complete(model);
                place = first_change(
                    model,
                    &self.step,
                    guards,
                    &self.guards,
                    Zero::Positive,
                    crossed,
                );
                let within = place.behind.part(0).lt(one.part(0));
                whole = whole.and(within.and(crossed).not());
            }
        }
        if M::Kinks::LEN > 0 && self.settings.locate {
            let kinks = |t, y: &M::State| enabled::kinks(model, t, y);
            let before = enabled::kinks(model, self.step.t, &self.step.y);
            let after = enabled::kinks(model, reached, end);
            let crossed = changed(Zero::Neither, &before, &after).and(accepted);
            if crossed.any() {
                self.step.complete(model);
                let at = first_change(model, &self.step, kinks, &before, Zero::Neither, crossed);
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
}

/// Puts what was found at places where it belongs: place by place, function by function.
#[inline(always)]
fn scatter<T: Several, G: Vector<T>>(
    found: &G,
    places: &Places<(usize, f64)>,
    values: &mut [Values<T>],
) {
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
        for (i, values) in values.iter_mut().enumerate() {
            values[k] = T::select(here, found[i].ordered(order), values[k]);
        }
    }
}
