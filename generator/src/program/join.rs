//! Several lists as one.

use super::{Input, List, Operation, Value};
use crate::expression::Function;
use rustc_hash::FxHashMap;

impl List {
    /// What several lists compute, one after the other: the results of one behind those of the one before. Operations that several have
    /// on the same operands are done once, so nothing is rounded otherwise.
    pub fn joined<'a>(lists: impl IntoIterator<Item = &'a List>) -> List {
        let mut lists: Vec<&List> = lists.into_iter().collect();
        lists.retain(|list| !list.results.is_empty());
        match lists[..] {
            [] => List::default(),
            [one] => one.clone(),
            _ => join(&lists),
        }
    }
}

fn join(lists: &[&List]) -> List {
    let mut joined = List::default();
    let mut constant_of: FxHashMap<u64, u32> = FxHashMap::default();
    let mut input_of: FxHashMap<Input, u32> = FxHashMap::default();
    for list in lists {
        for &constant in &list.constants {
            constant_of.entry(constant.to_bits()).or_insert_with(|| {
                joined.constants.push(constant);
                joined.constants.len() as u32 - 1
            });
        }
        for &input in &list.inputs {
            input_of.entry(input).or_insert_with(|| {
                joined.inputs.push(input);
                joined.inputs.len() as u32 - 1
            });
        }
    }
    let constants = joined.constants.len() as u32;
    let mut next = constants + joined.inputs.len() as u32;
    let mut found: FxHashMap<(Which, Vec<Value>), u32> = FxHashMap::default();
    for list in lists {
        let leaves = list.constants.iter().map(|c| constant_of[&c.to_bits()]);
        let inputs = list.inputs.iter().map(|input| constants + input_of[input]);
        let mut place: Vec<Value> = leaves.chain(inputs).map(Value).collect();
        for &operation in &list.operations {
            let operands: Vec<Value> = (list.operands(operation))
                .map(|value| place[value.0 as usize])
                .collect();
            let key = (Which::of(operation), operands);
            let first = match found.get(&key) {
                Some(&first) => first,
                None => {
                    let first = next;
                    next += operation.defines() as u32;
                    let moved = match operation {
                        Operation::Call { function, .. } => {
                            let at = joined.arguments.len() as u32;
                            joined.arguments.extend(&key.1);
                            Operation::Call {
                                function,
                                first: at,
                            }
                        }
                        algebra => algebra.map(|value| place[value.0 as usize]),
                    };
                    joined.operations.push(moved);
                    found.insert(key, first);
                    first
                }
            };
            place.extend((0..operation.defines() as u32).map(|part| Value(first + part)));
        }
        let results = list.results.iter().map(|value| place[value.0 as usize]);
        joined.results.extend(results);
    }
    joined
}

/// Which operation, without its operands.
#[derive(PartialEq, Eq, Hash)]
enum Which {
    Algebra(std::mem::Discriminant<Operation>),
    Call(Function),
}

impl Which {
    fn of(operation: Operation) -> Self {
        match operation {
            Operation::Call { function, .. } => Which::Call(function),
            algebra => Which::Algebra(std::mem::discriminant(&algebra)),
        }
    }
}
