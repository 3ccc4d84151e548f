//! Stores the onsets evaluated within the steps of all lanes, as plain numbers.
//!
//! Few lanes search at once, and each for one law after the other. So a place is evaluated for all laws of its lane,
//! which may ask for it later, and the otherwise idle lanes of a register evaluate places that are likely to be asked
//! for next ([`Hunt::ahead`]). Each search is told the same values, in the same order, as if it were alone.

use super::copies;
use super::place::Places;
use crate::Real;
use crate::real::Several;
use crate::real::lanes::MOST_LANES;
use crate::simulate::onset::{GapCourse, Hunt, QUARTERS, onset_of};

/// Number of evaluations that are remembered. One evaluation ("look") covers the places packed into one register.
const KEPT: usize = 8;

/// A number for each lane, or for each place.
type Numbers = [f64; MOST_LANES];

/// The onsets at the ends of the quarters of steps, and gaps at places between.
pub(super) struct OnsetCache {
    onsets: usize,
    corners: usize,
    /// For each quarter: all gaps, then all speeds, in each lane.
    quarters: [Box<[Numbers]>; QUARTERS + 1],
    /// For each look: all gaps, at each place.
    gaps: [Box<[Numbers]>; KEPT],
    /// For each look: the lane of each place, and the part of its step.
    places: [[(u8, f64); MOST_LANES]; KEPT],
    /// For each look: the number of places.
    counts: [usize; KEPT],
    /// The oldest look, which is overwritten next.
    next: usize,
}

/// The lanes of a scalar as doubles.
#[inline(always)]
fn numbers<T: Several>(scalar: T) -> Numbers {
    let (lanes, mut numbers) = (scalar.lanes(), [0.0; MOST_LANES]);
    for lane in 0..T::LANES {
        numbers[lane] = lanes[lane].to_f64();
    }
    numbers
}

impl OnsetCache {
    /// An empty store for this number of onsets, the last of which are `corners`.
    pub fn new(onsets: usize, corners: usize) -> Self {
        let zeros = |length: usize| copies([0.0; MOST_LANES], length);
        OnsetCache {
            onsets,
            corners,
            quarters: core::array::from_fn(|_| zeros(2 * onsets)),
            gaps: core::array::from_fn(|_| zeros(onsets)),
            places: [[(0, 0.0); MOST_LANES]; KEPT],
            counts: [0; KEPT],
            next: 0,
        }
    }

    /// Begins with new steps, given their onsets at the ends of quarters.
    #[inline(always)]
    pub fn begin<T: Several>(&mut self, values: &[Box<[T]>]) {
        self.counts = [0; KEPT];
        for (quarter, values) in self.quarters.iter_mut().zip(values) {
            for (known, value) in quarter.iter_mut().zip(values) {
                *known = numbers(*value);
            }
        }
    }

    /// Stores the onsets found at several places.
    #[inline(always)]
    pub fn add<T: Several>(&mut self, places: &Places<f64>, values: &[T]) {
        let look = self.next;
        self.next = (look + 1) % KEPT;
        self.counts[look] = 0;
        for (place, (lane, theta)) in self.places[look].iter_mut().zip(places.each()) {
            *place = (lane as u8, theta);
            self.counts[look] += 1;
        }
        for (known, value) in self.gaps[look].iter_mut().zip(values) {
            *known = numbers(*value);
        }
    }

    /// The look and the position in it where a place of a lane was evaluated.
    fn find(&self, lane: usize, theta: f64) -> Option<(usize, usize)> {
        for (look, places) in self.places.iter().enumerate() {
            for (position, place) in places[..self.counts[look]].iter().enumerate() {
                if usize::from(place.0) == lane && place.1 == theta {
                    return Some((look, position));
                }
            }
        }
        None
    }

    /// The gap of a side at a place of a lane, if that place was evaluated.
    fn gap(&self, lane: usize, theta: f64, side: usize) -> Option<f64> {
        let (look, position) = self.find(lane, theta)?;
        let (onset, far) = onset_of(side, self.onsets, self.corners);
        let gap = self.gaps[look][onset][position];
        Some(if far { -gap } else { gap })
    }

