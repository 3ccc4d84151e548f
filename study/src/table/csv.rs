//! The table as CSV: units are in the headings, and numbers have the fewest digits that read back exactly; a number
//! that is not finite is an empty cell.

use super::{TableError, numbers};
use crate::results::Results;
use crate::store::write::at;
use std::io::{self, Write};
use std::path::Path;

/// Writes the table.
pub fn write(out: &mut dyn Write, path: &Path, results: &Results<'_>) -> Result<(), TableError> {
    let mut writer = ::csv::Writer::from_writer(out);
    let columns = numbers(results.study);
    let mut headings = vec!["run".to_owned()];
    headings.extend(
        columns
            .iter()
            .map(|column| heading(&column.name, &column.unit)),
    );
    headings
        .extend(["status", "steps", "reached [s]", "error estimate", "reason"].map(str::to_owned));
    at(
        path,
        writer.write_record(&headings).map_err(io::Error::from),
    )?;
    let d = results.study.varied.len();
    for batch in results.batches() {
        let batch = batch?;
        for (k, outcome) in batch.outcomes.runs.iter().enumerate() {
            let mut fields = vec![(batch.first + k as u64).to_string()];
            let values = &batch.values[k * d..(k + 1) * d];
            fields.extend(
                values
                    .iter()
                    .chain(batch.outcomes.of(k))
                    .copied()
                    .map(number),
            );
            fields.push(outcome.status.word().to_owned());
            fields.push(outcome.steps.to_string());
            fields.push(number(outcome.reached));
            fields.push(number(outcome.error));
            fields.push(batch.outcomes.reason(k).to_owned());
            at(path, writer.write_record(&fields).map_err(io::Error::from))?;
        }
    }
    at(path, writer.flush())?;
    Ok(())
}

/// Name and unit in one line.
pub fn heading(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} [{unit}]")
    }
}

/// The fewest digits that read back exactly; empty for a number that is not finite.
pub fn number(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
