//! The JSON Schema of the language, from the declarations of its keys: editors complete and check texts by it. It says
//! what the shapes of values say; what numbers and names mean together is known only to reading.

use super::language::Language;
use super::quantity::Quantity;
use super::rule::Rule;
use super::shape::{Key, Record};
use bryant_table::unit;
use serde_yaml::{Mapping, Value};
use std::collections::BTreeMap;

/// The draft that editors know best.
const DRAFT: &str = "http://json-schema.org/draft-07/schema#";

/// Definitions that are being written.
pub struct Schema {
    /// The kinds of joints and the laws.
    pub language: &'static Language,
    /// By name; `Null` while one is being written, for records may contain themselves.
    definitions: BTreeMap<String, Value>,
}

/// A mapping as a value.
pub fn object<const N: usize>(entries: [(&str, Value); N]) -> Value {
    let entries = entries.map(|(key, value)| (Value::from(key), value));
    Value::Mapping(Mapping::from_iter(entries))
}

/// Values of a type of JSON: "string", "number", "boolean", "integer".
pub fn typed(name: &str) -> Value {
    object([("type", name.into())])
}

/// One of several.
pub fn any_of(all: impl IntoIterator<Item = Value>) -> Value {
    object([("anyOf", Value::Sequence(all.into_iter().collect()))])
}

/// One of some words.
pub fn words(all: &[&str]) -> Value {
    object([("enum", Value::from_iter(all.iter().copied()))])
}

/// One of some whole numbers.
pub fn numbers(all: &[u64]) -> Value {
    object([("enum", Value::from_iter(all.iter().copied()))])
}

/// Lists of such values.
pub fn list_of(item: Value) -> Value {
    object([("type", "array".into()), ("items", item)])
}

/// Mappings from names to such values.
pub fn mapping_of(value: Value) -> Value {
    object([("type", "object".into()), ("additionalProperties", value)])
}

/// The definition of what stands for a number.
pub const QUANTITY: &str = "a quantity";

/// A reference to the definition with this name.
fn reference(name: &str) -> Value {
    let path = format!("#/definitions/{}", name.replace(' ', "%20"));
    object([("$ref", path.into())])
}

/// A value with words for its reader.
fn described(value: Value, description: String) -> Value {
    let mut entries = match value {
        Value::Mapping(entries) if !entries.contains_key("$ref") => entries,
        // what stands beside a reference is not read, so the reference stands in a list of its own
        reference => Mapping::from_iter([("allOf".into(), Value::Sequence(vec![reference]))]),
    };
    entries.insert("description".into(), description.into());
    Value::Mapping(entries)
}

impl Schema {
    /// No definitions yet.
    pub fn new(language: &'static Language) -> Self {
        Schema {
            language,
            definitions: BTreeMap::new(),
        }
    }

    /// A reference to a definition, which is written at its first use.
    pub fn define(&mut self, name: &str, written: impl FnOnce(&mut Self) -> Value) -> Value {
        if !self.definitions.contains_key(name) {
            self.definitions.insert(name.to_owned(), Value::Null);
            let written = written(self);
            self.definitions.insert(name.to_owned(), written);
        }
        reference(name)
    }

    /// The values of a schema that keep a rule, if it is the schema of quantities.
    pub fn ruled(&mut self, of: Value, rule: Rule) -> Value {
        match of == reference(QUANTITY) && rule != Rule::Finite {
            true => {
                let name = format!("{QUANTITY} that {}", rule.words());
                self.define(&name, |to| Quantity::ruled(to, rule))
            }
            false => of,
        }
    }

    /// A reference to a record.
    pub fn record<R: Record>(&mut self) -> Value {
        self.keys(R::TITLE, &R::keys())
    }

    /// A reference to the record with this title and these keys.
    pub fn keys(&mut self, title: &str, keys: &[Key]) -> Value {
        self.define(title, |to| {
            let property = |key: &Key| {
                let value = (key.schema)(to);
                let quantity = self::reference(QUANTITY);
                let is_quantity = value == to.ruled(quantity, key.rule);
                let example = key.example().filter(|_| is_quantity);
                let mut value = described(value, key.sentence());
                if let (Value::Mapping(entries), Some(example)) = (&mut value, example) {
                    entries.insert("examples".into(), Value::Sequence(vec![example.into()]));
                }
                (Value::from(key.name), value)
            };
            let properties = Mapping::from_iter(keys.iter().map(property));
            let required = keys.iter().filter(|key| !key.optional).map(|key| key.name);
            object([
                ("type", "object".into()),
                ("description", title.into()),
                ("properties", Value::Mapping(properties)),
                ("required", Value::from_iter(required)),
                ("additionalProperties", false.into()),
            ])
        })
    }

    /// The schema of texts that are such a record.
    pub fn of<R: Record>(language: &'static Language) -> Value {
        let mut to = Schema::new(language);
        let root = to.record::<R>();
        let definitions = to.definitions.into_iter();
        let definitions = definitions.map(|(name, value)| (Value::from(name), value));
        object([
            ("$schema", DRAFT.into()),
            ("allOf", Value::Sequence(vec![root])),
            ("definitions", Value::Mapping(definitions.collect())),
        ])
    }
}

/// A text without the addresses of its links, which lead from the reference page.
fn without_links(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, link)) = rest.split_once('[') {
        plain += before;
        match link.split_once("](") {
            Some((shown, behind)) if !shown.contains(['[', ']']) => {
                plain += shown;
                rest = behind.split_once(')').map_or("", |(_, behind)| behind);
            }
            _ => {
                plain.push('[');
                rest = link;
            }
        }
    }
    plain + rest
}

impl Key {
    /// Meaning, unit and default in one line.
    pub fn sentence(&self) -> String {
        let unit = match self.measure() {
            unit if unit.is_empty() => String::new(),
            unit => format!(" [{unit}]"),
        };
        let default = match self.default {
            "none" | "required" => String::new(),
            default => format!("; default: {default}"),
        };
        without_links(&format!("{}{unit}{default}", self.meaning.trim()))
    }

    /// The unit of its numbers and the values that they may have: "N·s/m, ≥ 0"; "" where there is neither.
    pub fn measure(&self) -> String {
        let unit = (self.unit)();
        match (unit.is_empty(), self.rule.bound()) {
            (_, "") => unit,
            (true, bound) => bound.to_owned(),
            (false, bound) => format!("{unit}, {bound}"),
        }
    }

    /// A number with the unit of the key, as texts spell it.
    fn example(&self) -> Option<String> {
        let unit = (self.unit)();
        let spelled = unit.replace('·', "*").replace('²', "^2");
        unit::product(&spelled).map(|_| format!("1 {spelled}"))
    }

    /// Its row of the reference page.
    pub fn row(&self) -> String {
        let unit = match self.measure() {
            unit if unit.is_empty() => " ".to_owned(),
            unit => format!(" {unit} "),
        };
        format!(
            "| `{}` |{unit}| {} | {} |\n",
            self.name,
            self.default,
            self.meaning.trim()
        )
    }
}
