//! The files of a run, and the output that is printed instead of the table.

use super::scene::Shown;
use super::{Arguments, Error, Terminal};
use crate::command::model_argument::Found;
use crate::command::outputs::{Outputs, is_standard};
use crate::files;
use crate::picture::corridor::Corridor;
use crate::picture::plot::Request;
use crate::picture::{self, Arrangement, Format, View};
use crate::scene::needs_forces;
use crate::signature::ContentKind;
use crate::simulation::Recording;
use crate::state_file;
use crate::table::{Layout, Table};
use crate::units::Units;
use bryant_generator::model::{Dimension, Model};
use bryant_signal::filter::{Standard, class_of_code, filtered};
use bryant_signal::mme::{self, About};
use bryant_signal::{Channel, Signal};
use bryant_study::table::parquet::{Numbers, write_numbers};
use std::path::{Path, PathBuf};

/// A requested plot, and its file.
type Plot = (Request, PathBuf);

/// The files that a run writes, and the output that it prints.
pub struct Files {
    csv: Option<PathBuf>,
    final_state: Option<PathBuf>,
    mme: Option<PathBuf>,
    picture: Option<PathBuf>,
    plots: Vec<Plot>,
    corridors: Vec<Corridor>,
}

impl Files {
    /// The files that the user requests, and those that are written by default.
    ///
    /// # Errors
    /// Two results go to one place, a result goes to a file that the command reads, or a plot needs a column that does
    /// not exist.
    pub fn of(arguments: &Arguments, found: &Found) -> Result<Self, Error> {
        let model = &found.model;
        let view = arguments.view.unwrap_or_default();
        if model.dimension == Dimension::Plane && view != View::Side {
            return Err(Error::Input(format!(
                "--view {}: {} is planar and is seen from the side only\n  help: leave out --view",
                view.name(),
                model.name
            )));
        }
        let directory = arguments.out.clone().unwrap_or_default();
        let read = found.files.iter().chain(&arguments.start);
        let read = read.chain(&arguments.measured).chain(&arguments.responses);
        let mut outputs = Outputs::of(read, arguments.replacing);
        if arguments.json {
            outputs.take("--json", Path::new("-"), ContentKind::Table)?;
        }
        let mut place =
            |option: &str, named: &Option<PathBuf>, (extension, kind): (&str, ContentKind)| {
                let usual = || directory.join(format!("{}.{extension}", model.name));
                let path = match named {
                    Some(path) => Some(path.clone()),
                    None => (!arguments.no_files).then(usual),
                };
                if let Some(path) = &path {
                    outputs.take(option, path, kind)?;
                }
                Ok(path)
            };
        let csv = place("--csv", &arguments.csv, ("csv", ContentKind::Table))?;
        let final_state = arguments.final_state.clone();
        let ending = (arguments.pictures.ending(), ContentKind::Picture);
        let picture = place("--picture", &arguments.picture, ending)?;
        if let Some(path) = &final_state {
            outputs.take("--final-state", path, ContentKind::State)?;
        }
        if let Some(folder) = &arguments.mme {
            let test = folder.join(format!("{}.mme", model.name));
            outputs.take("--mme", &test, ContentKind::Test)?;
            has_equal_intervals(arguments, model)?;
        }
        let binary = [
            ("--parquet", &arguments.parquet, ContentKind::Parquet),
            ("--animation", &arguments.animation, ContentKind::Animation),
        ];
        for (option, path, kind) in binary {
            let Some(path) = path else { continue };
            if is_standard(path) {
                return Err(Error::Input(format!(
                    "{option} -: the file is not text and cannot be printed\n  help: name a file"
                )));
            }
            outputs.take(option, path, kind)?;
        }
        if let Some(path) = &arguments.report {
            outputs.take_report(path)?;
        }
        let (plots, corridors) = plots(arguments, model, &directory, &mut outputs)?;
        Ok(Files {
            csv,
            final_state,
            mme: arguments.mme.clone(),
            picture,
            plots,
            corridors,
        })
    }

