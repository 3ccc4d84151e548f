//! A model with all that it includes as one file in the long form, as the program reads it.

use super::curve::has_file;
use super::load::{Loaded, beside, shown};
use super::tree::{Entry, Node, NodeKind};
use std::fmt::Write as _;
use std::path::Path;

/// Longest line that is not broken up, where it can be \[characters\].
const WIDTH: usize = 150;

/// The sections that several files may have, in the order in which they are written.
const SECTIONS: [&str; 9] = [
    "parameters",
    "inputs",
    "curves",
    "vehicles",
    "systems",
    "surfaces",
    "forces",
    "switches",
    "outputs",
];

/// The text of the model. Paths in it are relative to the folder of the model's file.
pub fn long_form(loaded: &Loaded) -> String {
    let Some(main) = loaded.files.last() else {
        return String::new();
    };
    let mut text = String::new();
    let header = |text: &mut String, last: bool| {
        for entry in main.source.root.entries() {
            if !SECTIONS.contains(&entry.key.as_str()) && (entry.key == "run") == last {
                write_entry(text, &entry.key, &entry.value, 0);
            }
        }
    };
    header(&mut text, false);
    for section in SECTIONS {
        let mut whole: Option<Node> = None;
        for file in &loaded.files {
            let Some(part) = file.source.root.get(section) else {
                continue;
            };
            let mut part = part.clone();
            relate_paths(&mut part, &file.source.name, &main.source.name);
            match (whole.as_mut().map(|node| &mut node.kind), part.kind) {
                (Some(NodeKind::List(all)), NodeKind::List(more)) => all.extend(more),
                (Some(NodeKind::Map(all)), NodeKind::Map(more)) => all.extend(more),
                (_, kind) => {
                    whole = Some(Node {
                        span: part.span,
                        kind,
                    });
                }
            }
        }
        if let Some(mut whole) = whole {
            if section == "systems" {
                join_systems(&mut whole);
            }
            write_entry(&mut text, section, &whole, 0);
        }
    }
    header(&mut text, true);
    text
}

/// Puts what a file says of a system that an included one describes where that is described: a reference in the place
/// of the one there, a start key by key.
fn join_systems(systems: &mut Node) {
    let NodeKind::List(items) = &mut systems.kind else {
        return;
    };
    let mut joined: Vec<Node> = Vec::new();
    for item in std::mem::take(items) {
        let name = item.get("name").and_then(Node::text).map(str::to_owned);
        let described = |other: &&mut Node| {
            item.get("elements").is_none()
                && other.get("name").and_then(Node::text) == name.as_deref()
        };
        match joined.iter_mut().find(described) {
            Some(described) => join(described, &item, 2),
            None => joined.push(item),
        }
    }
    *items = joined;
}

/// Puts the entries of a mapping in the place of those of another, down to a depth.
fn join(into: &mut Node, from: &Node, depth: usize) {
    for entry in from.entries() {
        let both_maps = |old: &Node| {
            matches!(
                (&old.kind, &entry.value.kind),
                (NodeKind::Map(_), NodeKind::Map(_))
            )
        };
        match into.get_mut(&entry.key) {
            // a reference is one thing: it is replaced as a whole
            Some(old) if depth > 0 && both_maps(old) && entry.key != "reference" => {
                join(old, &entry.value, depth - 1);
            }
            _ => into.set(&entry.key, entry.value.clone()),
        }
    }
}

/// Makes the paths of files that are named in `file` relative to the folder of `main`.
fn relate_paths(node: &mut Node, file: &str, main: &str) {
    let folder = Path::new(main).parent().unwrap_or(Path::new(""));
    let names_file = has_file(node);
    match &mut node.kind {
        NodeKind::Scalar { .. } => {}
        NodeKind::List(items) => {
            for item in items {
                relate_paths(item, file, main);
            }
        }
        NodeKind::Map(entries) => {
            let is_user = entries.iter().any(|e| e.key == "user");
            for Entry { key, value, .. } in entries {
                if (key == "file" || key == "mme") && names_file || key == "source" && is_user {
                    relate(value, file, folder);
                } else if key == "mesh" {
                    for mesh in items_or_itself(value) {
                        match mesh.get_mut("file") {
                            Some(path) => relate(path, file, folder),
                            None => relate(mesh, file, folder),
                        }
                    }
                } else {
                    relate_paths(value, file, main);
                }
            }
        }
    }
}

