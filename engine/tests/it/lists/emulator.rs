//! A processor in software with the instructions that code may contain. It checks every access to memory, which
//! registers calls may change, and which a function must restore.

use iced_x86::{Decoder, DecoderOptions, Instruction, Mnemonic, OpKind, Register};

/// A piece of memory.
pub struct Region {
    pub start: u64,
    pub bytes: Vec<u8>,
    pub writable: bool,
}

/// Registers and memory.
pub struct Machine {
    pub general: [u64; 16],
    vectors: [[u8; 64]; 32],
    pub regions: Vec<Region>,
    /// Mask register 1.
    mask: u64,
    /// The zero flag.
    zero: bool,
    /// Whether upper halves of registers may differ from zero.
    upper: bool,
    /// The value that changed registers are filled with.
    garbage: u64,
}

const RSP: usize = 4;
const RDI: usize = 7;
const RSI: usize = 6;
const RDX: usize = 2;
/// Registers that a function must restore: rbx, rsp, rbp, r12 to r15.
const KEPT: [usize; 7] = [3, RSP, 5, 12, 13, 14, 15];
/// The return address.
const RETURN: u64 = 0x7777_0000;
const STACK: u64 = 0x2_0000_0000;

/// A call of a function of the table.
pub struct Call {
    /// Its address.
    pub function: u64,
    pub context: u64,
    pub arguments: u64,
    pub results: u64,
}

/// The number in a lane.
trait Number: Copy {
    const BYTES: usize;
    fn read(bytes: &[u8]) -> Self;
    fn write(self, bytes: &mut [u8]);
    fn apply(operation: &str, operands: [Self; 3]) -> Self;
    fn less(self, other: Self) -> bool;
}

macro_rules! number {
    ($float:ident, $bytes:literal) => {
        impl Number for $float {
            const BYTES: usize = $bytes;

            fn read(bytes: &[u8]) -> Self {
                $float::from_le_bytes(bytes[..$bytes].try_into().unwrap())
            }

            fn write(self, bytes: &mut [u8]) {
                bytes[..$bytes].copy_from_slice(&self.to_le_bytes());
            }

            fn less(self, other: Self) -> bool {
                self < other
            }

            /// Operands in the order of the instruction.
            fn apply(operation: &str, [x, y, z]: [Self; 3]) -> Self {
                match operation {
                    "Vadd" => y + z,
                    "Vsub" => y - z,
                    "Vmul" => y * z,
                    "Vdiv" => y / z,
                    "Vmax" => {
                        if y > z {
                            y
                        } else {
                            z
                        }
                    }
                    "Vmin" => {
                        if y < z {
                            y
                        } else {
                            z
                        }
                    }
                    "Vand" => $float::from_bits(y.to_bits() & z.to_bits()),
                    "Vxor" => $float::from_bits(y.to_bits() ^ z.to_bits()),
                    "Vsqrt" => z.sqrt(),
                    _ => {
                        let (kind, form) = operation.split_at(operation.len() - 3);
                        let (a, b, c) = match form {
                            "132" => (x, z, y),
                            "213" => (y, x, z),
                            "231" => (y, z, x),
                            _ => panic!("{operation}"),
                        };
                        match kind {
                            "Vfmadd" => a.mul_add(b, c),
                            "Vfmsub" => a.mul_add(b, -c),
                            "Vfnmadd" => (-a).mul_add(b, c),
                            "Vfnmsub" => (-a).mul_add(b, -c),
                            _ => panic!("{operation}"),
                        }
                    }
                }
            }
        }
    };
}

number!(f64, 8);
number!(f32, 4);

impl Machine {
    /// A machine with a stack, whose registers are full of arbitrary values.
    pub fn new(mut regions: Vec<Region>) -> Self {
        regions.push(Region {
            start: STACK - 4096,
            bytes: vec![0; 4096],
            writable: true,
        });
        let mut machine = Machine {
            general: [0; 16],
            vectors: [[0; 64]; 32],
            regions,
            mask: 0,
            zero: false,
            upper: false,
            garbage: 1,
        };
        machine.forget((0..16).collect());
        machine
    }

