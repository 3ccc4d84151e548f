//! The compiler's messages about text of the user, shown at the lines of the user's file.
//!
//! The text of a user force is copied unchanged into the generated module. So a line of the module is a line of the
//! file, shifted by a constant number of lines.

use super::Text;
use bryant_generator::diagnostic::{Diagnostic, Diagnostics};
use serde_json::Value;

/// The messages of the compiler. A line of output that is not a message counts as one.
pub struct Messages {
    messages: Vec<Value>,
    /// The messages for people.
    pub text: String,
}

impl Messages {
    /// Reads the lines of `--error-format=json`.
    pub fn parse(output: &str) -> Self {
        let (mut messages, mut text) = (Vec::new(), String::new());
        for line in output.lines() {
            match serde_json::from_str::<Value>(line) {
                Ok(message) if message["message"].is_string() => {
                    let rendered = message["rendered"].as_str();
                    text += rendered.or(message["message"].as_str()).unwrap_or_default();
                    text += "\n";
                    messages.push(message);
                }
                _ => {
                    text += line;
                    text += "\n";
                }
            }
        }
        Self { messages, text }
    }

    /// The first error; if there is none, the first line.
    pub fn first_error(&self) -> String {
        let error = self.errors().find_map(|m| m["message"].as_str());
        let first = error.or_else(|| self.text.lines().find(|line| !line.trim().is_empty()));
        first
            .unwrap_or("the compiler printed no message")
            .trim()
            .to_owned()
    }

    fn errors(&self) -> impl Iterator<Item = &Value> {
        self.messages.iter().filter(|m| m["level"] == "error")
    }

    /// The errors in the user's texts, which are parts of `module`; `None` if no error is there.
    pub fn in_texts(&self, module: &str, texts: &[Text<'_>]) -> Option<Diagnostics> {
        let blocks: Vec<Block<'_>> = texts
            .iter()
            .flat_map(|text| Block::of(module, text))
            .collect();
        let mut problems = Vec::new();
        for error in self.errors() {
            if let Some(problem) = problem(error, &blocks)
                && !problems.contains(&problem)
            {
                problems.push(problem);
            }
        }
        (!problems.is_empty()).then_some(Diagnostics { problems })
    }
}

/// A copy of a text in the module.
struct Block<'a> {
    text: &'a Text<'a>,
    /// Number of lines of the module above it.
    above: usize,
    lines: usize,
}

impl<'a> Block<'a> {
    /// All copies of a text: each force with other ports has its own copy.
    fn of(module: &str, text: &'a Text<'a>) -> Vec<Self> {
        let wanted = text.text.trim_end();
        let found = module.match_indices(wanted);
        let blocks = found.map(|(at, _)| Block {
            text,
            above: module[..at].matches('\n').count(),
            lines: wanted.lines().count(),
        });
        match wanted.is_empty() {
            true => Vec::new(),
            false => blocks.collect(),
        }
    }
}

impl Block<'_> {
    /// True if a line of the module belongs to the copy.
    fn holds(&self, line: usize) -> bool {
        (1..=self.lines).contains(&line.saturating_sub(self.above))
    }
}

/// The text that a line of the module belongs to, and the line in the text.
pub fn place_in_texts<'a>(
    module: &str,
    texts: &'a [Text<'a>],
    line: usize,
) -> Option<(&'a Text<'a>, usize)> {
    let mut blocks = texts.iter().flat_map(|text| Block::of(module, text));
    let block = blocks.find(|block| block.holds(line))?;
    Some((block.text, line - block.above))
}

/// An error as a problem of the user's file, if one of its places is there; the main place is preferred.
fn problem(error: &Value, blocks: &[Block<'_>]) -> Option<Diagnostic> {
    let empty = Vec::new();
    let spans = error["spans"].as_array().unwrap_or(&empty);
    let main_first = spans
        .iter()
        .filter(|span| span["is_primary"] == true)
        .chain(spans.iter().filter(|span| span["is_primary"] != true));
    let (span, block, line) = main_first
        .filter(|span| {
            let file = span["file_name"].as_str().unwrap_or_default();
            file.ends_with("model.rs")
        })
        .find_map(|span| {
            let line = span["line_start"].as_u64()? as usize;
            let block = blocks.iter().find(|block| block.holds(line))?;
            Some((span, block, line - block.above))
        })?;
    let column = span["column_start"].as_u64().unwrap_or(1) as usize;
    let length = match span["line_start"] == span["line_end"] {
        true => (span["column_end"].as_u64().unwrap_or(1) as usize).saturating_sub(column),
        false => usize::MAX / 2,
    };
    let mut message = error["message"].as_str().unwrap_or_default().to_owned();
    if let Some(label) = span["label"].as_str().filter(|label| !label.is_empty()) {
        message = format!("{message}: {label}");
    }
    Some(Diagnostic::at(
        block.text.name,
        block.text.text,
        (line, column, length.max(1)),
        message.replace('\n', " "),
        help(error),
    ))
}

/// The compiler's suggestions, and its notes without a place.
fn help(error: &Value) -> String {
    let empty = Vec::new();
    let children = error["children"].as_array().unwrap_or(&empty);
    let texts: Vec<String> = children
        .iter()
        .filter(|child| matches!(child["level"].as_str(), Some("help" | "note")))
        .filter_map(|child| {
            let message = child["message"].as_str()?;
            let suggested = child["spans"]
                .as_array()
                .and_then(|spans| spans.first()?["suggested_replacement"].as_str());
            Some(match suggested.filter(|s| !s.trim().is_empty()) {
                Some(suggested) => format!("{message}: `{}`", suggested.trim()),
                None => message.to_owned(),
            })
        })
        .map(|text| text.replace('\n', " "))
        .collect();
    match texts.is_empty() {
        true => {
            "correct this line of your file; the arguments and the result of the function are in \
                 `bryant equations MODEL --rust`, at the end"
                .to_owned()
        }
        false => texts.join("; "),
    }
}
