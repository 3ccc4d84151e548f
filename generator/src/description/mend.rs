//! What is left of a tree when that is taken out which is wrong, so that the rest can be looked at, too: one mistake
//! hides no other.
//!
//! What is taken out may be missed elsewhere. [`Lost`] knows its names and places, and tells such consequences from
//! mistakes.

use super::language::Language;
use super::place::At;
use super::shape::Problems;
use super::tree::{Entry, MAX_DEPTH, Node, NodeKind, Source, Span};
use crate::diagnostic::Diagnostic;
use std::collections::{BTreeSet, HashMap, HashSet};

/// What was taken out of the trees of a model.
#[derive(Debug, Default)]
pub struct Lost {
    /// Names of what is missing, or is not as it was meant.
    names: BTreeSet<String>,
    /// What is not as it was meant.
    regions: Vec<Region>,
}

/// A piece of a file, from a line and column to a line and column.
#[derive(Debug)]
struct Region {
    file: String,
    from: (usize, usize),
    to: (usize, usize),
}

/// What an unknown key was meant to be; without a key it means nothing.
#[derive(Clone, Debug, Default)]
pub struct Correction {
    /// The key.
    pub key: Option<String>,
    /// Its value, where that is part of the key as it is written.
    pub value: Option<String>,
}

impl Lost {
    /// Whether a problem may be there only because something was taken out.
    pub fn explains(&self, problem: &Diagnostic) -> bool {
        let place = (problem.line, problem.column);
        let inside = |region: &Region| {
            region.file == problem.file && region.from <= place && place <= region.to
        };
        // every second piece is in quotation marks
        let mut quoted = problem.message.split(['"', '`']).skip(1).step_by(2);
        // a contact of several surfaces makes names: `edge-trunk-man-pelvis`
        let is_of = |word: &str, name: &str| {
            word.strip_prefix(name)
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
        };
        let lost = |word: &str| {
            self.names
                .iter()
                .any(|name| !name.is_empty() && is_of(word, name))
        };
        self.regions.iter().any(inside)
            || quoted.any(|text| lost(text) || text.split([' ', '/', ',']).any(lost))
    }

    /// Notes that what stands where a problem is will not be as it was meant.
    pub fn add(&mut self, source: &Source, problem: &Diagnostic) {
        let place = (problem.line, problem.column);
        let mut node = &source.root;
        let mut innermost = None;
        loop {
            let contains = |node: &&Node| begin(node.span) <= place && place <= end(node);
            let inner = match &node.kind {
                NodeKind::Scalar { .. } => None,
                NodeKind::List(items) => items.iter().find(contains),
                NodeKind::Map(entries) => {
                    let found = entries.iter().find(|e| {
                        begin(e.span) <= place && place <= end(&e.value).max(begin(e.span))
                    });
                    if let Some(entry) = found {
                        self.names.insert(entry.key.clone());
                    }
                    found.map(|entry| &entry.value)
                }
            };
            let Some(inner) = inner else { break };
            if let NodeKind::Map(_) = inner.kind {
                self.names.extend(own_names(inner));
                innermost = Some(inner);
            }
            node = inner;
        }
        if let Some(record) = innermost {
            self.region(source, record);
        }
    }

    fn region(&mut self, source: &Source, node: &Node) {
        self.regions.push(Region {
            file: source.name.clone(),
            from: begin(node.span),
            to: end(node),
        });
    }
}

fn begin(span: Span) -> (usize, usize) {
    (span.line, span.column)
}

/// Where the last thing in a node ends.
fn end(node: &Node) -> (usize, usize) {
    let own = (node.span.line, node.span.column + node.span.length);
    match &node.kind {
        NodeKind::Scalar { .. } => own,
        NodeKind::List(items) => items.iter().map(end).fold(own, Ord::max),
        NodeKind::Map(entries) => entries.iter().map(|e| end(&e.value)).fold(own, Ord::max),
    }
}

