//! The interpreter. The lists and their evaluation are those of the tests of machine code.

use super::evaluate::{Given, results};
use super::random::{INPUTS, Mix, Random, list};
use bryant_engine::internals::{alone, count_runs};
use bryant_generator::Config;
use bryant_generator::expression::Function;
use bryant_generator::program::{List, Method, Operation, Value};

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
        let numbers = INPUTS.map(|count| (0..count).map(|_| random.ordinary()).collect());
        let [state, parameters, derived] = numbers;
        let given = Given {
            time: random.ordinary(),
            state,
            parameters,
            derived,
        };
        let inputs = [
            &given.parameters[..],
            &given.derived,
            &[given.time],
            &given.state,
        ];
        let (found, expected) = (alone(&list, inputs), results(&list, &given));
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(expected) {
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
    let yaml = include_str!("../../../../models/dummy15.yaml");
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("dummy15.yaml", yaml, &none).unwrap();
    let lists = Config::new().lists(&model);
    let list = lists.combined(Method::Derivative.into());
    let [before, after] = count_runs(&list);
    let count = list.operations.len();
    assert!(
        10 * after < count && before > count / 4,
        "{before}, {after} of {count}"
    );
}
