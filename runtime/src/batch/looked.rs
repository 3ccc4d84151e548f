//! What is known of onsets within the steps of all lanes, as plain numbers.
//!
//! Few lanes search at once, and each for one law after the other. So a place is looked at for all laws of its lane, which may ask for it later, and what
//! would be idle of a register looks at places that are likely to be asked for next ([`Hunt::ahead`]). What a search is told, and in which order, is the
//! same as if it were alone.

use super::place::Places;
use crate::Real;
use crate::real::Several;
use crate::real::lanes::MOST_LANES;
use crate::simulate::onset::{Course, Hunt, QUARTERS, onset_of};

/// So many looks are remembered.
const KEPT: usize = 8;

/// A number of each lane, or of each place.
type Numbers = [f64; MOST_LANES];

/// What was found at the ends of the quarters of steps, and at places between.
pub(super) struct Looked {
    onsets: usize,
    corners: usize,
    /// By quarter, all gaps, then all speeds, of each lane.
    quarters: [Box<[Numbers]>; QUARTERS + 1],
    /// By look, all gaps, of each place.
    gaps: [Box<[Numbers]>; KEPT],
    /// By look: in which lane each place is, and which part of its step.
    places: [[(u8, f64); MOST_LANES]; KEPT],
    /// By look: how many places.
    counts: [usize; KEPT],
    /// The look that is the next to be forgotten.
    next: usize,
}

/// The numbers of a scalar.
#[inline(always)]
fn numbers<T: Several>(scalar: T) -> Numbers {
    let (lanes, mut numbers) = (scalar.lanes(), [0.0; MOST_LANES]);
    for lane in 0..T::LANES {
        numbers[lane] = lanes[lane].to_f64();
    }
    numbers
}

impl Looked {
    /// Nothing yet, of so many onsets, the last of which are `corners`.
    pub fn new(onsets: usize, corners: usize) -> Self {
        let zeros = |length: usize| vec![[0.0; MOST_LANES]; length].into_boxed_slice();
        Looked {
            onsets,
            corners,
            quarters: core::array::from_fn(|_| zeros(2 * onsets)),
            gaps: core::array::from_fn(|_| zeros(onsets)),
            places: [[(0, 0.0); MOST_LANES]; KEPT],
            counts: [0; KEPT],
            next: 0,
        }
    }

    /// Other steps, of which these are the onsets at the ends of quarters.
    #[inline(always)]
    pub fn begin<T: Several>(&mut self, values: &[Box<[T]>]) {
        self.counts = [0; KEPT];
        for (quarter, values) in self.quarters.iter_mut().zip(values) {
            for (known, value) in quarter.iter_mut().zip(values) {
                *known = numbers(*value);
            }
        }
    }

    /// What was found at some places.
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

    /// The look and the position in it at which a place of a lane was looked at.
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

    /// The gap of one of the sides at a place of a lane, where it was looked at.
    fn gap(&self, lane: usize, theta: f64, side: usize) -> Option<f64> {
        let (look, position) = self.find(lane, theta)?;
        let (onset, far) = onset_of(side, self.onsets, self.corners);
        let gap = self.gaps[look][onset][position];
        Some(if far { -gap } else { gap })
    }

    /// What is known of one of the sides in a lane.
    fn course(&self, side: usize, lane: usize) -> Course {
        let (onset, far) = onset_of(side, self.onsets, self.corners);
        let (mut gaps, mut speed) = ([0.0; QUARTERS + 1], 0.0_f64);
        for (gap, values) in gaps.iter_mut().zip(&self.quarters) {
            let value = values[onset][lane];
            *gap = if far { -value } else { value };
            speed = speed.max(values[self.onsets + onset][lane]);
        }
        Course { gaps, speed }
    }

    /// Takes the search in a lane as far as is known what it asks for. True where that is its end; else the place that it asks for is one
    /// of the places.
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

    /// Fills up places, as many as `most`, with those that searches may ask for next.
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
