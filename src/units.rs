//! The units in which the results of a run are shown. What the program computes, keeps and compares is in SI.

use crate::picture::corridor::Corridor;
use crate::table::{Column, Table};
use bryant_generator::model::Model;
use bryant_generator::model::units::{Unit, UnitSystem};
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// The SI unit of time.
pub const TIME: &str = "s";

/// The units of the columns of a run's table.
#[derive(Clone, Debug)]
pub struct Units {
    time: Unit,
    /// Name, SI unit and unit of each output.
    outputs: Vec<(String, String, Unit)>,
}

impl Units {
    /// Those of a model.
    pub fn of(model: &Model) -> Self {
        let outputs = model.outputs.iter();
        let outputs = outputs.map(|o| (o.name.clone(), o.unit.clone(), model.unit_of(o)));
        Units {
            time: model.units.system.unit(TIME),
            outputs: outputs.collect(),
        }
    }

    /// The unit of an output, by its index.
    ///
    /// # Panics
    /// There is no such output.
    pub fn output(&self, index: usize) -> &Unit {
        &self.outputs[index].2
    }

    /// The names of the table's columns with their units.
    pub fn columns(&self) -> Vec<(&str, &str)> {
        let time = ("time", self.time.name.as_str());
        let outputs = self.outputs.iter();
        let outputs = outputs.map(|(name, _, unit)| (name.as_str(), unit.name.as_str()));
        std::iter::once(time).chain(outputs).collect()
    }

    /// The names of the table's columns with their SI units.
    pub fn si_columns(&self) -> Vec<(&str, &str)> {
        let time = ("time", TIME);
        let outputs = self.outputs.iter();
        let outputs = outputs.map(|(name, si, _)| (name.as_str(), si.as_str()));
        std::iter::once(time).chain(outputs).collect()
    }

    /// The table of a run, time first, in these units.
    pub fn table(&self, si: &Table) -> Table {
        let units = std::iter::once(&self.time);
        let units = units.chain(self.outputs.iter().map(|(.., unit)| unit));
        let columns = si.columns.iter().zip(units);
        let columns = columns.map(|(column, unit)| Column {
            name: column.name.clone(),
            unit: unit.name.clone(),
            values: column.values.iter().map(|si| unit.of_si(*si)).collect(),
        });
        Table {
            columns: columns.collect(),
        }
    }

    /// A corridor in these units.
    pub fn corridor(&self, si: Corridor) -> Corridor {
        let own = self.outputs.iter().find(|(name, ..)| *name == si.of);
        let value = own.map_or(&self.time, |(.., unit)| unit);
        let [times, values] = si.bounds;
        Corridor {
            of: si.of,
            bounds: [
                times.map(|t| self.time.of_si(t)),
                values.map(|bound| value.of_si(bound)),
            ],
        }
    }
}

/// A number as people write it: without the last digits, which a conversion may change.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    format!("{}", rounded + 0.0)
}

/// A system of units, by its name.
pub fn system() -> impl TypedValueParser<Value = UnitSystem> {
    PossibleValuesParser::new(UnitSystem::NAMES)
        .map(|name| UnitSystem::named(&name).unwrap_or_default())
}
