//! The calling convention: the emitted functions, and the functions that they call, are `extern "C"`, by the Procedure
//! Call Standard for the Arm 64-bit Architecture (AAPCS64).
//!
//! Each pointer that a function needs has a general register of its own, and so has the address of the constants. Which
//! pointers are needed, and which registers must be saved, is known only when the code is finished, so the beginning
//! and the end of a function are written last.

use super::encode::{Encoder, General, LINK, SP};
use crate::target::machine::Base;
use crate::target::machine::emit::At;
use crate::target::machine::operation::Vector;

/// The argument of the function: the address of the struct of pointers. In a call, the same register holds the first
/// argument.
const POINTERS: General = General(0);
/// Registers of the second and third argument of functions that are called.
const ARGUMENTS: General = General(1);
const RESULTS: General = General(2);
/// Two registers that hold numbers for a few instructions. A caller must expect that a call changes them.
pub const SCRATCH: General = General(16);
const OTHER_SCRATCH: General = General(17);
const FRAME_POINTER: General = General(29);
/// The first of the registers x19 to x28, which a function must restore.
const FIRST_KEPT: u8 = 19;
/// The vector registers whose lower halves a function must restore: v8 to v15.
pub(super) const KEPT_VECTORS: u32 = 0xff00;

/// The registers that hold the pointers to regions of memory while the function runs.
pub struct Bases {
    /// True if the function calls others. The pointers are then in registers that calls preserve.
    calls: bool,
    /// A bit for each pointer that is used, by its index; the last bit is that of the constants.
    used: u32,
}

/// Index of the bit of the constants in [`Bases::used`], and of their register.
const CONSTANTS: u8 = Base::ALL.len() as u8;

impl Bases {
    pub fn new(calls: bool) -> Self {
        Bases { calls, used: 0 }
    }

    fn register(&self, index: u8) -> General {
        General(index + if self.calls { FIRST_KEPT } else { 1 })
    }

    /// The register with the pointer to a region.
    pub fn base(&mut self, base: Base) -> General {
        self.used |= 1 << base as u8;
        self.register(base as u8)
    }

    /// The register with the address of the constants.
    pub fn constants(&mut self) -> General {
        self.used |= 1 << CONSTANTS;
        self.register(CONSTANTS)
    }

    /// Pairs of general registers and of vector registers that must be saved, in the order of their places on the
    /// stack.
    fn saved(&self, written: u32) -> (Vec<[General; 2]>, Vec<[Vector; 2]>) {
        let mut general = Vec::new();
        if self.calls {
            general.push([FRAME_POINTER, LINK]);
            let pairs = (0..=CONSTANTS).step_by(2);
            let used = pairs.filter(|first| self.used >> first & 3 != 0);
            general.extend(used.map(|first| [first, first + 1].map(|i| self.register(i))));
        }
        let pairs = (0..32).step_by(2);
        let changed = pairs.filter(|first| (written & KEPT_VECTORS) >> first & 3 != 0);
        let vectors = changed.map(|first| [Vector(first), Vector(first + 1)]);
        (general, vectors.collect())
    }

    /// Saves the registers that must be restored, or restores them.
    fn save(&self, encoder: &mut Encoder, written: u32, restore: bool) {
        let (general, vectors) = self.saved(written);
        let bytes = 16 * (general.len() + vectors.len()) as u32;
        if bytes == 0 {
            return;
        }
        if !restore {
            encoder.lower_stack(bytes);
        }
        let mut places = (0..).step_by(16);
        for (pair, at) in general.into_iter().zip(&mut places) {
            encoder.general_pair(!restore, SP, at, pair);
        }
        let first = bytes - 16 * vectors.len() as u32;
        for (pair, at) in vectors.into_iter().zip((first..).step_by(16)) {
            encoder.access_pair(!restore, SP, at, pair);
        }
        if restore {
            encoder.raise_stack(bytes);
        }
    }

    /// Writes the beginning of a function that changes the vector registers in `written`. `constants` is the distance
    /// in bytes from the end of the beginning to the constants; `far` says whether the distance may be 2²⁰ or more. The
    /// number of instructions does not depend on the distance.
    pub fn enter(&self, encoder: &mut Encoder, written: u32, constants: u32, far: bool) {
        self.save(encoder, written, false);
        if self.calls {
            encoder.add(FRAME_POINTER, SP, 0, SCRATCH);
        }
        let is_used = |index: u8| self.used >> index & 1 != 0;
        let mut index = 0;
        while index < CONSTANTS {
            let at = 8 * u32::from(index);
            match (is_used(index), index + 1 < CONSTANTS && is_used(index + 1)) {
                (true, true) => {
                    let pair = [self.register(index), self.register(index + 1)];
                    encoder.general_pair(false, POINTERS, at, pair);
                    index += 1;
                }
                (true, false) => encoder.general(false, POINTERS, at, self.register(index)),
                (false, _) => {}
            }
            index += 1;
        }
        if !is_used(CONSTANTS) {
            return;
        }
        let register = self.register(CONSTANTS);
        if far {
            // the distance counts from ADR: ADR, MOVZ, MOVK and ADD lie between it and the end of the beginning
            encoder.address(register, 0);
            encoder.wide(SCRATCH, constants + 16);
            encoder.sum(register, register, SCRATCH);
        } else {
            encoder.address(register, constants + 4);
        }
    }

    /// Writes the end of a function that changes the vector registers in `written`.
    pub fn leave(&self, encoder: &mut Encoder, written: u32) {
        self.save(encoder, written, true);
        encoder.ret();
    }

    /// Writes a call of the function with this index in the table.
    pub fn call(&mut self, encoder: &mut Encoder, index: u32, arguments: At, results: At) {
        for (register, (base, offset)) in [(ARGUMENTS, arguments), (RESULTS, results)] {
            let base = self.base(base);
            encoder.add(register, base, offset, SCRATCH);
        }
        let mut table = self.base(Base::Functions);
        let mut entry = 16 * index;
        // the largest offset of a load of two registers is 504
        if entry > 504 {
            encoder.add(OTHER_SCRATCH, table, entry, SCRATCH);
            (table, entry) = (OTHER_SCRATCH, 0);
        }
        encoder.general_pair(false, table, entry, [SCRATCH, POINTERS]);
        encoder.call(SCRATCH);
    }

    /// Writes a call like [`call`](Self::call) within a part that is itself called: the return address of the part is
    /// saved.
    pub fn call_from_part(
        &mut self,
        encoder: &mut Encoder,
        index: u32,
        arguments: At,
        results: At,
    ) {
        encoder.lower_stack(16);
        encoder.general(true, SP, 0, LINK);
        self.call(encoder, index, arguments, results);
        encoder.general(false, SP, 0, LINK);
        encoder.raise_stack(16);
    }
}