/// Makes a path relative to a folder, unless it begins with where it is looked for.
fn relate(value: &mut Node, file: &str, folder: &Path) {
    let written = value.text().unwrap_or_default();
    if !written.contains("://") {
        let path = beside(file, written);
        let path = shown(path.strip_prefix(folder).unwrap_or(&path));
        *value = value.with_text(path);
    }
}

/// The items of a list; anything else itself.
fn items_or_itself(node: &mut Node) -> Vec<&mut Node> {
    match node.kind {
        NodeKind::List(ref mut items) => items.iter_mut().collect(),
        _ => vec![node],
    }
}

fn write_entry(text: &mut String, key: &str, value: &Node, indent: usize) {
    let flow = flow(value);
    let is_section = indent == 0 && !value.items().is_empty();
    let fits = indent + key.len() + 2 + flow.chars().count() <= WIDTH && !is_section;
    let key = scalar(key, true);
    match &value.kind {
        NodeKind::Map(entries) if !entries.is_empty() && (indent == 0 || !fits) => {
            let _ = writeln!(text, "{:indent$}{key}:", "");
            for entry in entries {
                write_entry(text, &entry.key, &entry.value, indent + 2);
            }
        }
        NodeKind::List(items) if !items.is_empty() && !fits => {
            let _ = writeln!(text, "{:indent$}{key}:", "");
            for item in items {
                write_item(text, item, indent + 2);
            }
        }
        _ => {
            let _ = writeln!(text, "{:indent$}{key}: {flow}", "");
        }
    }
}

fn write_item(text: &mut String, item: &Node, indent: usize) {
    let flow = flow(item);
    let fits = indent + 2 + flow.chars().count() <= WIDTH;
    match &item.kind {
        NodeKind::Map(entries) if !entries.is_empty() && !fits => {
            let mut inner = String::new();
            for entry in entries {
                write_entry(&mut inner, &entry.key, &entry.value, indent + 2);
            }
            // the first key stands behind the dash
            let _ = write!(text, "{:indent$}- {}", "", inner.trim_start());
        }
        _ => {
            let _ = writeln!(text, "{:indent$}- {flow}", "");
        }
    }
}

/// On one line.
fn flow(node: &Node) -> String {
    match &node.kind {
        NodeKind::Scalar { text, plain } => scalar(text, *plain),
        NodeKind::List(items) => {
            let items: Vec<String> = items.iter().map(flow).collect();
            format!("[{}]", items.join(", "))
        }
        NodeKind::Map(entries) if entries.is_empty() => "{}".to_owned(),
        NodeKind::Map(entries) => {
            let entries: Vec<String> = entries
                .iter()
                .map(|e| format!("{}: {}", scalar(&e.key, true), flow(&e.value)))
                .collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

/// Text, in quotation marks where it could be read otherwise.
fn scalar(text: &str, plain: bool) -> String {
    let first = |c: char| c.is_alphanumeric() || "-+.(".contains(c);
    let harmless = text.starts_with(first)
        && !text.starts_with("- ")
        && text.trim() == text
        && !text.contains(|c: char| c.is_control() || ",[]{}:#\"'\\".contains(c));
    if plain && harmless {
        return text.to_owned();
    }
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            '\n' => quoted += "\\n",
            '\t' => quoted += "\\t",
            c if c.is_control() => {
                let _ = write!(quoted, "\\U{:08x}", u32::from(c));
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}
