//! Keeps track of which value is in which register, and chooses the value to evict if no register is free.

use super::operation::Vector;

/// The step number that means "no step": later than every step.
pub(crate) const NEVER: u32 = u32::MAX;
/// The register number that means "no register".
const NONE: u8 = u8::MAX;
/// The value number that means "no value".
const EMPTY: u32 = u32::MAX;

/// A set of registers.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Set(u32);

impl Set {
    pub fn with(self, register: Vector) -> Set {
        Set(self.0 | 1 << register.0)
    }

    /// The registers that are in either set.
    pub fn and(self, other: Set) -> Set {
        Set(self.0 | other.0)
    }

    fn has(self, register: usize) -> bool {
        self.0 >> register & 1 != 0
    }
}

/// The contents of all registers.
pub(crate) struct Registers {
    count: usize,
    taken_first: u32,
    free: u32,
    /// The value in each register.
    held: [u32; 32],
    /// The register of each value.
    of: Vec<u8>,
    /// The next step that uses each value.
    pub next: Vec<u32>,
}

impl Registers {
    /// All `count` registers are free. Those in `taken_first` are used before the others.
    pub fn new(count: usize, taken_first: u32, first_uses: Vec<u32>) -> Self {
        Registers {
            count,
            taken_first,
            free: (u64::MAX >> (64 - count)) as u32,
            held: [EMPTY; 32],
            of: vec![NONE; first_uses.len()],
            next: first_uses,
        }
    }

    /// The register that holds a value.
    pub fn of(&self, value: u32) -> Option<Vector> {
        let register = self.of[value as usize];
        (register != NONE).then_some(Vector(register))
    }

    /// True if a register is free.
    pub fn any_free(&self) -> bool {
        self.free != 0
    }

    /// A free register, which remains free until [`put`](Self::put).
    pub fn free(&self) -> Option<Vector> {
        let first = self.free & self.taken_first;
        let candidates = if first != 0 { first } else { self.free };
        self.any_free()
            .then(|| Vector(candidates.trailing_zeros() as u8))
    }

    /// The value to evict from its register: the one whose next use is latest (Belady 1966). `stored` says whether a
    /// value is also in memory. Such a value is preferred even if it is used somewhat earlier, because it needs no
    /// store.
    pub fn victim(&self, keep: Set, stored: impl Fn(u32) -> bool) -> u32 {
        let mut victim = (0, EMPTY);
        for register in 0..self.count {
            let value = self.held[register];
            if keep.has(register) || value == EMPTY {
                continue;
            }
            let next = self.next[value as usize];
            let score = next.saturating_add(if stored(value) { STORED } else { 0 });
            if victim.1 == EMPTY || score > victim.0 {
                victim = (score, value);
            }
        }
        victim.1
    }

    /// Puts a value into a free register.
    pub fn put(&mut self, value: u32, register: Vector) {
        self.free &= !(1 << register.0);
        self.held[usize::from(register.0)] = value;
        self.of[value as usize] = register.0;
    }

    /// Removes a value from its register, if it has one.
    pub fn remove(&mut self, value: u32) {
        let register = std::mem::replace(&mut self.of[value as usize], NONE);
        if register != NONE {
            self.held[usize::from(register)] = EMPTY;
            self.free |= 1 << register;
        }
    }

    /// All values that are in registers.
    pub fn values(&self) -> impl Iterator<Item = u32> + use<> {
        self.held.into_iter().filter(|value| *value != EMPTY)
    }
}

/// A value that needs no store is preferred if its next use is at most this many steps earlier.
const STORED: u32 = 16;
