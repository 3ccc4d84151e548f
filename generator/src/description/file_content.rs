//! What a file is, by its content: for the message where a model was expected.

use super::tree::{Node, NodeKind};
use crate::diagnostic::quoted;

/// What a file is, where it is no model, and what to do with it.
pub type What = (&'static str, String);

/// Begins of files that are no text, or text of another kind.
const BEGINS: [(&[u8], &str); 16] = [
    (b"\x89PNG", "a picture (PNG)"),
    (b"\xff\xd8\xff", "a picture (JPEG)"),
    (b"GIF8", "a picture (GIF)"),
    (b"<svg", "a picture (SVG)"),
    (b"%PDF", "a PDF document"),
    (b"PK\x03\x04", "a zip archive"),
    (b"\x1f\x8b", "a compressed file (gzip)"),
    (b"PAR1", "a table in Apache Parquet"),
    (b"glTF", "an animation (glTF)"),
    (b"\x7fELF", "a program"),
    (b"\xff\xfe", "text in UTF-16"),
    (b"\xfe\xff", "text in UTF-16"),
    (b"<!DOCTYPE html", "a page of HTML"),
    (b"<!doctype html", "a page of HTML"),
    (b"<html", "a page of HTML"),
    (
        b"Data format edition number",
        "the header of a test in ISO-MME",
    ),
];

/// What `bryant human` writes, and the data of models.
const PART: &str = "a part that models include";
/// Keys that only a study has.
const OF_STUDY: [&str; 5] = ["design", "runs", "responses", "rows", "fixed"];
/// Keys that only models and what they include have.
const OF_MODEL: [&str; 9] = [
    "dimension",
    "systems",
    "forces",
    "outputs",
    "curves",
    "surfaces",
    "vehicles",
    "switches",
    "include",
];

/// What begins so, if that is known and no YAML.
pub fn of_bytes(bytes: &[u8]) -> Option<&'static str> {
    let skipped = bytes.iter().take_while(|b| b.is_ascii_whitespace()).count();
    let bytes = &bytes[skipped..];
    let found = BEGINS.iter().find(|(begin, _)| bytes.starts_with(begin));
    found.map(|(_, what)| *what)
}

/// What a text is, if it is known and no YAML of this program.
pub fn of_text(text: &str) -> Option<What> {
    let help =
        "name a model: a YAML file with `model:`, `dimension:` and `systems:`, or a URDF file";
    if let Some(what) = of_bytes(text.trim_start_matches('\u{feff}').as_bytes()) {
        return Some((what, help.to_owned()));
    }
    is_table(text).then(|| {
        let help = "name a model; `bryant compare` and `bryant criteria` read tables, and a model reads one as a curve: `{ file: TABLE.csv }`";
        ("a table (CSV)", help.to_owned())
    })
}

/// Whether the first lines are a heading and a line of numbers, separated alike.
fn is_table(text: &str) -> bool {
    let mut lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    let (Some(heading), Some(first)) = (lines.next(), lines.next()) else {
        return false;
    };
    let number = |cell: &str| cell.trim().replace(',', ".").parse::<f64>().is_ok();
    [',', ';', '\t'].iter().any(|separator| {
        let columns = heading.split(*separator).count();
        let cells: Vec<&str> = first.split(*separator).collect();
        columns > 1 && cells.len() == columns && cells.iter().all(|cell| number(cell))
    })
}

/// What a tree is that was expected to be a model, if it is something else that is known. `name` is that of its file.
pub fn instead_of_model(root: &Node, name: &str) -> Option<What> {
    let NodeKind::Map(entries) = &root.kind else {
        return None;
    };
    let has = |key: &str| root.get(key).is_some();
    let name = quoted(name);
    let name = name.trim_matches('"');
    if has("coordinates") && has("velocities") && has("time") {
        return Some((
            "a state of a run",
            format!("a run begins with it by `bryant run MODEL --start {name}`"),
        ));
    }
    if has("systems") || has("dimension") && !OF_STUDY.iter().any(|key| has(key)) {
        // a person as `bryant human` writes it, or a part of a model
        let part = has("systems") && !has("dimension") && !has("model");
        return part.then(|| {
            (
                PART,
                format!("write a model with `include: [{name}]`, or add `model: NAME` and `dimension: 2` or `3`"),
            )
        });
    }
    let of_study = OF_STUDY.iter().filter(|key| has(key)).count();
    if of_study > 0 && of_study + usize::from(has("model")) > 1 {
        let of = root.get("model").and_then(Node::text).map(quoted);
        let of = of.map_or(String::new(), |model| format!("; its model is {model}"));
        return Some(("a study", format!("`bryant sweep {name}` runs it{of}")));
    }
    let of_model = OF_MODEL.iter().any(|key| has(key));
    if entries
        .iter()
        .any(|e| ["sex", "stature", "like", "percentile"].contains(&e.key.as_str()))
        && !of_model
        && !has("model")
    {
        return Some((
            "the description of a person",
            "a model includes a person as `include: [{ human: male-50, system: man }]`; `bryant human` writes one as a file".to_owned(),
        ));
    }
    None
}

/// What a tree is that was expected to be a part that models include, if it is something else that is known.
pub fn instead_of_part(root: &Node, name: &str) -> Option<What> {
    let has = |key: &str| root.get(key).is_some();
    if has("model") && has("dimension") {
        return Some((
            "a whole model",
            "a model includes parts: remove `model`, `title`, `dimension`, `coordinates`, `run` and `criteria` there".to_owned(),
        ));
    }
    instead_of_model(root, name).filter(|(what, _)| *what != PART)
}

/// What a tree is that was expected to be a study, if it is something else that is known.
pub fn instead_of_study(root: &Node, name: &str) -> Option<What> {
    let has = |key: &str| root.get(key).is_some();
    if OF_STUDY.iter().any(|key| has(key)) {
        return None;
    }
    if has("dimension") || has("systems") {
        let name = quoted(name);
        let name = name.trim_matches('"');
        return Some((
            "a model",
            format!(
                "`bryant run {name}` runs it; a study names it as `model: {name}` and says `design:`, `runs:`, `parameters:` and `responses:`"
            ),
        ));
    }
    instead_of_model(root, name).filter(|(what, _)| *what != "a study")
}
