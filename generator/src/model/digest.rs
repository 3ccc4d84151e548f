//! The digest of a model: SHA-256 of a text that contains every field with its name.
//!
//! | | in the text |
//! |---|---|
//! | fields of a record, sorted by name | `{name=value;…}`, without fields that are absent, false or empty |
//! | a list | `[value;…]` |
//! | a variant of an enumeration | `!name value`, or the name alone |
//! | a text | its length in bytes, `:` and its bytes |
//! | a number | the shortest decimal that reads back as the same number |
//!
//! So the digest depends neither on the order of fields nor on types of this program, and a feature that a model does
//! not use does not change its digest: a new field must be an `Option`, a flag or a list. A field or variant that is
//! renamed keeps its old name in the text by `#[serde(rename = "…")]`.

use super::mechanism::Model;
use serde_yaml::Value;
use sha2::{Digest, Sha256};
use std::fmt::Write;

impl Model {
    /// SHA-256, in lower-case hexadecimal, of all parts of the model that affect a motion or an output: two models in
    /// normal form have the same digest if and only if their modules have the same text.
    pub fn sha256(&self) -> String {
        let mut text = String::new();
        // a model is made of records, lists, texts and numbers, all of which have a value
        let value = serde_yaml::to_value(self)
            .unwrap_or_else(|error| panic!("a model has no value: {error}"));
        write_value(&value, &mut text);
        let digest = Sha256::digest(text);
        digest.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

fn write_value(value: &Value, text: &mut String) {
    match value {
        Value::Null => text.push('~'),
        Value::Bool(flag) => _ = write!(text, "{flag}"),
        Value::Number(number) => match number.as_f64().filter(|_| number.is_f64()) {
            Some(number) => _ = write!(text, "{number:?}"),
            None => _ = write!(text, "{number}"),
        },
        Value::String(words) => _ = write!(text, "{}:{words}", words.len()),
        Value::Sequence(list) => {
            text.push('[');
            for value in list {
                write_value(value, text);
                text.push(';');
            }
            text.push(']');
        }
        Value::Mapping(record) => {
            let mut fields: Vec<(&str, String)> = Vec::new();
            for (name, value) in record {
                let mut written = String::new();
                write_value(value, &mut written);
                if !matches!(written.as_str(), "~" | "false" | "[]" | "{}" | "0:") {
                    fields.push((name.as_str().unwrap_or_default(), written));
                }
            }
            fields.sort_unstable();
            text.push('{');
            for (name, value) in fields {
                _ = write!(text, "{name}={value};");
            }
            text.push('}');
        }
        Value::Tagged(tagged) => {
            _ = write!(text, "{} ", tagged.tag);
            write_value(&tagged.value, text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::write_value;

    #[derive(serde::Serialize)]
    struct Old {
        b: f64,
        a: Vec<Option<usize>>,
        c: Kind,
    }

    #[derive(serde::Serialize)]
    struct New<'a> {
        a: Vec<Option<usize>>,
        b: f64,
        c: Kind,
        flag: bool,
        more: Vec<f64>,
        name: &'a str,
        other: Option<f64>,
    }

    #[derive(serde::Serialize)]
    enum Kind {
        Plain,
        With(f64),
    }

    fn text(value: &impl serde::Serialize) -> String {
        let mut text = String::new();
        write_value(&serde_yaml::to_value(value).unwrap(), &mut text);
        text
    }

    /// Types, order and fields that say nothing leave no trace; whatever says something does.
    #[test]
    fn a_text_has_what_is_said() {
        let kinds = || [Kind::Plain, Kind::With(0.1)];
        let old = kinds().map(|c| {
            text(&Old {
                b: f64::INFINITY,
                a: vec![None, Some(2)],
                c,
            })
        });
        assert_eq!(
            old,
            [
                "{a=[~;2;];b=inf;c=5:Plain;}",
                "{a=[~;2;];b=inf;c=!With 0.1;}"
            ]
        );
        let new = |flag, more: &[f64], name, other| {
            let more = more.to_vec();
            kinds().map(|c| {
                text(&New {
                    a: vec![None, Some(2)],
                    b: f64::INFINITY,
                    c,
                    flag,
                    more: more.clone(),
                    name,
                    other,
                })
            })
        };
        assert_eq!(new(false, &[], "", None), old);
        let all = [
            new(true, &[], "", None),
            new(false, &[0.0], "", None),
            new(false, &[], "x", None),
            new(false, &[], "", Some(0.0)),
            new(false, &[-0.0], "", None),
        ];
        for (i, one) in all.iter().enumerate() {
            assert!(
                *one != old && all[..i].iter().all(|other| other != one),
                "{one:?}"
            );
        }
    }
}
