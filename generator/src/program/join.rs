//! Joins several lists to one.

use super::{Input, List, Lists, Method, Operation, Start, Value};
use crate::expression::Function;
use rustc_hash::FxHashMap;

/// A set of methods that are evaluated at the same time and state: their results follow one another in the order of
/// [`Method::ALL`]. Evaluated together they are cheaper, because they share many operations, above all those of
/// contacts.
///
/// A set is greater than another if its last method is a later one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Methods(u32);

impl Methods {
    /// True if the method is one of them.
    pub const fn contains(self, method: Method) -> bool {
        self.0 >> method as u32 & 1 == 1
    }

    /// These and one more.
    pub const fn with(self, method: Method) -> Self {
        Methods(self.0 | 1 << method as u32)
    }

    /// The only one; `None` if there are several or none.
    pub fn one(self) -> Option<Method> {
        let one = self.0.is_power_of_two();
        one.then(|| Method::ALL[self.0.trailing_zeros() as usize])
    }

    /// All of them, in the order of their results.
    pub fn iter(self) -> impl Iterator<Item = Method> {
        Method::ALL
            .into_iter()
            .filter(move |method| self.contains(*method))
    }
}

impl From<Method> for Methods {
    fn from(method: Method) -> Self {
        Methods::default().with(method)
    }
}

impl FromIterator<Method> for Methods {
    fn from_iter<I: IntoIterator<Item = Method>>(methods: I) -> Self {
        methods.into_iter().fold(Methods::default(), Methods::with)
    }
}

impl Lists {
    /// Several methods as one list that needs only time, state and parameters: accelerations or event functions from
    /// which a method starts are computed in the list. The operations are those of the methods, so the results have the
    /// same bits.
    pub fn combined(&self, wanted: Methods) -> List {
        let coordinates = self.facts.coordinates.len();
        let mut needed: Vec<Method> = wanted.iter().collect();
        for (start, by) in [
            (Start::EventFunctions, Method::EventFunctions),
            (Start::Accelerations, Method::Derivative),
        ] {
            let starts = |method: &Method| self.routine(*method).start == start;
            if !needed.contains(&by) && needed.iter().any(starts) {
                needed.push(by);
            }
        }
        needed.sort_unstable();
        let parts = needed.iter().map(|method| Part {
            list: self.list(*method),
            wanted: wanted.contains(*method),
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
