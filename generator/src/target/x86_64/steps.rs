//! A list as steps of the processor.
//!
//! Negations disappear where the next operation can take them over without changing a bit: a sum becomes a difference, a fused operation one
//! with other signs, and a product or quotient passes the sign on. −(a + b) is not (−a) + (−b), for the sign of zero differs; so the
//! sign of a sum is not moved.

use super::encode::{Binary, Signs};
use crate::expression::Function;
use crate::program::{Curve, Input, List, Operation, Value};
use rustc_hash::FxHashMap;

/// A function that is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Callee {
    /// Of one argument, with the results sine and cosine.
    SinCos,
    /// Of two arguments: the angle of the point (second, first).
    Atan2,
    /// A function of the runtime or of the user; of several results the first part.
    Function(Function),
}

/// Where a value comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Origin {
    Constant(f64),
    Input(Input),
    Step,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Of the first two operands.
    Binary(Binary),
    /// ±(first · second) ± third
    Fused(Signs),
    /// √first
    Sqrt,
    /// The first operand with another sign: the second is −0, whose bits are flipped.
    Negate,
    /// The third operand where the first is less than the second, otherwise the fourth.
    Select,
    /// Operands are `arguments` from `first` on; it defines as many values as the function has results.
    Call {
        callee: u32,
        first: u32,
        arguments: u32,
        results: u32,
    },
}

/// One instruction, more or less. The operands behind those that it has are the first one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub kind: Kind,
    pub operands: [u32; 4],
    /// The first value that it defines.
    pub defines: u32,
}

impl Step {
    /// The operands, but for those of a call.
    pub fn operands(&self) -> &[u32] {
        let count = match self.kind {
            Kind::Binary(_) | Kind::Negate => 2,
            Kind::Fused(_) => 3,
            Kind::Select => 4,
            Kind::Sqrt => 1,
            Kind::Call { .. } => 0,
        };
        &self.operands[..count]
    }
}

/// All steps.
#[derive(Default)]
pub(super) struct Steps {
    /// Of each value.
    pub origins: Vec<Origin>,
    pub steps: Vec<Step>,
    /// Arguments of calls.
    pub arguments: Vec<u32>,
    /// A value for each result of the list.
    pub results: Vec<u32>,
    /// Functions, in the order of their first call.
    pub callees: Vec<Callee>,
}

/// A value, or its negative.
#[derive(Clone, Copy)]
pub(super) struct Signed {
    value: u32,
    negative: bool,
}

impl Signed {
    /// The value itself.
    fn plain(value: u32) -> Self {
        Signed {
            value,
            negative: false,
        }
    }

    /// With the other sign.
    pub fn negated(self) -> Self {
        Signed {
            negative: !self.negative,
            ..self
        }
    }
}

/// The steps of a list. What no result depends on is left out.
pub(super) fn steps(list: &List, curves: &[Curve], fused: bool) -> Steps {
    let mut lowering = Lowering {
        list,
        curves,
        fused,
        of: vec![None; list.values()],
        negatives: FxHashMap::default(),
        constants: FxHashMap::default(),
        callees: FxHashMap::default(),
        steps: Steps::default(),
    };
    let live = live(list);
    let mut is_result = vec![false; list.values()];
    for result in &list.results {
        is_result[result.0 as usize] = true;
    }
    let leaves = list.constants.len() + list.inputs.len();
    // what is called at once finds no values in registers, which would have to be stored
    let at_once = |operation: &Operation| match operation {
        Operation::SinCos(a) => (a.0 as usize) < leaves,
        _ => false,
    };
    for early in [true, false] {
        let mut next = leaves;
        for operation in &list.operations {
            let defined = next..next + operation.defines();
            next = defined.end;
            let lives = defined.clone().any(|value| live[value]);
            if !lives || at_once(operation) != early {
                continue;
            }
            lowering.operation(*operation, defined.start);
            // at once, so that it is not kept for later
            for value in defined.filter(|value| is_result[*value]) {
                lowering.plain(Value(value as u32));
            }
        }
    }
    for result in &list.results {
        let value = lowering.plain(*result);
        lowering.steps.results.push(value);
    }
    lowering.steps
}

/// Which values of a list its results depend on.
fn live(list: &List) -> Vec<bool> {
    let mut live = vec![false; list.values()];
    for result in &list.results {
        live[result.0 as usize] = true;
    }
    let mut end = live.len();
    for operation in list.operations.iter().rev() {
        let start = end - operation.defines();
        if live[start..end].contains(&true) {
            for operand in list.operands(*operation) {
                live[operand.0 as usize] = true;
            }
        }
        end = start;
    }
    live
}

