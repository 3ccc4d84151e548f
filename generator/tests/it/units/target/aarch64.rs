//! Another decoder reads back every instruction, with every kind of operand. Its text is compared with that of the
//! intended instruction.

use bryant_generator::target::aarch64::abi::{Bases, SCRATCH};
use bryant_generator::target::aarch64::emit::Arm;
use bryant_generator::target::aarch64::encode::*;
use bryant_generator::target::aarch64::pairs;
use bryant_generator::target::machine::Base;
use bryant_generator::target::machine::emit::Writer;
use bryant_generator::target::machine::operation::{Binary, Bitwise, Signs, Vector};
use bryant_generator::target::machine::shape::{Length, Precision, Shape};
use yaxpeax_arch::{Decoder, U8Reader};
use yaxpeax_arm::armv8::a64::InstDecoder;

/// The text of an instruction.
fn text(word: u32) -> String {
    let bytes = word.to_le_bytes();
    let decoded = InstDecoder::default().decode(&mut U8Reader::new(&bytes));
    decoded
        .unwrap_or_else(|e| panic!("{word:08x}: {e}"))
        .to_string()
}

/// The texts of all instructions of an encoder.
fn texts(encode: impl FnOnce(&mut Encoder)) -> Vec<String> {
    let mut encoder = Encoder::default();
    encode(&mut encoder);
    let words = encoder.instructions.iter().map(|each| text(each.word));
    words.collect()
}

/// Compares the only instruction of an encoder with its text.
fn check(meant: &str, encode: impl FnOnce(&mut Encoder)) {
    assert_eq!(texts(encode), [meant]);
}

/// Registers with every bit set and not set.
const VECTORS: [Vector; 8] = [
    Vector(0),
    Vector(1),
    Vector(2),
    Vector(4),
    Vector(8),
    Vector(16),
    Vector(21),
    Vector(31),
];

const FORMS: [Form; 4] = {
    use Precision::{Double, Single};
    const fn form(lanes: bool, precision: Precision) -> Form {
        Form { lanes, precision }
    }
    [
        form(false, Double),
        form(false, Single),
        form(true, Double),
        form(true, Single),
    ]
};

/// The name of a register as an operand of this form.
fn named(form: Form, Vector(register): Vector) -> String {
    match (form.lanes, form.precision) {
        (false, Precision::Double) => format!("d{register}"),
        (false, Precision::Single) => format!("s{register}"),
        (true, Precision::Double) => format!("v{register}.2d"),
        (true, Precision::Single) => format!("v{register}.4s"),
    }
}

/// Triples of registers in which each has all values.
fn triples() -> impl Iterator<Item = [Vector; 3]> {
    let count = VECTORS.len();
    (0..count * count).map(move |i| {
        let [a, b] = [i % count, i / count];
        [VECTORS[a], VECTORS[b], VECTORS[(a + 3 * b + 1) % count]]
    })
}

#[test]
fn operations_of_two_numbers() {
    for form in FORMS {
        for [to, a, b] in triples() {
            let operands = [to, a, b].map(|register| named(form, register)).join(", ");
            for (operation, name) in [
                (Binary::Add, "fadd"),
                (Binary::Sub, "fsub"),
                (Binary::Mul, "fmul"),
                (Binary::Div, "fdiv"),
            ] {
                check(&format!("{name} {operands}"), |encoder| {
                    encoder.binary(form, operation, to, [a, b]);
                });
            }
            if form.lanes {
                check(&format!("fcmgt {operands}"), |encoder| {
                    encoder.greater(form.precision, to, [a, b]);
                });
                for (subtract, name) in [(false, "fmla"), (true, "fmls")] {
                    check(&format!("{name} {operands}"), |encoder| {
                        encoder.accumulate(form.precision, subtract, to, [a, b]);
                    });
                }
                continue;
            }
            for (condition, name) in [
                (Condition::Less, "mi"),
                (Condition::NotLess, "pl"),
                (Condition::Greater, "gt"),
            ] {
                check(&format!("fcsel {operands}, {name}"), |encoder| {
                    encoder.choose(form.precision, condition, to, [a, b]);
                });
            }
        }
    }
}

