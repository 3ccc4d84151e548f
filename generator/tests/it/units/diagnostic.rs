use bryant_generator::Diagnostic;
use bryant_generator::diagnostic::{nearest, quoted, suggestion};

#[test]
fn a_problem_is_drawn_under_its_text() {
    let text = "one\n  parent: torzo\n";
    let problem = Diagnostic::at("a.yaml", text, (2, 11, 5), "no torzo", "say torso");
    let drawn = problem.to_string();
    assert!(drawn.contains("a.yaml:2:11"), "{drawn}");
    assert!(drawn.contains("          ^^^^^"), "{drawn}");
    assert!(drawn.contains("help: say torso"), "{drawn}");
    assert_eq!(problem.line(), "a.yaml:2:11: no torzo (help: say torso)");
}

#[test]
fn near_misses_are_close() {
    assert_eq!(nearest("torzo", ["head", "torso"]), Some("torso"));
    assert_eq!(nearest("pelvis", ["head", "torso"]), None);
    assert_eq!(suggestion("x", [], "there is none"), "there is none");
}

#[test]
fn quoted_text_is_short_and_printable() {
    assert_eq!(quoted("a\nb\"\u{7}"), "\"a\\nb\\\"\\u{7}\"");
    assert!(quoted(&"x".repeat(1000)).chars().count() < 70);
}
