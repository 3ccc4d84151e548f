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

pub fn write_value(value: &Value, text: &mut String) {
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