#[test]
fn operations_of_one_number() {
    for form in FORMS {
        for [to, from, _] in triples() {
            let operands = [to, from].map(|register| named(form, register)).join(", ");
            for (operation, name) in [
                (Unary::Abs, "fabs"),
                (Unary::Neg, "fneg"),
                (Unary::Sqrt, "fsqrt"),
            ] {
                check(&format!("{name} {operands}"), |encoder| {
                    encoder.unary(form, operation, to, from);
                });
            }
            let copy = match form.lanes {
                true => format!("mov v{}.16b, v{}.16b", to.0, from.0),
                false => format!("fmov {operands}"),
            };
            check(&copy, |encoder| {
                encoder.unary(form, Unary::Copy, to, from);
            });
            if form.lanes {
                continue;
            }
            check(&format!("fcmp {operands}"), |encoder| {
                encoder.compare(form.precision, [to, from]);
            });
            let first = named(form, to);
            check(&format!("fcmp {first}, #0.0"), |encoder| {
                encoder.compare_with_zero(form.precision, to);
            });
        }
    }
}

#[test]
fn fused_operations_of_scalars() {
    for form in FORMS.into_iter().filter(|form| !form.lanes) {
        for [to, a, b] in triples() {
            let c = Vector(to.0 ^ 5);
            let operands = [to, a, b, c].map(|register| named(form, register));
            // c + ab, c − ab, −c − ab, ab − c
            for (product, addend, name) in [
                (false, false, "fmadd"),
                (true, false, "fmsub"),
                (true, true, "fnmadd"),
                (false, true, "fnmsub"),
            ] {
                let signs = Signs { product, addend };
                check(&format!("{name} {}", operands.join(", ")), |encoder| {
                    encoder.fused(form.precision, signs, to, [a, b, c]);
                });
            }
        }
    }
}

#[test]
fn operations_on_bits() {
    for [to, a, b] in triples() {
        let [t, m, n] = [to, a, b].map(|register| format!("v{}.16b", register.0));
        check(&format!("and {t}, {m}, {n}"), |encoder| {
            encoder.bits(Bitwise::And, to, [a, b]);
        });
        check(&format!("eor {t}, {m}, {n}"), |encoder| {
            encoder.bits(Bitwise::Xor, to, [a, b]);
        });
        check(&format!("bsl {t}, {m}, {n}"), |encoder| {
            encoder.blend(to, [a, b]);
        });
        for places in [0, 1, 31, 62, 63] {
            check(
                &format!("shl v{}.2d, v{}.2d, #{places:#x}", to.0, a.0),
                |encoder| {
                    encoder.shift_left(true, to, a, places);
                },
            );
            check(
                &format!("shl d{}, d{}, #{places:#x}", to.0, a.0),
                |encoder| {
                    encoder.shift_left(false, to, a, places);
                },
            );
        }
        check(&format!("uminv s{}, v{}.4s", to.0, a.0), |encoder| {
            encoder.smallest_word(to, a);
        });
        check(&format!("fmov w16, s{}", a.0), |encoder| {
            encoder.first_word(SCRATCH, a);
        });
    }
}

#[test]
fn numbers_within_instructions() {
    // every number that has a sign, an exponent from −3 to 4 and four bits behind the point
    let mut all = Vec::new();
    for sign in [1.0, -1.0] {
        for exponent in -3..=4 {
            for fraction in 0..16 {
                let number = f64::from(16 + fraction) / 16.0 * 2_f64.powi(exponent);
                all.push(sign * number);
            }
        }
    }
    assert_eq!(all.len(), 256);
    for number in all {
        let within = immediate(number).unwrap_or_else(|| panic!("{number}"));
        for form in FORMS {
            let read = texts(|encoder| encoder.number(form, Vector(19), within));
            let (name, value) = read[0].split_once(", #").unwrap_or_default();
            assert_eq!(name, format!("fmov {}", named(form, Vector(19))));
            assert_eq!(value.parse::<f64>(), Ok(number), "{}", read[0]);
        }
    }
    for number in [
        -0.0,
        0.1,
        0.0625,
        32.0,
        1.031_25,
        f64::NAN,
        f64::INFINITY,
        1e300,
    ] {
        assert_eq!(immediate(number), None, "{number}");
    }
    let zero = immediate(0.0).unwrap_or_else(|| panic!("0"));
    for form in FORMS {
        check("movi v30.2d, #0x0", |encoder| {
            encoder.number(form, Vector(30), zero);
        });
    }
}

