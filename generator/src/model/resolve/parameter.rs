//! Parameters: their names are identifiers, their values constants within their range.

use super::Resolver;
use super::quantity::{Measure, describe};
use crate::description::parameter::Parameter as Written;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::diagnostic::quoted;
use crate::model::Parameter;

/// The checked form of a parameter or an input, and its dimension.
pub(super) fn parameter(
    resolver: &Resolver<'_>,
    name: &str,
    written: &Written,
    at: At<'_>,
    input: bool,
) -> Option<(Parameter, Measure)> {
    if !resolver.check_parameter_name(name, at) {
        return None;
    }
    let earlier = resolver.parameters.iter().map(|p| p.name.as_str());
    if !resolver.check_unique(name, "parameters", earlier, at.on_key()) {
        return None;
    }
    let value_at = at.key("value");
    let (value, measure) =
        resolver.constant(&written.value, value_at, "the value of a parameter")?;
    let bound = |quantity: Option<&Quantity>, key| match quantity {
        None => Some(None),
        Some(quantity) => bound(resolver, quantity, measure, at.key(key)).map(Some),
    };
    let (min, max) = (
        bound(written.min.as_deref(), "min"),
        bound(written.max.as_deref(), "max"),
    );
    let (min, max) = (min?, max?);
    if let (Some(min), Some(max)) = (min, max)
        && min > max
    {
        resolver.problems.add(at.key("min").problem(
            format!(
                "the smallest value of {} is larger than the largest, {min} > {max}",
                quoted(name)
            ),
            "exchange `min` and `max`",
        ));
        return None;
    }
    let (low, high) = (
        min.unwrap_or(f64::NEG_INFINITY),
        max.unwrap_or(f64::INFINITY),
    );
    if !(low..=high).contains(&value) {
        resolver.problems.add(value_at.problem(
            format!(
                "the value {value} of {} lies outside its range {low} … {high} (SI)",
                quoted(name)
            ),
            "change the value, or widen `min` and `max`",
        ));
        return None;
    }
    let unit = match measure {
        Measure::Known(dimension) => dimension.to_string(),
        _ => String::new(),
    };
    Some((
        Parameter {
            name: name.to_owned(),
            default: value,
            min,
            max,
            unit,
            input,
        },
        match measure {
            Measure::Bare => Measure::Unknown,
            measure => measure,
        },
    ))
}

/// A bound of a parameter. Its dimension must be `of_value`.
fn bound(
    resolver: &Resolver<'_>,
    quantity: &Quantity,
    of_value: Measure,
    at: At<'_>,
) -> Option<f64> {
    let (bound, of_bound) = resolver.constant(quantity, at, "a bound of a parameter")?;
    if let (Measure::Known(a), Measure::Known(b)) = (of_value, of_bound)
        && a != b
    {
        resolver.problems.add(at.problem(
            format!(
                "the bound is {}, but the value is {}",
                describe(b),
                describe(a)
            ),
            "give both in the same kind of unit",
        ));
        return None;
    }
    Some(bound)
}
