//! Several places of the steps of all lanes, each place in a lane of its own.
//!
//! Lanes have different numbers of samples in a step, and some are looked into while others are not. One lane after the other would leave
//! most of a register idle; so places are packed, whatever lane they belong to.

use crate::real::Several;
use crate::real::lanes::MOST_LANES;

/// Places, as many as a register has lanes or fewer.
pub struct Places<X> {
    /// In which lane each is.
    lanes: [u8; MOST_LANES],
    /// What is wanted there.
    wanted: [X; MOST_LANES],
    count: usize,
}

impl<X: Copy> Places<X> {
    /// None yet; `blank` is anything.
    #[inline(always)]
    pub fn new(blank: X) -> Self {
        Places {
            lanes: [0; MOST_LANES],
            wanted: [blank; MOST_LANES],
            count: 0,
        }
    }

    /// One more, where there is room.
    #[inline(always)]
    pub fn push(&mut self, lane: usize, wanted: X) {
        self.lanes[self.count] = lane as u8;
        self.wanted[self.count] = wanted;
        self.count += 1;
    }

    /// Whether there is no room for more in so many lanes.
    #[inline(always)]
    pub fn full(&self, lanes: usize) -> bool {
        self.count >= lanes
    }

    /// Whether there is none.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// None any more.
    #[inline(always)]
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// Place by place: its lane, and what is wanted there.
    #[inline(always)]
    pub fn each(&self) -> impl Iterator<Item = (usize, X)> {
        // by reference: copies of sixteen would lie in registers
        let all = self.lanes.iter().zip(&self.wanted).take(self.count);
        all.map(|(lane, wanted)| (usize::from(*lane), *wanted))
    }

    /// What is wanted in every lane, after [`Places::pack`].
    #[inline(always)]
    pub fn wanted(&self) -> &[X; MOST_LANES] {
        &self.wanted
    }

    /// The lane of every place, after [`Places::pack`].
    #[inline(always)]
    pub fn lanes(&self) -> &[u8; MOST_LANES] {
        &self.lanes
    }

    /// The order of lanes that the places are in. Lanes that are left over have the first place once more.
    #[inline(always)]
    pub fn pack<T: Several>(&mut self) -> T::Order {
        for left in self.count..T::LANES {
            self.lanes[left] = self.lanes[0];
            self.wanted[left] = self.wanted[0];
        }
        T::order(&self.lanes)
    }
}
