//! The encoding of the instructions that this target needs.
//!
//! Instructions on vector registers have a VEX prefix if possible. They have an EVEX prefix with 64-byte registers,
//! with registers 16 to 31, and where memory is broadcast. The layouts are those of the Intel manual, volume 2,
//! chapter 2.

use crate::target::machine::operation::{Binary, Bitwise, CodePosition, Jump, Signs, Vector};
use crate::target::machine::shape::{Length, Precision, Shape};

/// A general register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum General {
    /// Scratch.
    Rax = 0,
    /// Fourth argument of a call.
    Rcx = 1,
    /// Third argument of a call.
    Rdx = 2,
    /// Preserved by calls.
    Rbx = 3,
    /// The stack.
    Rsp = 4,
    /// Preserved by calls.
    Rbp = 5,
    /// Second argument of a call.
    Rsi = 6,
    /// First argument of a call.
    Rdi = 7,
    /// Fifth argument of a call.
    R8 = 8,
    /// Sixth argument of a call.
    R9 = 9,
    /// Scratch.
    R10 = 10,
    /// Scratch.
    R11 = 11,
    /// Preserved by calls.
    R12 = 12,
    /// Preserved by calls.
    R13 = 13,
    /// Preserved by calls.
    R14 = 14,
    /// Preserved by calls.
    R15 = 15,
}

/// A place in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// The address in a register, plus an offset in bytes.
    At(General, i32),
    /// An offset in bytes from the beginning of the constants, which follow the code.
    Constant(u32),
}

/// The last operand of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operand {
    /// A register.
    Register(Vector),
    /// Memory: as many bytes as the instruction processes.
    Memory(Memory),
    /// One number in memory, which is used in every lane.
    Broadcast(Memory),
}

/// The condition of a comparison. With a NaN it is false or true as stated; no exception is raised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// first < second; false with a NaN
    Less,
    /// not first < second; true with a NaN
    NotLess,
}

impl Comparison {
    const fn predicate(self) -> u8 {
        match self {
            Comparison::Less => 0x11,
            Comparison::NotLess => 0x15,
        }
    }
}

/// The operands that a fused operation multiplies: 1 is the destination, 2 the register, 3 the last operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// 1 · 3 + 2
    F132,
    /// 2 · 1 + 3
    F213,
    /// 2 · 3 + 1
    F231,
}

/// Everything that identifies an instruction on vector registers, except its operands.
#[derive(Clone, Copy)]
struct Opcode {
    /// The opcode map: 1 for 0F, 2 for 0F 38, 3 for 0F 3A.
    map: u8,
    /// The mandatory prefix: 0 for none, 1 for 66, 2 for F3, 3 for F2.
    prefix: u8,
    /// The bit W of a VEX prefix, and that of an EVEX prefix.
    wide: [bool; 2],
    code: u8,
    length: Length,
    /// The unit of an EVEX displacement in bytes, if memory is not broadcast.
    unit: u32,
    /// The unit of an EVEX displacement in bytes, if memory is broadcast.
    element: u32,
}

/// A displacement to the constants that must still be filled in.
struct Fixup {
    /// Position of the displacement in the code, in bytes.
    at: usize,
    /// Offset of the constant from the beginning of the constants, in bytes.
    constant: u32,
    /// Number of bytes of the instruction after the displacement.
    behind: usize,
}

/// The code so far.
#[derive(Default)]
pub struct Encoder {
    bytes: Vec<u8>,
    fixups: Vec<Fixup>,
}

impl Encoder {
    /// An encoder without code, with room for this many bytes.
    pub fn with_capacity(bytes: usize) -> Self {
        Encoder {
            bytes: Vec::with_capacity(bytes),
            fixups: Vec::new(),
        }
    }

    /// The code, followed by the constants from the next multiple of 64 bytes on.
    pub fn finish(mut self, constants: &[u8]) -> Vec<u8> {
        let start = self.bytes.len().next_multiple_of(64);
        for Fixup {
            at,
            constant,
            behind,
        } in self.fixups
        {
            let end = at + 4;
            let displacement = (start - end - behind) as u32 + constant;
            self.bytes[at..end].copy_from_slice(&displacement.to_le_bytes());
        }
        const BREAKPOINT: u8 = 0xcc;
        self.bytes.resize(start, BREAKPOINT);
        self.bytes.extend_from_slice(constants);
        self.bytes
    }

