//! Code for every processor, run on an emulated one. Each lane is compared with a separate evaluation over one lane.

use super::emulator::{Call, Machine, Region};
use super::evaluate::{Given, called, curves, results};
use super::random::{INPUTS, Mix, Random, list};
use bryant_generator::program::List;
use bryant_generator::target::machine::{Base, Code, Length, Precision};
use bryant_generator::target::x86_64::{Target, assemble};
use bryant_runtime::real::lanes::{OfAnyWidth, with_width, with_width_of_singles};
use bryant_runtime::{Dual, Real, Several, Width};

const MIXES: [Mix; 6] = [
    Mix {
        length: 3,
        calls: 0,
        reach: 5,
    },
    Mix {
        length: 60,
        calls: 0,
        reach: 10,
    },
    Mix {
        length: 300,
        calls: 0,
        reach: 30,
    },
    Mix {
        length: 300,
        calls: 0,
        reach: 150,
    },
    Mix {
        length: 200,
        calls: 8,
        reach: 40,
    },
    Mix {
        length: 150,
        calls: 2,
        reach: 100,
    },
];

/// The address of the code; the regions follow it.
const CODE: u64 = 0x1000_0000;
/// The address of the first function.
const FUNCTIONS: u64 = 0x5000_0000;
/// The value of the first context; the index of the function is added.
const CONTEXT: u64 = 0xc0de_0000;

fn bits(value: f64) -> u64 {
    match value.is_nan() {
        true => f64::NAN.to_bits(),
        false => value.to_bits(),
    }
}

fn number(precision: Precision, value: f64) -> Vec<u8> {
    match precision {
        Precision::Double => value.to_le_bytes().into(),
        Precision::Single => (value as f32).to_le_bytes().into(),
    }
}

fn numbers(precision: Precision, bytes: &[u8]) -> Vec<f64> {
    let read = |bytes: &[u8]| match precision {
        Precision::Double => f64::from_le_bytes(bytes.try_into().unwrap()),
        Precision::Single => f64::from(f32::from_le_bytes(bytes.try_into().unwrap())),
    };
    bytes
        .chunks_exact(precision.bytes() as usize)
        .map(read)
        .collect()
}

/// How to make a scalar of one lane from numbers, and back.
struct Scalar<T> {
    /// Number of parts: 1, or 2 with a slope.
    parts: usize,
    of: fn(&[f64]) -> T,
    numbers: Box<dyn Fn(T) -> Vec<f64>>,
}

/// A scalar of one part; `number` is its only lane.
fn plain<T: Real>(number: fn(T) -> f64) -> Scalar<T> {
    Scalar {
        parts: 1,
        of: |numbers| T::from_f64(numbers[0]),
        numbers: Box::new(move |value| vec![number(value)]),
    }
}

fn dual<T: Real>(number: fn(T) -> f64) -> Scalar<Dual<T>> {
    Scalar {
        parts: 2,
        of: |numbers| Dual {
            value: T::from_f64(numbers[0]),
            slope: T::from_f64(numbers[1]),
        },
        numbers: Box::new(move |dual| [dual.value, dual.slope].map(number).into()),
    }
}

/// The numbers of one scalar in all lanes, part by part.
type Slot = Vec<f64>;

/// The scalar that a slot holds in one lane.
fn of_lane<T: Real>(scalar: &Scalar<T>, slot: &[f64], lanes: usize, lane: usize) -> T {
    let parts = slot.iter().skip(lane).step_by(lanes);
    (scalar.of)(&parts.copied().collect::<Vec<f64>>())
}

/// A list, its code for some target, and the machine that runs the code.
struct Emulated<'a> {
    list: &'a List,
    target: Target,
    code: Code,
    lanes: usize,
}

impl<'a> Emulated<'a> {
    fn new(list: &'a List, target: Target) -> Self {
        let bytes = match target.length {
            Length::Scalar => target.precision.bytes(),
            Length::Sixteen => 16,
            Length::ThirtyTwo => 32,
            Length::SixtyFour => 64,
        };
        Emulated {
            list,
            target,
            code: assemble(list, &curves(), &target),
            lanes: (bytes / target.precision.bytes()) as usize,
        }
    }

    /// The results of the code, as slots.
    fn run<T: Real>(&self, scalar: &Scalar<T>, inputs: [&[Slot]; 4]) -> Vec<Slot> {
        let mut regions = vec![Region {
            start: CODE,
            bytes: self.code.bytes.clone(),
            writable: false,
        }];
        let size = scalar.parts * self.lanes * self.target.precision.bytes() as usize;
        let mut pointers = Vec::new();
        for base in Base::ALL {
            let slots = self.code.slots[base as usize] as usize;
            let mut bytes = Vec::new();
            if let Some(given) = inputs.get(base as usize) {
                let given = given.iter().take(slots).flatten();
                bytes.extend(given.flat_map(|value| number(self.target.precision, *value)));
            } else if base == Base::Functions {
                let entry = |index: u64| [FUNCTIONS + index, CONTEXT + index];
                let entries = (0..slots as u64).flat_map(entry);
                bytes.extend(entries.flat_map(u64::to_le_bytes));
            } else {
                bytes.resize(slots * size, 0xff);
            }
            let start = CODE + 0x0100_0000 * (1 + base as u64);
            pointers.extend(start.to_le_bytes());
            regions.push(Region {
                start,
                bytes,
                writable: matches!(base, Base::Results | Base::Frame),
            });
        }
        let argument = 0x4000_0000;
        regions.push(Region {
            start: argument,
            bytes: pointers,
            writable: false,
        });
        let mut machine = Machine::new(regions);
        machine.call(CODE, argument, |machine, call| {
            self.called(scalar, machine, &call)
        });
        let results = &machine.regions[1 + Base::Results as usize].bytes;
        let results = results.chunks_exact(size);
        results
            .map(|slot| numbers(self.target.precision, slot))
            .collect()
    }

