//! The encoding of the instructions that this target needs.
//!
//! Every instruction is a word. Names and layouts are those of the Arm Architecture Reference Manual for A-profile
//! (DDI 0487), chapters C6 and C7. Methods that work on numbers take a [`Form`]: a scalar, or all lanes of a register.

use crate::target::machine::operation::{Binary, Bitwise, CodePosition, Jump, Signs, Vector};
use crate::target::machine::shape::Precision;

/// A general register of 64 bits, x0 to x30; 31 is the stack pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct General(pub u8);

/// The stack pointer.
pub const SP: General = General(31);
/// The register with the return address.
pub const LINK: General = General(30);

/// The operands of an instruction on numbers: scalars or vectors, of doubles or singles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// True for all lanes of a register of 16 bytes, false for one number.
    pub lanes: bool,
    /// Doubles or singles.
    pub precision: Precision,
}

/// The number of bytes that are moved between a vector register and memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// A single: 4 bytes.
    S,
    /// A double: 8 bytes.
    D,
    /// A whole register: 16 bytes.
    Q,
}

impl Size {
    /// In bytes.
    pub const fn bytes(self) -> u32 {
        match self {
            Size::S => 4,
            Size::D => 8,
            Size::Q => 16,
        }
    }
}

impl Form {
    /// The size of a load or store of this form.
    pub const fn size(self) -> Size {
        match (self.lanes, self.precision) {
            (true, _) => Size::Q,
            (false, Precision::Double) => Size::D,
            (false, Precision::Single) => Size::S,
        }
    }

    /// 1 for doubles.
    const fn double(self) -> u32 {
        matches!(self.precision, Precision::Double) as u32
    }
}

/// The condition of a branch or a selection, after FCMP.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Condition {
    /// MI: less; false with a NaN.
    Less = 4,
    /// PL: not less; true with a NaN.
    NotLess = 5,
    /// GT: greater; false with a NaN.
    Greater = 12,
}

/// Moves a vector register to or from memory, at an address that is a register and an offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Access {
    /// Whether memory is written.
    pub store: bool,
    /// The number of bytes.
    pub size: Size,
    /// The register with the address.
    pub base: General,
    /// The offset in units of `size`, at most [`Encoder::FARTHEST`].
    pub offset: u32,
    /// The vector register.
    pub vector: Vector,
}

/// What an instruction reads and writes. It decides whether a load or store may be moved past the instruction.
#[derive(Clone, Copy, Debug)]
pub enum Effect {
    /// The instruction reads and writes these vector registers and the condition flags, but no memory.
    Numbers {
        /// A bit for each vector register that is read.
        reads: u32,
        /// A bit for each vector register that is written.
        writes: u32,
    },
    /// A move to or from memory.
    Access(Access),
    /// Two loads or two stores in one instruction.
    Pair([Access; 2]),
    /// Anything else.
    Other,
}

/// An instruction with its effect.
#[derive(Clone, Copy, Debug)]
pub struct Instruction {
    /// The instruction word. The distance of a branch is still 0.
    pub word: u32,
    /// What it does.
    pub effect: Effect,
}

/// A branch: the index of its instruction, and that of its target.
#[derive(Clone, Copy, Debug)]
pub struct Branch {
    /// Index of the branch instruction.
    pub at: usize,
    /// Index of the instruction that the branch goes to.
    pub to: usize,
}

/// The code so far. Instructions are known by their index.
#[derive(Default)]
pub struct Encoder {
    /// All instructions, in order.
    pub instructions: Vec<Instruction>,
    /// All branches.
    pub branches: Vec<Branch>,
    /// A bit for each vector register that the code writes.
    pub written: u32,
}

/// The bit of a vector register in a set.
fn bit(vector: Vector) -> u32 {
    1 << vector.0
}

/// The words of FADD, FMUL, … without operands, for scalars (C7.2) and for vectors.
const fn binary(operation: Binary) -> [u32; 2] {
    match operation {
        Binary::Add => [0x1e20_2800, 0x4e20_d400],
        Binary::Sub => [0x1e20_3800, 0x4ea0_d400],
        Binary::Mul => [0x1e20_0800, 0x6e20_dc00],
        Binary::Div => [0x1e20_1800, 0x6e20_fc00],
        // these take more than one instruction
        Binary::Max | Binary::Min => unreachable!(),
    }
}