    /// Calls the function at an address with one argument. `called` runs when the function calls another one.
    pub fn call(&mut self, function: u64, argument: u64, mut called: impl FnMut(&mut Self, Call)) {
        self.general[RSP] = STACK - 64;
        self.push(RETURN);
        self.general[RDI] = argument;
        let kept = KEPT.map(|register| self.general[register]);
        let mut at = function;
        while at != RETURN {
            let instruction = self.decode(at);
            at = instruction.next_ip();
            match instruction.mnemonic() {
                Mnemonic::Ret => at = self.pop(),
                Mnemonic::Call if instruction.op0_kind() == OpKind::NearBranch64 => {
                    self.push(at);
                    at = instruction.near_branch_target();
                }
                Mnemonic::Jmp => at = instruction.near_branch_target(),
                Mnemonic::Jne if !self.zero => at = instruction.near_branch_target(),
                Mnemonic::Jne => {}
                Mnemonic::Call => self.call_out(&instruction, &mut called),
                _ => self.execute(&instruction),
            }
        }
        assert!(!self.upper, "upper halves of registers are left");
        let mut restored = kept;
        // the return address has been popped
        restored[1] += 8;
        assert_eq!(KEPT.map(|register| self.general[register]), restored);
    }

    fn decode(&self, at: u64) -> Instruction {
        let (region, offset) = self.region(at, 1);
        assert!(!self.regions[region].writable, "code that may be written");
        let bytes = &self.regions[region].bytes[offset..];
        let instruction = Decoder::with_ip(64, bytes, at, DecoderOptions::NONE).decode();
        assert!(!instruction.is_invalid());
        instruction
    }

    fn call_out(&mut self, instruction: &Instruction, called: &mut impl FnMut(&mut Self, Call)) {
        assert!(
            !self.upper,
            "a call with the upper halves of registers in use"
        );
        assert_eq!(self.general[RSP] % 16, 0, "the stack at a call");
        let function = self.read_general(instruction, 0);
        let call = Call {
            function,
            context: self.general[RDI],
            arguments: self.general[RSI],
            results: self.general[RDX],
        };
        called(self, call);
        self.zero = self.garbage & 1 == 0;
        let changed = (0..16).filter(|register| !KEPT.contains(register));
        self.forget(changed.collect());
    }

    /// Fills these registers, and all vector registers, with arbitrary values.
    fn forget(&mut self, general: Vec<usize>) {
        let mut next = || {
            self.garbage = self
                .garbage
                .wrapping_mul(0x5851_f42d_4c95_7f2d)
                .wrapping_add(12345);
            self.garbage
        };
        for register in general {
            self.general[register] = next() | 1 << 63;
        }
        self.mask = next();
        for vector in &mut self.vectors {
            for bytes in vector.chunks_exact_mut(8) {
                bytes.copy_from_slice(&next().to_le_bytes());
            }
        }
    }

    /// The region that contains all of these bytes, and the offset in it.
    fn region(&self, at: u64, bytes: usize) -> (usize, usize) {
        let inside = |region: &Region| {
            let end = region.start + region.bytes.len() as u64;
            at >= region.start && at + bytes as u64 <= end
        };
        let region = self.regions.iter().position(inside);
        let region = region.unwrap_or_else(|| panic!("{bytes} bytes at {at:x} are nowhere"));
        (region, (at - self.regions[region].start) as usize)
    }

    /// Reads bytes of memory.
    pub fn read(&self, at: u64, bytes: usize) -> &[u8] {
        let (region, offset) = self.region(at, bytes);
        &self.regions[region].bytes[offset..offset + bytes]
    }

    /// Writes bytes of memory.
    pub fn write(&mut self, at: u64, bytes: &[u8]) {
        let (region, offset) = self.region(at, bytes.len());
        assert!(self.regions[region].writable, "{at:x} may not be written");
        self.regions[region].bytes[offset..offset + bytes.len()].copy_from_slice(bytes);
    }

    fn push(&mut self, value: u64) {
        self.general[RSP] -= 8;
        self.write(self.general[RSP], &value.to_le_bytes());
    }

