//! Comments in generated Rust text. Tokens cannot hold comments, so an attribute stands for each comment until the text
//! is formatted.

use syn::{Attribute, parse_quote};

const MARK: &str = "@comment ";

/// The attribute that becomes a comment above a statement; `None` if the comment is empty.
pub fn marked(text: &str) -> Option<Attribute> {
    let marked = format!("{MARK}{}", crate::names::plain(text));
    (!text.is_empty()).then(|| parse_quote!(#[doc = #marked]))
}

/// Turns marked attributes into comments, and inserts an empty line above each of them and between items.
pub fn splice(formatted: &str) -> String {
    let mut text = String::with_capacity(formatted.len() + formatted.len() / 16);
    let (mut start_of_block, mut end_of_item) = (true, false);
    for line in formatted.lines() {
        let bare = line.trim_start();
        let indent = line.len() - bare.len();
        if end_of_item && !bare.starts_with('}') && !bare.starts_with("use ") {
            text.push('\n');
        }
        if let Some(comment) = bare
            .strip_prefix("///")
            .and_then(|rest| rest.strip_prefix(MARK))
        {
            if !start_of_block {
                text.push('\n');
            }
            text.push_str(&line[..indent]);
            text.push_str("// ");
            text.push_str(comment);
        } else {
            text.push_str(line);
        }
        text.push('\n');
        start_of_block = bare.ends_with('{');
        // Items have no indentation, those in an `impl` one level; statements have more.
        end_of_item = match indent {
            0 => bare.ends_with(['}', ';']),
            4 => bare == "}",
            _ => false,
        };
    }
    text
}
