//! The instructions of each step.
//!
//! An operand that is in no register is read from memory by the instruction that needs it, or is loaded into a register
//! if it is needed again soon.

use super::Target;
use super::abi::Bases;
use super::encode::{Comparison, Encoder, Form, Memory, Operand};
use crate::target::machine::emit::{At, Emitter, Home, Needs, Processor, Writer};
use crate::target::machine::operation::{Binary, Bitwise, CodePosition, Jump, Signs, Vector};
use crate::target::machine::registers::{NEVER, Set};
use crate::target::machine::shape::{Length, Shape};
use crate::target::machine::steps::{Step, StepKind};

/// A value in memory is loaded into a register if it is used again within this many steps.
const SOON: u32 = 12;

/// A processor of x86-64.
pub(super) struct X86 {
    encoder: Encoder,
    bases: Bases,
    /// True if comparisons write to mask registers.
    masks: bool,
}

impl X86 {
    /// A processor that has already written the beginning of a function.
    pub fn new(target: &Target, needs: &Needs) -> Self {
        let mut encoder = Encoder::with_capacity(needs.steps * 10 + 64);
        let bases = Bases::new(needs.uses, needs.calls);
        bases.enter(&mut encoder);
        X86 {
            encoder,
            bases,
            masks: target.masks(),
        }
    }

    /// The memory operand of a place in a region, valid for the next instruction only.
    fn memory(&mut self, (base, offset): At) -> Memory {
        self.bases
            .memory(&mut self.encoder, base, offset.cast_signed())
    }

    fn zero_upper(&mut self, shape: Shape) {
        if shape.length.is_wide() {
            self.encoder.zero_upper();
        }
    }

    fn call_entry(&mut self, index: u32, arguments: At, results: At) {
        let [arguments, results] =
            [arguments, results].map(|(base, offset)| (base, offset.cast_signed()));
        self.bases
            .call(&mut self.encoder, index, arguments, results);
    }
}

impl Length {
    /// True if a value has more than 16 bytes. Then the upper halves of registers must be cleared before code that uses
    /// no AVX.
    fn is_wide(self) -> bool {
        matches!(self, Length::ThirtyTwo | Length::SixtyFour)
    }
}

impl Processor for X86 {
    const TAKEN_FIRST: u32 = u32::MAX;

    fn step(emitter: &mut Emitter<'_, Self>, step: &Step) {
        let operands = step.operands;
        match step.kind {
            StepKind::Binary(operation) => {
                emitter.binary(operation, operands[0], operands[1], step.defines);
            }
            StepKind::Fused(signs) => {
                let [a, b, c, _] = operands;
                emitter.fused(signs, [a, b, c], step.defines);
            }
            StepKind::Select => emitter.select(operands, step.defines),
            StepKind::Sqrt => emitter.root(operands[0], step.defines),
            StepKind::Bits(operation) => emitter.bits(operation, operands, step.defines),
            StepKind::ShiftLeft(places) => emitter.shift_left(places, operands[0], step.defines),
            StepKind::Rare { .. } | StepKind::Call { .. } => unreachable!("not arithmetic"),
        }
    }

    fn jump_if_rare(emitter: &mut Emitter<'_, Self>, size: Vector, limit: u32, keep: Set) -> Jump {
        let limit = Memory::Constant(emitter.constant(limit));
        let limit = match emitter.shape.length {
            Length::SixtyFour => Operand::Broadcast(limit),
            _ => Operand::Memory(limit),
        };
        let shape = emitter.shape;
        if emitter.processor.masks {
            let encoder = &mut emitter.processor.encoder;
            encoder.compare_to_mask(shape, Comparison::NotLess, size, limit);
            encoder.jump_if_masked()
        } else {
            let scratch = emitter.make_room(keep);
            let encoder = &mut emitter.processor.encoder;
            encoder.compare(shape, Comparison::NotLess, [scratch, size], limit);
            encoder.jump_if_signed(shape, scratch)
        }
    }
}

impl Writer for X86 {
    fn load(&mut self, shape: Shape, register: Vector, from: At) {
        let memory = self.memory(from);
        self.encoder.load(shape, register, memory);
    }

    fn load_constant(&mut self, shape: Shape, register: Vector, offset: u32, _: &[u8]) {
        let memory = Memory::Constant(offset);
        match shape.length {
            Length::SixtyFour => self.encoder.broadcast(shape, register, memory),
            _ => self.encoder.load(shape, register, memory),
        }
    }

    fn store(&mut self, shape: Shape, to: At, register: Vector) {
        let memory = self.memory(to);
        self.encoder.store(shape, memory, register);
    }