    /// Writes the files; returns their paths.
    ///
    /// # Errors
    /// A file cannot be written, or a picture cannot be drawn.
    pub fn write(
        &self,
        arguments: &Arguments,
        shown: &Shown<'_>,
        (recording, table): (&Recording, &Table),
        terminal: &Terminal,
    ) -> Result<Vec<PathBuf>, Error> {
        let model = &shown.found.model;
        let file = |path: &Option<PathBuf>| path.clone().filter(|path| !is_standard(path));
        let mut written = Vec::new();
        if let Some(path) = file(&self.csv) {
            files::replace(&path, |out| table.write_csv(out)).map_err(Error::system)?;
            written.push(path);
        }
        if let Some(path) = file(&self.final_state).filter(|_| !recording.last_state.is_empty()) {
            let state = state_file::text(recording);
            files::replace(&path, |out| out.write_all(state.as_bytes())).map_err(Error::system)?;
            written.push(path);
        }
        if let Some(folder) = &self.mme {
            written.push(write_mme(folder, model, recording)?);
        }
        if let Some(path) = file(&self.picture) {
            let bytes = drawn(arguments, shown, recording, &path, terminal)?;
            files::replace(&path, |out| out.write_all(&bytes)).map_err(Error::system)?;
            written.push(path);
        }
        for (plot, path) in &self.plots {
            let title = match model.title.as_str() {
                "" => &model.name,
                title => title,
            };
            let drawing = plot
                .draw(title, table, &self.corridors)
                .map_err(Error::input)?;
            let bytes = drawing.bytes(arguments.pictures).map_err(Error::system)?;
            files::replace(path, |out| out.write_all(&bytes)).map_err(Error::system)?;
            written.push(path.clone());
        }
        Ok(written)
    }

    /// Prints the table, or the file that is printed instead.
    ///
    /// # Errors
    /// The result cannot be written or drawn.
    pub fn print(
        &self,
        arguments: &Arguments,
        shown: &Shown<'_>,
        (recording, table): (&Recording, &Table),
        terminal: &mut Terminal,
    ) -> Result<(), Error> {
        let standard = |path: &Option<PathBuf>| path.as_deref().is_some_and(is_standard);
        if standard(&self.csv) {
            terminal.write(|out| table.write_csv(out))
        } else if standard(&self.final_state) {
            match recording.last_state.is_empty() {
                true => Ok(()),
                false => terminal.print(&state_file::text(recording)),
            }
        } else if let Some(path) = self.picture.as_ref().filter(|path| is_standard(path)) {
            let bytes = drawn(arguments, shown, recording, path, terminal)?;
            terminal.write(|out| out.write_all(&bytes))
        } else if arguments.quiet {
            Ok(())
        } else if table.columns.len() == 1 {
            terminal.print(&nothing_asked(&shown.found.model))
        } else {
            let layout = Layout {
                digits: arguments.precision.map(usize::from),
                width: terminal.width(),
            };
            terminal.print(&table.text(layout))
        }
    }

    /// True if a file is printed on standard output.
    pub fn prints_a_file(&self) -> bool {
        let all = [&self.csv, &self.final_state, &self.picture];
        all.into_iter().flatten().any(|path| is_standard(path))
    }
}

/// In place of a table that would have times alone: what to add.
fn nothing_asked(model: &Model) -> String {
    let of = model.systems.iter().find_map(|system| {
        let first = system.elements.first()?;
        Some(format!("{}/{}", system.name, first.name))
    });
    let component = match model.dimension {
        Dimension::Plane => "component: z",
        Dimension::Space => "component: x",
    };
    let example = of.map_or_else(String::new, |of| {
        format!(", such as\n\noutputs:\n  - {{ name: position, of: {of}, what: position, {component} }}\n")
    });
    let example = example.trim_end();
    format!("the model has no outputs, so there is no table. Add what is to be seen{example}\n")
}

/// Refuses rows for ISO-MME whose last interval is shorter than the others.
fn has_equal_intervals(arguments: &Arguments, model: &Model) -> Result<(), Error> {
    let duration = arguments.duration.unwrap_or(model.run.duration);
    let every = arguments.every.unwrap_or(model.run.every);
    let rows = duration / every;
    match (rows - rows.round()).abs() > 1e-6 * rows.max(1.0) {
        true => Err(Error::Input(format!(
            "--mme: channels have samples at equal intervals, and {duration} s is no whole number of {every} s\n  \
             help: give another --every or --duration"
        ))),
        false => Ok(()),
    }
}

/// The requested plots with their files in `directory`, and the corridors that they show.
fn plots(
    arguments: &Arguments,
    model: &Model,
    directory: &Path,
    outputs: &mut Outputs,
) -> Result<(Vec<Plot>, Vec<Corridor>), Error> {
    let units = Units::of(model);
    let (columns, si_columns) = (units.columns(), units.si_columns());
    let mut plots = Vec::new();
    for text in &arguments.plot {
        let plot = Request::read(text, &columns).map_err(Error::input)?;
        let path = directory.join(format!(
            "{}-{}.{}",
            model.name,
            plot.slug(),
            arguments.pictures.ending()
        ));
        let option = format!("--plot '{}'", plot.text());
        outputs.take(&option, &path, ContentKind::Picture)?;
        plots.push((plot, path));
    }
    let corridors = arguments.corridor.iter();
    let corridors = corridors.map(|text| {
        let corridor = Corridor::read(text, &si_columns).map_err(Error::Input)?;
        Ok(units.corridor(corridor))
    });
    let corridors: Vec<Corridor> = corridors.collect::<Result<_, _>>()?;
    for corridor in &corridors {
        if !plots.iter().any(|(plot, _)| plot.shows(corridor)) {
            let of = &corridor.of;
            return Err(Error::Input(format!(
                "--corridor: no plot shows \"{of}\" over time\n  help: add --plot '{of}'"
            )));
        }
    }
    Ok((plots, corridors))
}

