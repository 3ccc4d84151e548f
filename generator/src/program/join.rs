//! Joins several lists to one.

use super::{Input, List, Lists, Method, Operation, Start, Value};
use crate::expression::Function;
use rustc_hash::FxHashMap;

/// Methods that are often evaluated at the same time and state. Evaluated together they are cheaper, because they share
/// many operations, above all those of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Combination {
    /// The event functions, with the accelerations that they start from.
    EventFunctions,
    /// The outputs, with the accelerations that they start from.
    Outputs,
    /// The terms of balances within a step: powers and external_wrench.
    Exchange,
    /// The results that a time loop needs at the end of a step: event functions, onsets, and the memory renewed
    /// according to these event functions.
    Arrival,
    /// The same, with the arguments of curves.
    ArrivalWithCurves,
    /// The same as `ArrivalWithCurves`, with the terms of balances: kinetic energy, powers, momentum and
    /// external_wrench.
    WatchedArrival,
}

impl Combination {
    /// All combinations, in the order of their numbers.
    pub const ALL: [Combination; 6] = [
        Combination::EventFunctions,
        Combination::Outputs,
        Combination::Exchange,
        Combination::Arrival,
        Combination::ArrivalWithCurves,
        Combination::WatchedArrival,
    ];

    /// The methods whose results the combination has, one after the other.
    pub const fn methods(self) -> &'static [Method] {
        match self {
            Combination::EventFunctions => &[Method::EventFunctions],
            Combination::Outputs => &[Method::Outputs],
            Combination::Exchange => &[Method::Powers, Method::ExternalWrench],
            Combination::Arrival => &[Method::EventFunctions, Method::Onsets, Method::Renewed],
            Combination::ArrivalWithCurves => &[
                Method::EventFunctions,
                Method::Onsets,
                Method::Renewed,
                Method::Curves,
            ],
            Combination::WatchedArrival => &[
                Method::EventFunctions,
                Method::Onsets,
                Method::Renewed,
                Method::Curves,
                Method::KineticEnergy,
                Method::Powers,
                Method::Momentum,
                Method::ExternalWrench,
            ],
        }
    }
}

impl Lists {
    /// Several methods as one list that needs only time, state and parameters: accelerations or event functions from
    /// which a method starts are computed in the list. The operations are those of the methods, so the results have the
    /// same bits.
    pub fn combined(&self, combination: Combination) -> List {
        let wanted = combination.methods();
        let coordinates = self.facts.coordinates.len();
        let starts = |start| move |method: &Method| self.routine(*method).start == start;
        let from_event_functions = wanted.iter().any(starts(Start::EventFunctions));
        let mut methods = wanted.to_vec();
        if from_event_functions && !wanted.contains(&Method::EventFunctions) {
            methods.insert(0, Method::EventFunctions);
        }
        if methods.iter().any(starts(Start::Accelerations)) {
            methods.insert(0, Method::Derivative);
        }
        let parts = methods.iter().map(|method| Part {
            list: self.list(*method),
            wanted: wanted.contains(method),
            gives: match method {
                Method::Derivative => Gives::Accelerations(coordinates),
                Method::EventFunctions => Gives::EventFunctions,
                _ => Gives::Nothing,
            },
        });
        join(&parts.collect::<Vec<_>>()).live()
    }
}

impl List {
    /// Several lists as one, with their results one after the other. Operations that several lists do on the same
    /// operands are done once, so rounding does not change.
    pub fn joined<'a>(lists: impl IntoIterator<Item = &'a List>) -> List {
        let mut lists: Vec<&List> = lists.into_iter().collect();
        lists.retain(|list| !list.results.is_empty());
        match lists[..] {
            [] => List::default(),
            [one] => one.clone(),
            _ => {
                let parts = lists.into_iter().map(|list| Part {
                    list,
                    wanted: true,
                    gives: Gives::Nothing,
                });
                join(&parts.collect::<Vec<_>>())
            }
        }
    }

    /// The list without operations that no result needs.
    fn live(self) -> List {
        let leaves = self.constants.len() + self.inputs.len();
        let mut needed = vec![false; self.values()];
        for result in &self.results {
            needed[result.0 as usize] = true;
        }
        let mut first = self.values();
        for &operation in self.operations.iter().rev() {
            let count = operation.defines();
            first -= count;
            if needed[first..first + count].contains(&true) {
                for operand in self.operands(operation) {
                    needed[operand.0 as usize] = true;
                }
            }
        }
        let mut place: Vec<Value> = (0..leaves as u32).map(Value).collect();
        let mut live = List {
            constants: self.constants.clone(),
            inputs: self.inputs.clone(),
            ..List::default()
        };
        let mut next = leaves as u32;
        for &operation in &self.operations {
            let (first, count) = (place.len(), operation.defines());
            if needed[first..first + count].contains(&true) {
                let operands: Vec<Value> = (self.operands(operation))
                    .map(|value| place[value.0 as usize])
                    .collect();
                live.push(operation, &operands, |value| place[value.0 as usize]);
                place.extend((0..count as u32).map(|part| Value(next + part)));
                next += count as u32;
            } else {
                place.extend((0..count).map(|_| Value(u32::MAX)));
            }
        }
        let results = self.results.iter().map(|value| place[value.0 as usize]);
        live.results.extend(results);
        live
    }

    /// Appends an operation with its operands mapped by `map`; `operands` are the mapped operands.
    fn push(&mut self, operation: Operation, operands: &[Value], map: impl FnMut(Value) -> Value) {
        self.operations.push(match operation {
            Operation::Call { function, .. } => {
                let first = self.arguments.len() as u32;
                self.arguments.extend(operands);
                Operation::Call { function, first }
            }
            algebra => algebra.map(map),
        });
    }
}

