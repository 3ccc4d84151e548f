//! What the pages name exists: files, headings, commands, options, models, targets of cargo.

use super::run::call;
use super::{compare, output, pages, picture, root, table};
use libtest_mimic::{Failed, Trial};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

type Found = Vec<String>;

/// The tests of this module.
pub fn trials() -> Vec<Trial> {
    let one = |name: &str, test: fn() -> Found| {
        Trial::test(name, move || match test() {
            found if found.is_empty() => Ok(()),
            found => Err(Failed::from(found.join("\n"))),
        })
    };
    vec![
        one("rules of comparison", rules),
        one("links lead to files and headings", links),
        one("contents have all headings", contents),
        one("commands, options and models exist", commands),
        one("files in code exist", files),
        one("targets of cargo exist", targets),
        one("keys of laws are in the reference", keys),
    ]
}

fn rules() -> Found {
    let all = [
        compare::rules_hold,
        output::rules_hold,
        picture::rules_hold,
        table::rules_hold,
    ];
    all.iter().filter_map(|rule| rule().err()).collect()
}

/// The pages, and others whose commands are not run.
fn texts() -> Vec<(PathBuf, String)> {
    let others = [
        "ARCHITECTURE.md",
        "benches/peers/README.md",
        "tests/reference/README.md",
    ];
    let all = pages().into_iter().chain(others.map(PathBuf::from));
    all.map(|path| {
        let text = std::fs::read_to_string(root().join(&path)).unwrap();
        (path, text)
    })
    .collect()
}

/// The lines of a page with what is code in each: spans in backquotes, or the whole line of a block of commands.
fn code(text: &str) -> Vec<(usize, Vec<String>)> {
    let mut found = Vec::new();
    let mut block: Option<&str> = None;
    for (i, line) in text.lines().enumerate() {
        if let Some(fence) = line.trim_start().strip_prefix("```") {
            block = match block {
                None => Some(fence.trim()),
                Some(_) => None,
            };
        } else if block == Some("sh") {
            let command = line.split(" #").next().unwrap_or_default();
            found.push((i, vec![command.trim().to_owned()]));
        } else if block.is_none() && !line.starts_with("    ") {
            found.push((
                i,
                line.split('`')
                    .skip(1)
                    .step_by(2)
                    .map(str::to_owned)
                    .collect(),
            ));
        }
    }
    found
}

/// Lines of a text that are not code.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut inside = false;
    text.lines().enumerate().filter(move |(_, line)| {
        let fence = line.trim_start().starts_with("```");
        inside ^= fence;
        !inside && !fence
    })
}

/// Words of a page without contents, at most.
const LONG: usize = 8000;

/// The section of a page that lists its headings.
const CONTENTS: &str = "## Contents";

/// A page with contents lists all of its headings there, and a long page has contents. With `PAGES_UPDATE` they are
/// written.
fn contents() -> Found {
    let mut found = Vec::new();
    for (path, text) in texts() {
        let Some((before, behind)) = text.split_once(&format!("{CONTENTS}\n\n")) else {
            if text.split_whitespace().count() > LONG {
                found.push(format!(
                    "{}: a page of this length needs `{CONTENTS}`",
                    path.display()
                ));
            }
            continue;
        };
        let (shown, rest) = behind.split_once("\n\n").unwrap_or((behind, ""));
        let listed = listed(rest);
        if shown == listed {
            continue;
        }
        match std::env::var_os("PAGES_UPDATE") {
            Some(_) => {
                let text = format!("{before}{CONTENTS}\n\n{listed}\n\n{rest}");
                std::fs::write(root().join(&path), text).unwrap();
            }
            None => found.push(format!(
                "{}: its contents should be\n{listed}",
                path.display()
            )),
        }
    }
    found
}