    fn call(&mut self, shape: Shape, index: u32, arguments: At, results: At) {
        self.zero_upper(shape);
        self.call_entry(index, arguments, results);
    }

    fn call_from_part(&mut self, shape: Shape, index: u32, arguments: At, results: At) {
        self.zero_upper(shape);
        // the return address of this part takes 8 bytes, and the called function must find the stack at a multiple of
        // 16
        self.encoder.lower_stack(8);
        self.call_entry(index, arguments, results);
        self.encoder.lower_stack(-8);
    }

    fn leave_part(&mut self) {
        self.encoder.ret();
    }

    fn changed(&self, _: Vector) -> bool {
        true
    }

    fn leave(&mut self, shape: Shape) {
        self.zero_upper(shape);
        self.bases.leave(&mut self.encoder);
    }

    fn here(&self) -> CodePosition {
        self.encoder.here()
    }

    fn land(&mut self, jump: Jump) {
        self.encoder.land(jump);
    }

    fn jump_to(&mut self, place: CodePosition) {
        self.encoder.jump_to(place);
    }

    fn call_place(&mut self, place: CodePosition) {
        self.encoder.call_place(place);
    }

    fn finish(self, mut constants: Vec<u8>) -> Vec<u8> {
        // a bitwise operation reads 16 bytes from memory, also at the last constant
        constants.extend([0; 12]);
        self.encoder.finish(&constants)
    }
}