const SIZES: [(Size, char); 3] = [(Size::S, 's'), (Size::D, 'd'), (Size::Q, 'q')];

/// A memory operand with an offset.
fn at(base: General, offset: u32) -> String {
    let base = match base {
        SP => "sp".to_owned(),
        General(register) => format!("x{register}"),
    };
    match offset {
        0 => format!("[{base}]"),
        _ => format!("[{base}, #{offset:#x}]"),
    }
}

#[test]
fn numbers_in_memory() {
    for (size, letter) in SIZES {
        for vector in VECTORS {
            for base in [1, 2, 4, 8, 16, 28].map(General) {
                for (store, names) in [(false, ["ldr", "ldp"]), (true, ["str", "stp"])] {
                    let v = vector.0;
                    for offset in [0, 1, 2, 63, 64, 1000, 4095] {
                        let memory = at(base, offset * size.bytes());
                        check(&format!("{} {letter}{v}, {memory}", names[0]), |encoder| {
                            encoder.access(Access {
                                store,
                                size,
                                base,
                                offset,
                                vector,
                            });
                        });
                    }
                    check(
                        &format!("{} {letter}{v}, [x{}, x16]", names[0], base.0),
                        |encoder| encoder.access_at(store, size, base, SCRATCH, vector),
                    );
                    for offset in [0, 1, 2, 62, 63] {
                        let other = Vector(v ^ 9);
                        let memory = at(base, offset * size.bytes());
                        let word = encode_pair(store, size, base, offset, [vector, other]);
                        let meant =
                            format!("{} {letter}{v}, {letter}{}, {memory}", names[1], other.0);
                        assert_eq!(text(word), meant);
                    }
                }
            }
        }
    }
}

#[test]
fn general_registers() {
    for (a, b) in [(1, 2), (4, 8), (16, 30), (0, 19), (27, 28)] {
        let [first, second] = [a, b].map(General);
        for (store, names) in [(false, ["ldr", "ldp"]), (true, ["str", "stp"])] {
            for offset in [0, 8, 16, 32_760] {
                let memory = at(second, offset);
                check(&format!("{} x{a}, {memory}", names[0]), |encoder| {
                    encoder.general(store, second, offset, first);
                });
            }
            for offset in [0, 8, 64, 504] {
                let memory = at(SP, offset);
                check(&format!("{} x{a}, x{b}, {memory}", names[1]), |encoder| {
                    encoder.general_pair(store, SP, offset, [first, second]);
                });
            }
        }
        check(&format!("add x{a}, x{b}, x16"), |encoder| {
            encoder.sum(first, second, SCRATCH);
        });
        check(&format!("blr x{a}"), |encoder| encoder.call(first));
        let add = |offset| texts(|encoder| encoder.add(first, second, offset, General(17)));
        assert_eq!(add(1), [format!("add x{a}, x{b}, #0x1")]);
        assert_eq!(add(4095), [format!("add x{a}, x{b}, #0xfff")]);
        assert_eq!(add(4096), [format!("add x{a}, x{b}, #0x1, lsl #12")]);
        assert_eq!(
            add(0xff_f123),
            [
                format!("add x{a}, x{b}, #0xfff, lsl #12"),
                format!("add x{a}, x{a}, #0x123")
            ]
        );
        assert_eq!(
            add(0x1234_5678),
            [
                "mov w17, #0x5678".to_owned(),
                "movk w17, #0x1234, lsl #16".to_owned(),
                format!("add x{a}, x{b}, x17")
            ]
        );
    }
    check("mov x29, sp", |encoder| {
        encoder.add(General(29), SP, 0, SCRATCH);
    });
    check("sub sp, sp, #0xa0", |encoder| encoder.lower_stack(0xa0));
    check("add sp, sp, #0xff0", |encoder| encoder.raise_stack(0xff0));
    check("ret", Encoder::ret);
    for distance in [4, 8, 0x12340, 0xf_fffc] {
        check(&format!("adr x10, $+{distance:#x}"), |encoder| {
            encoder.address(General(10), distance);
        });
    }
}

/// The instructions of a finished function, without what follows the last one.
fn finished(write: impl FnOnce(&mut Arm)) -> Vec<u32> {
    let mut arm = Arm::new(false);
    write(&mut arm);
    let bytes = arm.finish(Vec::new());
    let words = bytes.chunks_exact(4);
    let words = words.map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]]));
    let mut words: Vec<u32> = words.collect();
    while words.last() == Some(&0xd420_0000) {
        words.pop();
    }
    words
}

