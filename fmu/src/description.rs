//! `modelDescription.xml`: what an importer knows of an FMU.

use crate::instance::starts;
use crate::setting::{Setting, token};
use crate::variables::{Of, TIME, Variable, variables};
use bryant_engine::Engine;
use bryant_runtime::Info;
use std::collections::BTreeSet;
use std::fmt::Write;

/// A version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Two,
    /// FMI 3.0.
    Three,
}

impl Version {
    /// As the standard writes it.
    pub fn name(self) -> &'static str {
        match self {
            Version::Two => "2.0",
            Version::Three => "3.0",
        }
    }
}

/// The description of an FMU with these resources. `identifier` is the name of its shared library, `about` a sentence
/// about the model, or nothing.
pub fn description(
    version: Version,
    engine: &Engine,
    setting: &Setting,
    identifier: &str,
    about: &str,
) -> String {
    let info = engine.info();
    let token = token(&engine.keep(), &setting.written());
    let variables = variables(info);
    let starts = starts(info, setting);
    let mut xml = Xml(String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"));
    let two = version == Version::Two;
    let tool = concat!("bryant ", env!("CARGO_PKG_VERSION"));
    let token_key = if two { "guid" } else { "instantiationToken" };
    xml.line(
        0,
        "<fmiModelDescription",
        &[
            ("fmiVersion", version.name()),
            ("modelName", info.name),
            (token_key, &token),
            ("description", about),
            ("generationTool", tool),
            ("variableNamingConvention", "flat"),
        ],
        ">",
    );
    let mut abilities = vec![
        ("modelIdentifier", identifier),
        ("canHandleVariableCommunicationStepSize", "true"),
    ];
    if two {
        abilities.push(("canNotUseMemoryManagementFunctions", "true"));
    }
    xml.line(1, "<CoSimulation", &abilities, "/>");

    xml.units(&variables);
    xml.line(1, "<LogCategories", &[], ">");
    for name in ["logStatusWarning", "logStatusError"] {
        xml.line(2, "<Category", &[("name", name)], "/>");
    }
    xml.line(1, "</LogCategories", &[], ">");
    xml.line(
        1,
        "<DefaultExperiment",
        &[
            ("startTime", &setting.begin().to_string()),
            ("stopTime", &setting.stop.to_string()),
            ("stepSize", &setting.every.to_string()),
        ],
        "/>",
    );

    xml.variables(two, info, &variables, &starts);
    xml.structure(two, &variables);
    xml.line(0, "</fmiModelDescription", &[], ">");
    xml.0
}

/// A text in XML.
struct Xml(String);

impl Xml {
    /// A tag in a line of its own; attributes without a value are left out.
    fn line(&mut self, depth: usize, begin: &str, attributes: &[(&str, &str)], end: &str) {
        let _ = write!(self.0, "{:1$}{begin}", "", 2 * depth);
        for (name, value) in attributes.iter().filter(|(_, value)| !value.is_empty()) {
            let _ = write!(self.0, " {name}=\"{}\"", escaped(value));
        }
        self.0.push_str(end);
        self.0.push('\n');
    }

    /// The units of variables, with their base units.
    fn units(&mut self, variables: &[Variable]) {
        let units: BTreeSet<&str> = variables
            .iter()
            .map(|of| of.unit.as_str())
            .chain(["s"])
            .collect();
        self.line(1, "<UnitDefinitions", &[], ">");
        for unit in units.into_iter().filter(|unit| !unit.is_empty()) {
            self.line(2, "<Unit", &[("name", unit)], ">");
            if let Some(base) = base_unit(unit) {
                let base: Vec<_> = base
                    .iter()
                    .map(|(name, power)| (*name, power.to_string()))
                    .collect();
                let base: Vec<_> = base
                    .iter()
                    .map(|(name, power)| (*name, &power[..]))
                    .collect();
                self.line(3, "<BaseUnit", &base, "/>");
            }
            self.line(2, "</Unit", &[], ">");
        }
        self.line(1, "</UnitDefinitions", &[], ">");
    }

    /// Time, then all variables. `starts` has the values of parameters and inputs.
    fn variables(&mut self, two: bool, info: &Info, variables: &[Variable], starts: &[f64]) {
        self.line(1, "<ModelVariables", &[], ">");
        let independent = [("causality", "independent"), ("variability", "continuous")];
        self.variable(two, TIME, 0, &independent, &[("unit", "s")]);
        for (index, variable) in variables.iter().enumerate() {
            let kept = match variable.of {
                Of::Parameter(index) | Of::Input(index) => Some(&info.parameters[index]),
                _ => None,
            };
            let start = kept.map(|_| match variable.of {
                Of::Parameter(index) | Of::Input(index) => starts[index].to_string(),
                _ => String::new(),
            });
            let (min, max) = (kept.map(|of| of.min), kept.map(|of| of.max));
            let [min, max] =
                [min, max].map(|bound| bound.filter(|of| of.is_finite()).map(|of| of.to_string()));
            let of_kind: &[(&str, &str)] = match variable.of {
                Of::Parameter(_) => &[
                    ("causality", "parameter"),
                    ("variability", "fixed"),
                    ("initial", "exact"),
                ],
                Of::Input(_) => &[("causality", "input"), ("variability", "continuous")],
                Of::Output(_) => &[
                    ("causality", "output"),
                    ("variability", "continuous"),
                    ("initial", "calculated"),
                ],
                Of::State(_) => &[
                    ("causality", "local"),
                    ("variability", "continuous"),
                    ("initial", "calculated"),
                ],
            };
            let optional = [
                (
                    "unit",
                    Some(variable.unit.as_str()).filter(|unit| !unit.is_empty()),
                ),
                ("min", min.as_deref()),
                ("max", max.as_deref()),
                ("start", start.as_deref()),
            ];
            let number: Vec<_> = optional
                .into_iter()
                .filter_map(|(key, value)| Some((key, value?)))
                .collect();
            self.variable(two, &variable.name, index + 1, of_kind, &number);
        }
        self.line(1, "</ModelVariables", &[], ">");
    }

    /// What the importer may ask for: the outputs.
    fn structure(&mut self, two: bool, variables: &[Variable]) {
        self.line(1, "<ModelStructure", &[], ">");
        let outputs: Vec<String> = variables
            .iter()
            .enumerate()
            .filter(|(_, variable)| matches!(variable.of, Of::Output(_)))
            // references from 1, behind the time; indices of variables in FMI 2.0 begin at 1, with the time
            .map(|(index, _)| (index + if two { 2 } else { 1 }).to_string())
            .collect();
        if two && !outputs.is_empty() {
            for list in ["Outputs", "InitialUnknowns"] {
                self.line(2, &format!("<{list}"), &[], ">");
                for index in &outputs {
                    self.line(3, "<Unknown", &[("index", index)], "/>");
                }
                self.line(2, &format!("</{list}"), &[], ">");
            }
        } else {
            for element in ["<Output", "<InitialUnknown"] {
                for reference in &outputs {
                    self.line(2, element, &[("valueReference", reference)], "/>");
                }
            }
        }
        self.line(1, "</ModelStructure", &[], ">");
    }

    /// A variable: in FMI 2.0 with an element for its number, in 3.0 as one.
    fn variable(
        &mut self,
        two: bool,
        name: &str,
        reference: usize,
        kind: &[(&str, &str)],
        number: &[(&str, &str)],
    ) {
        let reference = reference.to_string();
        let named = [("name", name), ("valueReference", &reference)];
        let head = [&named, kind].concat();
        if two {
            self.line(2, "<ScalarVariable", &head, ">");
            self.line(3, "<Real", number, "/>");
            self.line(2, "</ScalarVariable", &[], ">");
        } else {
            self.line(2, "<Float64", &[&head, number].concat(), "/>");
        }
    }
}

/// A text as the value of an attribute.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for letter in text.chars() {
        match letter {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\n' | '\t' => escaped.push(' '),
            letter => escaped.push(letter),
        }
    }
    escaped
}

