//! C identifiers, each used only once.

use rustc_hash::FxHashSet;

/// Lowercase letters, digits and single underscores, made from words such as "man/head.angle": `man_head_angle`. The
/// caller puts a prefix before the result, so the result may begin with a digit, and may be empty.
pub fn snake(words: &str) -> String {
    let letter = |c: char| match c.is_ascii_alphanumeric() {
        true => c.to_ascii_lowercase(),
        false => '_',
    };
    let letters: String = words.chars().map(letter).collect();
    let parts = letters.split('_').filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("_")
}

/// The name of a model in C; `model` if no letter or digit of the words is left.
pub fn model(words: &str) -> String {
    let name = snake(words);
    match name.chars().next() {
        None => "model".to_owned(),
        Some(c) if c.is_ascii_digit() => format!("model_{name}"),
        Some(_) => name,
    }
}

/// The names of enumerators used so far.
#[derive(Default)]
pub struct Enumerators(FxHashSet<String>);

impl Enumerators {
    /// The enumerator for these words, or the first of `NAME_2`, `NAME_3`, … that is unused.
    pub fn take(&mut self, prefix: &str, words: &str) -> String {
        let wanted = format!("{prefix}_{}", snake(words)).to_ascii_uppercase();
        let mut name = wanted.clone();
        let mut number = 1;
        while !self.0.insert(name.clone()) {
            number += 1;
            name = format!("{wanted}_{number}");
        }
        name
    }
}