const DOUBLE: Shape = Shape {
    length: Length::Scalar,
    precision: Precision::Double,
};

#[test]
fn jumps_go_where_they_are_to() {
    let words = finished(|arm| {
        let masked = arm.encoder.jump_if(Condition::NotLess);
        let back = arm.here();
        let zero = arm.encoder.jump_if_zero(SCRATCH);
        arm.leave(DOUBLE);
        arm.land(masked);
        arm.land(zero);
        arm.call_place(back);
        arm.jump_to(back);
    });
    let texts: Vec<String> = words.into_iter().map(text).collect();
    assert_eq!(
        texts,
        ["b.pl $+0xc", "cbz w16, $+0x8", "ret", "bl $-0x8", "b $-0xc"]
    );
}

/// Beyond the reach of conditional branches these skip a longer branch.
#[test]
fn jumps_in_long_code_go_where_they_are_to() {
    const BETWEEN: u32 = 1 << 18;
    let words = finished(|arm| {
        let masked = arm.encoder.jump_if(Condition::NotLess);
        let zero = arm.encoder.jump_if_zero(SCRATCH);
        let back = arm.here();
        for _ in 0..BETWEEN {
            arm.encoder.ret();
        }
        arm.leave(DOUBLE);
        arm.land(masked);
        arm.land(zero);
        arm.jump_to(back);
    });
    let texts: Vec<String> = words[..5].iter().map(|word| text(*word)).collect();
    let end = 4 * (4 + BETWEEN + 1);
    assert_eq!(
        texts,
        [
            "b.mi $+0x8".to_owned(),
            format!("b $+{:#x}", end - 4),
            "cbnz w16, $+0x8".to_owned(),
            format!("b $+{:#x}", end - 12),
            "ret".to_owned()
        ]
    );
    assert_eq!(words.len() as u32, end / 4 + 1);
    let back = text(words[words.len() - 1]);
    assert_eq!(back, format!("b $-{:#x}", end - 16));
}

#[test]
fn a_function_saves_what_it_must_restore() {
    let mut bases = Bases::new(true);
    bases.base(Base::Frame);
    let written = 1 << 3 | 1 << 9 | 1 << 14 | 1 << 20;
    assert_eq!(
        texts(|encoder| bases.enter(encoder, written, 64, false)),
        [
            "sub sp, sp, #0x40",
            "stp x29, x30, [sp]",
            "stp x23, x24, [sp, #0x10]",
            "stp d8, d9, [sp, #0x20]",
            "stp d14, d15, [sp, #0x30]",
            "mov x29, sp",
            "ldr x24, [x0, #0x28]"
        ]
    );
    assert_eq!(
        texts(|encoder| bases.leave(encoder, written)),
        [
            "ldp x29, x30, [sp]",
            "ldp x23, x24, [sp, #0x10]",
            "ldp d8, d9, [sp, #0x20]",
            "ldp d14, d15, [sp, #0x30]",
            "add sp, sp, #0x40",
            "ret"
        ]
    );
}

#[test]
fn constants_are_found_from_near_and_from_far() {
    let mut bases = Bases::new(false);
    bases.base(Base::State);
    bases.base(Base::Parameters);
    bases.constants();
    let near = texts(|encoder| bases.enter(encoder, 0, 0x80, false));
    assert_eq!(near, ["ldp x2, x3, [x0, #0x8]", "adr x8, $+0x84"]);
    let far = texts(|encoder| bases.enter(encoder, 0, 0x12_3400, true));
    assert_eq!(
        far,
        [
            "ldp x2, x3, [x0, #0x8]",
            "adr x8, $+0x0",
            "mov w16, #0x3410",
            "movk w16, #0x12, lsl #16",
            "add x8, x8, x16"
        ]
    );
}

#[test]
fn a_call_hands_over_addresses() {
    let mut bases = Bases::new(true);
    let (arguments, results) = ((Base::Frame, 8), (Base::Results, 0x5000));
    assert_eq!(
        texts(|encoder| bases.call(encoder, 3, arguments, results)),
        [
            "add x1, x24, #0x8",
            "add x2, x23, #0x5, lsl #12",
            "ldp x16, x0, [x25, #0x30]",
            "blr x16"
        ]
    );
    assert_eq!(
        texts(|encoder| bases.call(encoder, 40, arguments, results))[2..],
        ["add x17, x25, #0x280", "ldp x16, x0, [x17]", "blr x16"]
    );
}

