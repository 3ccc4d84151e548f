//! The emitted text depends only on the model: not on the run, and not on the place of the file.

use crate::share::share;
use bryant_generator::{Config, Generated};
use std::path::{Path, PathBuf};

/// All models of the project with the data that they include, as paths relative to this crate.
fn models() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for directory in ["../models", "models"] {
        let entries = here
            .join(directory)
            .canonicalize()
            .and_then(std::fs::read_dir);
        let entries = entries.expect("a directory of models");
        found.extend(entries.map(|entry| entry.expect("an entry").path()));
    }
    found.retain(|path| path.extension().is_some_and(|e| e == "yaml"));
    found.sort();
    assert!(found.len() > 10, "{found:?}");
    found
}

fn generate(model: &Path, out: &Path) -> Generated {
    let mut generated = Config::new()
        .model(model)
        .out_dir(out)
        .generate()
        .unwrap_or_else(|error| panic!("{error}"));
    generated.pop().expect("one model")
}

#[test]
fn a_model_gives_the_same_bytes_anywhere_and_any_time() {
    let elsewhere = tempfile::tempdir().expect("a directory");
    let place = elsewhere.path().join("another place").join("Modelle ä");
    let root = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .canonicalize();
    let root = root.expect("the project");
    let copied = |path: &Path| place.join(path.strip_prefix(&root).expect("a file of the project"));
    for path in share(3, models()) {
        let here = path.parent().expect("a directory");
        let first = generate(&path, &elsewhere.path().join("first"));
        // a copy with all files that it includes
        for read in &first.read {
            let copy = copied(read);
            std::fs::create_dir_all(copy.parent().expect("a directory")).expect("a directory");
            std::fs::copy(read, copy).expect("a copy");
        }
        let second = generate(&copied(&path), &elsewhere.path().join("second"));

        let name = path.display();
        assert!(first.source == second.source, "{name} depends on its place");
        let written = |generated: &Generated| std::fs::read(&generated.written).expect("the text");
        assert!(written(&first) == written(&second), "{name} as written");
        assert!(
            written(&first) == first.source.as_bytes(),
            "{name} as written"
        );
        let again = generate(&path, &elsewhere.path().join("first"));
        assert!(first.source == again.source, "{name} depends on the run");
        for place in [here, place.as_path()] {
            let place = place.to_str().expect("a path in Unicode");
            assert!(!first.source.contains(place), "{name} names {place}");
        }
    }
}
