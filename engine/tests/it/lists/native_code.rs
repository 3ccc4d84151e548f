//! Tests on this processor.

use super::evaluate::{Given, called, curves, results};
use super::random::{INPUTS, Mix, Random, list};
use bryant_engine::Given as Point;
use bryant_engine::internals::{Call, Compiled, compile, target};
use bryant_generator::expression::Function;
use bryant_generator::program::List;
use bryant_generator::target::machine::Callee;
use bryant_runtime::real::lanes::{MOST_LANES, OfAnyWidth, with_width, with_width_of_singles};
use bryant_runtime::real::{Array2, Array4, Array8};
use bryant_runtime::{DoubleDouble, Dual, Real, Several, Width};
use std::cell::RefCell;

/// How to make a scalar from numbers, and how to read it.
#[derive(Clone, Copy)]
struct Probe<T> {
    of: fn(&[f64; MOST_LANES]) -> T,
    /// The bits of all numbers; all NaN are equal.
    bits: fn(T) -> Vec<u64>,
}

fn bits(value: f64) -> u64 {
    match value.is_nan() {
        true => f64::NAN.to_bits(),
        false => value.to_bits(),
    }
}

fn lanes<T: Several>() -> Probe<T> {
    Probe {
        of: |numbers| T::of_lanes(&numbers.map(T::One::from_f64)),
        bits: |value| {
            let lanes = value.lanes().into_iter().take(T::LANES);
            lanes.map(|lane| bits(lane.to_f64())).collect()
        },
    }
}

/// The same for dual numbers, whose slopes are the other half of the numbers.
fn duals<T: Several>() -> Probe<Dual<T>> {
    Probe {
        of: |numbers| {
            let mut turned = *numbers;
            turned.rotate_left(MOST_LANES / 2);
            Dual {
                value: (lanes::<T>().of)(numbers),
                slope: (lanes::<T>().of)(&turned),
            }
        },
        bits: |dual| [dual.value, dual.slope].map(lanes::<T>().bits).concat(),
    }
}

impl<T: Real> Probe<T> {
    fn random(self, random: &mut Random, special: bool) -> T {
        (self.of)(&[(); MOST_LANES].map(|()| match special {
            true => random.any(),
            false => random.ordinary(),
        }))
    }

    fn given(self, random: &mut Random, special: bool) -> Given<T> {
        let mut some = |count: usize| {
            let numbers = (0..count).map(|_| self.random(random, special));
            numbers.collect::<Vec<T>>()
        };
        let [state, parameters, derived] = INPUTS.map(&mut some);
        Given {
            time: some(1)[0],
            state,
            parameters,
            derived,
        }
    }
}

/// A function of the tests.
struct Tested(Function);

impl<T: Real> Call<T> for Tested {
    fn call(&self, arguments: &[T], results: &mut [T]) {
        results.copy_from_slice(&called(Callee::Function(self.0), arguments));
    }
}

/// Runs code on these inputs.
fn run<T: Real, C: Call<T>>(code: &Compiled<T, C>, given: &Given<T>, results: &mut [T]) {
    let point = Point {
        time: given.time,
        state: &given.state,
    };
    let constants = (&given.parameters[..], &given.derived[..]);
    code.run(point, constants, &RefCell::default(), results);
}

/// Compares code with plain evaluation, and checks the memory around the results.
fn check<T: Real, C: Call<T>>(
    probe: Probe<T>,
    list: &List,
    code: &Compiled<T, C>,
    given: &Given<T>,
) {
    const AROUND: usize = 40;
    let canary = (probe.of)(&[1234.5; MOST_LANES]);
    let mut room = vec![canary; list.results.len() + 2 * AROUND];
    let end = AROUND + list.results.len();
    run(code, given, &mut room[AROUND..end]);
    let wanted = results(list, given);
    for (index, (got, wanted)) in room[AROUND..end].iter().zip(&wanted).enumerate() {
        let (got, wanted) = ((probe.bits)(*got), (probe.bits)(*wanted));
        assert_eq!(got, wanted, "result {index}, {:?}", target::<T>());
    }
    let untouched = (probe.bits)(canary);
    for around in room[..AROUND].iter().chain(&room[end..]) {
        assert_eq!((probe.bits)(*around), untouched);
    }
}

const MIXES: [Mix; 7] = [
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
        length: 400,
        calls: 0,
        reach: 30,
    },
    Mix {
        length: 400,
        calls: 0,
        reach: 150,
    },
    Mix {
        length: 200,
        calls: 4,
        reach: 20,
    },
    Mix {
        length: 600,
        calls: 25,
        reach: 60,
    },
    Mix {
        length: 300,
        calls: 2,
        reach: 150,
    },
];

/// Returns whether there is code for this scalar, after checking the code.
fn scalar<T: Real>(probe: Probe<T>) -> bool {
    if target::<T>().is_none() {
        return false;
    }
    for (seed, mix) in (0..25).flat_map(|seed| MIXES.map(|mix| (seed, mix))) {
        let random = &mut Random::new(seed);
        let list = list(random, mix);
        let code = compile::<T, _>(&list, &curves(), Tested).expect("memory may be executable");
        for special in [false, false, true, true] {
            let given = probe.given(random, special);
            check(probe, &list, &code, &given);
        }
    }
    true
}

