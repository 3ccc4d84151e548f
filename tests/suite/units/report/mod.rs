mod curves;
mod plots;

use bryant::report::{modes_page, page};
use bryant_picture::text::typeset;
use serde_json::json;

/// The page writes units as pictures and terminals do: what its script replaces, read from its text, is what the
/// program replaces.
#[test]
fn the_page_writes_units_as_the_program_does() {
    let script = include_str!("../../../../src/report/common.js");
    let mut lines = script.lines();
    let line = lines.find_map(|line| line.strip_prefix("const typeset = (unit) => unit"));
    let each = line.unwrap().trim_end_matches(';').split(".replace(/");
    let each = each.skip(1).map(|one| {
        let (pattern, by) = one.split_once("/g, \"").unwrap();
        (pattern.replace('\\', ""), by.strip_suffix("\")").unwrap())
    });
    let each: Vec<(String, &str)> = each.collect();
    assert!(each.len() > 3);
    let by_page = |unit: &str| {
        each.iter().fold(unit.to_owned(), |unit, (pattern, by)| {
            unit.replace(pattern, by)
        })
    };
    for unit in [
        "",
        "m",
        "m/s^2",
        "N*m",
        "N*m*s/rad",
        "kg*m^2",
        "m^3",
        "kg/m^3",
        "m^2/s^3",
        "deg",
        "deg/s",
        "rad/s^2",
        "N*m/deg",
        "kPa",
        "1/s",
        "m^4",
        "g",
        "mm/(N*s)",
    ] {
        assert_eq!(by_page(unit), typeset(unit), "{unit}");
    }
}

#[test]
fn names_of_a_model_cannot_leave_their_place() {
    let hostile = "</script><script>alert(1)</script> {{data}} \"'&<img src=x onerror=alert(1)>";
    let data = json!({ "name": hostile, hostile: [hostile] });
    for text in [page(hostile, &data), modes_page(hostile, &data)] {
        assert!(!text.contains("alert(1)</script>") && !text.contains("<img"));
        // these are the two elements of the page itself
        assert_eq!(text.matches("</script>").count(), 2);
        let inside = text.split("id=\"data\">").nth(1).unwrap();
        let inside = inside.split("</script>").next().unwrap();
        let back: serde_json::Value = serde_json::from_str(inside).unwrap();
        assert_eq!(back, data);
    }
}

#[test]
fn a_page_asks_no_host_and_evaluates_no_text() {
    let text = page("a", &json!({})) + &modes_page("a", &json!({}));
    for word in [
        "http:",
        "https:",
        "eval(",
        "innerHTML",
        "import(",
        "fetch(",
        "@import",
        "src=",
    ] {
        assert!(!text.contains(word), "{word}");
    }
    assert!(text.contains("default-src 'none'"));
}

/// A name that two scripts of a page declare makes a page without content: no script of it runs.
#[test]
fn no_name_is_declared_twice_in_the_scripts_of_a_page() {
    for text in [page("a", &json!({})), modes_page("a", &json!({}))] {
        let declared = text.lines().filter_map(|line| {
            let rest = ["const ", "let ", "function "].iter();
            let rest = rest.filter_map(|word| line.strip_prefix(word)).next()?;
            let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_')?;
            Some(&rest[..end]).filter(|name| !name.is_empty())
        });
        let mut names: Vec<&str> = declared.collect();
        assert!(names.contains(&"cross") && names.contains(&"bushingMark"));
        names.sort_unstable();
        let twice = names.windows(2).find(|pair| pair[0] == pair[1]);
        assert_eq!(twice, None);
    }
}
