//! A file that is read with another name for its system, so that a model has several of them.
//!
//! What the file says of that system is said of the one with the new name: elements, start, the forces, switches,
//! surfaces and outputs that mention it, directly or by each other. Their names begin with that of the system
//! (`sister-chin`, `sister head`). What does not mention the system is common to all instances, and counts once.

use super::{Known, Node};
use crate::description::language::Language;
use crate::description::place::At;
use crate::description::shape::Problems;
use crate::description::tree::NodeKind;
use std::collections::HashSet;

/// The sections whose items may mention the system.
const SECTIONS: [&str; 4] = ["surfaces", "switches", "forces", "outputs"];

/// The sections that are common.
const COMMON: [&str; 4] = ["parameters", "inputs", "curves", "vehicles"];

/// What a text refers to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reference {
    /// A system or element, `man` or `man/head`.
    Body,
    /// What an output looks at: `man/head`, `joint man/head`, `contact chin`.
    Of,
    /// A switch.
    Switch,
    /// An output, by its heading.
    Output,
}

/// How names change.
pub struct Renaming {
    language: &'static Language,
    from: String,
    to: String,
    /// The names that get a prefix, behind their kind: `contact chin`, `switch fire`, `surface head`, `output head
    /// force`.
    names: HashSet<String>,
}

/// Renames the system of a file whose short forms are written out; `None`, and reported at `at`, where the file does
/// not describe exactly one.
///
/// `system`: its new name; without one it stays. `again`: the file was read before, so that what is common is left out.
pub fn rename(
    root: &mut Node,
    system: Option<&str>,
    again: bool,
    at: At<'_>,
    problems: &Problems,
) -> Option<Renaming> {
    let described: Vec<&str> = root
        .get("systems")
        .map_or(&[][..], Node::items)
        .iter()
        .filter(|system| system.get("elements").is_some())
        .filter_map(|system| system.word("name"))
        .collect();
    let [from] = described[..] else {
        problems.add(at.problem(
            format!("this file describes {} systems, not one", described.len()),
            "only a file with the elements of one system can be included under another name",
        ));
        return None;
    };
    let mut renaming = Renaming {
        language: problems.language,
        from: from.to_owned(),
        to: system.unwrap_or(from).to_owned(),
        names: HashSet::new(),
    };
    renaming.collect(root);
    renaming.apply(root, again);
    if again {
        for section in COMMON {
            root.remove(section);
        }
    }
    Some(renaming)
}

impl Renaming {
    /// Finds the names that change: of what mentions the system, directly or by such a name.
    fn collect(&mut self, root: &mut Node) {
        loop {
            let before = self.names.len();
            for section in SECTIONS {
                for (name, item) in items(root, section, self.language) {
                    if self.mentions(item)
                        && let Some(name) = name
                    {
                        self.names.insert(name);
                    }
                }
            }
            if self.names.len() == before {
                break;
            }
        }
    }

    /// Whether an item mentions the system.
    fn mentions(&self, item: &mut Node) -> bool {
        let mut found = !self.words_of_formula(item).is_empty();
        references(item, &mut |kind, text| {
            found |= self.renamed(kind, text).is_some();
        });
        found
    }

    /// The words of a formula that are names of outputs that change.
    fn words_of_formula(&self, item: &Node) -> Vec<String> {
        let formula = item.word("formula").unwrap_or_default();
        let words = formula.split(|c: char| !c.is_alphanumeric() && c != '_');
        let with = |word: &str| {
            item.get("with")
                .is_some_and(|with| with.get(word).is_some())
        };
        let changes = |word: &&str| self.names.contains(&format!("output {word}")) && !with(word);
        let mut words: Vec<String> = words.filter(changes).map(str::to_owned).collect();
        words.sort();
        words.dedup();
        words
    }

