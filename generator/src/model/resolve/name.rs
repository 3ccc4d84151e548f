//! Names: permitted characters, and uniqueness.
//!
//! Names become identifiers of the generated source, with dashes as underscores.

use super::Resolver;
use crate::description::expression::FUNCTIONS;
use crate::description::place::At;
use crate::description::unit::unit;
use crate::diagnostic::quoted;

/// Longest name \[characters\].
const MAX_LENGTH: usize = 64;

/// Keywords of Rust, edition 2024, including reserved ones.
const KEYWORDS: [&str; 54] = [
    "abstract",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "const",
    "continue",
    "crate",
    "do",
    "dyn",
    "else",
    "enum",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "pub",
    "ref",
    "return",
    "self",
    "static",
    "struct",
    "super",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "union",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
    "macro_rules",
    "raw",
];

/// The separators that a name may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Words between dashes: models.
    Kebab,
    /// Words between underscores: parameters.
    Snake,
    /// Either: systems, elements, forces, curves.
    Either,
}

/// True if a word is a keyword of Rust.
pub fn is_keyword(word: &str) -> bool {
    KEYWORDS.contains(&word)
}

/// The name as an identifier of the generated source.
pub fn identifier(name: &str) -> String {
    name.replace('-', "_")
}

impl Resolver<'_> {
    /// True if `name` may be the name of `what` ("an element"); otherwise reports it.
    pub fn check_name(&self, name: &str, what: &str, style: Style, at: At<'_>) -> bool {
        let separators = match style {
            Style::Kebab => "-",
            Style::Snake => "_",
            Style::Either => "-_",
        };
        let words_are_fine = name.split(|c| separators.contains(c)).all(|word| {
            !word.is_empty()
                && word
                    .chars()
                    .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
        });
        let starts = name.starts_with(|c: char| c.is_ascii_lowercase());
        let problem = if name.chars().count() > MAX_LENGTH {
            Some((
                format!("the name {} is too long", quoted(name)),
                format!("a name has at most {MAX_LENGTH} characters"),
            ))
        } else if !words_are_fine || !starts {
            Some((
                format!("{} cannot be the name of {what}", quoted(name)),
                match repaired(name, style) {
                    Some(better) => format!(
                        "write `{better}`: lower-case letters and digits, a letter first, words joined by {}",
                        joined_by(style)
                    ),
                    None => format!(
                        "a name has lower-case letters and digits, a letter first, words joined by {}",
                        joined_by(style)
                    ),
                },
            ))
        } else if KEYWORDS.contains(&identifier(name).as_str()) {
            Some((
                format!("{} is a keyword of Rust and cannot be the name of {what}", quoted(name)),
                format!("names become identifiers in the generated source; write for instance `{name}-1`").replace(
                    "-1",
                    if style == Style::Snake { "_1" } else { "-1" },
                ),
            ))
        } else {
            None
        };
        let fine = problem.is_none();
        if let Some((message, help)) = problem {
            self.problems.add(at.problem(message, help));
        }
        fine
    }

    /// True if `name` may be the name of a parameter; otherwise reports it.
    pub fn check_parameter_name(&self, name: &str, at: At<'_>) -> bool {
        let report = |message: String, help: &str| {
            self.problems.add(at.key_problem(message, help));
            false
        };
        if unit(name).is_some() {
            return report(
                format!(
                    "{} is a unit and cannot be the name of a parameter",
                    quoted(name)
                ),
                "in an expression it would stand for the unit; use a longer word",
            );
        }
        if FUNCTIONS.contains(&name) || name == "pi" {
            return report(
                format!(
                    "{} has a meaning in expressions and cannot be the name of a parameter",
                    quoted(name)
                ),
                "use another word",
            );
        }
        let words = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
        let fine = name.starts_with(|c: char| c.is_ascii_lowercase())
            && name.chars().count() <= MAX_LENGTH
            && name
                .split('_')
                .all(|word| !word.is_empty() && word.chars().all(words));
        if !fine {
            return report(
                format!("{} cannot be the name of a parameter", quoted(name)),
                &match repaired(name, Style::Snake) {
                    Some(better) => {
                        format!("write `{better}`: parameters are Rust identifiers in snake case")
                    }
                    None => {
                        "parameters are Rust identifiers in snake case, such as `belt_stiffness`"
                            .to_owned()
                    }
                },
            );
        }
        if KEYWORDS.contains(&name) {
            return report(
                format!(
                    "{} is a keyword of Rust and cannot be the name of a parameter",
                    quoted(name)
                ),
                "parameters become fields of a struct in the generated source; use another word",
            );
        }
        true
    }

    /// True if no earlier name becomes the same identifier; otherwise reports it.
    pub fn check_unique<'n>(
        &self,
        name: &str,
        what: &str,
        earlier: impl IntoIterator<Item = &'n str>,
        at: At<'_>,
    ) -> bool {
        let Some(other) = earlier
            .into_iter()
            .find(|o| identifier(o) == identifier(name))
        else {
            return true;
        };
        let message = if other == name {
            format!("there are two {what} called {}", quoted(name))
        } else {
            format!(
                "the {what} {} and {} become the same identifier",
                quoted(other),
                quoted(name)
            )
        };
        self.problems
            .add(at.problem(message, "give one of them another name"));
        false
    }
}

fn joined_by(style: Style) -> &'static str {
    match style {
        Style::Kebab => "`-`",
        Style::Snake => "`_`",
        Style::Either => "`-` or `_`",
    }
}

/// The name with its faults mended; `None` if nothing useful is left.
fn repaired(name: &str, style: Style) -> Option<String> {
    let separator = if style == Style::Snake { "_" } else { "-" };
    let mut spread = String::new();
    for (previous, c) in std::iter::once(' ').chain(name.chars()).zip(name.chars()) {
        if c.is_ascii_uppercase() && previous.is_ascii_lowercase() {
            spread.push(' ');
        }
        spread.push(c.to_ascii_lowercase());
    }
    let words: Vec<&str> = spread
        .split(|c: char| !c.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .collect();
    let better = words.join(separator);
    (better.starts_with(|c: char| c.is_ascii_lowercase()) && better.len() <= MAX_LENGTH)
        .then_some(better)
}
