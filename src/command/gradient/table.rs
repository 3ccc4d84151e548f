//! The derivatives as a table for people, and as JSON.

use super::slopes::{SMALL, size};
use crate::accuracy::conclusion::percent;
use crate::command::response::Requested;
use crate::quantity::dimension;
use crate::units::short;
use bryant_generator::description::unit::Dimension;
use bryant_generator::model::Parameter;
use bryant_generator::model::units::Unit;
use bryant_picture::text::typeset;
use serde_json::json;

/// Differences disagree if they are off by more than this share of the largest derivative.
pub(super) const AGREE: f64 = 1e-2;
/// The derivatives of some responses with respect to some parameters.
pub(super) struct Table<'a> {
    pub responses: &'a [Requested],
    pub parameters: &'a [&'a Parameter],
    /// The units in which the parameters are shown.
    pub units: &'a [Unit],
    /// The values of the parameters.
    pub row: &'a [f64],
    /// The values of the responses.
    pub values: &'a [f64],
    /// The derivatives of all responses, one parameter after the other.
    pub slopes: &'a [f64],
    /// The same by differences, for the first parameters or for all.
    pub checked: Option<&'a [f64]>,
    /// The estimated error of each response and its derivatives, as a share of the largest change or of the response,
    /// if it is known.
    pub error: Option<f64>,
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

    /// The slope of a response with respect to a parameter in the units in which both are shown, or the difference in
    /// its place.
    fn shown(&self, slope: f64, response: usize, parameter: usize) -> f64 {
        let [above, below] = [&self.responses[response].unit, &self.units[parameter]];
        // in SI all digits stay as they are
        match below.size / above.size {
            1.0 => slope,
            size => slope * size,
        }
    }

    /// The estimated errors of a response and of the changes that parameters make of it.
    fn errors(&self, response: usize) -> [Option<f64>; 2] {
        let changes = (0..self.parameters.len())
            .map(|i| self.slope(response, i) * size(self.parameters[i], self.row[i]));
        let largest = changes.fold(0.0, |largest: f64, change| largest.max(change.abs()));
        let value = self.values[response].abs();
        [value, SMALL * value].map(|least| Some(self.error? * largest.max(least)))
    }

    pub fn text(&self) -> String {
        let mut text = String::new();
        for (k, response) in self.responses.iter().enumerate() {
            let unit = with_unit(&response.unit.name);
            let value = self.values[k];
            let [error, of_changes] = self.errors(k);
            let shown = number(response.unit.of_si(value), known_digits(value, error));
            text += &format!("{}: {shown}{unit}\n", response.name);
            let mut lines = vec![
                ["parameter", "value", "derivative", "by 1 %", "difference"].map(String::from),
            ];
            for (i, parameter) in self.parameters.iter().enumerate() {
                let slope = self.slope(k, i);
                let unit = &self.units[i];
                let change = slope * size(parameter, self.row[i]);
                let digits = known_digits(change, of_changes);
                let elasticity = slope * self.row[i] / value;
                lines.push([
                    parameter.name.clone(),
                    short(unit.of_si(self.row[i])) + &with_unit(&unit.name),
                    number(self.shown(slope, k, i), digits)
                        + &with_unit(&quotient(&response.unit, unit)),
                    match elasticity {
                        // a zero has no sign
                        0.0 => "0 %".into(),
                        _ if elasticity.is_finite() => format!("{elasticity:+.4} %"),
                        _ => "-".into(),
                    },
                    self.check(k, i)
                        .map_or_else(String::new, |slope| number(self.shown(slope, k, i), digits)),
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

    /// How far the derivatives of a response are from the differences, relative to the largest change of the response
    /// that any parameter makes by either of the two, or to 1 % of the response: what is far less cannot be told from 0
    /// by differences of runs.
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
                let unit = &self.units[i];
                let mut value = json!({
                    "name": parameter.name,
                    "value": unit.of_si(self.row[i]),
                    "unit": unit.name,
                    "derivative": self.shown(self.slope(k, i), k, i),
                    "derivative_unit": quotient(&response.unit, unit),
                });
                if let Some(difference) = self.check(k, i) {
                    value["difference"] = json!(self.shown(difference, k, i));
                }
                value
            });
            let mut value = json!({
                "response": response.name,
                "value": response.unit.of_si(self.values[k]),
                "unit": response.unit.name,
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

/// So many digits are shown where the error of a number does not say less.
const DIGITS: usize = 5;

/// The digits of a value that its error supports: at least one, and at most `DIGITS`.
pub fn known_digits(value: f64, error: Option<f64>) -> usize {
    let Some(error) = error.filter(|error| error.is_finite()) else {
        return DIGITS;
    };
    // an error of 1e-4 of the value supports four digits
    let digits = -libm::log10(error / value.abs()).ceil();
    match digits.is_nan() {
        true => DIGITS,
        false => (digits.max(1.0) as usize).min(DIGITS),
    }
}

/// A number with so many digits.
pub fn number(value: f64, digits: usize) -> String {
    let size = value.abs();
    let behind = digits.saturating_sub(1);
    match size {
        0.0 => "0".into(),
        _ if (1e-3..1e6).contains(&size) => {
            let decimals = (behind as i32 - libm::log10(size).floor() as i32).max(0) as usize;
            format!("{value:.decimals$}")
        }
        _ => format!("{value:.behind$e}"),
    }
}

fn with_unit(unit: &str) -> String {
    match unit {
        "" => String::new(),
        unit => format!(" {}", typeset(unit)),
    }
}

/// The unit of a response in one unit divided by a parameter in another.
pub fn quotient(above: &Unit, below: &Unit) -> String {
    let dimension = |unit: &Unit| dimension(&unit.name).unwrap_or(Dimension::ONE);
    match (above.name.as_str(), below.name.as_str()) {
        _ if above.size == 1.0 && below.size == 1.0 => {
            (dimension(above) / dimension(below)).to_string()
        }
        (above, below) if above == below => String::new(),
        (above, "") => above.to_owned(),
        ("", below) if below.contains(['*', '/']) => format!("1/({below})"),
        ("", below) => format!("1/{below}"),
        (above, below) if below.contains(['*', '/']) => format!("{above}/({below})"),
        (above, below) => format!("{above}/{below}"),
    }
}