    /// Changes the names; leaves out what is common if that was read before.
    fn apply(&self, root: &mut Node, again: bool) {
        for section in SECTIONS {
            let Some(list) = root.get_mut(section) else {
                continue;
            };
            match &mut list.kind {
                NodeKind::List(all) => {
                    all.retain_mut(|item| self.apply_to(item, section) || !again)
                }
                NodeKind::Map(all) => all.retain_mut(|entry| {
                    let mentions = self.mentions(&mut entry.value);
                    self.apply_to(&mut entry.value, section);
                    if mentions {
                        entry.key = self.prefixed(&entry.key);
                    }
                    mentions || !again
                }),
                NodeKind::Scalar { .. } => {}
            }
        }
        let Some(NodeKind::List(systems)) = root.get_mut("systems").map(|s| &mut s.kind) else {
            return;
        };
        for system in systems {
            if system.word("name") == Some(&self.from) {
                system.change("name", |n| n.with_text(&*self.to));
            }
        }
    }

    /// Changes the names in an item; whether it mentions the system.
    fn apply_to(&self, item: &mut Node, section: &str) -> bool {
        if !self.mentions(item) {
            return false;
        }
        references(item, &mut |kind, text| {
            if let Some(renamed) = self.renamed(kind, text) {
                *text = renamed;
            }
        });
        match (section, self.language.kind_and_name(item)) {
            ("forces", Some((kind, name))) if kind != "joint" => {
                let name = name.to_owned();
                item.change(kind, |n| n.with_text(self.prefixed(&name)));
                if kind == "user" && self.from != self.to && item.get("function").is_none() {
                    // the function is called as the force was
                    let function = Node::plain(name.replace('-', "_"), item.span);
                    item.set("function", function);
                }
            }
            ("switches", _) => item.change("switch", |n| {
                n.with_text(self.prefixed(n.text().unwrap_or_default()))
            }),
            ("outputs", _) if self.from != self.to => {
                for word in self.words_of_formula(item) {
                    self.stands_for(item, &word);
                }
                item.change("name", |n| {
                    n.with_text(self.heading(n.text().unwrap_or_default()))
                });
            }
            _ => {}
        }
        true
    }

    /// Lets a word of a formula stand for the output that was called so.
    fn stands_for(&self, formula: &mut Node, word: &str) {
        let renamed = Node::plain(self.heading(word), formula.span);
        if formula.get("with").is_none() {
            let with = Node {
                span: formula.span,
                kind: NodeKind::Map(Vec::new()),
            };
            formula.set("with", with);
        }
        if let Some(with) = formula.get_mut("with") {
            with.set(word, renamed);
        }
    }

    /// The heading of an output under the new name.
    fn heading(&self, name: &str) -> String {
        match self.from == self.to {
            true => name.to_owned(),
            false => format!("{} {name}", self.to),
        }
    }

    fn prefixed(&self, name: &str) -> String {
        match self.from == self.to {
            true => name.to_owned(),
            false => format!("{}-{name}", self.to),
        }
    }

    /// What a reference becomes; `None` where it does not concern the system.
    fn renamed(&self, kind: Reference, text: &str) -> Option<String> {
        let body = |path: &str| {
            let rest = path.strip_prefix(&*self.from)?;
            (rest.is_empty() || rest.starts_with('/')).then(|| format!("{}{rest}", self.to))
        };
        match kind {
            Reference::Body => body(text),
            Reference::Output => {
                let known = self.names.contains(&format!("output {text}"));
                known.then(|| self.heading(text))
            }
            Reference::Switch => {
                let known = self.names.contains(&format!("switch {text}"));
                known.then(|| self.prefixed(text))
            }
            Reference::Of => match text.split_once(' ') {
                None => body(text),
                Some((kind @ ("joint" | "system"), path)) => {
                    body(path).map(|path| format!("{kind} {path}"))
                }
                Some((kind, path)) => {
                    let name = path.split('/').next().unwrap_or_default();
                    let known = self.names.contains(&format!("{kind} {name}"));
                    known.then(|| format!("{kind} {}", self.prefixed(path)))
                }
            },
        }
    }
}