/// An operation of one operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// FMOV, or MOV of a whole register.
    Copy,
    /// FABS
    Abs,
    /// FNEG
    Neg,
    /// FSQRT
    Sqrt,
}

impl Encoder {
    /// The largest offset of an [`Access`].
    pub const FARTHEST: u32 = 4095;
    /// The largest offset of a pair of [`Access`]es.
    pub const FARTHEST_PAIR: u32 = 63;

    fn push(&mut self, word: u32, effect: Effect) {
        self.instructions.push(Instruction { word, effect });
    }

    fn other(&mut self, word: u32) {
        self.push(word, Effect::Other);
    }

    /// An instruction that reads vector registers and writes one.
    fn numbers(&mut self, word: u32, destination: Vector, reads: u32) {
        let writes = bit(destination);
        self.written |= writes;
        self.push(
            word | u32::from(destination.0),
            Effect::Numbers { reads, writes },
        );
    }

    /// destination = first ∘ second: FADD, FSUB, FMUL, FDIV
    pub fn binary(
        &mut self,
        form: Form,
        operation: Binary,
        destination: Vector,
        [first, second]: [Vector; 2],
    ) {
        let word = binary(operation)[usize::from(form.lanes)] | form.double() << 22;
        let operands = u32::from(second.0) << 16 | u32::from(first.0) << 5;
        self.numbers(word | operands, destination, bit(first) | bit(second));
    }

    /// destination = ∘ source
    pub fn unary(&mut self, form: Form, operation: Unary, destination: Vector, source: Vector) {
        let n = u32::from(source.0);
        let double = form.double() << 22;
        let word = match (form.lanes, operation) {
            // ORR of a register with itself
            (true, Unary::Copy) => 0x4ea0_1c00 | n << 16,
            (true, Unary::Abs) => 0x4ea0_f800 | double,
            (true, Unary::Neg) => 0x6ea0_f800 | double,
            (true, Unary::Sqrt) => 0x6ea1_f800 | double,
            (false, Unary::Copy) => 0x1e20_4000 | double,
            (false, Unary::Abs) => 0x1e20_c000 | double,
            (false, Unary::Neg) => 0x1e21_4000 | double,
            (false, Unary::Sqrt) => 0x1e21_c000 | double,
        };
        self.numbers(word | n << 5, destination, bit(source));
    }

    /// destination = ±(a · b) ± c, rounded once, for scalars only: FMADD, FMSUB, FNMADD, FNMSUB
    pub fn fused(
        &mut self,
        precision: Precision,
        signs: Signs,
        destination: Vector,
        [a, b, c]: [Vector; 3],
    ) {
        // FNMADD computes −c − a · b, FNMSUB computes −c + a · b
        let word = match (signs.product, signs.addend) {
            (false, false) => 0x1f00_0000,
            (true, false) => 0x1f00_8000,
            (true, true) => 0x1f20_0000,
            (false, true) => 0x1f20_8000,
        };
        let double = u32::from(precision == Precision::Double) << 22;
        let operands = u32::from(b.0) << 16 | u32::from(c.0) << 10 | u32::from(a.0) << 5;
        self.numbers(
            word | double | operands,
            destination,
            bit(a) | bit(b) | bit(c),
        );
    }

    /// sum = sum ± a · b in every lane, rounded once: FMLA, FMLS.
    pub fn accumulate(
        &mut self,
        precision: Precision,
        subtract: bool,
        sum: Vector,
        [a, b]: [Vector; 2],
    ) {
        let double = u32::from(precision == Precision::Double) << 22;
        let word = 0x4e20_cc00 | double | u32::from(subtract) << 23;
        let operands = u32::from(b.0) << 16 | u32::from(a.0) << 5;
        self.numbers(word | operands, sum, bit(a) | bit(b) | bit(sum));
    }

    /// destination = first ∘ second, bit by bit, in the whole register: AND, EOR
    pub fn bits(&mut self, operation: Bitwise, destination: Vector, [first, second]: [Vector; 2]) {
        let word = match operation {
            Bitwise::And => 0x4e20_1c00,
            Bitwise::Xor => 0x6e20_1c00,
        };
        let operands = u32::from(second.0) << 16 | u32::from(first.0) << 5;
        self.numbers(word | operands, destination, bit(first) | bit(second));
    }