    /// destination = first ∘ second
    pub fn binary(
        &mut self,
        shape: Shape,
        operation: Binary,
        [destination, first]: [Vector; 2],
        second: Operand,
    ) {
        let code = match operation {
            Binary::Add => 0x58,
            Binary::Mul => 0x59,
            Binary::Sub => 0x5c,
            Binary::Min => 0x5d,
            Binary::Div => 0x5e,
            Binary::Max => 0x5f,
        };
        self.vector(arithmetic(shape, code), destination, first, second);
    }

    /// destination = √operand. For scalars, the lanes beyond the first come from `first`; unless `first` is the operand
    /// itself, the instruction has to wait for it as well.
    pub fn sqrt(&mut self, shape: Shape, [destination, first]: [Vector; 2], operand: Operand) {
        let first = match shape.length {
            Length::Scalar => first,
            _ => Vector(0),
        };
        self.vector(arithmetic(shape, 0x51), destination, first, operand);
    }

    /// destination = first ∘ second, bit by bit. From memory, the instruction reads a whole register or a broadcast
    /// number; for scalars 16 bytes.
    pub fn bits(
        &mut self,
        shape: Shape,
        operation: Bitwise,
        [destination, first]: [Vector; 2],
        second: Operand,
    ) {
        let code = match operation {
            Bitwise::And => 0x54,
            Bitwise::Xor => 0x57,
        };
        self.vector(arithmetic(shape.whole(), code), destination, first, second);
    }

    /// destination = the bits of each double, shifted left. For scalars, the whole register is shifted.
    pub fn shift_left(&mut self, shape: Shape, destination: Vector, source: Vector, places: u8) {
        let opcode = Opcode {
            prefix: 1,
            wide: [false, true],
            ..arithmetic(shape.whole(), 0x73)
        };
        // the field of the destination holds a part of the operation code; the destination is in the field of the
        // second operand
        let shift = Vector(6);
        self.vector(opcode, shift, destination, Operand::Register(source));
        self.immediate(places);
    }

    /// The product of two operands plus the third, with these signs, rounded once.
    pub fn fused(
        &mut self,
        shape: Shape,
        signs: Signs,
        form: Form,
        [destination, second]: [Vector; 2],
        third: Operand,
    ) {
        let by_signs = match (signs.product, signs.addend) {
            (false, false) => 0x98,
            (false, true) => 0x9a,
            (true, false) => 0x9c,
            (true, true) => 0x9e,
        };
        let by_form = match form {
            Form::F132 => 0x00,
            Form::F213 => 0x10,
            Form::F231 => 0x20,
        };
        let scalar = u8::from(shape.length == Length::Scalar);
        let opcode = Opcode {
            map: 2,
            prefix: 1,
            wide: [shape.precision == Precision::Double; 2],
            ..arithmetic(shape, by_signs + by_form + scalar)
        };
        self.vector(opcode, destination, second, third);
    }

    /// destination = all bits set in each number for which the comparison holds, no bits elsewhere. Not for registers
    /// 16 to 31, nor for 64 bytes.
    pub fn compare(
        &mut self,
        shape: Shape,
        comparison: Comparison,
        [destination, first]: [Vector; 2],
        second: Operand,
    ) {
        self.vector(arithmetic(shape, 0xc2), destination, first, second);
        self.immediate(comparison.predicate());
    }

    /// destination = for each number, `then` if the first bit of the same number in `mask` is set, otherwise
    /// `otherwise`. For scalars, the whole register is written. Not for registers 16 to 31, nor for 64 bytes.
    pub fn blend(
        &mut self,
        shape: Shape,
        [destination, otherwise]: [Vector; 2],
        then: Operand,
        mask: Vector,
    ) {
        let opcode = Opcode {
            map: 3,
            prefix: 1,
            wide: [false; 2],
            ..arithmetic(
                shape.whole(),
                match shape.precision {
                    Precision::Double => 0x4b,
                    Precision::Single => 0x4a,
                },
            )
        };
        self.vector(opcode, destination, otherwise, then);
        self.immediate(mask.0 << 4);
    }

    /// Mask register 1 = the lanes in which the comparison holds. The instruction has an EVEX prefix.
    pub fn compare_to_mask(
        &mut self,
        shape: Shape,
        comparison: Comparison,
        first: Vector,
        second: Operand,
    ) {
        let opcode = arithmetic(shape, 0xc2);
        self.with_evex(opcode, Vector(1), first, second, 0);
        self.immediate(comparison.predicate());
    }

