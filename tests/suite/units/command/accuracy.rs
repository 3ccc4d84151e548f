use bryant::accuracy::setting::Scheme;
use bryant::command::accuracy::{accuracy, link, methods, steps, tolerances};
use bryant_runtime::Formula;
use std::path::Path;

#[test]
fn bad_input_is_told_what_is_possible() {
    let error = methods("rk4,dopri6").unwrap_err();
    assert!(
        error.contains("dopri5") && error.contains("rodas5"),
        "{error}"
    );
    for wrong in ["0..1e-1", "-1e-3", "nan..1e-3", "1..1e-3", "x"] {
        let error = tolerances(wrong).unwrap_err();
        assert!(error.contains("1e-2..1e-10"), "{error}");
    }
    assert!(steps("0 s..1 ms").unwrap_err().contains("help:"));
    assert!(accuracy("0").is_err() && accuracy("2").is_err());
    assert_eq!(accuracy("1 %"), Ok(0.01));
    assert_eq!(
        methods("rk4, dopri5+rodas5,rk4").unwrap().0,
        [
            Scheme {
                formula: Formula::Rk4,
                switches: false
            },
            Scheme::DEFAULT
        ]
    );
}

#[test]
fn pages_link_pictures_as_seen_from_them() {
    let link = |page: &str, picture: &str| link(Path::new(page), Path::new(picture));
    assert_eq!(link("docs/a.md", "docs/images/a.svg"), "images/a.svg");
    assert_eq!(link("a.md", "a.svg"), "a.svg");
    assert_eq!(link("docs/a.md", "out/a.svg"), "../out/a.svg");
    assert_eq!(link("docs/b/a.md", "docs/images/a.svg"), "../images/a.svg");
    assert_eq!(link("/docs/a.md", "a.svg"), "a.svg");
    assert_eq!(link("../a.md", "a.svg"), "a.svg");
}
