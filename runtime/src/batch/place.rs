//! Several places within the steps of lanes, packed so that each place has a lane of a register.
//!
//! Lanes have different numbers of samples in a step, and only some steps are searched. One lane after the other would
//! leave most of a register idle, so places are packed whatever lane they belong to.

use crate::real::Several;
use crate::real::lanes::MOST_LANES;

/// Up to as many places as a register has lanes.
pub struct Places<X> {
    /// The lane of each place.
    lanes: [u8; MOST_LANES],
    /// The request at each place.
    wanted: [X; MOST_LANES],
    count: usize,
}

impl<X: Copy> Places<X> {
    /// An empty list; `blank` is any value.
    #[inline(always)]
    pub fn new(blank: X) -> Self {
        Places {
            lanes: [0; MOST_LANES],
            wanted: [blank; MOST_LANES],
            count: 0,
        }
    }

    /// Adds a place; there must be room.
    #[inline(always)]
    pub fn push(&mut self, lane: usize, wanted: X) {
        self.lanes[self.count] = lane as u8;
        self.wanted[self.count] = wanted;
        self.count += 1;
    }

    /// True if there is no room for more, given this number of lanes.
    #[inline(always)]
    pub fn full(&self, lanes: usize) -> bool {
        self.count >= lanes
    }

    /// True if there are no places.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Removes all places.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// The lane and the request of each place.
    #[inline(always)]
    pub fn each(&self) -> impl Iterator<Item = (usize, X)> {
        // by reference: a copied array of sixteen would be held in registers
        let all = self.lanes.iter().zip(&self.wanted).take(self.count);
        all.map(|(lane, wanted)| (usize::from(*lane), *wanted))
    }

    /// The request in every lane, after [`Places::pack`].
    #[inline(always)]
    pub fn wanted(&self) -> &[X; MOST_LANES] {
        &self.wanted
    }

    /// The lane of every place, after [`Places::pack`].
    #[inline(always)]
    pub fn lanes(&self) -> &[u8; MOST_LANES] {
        &self.lanes
    }

    /// Returns the permutation that brings the lanes to their places. Unused lanes repeat the first place.
    #[inline(always)]
    pub fn pack<T: Several>(&mut self) -> T::Order {
        for left in self.count..T::LANES {
            self.lanes[left] = self.lanes[0];
            self.wanted[left] = self.wanted[0];
        }
        T::order(&self.lanes)
    }
}
