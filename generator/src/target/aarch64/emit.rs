//! The instructions of each step. Operands are loaded into registers, because no arithmetic reads memory.

use super::abi::{Bases, KEPT_VECTORS, SCRATCH};
use super::encode::{
    Access, Condition, Encoder, Form, Instruction, Unary, immediate, is_conditional, long_branch,
    with_distance,
};
use super::pairs;
use crate::target::machine::emit::{At, Emitter, Processor, Writer};
use crate::target::machine::operation::{Binary, Bitwise, CodePosition, Jump, Signs, Vector};
use crate::target::machine::registers::{NEVER, Set};
use crate::target::machine::shape::{Length, Precision, Shape};
use crate::target::machine::steps::{Origin, Step, StepKind};

/// A processor of AArch64.
pub struct Arm {
    pub encoder: Encoder,
    bases: Bases,
    /// The two values of the last comparison of scalars, if the condition flags still hold its result.
    compared: Option<[u32; 2]>,
    /// The index of the instruction before which the end of the function belongs.
    end: usize,
}

impl Arm {
    pub fn new(calls: bool) -> Self {
        Arm {
            encoder: Encoder::default(),
            bases: Bases::new(calls),
            compared: None,
            end: 0,
        }
    }

    fn access(&mut self, store: bool, shape: Shape, (base, offset): At, vector: Vector) {
        let size = form(shape).size();
        let base = self.bases.base(base);
        let units = offset / size.bytes();
        if units > Encoder::FARTHEST {
            self.encoder.wide(SCRATCH, offset);
            self.encoder.access_at(store, size, base, SCRATCH, vector);
            return;
        }
        self.encoder.access(Access {
            store,
            size,
            base,
            offset: units,
            vector,
        });
    }
}

fn form(shape: Shape) -> Form {
    Form {
        lanes: shape.length != Length::Scalar,
        precision: shape.precision,
    }
}

impl Processor for Arm {
    const TAKEN_FIRST: u32 = !KEPT_VECTORS;

    fn step(emitter: &mut Emitter<'_, Self>, step: &Step) {
        let [a, b, c, d] = step.operands;
        match step.kind {
            StepKind::Binary(operation @ (Binary::Max | Binary::Min)) => {
                emitter.extreme(operation, [a, b], step.defines);
            }
            StepKind::Binary(operation) => emitter.binary(operation, [a, b], step.defines),
            StepKind::Fused(signs) if emitter.lanes() => {
                emitter.accumulate(signs, [a, b, c], step.defines);
            }
            StepKind::Fused(signs) => emitter.fused(signs, [a, b, c], step.defines),
            StepKind::Select => emitter.select([a, b], [c, d], step.defines),
            StepKind::Sqrt => emitter.unary(Unary::Sqrt, a, step.defines),
            StepKind::Bits(operation) => emitter.bits(operation, [a, b], step.defines),
            StepKind::ShiftLeft(places) => {
                let [source] = emitter.all_loaded([a]);
                emitter.used();
                let result = emitter.destination();
                let lanes = emitter.lanes();
                let encoder = &mut emitter.processor.encoder;
                encoder.shift_left(lanes, result, source, places);
                emitter.define(step.defines, result);
            }
            StepKind::Rare { .. } | StepKind::Call { .. } => unreachable!("not arithmetic"),
        }
    }

    fn jump_if_rare(emitter: &mut Emitter<'_, Self>, size: Vector, limit: u32, keep: Set) -> Jump {
        // the code behind the branch calls a function, which changes the flags
        emitter.processor.compared = None;
        let Form { lanes, precision } = form(emitter.shape);
        if !lanes && emitter.is_zero(limit) {
            let arm = &mut emitter.processor;
            arm.encoder.compare_with_zero(precision, size);
            return arm.encoder.jump_if(Condition::NotLess);
        }
        let scratch = emitter.make_room(keep);
        emitter.load(scratch, limit);
        let arm = &mut emitter.processor;
        if !lanes {
            arm.encoder.compare(precision, [size, scratch]);
            return arm.encoder.jump_if(Condition::NotLess);
        }
        arm.encoder.greater(precision, scratch, [scratch, size]);
        arm.encoder.smallest_word(scratch, scratch);
        arm.encoder.first_word(SCRATCH, scratch);
        arm.encoder.jump_if_zero(SCRATCH)
    }
}

