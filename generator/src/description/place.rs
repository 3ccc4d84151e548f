//! Places in a source, and problems reported there.

use super::tree::{Node, NodeKind, Source, Span};
use crate::diagnostic::Diagnostic;

/// A place in a source, walked down in step with the description read from it.
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// The file.
    pub source: &'a Source,
    /// The value.
    pub node: &'a Node,
    /// The key it is the value of.
    key: Option<Span>,
    /// Whether problems are with the key.
    on_key: bool,
    /// Where the keys of a [trail](At::trail) begin.
    base: &'a Node,
}

/// A step of a trail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<'a> {
    /// Into the value of a key.
    Key(&'a str),
    /// Into an entry of a list: its index.
    Item(usize),
}

/// Whether a value is `wanted` or has it inside; the trail there is added.
fn leads<'a>(from: &'a Node, wanted: &Node, trail: &mut Vec<Step<'a>>) -> bool {
    if std::ptr::eq(from, wanted) {
        return true;
    }
    let mut below = |step: Step<'a>, node: &'a Node| {
        trail.push(step);
        let found = leads(node, wanted, trail);
        if !found {
            trail.pop();
        }
        found
    };
    match &from.kind {
        NodeKind::Map(entries) => entries.iter().any(|e| below(Step::Key(&e.key), &e.value)),
        NodeKind::List(items) => items
            .iter()
            .enumerate()
            .any(|(i, item)| below(Step::Item(i), item)),
        _ => false,
    }
}

impl<'a> At<'a> {
    /// The whole of a source.
    pub fn root(source: &'a Source) -> At<'a> {
        At {
            source,
            node: &source.root,
            key: None,
            on_key: false,
            base: &source.root,
        }
    }

    /// This place, from which the keys of a [trail](At::trail) are counted.
    pub fn base(self) -> At<'a> {
        At {
            base: self.node,
            ..self
        }
    }

    /// The keys and the numbers of entries, from 1, that lead here from the [base](At::base).
    pub fn trail(self) -> Vec<Step<'a>> {
        let mut trail = Vec::new();
        leads(self.base, self.node, &mut trail);
        trail
    }

    /// The value of a key; this place itself where there is none.
    pub fn key(self, key: &str) -> At<'a> {
        if let NodeKind::Map(entries) = &self.node.kind
            && let Some(entry) = entries.iter().find(|e| e.key == key)
        {
            return At {
                source: self.source,
                node: &entry.value,
                key: Some(entry.span),
                on_key: false,
                ..self
            };
        }
        self
    }

    /// An entry of a list; this place itself where there is none.
    pub fn item(self, index: usize) -> At<'a> {
        match &self.node.kind {
            NodeKind::List(items) if index < items.len() => At {
                source: self.source,
                node: &items[index],
                key: None,
                on_key: false,
                ..self
            },
            _ => self,
        }
    }

    /// The value at a path such as `about.x.friction` or `plane.extent[1]`, or as far along it as there is one.
    pub fn path(self, path: &str) -> At<'a> {
        path.split('.').fold(self, |at, step| {
            let (key, index) = match step.split_once('[') {
                Some((key, rest)) => (key, rest.trim_end_matches(']').parse().ok()),
                None => (step, None),
            };
            let below = at.key(key);
            index.map_or(below, |index| below.item(index))
        })
    }

    /// The place of the key of this value, as a place of its own.
    pub fn on_key(self) -> At<'a> {
        At {
            on_key: true,
            ..self
        }
    }

    /// Where the key of this value stands; the value itself where it has none.
    pub fn of_key(self) -> Span {
        self.key.unwrap_or(self.node.span)
    }

    /// A problem with this value.
    pub fn problem(self, message: impl Into<String>, help: impl Into<String>) -> Diagnostic {
        let span = if self.on_key {
            self.of_key()
        } else {
            self.node.span
        };
        self.problem_at(span, message, help)
    }

    /// A problem with the key of this value.
    pub fn key_problem(self, message: impl Into<String>, help: impl Into<String>) -> Diagnostic {
        self.problem_at(self.of_key(), message, help)
    }

    /// A problem with `length` characters of this text, `offset` characters from its beginning.
    pub fn text_problem(
        self,
        offset: usize,
        length: usize,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        let mut span = self.node.span;
        if let NodeKind::Scalar { text, plain } = &self.node.kind {
            let quotes = usize::from(!plain);
            // only text that stands in the file as it is read has its characters where they are counted
            if span.length == text.chars().count() + 2 * quotes {
                span.column += quotes + offset;
                span.length = length.max(1);
            }
        }
        self.problem_at(span, message, help)
    }

    /// A problem at a place of this file.
    pub fn problem_at(
        self,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::at(
            &self.source.name,
            &self.source.text,
            (span.line, span.column, span.length),
            message,
            help,
        )
    }
}
