//! Turns scheduled values into a [`List`]: the operations of the Rust text, in the same order.
//!
//! Equal operations on equal operands become one. That changes no bit, and a compiler does it, too.

use super::formula::{Form, Formulas, MethodOperation, Operator};
use super::schedule::{Schedule, Statement, index};
use crate::expression::{Function, NodeId, Symbol};
use crate::method::inputs::{self, Inputs};
use crate::program::{Input, List, Operation, Value};
use rustc_hash::FxHashMap;
use std::cell::RefCell;

/// The list of a schedule's roots.
pub(crate) fn list(schedule: &Schedule, inputs: &Inputs) -> List {
    let writer = Writer {
        schedule,
        inputs,
        list: RefCell::new(Growing::new(schedule.graph.len())),
    };
    for line in &schedule.lines {
        writer.line(line.statement);
    }
    let formulas = writer.formulas();
    let results = schedule.roots.iter().map(|&root| formulas.value(root));
    let results = results.collect();
    writer.list.into_inner().finish(results)
}

/// A value while the numbers of constants and inputs are not yet known.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Term(u32);

/// The kinds of terms, as their two highest bits; a result of an operation has neither bit.
const CONSTANT: u32 = 1 << 31;
const INPUT: u32 = 1 << 30;
const KIND: u32 = CONSTANT | INPUT;

/// Writes the formulas of a schedule into a list.
struct Writer<'a> {
    schedule: &'a Schedule,
    inputs: &'a Inputs,
    list: RefCell<Growing>,
}

/// A list under construction.
struct Growing {
    constants: Vec<f64>,
    constant_of: FxHashMap<u64, u32>,
    inputs: Vec<Input>,
    input_of: FxHashMap<Input, u32>,
    operations: Vec<Operation>,
    /// By operation: the first value that it defines.
    first_of: FxHashMap<Key, u32>,
    defined: u32,
    arguments: Vec<Value>,
    /// By node: the value to which a line has bound it.
    bound: Vec<Option<Term>>,
}

/// An operation with its operands; those of a call are boxed.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    Algebra(u8, [u32; 3]),
    Call(Function, Box<[u32]>),
}

impl Growing {
    fn new(nodes: usize) -> Self {
        Growing {
            constants: Vec::new(),
            constant_of: FxHashMap::default(),
            inputs: Vec::new(),
            input_of: FxHashMap::default(),
            operations: Vec::with_capacity(nodes),
            first_of: FxHashMap::with_capacity_and_hasher(nodes, Default::default()),
            defined: 0,
            arguments: Vec::new(),
            bound: vec![None; nodes],
        }
    }

    /// A constant. A zero loses its sign, as in the text.
    fn constant(&mut self, value: f64) -> Term {
        let value = value + 0.0;
        let constants = &mut self.constants;
        let place = *self.constant_of.entry(value.to_bits()).or_insert_with(|| {
            constants.push(value);
            constants.len() as u32 - 1
        });
        Term(CONSTANT | place)
    }

    fn input(&mut self, input: Input) -> Term {
        let inputs = &mut self.inputs;
        let place = *self.input_of.entry(input).or_insert_with(|| {
            inputs.push(input);
            inputs.len() as u32 - 1
        });
        Term(INPUT | place)
    }

    /// The first value of the operation; appends the operation if it is new.
    fn operation(&mut self, key: Key, make: impl FnOnce(&mut Vec<Value>) -> Operation) -> Term {
        let (operations, defined) = (&mut self.operations, &mut self.defined);
        let arguments = &mut self.arguments;
        let first = *self.first_of.entry(key).or_insert_with(|| {
            let operation = make(arguments);
            let first = *defined;
            *defined += operation.defines() as u32;
            operations.push(operation);
            first
        });
        Term(first)
    }

    fn algebra<const N: usize>(
        &mut self,
        of: u8,
        operands: [Term; N],
        make: impl FnOnce([Value; N]) -> Operation,
    ) -> Term {
        let mut given = [u32::MAX; 3];
        for (place, operand) in given.iter_mut().zip(operands) {
            *place = operand.0;
        }
        let operands = operands.map(|term| Value(term.0));
        self.operation(Key::Algebra(of, given), |_| make(operands))
    }

    /// Builds the list. Numbers constants first, then inputs, then results of operations.
    fn finish(self, results: Vec<Term>) -> List {
        let (constants, inputs) = (self.constants.len() as u32, self.inputs.len() as u32);
        let number = |value: Value| {
            let place = value.0 & !KIND;
            Value(match value.0 & KIND {
                CONSTANT => place,
                INPUT => constants + place,
                _ => constants + inputs + place,
            })
        };
        let operations = self.operations.into_iter();
        List {
            constants: self.constants,
            inputs: self.inputs,
            operations: operations.map(|operation| operation.map(number)).collect(),
            arguments: self.arguments.into_iter().map(number).collect(),
            results: results
                .into_iter()
                .map(|term| number(Value(term.0)))
                .collect(),
        }
    }
}