impl Writer for Arm {
    fn load(&mut self, shape: Shape, register: Vector, from: At) {
        self.access(false, shape, from, register);
    }

    fn load_constant(&mut self, shape: Shape, register: Vector, offset: u32, constants: &[u8]) {
        let bytes = &constants[offset as usize..];
        let number = match shape.precision {
            Precision::Double => f64::from_le_bytes(chunk(bytes)),
            Precision::Single => f64::from(f32::from_le_bytes(chunk(bytes))),
        };
        let form = form(shape);
        if let Some(number) = immediate(number) {
            return self.encoder.number(form, register, number);
        }
        let base = self.bases.constants();
        let units = offset / form.size().bytes();
        if units > Encoder::FARTHEST {
            self.encoder.wide(SCRATCH, offset);
            let encoder = &mut self.encoder;
            return encoder.access_at(false, form.size(), base, SCRATCH, register);
        }
        self.encoder.access(Access {
            store: false,
            size: form.size(),
            base,
            offset: units,
            vector: register,
        });
    }

    fn store(&mut self, shape: Shape, to: At, register: Vector) {
        self.access(true, shape, to, register);
    }

    fn call(&mut self, _: Shape, index: u32, arguments: At, results: At) {
        self.compared = None;
        self.bases
            .call(&mut self.encoder, index, arguments, results);
    }

    fn call_from_part(&mut self, _: Shape, index: u32, arguments: At, results: At) {
        self.bases
            .call_from_part(&mut self.encoder, index, arguments, results);
    }

    fn leave_part(&mut self) {
        self.encoder.ret();
    }

    fn changed(&self, register: Vector) -> bool {
        self.encoder.written >> register.0 & 1 != 0
    }

    fn leave(&mut self, _: Shape) {
        self.end = self.encoder.instructions.len();
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

    fn finish(mut self, constants: Vec<u8>) -> Vec<u8> {
        let written = self.encoder.written;
        let mut borders = vec![false; self.encoder.instructions.len() + 1];
        borders[self.end] = true;
        for branch in &self.encoder.branches {
            borders[branch.to] = true;
        }
        let gone = pairs::join(&mut self.encoder.instructions, &borders);
        let mut end = Encoder::default();
        self.bases.leave(&mut end, written);
        let begin = |distance: u32, far: bool| {
            let mut begin = Encoder::default();
            self.bases.enter(&mut begin, written, distance, far);
            begin.instructions
        };
        let far = {
            let all = [
                &self.encoder.instructions,
                &end.instructions,
                &begin(0, true),
            ];
            let instructions: usize = all.iter().map(|some| some.len()).sum();
            4 * (instructions + self.encoder.branches.len()) + 64 >= NEAR
        };
        // the length of the beginning does not depend on the distance to the constants
        let first = begin(0, far).len();
        let code = self.body(&gone, &end.instructions, far);
        let start = (4 * (first + code.len())).next_multiple_of(64);
        let mut bytes = Vec::with_capacity(start + constants.len());
        let begin = begin((start - 4 * first) as u32, far);
        for word in begin.iter().map(|instruction| instruction.word).chain(code) {
            bytes.extend(word.to_le_bytes());
        }
        while bytes.len() < start {
            bytes.extend(BREAKPOINT.to_le_bytes());
        }
        bytes.extend(constants);
        bytes
    }
}

/// A distance in bytes that conditional branches and the instruction for the address of the constants can reach; their
/// exact limit is a little farther.
const NEAR: usize = 1 << 20;
/// BRK: fills the bytes between code and constants, and is never executed.
const BREAKPOINT: u32 = 0xd420_0000;

impl Arm {
    /// All instructions after the beginning of the function, without those in `gone`, and with the end of the function
    /// in its place. If the code is long, a conditional branch becomes the opposite branch, which skips an
    /// unconditional one.
    fn body(&self, gone: &[bool], end: &[Instruction], far: bool) -> Vec<u32> {
        let instructions = &self.encoder.instructions;
        let mut code: Vec<u32> = Vec::with_capacity(instructions.len() + end.len());
        let mut places = Vec::with_capacity(instructions.len() + 1);
        let all = instructions.iter().zip(gone).map(Some).chain([None]);
        for (index, next) in all.enumerate() {
            if index == self.end {
                code.extend(end.iter().map(|instruction| instruction.word));
            }
            places.push(code.len());
            match next {
                Some((instruction, false)) if far => code.extend(long_branch(instruction.word)),
                Some((instruction, false)) => code.push(instruction.word),
                _ => {}
            }
        }
        for branch in &self.encoder.branches {
            let [mut at, to] = [branch.at, branch.to].map(|index| places[index]);
            if far && is_conditional(instructions[branch.at].word) {
                at += 1;
            }
            code[at] = with_distance(code[at], to as i64 - at as i64);
        }
        code
    }
}

/// The first bytes of a slice.
fn chunk<const N: usize>(bytes: &[u8]) -> [u8; N] {
    std::array::from_fn(|i| bytes[i])
}

impl Emitter<'_, Arm> {
    fn lanes(&self) -> bool {
        self.shape.length != Length::Scalar
    }

