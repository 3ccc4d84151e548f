//! The located tree as a value, without places.

use super::tree::{Node, NodeKind};
use serde_yaml::{Mapping, Value};

impl Node {
    /// The same without places: text without quotation marks is a number, a truth value or nothing where YAML says so.
    pub fn value(&self) -> Value {
        match &self.kind {
            NodeKind::Scalar { text, plain: true } => match serde_yaml::from_str(text) {
                Ok(value @ (Value::Null | Value::Bool(_) | Value::Number(_))) => value,
                _ => Value::String(text.clone()),
            },
            NodeKind::Scalar { text, .. } => Value::String(text.clone()),
            NodeKind::List(items) => Value::Sequence(items.iter().map(Node::value).collect()),
            NodeKind::Map(entries) => {
                let entries = entries.iter().map(|e| {
                    // a key is a text, also where it looks like a number
                    (Value::String(e.key.clone()), e.value.value())
                });
                Value::Mapping(entries.collect::<Mapping>())
            }
        }
    }
}