    /// Jumps if a bit of mask register 1 is set; the mask has at most 16 bits. [`land`](Self::land) sets the target.
    pub fn jump_if_masked(&mut self) -> Jump {
        // kortestw k1, k1
        self.bytes.extend([0xc5, 0xf8, 0x98, 0xc9]);
        self.jump_if_not_zero()
    }

    /// Jumps if any number in a register has its sign bit set; for scalars, only the first number counts.
    /// [`land`](Self::land) sets the target. The scratch register is changed. Not for registers 16 to 31, nor for 64
    /// bytes.
    pub fn jump_if_signed(&mut self, shape: Shape, source: Vector) -> Jump {
        let opcode = Opcode {
            wide: [false; 2],
            ..arithmetic(shape.whole(), 0x50)
        };
        let eax = Vector(General::Rax as u8);
        self.vector(opcode, eax, Vector(0), Operand::Register(source));
        let lanes = shape.bytes() / shape.precision.bytes();
        // test al, lanes
        self.bytes.extend([0xa8, ((1_u32 << lanes) - 1) as u8]);
        self.jump_if_not_zero()
    }

    fn jump_if_not_zero(&mut self) -> Jump {
        self.bytes.extend([0x0f, 0x85]);
        self.displacement()
    }

    /// Jumps back to a place.
    pub fn jump_to(&mut self, place: CodePosition) {
        self.bytes.push(0xe9);
        let jump = self.displacement();
        self.fill_in(jump, place);
    }

    /// Calls the function at a place in the code.
    pub fn call_place(&mut self, place: CodePosition) {
        self.bytes.push(0xe8);
        let jump = self.displacement();
        self.fill_in(jump, place);
    }

    fn displacement(&mut self) -> Jump {
        let jump = Jump(self.bytes.len());
        self.bytes.extend([0; 4]);
        jump
    }

    /// The place of the next instruction.
    pub fn here(&self) -> CodePosition {
        CodePosition(self.bytes.len())
    }

    /// Makes a jump go to the next instruction.
    pub fn land(&mut self, jump: Jump) {
        let here = self.here();
        self.fill_in(jump, here);
    }

    fn fill_in(&mut self, Jump(at): Jump, CodePosition(place): CodePosition) {
        let end = at + 4;
        let distance = (place as i64 - end as i64) as i32;
        self.bytes[at..end].copy_from_slice(&distance.to_le_bytes());
    }

    /// destination = `then` where mask register 1 is set, `otherwise` elsewhere. For scalars, the whole register is
    /// written. The instruction has an EVEX prefix.
    pub fn blend_by_mask(
        &mut self,
        shape: Shape,
        [destination, otherwise]: [Vector; 2],
        then: Operand,
    ) {
        let opcode = Opcode {
            map: 2,
            prefix: 1,
            ..arithmetic(shape.whole(), 0x65)
        };
        self.with_evex(opcode, destination, otherwise, then, 1);
    }

    /// destination = source, for the whole register.
    pub fn copy(&mut self, shape: Shape, destination: Vector, source: Vector) {
        let opcode = arithmetic(shape.whole(), 0x28);
        self.vector(opcode, destination, Vector(0), Operand::Register(source));
    }

    /// destination = memory, at any alignment. A load of a scalar sets the rest of the register to zero.
    pub fn load(&mut self, shape: Shape, destination: Vector, source: Memory) {
        let opcode = arithmetic(shape, 0x10);
        self.vector(opcode, destination, Vector(0), Operand::Memory(source));
    }

    /// memory = source, at any alignment.
    pub fn store(&mut self, shape: Shape, destination: Memory, source: Vector) {
        let opcode = arithmetic(shape, 0x11);
        self.vector(opcode, source, Vector(0), Operand::Memory(destination));
    }

    /// Every lane of the destination = one number in memory. Not for scalars.
    pub fn broadcast(&mut self, shape: Shape, destination: Vector, source: Memory) {
        let code = match shape.precision {
            Precision::Double => 0x19,
            Precision::Single => 0x18,
        };
        let opcode = Opcode {
            map: 2,
            prefix: 1,
            wide: [false, shape.precision == Precision::Double],
            unit: shape.precision.bytes(),
            ..arithmetic(shape, code)
        };
        self.vector(opcode, destination, Vector(0), Operand::Memory(source));
    }

