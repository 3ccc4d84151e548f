//! Time series of runs for which the study keeps them: `series/run-00000017.csv`, a column for each output.

use crate::design::Sampler;
use crate::engine::{Engine, EngineError, Series};
use crate::run::Failure;
use crate::shard::Shard;
use crate::store::Folder;
use crate::store::write::{WriteError, at, replace};
use crate::study::Study;
use crate::table::csv::{heading, number};
use bryant_generator::description::load::open_file;
use bryant_generator::model::units::Unit;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Writes the missing series of a shard; returns how many were written.
pub(crate) fn write(
    study: &Study,
    sampler: &Sampler<'_>,
    engine: &dyn Engine,
    folder: &Folder,
    shard: Shard,
) -> Result<u64, Failure> {
    let blocks = folder.blocks();
    let every = study.keep.every.unwrap_or(u64::MAX);
    let regular = (0..study.rows).step_by(usize::try_from(every).unwrap_or(usize::MAX));
    let regular = regular.take_while(|_| study.keep.every.is_some());
    let listed = study
        .keep
        .runs
        .iter()
        .copied()
        .filter(|row| row % every != 0 || study.keep.every.is_none());
    let kept = regular
        .chain(listed)
        .filter(|row| shard.has(row / blocks.size));
    let mut worker = None;
    let mut values = vec![0.0; study.varied.len()];
    let mut written = 0;
    for row in kept {
        let path = path(folder.path(), row);
        if is_whole(&path, &headings(study)) {
            continue;
        }
        if engine.stops() {
            break;
        }
        let worker = match &mut worker {
            Some(worker) => worker,
            none => none.insert(engine.worker()?),
        };
        sampler.values(row, &mut values);
        let series = worker.series(&values)?;
        at(&path, std::fs::create_dir_all(folder.path().join("series")))?;
        let columns = columns(study, series)?;
        replace(&path, |out| -> Result<(), WriteError> {
            at(&path, table(out, &headings(study), &columns))
        })?;
        written += 1;
    }
    Ok(written)
}

/// The file with the series of a run.
pub fn path(folder: &Path, row: u64) -> PathBuf {
    folder.join("series").join(format!("run-{row:08}.csv"))
}

/// Headings of all columns.
fn headings(study: &Study) -> Vec<String> {
    let time = study.keep.time.as_ref().map_or("s", |unit| &unit.name);
    let kept = study.keep.outputs.iter();
    let kept = kept.map(|output| heading(&output.name, &output.unit.name));
    std::iter::once(heading("time", time)).chain(kept).collect()
}

/// The times and the outputs that are kept, in their units.
fn columns(study: &Study, series: Series) -> Result<Vec<Vec<f64>>, EngineError> {
    let Series { times, outputs } = series;
    let shown = |unit: &Unit, si: &[f64]| si.iter().map(|si| unit.of_si(*si)).collect();
    let kept = study.keep.outputs.iter().map(|kept| {
        let values = outputs.get(kept.index);
        let values = values.filter(|values| values.len() == times.len());
        let missing = || EngineError(format!("the engine has no series of output {}", kept.index));
        Ok(shown(&kept.unit, values.ok_or_else(missing)?))
    });
    let kept: Vec<Vec<f64>> = kept.collect::<Result<_, EngineError>>()?;
    let times = match &study.keep.time {
        Some(unit) => shown(unit, &times),
        None => times,
    };
    Ok(std::iter::once(times).chain(kept).collect())
}

/// True if the file exists with these columns. An existing file is complete, but it may be from a time when other
/// outputs were kept.
fn is_whole(path: &Path, headings: &[String]) -> bool {
    let mut expected = Vec::new();
    let (Ok(file), Ok(())) = (open_file(path), record(&mut expected, headings)) else {
        return false;
    };
    let mut begin = Vec::new();
    let read = file.take(expected.len() as u64).read_to_end(&mut begin);
    read.is_ok() && begin == expected
}

fn record(out: &mut dyn io::Write, fields: &[String]) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    writer.write_record(fields)?;
    writer.flush()
}

fn table(out: &mut dyn io::Write, headings: &[String], columns: &[Vec<f64>]) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    writer.write_record(headings)?;
    for k in 0..columns[0].len() {
        writer.write_record(columns.iter().map(|column| number(column[k])))?;
    }
    writer.flush()
}
