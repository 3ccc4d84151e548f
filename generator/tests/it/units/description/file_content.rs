use bryant_generator::description::file_content::{instead_of_model, of_text};
use bryant_generator::description::tree::Source;

fn of(text: &str) -> Option<&'static str> {
    let source = Source::parse("a.yaml", text).unwrap();
    instead_of_model(&source.root, "a.yaml").map(|(what, _)| what)
}

#[test]
fn files_are_told_by_what_they_are() {
    assert_eq!(of("{ model: a, design: sobol, runs: 8 }"), Some("a study"));
    assert_eq!(
        of("{ model: a, time: 0, coordinates: {}, velocities: {} }"),
        Some("a state of a run")
    );
    assert_eq!(
        of("systems: [{ name: man }]"),
        Some("a part that models include")
    );
    assert_eq!(of("{ model: a, dimension: 2, systems: [] }"), None);
    assert_eq!(of("{ model: a, dimension: 2, runs: 8 }"), Some("a study"));
    assert_eq!(of("model: a"), None);
    let table = |text| of_text(text).map(|(what, _)| what);
    assert_eq!(table("time [s],a\n0,1\n"), Some("a table (CSV)"));
    assert_eq!(table("t;a\n0,5;1\n"), Some("a table (CSV)"));
    assert_eq!(table("model: a\ndimension: 2\n"), None);
    assert_eq!(table("\n<svg xmlns='a'>"), Some("a picture (SVG)"));
}