/// What a record may be called: its `name`, or what its first key is (`belt: chest`).
fn own_names(record: &Node) -> Vec<String> {
    let NodeKind::Map(entries) = &record.kind else {
        return Vec::new();
    };
    let first = entries.first().map(|e| &e.value);
    let names = [record.get("name"), first].into_iter().flatten();
    let names = names.filter_map(Node::text);
    // `belt:chest` for `belt: chest`
    let joined = entries
        .iter()
        .filter_map(|e| Some(e.key.split_once(':')?.1));
    names
        .chain(joined)
        .map(|name| name.trim().to_owned())
        .collect()
}

/// The names of a node and of all below it.
fn all_names(node: &Node, names: &mut BTreeSet<String>) {
    names.extend(own_names(node));
    match &node.kind {
        NodeKind::Scalar { .. } => {}
        NodeKind::List(items) => items.iter().for_each(|item| all_names(item, names)),
        NodeKind::Map(entries) => entries.iter().for_each(|e| all_names(&e.value, names)),
    }
}

/// Takes the items of lists and mappings out of a file in which these problems are.
pub fn take_out(root: &mut Node, problems: &[Diagnostic]) {
    let is_sound = |from: Span, node: &Node| {
        let inside =
            |p: &Diagnostic| begin(from) <= (p.line, p.column) && (p.line, p.column) <= end(node);
        !problems.iter().any(inside)
    };
    let NodeKind::Map(sections) = &mut root.kind else {
        return;
    };
    for section in sections {
        match &mut section.value.kind {
            NodeKind::Scalar { .. } => {}
            NodeKind::List(items) => items.retain(|item| is_sound(item.span, item)),
            NodeKind::Map(entries) => entries.retain(|e| is_sound(e.span, &e.value)),
        }
    }
}

/// Whether the item of a list in which a problem is has one of these words, such as the name of a parameter whose value
/// is not known.
pub fn item_mentions(source: &Source, problem: &Diagnostic, words: &[String]) -> bool {
    let place = (problem.line, problem.column);
    let contains = |from: Span, node: &Node| begin(from) <= place && place <= end(node);
    let mut node = &source.root;
    let mut item = None;
    loop {
        let inner = match &node.kind {
            NodeKind::Scalar { .. } => None,
            NodeKind::List(items) => {
                let found = items.iter().find(|item| contains(item.span, item));
                item = found
                    .filter(|found| matches!(found.kind, NodeKind::Map(_)))
                    .or(item);
                found
            }
            NodeKind::Map(entries) => {
                let found = entries.iter().find(|e| contains(e.span, &e.value));
                found.map(|entry| &entry.value)
            }
        };
        match inner {
            Some(inner) => node = inner,
            None => return item.is_some_and(|item| mentions(item, words)),
        }
    }
}

/// Whether one of these words stands in a node.
fn mentions(node: &Node, words: &[String]) -> bool {
    match &node.kind {
        NodeKind::Scalar { text, .. } => {
            let mut parts = text.split(|c: char| !c.is_alphanumeric() && c != '_');
            parts.any(|part| words.iter().any(|word| word == part))
        }
        NodeKind::List(items) => items.iter().any(|item| mentions(item, words)),
        NodeKind::Map(entries) => entries.iter().any(|e| mentions(&e.value, words)),
    }
}

/// The tree of a source without what `check` reports; `None` if so little is left that nothing can be said of it.
pub fn mend(
    source: &Source,
    language: &'static Language,
    check: fn(At<'_>, &Problems),
    lost: &mut Lost,
) -> Option<Node> {
    let mut rest = Source {
        name: source.name.clone(),
        text: source.text.clone(),
        root: source.root.clone(),
    };
    // each round takes out a level of the tree at most
    for _ in 0..2 * MAX_DEPTH {
        let problems = Problems::new(language);
        check(rest.at(), &problems);
        let (wrong, corrections) = problems.into_parts();
        if wrong.is_empty() {
            // what a file includes is everywhere
            let [before, now] = [&source.root, &rest.root].map(|root| root.get("include"));
            let same = match (before, now) {
                (Some(before), Some(now)) => before.reads_as(now),
                (before, now) => before.is_none() && now.is_none(),
            };
            return same.then_some(rest.root);
        }
        let mut surgeon = Surgeon {
            wrong: wrong.iter().map(|p| (p.line, p.column, p.length)).collect(),
            corrections: corrections
                .into_iter()
                .map(|(span, c)| (begin(span), c))
                .collect(),
            source,
            lost,
            changed: false,
        };
        if surgeon.operate(&mut rest.root, 0) || !surgeon.changed {
            return None;
        }
    }
    None
}

struct Surgeon<'a> {
    /// Places of problems: line, column, length.
    wrong: HashSet<(usize, usize, usize)>,
    corrections: HashMap<(usize, usize), Correction>,
    source: &'a Source,
    lost: &'a mut Lost,
    changed: bool,
}

