//! Turns a list into steps for a processor. Each value of the list becomes a term: a number with its sign and, over
//! dual numbers, its slope.

use super::numbers::{Numbers, Signed};
use super::operation::{Binary, Bitwise, Signs};
use super::shape::{Length, Precision, Values};
use super::terms::Term;
use crate::expression::Function;
use crate::program::{Curve, Input, List, Operation, Value};
use rustc_hash::FxHashMap;

/// A function that machine code calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Callee {
    /// A function of one argument, with the results sine and cosine.
    SinCos,
    /// A function of two arguments y, x: the angle of the point (x, y).
    Atan2,
    /// A function of the runtime or of the user; for one with several results, the call of its first part.
    Function(Function),
}

/// The origin of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Origin {
    Constant(f64),
    /// An input, or its slope.
    Input {
        input: Input,
        slope: bool,
    },
    Step,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum StepKind {
    /// An operation on the first two operands.
    Binary(Binary),
    /// ±(first · second) ± third
    Fused(Signs),
    /// √first
    Sqrt,
    /// A bitwise operation on the first two operands.
    Bits(Bitwise),
    /// The bits of the first operand, shifted left.
    ShiftLeft(u8),
    /// The last arguments if the first argument is below the constant `limit` in all lanes, otherwise the results of a
    /// function. The arguments, from `first` on, are: a size, the numbers that are passed to the function, and its
    /// results for numbers that are not rare, of which this is the last use. The function handles all numbers. Each
    /// number passed or returned takes `slots` slots.
    Rare {
        callee: u32,
        limit: u32,
        first: u32,
        given: u32,
        results: u32,
        slots: u32,
    },
    /// The third operand where the first is less than the second, otherwise the fourth.
    Select,
    /// A call. Its arguments are the entries of [`Steps::arguments`] from `first` on. It defines as many values as the
    /// function has results.
    Call {
        callee: u32,
        first: u32,
        arguments: u32,
        results: u32,
    },
}

/// Roughly one instruction. Unused operands repeat the first operand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step {
    pub kind: StepKind,
    pub operands: [u32; 4],
    /// The first value that the step defines.
    pub defines: u32,
}

impl Step {
    /// The operands in use. The arguments of a call are not among them.
    pub fn operands(&self) -> &[u32] {
        let count = match self.kind {
            StepKind::Binary(_) | StepKind::Bits(_) => 2,
            StepKind::Fused(_) => 3,
            StepKind::Select => 4,
            StepKind::Sqrt | StepKind::ShiftLeft(_) => 1,
            StepKind::Call { .. } | StepKind::Rare { .. } => 0,
        };
        &self.operands[..count]
    }

    /// The range of the step's arguments in [`Steps::arguments`].
    pub fn arguments(&self) -> std::ops::Range<usize> {
        let (first, count) = match self.kind {
            StepKind::Call {
                first, arguments, ..
            } => (first, arguments),
            StepKind::Rare {
                first,
                given,
                results,
                ..
            } => (first, 1 + given + results),
            _ => (0, 0),
        };
        first as usize..(first + count) as usize
    }
}

/// The steps of a list, with their values.
#[derive(Default)]
pub(crate) struct Steps {
    /// The origin of each value.
    pub origins: Vec<Origin>,
    pub steps: Vec<Step>,
    /// Arguments of all calls.
    pub arguments: Vec<u32>,
    /// The value of each result of the list, followed by the value of its slope if slopes are computed.
    pub results: Vec<u32>,
    /// The functions that are called, in the order of their first call.
    pub callees: Vec<Callee>,
}

/// Makes the steps of a list. Operations that no result depends on are left out.
pub(crate) fn steps(list: &List, curves: &[Curve], values: &Values) -> Steps {
    let doubles = values.shape.precision == Precision::Double;
    let mut lowering = Lowering {
        list,
        curves,
        slopes: values.slopes,
        one_lane: values.shape.length == Length::Scalar,
        writes_elementary: doubles,
        of: vec![None; list.values()],
        callees: FxHashMap::default(),
        numbers: Numbers::new(values.fused),
    };
    let live = live(list);
    let mut is_result = vec![false; list.values()];
    for result in &list.results {
        is_result[result.0 as usize] = true;
    }
    let leaves = list.constants.len() + list.inputs.len();
    // calls that depend on constants and inputs alone come first: few values are then in registers, which a call would
    // have to store
    let at_once = |operation: &Operation| match operation {
        Operation::SinCos(a) => !doubles && (a.0 as usize) < leaves,
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
            // negates a result at once, so that the operand is not kept in a register for it
            for value in defined.filter(|value| is_result[*value]) {
                let _ = lowering.plain(Value(value as u32));
            }
        }
    }
    for result in &list.results {
        let parts = lowering.plain(*result);
        lowering.numbers.steps.results.extend(parts);
    }
    lowering.numbers.steps
}

/// For each value of a list, true if a result depends on it.
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

pub(crate) struct Lowering<'a> {
    list: &'a List,
    pub curves: &'a [Curve],
    /// True if every value has a slope.
    pub slopes: bool,
    /// True if a number takes one lane.
    pub one_lane: bool,
    /// True if sine, cosine and `atan2` are written out as steps, not called.
    writes_elementary: bool,
    /// The term of each value of the list.
    of: Vec<Option<Term>>,
    callees: FxHashMap<Callee, u32>,
    pub numbers: Numbers,
}

