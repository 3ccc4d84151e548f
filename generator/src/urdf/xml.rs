//! The XML of a URDF file, with the place of everything in the text as it was given.
//!
//! The readers of ROS know no namespaces and are lenient with blanks and comments. So three things that are no XML are
//! mended before it is parsed: blanks before the beginning are left out, prefixes that are not declared are declared,
//! and `--` in comments is overwritten.

use super::kind::{self, Head};
use super::robot::TextPlace;
use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use roxmltree::{Document, Error, Node};
use std::borrow::Cow;
use std::collections::BTreeSet;

/// A text that is XML after mending, and where its bytes stand in the text as given.
pub struct Xml<'a> {
    file: &'a str,
    given: &'a str,
    /// The mended text.
    pub text: Cow<'a, str>,
    /// Bytes left out at the beginning.
    skipped: usize,
    /// Where bytes were added to the mended text, and how many.
    added: (usize, usize),
    /// Where the lines of the given text begin \[bytes\].
    lines: Vec<usize>,
}

/// Prefixes that are declared for a file at most.
const MOST_PREFIXES: usize = 100;

impl<'a> Xml<'a> {
    /// Mends a text until it is XML.
    ///
    /// # Errors
    /// What the text is instead, or what is wrong with it, with the remedy.
    pub fn of(file: &'a str, given: &'a str) -> Result<Self, Diagnostics> {
        let skipped = kind::before(given);
        let newlines = given.bytes().enumerate().filter(|(_, b)| *b == b'\n');
        let mut xml = Xml {
            file,
            given,
            text: Cow::Borrowed(&given[skipped..]),
            skipped,
            added: (0, 0),
            lines: [0]
                .into_iter()
                .chain(newlines.map(|(at, _)| at + 1))
                .collect(),
        };
        let head = kind::head(&xml.text);
        xml.check_kind(&head)?;
        let mut prefixes = BTreeSet::new();
        let mut masked = false;
        loop {
            let error = match Document::parse(&xml.text) {
                Ok(_) => return Ok(xml),
                Err(error) => error,
            };
            match (&error, &head.root) {
                (Error::UnknownNamespace(prefix, _), Some(root))
                    if prefix != "xacro" && prefixes.len() < MOST_PREFIXES =>
                {
                    let new = prefixes.insert(prefix.clone());
                    debug_assert!(new, "a prefix is declared once");
                    let declaration = format!(" xmlns:{prefix}=\"{prefix}\"");
                    xml.text.to_mut().insert_str(root.end, &declaration);
                    xml.added = (root.end, xml.added.1 + declaration.len());
                }
                (Error::InvalidComment(_), _) if !masked => {
                    masked = true;
                    xml.text = Cow::Owned(without_comments(&xml.text));
                }
                _ => return Err(xml.wrong(&error, &head)),
            }
        }
    }

    /// Refuses files of other formats.
    fn check_kind(&self, head: &Head) -> Result<(), Diagnostics> {
        let root = head.root.clone().map_or("", |root| &self.text[root]);
        let doctype = head.doctype.clone();
        let of_html = doctype
            .clone()
            .is_some_and(|at| self.text[at].to_lowercase().starts_with("<!doctype html"));
        if let Some((name, help)) = kind::other_format(if of_html { "html" } else { root }) {
            let place = self.place_at(head.root.clone().map_or(0, |root| root.start), root.len());
            return Err(self.problem(place, format!("this is {name}"), help));
        }
        if !self.text.starts_with('<') {
            let first = self.text.lines().next().unwrap_or_default();
            let message = match first {
                "" => "the file is empty".to_owned(),
                first => format!(
                    "a URDF file is XML and begins with <robot>, this one with {}",
                    quoted(first)
                ),
            };
            let help = "give the URDF file of a robot; the name of a model in YAML ends in .yaml";
            return Err(self.problem(self.place_at(0, 1), message, help));
        }
        if let Some(at) = doctype {
            return Err(self.problem(
                self.place_at(at.start, at.len()),
                "a declaration of the type of document (DOCTYPE) is not read",
                "remove `<!DOCTYPE …>`: URDF has none",
            ));
        }
        Ok(())
    }

