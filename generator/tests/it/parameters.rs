//! Run-time parameters cost only the operations that depend on them: values that depend on parameters alone are
//! computed once.

use bryant_generator::dynamics::derive;
use bryant_generator::effect::general;
use bryant_generator::model::Model;
use bryant_generator::program;
use std::path::Path;

fn written(path: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path);
    bryant_generator::read_annotated(&path)
        .expect("a valid model")
        .written
}

#[test]
fn what_parameters_alone_decide_is_computed_once() {
    for path in [
        "models/child-seat.yaml",
        "models/sled-pendulum.yaml",
        "models/dummy15.yaml",
        "tests/models/prescribed.yaml",
        "tests/models/sliding-sphere.yaml",
        "tests/models/free-tree-bryant.yaml",
    ] {
        let written = written(path);
        for model in [written.clone(), general(&written)] {
            let equations = derive(&model);
            for (method, count) in
                program::repeated(&model, &equations, &program::Options::default())
            {
                // the start of a run is computed once, and so is whether it is allowed
                let once = ["new", "initial_conditions", "initial_memory", "conditions"];
                if !once.contains(&&*method) {
                    assert!(count.is_empty(), "{path}: {method}: {count}");
                }
            }
        }
    }
}
