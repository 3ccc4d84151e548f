//! Lists that join several methods: what the methods have in common is computed once.

use bryant_generator::program::{List, Method, Operation};
use bryant_generator::{Config, expression::Function};
use std::path::Path;

/// The number of searches between two ellipsoids.
fn searches(list: &List) -> usize {
    let is_search = |operation: &&Operation| match operation {
        Operation::Call { function, .. } => matches!(function, Function::Approach(_)),
        _ => false,
    };
    list.operations.iter().filter(is_search).count()
}

#[test]
fn power_and_wrench_of_a_contact_need_one_search() {
    for (scene, contacts) in [("occupant", 1), ("pedestrian", 7)] {
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../benches/scenes");
        let (model, _) = bryant_generator::read(&scenes.join(format!("{scene}.yaml"))).unwrap();
        let lists = Config::new().matrices(false).lists(&model);
        for method in [Method::Derivative, Method::Powers, Method::ExternalWrench] {
            assert_eq!(
                searches(lists.list(method)),
                contacts,
                "{scene}: {method:?}"
            );
        }
        let joined = lists.combined(
            [Method::Powers, Method::ExternalWrench]
                .into_iter()
                .collect(),
        );
        assert_eq!(searches(&joined), contacts, "{scene}: joined");
    }
}
