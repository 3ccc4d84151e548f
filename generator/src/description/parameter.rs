//! Parameters as written: numbers that may be changed without compiling again.

use super::measure::{Any, OfTheValue};
use super::place::At;
use super::quantity::{Number, Quantity};
use super::schema::{Schema, any_of};
use super::shape::{Misfit, Problems, Shape, check_record, record};
use super::tree::NodeKind;
use serde_yaml::Value;

record! {
    /// A parameter and its range.
    Parameter as "a parameter" {
        /// the value unless a run sets another; `name: 0.3` is short for `name: { value: 0.3 }`
        value: Number<Any>,
        /// smallest value allowed
        min: Option<Number<OfTheValue>> = "unbounded",
        /// largest value allowed
        max: Option<Number<OfTheValue>> = "unbounded",
    }
}

/// A parameter with its range, or its value alone.
#[derive(Clone, Debug)]
pub struct ParameterEntry(pub Parameter);

impl Shape for ParameterEntry {
    fn schema(to: &mut Schema) -> Value {
        any_of([Quantity::schema(to), Parameter::schema(to)])
    }

    fn check(at: At<'_>, problems: &Problems) {
        match at.node.kind {
            NodeKind::Map(_) => check_record::<Parameter>(at, problems),
            _ => Quantity::check(at, problems),
        }
    }

    fn read(value: &Value) -> Result<Self, Misfit> {
        let parameter = match value.is_mapping() {
            true => Parameter::read(value)?,
            false => Parameter {
                value: Number::read(value)?,
                min: None,
                max: None,
            },
        };
        Ok(ParameterEntry(parameter))
    }
}
