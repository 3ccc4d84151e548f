//! Identifiers: from the words of a model to names that Rust accepts, each used once.

use rustc_hash::FxHashSet;

/// Names taken so far in one scope.
#[derive(Clone, Default)]
pub(crate) struct Names {
    taken: FxHashSet<String>,
}

impl Names {
    /// A scope in which these names mean something already.
    pub(crate) fn with(reserved: &[&str]) -> Self {
        Self {
            taken: reserved.iter().map(|name| name.to_string()).collect(),
        }
    }

    /// Takes the name, or the first of `name_2`, `name_3` … that is free.
    pub(crate) fn take(&mut self, wanted: &str) -> String {
        let mut name = wanted.to_string();
        let mut number = 1;
        while !self.taken.insert(name.clone()) {
            number += 1;
            name = format!("{wanted}_{number}");
        }
        name
    }
}

/// An identifier in snake case for words such as "man/head.angle"; `value` where nothing of the words is left.
pub(crate) fn snake(words: &str) -> String {
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
        // `self` and its like cannot even be raw identifiers, so keywords get a trailing underscore instead.
        // `gen` is reserved since edition 2024 only, so syn lets it pass.
        Some(_) if name == "gen" || syn::parse_str::<syn::Ident>(name).is_err() => {
            format!("{name}_")
        }
        Some(_) => name.to_string(),
    }
}

/// The same for constants.
pub(crate) fn screaming(words: &str) -> String {
    snake(words).trim_end_matches('_').to_ascii_uppercase()
}

/// The same for types.
pub(crate) fn camel(words: &str) -> String {
    snake(words)
        .split('_')
        .flat_map(|word| {
            let (first, rest) = word.split_at(word.len().min(1));
            [first.to_ascii_uppercase(), rest.to_string()]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_become_identifiers() {
        assert_eq!(snake("man/head.angle"), "man_head_angle");
        assert_eq!(snake("Lap belt -- left"), "lap_belt_left");
        assert_eq!(snake("3yo"), "n3yo");
        assert_eq!(snake("ω"), "value");
        assert_eq!(screaming("belt chest force"), "BELT_CHEST_FORCE");
        assert_eq!(camel("mass_matrix"), "MassMatrix");
    }

    #[test]
    fn keywords_are_avoided() {
        for word in [
            "type", "self", "fn", "loop", "async", "gen", "Self", "super", "crate",
        ] {
            let name = snake(word);
            assert!(syn::parse_str::<syn::Ident>(&name).is_ok(), "{name}");
            assert_ne!(name, word.to_ascii_lowercase());
        }
    }

    #[test]
    fn a_name_is_given_once() {
        let mut names = Names::with(&["q"]);
        let given = ["a", "a", "q", "a_2", "a"].map(|name| names.take(name));
        assert_eq!(given, ["a", "a_2", "q_2", "a_2_2", "a_3"]);
    }
}
