//! The derivatives as a table for people, and as JSON.

use super::slopes::{SMALL, size};
use crate::accuracy::conclusion::percent;
use crate::command::response::Requested;
use crate::quantity::dimension;
use bryant_generator::description::unit::Dimension;
use bryant_generator::model::Parameter;
use bryant_picture::text::typeset;
use serde_json::json;

/// Differences disagree if they are off by more than this share of the largest derivative.
pub(super) const AGREE: f64 = 1e-2;
/// The derivatives of some responses with respect to some parameters.
pub(super) struct Table<'a> {
    pub responses: &'a [Requested],
    pub parameters: &'a [&'a Parameter],
    /// The values of the parameters.
    pub row: &'a [f64],
    /// The values of the responses.
    pub values: &'a [f64],
    /// The derivatives of all responses, one parameter after the other.
    pub slopes: &'a [f64],
    /// The same by differences, for the first parameters or for all.
    pub checked: Option<&'a [f64]>,
}

impl Table<'_> {
    fn slope(&self, response: usize, parameter: usize) -> f64 {
        self.slopes[parameter * self.responses.len() + response]
    }

    fn check(&self, response: usize, parameter: usize) -> Option<f64> {
        let checked = self.checked?;
        checked
            .get(parameter * self.responses.len() + response)
            .copied()
    }

    pub fn text(&self) -> String {
        let mut text = String::new();
        for (k, response) in self.responses.iter().enumerate() {
            let unit = with_unit(&response.unit);
            text += &format!("{}: {}{unit}\n", response.name, number(self.values[k]));
            let mut lines = vec![
                ["parameter", "value", "derivative", "by 1 %", "difference"].map(String::from),
            ];
            for (i, parameter) in self.parameters.iter().enumerate() {
                let slope = self.slope(k, i);
                let elasticity = slope * self.row[i] / self.values[k];
                lines.push([
                    parameter.name.clone(),
                    number(self.row[i]) + &with_unit(&parameter.unit),
                    number(slope) + &with_unit(&quotient(&response.unit, &parameter.unit)),
                    match elasticity {
                        // a zero has no sign
                        0.0 => "0 %".into(),
                        _ if elasticity.is_finite() => format!("{elasticity:+.4} %"),
                        _ => "-".into(),
                    },
                    self.check(k, i).map_or_else(String::new, number),
                ]);
            }
            let columns = 4 + usize::from(self.checked.is_some());
            let width = |column: usize| {
                let widths = lines.iter().map(|line| line[column].chars().count());
                widths.max().unwrap_or(0)
            };
            let widths: Vec<usize> = (0..columns).map(width).collect();
            for line in &lines {
                let cells = line.iter().zip(&widths).enumerate();
                let cells = cells.map(|(column, (cell, width))| match column {
                    0 => format!("{cell:<width$}"),
                    _ => format!("{cell:>width$}"),
                });
                text += &format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end());
            }
            if let Some(worst) = self.disagreement(k) {
                let worst_of = percent(worst);
                text += &match worst <= AGREE {
                    true => format!("  differences agree within {worst_of} of the largest\n"),
                    false => format!(
                        "  differences disagree by {worst_of} of the largest: a response has a kink or a jump near these values\n"
                    ),
                };
            }
            text.push('\n');
        }
        text
    }

    /// How far the derivatives of a response are from the differences, relative to the largest change of the response that any parameter
    /// makes by either of the two, or to 1 % of the response: what is far less cannot be told from 0 by differences of runs.
    fn disagreement(&self, response: usize) -> Option<f64> {
        self.checked?;
        let change = |i: usize, slope: f64| (slope * size(self.parameters[i], self.row[i])).abs();
        let all = 0..self.parameters.len();
        let largest = all.clone().map(|i| {
            let difference = self.check(response, i).unwrap_or(0.0);
            change(i, self.slope(response, i)).max(change(i, difference))
        });
        let least = SMALL * self.values[response].abs();
        let largest = largest.fold(least.max(f64::MIN_POSITIVE), f64::max);
        let off = all.filter_map(|i| {
            let difference = self.check(response, i)?;
            Some(change(i, self.slope(response, i) - difference) / largest)
        });
        // what is no number stays
        Some(
            off.fold(0.0, |worst, off| match off > worst || off.is_nan() {
                true => off,
                false => worst,
            }),
        )
    }

    /// How far the derivatives of any response are from the differences; `None` if they were not compared.
    pub fn worst(&self) -> Option<f64> {
        let all = (0..self.responses.len()).filter_map(|k| self.disagreement(k));
        all.reduce(|a, b| match a.is_nan() {
            true => a,
            false => a.max(b),
        })
    }

    pub fn json(&self) -> serde_json::Value {
        let responses = self.responses.iter().enumerate().map(|(k, response)| {
            let parameters = self.parameters.iter().enumerate().map(|(i, parameter)| {
                let mut value = json!({
                    "name": parameter.name,
                    "value": self.row[i],
                    "unit": parameter.unit,
                    "derivative": self.slope(k, i),
                    "derivative_unit": quotient(&response.unit, &parameter.unit),
                });
                if let Some(difference) = self.check(k, i) {
                    value["difference"] = json!(difference);
                }
                value
            });
            let mut value = json!({
                "response": response.name,
                "value": self.values[k],
                "unit": response.unit,
                "parameters": parameters.collect::<Vec<_>>(),
            });
            if let Some(worst) = self.disagreement(k) {
                value["disagreement"] = json!(worst);
            }
            value
        });
        json!({ "responses": responses.collect::<Vec<_>>() })
    }
}

/// A number with seven digits.
pub(in crate::command) fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".into(),
        _ if (1e-3..1e6).contains(&size) => {
            let decimals = (6 - libm::log10(size).floor() as i32).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.6e}"),
    }
}

fn with_unit(unit: &str) -> String {
    match unit {
        "" => String::new(),
        unit => format!(" {}", typeset(unit)),
    }
}

/// The SI unit of a response in one SI unit divided by a parameter in another.
fn quotient(above: &str, below: &str) -> String {
    let dimension = |unit: &str| dimension(unit).unwrap_or(Dimension::ONE);
    (dimension(above) / dimension(below)).to_string()
}

#[cfg(test)]
mod tests {
    use super::{number, quotient};

    #[test]
    fn numbers_have_seven_digits() {
        assert_eq!(number(1234.5678), "1234.568");
        assert_eq!(number(-0.25), "-0.2500000");
        assert_eq!(number(1e-9), "1.000000e-9");
        assert_eq!(quotient("N", "m"), "N/m");
        assert_eq!(quotient("N", "N"), "");
        assert_eq!(quotient("", "m"), "1/m");
        assert_eq!(quotient("m/s^2", ""), "m/s^2");
        assert_eq!(quotient("N", "N/m"), "m");
    }
}