    fn form(&self) -> Form {
        form(self.shape)
    }

    /// True if a value is the constant 0 or −0.
    fn is_zero(&self, value: u32) -> bool {
        self.steps.origins[value as usize] == Origin::Constant(0.0)
    }

    /// True if a value is a constant with these bits.
    fn is_constant(&self, value: u32, bits: u64) -> bool {
        match self.steps.origins[value as usize] {
            Origin::Constant(number) => number.to_bits() == bits,
            _ => false,
        }
    }

    /// The registers of those values that are in one.
    fn present(&self, values: &[u32]) -> Set {
        let registers = values.iter().filter_map(|value| self.registers.of(*value));
        registers.fold(Set::default(), Set::with)
    }

    /// Loads these values, so that all are in registers at the same time, and returns the registers.
    fn all_loaded<const N: usize>(&mut self, values: [u32; N]) -> [Vector; N] {
        self.loaded_beside(values, Set::default())
    }

    /// Like [`all_loaded`](Self::all_loaded), without overwriting the registers in `keep`.
    fn loaded_beside<const N: usize>(&mut self, values: [u32; N], keep: Set) -> [Vector; N] {
        let mut keep = keep.and(self.present(&values));
        values.map(|value| {
            let register = self.loaded(value, keep);
            keep = keep.with(register);
            register
        })
    }

    fn binary(&mut self, operation: Binary, operands: [u32; 2], defines: u32) {
        let registers = self.all_loaded(operands);
        self.used();
        let result = self.destination();
        let form = self.form();
        let encoder = &mut self.processor.encoder;
        encoder.binary(form, operation, result, registers);
        self.define(defines, result);
    }

    fn unary(&mut self, operation: Unary, value: u32, defines: u32) {
        let [source] = self.all_loaded([value]);
        self.used();
        let result = self.destination();
        let form = self.form();
        let encoder = &mut self.processor.encoder;
        encoder.unary(form, operation, result, source);
        self.define(defines, result);
    }

    fn bits(&mut self, operation: Bitwise, operands: [u32; 2], defines: u32) {
        const SIGN: u64 = 1 << 63;
        let [value, mask] = operands;
        if operation == Bitwise::Xor && self.is_constant(mask, SIGN) {
            return self.unary(Unary::Neg, value, defines);
        }
        let double = self.shape.precision == Precision::Double;
        if double && operation == Bitwise::And && self.is_constant(mask, !SIGN) {
            return self.unary(Unary::Abs, value, defines);
        }
        let registers = self.all_loaded(operands);
        self.used();
        let result = self.destination();
        self.processor.encoder.bits(operation, result, registers);
        self.define(defines, result);
    }