    /// destination = the bits of each double, shifted left by less than 64: SHL
    pub fn shift_left(&mut self, lanes: bool, destination: Vector, source: Vector, places: u8) {
        let word = if lanes { 0x4f00_5400 } else { 0x5f00_5400 };
        let operands = (64 + u32::from(places)) << 16 | u32::from(source.0) << 5;
        self.numbers(word | operands, destination, bit(source));
    }

    /// Compares two scalars: FCMP
    pub fn compare(&mut self, precision: Precision, [first, second]: [Vector; 2]) {
        let operands = u32::from(second.0) << 16 | u32::from(first.0) << 5;
        let reads = bit(first) | bit(second);
        self.compared(0x1e20_2000 | operands, precision, reads);
    }

    /// Compares a scalar with 0: FCMP
    pub fn compare_with_zero(&mut self, precision: Precision, first: Vector) {
        let operands = u32::from(first.0) << 5;
        self.compared(0x1e20_2008 | operands, precision, bit(first));
    }

    fn compared(&mut self, word: u32, precision: Precision, reads: u32) {
        let double = u32::from(precision == Precision::Double) << 22;
        self.push(word | double, Effect::Numbers { reads, writes: 0 });
    }

    /// destination = `then` if the condition holds, otherwise `otherwise`: FCSEL
    pub fn choose(
        &mut self,
        precision: Precision,
        condition: Condition,
        destination: Vector,
        [then, otherwise]: [Vector; 2],
    ) {
        let double = u32::from(precision == Precision::Double) << 22;
        let operands = u32::from(otherwise.0) << 16 | u32::from(then.0) << 5;
        let word = 0x1e20_0c00 | double | (condition as u32) << 12;
        self.numbers(word | operands, destination, bit(then) | bit(otherwise));
    }

    /// destination = all bits set in each lane where first > second, no bits elsewhere: FCMGT
    pub fn greater(
        &mut self,
        precision: Precision,
        destination: Vector,
        [first, second]: [Vector; 2],
    ) {
        let double = u32::from(precision == Precision::Double) << 22;
        let operands = u32::from(second.0) << 16 | u32::from(first.0) << 5;
        let reads = bit(first) | bit(second);
        self.numbers(0x6ea0_e400 | double | operands, destination, reads);
    }

    /// mask = `then` where its bits are set, `otherwise` elsewhere: BSL
    pub fn blend(&mut self, mask: Vector, [then, otherwise]: [Vector; 2]) {
        let operands = u32::from(otherwise.0) << 16 | u32::from(then.0) << 5;
        let reads = bit(mask) | bit(then) | bit(otherwise);
        self.numbers(0x6e60_1c00 | operands, mask, reads);
    }

    /// The first word of the destination = the smallest of the four words of the source: UMINV
    pub fn smallest_word(&mut self, destination: Vector, source: Vector) {
        let operands = u32::from(source.0) << 5;
        self.numbers(0x6eb1_a800 | operands, destination, bit(source));
    }

    /// Every lane of the destination = a number that [`immediate`] can express: FMOV, MOVI
    pub fn number(&mut self, form: Form, destination: Vector, number: Immediate) {
        let word = match (number, form.lanes, form.precision) {
            (Immediate::Zero, ..) => 0x6f00_e400,
            (Immediate::Eight(bits), true, precision) => {
                let op = u32::from(precision == Precision::Double) << 29;
                let bits = u32::from(bits);
                0x4f00_f400 | op | bits >> 5 << 16 | (bits & 31) << 5
            }
            (Immediate::Eight(bits), false, _) => {
                0x1e20_1000 | form.double() << 22 | u32::from(bits) << 13
            }
        };
        self.numbers(word, destination, 0);
    }

    /// Moves a vector register to or from memory: LDR, STR with an unsigned offset.
    pub fn access(&mut self, access: Access) {
        if !access.store {
            self.written |= bit(access.vector);
        }
        self.push(encode_access(access), Effect::Access(access));
    }

    /// Like [`access`](Self::access), with the offset in a register, in bytes: LDR, STR (register).
    pub fn access_at(
        &mut self,
        store: bool,
        size: Size,
        base: General,
        offset: General,
        vector: Vector,
    ) {
        let word = match size {
            Size::S => 0xbc20_6800,
            Size::D => 0xfc20_6800,
            Size::Q => 0x3ca0_6800,
        };
        if !store {
            self.written |= bit(vector);
        }
        let operands = u32::from(offset.0) << 16 | u32::from(base.0) << 5 | u32::from(vector.0);
        self.other(word | u32::from(!store) << 22 | operands);
    }