/// A line for each heading of the second level, with those of the third behind it.
fn listed(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for (_, line) in prose(text) {
        let link = |title: &str| format!("[{title}](#{})", anchor(title));
        match (line.strip_prefix("## "), line.strip_prefix("### ")) {
            (Some(title), _) => lines.push(format!("- {}", link(title))),
            (_, Some(title)) => {
                if let Some(last) = lines.last_mut() {
                    let joint = if last.contains("): ") { "," } else { ":" };
                    *last += &format!("{joint} {}", link(title));
                }
            }
            _ => {}
        }
    }
    lines.join("\n")
}

/// The anchor that GitHub gives the first heading with this title.
fn anchor(title: &str) -> String {
    let title = title.to_lowercase();
    let kept = title
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The anchors that GitHub gives the headings of a page.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut found: BTreeMap<String, usize> = BTreeMap::new();
    let mut anchors = BTreeSet::new();
    for (_, line) in prose(text).filter(|(_, line)| line.starts_with('#')) {
        let anchor = anchor(line.trim_start_matches('#').trim());
        let count = found.entry(anchor.clone()).or_default();
        anchors.insert(match *count {
            0 => anchor,
            more => format!("{anchor}-{more}"),
        });
        *count += 1;
    }
    anchors
}

fn links() -> Found {
    let mut found = Found::new();
    for (path, text) in texts() {
        let folder = root().join(path.parent().unwrap_or(Path::new("")));
        for (i, line) in prose(&text) {
            for piece in line.split("](").skip(1) {
                let target = piece.split(')').next().unwrap_or_default();
                if target.contains("://") || target.starts_with("mailto:") {
                    continue;
                }
                let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
                let whole = match file {
                    "" => root().join(&path),
                    file => folder.join(file),
                };
                let place = format!("{}:{}", path.display(), i + 1);
                if !whole.exists() {
                    found.push(format!("{place}: there is no {file}"));
                } else if !anchor.is_empty() {
                    let there = std::fs::read_to_string(&whole).unwrap_or_default();
                    if !anchors(&there).contains(anchor) {
                        found.push(format!("{place}: {file} has no heading #{anchor}"));
                    }
                }
            }
        }
    }
    found
}

/// Options of other programs that pages name in code of their own.
const OF_OTHERS: [&str; 5] = [
    "--cpus-per-task",
    "--requeue",
    "--from-file",
    "--states",
    "--seed",
];

/// The options of each command, from its help and those of the commands below it, and the words of these.
fn helps() -> BTreeMap<String, BTreeSet<String>> {
    let options = |text: &str| -> BTreeSet<String> {
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '-');
        words
            .filter(|word| word.starts_with('-') && word.len() > 1)
            .map(str::to_owned)
            .collect()
    };
    // the commands that a help lists
    let names = |help: &str| -> Vec<String> {
        let lines = help.lines().skip_while(|line| *line != "Commands:").skip(1);
        let lines = lines.take_while(|line| !line.is_empty());
        let names = lines.filter_map(|line| line.strip_prefix("  ")?.split_whitespace().next());
        names.map(str::to_owned).collect()
    };
    let help = |command: &str| call(root(), &format!("bryant {command} --help")).1.out;
    let of_command = |name: String| {
        let own = help(&name);
        let below = names(&own).into_iter().filter(|of| of != "help");
        let below = below.flat_map(|of| options(&help(&format!("{name} {of}"))));
        let all = options(&own).into_iter().chain(below).collect();
        (name, all)
    };
    names(&help("")).into_iter().map(of_command).collect()
}

/// The options that a command line gives.
fn given(line: &str) -> Vec<String> {
    // what is in quotes is a value
    let mut plain = String::new();
    for (k, piece) in line.split(['\'', '"']).enumerate() {
        plain.push_str(if k % 2 == 0 { piece } else { "x" });
    }
    let words = plain
        .split_whitespace()
        .filter(|word| word.starts_with('-') && word.len() > 1);
    let words = words.map(|word| word.split('=').next().unwrap_or(word));
    words
        .filter(|word| word[1..].starts_with(|c: char| c == '-' || c.is_ascii_alphabetic()))
        .map(str::to_owned)
        .collect()
}