    fn pop(&mut self) -> u64 {
        let value = self.read_u64(self.general[RSP]);
        self.general[RSP] += 8;
        value
    }

    fn read_u64(&self, at: u64) -> u64 {
        u64::from_le_bytes(self.read(at, 8).try_into().unwrap())
    }

    fn address(&self, instruction: &Instruction) -> u64 {
        let displacement = instruction.memory_displacement64();
        match instruction.memory_base() {
            Register::RIP => displacement,
            base => self.general[base.number()].wrapping_add(displacement),
        }
    }

    fn read_general(&self, instruction: &Instruction, operand: u32) -> u64 {
        match instruction.op_kind(operand) {
            OpKind::Register => self.general[instruction.op_register(operand).number()],
            OpKind::Memory => self.read_u64(self.address(instruction)),
            _ => instruction.immediate8to64() as u64,
        }
    }

    fn execute(&mut self, instruction: &Instruction) {
        let general = instruction.op0_register().number();
        match instruction.mnemonic() {
            Mnemonic::Push => self.push(self.general[general]),
            Mnemonic::Pop => self.general[general] = self.pop(),
            Mnemonic::Mov => self.general[general] = self.read_general(instruction, 1),
            Mnemonic::Lea => self.general[general] = self.address(instruction),
            Mnemonic::Sub => {
                let subtrahend = self.read_general(instruction, 1);
                self.general[general] = self.general[general].wrapping_sub(subtrahend);
            }
            Mnemonic::Test => {
                let first = self.general[general % 16];
                self.zero = first & u64::from(instruction.immediate8()) == 0;
            }
            Mnemonic::Kortestw => self.zero = self.mask & 0xffff == 0,
            Mnemonic::Vmovmskpd | Mnemonic::Vmovmskps => {
                let number = match instruction.mnemonic() {
                    Mnemonic::Vmovmskpd => 8,
                    _ => 4,
                };
                let whole = instruction.op1_register().size();
                let bytes = self.vectors[instruction.op1_register().number()];
                let numbers = bytes[..whole].chunks_exact(number).enumerate();
                let signs = numbers.map(|(lane, bytes)| u64::from(bytes[number - 1] >> 7) << lane);
                self.general[general] = signs.sum();
            }
            Mnemonic::Vpsllq => {
                let whole = instruction.op0_register().size();
                self.upper |= whole > 16;
                let mut bytes = self.vectors[instruction.op1_register().number()];
                for bytes in bytes.chunks_exact_mut(8) {
                    let number = <f64 as Number>::read(bytes).to_bits();
                    f64::from_bits(number << instruction.immediate8()).write(bytes);
                }
                bytes[whole..].fill(0);
                self.vectors[general] = bytes;
            }
            Mnemonic::Vzeroupper => {
                for vector in &mut self.vectors[..16] {
                    vector[16..].fill(0);
                }
                self.upper = false;
            }
            _ => self.vector(instruction),
        }
    }

    fn vector(&mut self, instruction: &Instruction) {
        let name = format!("{:?}", instruction.mnemonic());
        let (operation, suffix) = name.split_at(name.len() - 2);
        match suffix {
            "sd" | "pd" => self.numbers::<f64>(instruction, operation, suffix == "sd"),
            "ss" | "ps" => self.numbers::<f32>(instruction, operation, suffix == "ss"),
            _ => panic!("{name}"),
        }
    }

    /// Compares less or not less, into a register or a mask register.
    fn compare<N: Number>(&mut self, instruction: &Instruction, scalar: bool) {
        // less (false where either is NaN) or not less (true there); only quiet comparisons
        let wanted = match instruction.immediate8() {
            0x11 => true,
            0x15 => false,
            other => panic!("comparison {other:x}"),
        };
        let whole = instruction.op1_register().size();
        self.upper |= whole > 16;
        let length = if scalar { N::BYTES } else { whole };
        let first = self.bytes::<N>(instruction, 1, length);
        let second = self.bytes::<N>(instruction, 2, length);
        let mut bytes = first;
        let mut mask = 0;
        for (lane, at) in (0..length).step_by(N::BYTES).enumerate() {
            let less = N::less(N::read(&first[at..]), N::read(&second[at..])) == wanted;
            mask |= u64::from(less) << lane;
            bytes[at..at + N::BYTES].fill(if less { 0xff } else { 0 });
        }
        let to = instruction.op0_register();
        if to.is_k() {
            assert_eq!(to, Register::K1);
            self.mask = mask;
        } else {
            bytes[whole..].fill(0);
            self.vectors[to.number()] = bytes;
        }
    }

