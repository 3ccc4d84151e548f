//! `bryant models`: the bundled models.

use super::Error;
use super::model_argument::find_bundled;
use super::terminal::Terminal;
use crate::bundled::{self, Bundled};
use crate::files;
use bryant_generator::model::{Dimension, Model};
use bryant_picture::text::wrap;
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};

/// List the bundled models, or print the YAML of one
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  bryant models
  bryant models child-seat --copy .                  a model to start from, with the files that it includes
  bryant models child-seat --yaml
  bryant models --json")]
pub struct Arguments {
    /// One model; without it, all of them
    name: Option<String>,

    /// Print the model's YAML
    #[arg(long, requires = "name", conflicts_with = "json")]
    yaml: bool,

    /// Write the model's YAML, and the files that it includes, to this directory; nothing is overwritten
    #[arg(long, value_name = "DIR", requires = "name", conflicts_with_all = ["yaml", "json"])]
    copy: Option<PathBuf>,

    /// Print JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Lists models.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let chosen = match &self.name {
            Some(name) => vec![find_bundled(name)?],
            None => bundled::all().iter().collect(),
        };
        if self.yaml {
            return terminal.print(chosen[0].yaml);
        }
        if let Some(directory) = &self.copy {
            return copy(chosen[0], directory, terminal);
        }
        let models = chosen.iter().map(|bundled| bundled::model(bundled));
        let models: Vec<Model> = models.collect::<Result<_, _>>().map_err(Error::Model)?;
        let rows: Vec<Row> = models.iter().map(Row::of).collect();
        if self.json {
            let rows: Vec<_> = rows.iter().map(Row::json).collect();
            return terminal.print_json(&rows);
        }
        terminal.print(&table(&rows, terminal.width()))
    }
}

/// Writes all files of a model, or none if one of them exists.
fn copy(bundled: &Bundled, directory: &Path, terminal: &mut Terminal) -> Result<(), Error> {
    let scene = bundled::scene(bundled).map_err(Error::Model)?;
    let files = scene.read.iter().filter_map(|path| {
        let text = bundled::file(path)?;
        let path = path.strip_prefix("applications").unwrap_or(path);
        Some((directory.join(path), text))
    });
    let files: Vec<_> = files.collect();
    if let Some((path, _)) = files.iter().find(|(path, _)| path.exists()) {
        return Err(Error::Input(format!(
            "{} exists already\n  help: name another directory",
            path.display()
        )));
    }
    for (path, text) in files {
        files::replace(&path, |out| out.write_all(text.as_bytes())).map_err(Error::system)?;
        terminal.note(&format!("wrote {}", path.display()));
    }
    Ok(())
}

struct Row<'a> {
    name: &'a str,
    dimension: u8,
    systems: usize,
    elements: usize,
    freedoms: usize,
    title: &'a str,
}

impl<'a> Row<'a> {
    fn of(model: &'a Model) -> Self {
        Self {
            name: &model.name,
            dimension: match model.dimension {
                Dimension::Plane => 2,
                Dimension::Space => 3,
            },
            systems: model.systems.len(),
            elements: model.systems.iter().map(|s| s.elements.len()).sum(),
            freedoms: super::check::freedoms(model),
            title: &model.title,
        }
    }

    fn json(&self) -> serde_json::Value {
        json!({
            "name": self.name,
            "dimension": self.dimension,
            "systems": self.systems,
            "elements": self.elements,
            "freedoms": self.freedoms,
            "title": self.title,
        })
    }
}

/// A line for each model. If `width` is given, long titles are broken, and continue in their column.
fn table(rows: &[Row<'_>], width: Option<usize>) -> String {
    let heading = "model";
    let names = rows.iter().map(|row| row.name.chars().count());
    let names = names.fold(heading.len(), usize::max);
    let mut text = format!("{heading:names$}  in     freedoms  title\n");
    let before = names + "  plane  freedoms  ".len();
    let room = width.map_or(usize::MAX, |width| width.saturating_sub(before).max(20));
    for row in rows {
        let space = match row.dimension {
            2 => "plane",
            _ => "space",
        };
        let mut title = wrap(row.title, room).into_iter();
        let line = format!(
            "{:names$}  {space}  {:>8}  {}",
            row.name,
            row.freedoms,
            title.next().unwrap_or_default()
        );
        text.push_str(line.trim_end());
        text.push('\n');
        for line in title {
            text.push_str(&format!("{:before$}{line}\n", ""));
        }
    }
    text
}