/// A list to be joined.
struct Part<'a> {
    list: &'a List,
    /// True if its results are results of the joined list.
    wanted: bool,
    /// The use that later parts make of its results.
    gives: Gives,
}

/// The use that later parts make of a part's results.
#[derive(Clone, Copy)]
enum Gives {
    Nothing,
    /// The results from this index on are accelerations.
    Accelerations(usize),
    /// The results are event functions.
    EventFunctions,
}

/// The values that the parts so far provide to later ones.
#[derive(Default)]
struct Given {
    accelerations: Option<Vec<Value>>,
    event_functions: Option<Vec<Value>>,
}

impl Given {
    /// The value of an input that an earlier part has computed; `None` if there is none.
    fn value(&self, input: Input) -> Option<Value> {
        match input {
            Input::Acceleration(i) => self.accelerations.as_ref().map(|given| given[i as usize]),
            Input::EventFunction(i) => self.event_functions.as_ref().map(|given| given[i as usize]),
            _ => None,
        }
    }

    fn take(&mut self, gives: Gives, results: &[Value]) {
        match gives {
            Gives::Nothing => {}
            Gives::Accelerations(from) => self.accelerations = Some(results[from..].to_vec()),
            Gives::EventFunctions => self.event_functions = Some(results.to_vec()),
        }
    }
}

/// A list with the constants and inputs of all parts, and the index of each constant and of each input.
fn leaves(parts: &[Part]) -> (List, FxHashMap<u64, u32>, FxHashMap<Input, u32>) {
    let mut joined = List::default();
    let mut constant_of: FxHashMap<u64, u32> = FxHashMap::default();
    let mut input_of: FxHashMap<Input, u32> = FxHashMap::default();
    let mut given = Given::default();
    for Part { list, gives, .. } in parts {
        for &constant in &list.constants {
            constant_of.entry(constant.to_bits()).or_insert_with(|| {
                joined.constants.push(constant);
                joined.constants.len() as u32 - 1
            });
        }
        for &input in &list.inputs {
            if given.value(input).is_none() {
                input_of.entry(input).or_insert_with(|| {
                    joined.inputs.push(input);
                    joined.inputs.len() as u32 - 1
                });
            }
        }
        given.take(*gives, &list.results);
    }
    (joined, constant_of, input_of)
}

fn join(parts: &[Part]) -> List {
    let (mut joined, constant_of, input_of) = leaves(parts);
    let constants = joined.constants.len() as u32;
    let mut next = constants + joined.inputs.len() as u32;
    let mut found: FxHashMap<Key, u32> = FxHashMap::default();
    let mut given = Given::default();
    let mut operands = Vec::new();
    for Part {
        list,
        wanted,
        gives,
    } in parts
    {
        let leaves = (list.constants.iter()).map(|c| Value(constant_of[&c.to_bits()]));
        let inputs = (list.inputs.iter()).map(|input| match given.value(*input) {
            Some(value) => value,
            None => Value(constants + input_of[input]),
        });
        let mut place: Vec<Value> = leaves.chain(inputs).collect();
        for &operation in &list.operations {
            operands.clear();
            operands.extend((list.operands(operation)).map(|value| place[value.0 as usize]));
            let first = *(found.entry(Key::of(operation, &operands))).or_insert_with(|| {
                let first = next;
                next += operation.defines() as u32;
                joined.push(operation, &operands, |value| place[value.0 as usize]);
                first
            });
            place.extend((0..operation.defines() as u32).map(|part| Value(first + part)));
        }
        let results: Vec<Value> = (list.results.iter())
            .map(|value| place[value.0 as usize])
            .collect();
        given.take(*gives, &results);
        if *wanted {
            joined.results.extend(results);
        }
    }
    joined
}

/// An operation with its operands; those of a call are boxed. The operands of a sum are sorted, because a + b and b + a
/// have the same bits for every scalar. The operands of a product are not sorted: with dual numbers, a · b and b · a
/// may differ in the rounding of their slopes.
#[derive(PartialEq, Eq, Hash)]
enum Key {
    Algebra(std::mem::Discriminant<Operation>, [u32; 3]),
    Call(Function, Box<[Value]>),
}

impl Key {
    fn of(operation: Operation, operands: &[Value]) -> Self {
        match operation {
            Operation::Call { function, .. } => Key::Call(function, operands.into()),
            algebra => {
                let mut all = [u32::MAX; 3];
                for (place, operand) in all.iter_mut().zip(operands) {
                    *place = operand.0;
                }
                if matches!(algebra, Operation::Add(..)) {
                    all[..2].sort_unstable();
                }
                Key::Algebra(std::mem::discriminant(&algebra), all)
            }
        }
    }
}
