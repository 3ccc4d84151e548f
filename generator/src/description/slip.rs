//! Slips of the pen, after which a text is not what was meant: a tab, a space that is missing or no usual one, a comma
//! in a number, typographic signs. They are looked for only where something is wrong.

use super::place::At;
use super::tree::{NodeKind, Span};
use crate::diagnostic::excerpt;

/// A slip: where it is, what it is, and what would be right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slip {
    /// Its place.
    pub span: Span,
    /// What it is.
    pub message: String,
    /// What would be right.
    pub help: String,
    /// Whether it stands in the indentation.
    pub indents: bool,
}

/// A parser notices a slip at most this many lines of content later.
const NOTICED_AFTER: usize = 3;

/// The slip that a parser noticed in this line: the last one in the line of content behind it, in it, or shortly
/// before; or, in an indentation, anywhere before.
pub fn noticed_at(text: &str, line: usize) -> Option<Slip> {
    let mut before = Vec::new();
    for (number, content) in (1..).zip(text.lines()) {
        if content.trim().is_empty() || content.trim_start().starts_with('#') {
            continue;
        }
        before.push(in_line(content, number));
        // the line of content behind it is looked at, too
        if number > line {
            break;
        }
    }
    let near = before.iter().rev().take(NOTICED_AFTER + 1);
    let near = near.flatten().next();
    // an indentation counts up to the end of its block
    let indented = || before.iter().rev().flatten().find(|slip| slip.indents);
    near.or_else(indented).cloned()
}

/// The first slip in a line.
fn in_line(line: &str, number: usize) -> Option<Slip> {
    let code = code(line);
    let slip = |column: usize, length: usize, (message, help): (String, String)| Slip {
        span: Span {
            line: number,
            column: column + 1,
            length,
        },
        message,
        help,
        indents: false,
    };
    let begin = code.iter().position(|c| !is_space(*c) && *c != '-');
    let indentation = &code[..begin.unwrap_or(code.len())];
    if let Some(column) = indentation.iter().position(|c| *c != ' ' && *c != '-') {
        let said = match indentation[column] {
            '\t' => (
                "a tab stands in the indentation".to_owned(),
                "YAML is indented with spaces; replace the tab by spaces, as many as the line above has".to_owned(),
            ),
            odd => odd_sign(odd)?,
        };
        let indents = true;
        return Some(Slip {
            indents,
            ..slip(column, 1, said)
        });
    }
    if let Some((column, said)) = code
        .iter()
        .enumerate()
        .find_map(|(column, c)| Some((column, odd_sign(*c)?)))
    {
        return Some(slip(column, 1, said));
    }
    let starts = keys_begin(&code, indentation.len());
    starts.into_iter().find_map(|start| {
        let length = key_with_value(&code[start..])?;
        let rest = code[start..].iter().take_while(|c| !",]}".contains(**c));
        let word: String = rest.collect();
        let word = word.trim_end();
        Some(slip(start, word.chars().count(), no_space(word, length)))
    })
}

/// The characters of a line; those between quotation marks and in comments are replaced by letters and spaces.
fn code(line: &str) -> Vec<char> {
    let mut quote = None;
    let mut before = ' ';
    let mut comment = false;
    let of = |c: char| {
        comment |= quote.is_none() && c == '#' && is_space(before);
        let shown = match quote {
            _ if comment => ' ',
            Some(mark) if mark == c => {
                quote = None;
                'x'
            }
            Some(_) => 'x',
            None if "\"'".contains(c) && (is_space(before) || "[{,:(".contains(before)) => {
                quote = Some(c);
                'x'
            }
            None => c,
        };
        before = c;
        shown
    };
    line.chars().map(of).collect()
}

/// Where keys may begin: at the beginning of the line, and behind `{` and `,`.
fn keys_begin(code: &[char], indentation: usize) -> Vec<usize> {
    let mut starts = vec![indentation];
    for (at, _) in code.iter().enumerate().filter(|(_, c)| "{,".contains(**c)) {
        let skipped = code[at + 1..].iter().take_while(|c| is_space(**c)).count();
        starts.push(at + 1 + skipped);
    }
    starts
}

/// The length of the key of `key:value`, where no space stands behind the colon.
fn key_with_value(word: &[char]) -> Option<usize> {
    let in_key = |c: &&char| c.is_ascii_alphanumeric() || "_-".contains(**c);
    let length = word.iter().take_while(in_key).count();
    let begins = word.first()?.is_ascii_alphabetic();
    let value = *word.get(length + 1)?;
    // `a::b` and `http://` are no keys
    let is_value = !is_space(value) && !":/,]}".contains(value);
    (begins && word[length] == ':' && is_value).then_some(length)
}

fn no_space(word: &str, length: usize) -> (String, String) {
    let (key, value) = word.split_at(length);
    (
        format!("a space is missing behind the colon of `{}:`", excerpt(key)),
        format!("write `{}: {}`", excerpt(key), excerpt(&value[1..])),
    )
}