/// How many inputs, constants, results and values that live for long are in a long list: more than instructions can
/// address, where they hold an offset.
const MANY: u32 = 5000;

/// A list of more than 2²⁰ bytes of code, with a rare number and calls at the beginning.
fn long() -> List {
    use bryant_generator::expression::UserCall;
    use bryant_generator::program::{Input, Operation, Value};

    let random = &mut Random::new(11);
    let mut list = List {
        constants: (0..MANY)
            .map(|i| f64::from(i) / f64::from(2 * MANY))
            .collect(),
        inputs: (0..MANY).map(Input::State).collect(),
        ..List::default()
    };
    let state = |i: u32| Value(MANY + i % MANY);
    let mut next = 2 * MANY;
    list.operations.push(Operation::SinCos(state(0)));
    list.results.extend([Value(next), Value(next + 1)]);
    next += 2;
    for force in 0..40 {
        let user = UserCall {
            force,
            arguments: 1,
            part: 0,
            parts: 1,
        };
        list.operations.push(Operation::Call {
            function: Function::User(user),
            first: list.arguments.len() as u32,
        });
        list.arguments.push(state(force.into()));
        list.results.push(Value(next));
        next += 1;
    }
    let first = next;
    for i in 0..MANY {
        let sum = Operation::MulAdd(state(i), Value(i), state(i + 1));
        list.operations.push(sum);
        next += 1;
    }
    for _ in 0..100_000 {
        let factor = Value(random.below(MANY as usize) as u32);
        let addend = Value(first + random.below(MANY as usize) as u32);
        let sum = Operation::MulAdd(Value(next - 1), factor, addend);
        list.operations.push(sum);
        next += 1;
    }
    list.results.push(Value(next - 1));
    for i in 0..MANY {
        let sum = Operation::Add(Value(first + i), Value(first + MANY - 1 - i));
        list.operations.push(sum);
        list.results.push(Value(next));
        next += 1;
    }
    list
}

/// Checks a long list, if there is code for this scalar.
fn check_long<T: Real>(probe: Probe<T>) {
    if target::<T>().is_none() {
        return;
    }
    let list = long();
    let code = compile::<T, _>(&list, &curves(), Tested).expect("memory may be executable");
    assert!(code.bytes() > 1 << 20, "{}", code.bytes());
    let random = &mut Random::new(12);
    let mut given = Given {
        time: probe.random(random, false),
        state: (0..MANY).map(|_| probe.random(random, false)).collect(),
        parameters: Vec::new(),
        derived: Vec::new(),
    };
    check(probe, &list, &code, &given);
    // an angle that is rare
    given.state[0] = (probe.of)(&[1e5; MOST_LANES]);
    check(probe, &list, &code, &given);
}

struct LongInLanes;

impl<F: Real> OfAnyWidth<F> for LongInLanes {
    type Output = ();
    fn run<T: Several<One = F>>(self) {
        check_long(lanes::<T>());
    }
}

#[test]
fn code_may_be_longer_than_branches_and_offsets_reach() {
    check_long(Probe {
        of: |numbers| numbers[0],
        bits: |value: f64| vec![bits(value)],
    });
    check_long(Probe {
        of: |numbers| Dual {
            value: numbers[0],
            slope: numbers[1],
        },
        bits: |dual: Dual<f64>| vec![bits(dual.value), bits(dual.slope)],
    });
    with_width(Width::widest(), LongInLanes);
    with_width_of_singles(Width::widest(), LongInLanes);
}

struct Lanes;

impl<F: Real> OfAnyWidth<F> for Lanes {
    type Output = bool;
    fn run<T: Several<One = F>>(self) -> bool {
        let numbers = scalar(lanes::<T>());
        assert_eq!(scalar(duals::<T>()), numbers);
        numbers
    }
}

