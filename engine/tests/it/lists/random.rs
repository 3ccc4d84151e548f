//! Random straight-line programs and numbers.

use super::evaluate::{curves, evaluate};
use bryant_generator::expression::{ApproachCall, Function, UserCall};
use bryant_generator::program::{Input, List, Operation, Value};

/// A xorshift generator.
pub struct Random(pub u64);

impl Random {
    /// A seed from a small number.
    pub fn new(seed: u64) -> Self {
        Random(seed.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// A whole number below `end`.
    pub fn below(&mut self, end: usize) -> usize {
        (self.next() >> 11) as usize % end
    }

    /// A number of ordinary size.
    pub fn ordinary(&mut self) -> f64 {
        let unit = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        (unit - 0.5) * 10_f64.powi(self.below(5) as i32 - 1)
    }

    /// A number of any kind: ordinary, special, very large or very small.
    pub fn any(&mut self) -> f64 {
        const SPECIAL: [f64; 14] = [
            65_536.0,
            -1e5,
            0.0,
            -0.0,
            1.0,
            -1.0,
            f64::INFINITY,
            f64::NEG_INFINITY,
            f64::NAN,
            f64::MIN_POSITIVE,
            5e-324,
            1e-40,
            f64::MAX,
            1e30,
        ];
        match self.below(3) {
            0 => SPECIAL[self.below(SPECIAL.len())],
            _ => self.ordinary(),
        }
    }
}

/// The mix of operations in a random list.
#[derive(Clone, Copy)]
pub struct Mix {
    /// Number of operations.
    pub length: usize,
    /// One of this many operations is a call; 0: none is.
    pub calls: usize,
    /// How far back most operands lie. The larger it is, the more values are alive at once.
    pub reach: usize,
}

/// The inputs of a list, in regions.
pub const INPUTS: [usize; 3] = [9, 20, 15];

/// A random list. Most of its values are of ordinary size at one point.
pub fn list(random: &mut Random, mix: Mix) -> List {
    let mut list = List::default();
    for _ in 0..1 + random.below(12) {
        list.constants.push(random.ordinary());
    }
    list.constants.extend([1.0, -0.0, 0.5]);
    list.inputs.push(Input::Time);
    let [state, parameters, derived] = INPUTS.map(|count| 0..count as u32);
    list.inputs.extend(state.map(Input::State));
    list.inputs.extend(parameters.map(Input::Parameter));
    list.inputs.extend(derived.map(Input::Derived));
    let inputs: Vec<f64> = list.inputs.iter().map(|_| random.ordinary()).collect();
    let mut at = [list.constants.clone(), inputs].concat();
    while list.operations.len() < mix.length {
        let before = list.arguments.len();
        let operation = operation(random, &mut list, mix);
        let values = evaluate(&list, &at, operation);
        let ordinary = |x: &f64| x.is_finite() && x.abs() < 1e4 && (x.abs() > 1e-4 || *x == 0.0);
        if !values.iter().all(ordinary) && random.below(20) > 0 {
            list.arguments.truncate(before);
            continue;
        }
        list.operations.push(operation);
        at.extend(values);
    }
    for _ in 0..1 + mix.length / 6 {
        let value = random.below(list.values());
        list.results.push(Value(value as u32));
    }
    list
}

fn operation(random: &mut Random, list: &mut List, mix: Mix) -> Operation {
    if mix.calls > 0 && random.below(mix.calls) == 0 {
        return call(random, list, mix);
    }
    let mut value = || operand(random, list, mix);
    let [a, b, c] = [value(), value(), value()];
    match random.below(20) {
        0..6 => Operation::MulAdd(a, b, c),
        6..10 => Operation::Mul(a, b),
        10..13 => Operation::Add(a, b),
        13..15 => Operation::Sub(a, b),
        15..17 => Operation::Neg(a),
        17 => Operation::Div(a, b),
        18 => Operation::Sqrt(a),
        _ => match random.below(2) {
            0 => Operation::Max(a, b),
            _ => Operation::Min(a, b),
        },
    }
}

fn call(random: &mut Random, list: &mut List, mix: Mix) -> Operation {
    let [a, b] = [(); 2].map(|()| operand(random, list, mix));
    let user = |arguments, parts| {
        Function::User(UserCall {
            force: 0,
            arguments,
            part: 0,
            parts,
        })
    };
    let curve = random.below(curves().len()) as u32;
    let function = match random.below(22) {
        0..3 => return Operation::SinCos(a),
        3 => return Operation::Atan2(a, b),
        4..8 => Function::Curve(curve),
        8..10 => Function::CurveSlope(curve),
        10 => Function::CurveBreakpoints(curve),
        11..17 => Function::Choose,
        17 => Function::Power,
        18 => Function::Approach(ApproachCall {
            planar: random.below(2) == 0,
            early: random.below(3) > 0,
            part: 0,
        }),
        19 => user(1, 1),
        20 => user(2, 7),
        _ => user(1, 3),
    };
    let first = list.arguments.len() as u32;
    for _ in 0..function.arity() {
        let argument = operand(random, list, mix);
        list.arguments.push(argument);
    }
    Operation::Call { function, first }
}

/// An operand, most of the time a recent value.
fn operand(random: &mut Random, list: &List, mix: Mix) -> Value {
    let values = list.values();
    let given = list.constants.len() + list.inputs.len();
    let index = match random.below(10) {
        0..2 => random.below(given),
        2..3 => random.below(values),
        _ => values - 1 - random.below(mix.reach.min(values)),
    };
    Value(index as u32)
}