/// The items of a section, each with its kind and name where it has one.
fn items<'n>(
    root: &'n mut Node,
    section: &str,
    language: &Language,
) -> Vec<(Option<String>, &'n mut Node)> {
    match root.get_mut(section).map(|list| &mut list.kind) {
        Some(NodeKind::List(all)) => all
            .iter_mut()
            .map(|item| {
                let name = match section {
                    "switches" => item.word("switch").map(|name| format!("switch {name}")),
                    "outputs" => item.word("name").map(|name| format!("output {name}")),
                    _ => language
                        .kind_and_name(item)
                        .map(|(kind, name)| format!("{kind} {name}")),
                };
                (name, item)
            })
            .collect(),
        Some(NodeKind::Map(all)) => all
            .iter_mut()
            .map(|entry| (Some(format!("surface {}", entry.key)), &mut entry.value))
            .collect(),
        _ => Vec::new(),
    }
}

/// Visits the texts in an item that refer to bodies, switches and what outputs look at.
fn references(item: &mut Node, visit: &mut dyn FnMut(Reference, &mut String)) {
    let is_output = item.get("what").is_some();
    let is_formula = item.get("formula").is_some();
    match &mut item.kind {
        NodeKind::Scalar { .. } => {}
        NodeKind::List(all) => all.iter_mut().for_each(|one| references(one, visit)),
        NodeKind::Map(entries) => {
            for entry in entries {
                let value = &mut entry.value;
                let is_text = matches!(value.kind, NodeKind::Scalar { .. });
                match entry.key.as_str() {
                    "on" | "joint" | "relative_to" => texts(value, Reference::Body, visit),
                    "with" if is_formula => texts(value, Reference::Output, visit),
                    "axes" if is_output => texts(value, Reference::Body, visit),
                    "bodies" | "joints" => texts(value, Reference::Body, visit),
                    "of" => texts(value, Reference::Of, visit),
                    "since" | "until" | "by" | "fire" => texts(value, Reference::Switch, visit),
                    "lock" if is_text => texts(value, Reference::Switch, visit),
                    _ => references(value, visit),
                }
            }
        }
    }
}

/// Visits a text, or those of a list or mapping.
fn texts(value: &mut Node, kind: Reference, visit: &mut dyn FnMut(Reference, &mut String)) {
    match &mut value.kind {
        NodeKind::Scalar { text, .. } => visit(kind, text),
        NodeKind::List(all) => all.iter_mut().for_each(|one| texts(one, kind, visit)),
        NodeKind::Map(entries) => {
            for entry in entries {
                texts(&mut entry.value, kind, visit);
            }
        }
    }
}

impl Known {
    /// Without the surfaces and groups of a file.
    pub fn without(&self, file: &str) -> Known {
        let mut known = self.clone();
        known.surfaces.forget(file);
        known
    }

    /// Adds what a file declared, `of_file` being known behind it, under the names that `root` has now.
    pub fn add_renamed(&mut self, of_file: Known, root: &Node, file: &str, renaming: &Renaming) {
        let renamed = |text: &str| renaming.renamed(Reference::Of, text);
        for (name, image) in of_file.images {
            if let (Some(name), Some(image)) = (renamed(&name), renamed(&image)) {
                self.images.insert(name, image);
            }
        }
        let jointed = of_file.jointed.iter().filter_map(|path| renamed(path));
        self.jointed.extend(jointed);
        self.curves.extend(of_file.curves);
        let surface = |name: &str| {
            let full = renamed(&format!("surface {name}"));
            full.map_or_else(
                || name.to_owned(),
                |full| full["surface ".len()..].to_owned(),
            )
        };
        self.surfaces.add(
            root.get("surfaces").map_or(&[][..], Node::entries),
            of_file.surfaces.groups_of(file).map(|(name, members)| {
                (
                    renaming.prefixed(name),
                    members.iter().map(|m| surface(m)).collect(),
                )
            }),
            file,
        );
    }
}
