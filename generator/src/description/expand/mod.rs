//! Short forms to long ones: a located tree in, a located tree out, before anything is read from it.
//!
//! ```text
//! tree ─instance→ under another name ─expand→ lists → mirror images → surfaces by name ─read→ Included
//! ```
//!
//! What is written out stands in the tree as if the user had written it, with the places of what it comes from. So
//! nothing behind this pass knows of short forms, and the long form gives the same generated source.

mod axes;
pub mod instance;
mod list;
mod mirror;
mod surface;

use super::place::At;
use super::shape::Problems;
pub(crate) use super::tree::Node;
use super::tree::{Entry, MAX_ENTRIES, NodeKind, Source, Span};
use mirror::Words;
use std::collections::{HashMap, HashSet};
use surface::Surfaces;

/// What short forms refer to, of all files read so far.
#[derive(Clone, Debug, Default)]
pub struct Known {
    surfaces: Surfaces,
    /// Named curves as written.
    curves: HashMap<String, Node>,
    /// Mirror images: of elements by path, of the others by kind and name, such as `contact knee-left`.
    images: HashMap<String, String>,
    /// Elements by path whose joint has coordinates of its own.
    jointed: HashSet<String>,
}

/// One file while its short forms are written out.
pub struct Expander<'a> {
    source: &'a Source,
    problems: &'a Problems,
    known: &'a mut Known,
    planar: bool,
    words: Words,
}

/// The tree of a file with its short forms written out. The file was found to have the shape of a model or an included
/// file; what cannot be written out is reported.
pub fn expand(source: &Source, planar: bool, known: &mut Known, problems: &Problems) -> Node {
    let mut root = source.root.clone();
    let words = Words::of(root.get("mirror"));
    root.remove("include");
    root.remove("mirror");
    let mut file = Expander {
        source,
        problems,
        known,
        planar,
        words,
    };
    file.curves(&root);
    if let Some(systems) = root.get_mut("systems") {
        file.mirror_systems(systems);
    }
    file.surfaces(&mut root);
    if let Some(forces) = root.get_mut("forces") {
        file.expand_list(forces, "forces", |file, force| file.forces(force));
    }
    if let Some(outputs) = root.get_mut("outputs") {
        file.expand_list(outputs, "outputs", |file, output| file.outputs(output));
    }
    root
}

impl Expander<'_> {
    /// Every item of a list replaced by those that it stands for.
    fn expand_list(
        &mut self,
        list: &mut Node,
        what: &str,
        items_of: impl Fn(&mut Self, Node) -> Vec<Node>,
    ) {
        let place = list.span;
        let NodeKind::List(items) = &mut list.kind else {
            return;
        };
        let mut expanded = Vec::with_capacity(items.len());
        for item in std::mem::take(items) {
            expanded.extend(items_of(self, item));
            if expanded.len() > MAX_ENTRIES {
                self.problem(
                    place,
                    format!("written out, these are more than {MAX_ENTRIES} {what}"),
                    "shorten the lists of surfaces",
                );
                break;
            }
        }
        *items = expanded;
    }

    fn forces(&mut self, force: Node) -> Vec<Node> {
        let mut all = Vec::new();
        for mut one in self.each_force(force) {
            match self.mirrored_force(&mut one) {
                Some(image) => all.extend([one, image]),
                None => all.push(one),
            }
        }
        for force in &mut all {
            self.place_surfaces(force);
        }
        all
    }

    fn outputs(&mut self, output: Node) -> Vec<Node> {
        let mut all = Vec::new();
        for mut one in self.each_output(output) {
            match self.mirrored_output(&mut one) {
                Some(image) => all.extend([one, image]),
                None => all.push(one),
            }
        }
        all
    }

    fn curves(&mut self, root: &Node) {
        for entry in root.get("curves").into_iter().flat_map(Node::entries) {
            self.known
                .curves
                .insert(entry.key.clone(), entry.value.clone());
        }
    }

    fn problem(&self, span: Span, message: impl Into<String>, help: impl Into<String>) {
        self.problems
            .add(At::root(self.source).problem_at(span, message, help));
    }
}

impl Node {
    /// Text that stands without quotation marks.
    fn plain(text: impl Into<String>, span: Span) -> Node {
        Node {
            span,
            kind: NodeKind::Scalar {
                text: text.into(),
                plain: true,
            },
        }
    }

    /// The same text in place of this one's.
    pub fn with_text(&self, text: impl Into<String>) -> Node {
        Node {
            span: self.span,
            kind: NodeKind::Scalar {
                text: text.into(),
                plain: !matches!(self.kind, NodeKind::Scalar { plain: false, .. }),
            },
        }
    }

    /// The text of a scalar.
    pub fn text(&self) -> Option<&str> {
        match &self.kind {
            NodeKind::Scalar { text, .. } => Some(text),
            _ => None,
        }
    }

    /// The items of a list; none of anything else.
    pub fn items(&self) -> &[Node] {
        match &self.kind {
            NodeKind::List(items) => items,
            _ => &[],
        }
    }

    /// The entries of a mapping; none of anything else.
    pub fn entries(&self) -> &[Entry] {
        match &self.kind {
            NodeKind::Map(entries) => entries,
            _ => &[],
        }
    }

    /// The text of a key.
    pub(crate) fn word(&self, key: &str) -> Option<&str> {
        self.get(key).and_then(Node::text)
    }

    /// The value of a key, to be changed.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        match &mut self.kind {
            NodeKind::Map(entries) => entries
                .iter_mut()
                .find(|e| e.key == key)
                .map(|e| &mut e.value),
            _ => None,
        }
    }

    /// Changes the value of a key, where there is one.
    pub(crate) fn change(&mut self, key: &str, change: impl FnOnce(&Node) -> Node) {
        if let Some(value) = self.get_mut(key) {
            *value = change(value);
        }
    }

    /// Takes a key out.
    fn remove(&mut self, key: &str) -> Option<Node> {
        let NodeKind::Map(entries) = &mut self.kind else {
            return None;
        };
        let index = entries.iter().position(|e| e.key == key)?;
        Some(entries.remove(index).value)
    }

    /// Gives a key a value, in the place of its former one.
    pub fn set(&mut self, key: &str, value: Node) {
        if let Some(old) = self.get_mut(key) {
            *old = value;
        } else if let NodeKind::Map(entries) = &mut self.kind {
            entries.push(Entry {
                key: key.to_owned(),
                span: value.span,
                value,
            });
        }
    }

    /// Takes out a key that is true or false, and says whether it was true.
    fn take_flag(&mut self, key: &str) -> bool {
        self.remove(key)
            .is_some_and(|node| node.text().is_some_and(|t| t.eq_ignore_ascii_case("true")))
    }
}
