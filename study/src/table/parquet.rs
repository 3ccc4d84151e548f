//! The table as Apache Parquet: plain columns, the same bytes whenever it is written; units and what the results are of stand
//! in the metadata (`units`, `identity`, `model`, `version`, `arithmetic`).

use super::{Column, TableError, numbers};
use crate::engine::Outcome;
use crate::results::{Batch, Results};
use crate::store::write::WriteError;
use ::parquet::basic::{ConvertedType, Encoding, LogicalType, Repetition, Type as Physical};
use ::parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int32Type, Int64Type};
use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::{WriterProperties, WriterVersion};
use ::parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use ::parquet::schema::types::{ColumnPath, PrimitiveTypeBuilder, Type};
use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

/// Rows of a group, a multiple of every size of blocks.
const GROUP: usize = 1 << 16;

/// Writes the table.
pub fn write(
    out: &mut (dyn Write + Send),
    path: &Path,
    results: &Results<'_>,
) -> Result<(), TableError> {
    let failed = |error| failure(path, error);
    let columns = numbers(results.study);
    let schema = schema(&columns).map_err(failed)?;
    let properties = Arc::new(properties(results, &columns));
    let mut writer =
        SerializedFileWriter::new(out, Arc::new(schema), properties).map_err(failed)?;
    let mut group: Vec<Batch> = Vec::new();
    let mut rows = 0;
    for batch in results.batches() {
        let batch = batch?;
        rows += batch.outcomes.runs.len();
        group.push(batch);
        if rows >= GROUP {
            add(&mut writer, results, &group).map_err(failed)?;
            group.clear();
            rows = 0;
        }
    }
    if !group.is_empty() {
        add(&mut writer, results, &group).map_err(failed)?;
    }
    writer.close().map_err(failed)?;
    Ok(())
}

/// A disk that is full stays what it is, though the library has put it into an error of its own.
fn failure(path: &Path, error: ParquetError) -> TableError {
    let path = path.to_owned();
    match error {
        ParquetError::External(inner) => match inner.downcast::<io::Error>() {
            Ok(source) => TableError::Write(WriteError {
                path,
                source: *source,
            }),
            Err(inner) => TableError::Parquet {
                path,
                error: ParquetError::External(inner),
            },
        },
        error => TableError::Parquet { path, error },
    }
}

fn schema(columns: &[Column]) -> Result<Type, ParquetError> {
    let mut fields = vec![required("run", Physical::INT64).build()?];
    for Column { name, .. } in columns {
        fields.push(required(name, Physical::DOUBLE).build()?);
    }
    let text =
        required("status", Physical::BYTE_ARRAY).with_logical_type(Some(LogicalType::String));
    fields.push(text.with_converted_type(ConvertedType::UTF8).build()?);
    let count =
        required("steps", Physical::INT32).with_logical_type(Some(LogicalType::integer(32, false)));
    fields.push(count.with_converted_type(ConvertedType::UINT_32).build()?);
    fields.push(required("reached", Physical::DOUBLE).build()?);
    fields.push(required("error estimate", Physical::DOUBLE).build()?);
    let fields = fields.into_iter().map(Arc::new).collect();
    Type::group_type_builder("study")
        .with_fields(fields)
        .build()
}

fn properties(results: &Results<'_>, columns: &[Column]) -> WriterProperties {
    let identity = results.folder.identity();
    let units: serde_json::Map<String, serde_json::Value> = columns
        .iter()
        .map(|column| (column.name.clone(), column.unit.clone().into()))
        .chain([("reached".to_owned(), "s".into())])
        .collect();
    let text = |key: &str, value: String| KeyValue::new(key.to_owned(), value);
    WriterProperties::builder()
        .set_writer_version(WriterVersion::PARQUET_1_0)
        .set_created_by("bryant".into())
        .set_encoding(Encoding::PLAIN)
        // few numbers come twice, but all words do
        .set_dictionary_enabled(false)
        .set_column_dictionary_enabled(ColumnPath::from("status"), true)
        .set_key_value_metadata(Some(vec![
            text("units", serde_json::Value::Object(units).to_string()),
            text("identity", identity.identity.clone()),
            text("model", identity.model.clone()),
            text("version", identity.version.clone()),
            text("arithmetic", identity.arithmetic.clone()),
        ]))
        .build()
}

fn required(name: &str, physical: Physical) -> PrimitiveTypeBuilder<'_> {
    Type::primitive_type_builder(name, physical).with_repetition(Repetition::REQUIRED)
}

/// A group of rows, column after column.
fn add<W: Write + Send>(
    writer: &mut SerializedFileWriter<W>,
    results: &Results<'_>,
    batches: &[Batch],
) -> Result<(), ParquetError> {
    let mut group = writer.next_row_group()?;
    let runs = || batches.iter().flat_map(|batch| &batch.outcomes.runs);
    let count = |batch: &Batch| batch.outcomes.runs.len() as u64;
    let index = batches
        .iter()
        .flat_map(|batch| batch.first..batch.first + count(batch));
    column::<Int64Type>(&mut group, index.map(|row| row as i64).collect())?;
    let d = results.study.varied.len();
    for parameter in 0..d {
        let of = |batch: &Batch| -> Vec<f64> {
            batch
                .values
                .iter()
                .skip(parameter)
                .step_by(d)
                .copied()
                .collect()
        };
        column::<DoubleType>(&mut group, batches.iter().flat_map(of).collect())?;
    }
    let width = results.study.responses.len();
    for response in 0..width {
        let of = |batch: &Batch| -> Vec<f64> {
            batch
                .outcomes
                .responses
                .iter()
                .skip(response)
                .step_by(width)
                .copied()
                .collect()
        };
        column::<DoubleType>(&mut group, batches.iter().flat_map(of).collect())?;
    }
    let word = |run: &Outcome| ByteArray::from(run.status.word());
    column::<ByteArrayType>(&mut group, runs().map(word).collect())?;
    column::<Int32Type>(
        &mut group,
        runs().map(|run| run.steps.cast_signed()).collect(),
    )?;
    column::<DoubleType>(&mut group, runs().map(|run| run.reached).collect())?;
    column::<DoubleType>(&mut group, runs().map(|run| run.error).collect())?;
    group.close()?;
    Ok(())
}

fn column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, impl Write + Send>,
    values: Vec<T::T>,
) -> Result<(), ParquetError> {
    let mut writer = group
        .next_column()?
        .ok_or_else(|| ParquetError::General("the schema has too few columns".into()))?;
    writer.typed::<T>().write_batch(&values, None, None)?;
    writer.close()
}
