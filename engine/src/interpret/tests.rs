//! The interpreter. The lists and their evaluation are those of the tests of machine code.

use super::{Kind, Layout, Runs, encode, in_runs};
use crate::call::Library;
use crate::tests::evaluate::evaluate;
use crate::tests::random::{INPUTS, Mix, Random, list};
use bryant_generator::Config;
use bryant_generator::expression::Function;
use bryant_generator::program::{List, Method, Operation, Value};
use bryant_runtime::Task as _;
use std::collections::HashMap;

/// Appends a choice between any values, and a product with its result.
fn append_call(list: &mut List, random: &mut Random) {
    let first = list.arguments.len() as u32;
    let values = list.values();
    let mut any = || Value(random.below(values) as u32);
    list.arguments.extend([(); 4].map(|()| any()));
    let (factor, result) = (any(), Value(values as u32));
    list.operations.push(Operation::Call {
        function: Function::Choose,
        first,
    });
    list.operations.push(Operation::Mul(result, factor));
    list.results.extend([result, Value(values as u32 + 1)]);
}

#[test]
fn the_interpreter_has_the_bits_of_each_operation_alone() {
    for seed in 0..60 {
        let mix = Mix {
            // the last ones are as long as methods of real models
            length: if seed < 50 { 60 } else { 3000 },
            calls: 0,
            reach: if seed < 50 { 20 } else { 500 },
        };
        let random = &mut Random::new(seed);
        let mut list = list(random, mix);
        append_call(&mut list, random);
        let places = (0..).zip(&list.constants);
        let constants: HashMap<u64, u32> = places.map(|(i, c)| (c.to_bits(), i)).collect();
        let [state, parameters, derived] = INPUTS.map(|n| n as u32);
        let parameters_at = list.constants.len() as u32;
        let time = parameters_at + parameters + derived;
        let layout = Layout {
            parameters: parameters_at,
            derived: parameters_at + parameters,
            time,
            state: time + 1,
            rest: time + 1 + state,
        };
        let code = encode(&list, &layout, &constants);
        let mut frame: Vec<f64> = (0..code.end).map(|_| random.ordinary()).collect();
        frame[..list.constants.len()].copy_from_slice(&list.constants);

        let inputs = list.inputs.iter();
        let inputs = inputs.map(|input| frame[layout.place(*input) as usize]);
        let mut values = list.constants.clone();
        values.extend(inputs);
        for &operation in &list.operations {
            let defined = evaluate(&list, &values, operation);
            values.extend(defined);
        }

        Runs {
            code: &code,
            library: &Library::new(&[], None),
            frame: &mut frame,
            arguments: &mut vec![0.0; code.most_arguments],
        }
        .run();
        for (value, &place) in list.results.iter().zip(&code.results) {
            let (found, expected) = (frame[place as usize], values[value.0 as usize]);
            let same = found.to_bits() == expected.to_bits();
            assert!(
                same || found.is_nan() && expected.is_nan(),
                "list {seed}: {found} for {expected}"
            );
        }
    }
}

#[test]
fn runs_of_one_kind_are_long() {
    let yaml = include_str!("../../../models/dummy15.yaml");
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("dummy15.yaml", yaml, &none).unwrap();
    let lists = Config::new().lists(&model);
    let list = lists.combined(Method::Derivative.into());
    let runs = |operations: &mut dyn Iterator<Item = Operation>| {
        let kinds: Vec<Kind> = operations.map(Kind::of).collect();
        kinds.chunk_by(|a, b| a == b).count()
    };
    let ordered = in_runs(&list).into_iter();
    let [before, after] = [
        runs(&mut list.operations.iter().copied()),
        runs(&mut ordered.map(|(_, operation)| operation)),
    ];
    let count = list.operations.len();
    assert!(
        10 * after < count && before > count / 4,
        "{before}, {after} of {count}"
    );
}