    fn problem(
        &self,
        place: TextPlace,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Diagnostics {
        Diagnostic::at(self.file, self.given, place, message, help).into()
    }

    /// What is wrong with a text that is no XML.
    fn wrong(&self, error: &Error, head: &Head) -> Diagnostics {
        let position = error.pos();
        let line_start = self
            .text
            .split_inclusive('\n')
            .take((position.row as usize).saturating_sub(1));
        let start: usize = line_start.map(str::len).sum();
        let rest = self.text[start..]
            .chars()
            .take((position.col as usize).saturating_sub(1));
        let at = start + rest.map(char::len_utf8).sum::<usize>();
        let mut place = self.place_at(at, 1);
        const END: &str = "the text ends before </robot>: give the whole file";
        let (message, help) = match error {
            Error::UnknownNamespace(prefix, _) => (
                format!("the prefix {prefix:?} is that of macros, which are not expanded"),
                XACRO.to_owned(),
            ),
            Error::NoRootNode => (
                "the file has no element".to_owned(),
                "give the URDF file of a robot".to_owned(),
            ),
            Error::UnclosedRootNode | Error::UnexpectedEndOfStream => {
                let last = self.lines.len().saturating_sub(1).max(1);
                place = (last, 1, 1);
                ("the file is not whole".to_owned(), END.to_owned())
            }
            Error::UnexpectedCloseTag(expected, found, _) => (
                format!("this is no XML: </{found}> stands where </{expected}> should"),
                format!("close <{expected}> before, by `</{expected}>` or by `/>` at its end"),
            ),
            Error::DuplicatedAttribute(name, _) => (
                format!("the attribute {name:?} stands twice in one element"),
                "remove one of them".to_owned(),
            ),
            Error::UnexpectedDeclaration(_) if head.declaration.is_some() => (
                "nothing may stand before `<?xml …?>`".to_owned(),
                "move it to the beginning of the file, or remove it".to_owned(),
            ),
            Error::MalformedEntityReference(_) | Error::UnknownEntityReference(..) => (
                "this is no XML: `&` begins the name of a character".to_owned(),
                "write `&amp;` for & itself".to_owned(),
            ),
            Error::InvalidAttributeValue(_)
            | Error::InvalidChar(_, b'<', _)
            | Error::InvalidChar2(_, b'<', _) => (
                "this is no XML: `<` begins an element here, in the middle of another".to_owned(),
                "write `&lt;` for < itself, or close the quotation marks and the element before it"
                    .to_owned(),
            ),
            other => {
                // its own place is one of the mended text
                let text = other.to_string();
                let text = text
                    .rsplit_once(" at ")
                    .map_or(text.as_str(), |(text, _)| text);
                (
                    format!("this is no XML: {text}"),
                    "mend the text here".to_owned(),
                )
            }
        };
        self.problem(place, message, help)
    }

    /// The place of a byte of the mended text.
    fn place_at(&self, at: usize, length: usize) -> TextPlace {
        let (from, added) = self.added;
        let at = match at < from {
            true => at,
            false => at.saturating_sub(added).max(from),
        };
        let at = (self.skipped + at).min(self.given.len());
        let line = self.lines.partition_point(|&start| start <= at);
        let start = self.lines[line.saturating_sub(1)];
        let before = self.given.get(start..at).unwrap_or_default();
        let column = before.chars().count() + 1;
        (line, column, length.max(1))
    }

    /// The place where an element begins.
    pub fn place(&self, node: Node<'_, '_>) -> TextPlace {
        self.place_at(node.range().start, self.tag(node).len() + 1)
    }

    /// The place of the value of an attribute, or of the element where it has none.
    pub fn place_of(&self, node: Node<'_, '_>, attribute: &str) -> TextPlace {
        match node.attribute_node(attribute) {
            None => self.place(node),
            Some(found) => {
                let range = found.range_value();
                self.place_at(range.start, self.text[range].chars().count())
            }
        }
    }

    /// The place of a text.
    pub fn place_of_text(&self, node: Node<'_, '_>) -> TextPlace {
        let text = &self.text[node.range()];
        let blank = text.len() - text.trim_start().len();
        self.place_at(node.range().start + blank, text.trim().chars().count())
    }

    /// The place of the name of an attribute.
    pub fn place_of_name(&self, attribute: &roxmltree::Attribute<'_, '_>) -> TextPlace {
        let start = attribute.range().start;
        self.place_at(start, self.name(attribute).chars().count())
    }

    /// The name of an element as it is written, with its prefix.
    pub fn tag(&self, node: Node<'_, '_>) -> &str {
        let rest = &self.text[node.range().start + 1..];
        word(rest)
    }

    /// The name of an attribute as it is written, with its prefix.
    pub fn name(&self, attribute: &roxmltree::Attribute<'_, '_>) -> &str {
        word(&self.text[attribute.range()])
    }

    /// The elements in an element that have this name.
    pub fn children<'n, 't: 'n>(
        &'n self,
        node: Node<'t, 't>,
        tag: &'n str,
    ) -> impl Iterator<Item = Node<'t, 't>> + 'n {
        node.children()
            .filter(move |n| n.is_element() && self.tag(*n) == tag)
    }

    /// The first element in an element that has this name.
    pub fn child<'t>(&self, node: Node<'t, 't>, tag: &str) -> Option<Node<'t, 't>> {
        node.children()
            .find(|n| n.is_element() && self.tag(*n) == tag)
    }
}

/// What to do with macros.
pub const XACRO: &str = "expand the file first: `xacro robot.urdf.xacro > robot.urdf`";

/// A name at the beginning of a text.
fn word(text: &str) -> &str {
    let end = text.find(|c: char| c.is_whitespace() || matches!(c, '/' | '>' | '='));
    &text[..end.unwrap_or(text.len())]
}

/// The text with blanks in its comments; line ends stay where they are.
fn without_comments(text: &str) -> String {
    let mut masked = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(open) = rest.find("<!--") {
        let (before, comment) = rest.split_at(open + 4);
        masked.push_str(before);
        let Some(close) = comment.find("-->") else {
            masked.push_str(comment);
            return masked;
        };
        for c in comment[..close].chars() {
            match c {
                '\n' | '\r' => masked.push(c),
                _ => masked.extend(std::iter::repeat_n(' ', c.len_utf8())),
            }
        }
        masked.push_str("-->");
        rest = &comment[close + 3..];
    }
    masked.push_str(rest);
    masked
}
