use bryant::signature::{ContentKind, is_own_heading, is_signed, signed};
use std::path::Path;

#[test]
fn headings_of_others_are_not_ours() {
    for own in [
        "\"time [s]\",a [N]",
        "\"time [s]\",\"a, b [N]\"",
        "\"time [s]\"",
        "\"time [ms]\",a [N]",
    ] {
        assert!(is_own_heading(own.as_bytes()), "{own}");
    }
    for other in [
        "time [s],a [N]",
        "\"time [s]\",\"a [N]\"",
        "\"time\",a",
        "data",
    ] {
        assert!(!is_own_heading(other.as_bytes()), "{other}");
    }
}

#[test]
fn endings_of_other_formats_contradict() {
    let contradicts = |kind: ContentKind, name: &str| kind.contradicts(Path::new(name));
    assert!(
        contradicts(ContentKind::Report, "x.pdf") && contradicts(ContentKind::Animation, "x.gltf")
    );
    assert!(
        contradicts(ContentKind::Parquet, "x.CSV") && contradicts(ContentKind::Table, "a/x.xlsx")
    );
    for (kind, name) in [
        (ContentKind::Report, "x.HTML"),
        (ContentKind::Table, "x"),
        (ContentKind::State, "x.v2"),
    ] {
        assert!(!contradicts(kind, name), "{name}");
    }
}

#[test]
fn a_text_that_was_changed_is_not_ours_any_more() {
    let text = signed("model: a\n");
    assert!(is_signed(text.as_bytes()));
    assert!(!is_signed(text.replace("model: a", "model: b").as_bytes()));
    assert!(!is_signed(format!("{text}# mine\n").as_bytes()));
    assert!(!is_signed(b"model: a\n"));
}
