//! Parameters as written: numbers that may be changed without compiling again.

use super::place::At;
use super::quantity::Quantity;
use super::shape::{Problems, Shape, check_record, record};
use super::tree::Kind;
use serde::de::{Deserialize, Deserializer, Error};

record! {
    /// A parameter and its range.
    Parameter as "a parameter" {
        /// Value where nobody sets another.
        value: Quantity,
        /// Smallest value allowed.
        min: Option<Quantity>,
        /// Largest value allowed.
        max: Option<Quantity>,
    }
}

/// A parameter with its range, or its value alone.
#[derive(Clone, Debug)]
pub struct ParameterEntry(pub Parameter);

impl Shape for ParameterEntry {
    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            Kind::Map(_) => check_record::<Parameter>(at, problems),
            _ => Quantity::check(at, problems),
        }
    }
}

impl<'de> Deserialize<'de> for ParameterEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = serde_yaml::Value::deserialize(deserializer)?;
        if value.is_mapping() {
            Parameter::deserialize(value)
        } else {
            Quantity::deserialize(value).map(|value| Parameter {
                value,
                min: None,
                max: None,
            })
        }
        .map(ParameterEntry)
        .map_err(D::Error::custom)
    }
}
