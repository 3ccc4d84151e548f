//! The words of arithmetic: numbers, names, signs.

use super::expression::Mistake;
use super::slip;
use crate::diagnostic::quoted;

/// A token and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Token {
    /// First character, from 0.
    pub offset: usize,
    /// Characters.
    pub length: usize,
    /// What it is.
    pub kind: TokenKind,
}

/// What a token is.
#[derive(Clone, Debug, PartialEq)]
pub enum TokenKind {
    /// A number without sign.
    Number(f64),
    /// A unit, a parameter, a function.
    Name(String),
    /// One of `+ - * / ( ) ^`.
    Sign(char),
}

/// The tokens of a text; other spellings of an operator (`·`, `−`, `²`) become the usual one.
pub fn tokens(characters: &[char]) -> Result<Vec<Token>, Mistake> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while at < characters.len() {
        let start = at;
        let c = characters[at];
        let kind = if c.is_whitespace() {
            at += 1;
            continue;
        } else if c.is_ascii_digit() || c == '.' {
            at = end_of_number(characters, at);
            let text: String = characters[start..at].iter().collect();
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => TokenKind::Number(value),
                _ => {
                    return Err(Mistake {
                        offset: start,
                        length: at - start,
                        message: format!("{} is not a finite number", quoted(&text)),
                        help: "numbers are written like `12`, `0.5` or `1e-3`".to_owned(),
                    });
                }
            }
        } else if is_letter(c) {
            while at < characters.len()
                && (is_letter(characters[at]) || characters[at].is_ascii_digit())
            {
                at += 1;
            }
            TokenKind::Name(characters[start..at].iter().collect())
        } else {
            at += 1;
            match c {
                '%' | '°' => TokenKind::Name(c.to_string()),
                '·' | '×' => TokenKind::Sign('*'),
                '−' => TokenKind::Sign('-'),
                '²' | '³' => {
                    tokens.push(Token {
                        offset: start,
                        length: 1,
                        kind: TokenKind::Sign('^'),
                    });
                    TokenKind::Number(if c == '²' { 2.0 } else { 3.0 })
                }
                '+' | '-' | '*' | '/' | '(' | ')' | '^' => TokenKind::Sign(c),
                _ => return Err(no_token(characters, start)),
            }
        };
        tokens.push(Token {
            offset: start,
            length: at - start,
            kind,
        });
    }
    Ok(tokens)
}

/// What is wrong with a character that is no part of arithmetic.
fn no_token(characters: &[char], at: usize) -> Mistake {
    let c = characters[at];
    let digit = |at: Option<usize>| {
        let c = at.and_then(|at| characters.get(at));
        c.is_some_and(char::is_ascii_digit)
    };
    let (message, help) = match slip::in_word(&c.to_string()) {
        Some(said) => said,
        None if c == ',' && digit(at.checked_sub(1)) && digit(Some(at + 1)) => (
            "a comma stands in a number".to_owned(),
            "the decimal sign is a point, as in `0.5`; thousands are not divided".to_owned(),
        ),
        None => (
            format!(
                "the character {} has no meaning in a quantity",
                quoted(&c.to_string())
            ),
            "a quantity is made of numbers, units, parameters, + - * / ( ) sqrt sin cos pi"
                .to_owned(),
        ),
    };
    Mistake {
        offset: at,
        length: 1,
        message,
        help,
    }
}

fn is_letter(c: char) -> bool {
    c.is_alphabetic() || c == '_' || c == 'µ'
}

fn end_of_number(characters: &[char], mut at: usize) -> usize {
    let digit = |at: usize| characters.get(at).is_some_and(char::is_ascii_digit);
    while digit(at) || characters.get(at) == Some(&'.') {
        at += 1;
    }
    if matches!(characters.get(at), Some('e' | 'E')) {
        let sign = usize::from(matches!(characters.get(at + 1), Some('+' | '-')));
        if digit(at + 1 + sign) {
            at += 1 + sign;
            while digit(at) {
                at += 1;
            }
        }
    }
    at
}