    /// Runs a function of the table, lane by lane.
    fn called<T: Real>(&self, scalar: &Scalar<T>, machine: &mut Machine, call: &Call) {
        let index = call.function - FUNCTIONS;
        assert_eq!(call.context, CONTEXT + index);
        let callee = self.code.callees[index as usize];
        let size = self.target.precision.bytes() as usize;
        let across = scalar.parts * self.lanes;
        let arguments = machine.read(call.arguments, callee.arguments() * across * size);
        let arguments = numbers(self.target.precision, arguments);
        let mut written = vec![0; callee.results() * across * size];
        for lane in 0..self.lanes {
            let arguments = arguments.chunks_exact(across);
            let arguments: Vec<T> = arguments
                .map(|slot| of_lane(scalar, slot, self.lanes, lane))
                .collect();
            for (index, result) in called(callee, &arguments).into_iter().enumerate() {
                for (part, number_of) in (scalar.numbers)(result).into_iter().enumerate() {
                    let at = (index * across + part * self.lanes + lane) * size;
                    let bytes = number(self.target.precision, number_of);
                    written[at..at + size].copy_from_slice(&bytes);
                }
            }
        }
        machine.write(call.results, &written);
    }

    /// Compares the results of the code with a plain evaluation, lane by lane.
    fn check<T: Real>(&self, scalar: &Scalar<T>, random: &mut Random, special: bool) {
        let mut some = |count: usize| -> Vec<Slot> {
            let mut slot = || -> Slot {
                let number = |_| match special {
                    true => random.any(),
                    false => random.ordinary(),
                };
                (0..scalar.parts * self.lanes).map(number).collect()
            };
            (0..count).map(|_| slot()).collect()
        };
        let time = some(1);
        let given = INPUTS.map(&mut some);
        let [state, parameters, derived] = &given;
        let inputs = [&time, state, parameters, derived];
        let got = self.run(scalar, inputs.map(|slots| slots.as_slice()));
        for lane in 0..self.lanes {
            let at = |slot: &Slot| of_lane(scalar, slot, self.lanes, lane);
            let of = |slots: &[Slot]| slots.iter().map(at).collect();
            let given = Given {
                time: at(&time[0]),
                state: of(state),
                parameters: of(parameters),
                derived: of(derived),
            };
            let wanted = results(self.list, &given);
            assert_eq!(got.len(), wanted.len());
            for (index, (got, wanted)) in got.iter().zip(wanted).enumerate() {
                let got = got.iter().skip(lane).step_by(self.lanes).copied().map(bits);
                let wanted = (scalar.numbers)(wanted).into_iter().map(bits);
                assert!(got.eq(wanted), "result {index}, {:?}", self.target);
            }
        }
    }
}

/// All targets of one precision, with fused and unfused lanes.
struct AllTargets {
    precision: Precision,
    fused: bool,
}

impl<F: Real> OfAnyWidth<F> for AllTargets {
    type Output = ();
    fn run<T: Several<One = F>>(self) {
        self.check::<T>(|value| value.lane(0).to_f64());
    }
}

impl AllTargets {
    fn check<T: Real>(self, number: fn(T) -> f64) {
        for (seed, mix) in (0..4).flat_map(|seed| MIXES.map(|mix| (seed, mix))) {
            let random = &mut Random::new(1000 + seed);
            let list = list(random, mix);
            for length in [
                Length::Scalar,
                Length::Sixteen,
                Length::ThirtyTwo,
                Length::SixtyFour,
            ] {
                for many_registers in [false, true] {
                    let target = Target {
                        length,
                        precision: self.precision,
                        fused: self.fused,
                        many_registers,
                        slopes: false,
                    };
                    let slopes = Target {
                        slopes: true,
                        ..target
                    };
                    let plainly = Emulated::new(&list, target);
                    let with_slopes = Emulated::new(&list, slopes);
                    for special in [false, true] {
                        plainly.check(&plain(number), random, special);
                        with_slopes.check(&dual(number), random, special);
                    }
                }
            }
        }
    }
}

/// Every target, compared with a number that fuses as it does.
#[test]
fn doubles() {
    let of = |fused| AllTargets {
        precision: Precision::Double,
        fused,
    };
    of(false).check::<f64>(Real::to_f64);
    with_width(Width::One, of(true)).expect("one lane");
}

#[test]
fn singles() {
    let of = |fused| AllTargets {
        precision: Precision::Single,
        fused,
    };
    of(false).check::<f32>(Real::to_f64);
    with_width_of_singles(Width::One, of(true)).expect("one lane");
}
