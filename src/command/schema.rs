//! `bryant schema`: the keys of models and studies as a JSON Schema.

use super::Error;
use super::terminal::Terminal;
use bryant_generator::description::load::{Included, Model};
use bryant_generator::description::schema::Schema;
use bryant_generator::read::LANGUAGE;
use clap::{Args, ValueEnum};

/// Print the keys of models or studies as a JSON Schema, by which editors complete and check
#[derive(Debug, Args)]
#[command(after_long_help = "\
Each key has its meaning, its unit and its default. What several values mean together is known to `bryant check` alone.

Examples:
  bryant schema > model.schema.json
  bryant schema study > study.schema.json
In VS Code with the extension YAML, and in editors with yaml-language-server, the first line of a model names it:
  # yaml-language-server: $schema=model.schema.json")]
pub struct Arguments {
    /// The kind of file
    #[arg(value_enum, default_value_t = FileKind::Model)]
    of: FileKind,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum FileKind {
    /// A model
    Model,
    /// A file that models include
    Included,
    /// A study
    Study,
}

impl Arguments {
    /// Prints a schema.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        terminal.print_json(&match self.of {
            FileKind::Model => Schema::of::<Model>(LANGUAGE),
            FileKind::Included => Schema::of::<Included>(LANGUAGE),
            FileKind::Study => Schema::of::<bryant_study::file::Keys>(LANGUAGE),
        })
    }
}