impl Surgeon<'_> {
    fn is_wrong(&self, span: Span) -> bool {
        self.wrong.contains(&(span.line, span.column, span.length))
    }

    /// Takes out what is wrong below a node; whether the node itself has to go.
    fn operate(&mut self, node: &mut Node, depth: usize) -> bool {
        if self.is_wrong(node.span)
            && !is_first_key(node, |span| self.corrections.contains_key(&begin(span)))
        {
            return true;
        }
        match &mut node.kind {
            NodeKind::Scalar { .. } => false,
            NodeKind::List(items) => {
                let before = items.len();
                items.retain_mut(|item| {
                    let keep = !self.operate(item, depth + 1);
                    if !keep {
                        all_names(item, &mut self.lost.names);
                    }
                    keep
                });
                self.changed |= items.len() < before;
                items.is_empty() && before > 0
            }
            NodeKind::Map(_) => self.operate_map(node, depth),
        }
    }

    fn operate_map(&mut self, node: &mut Node, depth: usize) -> bool {
        let record = node.clone();
        let NodeKind::Map(entries) = &mut node.kind else {
            return false;
        };
        let mut gives_up = false;
        let mut kept: Vec<Entry> = Vec::with_capacity(entries.len());
        for mut entry in std::mem::take(entries) {
            if let Some(correction) = self.corrections.remove(&begin(entry.span)) {
                self.changed = true;
                if self.corrected(&mut entry, correction, &record) {
                    kept.push(entry);
                } else {
                    all_names(&entry.value, &mut self.lost.names);
                    gives_up |= depth == 0 && !matches!(entry.value.kind, NodeKind::Scalar { .. });
                }
                continue;
            }
            let empty = self.is_wrong(entry.span);
            let direct = empty || self.is_wrong(entry.value.span);
            if !empty && !self.operate(&mut entry.value, depth + 1) {
                kept.push(entry);
                continue;
            }
            self.changed = true;
            all_names(&entry.value, &mut self.lost.names);
            self.lost.names.insert(entry.key.clone());
            match depth {
                // without this the rest cannot be understood
                0 => gives_up |= direct || entry.key == "systems",
                // names of the user's stand under a key of the file
                1 => {}
                _ => {
                    self.lost.names.extend(own_names(&record));
                    self.lost.region(self.source, &record);
                }
            }
        }
        *entries = kept;
        gives_up
    }

    /// Corrects an entry; false if it means nothing.
    fn corrected(&self, entry: &mut Entry, correction: Correction, record: &Node) -> bool {
        let Some(key) = correction.key.filter(|key| record.get(key).is_none()) else {
            return false;
        };
        entry.key = key;
        if let Some(text) = correction.value {
            entry.value = Node {
                span: entry.span,
                kind: NodeKind::Scalar { text, plain: true },
            };
        }
        true
    }
}

/// Whether a problem at a node is one with its first key, which begins at the same place.
fn is_first_key(node: &Node, is_corrected: impl Fn(Span) -> bool) -> bool {
    match &node.kind {
        NodeKind::Map(entries) => entries.first().is_some_and(|first| {
            begin(first.span) == begin(node.span)
                && first.span.length == node.span.length
                && is_corrected(first.span)
        }),
        _ => false,
    }
}