    /// The third operand where the mask is set, otherwise the second.
    fn blend<N: Number>(&mut self, instruction: &Instruction, operation: &str) {
        let to = instruction.op0_register();
        let whole = to.size();
        self.upper |= whole > 16;
        let mut result = self.bytes::<N>(instruction, 1, whole);
        let then = self.bytes::<N>(instruction, 2, whole);
        for (lane, at) in (0..whole).step_by(N::BYTES).enumerate() {
            let chosen = if operation == "Vblendv" {
                let mask = self.vectors[instruction.op_register(3).number()];
                mask[at + N::BYTES - 1] & 0x80 != 0
            } else {
                assert_eq!(instruction.op_mask(), Register::K1);
                self.mask >> lane & 1 != 0
            };
            if chosen {
                result[at..at + N::BYTES].copy_from_slice(&then[at..at + N::BYTES]);
            }
        }
        result[whole..].fill(0);
        self.vectors[to.number()] = result;
    }

    /// The bytes of an operand: a register, or memory followed by zeros.
    fn bytes<N: Number>(&self, instruction: &Instruction, operand: u32, length: usize) -> [u8; 64] {
        if instruction.op_kind(operand) == OpKind::Register {
            return self.vectors[instruction.op_register(operand).number()];
        }
        let at = self.address(instruction);
        let mut bytes = [0; 64];
        if instruction.is_broadcast() {
            let number = self.read(at, N::BYTES);
            for lane in bytes.chunks_exact_mut(N::BYTES) {
                lane.copy_from_slice(number);
            }
        } else {
            bytes[..length].copy_from_slice(self.read(at, length));
        }
        bytes
    }

    fn numbers<N: Number>(&mut self, instruction: &Instruction, operation: &str, scalar: bool) {
        match operation {
            "Vcmp" => return self.compare::<N>(instruction, scalar),
            "Vblendv" | "Vblendm" => return self.blend::<N>(instruction, operation),
            _ => {}
        }
        let register = match instruction.op0_kind() {
            OpKind::Register => instruction.op0_register(),
            _ => instruction.op1_register(),
        };
        let whole = register.size();
        self.upper |= whole > 16;
        let length = if scalar { N::BYTES } else { whole };
        let broadcast = operation == "Vbroadcast";
        if broadcast || matches!(operation, "Vmova" | "Vmovu" | "Vmov") {
            if instruction.op0_kind() == OpKind::Memory {
                let bytes = self.vectors[register.number()];
                self.write(self.address(instruction), &bytes[..length]);
                return;
            }
            let read = if broadcast { N::BYTES } else { length };
            let mut result = self.bytes::<N>(instruction, 1, read);
            if broadcast {
                let number = result[..N::BYTES].to_vec();
                result[..whole].copy_from_slice(&number.repeat(whole / N::BYTES));
            }
            result[whole..].fill(0);
            self.vectors[register.number()] = result;
            return;
        }
        let last = instruction.op_count() - 1;
        let destination = self.vectors[register.number()];
        let first = self.bytes::<N>(instruction, 1, length);
        let second = self.bytes::<N>(instruction, last, length);
        // for scalars the other lanes come from the first source, or, in fused operations, from the destination
        let mut result = match operation.starts_with("Vfm") || operation.starts_with("Vfn") {
            true => destination,
            false => first,
        };
        for lane in (0..length).step_by(N::BYTES) {
            let operands = [&destination, &first, &second].map(|bytes| N::read(&bytes[lane..]));
            N::apply(operation, operands).write(&mut result[lane..]);
        }
        result[whole..].fill(0);
        self.vectors[register.number()] = result;
    }
}
