//! The table of docs/functions.md is that of the generator; PAGES_UPDATE=1 renews it.

use bryant_generator::dynamics::functions::{FUNCTIONS, requests};
use bryant_generator::dynamics::{Options, derive_functions};
use std::fmt::Write as _;
use std::path::Path;

const HEAD: &str = "| function | takes | size | is |\n";

#[test]
fn the_page_has_all_functions() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = root.join("models/functions/machine.yaml");
    let (model, _) = bryant_generator::read(&file).expect("a model");
    let mut table = format!("{HEAD}|---|---|---|---|\n");
    for function in FUNCTIONS {
        let (asked, shown) = match function.is_of_frame() {
            true => (
                format!("{}(tip)", function.name),
                format!("{}(frame)", function.name),
            ),
            false => (function.name.to_owned(), function.name.to_owned()),
        };
        let requests = requests(&model, "machine.yaml", [&asked[..]]).expect("it exists");
        let equations = derive_functions(&model, Options::default(), &requests);
        let derived = &equations.functions[0];
        let n = equations.velocities.len();
        let elements: usize = model.systems.iter().map(|s| s.elements.len()).sum();
        let side = |names: &[String]| match names.len() {
            length if length == n => "n".to_owned(),
            length if length == 10 * elements => "10 N".to_owned(),
            length if length == 2 * n => "2 n".to_owned(),
            length if length == 3 * n + 1 => "(3 n + 1)".to_owned(),
            length => length.to_string(),
        };
        let rows = match function.name {
            "contacts" => "k".to_owned(),
            _ => side(&derived.rows),
        };
        let columns = side(&derived.columns);
        let size = match (&rows[..], &columns[..]) {
            (rows, "1") => rows.to_owned(),
            (rows, columns) => format!("{rows} × {columns}"),
        };
        let takes: Vec<&str> = derived.arguments.iter().map(|a| a.name()).collect();
        let sentence = function.sentence;
        let takes = takes.join(", ");
        writeln!(table, "| `{shown}` | {takes} | {size} | {sentence} |").expect("text");
    }
    let page = root.join("../docs/functions.md");
    let text = std::fs::read_to_string(&page).expect("a page");
    let begin = text.find(HEAD).expect("a table");
    let end = begin + text[begin..].find("\n\n").expect("an end") + 1;
    let is = &text[begin..end];
    if is != table && std::env::var_os("PAGES_UPDATE").is_some() {
        let (before, after) = (&text[..begin], &text[end..]);
        std::fs::write(&page, format!("{before}{table}{after}")).expect("written");
        return;
    }
    assert_eq!(is, table, "PAGES_UPDATE=1 renews the table");
}
