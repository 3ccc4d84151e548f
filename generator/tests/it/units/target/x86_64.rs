//! Another decoder reads back every instruction, with every kind of operand. The result is compared with the intended
//! instruction.

use bryant_generator::target::machine::operation::{Binary, Bitwise, Signs, Vector};
use bryant_generator::target::machine::shape::{Length, Precision, Shape};
use bryant_generator::target::x86_64::encode::*;
use iced_x86::{Decoder, DecoderOptions, Instruction, Mnemonic, OpKind, Register};

/// The intended instruction: its name and operands.
#[derive(Debug, PartialEq)]
struct Meant {
    mnemonic: Mnemonic,
    operands: Vec<Meaning>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Meaning {
    Register(Register),
    /// Base register, displacement or address, number of bytes, and whether all lanes get the same number.
    Memory(Register, u64, usize, bool),
    Immediate(u64),
}

/// The address of the code in a test.
const START: u64 = 0x10_0000;

/// The only instruction of an encoder.
fn read_back(encode: impl FnOnce(&mut Encoder)) -> Meant {
    read_back_masked(Register::None, encode)
}

/// The same for an instruction with a mask register.
fn read_back_masked(mask: Register, encode: impl FnOnce(&mut Encoder)) -> Meant {
    let mut encoder = Encoder::default();
    encode(&mut encoder);
    let bytes = encoder.finish(&[0; 4096]);
    let mut decoder = Decoder::with_ip(64, &bytes, START, DecoderOptions::NONE);
    let instruction = decoder.decode();
    assert!(!instruction.is_invalid(), "{bytes:x?}");
    let rest = &bytes[instruction.len()..bytes.len() - 4096];
    assert!(
        rest.iter().all(|byte| *byte == 0xcc),
        "{instruction:?} then {rest:x?}"
    );
    assert_eq!(instruction.op_mask(), mask);
    assert!(!instruction.zeroing_masking());
    let operands = (0..instruction.op_count()).map(|i| meaning(&instruction, i));
    Meant {
        mnemonic: instruction.mnemonic(),
        operands: operands.collect(),
    }
}

fn meaning(instruction: &Instruction, index: u32) -> Meaning {
    match instruction.op_kind(index) {
        OpKind::Register => Meaning::Register(instruction.op_register(index)),
        OpKind::Memory => {
            assert_eq!(instruction.memory_index(), Register::None);
            Meaning::Memory(
                instruction.memory_base(),
                instruction.memory_displacement64(),
                instruction.memory_size().size(),
                instruction.is_broadcast(),
            )
        }
        OpKind::Immediate8 => Meaning::Immediate(instruction.immediate8().into()),
        OpKind::Immediate8to64 => Meaning::Immediate(instruction.immediate8to64() as u64),
        other => panic!("{other:?}"),
    }
}

const GENERAL: [(General, Register); 16] = [
    (General::Rax, Register::RAX),
    (General::Rcx, Register::RCX),
    (General::Rdx, Register::RDX),
    (General::Rbx, Register::RBX),
    (General::Rsp, Register::RSP),
    (General::Rbp, Register::RBP),
    (General::Rsi, Register::RSI),
    (General::Rdi, Register::RDI),
    (General::R8, Register::R8),
    (General::R9, Register::R9),
    (General::R10, Register::R10),
    (General::R11, Register::R11),
    (General::R12, Register::R12),
    (General::R13, Register::R13),
    (General::R14, Register::R14),
    (General::R15, Register::R15),
];

const SHAPES: [Shape; 8] = {
    use Length::*;
    use Precision::*;
    const fn shape(length: Length, precision: Precision) -> Shape {
        Shape { length, precision }
    }
    [
        shape(Scalar, Double),
        shape(Scalar, Single),
        shape(Sixteen, Double),
        shape(Sixteen, Single),
        shape(ThirtyTwo, Double),
        shape(ThirtyTwo, Single),
        shape(SixtyFour, Double),
        shape(SixtyFour, Single),
    ]
};

/// A vector register in the terms of the decoder.
fn register(length: Length, vector: Vector) -> Meaning {
    let first = match length {
        Length::Scalar | Length::Sixteen => Register::XMM0,
        Length::ThirtyTwo => Register::YMM0,
        Length::SixtyFour => Register::ZMM0,
    };
    Meaning::Register(first + u32::from(vector.0))
}

/// Registers with every pair of fourth and fifth bits.
fn vectors() -> impl Iterator<Item = Vector> + Clone {
    [0, 3, 7, 8, 12, 15, 16, 21, 23, 24, 29, 31]
        .into_iter()
        .map(Vector)
}

/// Displacements around the ends of each encoding.
fn displacements() -> Vec<i32> {
    let mut all = vec![0, 1, -1, i32::MAX, i32::MIN, 100_000, -100_000];
    for unit in [1, 4, 8, 16, 32, 64] {
        for edge in [-129, -128, -127, -1, 1, 2, 126, 127, 128] {
            all.extend([edge * unit, edge * unit + 1, edge * unit + unit / 2]);
        }
    }
    all
}

/// Memory operands, and their meaning for an access of so many bytes.
fn memories(bytes: u32, broadcast: bool) -> Vec<(Memory, Meaning)> {
    let meant = |base, address| Meaning::Memory(base, address, bytes as usize, broadcast);
    let mut all = Vec::new();
    for (base, name) in GENERAL {
        for displacement in displacements() {
            let address = i64::from(displacement) as u64;
            all.push((Memory::At(base, displacement), meant(name, address)));
        }
    }
    for constant in [0, 8, 4000] {
        // one instruction has less than 64 bytes
        let address = START + 64 + u64::from(constant);
        all.push((Memory::Constant(constant), meant(Register::RIP, address)));
    }
    all
}

/// Last operands, with their meaning for an instruction of this shape.
fn operands(length: Length, bytes: u32, element: u32, broadcast: bool) -> Vec<(Operand, Meaning)> {
    let registers = vectors().map(|vector| (Operand::Register(vector), register(length, vector)));
    let mut all: Vec<_> = registers.collect();
    let memory = memories(bytes, false);
    all.extend(
        memory
            .into_iter()
            .map(|(at, meaning)| (Operand::Memory(at), meaning)),
    );
    if broadcast {
        let memory = memories(element, true);
        all.extend(
            memory
                .into_iter()
                .map(|(at, meaning)| (Operand::Broadcast(at), meaning)),
        );
    }
    all
}

/// The mnemonic of a shape.
fn named(shape: Shape, [sd, ss, pd, ps]: [Mnemonic; 4]) -> Mnemonic {
    match (shape.length, shape.precision) {
        (Length::Scalar, Precision::Double) => sd,
        (Length::Scalar, Precision::Single) => ss,
        (_, Precision::Double) => pd,
        (_, Precision::Single) => ps,
    }
}

/// Tests all registers and last operands of an instruction that compares or selects; only registers 0 to 15 if it has
/// no EVEX prefix.
fn choice(
    shape: Shape,
    (mask, evex): (Register, bool),
    encode: impl Fn(&mut Encoder, [Vector; 2], Operand),
    meant: impl Fn([Meaning; 3]) -> Meant,
) {
    let short = |vector: &Vector| evex || vector.0 < 16;
    let packed = evex && shape.length != Length::Scalar;
    let last = operands(shape.length, shape.bytes(), shape.precision.bytes(), packed);
    let last = last.into_iter().filter(|(operand, _)| match operand {
        Operand::Register(vector) => short(vector),
        _ => true,
    });
    let last: Vec<_> = last.collect();
    let check = |registers: [Vector; 2], (operand, meaning): (Operand, Meaning)| {
        let [destination, first] = registers.map(|vector| register(shape.length, vector));
        let read = read_back_masked(mask, |encoder| encode(encoder, registers, operand));
        assert_eq!(
            read,
            meant([destination, first, meaning]),
            "{shape:?} {operand:?}"
        );
    };
    for operand in &last {
        check([Vector(1), Vector(2)], *operand);
        check([Vector(13), Vector(9)], *operand);
    }
    for destination in vectors().filter(short) {
        for first in vectors().filter(short) {
            check([destination, first], last[0]);
            check([destination, first], last[5]);
            check([destination, first], last[20]);
        }
    }
}

#[test]
fn comparisons() {
    use Mnemonic::*;
    for (shape, comparison) in SHAPES.into_iter().flat_map(|shape| {
        [Comparison::Less, Comparison::NotLess].map(|comparison| (shape, comparison))
    }) {
        let asked = Meaning::Immediate(match comparison {
            Comparison::Less => 0x11,
            Comparison::NotLess => 0x15,
        });
        let mnemonic = named(shape, [Vcmpsd, Vcmpss, Vcmppd, Vcmpps]);
        let mask = Meaning::Register(Register::K1);
        choice(
            shape,
            (Register::None, true),
            |encoder, [_, first], second| {
                encoder.compare_to_mask(shape, comparison, first, second);
            },
            |[_, first, second]| Meant {
                mnemonic,
                operands: vec![mask, first, second, asked],
            },
        );
        if shape.length == Length::SixtyFour {
            continue;
        }
        choice(
            shape,
            (Register::None, false),
            |encoder, registers, second| encoder.compare(shape, comparison, registers, second),
            |[destination, first, second]| Meant {
                mnemonic,
                operands: vec![destination, first, second, asked],
            },
        );
    }
}

#[test]
fn choices() {
    use Mnemonic::*;
    for shape in SHAPES {
        if shape.length == Length::Scalar {
            continue;
        }
        choice(
            shape,
            (Register::K1, true),
            |encoder, registers, then| encoder.blend_by_mask(shape, registers, then),
            |operands| Meant {
                mnemonic: named(shape, [INVALID, INVALID, Vblendmpd, Vblendmps]),
                operands: operands.into(),
            },
        );
        if shape.length == Length::SixtyFour {
            continue;
        }
        for mask in [0, 7, 8, 15].map(Vector) {
            choice(
                shape,
                (Register::None, false),
                |encoder, registers, then| encoder.blend(shape, registers, then, mask),
                |[destination, otherwise, then]| Meant {
                    mnemonic: named(shape, [INVALID, INVALID, Vblendvpd, Vblendvps]),
                    operands: vec![destination, otherwise, then, register(shape.length, mask)],
                },
            );
        }
    }
}

#[test]
fn scalars_are_chosen_as_whole_registers() {
    use Mnemonic::*;
    for (precision, by_mask, by_register) in [
        (Precision::Double, Vblendmpd, Vblendvpd),
        (Precision::Single, Vblendmps, Vblendvps),
    ] {
        let shape = Shape {
            length: Length::Scalar,
            precision,
        };
        let then = Operand::Register(Vector(5));
        let xmm = |number| register(Length::Sixteen, Vector(number));
        let read = read_back_masked(Register::K1, |encoder| {
            encoder.blend_by_mask(shape, [Vector(3), Vector(30)], then);
        });
        let operands = vec![xmm(3), xmm(30), xmm(5)];
        let mnemonic = by_mask;
        assert_eq!(read, Meant { mnemonic, operands });
        let read = read_back(|encoder| {
            encoder.blend(shape, [Vector(3), Vector(12)], then, Vector(9));
        });
        let operands = vec![xmm(3), xmm(12), xmm(5), xmm(9)];
        let mnemonic = by_register;
        assert_eq!(read, Meant { mnemonic, operands });
    }
}

/// Tests destinations, first operands and last operands of an instruction with three operands. The lists of registers
/// and of memory are long. So each destination and first operand is combined with the first two of the others, and all
/// pairs of registers with the first two last operands.
fn three(
    shape: Shape,
    last: &[(Operand, Meaning)],
    mnemonic: Mnemonic,
    encode: impl Fn(&mut Encoder, [Vector; 2], Operand),
) {
    let check = |registers: [Vector; 2], (operand, meaning): (Operand, Meaning)| {
        let [destination, first] = registers.map(|vector| register(shape.length, vector));
        let meant = Meant {
            mnemonic,
            operands: vec![destination, first, meaning],
        };
        let read = read_back(|encoder| encode(encoder, registers, operand));
        assert_eq!(read, meant, "{shape:?} {operand:?}");
    };
    for operand in last {
        check([Vector(1), Vector(2)], *operand);
        check([Vector(17), Vector(26)], *operand);
    }
    for destination in vectors() {
        for first in vectors() {
            check([destination, first], last[0]);
            check([destination, first], last[7]);
            check([destination, first], last[20]);
        }
    }
}

/// The last operands of arithmetic.
fn arithmetic(shape: Shape) -> Vec<(Operand, Meaning)> {
    let packed = shape.length != Length::Scalar;
    operands(shape.length, shape.bytes(), shape.precision.bytes(), packed)
}

#[test]
fn operations_of_two_operands() {
    use Mnemonic::*;
    for shape in SHAPES {
        let last = arithmetic(shape);
        for (operation, names) in [
            (Binary::Add, [Vaddsd, Vaddss, Vaddpd, Vaddps]),
            (Binary::Mul, [Vmulsd, Vmulss, Vmulpd, Vmulps]),
            (Binary::Sub, [Vsubsd, Vsubss, Vsubpd, Vsubps]),
            (Binary::Div, [Vdivsd, Vdivss, Vdivpd, Vdivps]),
            (Binary::Max, [Vmaxsd, Vmaxss, Vmaxpd, Vmaxps]),
            (Binary::Min, [Vminsd, Vminss, Vminpd, Vminps]),
        ] {
            three(
                shape,
                &last,
                named(shape, names),
                |encoder, registers, operand| {
                    encoder.binary(shape, operation, registers, operand);
                },
            );
        }
    }
}

#[test]
fn fused_operations() {
    use Mnemonic::*;
    let names = [
        [
            [Vfmadd132sd, Vfmadd132ss, Vfmadd132pd, Vfmadd132ps],
            [Vfmadd213sd, Vfmadd213ss, Vfmadd213pd, Vfmadd213ps],
            [Vfmadd231sd, Vfmadd231ss, Vfmadd231pd, Vfmadd231ps],
        ],
        [
            [Vfmsub132sd, Vfmsub132ss, Vfmsub132pd, Vfmsub132ps],
            [Vfmsub213sd, Vfmsub213ss, Vfmsub213pd, Vfmsub213ps],
            [Vfmsub231sd, Vfmsub231ss, Vfmsub231pd, Vfmsub231ps],
        ],
        [
            [Vfnmadd132sd, Vfnmadd132ss, Vfnmadd132pd, Vfnmadd132ps],
            [Vfnmadd213sd, Vfnmadd213ss, Vfnmadd213pd, Vfnmadd213ps],
            [Vfnmadd231sd, Vfnmadd231ss, Vfnmadd231pd, Vfnmadd231ps],
        ],
        [
            [Vfnmsub132sd, Vfnmsub132ss, Vfnmsub132pd, Vfnmsub132ps],
            [Vfnmsub213sd, Vfnmsub213ss, Vfnmsub213pd, Vfnmsub213ps],
            [Vfnmsub231sd, Vfnmsub231ss, Vfnmsub231pd, Vfnmsub231ps],
        ],
    ];
    for shape in SHAPES {
        let last = arithmetic(shape);
        for (kind, names) in names.iter().enumerate() {
            let signs = Signs {
                product: kind / 2 == 1,
                addend: kind % 2 == 1,
            };
            for (form, names) in [Form::F132, Form::F213, Form::F231].into_iter().zip(names) {
                three(
                    shape,
                    &last,
                    named(shape, *names),
                    |encoder, registers, operand| {
                        encoder.fused(shape, signs, form, registers, operand);
                    },
                );
            }
        }
    }
}

#[test]
fn roots_and_signs() {
    use Mnemonic::*;
    for shape in SHAPES {
        let last = arithmetic(shape);
        let root = named(shape, [Vsqrtsd, Vsqrtss, Vsqrtpd, Vsqrtps]);
        if shape.length == Length::Scalar {
            three(shape, &last, root, |encoder, registers, operand| {
                encoder.sqrt(shape, registers, operand);
            });
        } else {
            for (operand, meaning) in last {
                for destination in vectors() {
                    let read = read_back(|encoder| {
                        encoder.sqrt(shape, [destination, Vector(9)], operand);
                    });
                    let operands = vec![register(shape.length, destination), meaning];
                    let mnemonic = root;
                    assert_eq!(read, Meant { mnemonic, operands });
                }
            }
        }
        // for scalars the whole register is used
        let whole = Shape {
            length: match shape.length {
                Length::Scalar => Length::Sixteen,
                length => length,
            },
            ..shape
        };
        for (operation, mnemonic) in [
            (
                Bitwise::Xor,
                named(whole, [INVALID, INVALID, Vxorpd, Vxorps]),
            ),
            (
                Bitwise::And,
                named(whole, [INVALID, INVALID, Vandpd, Vandps]),
            ),
        ] {
            three(
                whole,
                &arithmetic(whole),
                mnemonic,
                |encoder, registers, operand| {
                    encoder.bits(shape, operation, registers, operand);
                },
            );
        }
        if shape.precision == Precision::Single {
            continue;
        }
        for (destination, source) in vectors().flat_map(|to| vectors().map(move |from| (to, from)))
        {
            let read = read_back(|encoder| encoder.shift_left(shape, destination, source, 62));
            let [to, from] = [destination, source].map(|vector| register(whole.length, vector));
            let operands = vec![to, from, Meaning::Immediate(62)];
            let mnemonic = Vpsllq;
            assert_eq!(read, Meant { mnemonic, operands });
        }
    }
}

/// All instructions of an encoder, with their addresses.
fn all_instructions(encode: impl FnOnce(&mut Encoder)) -> Vec<(u64, Instruction)> {
    let mut encoder = Encoder::default();
    encode(&mut encoder);
    let bytes = encoder.finish(&[]);
    let mut decoder = Decoder::with_ip(64, &bytes, START, DecoderOptions::NONE);
    let mut all = Vec::new();
    while decoder.can_decode() {
        let instruction = decoder.decode();
        assert!(!instruction.is_invalid());
        if instruction.mnemonic() != Mnemonic::Int3 {
            all.push((instruction.ip(), instruction));
        }
    }
    all
}

#[test]
fn jumps_go_where_they_are_to() {
    use Mnemonic::*;
    let all = all_instructions(|encoder| {
        let begin = encoder.here();
        let masked = encoder.jump_if_masked();
        encoder.jump_to(begin);
        encoder.land(masked);
        let called = encoder.here();
        encoder.ret();
        encoder.call_place(called);
    });
    let mnemonics: Vec<Mnemonic> = all.iter().map(|(_, is)| is.mnemonic()).collect();
    assert_eq!(mnemonics, [Kortestw, Jne, Jmp, Ret, Call]);
    for operand in 0..2 {
        assert_eq!(all[0].1.op_register(operand), Register::K1);
    }
    let target = |index: usize| all[index].1.near_branch_target();
    assert_eq!(
        [target(1), target(2), target(4)],
        [all[3].0, START, all[3].0]
    );
}

#[test]
fn signs_of_lanes_are_asked_for() {
    use Mnemonic::*;
    for (shape, lanes) in SHAPES.into_iter().zip([1, 1, 3, 0xf, 0xf, 0xff]) {
        let length = shape.length;
        for vector in (0..16).map(Vector) {
            let all = all_instructions(|encoder| {
                let jump = encoder.jump_if_signed(shape, vector);
                encoder.land(jump);
            });
            let [signs, test, jump] = all.as_slice() else {
                panic!("{} instructions", all.len());
            };
            let (signs, test, jump) = (signs.1, test.1, jump.1);
            let name = match shape.precision {
                Precision::Double => Vmovmskpd,
                Precision::Single => Vmovmskps,
            };
            assert_eq!(signs.mnemonic(), name);
            assert_eq!(signs.op_register(0), Register::EAX);
            assert_eq!(meaning(&signs, 1), register(length, vector));
            assert_eq!((test.mnemonic(), test.op_register(0)), (Test, Register::AL));
            assert_eq!(test.immediate8(), lanes);
            assert_eq!(
                (jump.mnemonic(), jump.near_branch_target()),
                (Jne, jump.next_ip())
            );
        }
    }
}

#[test]
fn moves() {
    use Mnemonic::*;
    for shape in SHAPES {
        for vector in vectors() {
            for source in vectors() {
                let length = shape.length;
                let operands = vec![register(length, vector), register(length, source)];
                let mnemonic = named(shape, [Vmovapd, Vmovaps, Vmovapd, Vmovaps]);
                let read = read_back(|encoder| encoder.copy(shape, vector, source));
                assert_eq!(read, Meant { mnemonic, operands });
            }
            let mnemonic = named(shape, [Vmovsd, Vmovss, Vmovupd, Vmovups]);
            let register = register(shape.length, vector);
            for (memory, meaning) in memories(shape.bytes(), false) {
                let operands = vec![register, meaning];
                let read = read_back(|encoder| encoder.load(shape, vector, memory));
                assert_eq!(read, Meant { mnemonic, operands });
                let operands = vec![meaning, register];
                let read = read_back(|encoder| encoder.store(shape, memory, vector));
                assert_eq!(read, Meant { mnemonic, operands });
            }
            if matches!(shape.length, Length::Scalar | Length::Sixteen) {
                continue;
            }
            let mnemonic = named(shape, [INVALID, INVALID, Vbroadcastsd, Vbroadcastss]);
            for (memory, meaning) in memories(shape.precision.bytes(), false) {
                let operands = vec![register, meaning];
                let read = read_back(|encoder| encoder.broadcast(shape, vector, memory));
                assert_eq!(read, Meant { mnemonic, operands });
            }
        }
    }
}

#[test]
fn general_registers() {
    use Mnemonic::*;
    let check = |mnemonic, operands, encode: &dyn Fn(&mut Encoder)| {
        let operands: Vec<Meaning> = operands;
        assert_eq!(read_back(encode), Meant { mnemonic, operands });
    };
    for (general, name) in GENERAL {
        let named = Meaning::Register(name);
        check(Push, vec![named], &|encoder| encoder.push(general));
        check(Pop, vec![named], &|encoder| encoder.pop(general));
        for (source, name) in GENERAL {
            let operands = vec![named, Meaning::Register(name)];
            check(Mov, operands, &|encoder| {
                encoder.move_general(general, source)
            });
        }
        for (memory, meaning) in memories(8, false) {
            check(Mov, vec![named, meaning], &|encoder| {
                encoder.load_general(general, memory)
            });
        }
        // an address reads nothing
        for (memory, meaning) in memories(0, false) {
            check(Lea, vec![named, meaning], &|encoder| {
                encoder.address(general, memory)
            });
        }
    }
    for (memory, meaning) in memories(8, false) {
        check(Call, vec![meaning], &|encoder| encoder.call(memory));
    }
    let stack = Meaning::Register(Register::RSP);
    for bytes in [8, -8] {
        let operands = vec![stack, Meaning::Immediate(i64::from(bytes) as u64)];
        check(Sub, operands, &|encoder| encoder.lower_stack(bytes));
    }
    check(Ret, vec![], &|encoder| encoder.ret());
    check(Vzeroupper, vec![], &|encoder| encoder.zero_upper());
}