    /// Moves two doubles to or from memory; `offset` is a multiple of 8: LDP, STP
    pub fn access_pair(&mut self, store: bool, base: General, offset: u32, vectors: [Vector; 2]) {
        self.other(encode_pair(store, Size::D, base, offset / 8, vectors));
    }

    /// Moves two general registers to or from memory; `offset` is a multiple of 8, at most 504: LDP, STP
    pub fn general_pair(&mut self, store: bool, base: General, offset: u32, pair: [General; 2]) {
        let operands = u32::from(pair[1].0) << 10 | u32::from(base.0) << 5 | u32::from(pair[0].0);
        self.other(0xa900_0000 | u32::from(!store) << 22 | (offset / 8) << 15 | operands);
    }

    /// Moves a general register to or from memory; `offset` is a multiple of 8, at most 32760: LDR, STR
    pub fn general(&mut self, store: bool, base: General, offset: u32, register: General) {
        let operands = u32::from(base.0) << 5 | u32::from(register.0);
        self.other(0xf900_0000 | u32::from(!store) << 22 | (offset / 8) << 10 | operands);
    }

    /// Lowers the stack by up to 4095 bytes: SUB
    pub fn lower_stack(&mut self, bytes: u32) {
        self.other(0xd100_03ff | bytes << 10);
    }

    /// Raises the stack by up to 4095 bytes: ADD
    pub fn raise_stack(&mut self, bytes: u32) {
        self.other(0x9100_03ff | bytes << 10);
    }

    /// destination = source + offset: one or several ADD. If the offset has more than 24 bits, the scratch register is
    /// changed.
    pub fn add(&mut self, destination: General, source: General, offset: u32, scratch: General) {
        let operands = |source: General| u32::from(source.0) << 5 | u32::from(destination.0);
        let (low, high) = (offset & 0xfff, offset >> 12);
        if high > 0xfff {
            self.wide(scratch, offset);
            let scratch = u32::from(scratch.0) << 16;
            return self.other(0x8b00_0000 | scratch | operands(source));
        }
        let mut from = source;
        if high > 0 {
            self.other(0x9140_0000 | high << 10 | operands(source));
            from = destination;
        }
        if low > 0 || high == 0 {
            self.other(0x9100_0000 | low << 10 | operands(from));
        }
    }

    /// destination = a number: MOVZ, MOVK
    pub fn wide(&mut self, destination: General, number: u32) {
        let to = u32::from(destination.0);
        self.other(0x5280_0000 | (number & 0xffff) << 5 | to);
        self.other(0x72a0_0000 | number >> 16 << 5 | to);
    }

    /// destination = first + second: ADD
    pub fn sum(&mut self, destination: General, first: General, second: General) {
        let operands = u32::from(second.0) << 16 | u32::from(first.0) << 5;
        self.other(0x8b00_0000 | operands | u32::from(destination.0));
    }

    /// destination = the address of this instruction + `distance`, which is less than 2²⁰ bytes: ADR
    pub fn address(&mut self, destination: General, distance: u32) {
        let distance = (distance & 3) << 29 | (distance >> 2) << 5;
        self.other(0x1000_0000 | distance | u32::from(destination.0));
    }

    /// destination = the first word of a vector register: FMOV. The upper half is 0.
    pub fn first_word(&mut self, destination: General, source: Vector) {
        self.other(0x1e26_0000 | u32::from(source.0) << 5 | u32::from(destination.0));
    }

    /// Calls the function at the address in a register: BLR
    pub fn call(&mut self, function: General) {
        self.other(0xd63f_0000 | u32::from(function.0) << 5);
    }

    /// Returns to the caller: RET
    pub fn ret(&mut self) {
        self.other(0xd65f_03c0);
    }

    /// Jumps if the condition holds: B.cond. [`land`](Self::land) sets the target, which must be nearer than 2²⁰ bytes.
    pub fn jump_if(&mut self, condition: Condition) -> Jump {
        self.branch(0x5400_0000 | condition as u32)
    }

    /// Jumps if the lower half of a register is 0: CBZ. The target must be nearer than 2²⁰ bytes.
    pub fn jump_if_zero(&mut self, register: General) -> Jump {
        self.branch(0x3400_0000 | u32::from(register.0))
    }

