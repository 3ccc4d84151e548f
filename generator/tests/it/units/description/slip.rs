use bryant_generator::description::slip::{is_decimal_comma, key_meant, noticed_at};

fn at(text: &str, line: usize) -> (usize, usize, String) {
    let slip = noticed_at(text, line).unwrap();
    (slip.span.line, slip.span.column, slip.message)
}

#[test]
fn a_missing_space_is_found_before_the_line_that_does_not_fit() {
    let (line, column, message) = at("model: p\ndimension:2\n\n# more\nsystems:\n", 5);
    assert_eq!((line, column), (2, 1));
    assert!(message.contains("`dimension:`"), "{message}");
    assert_eq!(at("a: { b: 1, mass:4 }\n", 1).1, 12);
}

#[test]
fn tabs_and_odd_signs_are_named() {
    assert_eq!(at("a:\n  b: 1\n\tc: 2\n", 2).0, 3);
    assert!(at("a: “b”: c\n", 1).2.contains("U+201C"));
    assert!(at("a:\n\u{a0} b: 1\n", 2).2.contains("no-break"));
}

#[test]
fn what_stands_in_quotation_marks_and_comments_is_no_slip() {
    let text = "a: \"b:c “\" # d:e\nof: it's\nurl: http://a.b\n";
    assert_eq!(noticed_at(text, 3), None);
}

#[test]
fn keys_are_meant() {
    let meant = |written| key_meant(written, &["mass", "cg"]).map(|m| (m.key, m.value));
    let mass = Some("mass".to_owned());
    assert_eq!(
        meant("mass:4 kg"),
        mass.clone().map(|m| (m, Some("4 kg".into())))
    );
    assert_eq!(meant("\u{a0}mass"), mass.map(|m| (m, None)));
    assert_eq!(meant("weight:4"), None);
}

#[test]
fn a_decimal_comma_has_digits_on_both_sides() {
    assert!(is_decimal_comma("-0", "35 kg"));
    assert!(!is_decimal_comma("0.1", "35") && !is_decimal_comma("a", "35"));
}