fn commands() -> Found {
    let helps = helps();
    let (_, listed) = call(root(), "bryant models");
    let models: BTreeSet<&str> = listed
        .out
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    let any: BTreeSet<&String> = helps.values().flatten().collect();
    let mut found = Found::new();
    if helps.len() < 10 || models.len() < 20 {
        found.push(format!(
            "read too little of the help: {helps:?}, {models:?}"
        ));
    }
    for (path, text) in texts() {
        for (i, spans) in code(&text) {
            let mut wrong =
                |what: String| found.push(format!("{}:{}: {what}", path.display(), i + 1));
            for span in spans {
                let whole = span.trim();
                if whole.starts_with("--") && whole != "--" {
                    let option = whole.split([' ', '=']).next().unwrap_or_default();
                    if !any.contains(&option.to_owned()) && !OF_OTHERS.contains(&option) {
                        wrong(format!("no command has {option}"));
                    }
                }
                for command in whole.split(['|', '&', ';']).map(str::trim) {
                    let Some(rest) = command.strip_prefix("bryant ") else {
                        continue;
                    };
                    let mut words = rest.split_whitespace();
                    let name = words.next().unwrap_or_default();
                    let Some(options) = helps.get(name) else {
                        if !name.starts_with("--") && !matches!(name, "help" | "…") {
                            wrong(format!("there is no `bryant {name}`"));
                        }
                        continue;
                    };
                    for option in given(rest)
                        .iter()
                        .filter(|option| !options.contains(*option))
                    {
                        wrong(format!("`bryant {name}` has no {option}"));
                    }
                    let model = words.next().unwrap_or_default();
                    let of_models = matches!(
                        name,
                        "run"
                            | "check"
                            | "settle"
                            | "modes"
                            | "gradient"
                            | "accuracy"
                            | "effects"
                            | "equations"
                            | "models"
                    );
                    let plain = model
                        .chars()
                        .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
                    if of_models
                        && plain
                        && !model.is_empty()
                        && !model.starts_with('-')
                        && !models.contains(model)
                    {
                        wrong(format!("there is no model {model}"));
                    }
                }
            }
        }
    }
    found
}

/// Files that pages name although they are not in the repository: results of commands, and files of a user.
const OF_USERS: [&str; 2] = ["study-results/results.parquet", "models/arm.yaml"];

/// All files of the repository, relative to its root.
fn tree() -> Vec<String> {
    let mut found = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(root().join(&folder)).unwrap().flatten() {
            let path = folder.join(entry.file_name());
            match root().join(&path).is_dir() {
                true if !matches!(path.to_str(), Some("target" | ".git")) => folders.push(path),
                true => (),
                false => found.push(format!("/{}", path.display())),
            }
        }
    }
    found
}

fn files() -> Found {
    const ENDINGS: [&str; 15] = [
        "rs", "md", "yaml", "json", "svg", "png", "py", "sh", "toml", "csv", "js", "html",
        "sbatch", "parquet", "txt",
    ];
    let tree = tree();
    let mut found = Found::new();
    for (path, text) in texts() {
        for (i, spans) in code(&text) {
            for span in spans.iter().flat_map(|span| span.split_whitespace()) {
                let plain = span
                    .chars()
                    .all(|c| c.is_ascii_alphanumeric() || "_.-/".contains(c));
                let ending = span.rsplit_once('.').map_or("", |(_, ending)| ending);
                if !plain
                    || !span.contains('/')
                    || span.starts_with(['/', '-'])
                    || !ENDINGS.contains(&ending)
                {
                    continue;
                }
                // the first folders of a path are left out where the text says in which part of the program it is
                let there = tree.iter().any(|file| file.ends_with(&format!("/{span}")));
                if !OF_USERS.contains(&span) && !there {
                    found.push(format!("{}:{}: there is no {span}", path.display(), i + 1));
                }
            }
        }
    }
    found
}