    /// Sets the upper halves of all vector registers to zero, before code that uses only the lower halves.
    pub fn zero_upper(&mut self) {
        self.bytes.extend([0xc5, 0xf8, 0x77]);
    }

    /// Pushes a register on the stack.
    pub fn push(&mut self, register: General) {
        self.short(0x50, register);
    }

    /// Pops a register from the stack.
    pub fn pop(&mut self, register: General) {
        self.short(0x58, register);
    }

    /// destination = source
    pub fn move_general(&mut self, destination: General, source: General) {
        let (reg, rm) = (destination as u8, source as u8);
        self.bytes.push(0x48 | reg >> 3 << 2 | rm >> 3);
        self.bytes.extend([0x8b, 0xc0 | (reg & 7) << 3 | rm & 7]);
    }

    /// destination = 8 bytes of memory
    pub fn load_general(&mut self, destination: General, source: Memory) {
        self.general(true, 0x8b, destination as u8, source);
    }

    /// destination = address of the memory operand
    pub fn address(&mut self, destination: General, of: Memory) {
        self.general(true, 0x8d, destination as u8, of);
    }

    /// Calls the function whose address is in memory.
    pub fn call(&mut self, address: Memory) {
        self.general(false, 0xff, 2, address);
    }

    /// Moves the stack pointer down by this many bytes; up if negative.
    pub fn lower_stack(&mut self, bytes: i8) {
        self.bytes.extend([0x48, 0x83, 0xec, bytes.cast_unsigned()]);
    }

    /// Returns to the caller.
    pub fn ret(&mut self) {
        self.bytes.push(0xc3);
    }

    /// Writes an instruction of one byte that contains its register, after a prefix for registers 8 to 15.
    fn short(&mut self, code: u8, register: General) {
        let register = register as u8;
        if register > 7 {
            self.bytes.push(0x41);
        }
        self.bytes.push(code | register & 7);
    }

    /// Writes an instruction with a general register and a memory operand.
    fn general(&mut self, wide: bool, code: u8, reg: u8, memory: Memory) {
        let base = base_bit(memory);
        let rex = 0x40 | u8::from(wide) << 3 | reg >> 3 << 2 | base;
        if rex != 0x40 {
            self.bytes.push(rex);
        }
        self.bytes.push(code);
        self.memory(reg, memory, 1);
    }

    /// Writes an instruction on vector registers. `reg` is the destination, or the register to store; `second` is 0 if
    /// there is none.
    fn vector(&mut self, opcode: Opcode, reg: Vector, second: Vector, last: Operand) {
        let high = |register: Vector| register.0 > 15;
        let evex = opcode.length == Length::SixtyFour
            || high(reg)
            || high(second)
            || match last {
                Operand::Register(register) => high(register),
                Operand::Memory(_) => false,
                Operand::Broadcast(_) => true,
            };
        match evex {
            true => self.with_evex(opcode, reg, second, last, 0),
            false => {
                self.vex(&opcode, reg.0, second.0, last);
                self.bytes.push(opcode.code);
                self.last_operand(reg, last, 1);
            }
        }
    }

    /// Writes an instruction on vector registers with an EVEX prefix. It works on the numbers that mask register `mask`
    /// selects; on all numbers if `mask` is 0.
    fn with_evex(&mut self, opcode: Opcode, reg: Vector, second: Vector, last: Operand, mask: u8) {
        self.evex(&opcode, reg.0, second.0, last, mask);
        self.bytes.push(opcode.code);
        let unit = match last {
            Operand::Broadcast(_) => opcode.element,
            _ => opcode.unit,
        };
        self.last_operand(reg, last, unit);
    }

    /// Writes the bytes for the operands that are not in the prefix.
    fn last_operand(&mut self, reg: Vector, last: Operand, unit: u32) {
        match last {
            Operand::Register(register) => {
                self.bytes.push(0xc0 | (reg.0 & 7) << 3 | register.0 & 7);
            }
            Operand::Memory(memory) | Operand::Broadcast(memory) => {
                self.memory(reg.0, memory, unit);
            }
        }
    }