impl Lowering<'_> {
    fn operation(&mut self, operation: Operation, defines: usize) {
        let result = match operation {
            Operation::Neg(a) => self.term(a).negated(),
            Operation::Add(a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                self.sum(a, b)
            }
            Operation::Sub(a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                self.sum(a, b.negated())
            }
            Operation::Mul(a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                self.product(a, b)
            }
            Operation::Div(a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                self.quotient(a, b)
            }
            Operation::MulAdd(a, b, c) => {
                let [a, b, c] = [a, b, c].map(|value| self.term(value));
                self.mul_add(a, b, c)
            }
            Operation::Sqrt(a) => {
                let a = self.term(a);
                self.root(a)
            }
            Operation::Max(a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                self.larger(a, b)
            }
            Operation::Min(a, b) => {
                let (a, b) = (self.term(a), self.term(b));
                self.smaller(a, b)
            }
            Operation::SinCos(a) if self.writes_elementary => {
                let a = self.term(a);
                let [sine, cosine] = self.sin_cos(a);
                self.of[defines] = Some(sine);
                self.of[defines + 1] = Some(cosine);
                return;
            }
            Operation::SinCos(a) => return self.call(Callee::SinCos, &[a], 2, defines),
            Operation::Atan2(a, b) if self.writes_elementary => {
                let (a, b) = (self.term(a), self.term(b));
                self.angle(a, b)
            }
            Operation::Atan2(a, b) => return self.call(Callee::Atan2, &[a, b], 1, defines),
            Operation::Call { function, first } => {
                let first = first as usize;
                let arguments = &self.list.arguments[first..first + function.arity()];
                let terms: Vec<Term> = arguments.iter().map(|a| self.term(*a)).collect();
                if let Function::Approach(call) = function
                    && let Some(results) = self.approach(call, &terms)
                {
                    for (of, result) in self.of[defines..].iter_mut().zip(results) {
                        *of = Some(result);
                    }
                    return;
                }
                match self.law(function, &terms) {
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

    fn call(&mut self, callee: Callee, arguments: &[Value], results: usize, defines: usize) {
        let parts = arguments.iter().flat_map(|value| self.plain(*value));
        let arguments: Vec<u32> = parts.collect();
        let index = self.callee(callee);
        let steps = &mut self.numbers.steps;
        let parts = 1 + usize::from(self.slopes);
        let kind = StepKind::Call {
            callee: index,
            first: steps.arguments.len() as u32,
            arguments: arguments.len() as u32,
            results: (results * parts) as u32,
        };
        steps.arguments.extend(arguments);
        let first = self.numbers.step(kind, [0; 4]);
        let behind = (1..results * parts).map(|_| self.numbers.value(Origin::Step));
        let mut defined = std::iter::once(first).chain(behind.map(Signed::plain));
        for of in &mut self.of[defines..defines + results] {
            *of = defined.next().map(|value| Term {
                value,
                slope: self.slopes.then(|| defined.next()).flatten(),
            });
        }
    }

    /// The given results, which were computed for numbers that are not rare. Unless a size is below a limit in all
    /// lanes, the results of a function replace them. Each number passed to the function or returned takes `slots`
    /// slots.
    pub fn unless_rare(
        &mut self,
        callee: Callee,
        slots: u32,
        (size, limit): (Signed, f64),
        given: &[Signed],
        results: &[Signed],
    ) -> Vec<Signed> {
        let callee = self.callee(callee);
        let numbers = &mut self.numbers;
        let limit = numbers.constant(limit);
        let all = std::iter::once(&size).chain(given).chain(results);
        let arguments: Vec<u32> = all.map(|value| numbers.with_sign(*value)).collect();
        let kind = StepKind::Rare {
            callee,
            limit,
            first: numbers.steps.arguments.len() as u32,
            given: given.len() as u32,
            results: results.len() as u32,
            slots,
        };
        numbers.steps.arguments.extend(arguments);
        let mut found = vec![numbers.step(kind, [0; 4])];
        found.extend((1..results.len()).map(|_| Signed::plain(numbers.value(Origin::Step))));
        found
    }

    /// The index of a function in the table of called functions.
    pub fn callee(&mut self, callee: Callee) -> u32 {
        let steps = &mut self.numbers.steps;
        *self.callees.entry(callee).or_insert_with(|| {
            steps.callees.push(callee);
            steps.callees.len() as u32 - 1
        })
    }

    /// The term of a value of the list.
    fn term(&mut self, value: Value) -> Term {
        let index = value.0 as usize;
        if let Some(term) = self.of[index] {
            return term;
        }
        let constants = &self.list.constants;
        // an operation has set its term already: what is left are constants and inputs
        let term = match constants.get(index) {
            Some(number) => self.number(*number),
            None => {
                let input = self.list.inputs[index - constants.len()];
                let mut part = |slope| {
                    let value = self.numbers.value(Origin::Input { input, slope });
                    Signed::plain(value)
                };
                Term {
                    value: part(false),
                    slope: self.slopes.then(|| part(true)),
                }
            }
        };
        self.of[index] = Some(term);
        term
    }

    /// A value of the list with its sign, followed by its slope if it has one.
    fn plain(&mut self, value: Value) -> impl Iterator<Item = u32> + use<> {
        let Term { value, slope } = self.term(value);
        let value = self.numbers.with_sign(value);
        let slope = slope.map(|slope| self.numbers.with_sign(slope));
        std::iter::once(value).chain(slope)
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
