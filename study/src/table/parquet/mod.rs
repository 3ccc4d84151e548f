//! The table as Apache Parquet: plain columns, with the same bytes whenever it is written. Its metadata have the units
//! and the identity of the results (`units`, `identity`, `model`, `version`, `arithmetic`).

mod file;
mod thrift;

use super::{TableError, numbers};
use crate::engine::Outcome;
use crate::results::{Batch, Results};
use crate::store::write::at;
use file::{Column, File, Values};
use std::io::{self, Write};
use std::path::Path;

/// Number of rows of a group, a multiple of every block size.
const GROUP: usize = 1 << 16;

/// A column of numbers.
pub struct Numbers<'a> {
    /// Its name, unique.
    pub name: &'a str,
    /// One value for each row.
    pub values: &'a [f64],
}

/// Writes a table of numbers; `name` is the name of the table.
///
/// # Errors
/// Those of `out`.
pub fn write_numbers(
    out: &mut dyn Write,
    name: &str,
    numbers: &[Numbers<'_>],
    metadata: &[(&str, String)],
) -> io::Result<()> {
    let rows = numbers.first().map_or(0, |column| column.values.len());
    let some = |range: std::ops::Range<usize>| -> Vec<Column<'_>> {
        let columns = numbers.iter().map(|column| Column {
            name: column.name.to_owned(),
            values: Values::Double(column.values[range.clone()].to_vec()),
        });
        columns.collect()
    };
    let mut file = File::new(out, name, some(0..0))?;
    for begin in (0..rows).step_by(GROUP) {
        file.group(some(begin..rows.min(begin + GROUP)))?;
    }
    file.close(metadata)
}

/// Writes the table.
pub fn write(
    out: &mut (dyn Write + Send),
    path: &Path,
    results: &Results<'_>,
) -> Result<(), TableError> {
    let mut file = at(path, File::new(out, "study", columns(results, &[])))?;
    let mut group: Vec<Batch> = Vec::new();
    let mut rows = 0;
    for batch in results.batches() {
        let batch = batch?;
        rows += batch.outcomes.runs.len();
        group.push(batch);
        if rows >= GROUP {
            at(path, file.group(columns(results, &group)))?;
            group.clear();
            rows = 0;
        }
    }
    if !group.is_empty() {
        at(path, file.group(columns(results, &group)))?;
    }
    at(path, file.close(&metadata(results)))?;
    Ok(())
}

fn metadata(results: &Results<'_>) -> [(&'static str, String); 5] {
    let identity = results.folder.identity();
    let units: serde_json::Map<String, serde_json::Value> = numbers(results.study)
        .into_iter()
        .map(|column| (column.name, column.unit.into()))
        .chain([("reached".to_owned(), "s".into())])
        .collect();
    [
        ("units", serde_json::Value::Object(units).to_string()),
        ("identity", identity.identity.clone()),
        ("model", identity.model.clone()),
        ("version", identity.version.clone()),
        ("arithmetic", identity.arithmetic.clone()),
    ]
}

/// The columns of some rows; empty columns if there are no rows.
fn columns<'a>(results: &Results<'_>, batches: &'a [Batch]) -> Vec<Column<'a>> {
    let mut columns = Vec::new();
    let mut add = |name: &str, values| {
        let name = name.to_owned();
        columns.push(Column { name, values });
    };
    let runs = || batches.iter().flat_map(|batch| &batch.outcomes.runs);
    let indices = batches.iter().flat_map(|batch| {
        let count = batch.outcomes.runs.len() as u64;
        batch.first..batch.first + count
    });
    add("run", Values::Long(indices.map(|row| row as i64).collect()));
    // column `index` of values that are stored row by row, `width` in each row
    let of = |lists: &dyn Fn(&Batch) -> Vec<f64>, width: usize, index: usize| {
        let values = batches.iter().flat_map(|batch| {
            let list = lists(batch);
            list.into_iter().skip(index).step_by(width)
        });
        Values::Double(values.collect())
    };
    let study = results.study;
    for (index, parameter) in study.varied.iter().enumerate() {
        let values = of(&|batch| batch.values.clone(), study.varied.len(), index);
        add(&parameter.name, values);
    }
    for (index, response) in study.responses.iter().enumerate() {
        let responses = |batch: &Batch| batch.outcomes.responses.clone();
        add(&response.name, of(&responses, study.responses.len(), index));
    }
    let double = |of: fn(&Outcome) -> f64| Values::Double(runs().map(of).collect());
    let words = runs().map(|run| run.status.word()).collect();
    add("status", Values::Word(words));
    add(
        "steps",
        Values::Count(runs().map(|run| run.steps).collect()),
    );
    add("reached", double(|run| run.reached));
    add("error estimate", double(|run| run.error));
    let reasons = batches.iter().flat_map(|batch| {
        let count = batch.outcomes.runs.len();
        (0..count).map(|run| batch.outcomes.reason(run))
    });
    add("reason", Values::Word(reasons.collect()));
    columns
}