fn is_space(c: char) -> bool {
    c.is_whitespace() || "\u{200b}\u{2060}\u{feff}".contains(c)
}

/// What is wrong with a sign that looks like another one.
fn odd_sign(c: char) -> Option<(String, String)> {
    let (name, usual) = match c {
        '“' | '”' | '„' | '‟' | '«' | '»' | '＂' => {
            ("a typographic quotation mark", "\"")
        }
        '‘' | '’' | '‚' | '‛' | '＇' => ("a typographic quotation mark", "'"),
        '：' | '﹕' | '∶' => ("a wide colon", ": "),
        '，' | '、' | '﹐' => ("a wide comma", ", "),
        '［' | '【' => ("a wide bracket", "["),
        '］' | '】' => ("a wide bracket", "]"),
        '｛' => ("a wide bracket", "{"),
        '｝' => ("a wide bracket", "}"),
        '．' | '。' => ("a wide point", "."),
        '－' | '–' | '—' => ("a dash", "-"),
        '\u{a0}' | '\u{202f}' | '\u{2007}' => ("a no-break space", " "),
        '\u{200b}' | '\u{2060}' | '\u{feff}' => ("a character that cannot be seen", ""),
        c if c != ' ' && c != '\t' && is_space(c) => ("an unusual space", " "),
        _ => return None,
    };
    let code = u32::from(c);
    let help = match usual {
        "" => "remove it".to_owned(),
        " " => "replace it by a usual space".to_owned(),
        usual => format!("write `{}`", usual.trim_end()),
    };
    Some((format!("{name} (U+{code:04X}) stands here"), help))
}

/// A word with a sign that looks like another one: what is wrong, and what would be right.
pub fn in_word(word: &str) -> Option<(String, String)> {
    let (message, help) = word.chars().find_map(odd_sign)?;
    let usual: String = word.chars().filter(|c| odd_sign(*c).is_none()).collect();
    match usual.trim() {
        "" => Some((message, help)),
        usual => Some((
            message.replace("stands here", "stands in it"),
            format!("{help}; or write `{}`", excerpt(usual)),
        )),
    }
}

/// A key that was meant otherwise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Meant {
    /// The key that was meant.
    pub key: String,
    /// Its value, where that is part of what is written.
    pub value: Option<String>,
    /// What is wrong, and what would be right.
    pub said: (String, String),
}

/// What a key that is none was meant to be, if this is seen from its signs: one of `known`, its value behind a colon
/// without a space, or surrounded by signs that are no letters.
pub fn key_meant(written: &str, known: &[&str]) -> Option<Meant> {
    let characters: Vec<char> = written.chars().collect();
    if let Some(length) = key_with_value(&characters)
        && known.contains(&&written[..length])
    {
        return Some(Meant {
            key: written[..length].to_owned(),
            value: Some(written[length + 1..].trim().to_owned()),
            said: no_space(written, length),
        });
    }
    let usual: String = characters
        .iter()
        .filter(|c| !is_space(**c) && odd_sign(**c).is_none())
        .collect();
    let (message, help) = characters.iter().find_map(|c| odd_sign(*c))?;
    known.contains(&usual.as_str()).then(|| Meant {
        value: None,
        said: (message, format!("{help}: the key is `{usual}`")),
        key: usual,
    })
}

/// What is wrong with a list that has too many or too few entries, if this is seen from its signs.
pub fn in_list(at: At<'_>) -> Option<String> {
    let NodeKind::List(items) = &at.node.kind else {
        return None;
    };
    let text = |index: usize| items.get(index).and_then(super::tree::Node::text);
    for (index, item) in items.iter().enumerate() {
        let word = text(index).unwrap_or_default();
        if let Some((message, help)) = word.chars().find_map(odd_sign) {
            return Some(format!("{message}: {help}"));
        }
        let numbers: Vec<&str> = word.split_whitespace().collect();
        if numbers.len() > 1 && numbers.iter().all(|n| n.parse::<f64>().is_ok()) {
            return Some(format!(
                "write a comma between two numbers: `{}`",
                excerpt(&numbers.join(", "))
            ));
        }
        let (Some(next), Some(behind)) = (items.get(index + 1), text(index + 1)) else {
            continue;
        };
        let adjacent = next.span.line == item.span.line
            && next.span.column == item.span.column + word.chars().count() + 1;
        if adjacent && is_decimal_comma(word, behind) {
            return Some(format!(
                "the decimal sign is a point: write `{0}.{1}` where `{0},{1}` is one number",
                excerpt(word),
                excerpt(behind)
            ));
        }
    }
    None
}

/// Whether `before,behind` may be one number with a decimal comma.
pub fn is_decimal_comma(before: &str, behind: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let whole = before.trim_start_matches(['-', '+']);
    digits(whole) && behind.starts_with(|c: char| c.is_ascii_digit())
}