#[test]
fn numbers() {
    let double = Probe {
        of: |numbers| numbers[0],
        bits: |value| vec![bits(value)],
    };
    let single = Probe {
        of: |numbers| numbers[0] as f32,
        bits: |value: f32| vec![bits(value.into())],
    };
    assert_eq!(scalar::<f64>(double), scalar::<f32>(single));
    let dual = Probe {
        of: |numbers| Dual {
            value: numbers[0],
            slope: numbers[1],
        },
        bits: |dual: Dual<f64>| vec![bits(dual.value), bits(dual.slope)],
    };
    assert_eq!(scalar::<Dual<f64>>(dual), scalar::<f64>(double));
    let array = Probe {
        of: |numbers| Array8(*numbers.first_chunk().unwrap()),
        bits: |value: Array8| value.0.map(bits).into(),
    };
    let columns = Probe {
        of: |numbers| Dual {
            value: Array8([numbers[0]; 8]),
            slope: Array8(*numbers.last_chunk().unwrap()),
        },
        bits: |dual: Dual<Array8>| {
            [dual.value.0, dual.slope.0]
                .concat()
                .into_iter()
                .map(bits)
                .collect()
        },
    };
    assert_eq!(scalar(array), scalar(columns));
    let columns = Probe {
        of: |numbers| Dual {
            value: Array4([numbers[0]; 4]),
            slope: Array4(*numbers.last_chunk().unwrap()),
        },
        bits: |dual: Dual<Array4>| {
            [dual.value.0, dual.slope.0]
                .concat()
                .into_iter()
                .map(bits)
                .collect()
        },
    };
    assert!(scalar(columns) || !scalar(array));
    let columns = Probe {
        of: |numbers| Dual {
            value: Array2([numbers[0]; 2]),
            slope: Array2(*numbers.last_chunk().unwrap()),
        },
        bits: |dual: Dual<Array2>| {
            [dual.value.0, dual.slope.0]
                .concat()
                .into_iter()
                .map(bits)
                .collect()
        },
    };
    assert_eq!(scalar(columns), scalar::<f64>(double));
}

#[test]
fn lanes_of_every_width() {
    for width in Width::ALL {
        let there = with_width(width, Lanes);
        // a processor without fused multiply-adds has no code for one lane
        let may_lack = width == Width::One && Width::widest() == Width::One;
        assert!(there.is_none_or(|there| there || may_lack), "{width:?}");
    }
}

#[test]
fn lanes_of_singles_of_every_width() {
    for width in Width::ALL {
        let there = with_width_of_singles(width, Lanes);
        // a processor without fused multiply-adds has no code for one lane
        let may_lack = width == Width::One && Width::widest() == Width::One;
        assert!(there.is_none_or(|there| there || may_lack), "{width:?}");
    }
}

#[test]
fn other_scalars_have_no_code() {
    assert_eq!(target::<Dual<Dual<f64>>>(), None);
    assert_eq!(target::<DoubleDouble>(), None);
    assert_eq!(target::<Dual<DoubleDouble>>(), None);
}

#[test]
fn a_list_may_be_evaluated_within_itself() {
    use bryant_generator::expression::UserCall;
    use bryant_generator::program::{Input, Operation, Value};
    use std::rc::{Rc, Weak};

    if target::<f64>().is_none() {
        return;
    }
    // the function computes c(s)·s, where c evaluates the same at s − 1, down to 0
    let user = UserCall {
        force: 0,
        arguments: 1,
        part: 0,
        parts: 1,
    };
    let list = List {
        constants: vec![],
        inputs: vec![Input::State(0)],
        operations: vec![
            Operation::Call {
                function: Function::User(user),
                first: 0,
            },
            Operation::Mul(Value(1), Value(0)),
        ],
        arguments: vec![Value(0)],
        results: vec![Value(2)],
    };
    /// c
    struct Inner(Rc<RefCell<Weak<Outer>>>);

    /// The code, and the frame that all its evaluations are given.
    type Outer = (Compiled<f64, Inner>, RefCell<Vec<f64>>);

    impl Call<f64> for Inner {
        fn call(&self, arguments: &[f64], results: &mut [f64]) {
            let code = self.0.borrow().upgrade().unwrap();
            results[0] = match arguments[0] > 1.0 {
                true => evaluate(&code, arguments[0] - 1.0),
                false => 1.0,
            };
        }
    }

    fn evaluate((code, room): &Outer, state: f64) -> f64 {
        let point = Point {
            state: &[state],
            ..Point::nothing()
        };
        let mut results = [0.0];
        code.run(point, (&[], &[]), room, &mut results);
        results[0]
    }

    let code: Rc<RefCell<Weak<Outer>>> = Rc::default();
    let inner = |_| Inner(Rc::clone(&code));
    let outer = Rc::new((
        compile::<f64, _>(&list, &[], inner).unwrap(),
        RefCell::default(),
    ));
    *code.borrow_mut() = Rc::downgrade(&outer);
    assert_eq!(evaluate(&outer, 5.0), 120.0);
}

#[test]
#[should_panic(expected = "shorter")]
fn slices_that_are_too_short_are_refused() {
    let mut random = Random::new(7);
    let list = list(&mut random, MIXES[1]);
    let Some(code) = compile::<f64, _>(&list, &curves(), Tested) else {
        panic!("no slice is shorter where there is no code");
    };
    let results = &mut vec![0.0; list.results.len()];
    code.run(Point::nothing(), (&[], &[]), &RefCell::default(), results);
}

#[test]
#[cfg(target_os = "linux")]
fn no_memory_is_writable_and_executable() {
    let mut random = Random::new(8);
    let list = list(&mut random, MIXES[1]);
    let code = compile::<f64, _>(&list, &curves(), Tested);
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    let permissions = maps.lines().filter_map(|line| line.split(' ').nth(1));
    assert!(
        permissions
            .clone()
            .all(|flags| !(flags.contains('w') && flags.contains('x')))
    );
    assert!(permissions.clone().any(|flags| flags.contains('x')));
    drop(code);
}
