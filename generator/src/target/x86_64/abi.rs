//! The calling convention: the emitted functions, and the functions that they call, are `extern "sysv64"`.
//!
//! The pointers that a function needs are kept in general registers. If there are more pointers than registers, the
//! others are read from the struct of pointers at each use.

use super::encode::{Encoder, General, Memory};
use crate::target::machine::Base;

/// Registers that a function may change without restoring them, except the scratch register and the one with the
/// pointers.
const FREE: [General; 7] = [
    General::Rsi,
    General::Rdx,
    General::Rcx,
    General::R8,
    General::R9,
    General::R10,
    General::R11,
];
/// Registers that a function must restore, except the one with the pointers. Registers with shorter encodings come
/// first.
const KEPT: [General; 5] = [
    General::Rbp,
    General::R14,
    General::R15,
    General::R13,
    General::R12,
];
/// Holds an address for the next instruction.
const SCRATCH: General = General::Rax;

/// The registers that hold the pointers to regions of memory while the function runs.
pub(super) struct Bases {
    /// The register with the address of the struct of pointers.
    pointers: General,
    registers: [Option<General>; Base::ALL.len()],
    /// Registers that the function saves and restores.
    saved: Vec<General>,
    /// True if the stack pointer must be moved by 8 bytes, so that it is a multiple of 16 in calls.
    align: bool,
}

impl Bases {
    /// Gives registers to the regions that are used most, given the number of uses of each.
    pub fn new(uses: [u32; Base::ALL.len()], calls: bool) -> Self {
        let mut order = Base::ALL;
        order.sort_by_key(|base| std::cmp::Reverse(uses[*base as usize]));
        let used = order.into_iter().filter(|base| uses[*base as usize] > 0);
        let (pointers, candidates): (General, &[General]) = match calls {
            true => (General::Rbx, &KEPT),
            false => (General::Rdi, &FREE),
        };
        let mut registers = [None; Base::ALL.len()];
        let mut saved = Vec::new();
        if calls {
            saved.push(pointers);
        }
        for (base, register) in used.zip(candidates) {
            registers[base as usize] = Some(*register);
            if calls {
                saved.push(*register);
            }
        }
        Bases {
            pointers,
            registers,
            // the return address takes eight bytes
            align: calls && saved.len().is_multiple_of(2),
            saved,
        }
    }

    /// Writes the beginning of a function.
    pub fn enter(&self, encoder: &mut Encoder) {
        for register in &self.saved {
            encoder.push(*register);
        }
        if self.align {
            encoder.lower_stack(8);
        }
        if self.pointers != General::Rdi {
            encoder.move_general(self.pointers, General::Rdi);
        }
        for base in Base::ALL {
            if let Some(register) = self.registers[base as usize] {
                encoder.load_general(register, self.pointer(base));
            }
        }
    }

    /// Writes the end of a function.
    pub fn leave(&self, encoder: &mut Encoder) {
        if self.align {
            encoder.lower_stack(-8);
        }
        for register in self.saved.iter().rev() {
            encoder.pop(*register);
        }
        encoder.ret();
    }

    /// The memory operand of a place in a region. It is valid for the next instruction only, because its address may be
    /// in the scratch register.
    pub fn memory(&self, encoder: &mut Encoder, base: Base, offset: i32) -> Memory {
        let register = self.registers[base as usize].unwrap_or_else(|| {
            encoder.load_general(SCRATCH, self.pointer(base));
            SCRATCH
        });
        Memory::At(register, offset)
    }

    /// The memory that holds the pointer to a region.
    fn pointer(&self, base: Base) -> Memory {
        Memory::At(self.pointers, 8 * i32::from(base as u8))
    }

    /// Writes a call of the function with this index in the table.
    pub fn call(
        &self,
        encoder: &mut Encoder,
        index: u32,
        arguments: (Base, i32),
        results: (Base, i32),
    ) {
        let arguments = self.memory(encoder, arguments.0, arguments.1);
        encoder.address(General::Rsi, arguments);
        let results = self.memory(encoder, results.0, results.1);
        encoder.address(General::Rdx, results);
        let entry = 16 * index.cast_signed();
        let Memory::At(table, _) = self.memory(encoder, Base::Functions, 0) else {
            unreachable!("a base is no constant");
        };
        encoder.load_general(General::Rdi, Memory::At(table, entry + 8));
        encoder.call(Memory::At(table, entry));
    }
}
