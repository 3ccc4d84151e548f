//! Identifiers: turns the words of a model into names that Rust accepts, each used once.

use rustc_hash::FxHashSet;

/// Names taken so far in one scope.
#[derive(Clone, Default)]
pub struct Names {
    taken: FxHashSet<String>,
}

impl Names {
    /// A scope in which these names are already taken.
    pub fn with(reserved: &[&str]) -> Self {
        Self {
            taken: reserved.iter().map(|name| name.to_string()).collect(),
        }
    }

    /// Takes the name, or the first of `name_2`, `name_3` … that is free.
    pub fn take(&mut self, wanted: &str) -> String {
        let mut name = wanted.to_string();
        let mut number = 1;
        while !self.taken.insert(name.clone()) {
            number += 1;
            name = format!("{wanted}_{number}");
        }
        name
    }
}

/// The user's text on one line, so that it cannot end a comment.
pub(crate) fn plain(text: &str) -> String {
    let printable = |c: char| {
        if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') {
            ' '
        } else {
            c
        }
    };
    text.chars().map(printable).collect()
}

/// Words that get a trailing underscore: the keywords of Rust, in lower case. Some keywords are not allowed even as raw
/// identifiers.
pub const RESERVED: &[&str] = &[
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "crate",
    "do", "dyn", "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl",
    "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref",
    "return", "self", "static", "struct", "super", "trait", "true", "try", "type", "typeof",
    "unsafe", "unsized", "use", "virtual", "where", "while", "yield",
];

/// An identifier in snake case from words such as "man/head.angle"; `value` if the words contain no letter or digit.
pub fn snake(words: &str) -> String {
    let mut name = String::with_capacity(words.len());
    for c in words.chars() {
        if c.is_ascii_alphanumeric() {
            name.push(c.to_ascii_lowercase());
        } else if !name.is_empty() && !name.ends_with('_') {
            name.push('_');
        }
    }
    let name = name.trim_end_matches('_');
    match name.chars().next() {
        None => "value".to_string(),
        Some(c) if c.is_ascii_digit() => format!("n{name}"),
        Some(_) if RESERVED.contains(&name) => format!("{name}_"),
        Some(_) => name.to_string(),
    }
}

/// The same in the case of constants.
pub fn screaming(words: &str) -> String {
    snake(words).trim_end_matches('_').to_ascii_uppercase()
}

/// The same in the case of types.
pub fn camel(words: &str) -> String {
    snake(words)
        .split('_')
        .flat_map(|word| {
            let (first, rest) = word.split_at(word.len().min(1));
            [first.to_ascii_uppercase(), rest.to_string()]
        })
        .collect()
}