    /// ±(a · b) ± c of scalars.
    fn fused(&mut self, signs: Signs, operands: [u32; 3], defines: u32) {
        let registers = self.all_loaded(operands);
        self.used();
        let result = self.destination();
        let precision = self.shape.precision;
        let encoder = &mut self.processor.encoder;
        encoder.fused(precision, signs, result, registers);
        self.define(defines, result);
    }

    /// ±(a · b) ± c of lanes. The instruction overwrites the addend c, so it works on a copy of c unless c is no longer
    /// needed.
    fn accumulate(&mut self, signs: Signs, operands: [u32; 3], defines: u32) {
        let [a, b, c] = self.all_loaded(operands);
        let overwritten = self.after(2) == NEVER && !(signs.addend && (c == a || c == b));
        let sum = match overwritten {
            true => c,
            false => self.make_room([a, b, c].into_iter().fold(Set::default(), Set::with)),
        };
        self.used();
        let form = self.form();
        let encoder = &mut self.processor.encoder;
        if signs.addend {
            encoder.unary(form, Unary::Neg, sum, c);
        } else if !overwritten {
            encoder.unary(form, Unary::Copy, sum, c);
        }
        encoder.accumulate(form.precision, signs.product, sum, [a, b]);
        self.define(defines, sum);
    }

    /// The larger or the smaller of two values; the second one if either is NaN.
    fn extreme(&mut self, operation: Binary, [a, b]: [u32; 2], defines: u32) {
        let below = match operation {
            Binary::Max => [b, a],
            _ => [a, b],
        };
        self.select(below, [a, b], defines);
    }

    /// The first of the two `chosen` values where a < b, the second one elsewhere.
    fn select(&mut self, [a, b]: [u32; 2], chosen: [u32; 2], defines: u32) {
        let keep = self.present(&[a, b, chosen[0], chosen[1]]);
        let precision = self.shape.precision;
        if self.lanes() {
            let [a, b, then, otherwise] = self.loaded_beside([a, b, chosen[0], chosen[1]], keep);
            let keep = [a, b, then, otherwise].into_iter();
            let mask = self.make_room(keep.fold(Set::default(), Set::with));
            self.used();
            let encoder = &mut self.processor.encoder;
            encoder.greater(precision, mask, [b, a]);
            encoder.blend(mask, [then, otherwise]);
            return self.define(defines, mask);
        }
        let condition = self.compare([a, b], keep);
        let registers = self.loaded_beside(chosen, Set::default());
        self.used();
        let result = self.destination();
        let encoder = &mut self.processor.encoder;
        encoder.choose(precision, condition, result, registers);
        self.define(defines, result);
    }

    /// Compares a and b, unless the condition flags already hold that comparison. Returns the condition that is true if
    /// a < b.
    fn compare(&mut self, [a, b]: [u32; 2], keep: Set) -> Condition {
        let precision = self.shape.precision;
        let compared = self.processor.compared;
        if compared == Some([a, b]) {
            return Condition::Less;
        }
        if compared == Some([b, a]) {
            return Condition::Greater;
        }
        if self.is_zero(a) {
            let [b_register] = self.loaded_beside([b], keep);
            let arm = &mut self.processor;
            arm.encoder.compare_with_zero(precision, b_register);
            arm.compared = Some([b, a]);
            return Condition::Greater;
        }
        self.processor.compared = Some([a, b]);
        if self.is_zero(b) {
            let [a] = self.loaded_beside([a], keep);
            let encoder = &mut self.processor.encoder;
            encoder.compare_with_zero(precision, a);
        } else {
            let registers = self.loaded_beside([a, b], keep);
            self.processor.encoder.compare(precision, registers);
        }
        Condition::Less
    }
}
