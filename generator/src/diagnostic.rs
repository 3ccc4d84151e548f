//! Problems of a description: file, line, column, message, help.
//!
//! All problems of a description are reported, not only the first. [`Display`](std::fmt::Display) draws a problem in
//! the style of rustc, and [`Diagnostic::line`] writes it on one line (`file:line:column: message (help: …)`) for build
//! scripts and editors.

use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use std::fmt;

/// Largest number of problems that are drawn; the others are only counted.
const SHOWN: usize = 50;
/// Longest line of source that is drawn \[characters\].
const LONGEST_EXCERPT: usize = 2000;
/// Longest piece of the user's text that a message quotes \[characters\].
const LONGEST_QUOTE: usize = 60;

/// One problem, its place, and a remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Name of the file as it was given, with `/` between its parts.
    pub file: String,
    /// Line, counted from 1; 0 if the problem concerns the whole file.
    pub line: usize,
    /// Column in characters, counted from 1; 0 if the problem concerns the whole file.
    pub column: usize,
    /// Length of the faulty text within its line, in characters; at least 1.
    pub length: usize,
    /// The problem in the words of the description.
    pub message: String,
    /// A remedy.
    pub help: String,
    /// The faulty line; empty if there is none, or if it is too long to be shown.
    pub excerpt: String,
}

impl Diagnostic {
    /// A problem of a whole file, such as a file that cannot be read.
    pub fn of_file(
        file: impl Into<String>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Diagnostic {
            file: file.into(),
            line: 0,
            column: 0,
            length: 1,
            message: message.into(),
            help: help.into(),
            excerpt: String::new(),
        }
    }

    /// A problem at `line` and `column` (both from 1) of `text`.
    pub fn at(
        file: &str,
        text: &str,
        (line, column, length): (usize, usize, usize),
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        let excerpt = text.lines().nth(line.saturating_sub(1)).unwrap_or("");
        let width = excerpt.chars().count();
        Diagnostic {
            file: file.to_owned(),
            line,
            column,
            length: length.min((width + 1).saturating_sub(column.max(1))).max(1),
            message: message.into(),
            help: help.into(),
            excerpt: if width <= LONGEST_EXCERPT {
                excerpt.to_owned()
            } else {
                String::new()
            },
        }
    }

    /// The problem as one line: `file:line:column: message (help: …)`.
    pub fn line(&self) -> String {
        let place = match self.line {
            0 => self.file.clone(),
            line => format!("{}:{line}:{}", self.file, self.column),
        };
        format!("{place}: {} (help: {})", self.message, self.help)
    }

    /// The problem with its line of source, in the style of rustc.
    fn draw(&self, renderer: &Renderer) -> String {
        let title = Level::ERROR.primary_title(&self.message);
        let help = Level::HELP.message(&self.help);
        let group = if self.line == 0 {
            title.element(Origin::path(&self.file))
        } else if self.excerpt.is_empty() {
            title.element(
                Origin::path(&self.file)
                    .line(self.line)
                    .char_column(self.column),
            )
        } else {
            let byte = |column: usize| {
                self.excerpt
                    .char_indices()
                    .nth(column)
                    .map_or(self.excerpt.len(), |(at, _)| at)
            };
            let start = byte(self.column - 1);
            let end = byte(self.column - 1 + self.length);
            title.element(
                Snippet::source(&self.excerpt)
                    .line_start(self.line)
                    .path(&self.file)
                    .annotation(AnnotationKind::Primary.span(start..end)),
            )
        };
        renderer.render(&[group.element(help)])
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.draw(&Renderer::plain()))
    }
}

/// All problems found in a description and the files it includes; never empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    /// The problems in the order of the text, file by file.
    pub problems: Vec<Diagnostic>,
}

impl Diagnostics {
    /// All problems in the style of rustc, with or without colour.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let mut text: Vec<String> = self
            .problems
            .iter()
            .take(SHOWN)
            .map(|p| p.draw(&renderer))
            .collect();
        if self.problems.len() > SHOWN {
            text.push(format!(
                "… and {} more problems",
                self.problems.len() - SHOWN
            ));
        }
        text.join("\n\n")
    }

    /// Each problem as one line, for build scripts and editors.
    pub fn lines(&self) -> impl Iterator<Item = String> + '_ {
        self.problems.iter().map(Diagnostic::line)
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(problem: Diagnostic) -> Self {
        Diagnostics {
            problems: vec![problem],
        }
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

/// The user's text in quotation marks, shortened if it is long, and with control characters escaped.
pub fn quoted(text: &str) -> String {
    format!("\"{}\"", excerpt(text))
}

/// The user's text, shortened if it is long, and with control characters escaped.
pub fn excerpt(text: &str) -> String {
    let mut shown: String = text
        .chars()
        .take(LONGEST_QUOTE)
        .flat_map(|c| {
            let escape = if c.is_control() || c == '"' {
                Some(c.escape_default())
            } else {
                None
            };
            escape
                .clone()
                .into_iter()
                .flatten()
                .chain(if escape.is_some() { None } else { Some(c) })
        })
        .collect();
    if text.chars().count() > LONGEST_QUOTE {
        shown.push('…');
    }
    shown
}

/// The candidate that `word` was probably meant to be: at most a third of its letters are wrong. `None` if there is
/// none.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let longest = word.chars().count().max(3);
    if longest > LONGEST_QUOTE {
        return None;
    }
    candidates
        .into_iter()
        .map(|c| {
            (
                strsim::damerau_levenshtein(&word.to_lowercase(), &c.to_lowercase()),
                c,
            )
        })
        .filter(|&(distance, _)| distance <= longest.div_ceil(3))
        .min_by_key(|&(distance, _)| distance)
        .map(|(_, c)| c)
}

/// Help for a name that does not exist: the nearest candidate, or the list of candidates; `none` if there are no
/// candidates.
pub fn suggestion<'a>(
    word: &str,
    candidates: impl IntoIterator<Item = &'a str> + Clone,
    none: &str,
) -> String {
    if let Some(near) = nearest(word, candidates.clone()) {
        return format!("did you mean {}?", quoted(near));
    }
    let all: Vec<&str> = candidates.into_iter().collect();
    match all.len() {
        0 => none.to_owned(),
        n => {
            let shown = all.iter().take(20).map(|c| quoted(c)).collect::<Vec<_>>();
            let more = if n > 20 { ", …" } else { "" };
            format!("there is {}{more}", shown.join(", "))
        }
    }
}