    /// Jumps to a place: B
    pub fn jump_to(&mut self, CodePosition(to): CodePosition) {
        let at = self.instructions.len();
        self.branches.push(Branch { at, to });
        self.other(0x1400_0000);
    }

    /// Calls the code at a place: BL
    pub fn call_place(&mut self, CodePosition(to): CodePosition) {
        let at = self.instructions.len();
        self.branches.push(Branch { at, to });
        self.other(0x9400_0000);
    }

    fn branch(&mut self, word: u32) -> Jump {
        let at = self.instructions.len();
        self.branches.push(Branch { at, to: at });
        self.other(word);
        Jump(self.branches.len() - 1)
    }

    /// The place of the next instruction.
    pub fn here(&self) -> CodePosition {
        CodePosition(self.instructions.len())
    }

    /// Makes a jump go to the next instruction.
    pub fn land(&mut self, Jump(branch): Jump) {
        self.branches[branch].to = self.instructions.len();
    }
}

/// LDR, STR with an unsigned offset.
fn encode_access(access: Access) -> u32 {
    let word = match access.size {
        Size::S => 0xbd00_0000,
        Size::D => 0xfd00_0000,
        Size::Q => 0x3d80_0000,
    };
    let operands = u32::from(access.base.0) << 5 | u32::from(access.vector.0);
    word | u32::from(!access.store) << 22 | access.offset << 10 | operands
}

/// LDP, STP of vector registers, with the offset in units of the size.
pub fn encode_pair(store: bool, size: Size, base: General, offset: u32, pair: [Vector; 2]) -> u32 {
    let word = match size {
        Size::S => 0x2d00_0000,
        Size::D => 0x6d00_0000,
        Size::Q => 0xad00_0000,
    };
    let operands = u32::from(pair[1].0) << 10 | u32::from(base.0) << 5 | u32::from(pair[0].0);
    word | u32::from(!store) << 22 | offset << 15 | operands
}

/// True if an instruction is B.cond or CBZ.
pub fn is_conditional(word: u32) -> bool {
    word & 0xff00_0010 == 0x5400_0000 || word & 0xff00_0000 == 0x3400_0000
}

/// An instruction as it stands in long code. A conditional branch becomes two: the opposite branch, which skips an
/// unconditional one. All other instructions stay as they are.
pub fn long_branch(word: u32) -> impl Iterator<Item = u32> {
    let skip = match word & 0xff00_0010 == 0x5400_0000 {
        true => word ^ 1,
        // CBZ becomes CBNZ
        false => word ^ 0x0100_0000,
    };
    let long = is_conditional(word).then(|| [with_distance(skip, 2), 0x1400_0000]);
    let short = long.is_none().then_some(word);
    long.into_iter().flatten().chain(short)
}

/// A branch instruction with its distance, counted in instructions, filled in.
///
/// # Panics
/// If the distance does not fit.
pub fn with_distance(word: u32, distance: i64) -> u32 {
    let bits = if word & 0x7c00_0000 == 0x1400_0000 {
        26
    } else {
        19
    };
    let limit = 1 << (bits - 1);
    assert!(
        (-limit..limit).contains(&distance),
        "a branch that is too far"
    );
    let distance = distance as u32 & ((1 << bits) - 1);
    match bits {
        26 => word | distance,
        _ => word | distance << 5,
    }
}

/// A number within an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Immediate {
    /// +0
    Zero,
    /// A number with a sign, three bits of exponent and four bits after the binary point.
    Eight(u8),
}

/// The encoding of a number within an instruction; `None` if the number has too many bits.
pub fn immediate(number: f64) -> Option<Immediate> {
    let bits = number.to_bits();
    if bits == 0 {
        return Some(Immediate::Zero);
    }
    let exponent = (bits >> 52 & 0x7ff) as i32 - 1023;
    if bits << 16 != 0 || !(-3..=4).contains(&exponent) {
        return None;
    }
    let sign = (bits >> 63) as u8;
    let fraction = (bits >> 48 & 15) as u8;
    // the encoding inverts the first bit of the exponent
    let exponent = ((exponent + 3) as u8 & 7) ^ 4;
    Some(Immediate::Eight(sign << 7 | exponent << 4 | fraction))
}