impl Writer<'_> {
    fn formulas(&self) -> Formulas<'_, Self> {
        Formulas {
            schedule: self.schedule,
            form: self,
        }
    }

    /// Appends the operations of a statement, and records the values that it binds.
    fn line(&self, statement: Statement) {
        let first = match statement {
            Statement::Value(id) => self.formulas().formula(id),
            Statement::SinCos { argument, .. } => self.sin_cos(self.formulas().receiver(argument)),
            Statement::Results(call) => match self.schedule.results(call).iter().flatten().next() {
                Some(&id) => self.formulas().formula(id),
                None => return,
            },
            // Results are collected after all lines.
            Statement::Put(_) => return,
        };
        let bindings = self.schedule.results_by_place(statement);
        let mut list = self.list.borrow_mut();
        for (place, id) in bindings.into_iter().enumerate() {
            if let Some(id) = id {
                list.bound[index(id)] = Some(Term(first.0 + place as u32));
            }
        }
    }

    fn sin_cos(&self, argument: Term) -> Term {
        let mut list = self.list.borrow_mut();
        list.algebra(0, [argument], |[a]| Operation::SinCos(a))
    }
}

impl Form for Writer<'_> {
    type Term = Term;

    fn number(&self, value: f64) -> Term {
        self.list.borrow_mut().constant(value)
    }

    fn bound(&self, id: NodeId) -> Term {
        let bound = self.list.borrow().bound[index(id)];
        bound.expect("lines stand in the order of need")
    }

    fn input(&self, _id: NodeId, symbol: Symbol) -> Term {
        let place = |i: usize| i as u32;
        let [q, v, z] = [
            self.inputs.coordinates.len(),
            self.inputs.velocities.len(),
            self.inputs.auxiliaries.len(),
        ];
        let input = match self.inputs.input(symbol) {
            inputs::Input::Time => Input::Time,
            inputs::Input::Coordinate(i) => Input::State(place(i)),
            inputs::Input::Velocity(i) => Input::State(place(q + i)),
            inputs::Input::Auxiliary(i) => Input::State(place(q + v + i)),
            inputs::Input::Memory(i) => Input::State(place(q + v + z + i)),
            inputs::Input::Acceleration(i) => Input::Acceleration(place(i)),
            inputs::Input::EventFunction(i) => Input::EventFunction(place(i)),
            inputs::Input::Parameter(i) => Input::Parameter(place(i)),
            inputs::Input::Derived(i) => Input::Derived(place(i)),
        };
        self.list.borrow_mut().input(input)
    }

    fn negative(&self, a: Term) -> Term {
        let mut list = self.list.borrow_mut();
        list.algebra(1, [a], |[a]| Operation::Neg(a))
    }

    fn binary(&self, a: Term, operator: Operator, b: Term) -> Term {
        let mut list = self.list.borrow_mut();
        let operands = [a, b];
        match operator {
            Operator::Plus => list.algebra(2, operands, |[a, b]| Operation::Add(a, b)),
            Operator::Minus => list.algebra(3, operands, |[a, b]| Operation::Sub(a, b)),
            Operator::Times => list.algebra(4, operands, |[a, b]| Operation::Mul(a, b)),
            Operator::Over => list.algebra(5, operands, |[a, b]| Operation::Div(a, b)),
        }
    }

    fn method<const N: usize>(
        &self,
        receiver: Term,
        method: MethodOperation,
        others: [Term; N],
    ) -> Term {
        let mut list = self.list.borrow_mut();
        let operands = |i: usize| others.get(i).copied().unwrap_or(receiver);
        let two = [receiver, operands(0)];
        match method {
            MethodOperation::Sqrt => list.algebra(6, [receiver], |[a]| Operation::Sqrt(a)),
            MethodOperation::Atan2 => list.algebra(7, two, |[a, b]| Operation::Atan2(a, b)),
            MethodOperation::Max => list.algebra(8, two, |[a, b]| Operation::Max(a, b)),
            MethodOperation::Min => list.algebra(9, two, |[a, b]| Operation::Min(a, b)),
            MethodOperation::MulAdd => {
                let three = [receiver, operands(0), operands(1)];
                list.algebra(10, three, |[a, b, c]| Operation::MulAdd(a, b, c))
            }
        }
    }

    fn half_of_pair(&self, argument: Term, half: u32) -> Term {
        Term(self.sin_cos(argument).0 + half)
    }

    fn call(&self, function: Function, given: Vec<Term>) -> Term {
        let function = function.first_part();
        let key = Key::Call(function, given.iter().map(|term| term.0).collect());
        let mut list = self.list.borrow_mut();
        list.operation(key, |arguments| {
            let first = arguments.len() as u32;
            arguments.extend(given.iter().map(|term| Value(term.0)));
            Operation::Call { function, first }
        })
    }

    fn arguments(&self) -> Term {
        unreachable!("the members of a list of arguments are written by its call")
    }

    fn brackets(&self, a: Term) -> Term {
        a
    }
}