pub(super) struct Lowering<'a> {
    list: &'a List,
    pub curves: &'a [Curve],
    fused: bool,
    /// What stands for each value of the list.
    of: Vec<Option<Signed>>,
    /// The negative of a value, where there is one already.
    negatives: FxHashMap<u32, u32>,
    /// By their bits.
    constants: FxHashMap<u64, u32>,
    callees: FxHashMap<Callee, u32>,
    steps: Steps,
}

impl Lowering<'_> {
    fn operation(&mut self, operation: Operation, defines: usize) {
        let result = match operation {
            Operation::Neg(a) => self.signed(a).negated(),
            Operation::Add(a, b) => {
                let (a, b) = (self.signed(a), self.signed(b));
                self.sum(a, b)
            }
            Operation::Sub(a, b) => {
                let (a, b) = (self.signed(a), self.signed(b));
                self.sum(a, b.negated())
            }
            Operation::Mul(a, b) => {
                let (a, b) = (self.signed(a), self.signed(b));
                self.scaled(Binary::Mul, a, b)
            }
            Operation::Div(a, b) => {
                let (a, b) = (self.signed(a), self.signed(b));
                self.scaled(Binary::Div, a, b)
            }
            Operation::MulAdd(a, b, c) => {
                let [a, b, c] = [a, b, c].map(|value| self.signed(value));
                self.mul_add(a, b, c)
            }
            Operation::Sqrt(a) => {
                let a = self.signed(a);
                self.root(a)
            }
            Operation::Max(a, b) => {
                let (a, b) = (self.signed(a), self.signed(b));
                self.extreme(Binary::Max, a, b)
            }
            Operation::Min(a, b) => {
                let (a, b) = (self.signed(a), self.signed(b));
                self.extreme(Binary::Min, a, b)
            }
            Operation::SinCos(a) => return self.call(Callee::SinCos, &[a], 2, defines),
            Operation::Atan2(a, b) => return self.call(Callee::Atan2, &[a, b], 1, defines),
            Operation::Call { function, first } => {
                let first = first as usize;
                let arguments = &self.list.arguments[first..first + function.arity()];
                let signed: Vec<Signed> = arguments.iter().map(|a| self.signed(*a)).collect();
                match self.law(function, &signed) {
                    Some(result) => result,
                    None => {
                        let callee = Callee::Function(function.first_part());
                        return self.call(callee, arguments, operation.defines(), defines);
                    }
                }
            }
        };
        self.of[defines] = Some(result);
    }

    /// (±a) + (±b)
    pub fn sum(&mut self, a: Signed, b: Signed) -> Signed {
        let (kind, first, second) = match (a.negative, b.negative) {
            (false, false) => (Binary::Add, a.value, b.value),
            (false, true) => (Binary::Sub, a.value, b.value),
            (true, false) => (Binary::Sub, b.value, a.value),
            (true, true) => (Binary::Sub, self.negative(a.value), b.value),
        };
        self.step(Kind::Binary(kind), [first, second, first, first])
    }

    /// A product or quotient, whose sign is that of its factors.
    pub fn scaled(&mut self, kind: Binary, a: Signed, b: Signed) -> Signed {
        Signed {
            negative: a.negative != b.negative,
            ..self.step(Kind::Binary(kind), [a.value, b.value, a.value, a.value])
        }
    }

    /// (±a) · (±b) + (±c), rounded once where the target does that
    pub fn mul_add(&mut self, a: Signed, b: Signed, c: Signed) -> Signed {
        if self.fused {
            return self.fused(a, b, c);
        }
        let product = self.scaled(Binary::Mul, a, b);
        self.sum(product, c)
    }

    /// √(±a)
    pub fn root(&mut self, a: Signed) -> Signed {
        let a = self.with_sign(a);
        self.step(Kind::Sqrt, [a; 4])
    }

    /// `then` where a < b, `otherwise` elsewhere
    pub fn select(&mut self, a: Signed, b: Signed, then: Signed, otherwise: Signed) -> Signed {
        let operands = [a, b, then, otherwise].map(|value| self.with_sign(value));
        self.step(Kind::Select, operands)
    }

    /// (±a) · (±b) + (±c), rounded once
    fn fused(&mut self, a: Signed, b: Signed, c: Signed) -> Signed {
        let signs = Signs {
            product: a.negative != b.negative,
            addend: c.negative,
        };
        self.step(Kind::Fused(signs), [a.value, b.value, c.value, a.value])
    }

    /// The larger or smaller one, the first where either is no number. The larger of two negatives is the negative of the smaller. The
    /// instruction gives its second operand where either is no number.
    pub fn extreme(&mut self, kind: Binary, a: Signed, b: Signed) -> Signed {
        let (first, second) = (b, a);
        if first.negative && second.negative {
            let other = match kind {
                Binary::Max => Binary::Min,
                _ => Binary::Max,
            };
            let operands = [first.value, second.value, first.value, first.value];
            return Signed {
                negative: true,
                ..self.step(Kind::Binary(other), operands)
            };
        }
        let (first, second) = (self.with_sign(first), self.with_sign(second));
        self.step(Kind::Binary(kind), [first, second, first, first])
    }

    fn call(&mut self, callee: Callee, arguments: &[Value], results: usize, defines: usize) {
        let arguments: Vec<u32> = arguments.iter().map(|value| self.plain(*value)).collect();
        let callees = &mut self.steps.callees;
        let index = *self.callees.entry(callee).or_insert_with(|| {
            callees.push(callee);
            callees.len() as u32 - 1
        });
        let kind = Kind::Call {
            callee: index,
            first: self.steps.arguments.len() as u32,
            arguments: arguments.len() as u32,
            results: results as u32,
        };
        self.steps.arguments.extend(arguments);
        let first = self.step(kind, [0; 4]).value;
        for i in 1..results {
            self.value(Origin::Step);
            self.of[defines + i] = Some(Signed::plain(first + i as u32));
        }
        self.of[defines] = Some(Signed::plain(first));
    }

    fn step(&mut self, kind: Kind, operands: [u32; 4]) -> Signed {
        let value = self.value(Origin::Step);
        self.steps.steps.push(Step {
            kind,
            operands,
            defines: value,
        });
        Signed::plain(value)
    }

    fn value(&mut self, origin: Origin) -> u32 {
        self.steps.origins.push(origin);
        self.steps.origins.len() as u32 - 1
    }

    fn constant(&mut self, number: f64) -> u32 {
        if let Some(value) = self.constants.get(&number.to_bits()) {
            return *value;
        }
        let value = self.value(Origin::Constant(number));
        self.constants.insert(number.to_bits(), value);
        value
    }

    /// A number.
    pub fn number(&mut self, number: f64) -> Signed {
        Signed::plain(self.constant(number))
    }

    /// What stands for a value of the list.
    fn signed(&mut self, value: Value) -> Signed {
        let index = value.0 as usize;
        if let Some(signed) = self.of[index] {
            return signed;
        }
        let constants = &self.list.constants;
        // operations are there before their results are used
        let value = match constants.get(index) {
            Some(number) => self.constant(*number),
            None => self.value(Origin::Input(self.list.inputs[index - constants.len()])),
        };
        let signed = Signed::plain(value);
        self.of[index] = Some(signed);
        signed
    }

    /// A value of the list with its sign.
    fn plain(&mut self, value: Value) -> u32 {
        let signed = self.signed(value);
        self.with_sign(signed)
    }

    /// A value with its sign.
    fn with_sign(&mut self, signed: Signed) -> u32 {
        match signed.negative {
            true => self.negative(signed.value),
            false => signed.value,
        }
    }

    /// −value
    fn negative(&mut self, value: u32) -> u32 {
        if let Origin::Constant(number) = self.steps.origins[value as usize] {
            return self.constant(-number);
        }
        if let Some(negative) = self.negatives.get(&value) {
            return *negative;
        }
        let mask = self.constant(-0.0);
        let negative = self.step(Kind::Negate, [value, mask, value, value]).value;
        self.negatives.insert(value, negative);
        negative
    }
}

impl Callee {
    /// Number of arguments.
    pub fn arguments(self) -> usize {
        match self {
            Callee::SinCos => 1,
            Callee::Atan2 => 2,
            Callee::Function(function) => function.arity(),
        }
    }

    /// Number of results.
    pub fn results(self) -> usize {
        match self {
            Callee::SinCos => 2,
            Callee::Atan2 => 1,
            Callee::Function(function) => function.part().map_or(1, |(_, parts)| parts),
        }
    }
}