    /// Writes a VEX prefix of two or three bytes. Register bits are inverted in it.
    fn vex(&mut self, opcode: &Opcode, reg: u8, second: u8, last: Operand) {
        let b = match last {
            Operand::Register(register) => register.0 >> 3 & 1,
            Operand::Memory(memory) | Operand::Broadcast(memory) => base_bit(memory),
        };
        let r = (!reg >> 3 & 1) << 7;
        let long = u8::from(opcode.length == Length::ThirtyTwo) << 2;
        let rest = (!second & 15) << 3 | long | opcode.prefix;
        let wide = opcode.wide[0];
        if opcode.map == 1 && b == 0 && !wide {
            self.bytes.extend([0xc5, r | rest]);
        } else {
            let first = r | 0x40 | (1 - b) << 5 | opcode.map;
            self.bytes.extend([0xc4, first, u8::from(wide) << 7 | rest]);
        }
    }

    /// Writes an immediate operand at the end of an instruction.
    fn immediate(&mut self, value: u8) {
        if let Some(fixup) = self.fixups.last_mut()
            && fixup.at + 4 == self.bytes.len()
        {
            fixup.behind = 1;
        }
        self.bytes.push(value);
    }

    /// Writes an EVEX prefix of four bytes. Register bits are inverted in it.
    fn evex(&mut self, opcode: &Opcode, reg: u8, second: u8, last: Operand, mask: u8) {
        let (x, b, broadcast) = match last {
            Operand::Register(Vector(register)) => (register >> 4 & 1, register >> 3 & 1, 0),
            Operand::Memory(memory) => (0, base_bit(memory), 0),
            Operand::Broadcast(memory) => (0, base_bit(memory), 1),
        };
        let length = match opcode.length {
            Length::Scalar | Length::Sixteen => 0,
            Length::ThirtyTwo => 1,
            Length::SixtyFour => 2,
        };
        let registers = (!reg >> 3 & 1) << 7 | (1 - x) << 6 | (1 - b) << 5 | (!reg >> 4 & 1) << 4;
        let wide = u8::from(opcode.wide[1]) << 7;
        self.bytes.extend([
            0x62,
            registers | opcode.map,
            wide | (!second & 15) << 3 | 0x04 | opcode.prefix,
            length << 5 | broadcast << 4 | (!second >> 4 & 1) << 3 | mask,
        ]);
    }

    /// Writes the bytes that encode a register and a memory operand. A displacement of one byte counts in units of
    /// `unit` bytes.
    fn memory(&mut self, reg: u8, memory: Memory, unit: u32) {
        let reg = (reg & 7) << 3;
        match memory {
            Memory::Constant(constant) => {
                self.bytes.push(reg | 5);
                self.fixups.push(Fixup {
                    at: self.bytes.len(),
                    constant,
                    behind: 0,
                });
                self.bytes.extend([0; 4]);
            }
            Memory::At(base, displacement) => {
                let base = base as u8 & 7;
                let unit = unit.cast_signed();
                let short = (displacement % unit == 0)
                    .then_some(displacement / unit)
                    .and_then(|units| i8::try_from(units).ok());
                // the encoding without a displacement means something else for rbp and r13
                let mode = match short {
                    Some(0) if base != 5 => 0x00,
                    Some(_) => 0x40,
                    None => 0x80,
                };
                self.bytes.push(mode | reg | base);
                // rsp and r12 need a second byte, which says that there is no index register
                if base == 4 {
                    self.bytes.push(0x24);
                }
                match (mode, short) {
                    (0x00, _) => {}
                    (_, Some(units)) => self.bytes.push(units.cast_unsigned()),
                    (_, None) => self.bytes.extend(displacement.to_le_bytes()),
                }
            }
        }
    }
}

/// The highest bit of the four-bit number of the base register.
fn base_bit(memory: Memory) -> u8 {
    match memory {
        Memory::At(base, _) => base as u8 >> 3,
        Memory::Constant(_) => 0,
    }
}

/// The opcode of an instruction whose prefix depends on its shape, as for most arithmetic.
fn arithmetic(shape: Shape, code: u8) -> Opcode {
    let prefix = match (shape.length, shape.precision) {
        (Length::Scalar, Precision::Double) => 3,
        (Length::Scalar, Precision::Single) => 2,
        (_, Precision::Double) => 1,
        (_, Precision::Single) => 0,
    };
    Opcode {
        map: 1,
        prefix,
        wide: [false, shape.precision == Precision::Double],
        code,
        length: shape.length,
        unit: shape.bytes(),
        element: shape.precision.bytes(),
    }
}