    /// The known gaps and the speed of a side in a lane.
    fn course(&self, side: usize, lane: usize) -> GapCourse {
        let (onset, far) = onset_of(side, self.onsets, self.corners);
        let (mut gaps, mut speed) = ([0.0; QUARTERS + 1], 0.0_f64);
        for (gap, values) in gaps.iter_mut().zip(&self.quarters) {
            let value = values[onset][lane];
            *gap = if far { -value } else { value };
            speed = speed.max(values[self.onsets + onset][lane]);
        }
        GapCourse { gaps, speed }
    }

    /// Continues the search in a lane as far as the values it asks for are known. True if the search has ended; else
    /// adds the place that it asks for to `places`.
    pub fn go_on(&self, lane: usize, hunt: &mut Hunt, places: &mut Places<f64>) -> bool {
        while let Some(theta) = hunt.next(|side| self.course(side, lane)) {
            let Some(gap) = self.gap(lane, theta, hunt.law()) else {
                places.push(lane, theta);
                return false;
            };
            hunt.tell(gap);
        }
        true
    }

    /// Fills up `places`, to at most `most`, with places that searches may ask for next.
    pub fn look_ahead(&self, hunts: &[Option<Hunt>], most: usize, places: &mut Places<f64>) {
        for k in 0..Hunt::AHEAD {
            for (lane, hunt) in hunts.iter().enumerate() {
                if places.full(most) {
                    return;
                }
                let Some(theta) = hunt.as_ref().and_then(|hunt| hunt.ahead(k)) else {
                    continue;
                };
                let known = self.find(lane, theta).is_some();
                if !known && places.each().all(|place| place != (lane, theta)) {
                    places.push(lane, theta);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{OnsetCache, Places, QUARTERS};
    use crate::Several;
    use crate::real::by_index;
    use crate::real::lanes::{MOST_LANES, OfAnyWidth, Width, with_width};
    use crate::simulate::onset::{GapCourse, Hunt, finest_gaps, onset_of, sides};

    const ONSETS: usize = 5;
    const CORNERS: usize = 2;

    /// The gap of an onset in a lane: it sways about a line.
    #[derive(Clone, Copy)]
    struct Gap {
        line: [f64; 2],
        sway: f64,
        frequency: f64,
    }

    impl Gap {
        fn at(&self, theta: f64) -> f64 {
            self.line[0] + self.line[1] * theta + self.sway * (self.frequency * theta).sin()
        }

        fn speed(&self) -> f64 {
            self.line[1].abs() + self.sway.abs() * self.frequency
        }
    }

    /// A step of length 1 of each lane, with its gaps.
    fn steps(seed: u64) -> [[Gap; ONSETS]; MOST_LANES] {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut random = || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        [(); MOST_LANES].map(|()| {
            [(); ONSETS].map(|()| Gap {
                line: [0.4 * random(), 0.4 * random() - 0.2],
                sway: 0.3 * random(),
                frequency: 20.0 * random(),
            })
        })
    }

    /// What a search finds alone, and how often it asks.
    fn alone(gaps: &[Gap; ONSETS], mut hunt: Hunt) -> (Option<(f64, usize)>, usize) {
        let sided = |side: usize, theta: f64| {
            let (onset, far) = onset_of(side, ONSETS, CORNERS);
            let gap = gaps[onset].at(theta);
            if far { -gap } else { gap }
        };
        let mut asked = 0;
        while let Some(theta) = hunt.next(|side| GapCourse {
            gaps: std::array::from_fn(|k| sided(side, k as f64 / QUARTERS as f64)),
            speed: gaps[onset_of(side, ONSETS, CORNERS).0].speed(),
        }) {
            asked += 1;
            hunt.tell(sided(hunt.law(), theta));
        }
        (hunt.best(), asked)
    }

    /// The gap of an onset at one of several places.
    type GapAt<'a> = &'a dyn Fn(usize, usize) -> f64;
    /// A number of a lane at a quarter: quarter, number, lane.
    type Number<'a> = &'a dyn Fn(usize, usize, usize) -> f64;

    /// A step of each lane in the cache: what its [`OnsetCache::begin`] and [`OnsetCache::add`] take, from functions of
    /// numbers, in registers of a type. All else is compiled once.
    struct Registers {
        lanes: usize,
        begin: fn(&mut OnsetCache, Number),
        add: fn(&mut OnsetCache, &Places<f64>, GapAt),
    }

    fn begin<T: Several<One = f64>>(cache: &mut OnsetCache, number: Number) {
        let mut values = Vec::new();
        for quarter in 0..=QUARTERS {
            let mut all = vec![T::from_f64(0.0); 2 * ONSETS];
            for (entry, value) in all.iter_mut().enumerate() {
                *value = T::of_lanes(&by_index(0.0, |lane| number(quarter, entry, lane)));
            }
            values.push(all.into_boxed_slice());
        }
        cache.begin(&values);
    }

    fn add<T: Several<One = f64>>(cache: &mut OnsetCache, places: &Places<f64>, gap: GapAt) {
        let mut all = [T::from_f64(0.0); ONSETS];
        for (onset, value) in all.iter_mut().enumerate() {
            *value = T::of_lanes(&by_index(0.0, |place| gap(place, onset)));
        }
        cache.add(places, &all);
    }

    struct Compare;

    impl OfAnyWidth for Compare {
        type Output = ();
        fn run<T: Several<One = f64>>(self) {
            compare(&Registers {
                lanes: T::LANES,
                begin: begin::<T>,
                add: add::<T>,
            });
        }
    }

    fn compare(registers: &Registers) {
        let (mut found, mut looks, mut longest, mut asked) = (0, 0, 0, 0);
        for seed in 0..300 {
            let steps = steps(seed);
            let new = || {
                let laws = ONSETS - CORNERS;
                Hunt::new(1.0, sides(ONSETS, CORNERS), laws, finest_gaps(false))
            };
            let mut looked = OnsetCache::new(ONSETS, CORNERS);
            (registers.begin)(&mut looked, &|quarter, entry, lane| {
                let theta = quarter as f64 / QUARTERS as f64;
                match entry < ONSETS {
                    true => steps[lane][entry].at(theta),
                    false => steps[lane][entry - ONSETS].speed(),
                }
            });
            // some lanes do not search
            let searches = |lane: usize| !(lane as u64 + seed).is_multiple_of(3);
            let mut hunts: Vec<Option<Hunt>> = (0..registers.lanes)
                .map(|l| searches(l).then(new))
                .collect();
            let mut best = [None; MOST_LANES];
            loop {
                let mut places = Places::new(0.0);
                for (lane, place) in hunts.iter_mut().enumerate() {
                    let ended =
                        (place.as_mut()).is_some_and(|h| looked.go_on(lane, h, &mut places));
                    if ended {
                        best[lane] = place.take().and_then(|hunt| hunt.best());
                    }
                }
                if places.is_empty() {
                    break;
                }
                looked.look_ahead(&hunts, registers.lanes, &mut places);
                assert!(places.each().count() <= registers.lanes);
                let at: Vec<(usize, f64)> = places.each().collect();
                (registers.add)(&mut looked, &places, &|place, onset| {
                    at.get(place)
                        .map_or(f64::NAN, |(l, theta)| steps[*l][onset].at(*theta))
                });
                looks += 1;
            }
            let mut most = 0;
            for lane in (0..registers.lanes).filter(|lane| searches(*lane)) {
                let (expected, times) = alone(&steps[lane], new());
                assert_eq!(best[lane], expected, "lane {lane} of {seed}");
                most = most.max(times);
                asked += times;
                found += usize::from(expected.is_some());
            }
            longest += most;
        }
        assert!(found > 20 && asked > 1000, "{found} of {asked}");
        // every look takes every search one place further, or more where there is room
        assert!(looks <= longest, "{looks} of {longest}");
        assert!(
            registers.lanes == 1 || looks < longest,
            "{looks} of {longest}"
        );
    }

    #[test]
    fn searches_side_by_side_find_what_each_finds_alone() {
        for width in Width::ALL {
            with_width(width, Compare);
        }
    }
}
