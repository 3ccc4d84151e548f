//! Comments in generated Rust text. Tokens cannot hold comments, so an attribute stands for each comment until the text
//! is formatted.

use syn::{Attribute, parse_quote};

const MARK: &str = "@comment ";

/// The attribute that becomes a comment above a statement; `None` if the comment is empty.
pub(crate) fn marked(text: &str) -> Option<Attribute> {
    let marked = format!("{MARK}{}", crate::names::plain(text));
    (!text.is_empty()).then(|| parse_quote!(#[doc = #marked]))
}

/// Turns marked attributes into comments, and inserts an empty line above each of them and between items.
pub(crate) fn splice(formatted: &str) -> String {
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

#[cfg(test)]
mod tests {
    use super::*;
    use quote::quote;

    #[test]
    fn comments_survive_formatting() {
        let comment = marked("belt \"lap\": tension");
        let tokens = quote!(fn f() { let a = 1; #comment let b = 2; });
        let file = syn::parse2(tokens).expect("a function");
        let text = splice(&prettyplease::unparse(&file));
        assert_eq!(
            text,
            "fn f() {\n    let a = 1;\n\n    // belt \"lap\": tension\n    let b = 2;\n}\n"
        );
    }

    #[test]
    fn a_comment_cannot_leave_its_line() {
        let comment = marked("a\nfn evil() {}");
        let file = syn::parse2(quote!(fn f() { #comment let b = 2; })).expect("a function");
        let text = splice(&prettyplease::unparse(&file));
        assert_eq!(text, "fn f() {\n    // a fn evil() {}\n    let b = 2;\n}\n");
    }
}