impl Emitter<'_, X86> {
    fn binary(&mut self, operation: Binary, first: u32, second: u32, defines: u32) {
        let [mut first, mut second] = [(first, 0), (second, 1)];
        if matches!(operation, Binary::Add | Binary::Mul) {
            let away = |(value, _): (u32, usize)| self.registers.of(value).is_none();
            let swap = match (away(first), away(second)) {
                (true, true) => self.after(second.1) < self.after(first.1),
                (first_away, second_away) => first_away && !second_away,
            };
            if swap {
                std::mem::swap(&mut first, &mut second);
            }
        }
        let keep = self.registers.of(second.0);
        let keep = keep.map_or(Set::default(), |register| Set::default().with(register));
        let source = self.loaded(first.0, keep);
        let operand = self.operand(second.0, keep.with(source), second.1);
        self.used();
        let result = self.destination();
        self.processor
            .encoder
            .binary(self.shape, operation, [result, source], operand);
        self.define(defines, result);
    }

    fn bits(&mut self, operation: Bitwise, [first, second, ..]: [u32; 4], defines: u32) {
        let keep = self.registers.of(second);
        let keep = keep.map_or(Set::default(), |register| Set::default().with(register));
        let source = self.loaded(first, keep);
        let keep = keep.with(source);
        // the instruction reads 16 bytes, but a scalar in memory has fewer, except among the constants
        let whole =
            self.shape.length != Length::Scalar || matches!(self.home(second), Home::Constant(_));
        let mask = match whole {
            true => self.operand(second, keep, 1),
            false => Operand::Register(self.loaded(second, keep)),
        };
        self.used();
        let result = self.destination();
        self.processor
            .encoder
            .bits(self.shape, operation, [result, source], mask);
        self.define(defines, result);
    }

    /// Emits ±(a · b) ± c. The instruction overwrites one of its operands.
    fn fused(&mut self, signs: Signs, operands: [u32; 3], defines: u32) {
        let keep = self.at_most_one_in_memory(operands);
        let registers = operands.map(|value| self.registers.of(value));
        let dies = |i: usize| registers[i].is_some() && self.after(i) == NEVER;
        // an operand that may be overwritten; the addend first, because the factors may be exchanged
        let dying = [2, 0, 1].into_iter().find(|i| dies(*i));
        let overwritten = match dying {
            Some(index) => index,
            // otherwise overwrites a copy of an operand that is in memory, or of the addend
            None => (0..3).find(|i| registers[*i].is_none()).unwrap_or(2),
        };
        let others = match overwritten {
            0 => [1, 2],
            1 => [0, 2],
            _ => [0, 1],
        };
        // the last operand may be in memory
        let [second, third] = match registers[others[0]] {
            Some(_) => others,
            None => [others[1], others[0]],
        };
        let form = match (overwritten, third) {
            (2, _) => Form::F231,
            (_, 2) => Form::F213,
            _ => Form::F132,
        };
        let last = match registers[third] {
            Some(register) => Operand::Register(register),
            None => self.operand(operands[third], keep, third),
        };
        let copied = (dying.is_none()).then(|| self.copied(operands[overwritten], keep));
        self.used();
        let second = registers[second].unwrap_or(Vector(0));
        let result = copied.or(registers[overwritten]).unwrap_or(Vector(0));
        self.processor
            .encoder
            .fused(self.shape, signs, form, [result, second], last);
        self.define(defines, result);
    }

    /// Emits a comparison and a selection: `then` where a < b, `otherwise` elsewhere.
    fn select(&mut self, operands: [u32; 4], defines: u32) {
        let mut keep = Set::default();
        for register in operands
            .iter()
            .filter_map(|value| self.registers.of(*value))
        {
            keep = keep.with(register);
        }
        let first = self.loaded(operands[0], keep);
        keep = keep.with(first);
        let otherwise = self.loaded(operands[3], keep);
        keep = keep.with(otherwise);
        // for scalars, the selection reads a whole register, but memory has only one number
        let scalar = self.shape.length == Length::Scalar;
        if scalar || !self.processor.masks {
            keep = keep.with(self.loaded(operands[2], keep));
        }
        let second = self.operand(operands[1], keep, 1);
        if let Operand::Register(register) = second {
            keep = keep.with(register);
        }
        if self.processor.masks {
            self.processor
                .encoder
                .compare_to_mask(self.shape, Comparison::Less, first, second);
            let then = self.operand(operands[2], keep, 2);
            self.used();
            let result = self.destination();
            self.processor
                .encoder
                .blend_by_mask(self.shape, [result, otherwise], then);
            self.define(defines, result);
        } else {
            let result = self.make_room(keep);
            self.processor
                .encoder
                .compare(self.shape, Comparison::Less, [result, first], second);
            let then = self.operand(operands[2], keep, 2);
            self.used();
            self.processor
                .encoder
                .blend(self.shape, [result, otherwise], then, result);
            self.define(defines, result);
        }
    }

    /// Loads operands until at most one of the values is in memory only, and that one is used only once. Returns the
    /// registers of the others.
    fn at_most_one_in_memory(&mut self, operands: [u32; 3]) -> Set {
        let mut keep = Set::default();
        for register in operands
            .iter()
            .filter_map(|value| self.registers.of(*value))
        {
            keep = keep.with(register);
        }
        loop {
            let away = (0..3).filter(|i| self.registers.of(operands[*i]).is_none());
            let away: Vec<usize> = away.collect();
            if away.len() < 2 {
                return keep;
            }
            let soonest = away.into_iter().min_by_key(|i| self.after(*i)).unwrap_or(0);
            keep = keep.with(self.loaded(operands[soonest], keep));
        }
    }

    /// A register with a copy of a value. The copy may be overwritten.
    fn copied(&mut self, value: u32, keep: Set) -> Vector {
        match self.registers.of(value) {
            Some(source) => {
                let register = self.make_room(keep);
                self.processor.encoder.copy(self.shape, register, source);
                register
            }
            None => {
                let register = self.make_room(keep);
                self.load(register, value);
                register
            }
        }
    }

    fn root(&mut self, value: u32, defines: u32) {
        let source = self.loaded(value, Set::default());
        self.used();
        let result = self.destination();
        let operand = Operand::Register(source);
        let encoder = &mut self.processor.encoder;
        encoder.sqrt(self.shape, [result, source], operand);
        self.define(defines, result);
    }

    fn shift_left(&mut self, places: u8, value: u32, defines: u32) {
        let source = self.loaded(value, Set::default());
        self.used();
        let result = self.destination();
        let encoder = &mut self.processor.encoder;
        encoder.shift_left(self.shape, result, source, places);
        self.define(defines, result);
    }

    /// A value as the last operand of an instruction, which may be in memory. `index` is its index among the operands
    /// of the step.
    fn operand(&mut self, value: u32, keep: Set, index: usize) -> Operand {
        if let Some(register) = self.registers.of(value) {
            return Operand::Register(register);
        }
        let after = self.after(index);
        if after != NEVER && after - self.now < SOON {
            return Operand::Register(self.loaded(value, keep));
        }
        match self.home(value) {
            Home::Constant(at) if self.shape.length == Length::SixtyFour => {
                Operand::Broadcast(Memory::Constant(at))
            }
            Home::Constant(at) => Operand::Memory(Memory::Constant(at)),
            Home::Slot(base, slot) => {
                let at = (base, self.offset(slot));
                Operand::Memory(self.processor.memory(at))
            }
            Home::Nowhere => unreachable!("a value that is neither in a register nor in memory"),
        }
    }
}