/// Writes the outputs as channels of ISO-MME; returns the path of the file that describes the test.
fn write_mme(folder: &Path, model: &Model, recording: &Recording) -> Result<PathBuf, Error> {
    let [times, columns @ ..] = recording.table.columns.as_slice() else {
        unreachable!("a table has times");
    };
    let mut channels = Vec::new();
    for (output, column) in model.outputs.iter().zip(columns) {
        let signal = Signal::of_samples(&times.values, &column.values).ok_or_else(|| {
            Error::system("--mme: the run ended between two rows, so there are no samples at equal intervals to write")
        })?;
        let (name, title) = match &output.code {
            Some(code) => (code, output.name.as_str()),
            None => (&output.name, ""),
        };
        // if the code names a filter, the samples must be filtered by it
        let signal = match class_of_code(name).filter(|_| output.filter.is_none()) {
            Some(class) => filtered(&signal, class, Standard::Iso6487).map_err(|error| {
                Error::Input(format!(
                    "--mme: the code {name} of the output \"{}\" says {class}, and {error}\n  help: run with --every '0.1 ms', or write 0 as the last character of the code",
                    output.name
                ))
            })?,
            None => signal,
        };
        channels.push(Channel {
            name: name.clone(),
            title: title.to_owned(),
            unit: output.unit.clone(),
            ..Channel::of(signal)
        });
    }
    if channels.len() > mme::MOST_CHANNELS {
        return Err(Error::input(format!(
            "--mme: the model has {} outputs, and a test has {} channels at most",
            channels.len(),
            mme::MOST_CHANNELS
        )));
    }
    let about = About {
        title: match model.title.as_str() {
            "" => model.name.clone(),
            title => title.to_owned(),
        },
        source: format!("bryant {}", env!("CARGO_PKG_VERSION")),
    };
    let path = folder.join(format!("{}.mme", model.name));
    let recording = bryant_signal::Recording {
        channels,
        damaged: Vec::new(),
    };
    mme::write(folder, &model.name, &recording, &about)
        .map_err(|error| Error::system(format!("{}: {error}", path.display())))?;
    Ok(path)
}

/// The table of a run as Apache Parquet; its metadata have units, model, digest and version.
pub fn parquet(
    out: &mut dyn std::io::Write,
    model: &str,
    (recording, table): (&Recording, &Table),
) -> std::io::Result<()> {
    let columns = &table.columns;
    let units = columns
        .iter()
        .map(|c| (c.name.clone(), c.unit.clone().into()));
    let units: serde_json::Map<String, serde_json::Value> = units.collect();
    let metadata = [
        ("units", serde_json::Value::Object(units).to_string()),
        ("model", model.to_owned()),
        ("digest", recording.header.digest.clone()),
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let numbers = columns.iter().map(|column| Numbers {
        name: &column.name,
        values: &column.values,
    });
    write_numbers(out, model, &numbers.collect::<Vec<_>>(), &metadata)
}

/// The picture of the motion; the extension of its file determines the format.
fn drawn(
    arguments: &Arguments,
    shown: &Shown<'_>,
    recording: &Recording,
    path: &Path,
    terminal: &Terminal,
) -> Result<Vec<u8>, Error> {
    let model = &shown.found.model;
    let every = shown.job.every.unwrap_or(model.run.every);
    let ends = [recording.first_time(), recording.last_time()];
    let times = picture::times(ends, arguments.figures.into(), every);
    let arrangement = match arguments.overlay {
        true => Arrangement::Overlay,
        false => Arrangement::Row,
    };
    // the scene also needs the motion between the figures: it decides which bodies the view follows, from where it
    // looks, and which figures are alike
    let between = times.windows(2).flat_map(|ends| {
        let part = |n: i32| ends[0] + f64::from(n) / 4.0 * (ends[1] - ends[0]);
        (0..4).map(part)
    });
    let looks: Vec<f64> = between.chain(times.last().copied()).collect();
    let instants = recording.at(&looks);
    let scene = match needs_forces(model) {
        true => shown.scene(recording, &instants, terminal)?,
        false => shown.bare(recording, &instants)?,
    };
    let drawn = recording.at(&times);
    let drawn: Vec<f64> = drawn.iter().map(|instant| instant.time).collect();
    let view = arguments.view.unwrap_or_else(|| scene.view());
    let drawing = picture::draw(model, &scene, &drawn, arrangement, view);
    let format = Format::of(path).unwrap_or(Format::Svg);
    drawing.bytes(format).map_err(Error::system)
}
