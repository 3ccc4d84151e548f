//! Parameters as written: numbers that may be changed without compiling again.

use super::place::At;
use super::quantity::Quantity;
use super::shape::{Misfit, Problems, Shape, check_record, record};
use super::tree::Kind;
use serde_yaml::Value;

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

    fn read(value: &Value) -> Result<Self, Misfit> {
        let parameter = match value.is_mapping() {
            true => Parameter::read(value)?,
            false => Parameter {
                value: Quantity::read(value)?,
                min: None,
                max: None,
            },
        };
        Ok(ParameterEntry(parameter))
    }
}
