//! The page on studies against the program.

use bryant_study::engine::Status;
use bryant_study::facts::{ModelFacts, OutputFact, ParameterFact};
use bryant_study::file::{KEYS, StudyFile};
use bryant_study::response;
use std::path::Path;

const PAGE: &str = include_str!("../../docs/studies.md");

fn facts() -> ModelFacts {
    let parameter = |(name, unit, min, max): &(&str, &str, f64, f64)| ParameterFact {
        name: (*name).into(),
        unit: (*unit).into(),
        default: *min,
        min: Some(*min),
        max: Some(*max).filter(|max| max.is_finite()),
    };
    let output = |(name, unit): &(&str, &str)| OutputFact {
        name: (*name).into(),
        unit: (*unit).into(),
    };
    let infinity = f64::INFINITY;
    let parameters = [
        ("lap_slack", "m", 0.0, 0.1),
        ("friction", "", 0.0, 1.0),
        ("pulse_scale", "", 0.0, infinity),
        ("webbing_scale", "", 0.1, 10.0),
        ("cushion_scale", "", 0.1, 10.0),
        ("gravity", "m/s^2", 0.0, infinity),
    ];
    let outputs = [
        ("lap belt force", "N"),
        ("head accelerometer", "m/s^2"),
        ("head excursion", "m"),
    ];
    ModelFacts {
        parameters: parameters.iter().map(parameter).collect(),
        outputs: outputs.iter().map(output).collect(),
    }
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
fn the_page_names_every_key_response_and_end() {
    let words = KEYS
        .into_iter()
        .chain(response::NAMES.map(|(name, _)| name))
        .chain(Status::ALL.map(Status::word));
    for word in words {
        assert!(PAGE.contains(&format!("`{word}`")), "{word}");
    }
}