/// Base units with their powers.
type Base = Vec<(&'static str, i32)>;

/// An SI unit as powers of base units, such as N*m/rad or m/s^2; `None` for one that is not made of the units below.
fn base_unit(unit: &str) -> Option<Base> {
    let mut base: Base = ["kg", "m", "s", "K", "rad"].map(|name| (name, 0)).to_vec();
    let (above, below) = unit.split_once('/').unwrap_or((unit, ""));
    let below = below.trim_start_matches('(').trim_end_matches(')');
    for (product, sign) in [(above, 1), (below, -1)] {
        for factor in product
            .split('*')
            .filter(|factor| !matches!(*factor, "" | "1"))
        {
            let (symbol, power) = factor.split_once('^').unwrap_or((factor, "1"));
            let power: i32 = power.parse().ok()?;
            for (name, times) in SYMBOLS.iter().find(|(of, _)| *of == symbol)?.1 {
                let (_, sum) = base.iter_mut().find(|(of, _)| of == name)?;
                *sum += sign * power * times;
            }
        }
    }
    base.retain(|(_, power)| *power != 0);
    Some(base)
}

/// Symbols of units in base units.
const SYMBOLS: [(&str, &[(&str, i32)]); 9] = [
    ("kg", &[("kg", 1)]),
    ("m", &[("m", 1)]),
    ("s", &[("s", 1)]),
    ("K", &[("K", 1)]),
    ("rad", &[("rad", 1)]),
    ("N", &[("kg", 1), ("m", 1), ("s", -2)]),
    ("J", &[("kg", 1), ("m", 2), ("s", -2)]),
    ("W", &[("kg", 1), ("m", 2), ("s", -3)]),
    ("Pa", &[("kg", 1), ("m", -1), ("s", -2)]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_powers_of_base_units() {
        assert_eq!(
            base_unit("N*m/rad").unwrap(),
            [("kg", 1), ("m", 2), ("s", -2), ("rad", -1)]
        );
        assert_eq!(base_unit("kg*m^2").unwrap(), [("kg", 1), ("m", 2)]);
        assert_eq!(
            base_unit("J/(kg*K)").unwrap(),
            [("m", 2), ("s", -2), ("K", -1)]
        );
        assert_eq!(base_unit("m/s^2").unwrap(), [("m", 1), ("s", -2)]);
        assert_eq!(base_unit("1/s").unwrap(), [("s", -1)]);
        assert_eq!(base_unit("furlong"), None);
    }

    #[test]
    fn names_cannot_break_the_text() {
        assert_eq!(escaped("a<\"b\">&\n"), "a&lt;&quot;b&quot;&gt;&amp; ");
    }
}
