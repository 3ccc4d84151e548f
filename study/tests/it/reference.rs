//! The documentation page on studies agrees with the program.

use bryant_study::engine::Status;
use bryant_study::facts::ModelFacts;
use bryant_study::file::StudyFile;
use bryant_study::response;
use std::path::Path;

const PAGE: &str = include_str!("../../../docs/studies.md");

fn facts() -> ModelFacts {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/child-seat.yaml");
    ModelFacts::of(&bryant_generator::read_annotated(&model).unwrap())
}

#[test]
fn examples_are_studies() {
    let blocks: Vec<&str> = PAGE
        .split("```yaml\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .collect();
    assert_eq!(blocks.len(), 4);
    let rows = blocks.iter().map(|text| {
        let file = StudyFile::parse("studies.md", text).unwrap();
        file.resolve(&facts(), Path::new(".")).unwrap().rows
    });
    assert_eq!(rows.collect::<Vec<_>>(), [4096, 21, 2, 1024]);
}

#[test]
fn the_page_names_every_response_and_end() {
    let names = response::NAMES.map(|(name, _)| name).into_iter();
    let words = names.chain(Status::ALL.map(Status::word));
    for word in words {
        assert!(PAGE.contains(&format!("`{word}`")), "{word}");
    }
}