/// Each key in the column `key` of a table of a law is one that the reference describes, which a test of the generator
/// holds to be all.
fn keys() -> Found {
    let cells = |line: &str| -> Vec<String> {
        line.split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let reference = std::fs::read_to_string(root().join("docs/reference.md")).unwrap();
    let known: BTreeSet<String> = reference
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(|line| cells(line)[1].trim_matches('`').to_owned())
        .collect();
    let mut found = Found::new();
    let mut count = 0;
    for (path, text) in texts() {
        if !path.starts_with("docs/forces") {
            continue;
        }
        let mut column = None;
        for (i, line) in prose(&text) {
            if !line.starts_with('|') {
                column = None;
                continue;
            }
            let cells = cells(line);
            column = column.or_else(|| {
                cells
                    .iter()
                    .position(|cell| cell == "key" || cell == "keys")
            });
            let Some(cell) = column.and_then(|column| cells.get(column)) else {
                continue;
            };
            for span in cell.split('`').skip(1).step_by(2) {
                let words = span.split(|c: char| !c.is_ascii_lowercase() && c != '_');
                for word in words.filter(|word| word.len() > 1) {
                    count += 1;
                    if !known.contains(word) {
                        found.push(format!(
                            "{}:{}: the reference has no key {word}",
                            path.display(),
                            i + 1
                        ));
                    }
                }
            }
        }
    }
    if count < 50 {
        found.push(format!("only {count} keys were found"));
    }
    found
}

/// The manifests that pages may speak of.
fn manifests() -> Vec<(PathBuf, String)> {
    let crates = [
        "",
        "generator",
        "runtime",
        "engine",
        "study",
        "signal",
        "picture",
        "generated",
        "tests",
        "hard",
        "examples/own-crate",
    ];
    let paths = crates.map(|name| root().join(name));
    paths
        .into_iter()
        .map(|path| {
            (
                path.clone(),
                std::fs::read_to_string(path.join("Cargo.toml")).unwrap(),
            )
        })
        .collect()
}

fn targets() -> Found {
    let manifests = manifests();
    let mut found = Found::new();
    for (path, text) in texts() {
        for (i, spans) in code(&text) {
            for span in spans.iter().filter(|span| span.contains("cargo ")) {
                let words: Vec<&str> = span
                    .split_whitespace()
                    .take_while(|word| *word != "--")
                    .collect();
                let of = words
                    .windows(2)
                    .find(|pair| pair[0] == "-p")
                    .map(|pair| pair[1]);
                let named = |text: &str, name: &str| text.contains(&format!("name = \"{name}\""));
                let here: Vec<_> = match of {
                    Some(name) => manifests
                        .iter()
                        .filter(|(_, text)| named(text, name))
                        .collect(),
                    None => manifests.iter().take(1).collect(),
                };
                let place = format!("{}:{}", path.display(), i + 1);
                if here.is_empty() {
                    found.push(format!(
                        "{place}: there is no package {}",
                        of.unwrap_or_default()
                    ));
                }
                for pair in words.windows(2) {
                    let folder = match pair[0] {
                        "--example" => "examples",
                        "--bench" => "benches",
                        "--test" => "tests",
                        _ => continue,
                    };
                    let exists = |(path, text): &&&(PathBuf, String)| {
                        let folder = path.join(folder);
                        let main = folder.join(pair[1]).join("main.rs");
                        named(text, pair[1])
                            || folder.join(format!("{}.rs", pair[1])).exists()
                            || main.exists()
                    };
                    if here.iter().find(exists).is_none() {
                        found.push(format!("{place}: there is no {} {}", pair[0], pair[1]));
                    }
                }
            }
        }
    }
    found
}
