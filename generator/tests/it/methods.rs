//! The table of methods.

use bryant_generator::dynamics::derive;
use bryant_generator::method::Method;
use bryant_generator::method::inputs::Inputs;
use bryant_generator::method::table::{Source, methods, motion};
use bryant_generator::read;

use std::collections::BTreeSet;
use std::path::Path;

/// Models that have all there is among them: curves that parameters stretch, pivots that may vanish, event functions,
/// charts, states of laws.
const MODELS: [&str; 6] = [
    "models/child-seat.yaml",
    "tests/models/curves.yaml",
    "tests/models/incline.yaml",
    "tests/models/pendulum.yaml",
    "tests/models/poles-bryant.yaml",
    "tests/models/switches.yaml",
];

#[test]
fn every_method_of_the_lists_has_an_entry() {
    let mut found = BTreeSet::from([Method::Derived]);
    for path in MODELS {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
        let (model, _) = read(&path).expect("a valid model");
        let equations = derive(&model);
        let inputs = Inputs::new(&model, &equations);
        let source = Source {
            model: &model,
            equations: &equations,
            inputs: &inputs,
            matrices: true,
        };
        let methods = methods(&source, None);
        let named = |name| methods.iter().find(|of| of.name == name);
        let both = named("coordinate_rates").zip(named("accelerations"));
        let motion = both.map(|(rates, accelerations)| motion(rates, accelerations));
        let mut names = BTreeSet::new();
        for method in methods.iter().chain(&motion) {
            let name = method.name.clone();
            assert!(names.insert(name.clone()), "two methods are called {name}");
            assert_eq!(method.labels.len(), method.roots.len(), "{name}");
            assert!(!method.documentation.is_empty(), "{name}");
            found.extend(method.part_of);
        }
    }
    let missing: Vec<_> = (Method::ALL.iter())
        .filter(|method| !found.contains(method))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
