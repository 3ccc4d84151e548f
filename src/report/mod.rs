//! A run, modes or a study as one page of HTML. The page of a run has the motion, the curves and the verdict, that of modes the motion in each of them,
//! that of a study distributions and rows. A page needs no other file and no network.
//!
//! | file | what |
//! |---|---|
//! | `scene` | bodies, shapes and forces at every sample, as data |
//! | `curves` | outputs over time, with samples between rows |
//! | `plots` | which outputs share a plot |
//! | `common.js`, `style.css`, `frame.html` | what all pages share |
//! | `page.html` | the page of a run |
//! | `motion.html` | the motion with its controls, on the page of a run and on that of modes |
//! | `camera.js`, `draw.js`, `motion.js` | the motion: the direction of the view, WebGL or canvas, playback |
//! | `curves.js` | outputs over time: plots, readings, zoom |
//! | `parts.js` | the tree of parts, and what is known of a part that was clicked |
//! | `tables.js` | the messages and numbers of the run |
//! | `modes.html`, `modes.js` | the page of modes |
//! | `study`, `study.html`, `study.js` | the page of a study |
//!
//! All data from a model is JSON, which the page puts into the document as text, never as HTML.

mod curves;
pub mod plots;
mod scene;
pub mod study;

pub use curves::{Curve, Samples, curves};
pub use scene::{json, short};

use serde_json::Value;

/// The page of a run. `title` is its heading; its scripts read `data`.
pub fn page(title: &str, data: &Value) -> String {
    let scripts = [
        include_str!("common.js"),
        include_str!("camera.js"),
        include_str!("draw.js"),
        include_str!("motion.js"),
        include_str!("curves.js"),
        include_str!("parts.js"),
        include_str!("tables.js"),
    ];
    filled(include_str!("page.html"), title, data, &scripts)
}

/// The page of modes.
pub fn modes_page(title: &str, data: &Value) -> String {
    let scripts = [
        include_str!("common.js"),
        include_str!("camera.js"),
        include_str!("draw.js"),
        include_str!("motion.js"),
        include_str!("parts.js"),
        include_str!("modes.js"),
    ];
    filled(include_str!("modes.html"), title, data, &scripts)
}

/// A page with its title, its scripts and its data in their places.
fn filled(main: &str, title: &str, data: &Value, scripts: &[&str]) -> String {
    // no string can end the element that contains it
    let data = data.to_string().replace('<', "\\u003c");
    include_str!("frame.html")
        .replace("{{main}}", main)
        .replace("{{motion}}", include_str!("motion.html"))
        .replace("{{title}}", &escaped(title))
        .replace("{{style}}", include_str!("style.css"))
        .replace("{{scripts}}", &scripts.join("\n"))
        // the data comes last, so that no placeholder is searched in it
        .replace("{{data}}", &data)
}

/// Text escaped for HTML.
fn escaped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => result.push_str("&amp;"),
            '<' => result.push_str("&lt;"),
            '>' => result.push_str("&gt;"),
            '"' => result.push_str("&quot;"),
            // no name may look like a placeholder of the page
            '{' => result.push_str("&#123;"),
            c => result.push(c),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::{modes_page, page};
    use bryant_picture::text::typeset;
    use serde_json::json;

    /// The page writes units as pictures and terminals do: what its script replaces, read from its text, is what the program replaces.
    #[test]
    fn the_page_writes_units_as_the_program_does() {
        let script = include_str!("common.js");
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
        let hostile =
            "</script><script>alert(1)</script> {{data}} \"'&<img src=x onerror=alert(1)>";
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
}
