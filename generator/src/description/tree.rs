//! The YAML as a tree whose every node knows its line and column.
//!
//! This tree, built by a marked parser from the text, says where values stand. Building it is
//! also where text that no model needs is turned away before it is read: nesting, size, aliases, tags, duplicate keys.

use super::place::At;
use super::slip;
use crate::diagnostic::{Diagnostic, quoted};
use saphyr_parser::{Event, Parser, ScalarStyle, ScanError, Span as Marks};
use std::collections::HashSet;

/// Largest file that is read \[bytes\].
pub const MAX_BYTES: usize = 16 << 20;
/// Deepest nesting of lists and keys.
pub const MAX_DEPTH: usize = 32;
/// Most elements of a system, and of a model.
pub const MAX_ELEMENTS: usize = 2000;
/// Most points of a curve.
pub const MAX_POINTS: usize = 10_000;
/// Most entries of any other list or mapping.
pub const MAX_ENTRIES: usize = 10_000;

/// Name and text of a file, with its tree.
#[derive(Debug)]
pub struct Source {
    /// Name as shown to the user.
    pub name: String,
    /// Text, without byte order mark, lines ended by `\n`.
    pub text: String,
    /// What the text says.
    pub root: Node,
}

/// A place in a text: line and column from 1, length in characters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// Characters, at least 1.
    pub length: usize,
}

/// A value and its place.
#[derive(Clone, Debug)]
pub struct Node {
    /// Where it begins.
    pub span: Span,
    /// What it is.
    pub kind: NodeKind,
}

/// What a node holds.
#[derive(Clone, Debug)]
pub enum NodeKind {
    /// Text or a number; `plain` where it stands without quotation marks.
    Scalar {
        /// As read, escapes resolved.
        text: String,
        /// Not quoted, hence perhaps a number, a truth value or nothing.
        plain: bool,
    },
    /// `[a, b]`
    List(Vec<Node>),
    /// `{ key: value }`, in the order of the text.
    Map(Vec<Entry>),
}

/// A key and its value.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub span: Span,
    /// Its value.
    pub value: Node,
}

impl Node {
    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Node> {
        match &self.kind {
            NodeKind::Map(entries) => entries.iter().find(|e| e.key == key).map(|e| &e.value),
            _ => None,
        }
    }

    /// Whether another node says the same, wherever it stands; 0 and −0 are one number.
    pub fn reads_as(&self, other: &Node) -> bool {
        match (&self.kind, &other.kind) {
            (NodeKind::Scalar { text: a, .. }, NodeKind::Scalar { text: b, .. }) => {
                let zero = |text: &str| text.trim_start_matches('-').parse() == Ok(0.0f64);
                a == b || zero(a) && zero(b)
            }
            (NodeKind::List(a), NodeKind::List(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.reads_as(b))
            }
            (NodeKind::Map(a), NodeKind::Map(b)) => {
                let has = |entry: &Entry| {
                    other
                        .get(&entry.key)
                        .is_some_and(|b| entry.value.reads_as(b))
                };
                a.len() == b.len() && a.iter().all(has)
            }
            _ => false,
        }
    }

    /// True for a key without a value, `~` and `null`.
    pub fn is_null(&self) -> bool {
        matches!(&self.kind, NodeKind::Scalar { text, plain: true }
            if matches!(text.as_str(), "" | "~" | "null" | "Null" | "NULL"))
    }
}

impl Source {
    /// Parses `text`; an `Err` is the first thing that keeps it from being a tree.
    pub fn parse(name: &str, text: &str) -> Result<Source, Box<Diagnostic>> {
        if text.len() > MAX_BYTES {
            return Err(Box::new(Diagnostic::of_file(
                name,
                format!("the file has {} bytes", text.len()),
                format!(
                    "at most {} MiB are read; split data sets into files",
                    MAX_BYTES >> 20
                ),
            )));
        }
        let text = text.trim_start_matches('\u{feff}');
        let text = text.replace("\r\n", "\n").replace('\r', "\n");
        let root = Builder { name, text: &text }.build()?;
        Ok(Source {
            name: name.to_owned(),
            text,
            root,
        })
    }

