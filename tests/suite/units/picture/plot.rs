use bryant::picture::plot::{LEFT, PlotError, RIGHT, Request, WIDTH};
use bryant::table::{Column, Table};

fn table() -> Table {
    let column = |name: &str, unit: &str, values: &[f64]| Column {
        name: name.into(),
        unit: unit.into(),
        values: values.to_vec(),
    };
    Table {
        columns: vec![
            column("time", "s", &[0.0, 0.1, 0.2]),
            column("belt force", "N", &[0.0, 120.0, f64::NAN]),
            column("elongation", "", &[0.0, 0.02, 0.05]),
            column("friction", "N", &[1.0, 2.0, 3.0]),
        ],
    }
}

const COLUMNS: [(&str, &str); 7] = [
    ("time", "s"),
    ("belt force", "N"),
    ("elongation", ""),
    ("friction", "N"),
    ("force, left", "N"),
    ("force over all", "N"),
    ("{}", "N"),
];

fn request(of: &[&str], over: &str) -> Request {
    Request {
        of: of.iter().map(|name| name.to_string()).collect(),
        over: over.into(),
    }
}

#[test]
fn requests_are_read() {
    let read = |text| Request::read(text, &COLUMNS);
    assert_eq!(read("belt force"), Ok(request(&["belt force"], "time")));
    assert_eq!(
        read("belt force , friction over elongation"),
        Ok(request(&["belt force", "friction"], "elongation"))
    );
    assert_eq!(read(" , "), Err(PlotError::Empty));
    for (text, of, over) in [
        ("force, left", &["force, left"][..], "time"),
        (
            "friction, force, left, {}",
            &["friction", "force, left", "{}"],
            "time",
        ),
        ("force over all", &["force over all"], "time"),
        (
            "friction over force over all",
            &["friction"],
            "force over all",
        ),
        ("force over all over time", &["force over all"], "time"),
        ("friction over force, left", &["friction"], "force, left"),
        (
            "friction, force over all",
            &["friction", "force over all"],
            "time",
        ),
    ] {
        assert_eq!(read(text), Ok(request(of, over)), "{text}");
    }
    let missing = read("friction, force over time").unwrap_err().to_string();
    assert!(missing.contains("no column \"force\""), "{missing}");
}

#[test]
fn files_are_told_apart() {
    let slug = |of: &str| request(&[of], "time").slug();
    assert_eq!(slug("belt force"), "belt-force-over-time");
    assert_eq!(slug("{}"), "u007b-u007d-over-time");
    assert_eq!(slug("--"), "u002d-u002d-over-time");
}

#[test]
fn columns_are_drawn_and_named() {
    let request = request(&["belt force", "friction"], "elongation");
    let drawing = request.draw("a <belt>", &table(), &[]).unwrap();
    let svg = drawing.svg();
    for word in [
        "<svg",
        "a &lt;belt&gt;",
        "elongation",
        "belt force",
        "friction",
        "[N]",
    ] {
        assert!(svg.contains(word), "{word}: {svg}");
    }
    assert!(drawing.png().is_ok());
    // lines begin at their numbers, not at whole pixels: 0 is 3 % of the range of 0.05 to the right of the frame's left
    // side
    let [left, across] = [LEFT, WIDTH - LEFT - RIGHT];
    let x = left + across * 0.03 / 1.06;
    assert!(svg.contains(&format!("points=\"{:.2},", x)), "{x}: {svg}");
}

#[test]
fn what_does_not_fit_is_named() {
    let error = |text: &str| Request::read(text, &COLUMNS).unwrap_err();
    assert!(
        error("tension")
            .to_string()
            .contains("time, belt force, elongation")
    );
    assert!(
        error("belt force, elongation")
            .to_string()
            .contains("pure numbers")
    );
}
