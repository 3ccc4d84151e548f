//! Parameters: names that are identifiers, constants within their range.

use super::Resolver;
use super::quantity::{Measure, describe};
use crate::description::parameter::Parameter as Written;
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::diagnostic::quoted;
use crate::model::Parameter;

impl Resolver<'_> {
    /// Enters a parameter.
    pub fn parameter_entry(&mut self, name: &str, written: &Written, at: At<'_>) {
        match self.declared(name, written, at) {
            Some((parameter, measure)) => {
                self.defaults.push(parameter.default);
                self.parameters.push(parameter);
                self.measures.push(measure);
            }
            None => self.failed_parameters.push(name.to_owned()),
        }
    }

    fn declared(&self, name: &str, written: &Written, at: At<'_>) -> Option<(Parameter, Measure)> {
        if !self.check_parameter_name(name, at) {
            return None;
        }
        let earlier = self.parameters.iter().map(|p| p.name.as_str());
        if !self.check_unique(name, "parameters", earlier, at.on_key()) {
            return None;
        }
        let value_at = at.key("value");
        let (value, measure) =
            self.constant(&written.value, value_at, "the value of a parameter")?;
        let bound = |quantity: &Option<Quantity>, key: &str| match quantity {
            None => Some(None),
            Some(quantity) => {
                let (bound, of_bound) =
                    self.constant(quantity, at.key(key), "a bound of a parameter")?;
                if let (Measure::Known(a), Measure::Known(b)) = (measure, of_bound)
                    && a != b
                {
                    self.problems.add(at.key(key).problem(
                        format!(
                            "the bound is {}, but the value is {}",
                            describe(b),
                            describe(a)
                        ),
                        "give both in the same kind of unit",
                    ));
                    return None;
                }
                Some(Some(bound))
            }
        };
        let (min, max) = (bound(&written.min, "min"), bound(&written.max, "max"));
        let (min, max) = (min?, max?);
        if let (Some(min), Some(max)) = (min, max)
            && min > max
        {
            self.problems.add(at.key("min").problem(
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
            self.problems.add(value_at.problem(
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
            },
            match measure {
                Measure::Bare => Measure::Unknown,
                measure => measure,
            },
        ))
    }

    /// A number that depends on no parameter.
    pub fn constant(&self, quantity: &Quantity, at: At<'_>, what: &str) -> Option<(f64, Measure)> {
        let (number, measure) = self.measured(quantity, at)?;
        if number.constant().is_none() {
            self.problems.add(at.problem(
                format!("{what} depends on a parameter"),
                "give a number; expressions of parameters may stand where the parameter is used",
            ));
        }
        Some((number.constant()?, measure))
    }
}