    /// The root and its source.
    pub fn at(&self) -> At<'_> {
        At::root(self)
    }
}

/// Builds the tree from the parser's events, without recursion.
struct Builder<'a> {
    name: &'a str,
    text: &'a str,
}

/// A list or mapping that is still open.
struct Open {
    node: Node,
    /// The key that waits for its value.
    key: Option<(String, Span)>,
    /// Keys seen.
    keys: HashSet<String>,
    /// The key this collection is the value of, for limits.
    under: String,
}

impl Builder<'_> {
    fn build(&self) -> Result<Node, Box<Diagnostic>> {
        let mut open: Vec<Open> = Vec::new();
        let mut root: Option<Node> = None;
        let mut documents = 0;
        for event in Parser::new_from_str(self.text) {
            let (event, marks) = event.map_err(|e| self.scan_problem(&e, &open))?;
            let span = self.span(&marks);
            self.check_is_in_language(&event, span)?;
            let finished = match event {
                Event::DocumentStart(_) => {
                    documents += 1;
                    if documents > 1 {
                        return Err(self.problem(
                            span,
                            "a second document begins here",
                            "a file holds one model: remove the `---`, or move what follows into a file of its own",
                        ));
                    }
                    continue;
                }
                Event::Scalar(text, style, _, _) => Node {
                    span,
                    kind: NodeKind::Scalar {
                        text: text.into_owned(),
                        plain: style == ScalarStyle::Plain,
                    },
                },
                Event::SequenceStart(..) => {
                    self.open(&mut open, NodeKind::List(Vec::new()), span)?;
                    continue;
                }
                Event::MappingStart(..) => {
                    self.open(&mut open, NodeKind::Map(Vec::new()), span)?;
                    continue;
                }
                Event::SequenceEnd | Event::MappingEnd => {
                    let Some(closed) = open.pop() else { continue };
                    closed.node
                }
                Event::Alias(_)
                | Event::Nothing
                | Event::StreamStart
                | Event::StreamEnd
                | Event::DocumentEnd => {
                    continue;
                }
            };
            match open.last_mut() {
                None => root = Some(finished),
                Some(parent) => self.add(parent, finished)?,
            }
        }
        root.ok_or_else(|| {
            Box::new(Diagnostic::of_file(
                self.name,
                "the file is empty",
                "a model begins with `model: its-name`, `dimension: 2` or `3`, and `systems:`",
            ))
        })
    }

    /// Reports aliases, anchors and tags, which YAML has and the language has not.
    fn check_is_in_language(&self, event: &Event<'_>, span: Span) -> Result<(), Box<Diagnostic>> {
        let (anchor, tag) = match event {
            Event::Alias(_) => {
                return Err(self.problem(
                    span,
                    "aliases (`*name`) are not part of the language",
                    "write the value again, or give it a name under `parameters` or `curves`",
                ));
            }
            Event::Scalar(_, _, anchor, tag)
            | Event::SequenceStart(anchor, tag)
            | Event::MappingStart(anchor, tag) => (*anchor > 0, tag.is_some()),
            _ => return Ok(()),
        };
        let (what, remedy) = match (anchor, tag) {
            (false, false) => return Ok(()),
            (true, _) => (
                "anchors (`&name`) are",
                "remove it; what is used twice gets a name under `parameters` or `curves`",
            ),
            (false, true) => (
                "tags (`!name`) are",
                "remove it, or put the text in quotation marks",
            ),
        };
        Err(self.problem(span, format!("{what} not part of the language"), remedy))
    }

    /// Begins a list or a mapping.
    fn open(
        &self,
        open: &mut Vec<Open>,
        kind: NodeKind,
        span: Span,
    ) -> Result<(), Box<Diagnostic>> {
        if open.len() == MAX_DEPTH {
            return Err(self.too_deep(span));
        }
        if let Some(parent) = open.last()
            && matches!(parent.node.kind, NodeKind::Map(_))
            && parent.key.is_none()
        {
            return Err(self.problem(
                span,
                "a key is a list or a mapping",
                "keys are words; text that begins with `{` or `[` needs quotation marks",
            ));
        }
        let under = open
            .last()
            .and_then(|o| o.key.as_ref())
            .map_or(String::new(), |(key, _)| key.clone());
        open.push(Open {
            node: Node {
                span: Span { length: 1, ..span },
                kind,
            },
            key: None,
            keys: HashSet::new(),
            under,
        });
        Ok(())
    }

    /// Puts a value in its list, or under its key; or keeps it as the key of the next value.
    fn add(&self, parent: &mut Open, value: Node) -> Result<(), Box<Diagnostic>> {
        let length = match &mut parent.node.kind {
            NodeKind::Scalar { .. } => 0,
            NodeKind::List(items) => {
                items.push(value);
                items.len()
            }
            NodeKind::Map(entries) => match (parent.key.take(), value.kind) {
                (Some((key, span)), kind) => {
                    entries.push(Entry {
                        key,
                        span,
                        value: Node {
                            span: value.span,
                            kind,
                        },
                    });
                    entries.len()
                }
                (None, NodeKind::Scalar { text, .. }) => {
                    if !parent.keys.insert(text.clone()) {
                        let first = entries.iter().find(|e| e.key == text);
                        return Err(self.problem(
                            value.span,
                            format!("the key {} is given twice", quoted(&text)),
                            format!(
                                "remove one of the two; the first is on line {}",
                                first.map_or(0, |e| e.span.line)
                            ),
                        ));
                    }
                    parent.key = Some((text, value.span));
                    entries.len()
                }
                // turned away where the collection begins
                (None, _) => entries.len(),
            },
        };
        let (limit, what) = match parent.under.as_str() {
            "elements" => (MAX_ELEMENTS, "elements"),
            "points" => (MAX_POINTS, "points"),
            _ => (MAX_ENTRIES, "entries"),
        };
        if length > limit {
            return Err(self.problem(
                parent.node.span,
                format!("more than {limit} {what}"),
                format!("at most {limit} {what} may stand here"),
            ));
        }
        Ok(())
    }

    fn span(&self, marks: &Marks) -> Span {
        Span {
            line: marks.start.line(),
            column: marks.start.col() + 1,
            length: if marks.start.line() == marks.end.line() {
                marks.len().max(1)
            } else {
                1
            },
        }
    }

    fn problem(
        &self,
        span: Span,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Box<Diagnostic> {
        Box::new(Diagnostic::at(
            self.name,
            self.text,
            (span.line, span.column, span.length),
            message,
            help,
        ))
    }

    fn too_deep(&self, span: Span) -> Box<Diagnostic> {
        self.problem(
            span,
            format!("lists and keys are nested more than {MAX_DEPTH} deep"),
            "no model needs that; look for a bracket that is not closed",
        )
    }

    /// A syntax error of YAML, in words that say what to do.
    fn scan_problem(&self, error: &ScanError, open: &[Open]) -> Box<Diagnostic> {
        let mark = error.marker();
        let span = Span {
            line: mark.line().max(1),
            column: mark.col() + 1,
            length: 1,
        };
        let info = error.info();
        if info.contains("recursion limit") {
            return self.too_deep(span);
        }
        if let Some(slip) = slip::noticed_at(self.text, span.line) {
            return self.problem(slip.span, slip.message, slip.help);
        }
        let help = if info.contains("mapping values are not allowed") {
            "text that holds `: ` needs quotation marks; two keys on one line stand in `{ a: 1, b: 2 }`"
        } else if let Some(collection) = open.last() {
            match collection.node.kind {
                NodeKind::List(_) => {
                    "look for a `]`, a comma or a quotation mark that is missing, or for lines indented differently"
                }
                _ => {
                    "look for a `}`, a comma, a colon or a quotation mark that is missing, or for lines indented differently"
                }
            }
        } else {
            "a model is written as `key: value` lines; text with special characters needs quotation marks"
        };
        self.problem(span, format!("this is not YAML: {info}"), help)
    }
}
