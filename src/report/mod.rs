//! A run, modes or a study as one page of HTML. The page of a run has the motion, the curves and the verdict, that of
//! modes the motion in each of them, that of a study distributions and rows. A page needs no other file and no network.
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

// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod curves;
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