/// The texts of instructions after moves were joined.
fn joined(border: Option<usize>, encode: impl FnOnce(&mut Encoder)) -> Vec<String> {
    let mut encoder = Encoder::default();
    encode(&mut encoder);
    let mut borders = vec![false; encoder.instructions.len() + 1];
    if let Some(border) = border {
        borders[border] = true;
    }
    let gone = pairs::join(&mut encoder.instructions, &borders);
    let kept = encoder.instructions.iter().zip(gone);
    let kept = kept.filter(|(_, gone)| !gone);
    kept.map(|(each, _)| text(each.word)).collect()
}

fn moved(store: bool, base: u8, offset: u32, vector: u8) -> Access {
    Access {
        store,
        size: Size::D,
        base: General(base),
        offset,
        vector: Vector(vector),
    }
}

#[test]
fn neighbouring_moves_are_joined_where_nothing_forbids_it() {
    let sum = |encoder: &mut Encoder, to: u8, from: [u8; 2]| {
        encoder.binary(FORMS[0], Binary::Add, Vector(to), from.map(Vector));
    };
    // the second load moves up
    let up = joined(None, |encoder| {
        encoder.access(moved(false, 2, 5, 0));
        sum(encoder, 3, [0, 0]);
        encoder.access(moved(false, 2, 4, 1));
    });
    assert_eq!(up, ["ldp d1, d0, [x2, #0x20]", "fadd d3, d0, d0"]);
    // the register of the second load is needed before, so the first one moves down
    let down = joined(None, |encoder| {
        encoder.access(moved(false, 2, 5, 0));
        sum(encoder, 3, [1, 1]);
        encoder.access(moved(false, 2, 6, 1));
    });
    assert_eq!(down, ["fadd d3, d1, d1", "ldp d0, d1, [x2, #0x28]"]);
    // neither can move
    let neither = |encoder: &mut Encoder| {
        encoder.access(moved(false, 2, 5, 0));
        sum(encoder, 3, [0, 1]);
        encoder.access(moved(false, 2, 6, 1));
    };
    assert_eq!(joined(None, neither).len(), 3);
    // a store waits for the next one, unless its register changes or its place is read
    let store = |encoder: &mut Encoder| {
        encoder.access(moved(true, 8, 1, 4));
        sum(encoder, 5, [4, 4]);
        encoder.access(moved(true, 8, 2, 5));
    };
    assert_eq!(
        joined(None, store),
        ["fadd d5, d4, d4", "stp d4, d5, [x8, #0x8]"]
    );
    let changed = |encoder: &mut Encoder| {
        encoder.access(moved(true, 8, 1, 4));
        sum(encoder, 4, [4, 4]);
        encoder.access(moved(true, 8, 2, 4));
    };
    assert_eq!(joined(None, changed).len(), 3);
    let read = |encoder: &mut Encoder| {
        encoder.access(moved(true, 8, 1, 4));
        encoder.access(moved(false, 8, 1, 5));
        sum(encoder, 5, [5, 5]);
        encoder.access(moved(true, 8, 2, 5));
    };
    assert_eq!(joined(None, read).len(), 4);
    // no move passes the target of a branch, or a branch
    let near = |encoder: &mut Encoder| {
        encoder.access(moved(false, 2, 0, 0));
        encoder.access(moved(false, 2, 1, 1));
    };
    assert_eq!(joined(None, near).len(), 1);
    assert_eq!(joined(Some(1), near).len(), 2);
    let apart = |encoder: &mut Encoder| {
        encoder.access(moved(false, 2, 0, 0));
        encoder.call(SCRATCH);
        encoder.access(moved(false, 2, 1, 1));
    };
    assert_eq!(joined(None, apart).len(), 3);
    // a pair reaches 64 numbers
    let end = |encoder: &mut Encoder| {
        encoder.access(moved(false, 2, 64, 0));
        encoder.access(moved(false, 2, 63, 1));
        encoder.access(moved(false, 2, 65, 2));
    };
    assert_eq!(
        joined(None, end),
        ["ldp d1, d0, [x2, #0x1f8]", "ldr d2, [x2, #0x208]"]
    );
}
