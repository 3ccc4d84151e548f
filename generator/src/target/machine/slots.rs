//! Slots of the frame: places for values that have no register.

/// Keeps track of which slots are taken.
#[derive(Default)]
pub struct Slots {
    /// A bit for each slot: 1 if the slot is free.
    free: Vec<u64>,
    /// Index of the first word that may have a free slot.
    first: usize,
    /// Number of slots that the frame needs so far.
    count: u32,
}

impl Slots {
    /// Number of slots that the frame needs so far.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// Takes a free slot, or a new one.
    pub fn take(&mut self) -> u32 {
        while let Some(word) = self.free.get_mut(self.first) {
            if *word != 0 {
                let bit = word.trailing_zeros();
                *word &= *word - 1;
                return self.first as u32 * 64 + bit;
            }
            self.first += 1;
        }
        self.first = self.first.min(self.free.len());
        self.take_new(1)
    }

    /// Takes `count` neighbouring slots and returns the first.
    pub fn take_several(&mut self, count: u32) -> u32 {
        if count == 1 {
            return self.take();
        }
        let mut found = 0;
        for slot in self.first as u32 * 64..self.count {
            found = match self.is_free(slot) {
                true => found + 1,
                false => 0,
            };
            if found == count {
                let start = slot + 1 - count;
                for slot in start..=slot {
                    self.free[slot as usize / 64] &= !(1 << (slot % 64));
                }
                return start;
            }
        }
        self.take_new(count)
    }

    /// Frees a slot.
    pub fn give_back(&mut self, slot: u32) {
        let word = slot as usize / 64;
        self.free[word] |= 1 << (slot % 64);
        self.first = self.first.min(word);
    }

    fn is_free(&self, slot: u32) -> bool {
        self.free[slot as usize / 64] >> (slot % 64) & 1 != 0
    }

    /// Takes `count` new slots at the end of the frame.
    fn take_new(&mut self, count: u32) -> u32 {
        let start = self.count;
        self.count += count;
        self.free.resize(self.count.div_ceil(64) as usize, 0);
        start
    }
}
