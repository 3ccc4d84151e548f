//! `bryant stability`: the hard cases, and how far from their bounds they stay.

use super::Error;
use super::terminal::Terminal;
use crate::files;
use crate::stability::report::{json, markdown, text};
use crate::stability::{self, Scenes};
use bryant_runtime::program::{ErrorKind, RunError};
use std::path::PathBuf;

/// Run the hard cases: does this program stay numerically stable where it is difficult?
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  bryant stability                                   every case, a table
  bryant stability contact --laws                    those about contacts, with the law of each and the reason of each bound
  bryant stability --full --markdown stability.md    harder grids, as a page

Exit code 3 where a bound is missed.")]
pub struct Arguments {
    /// Words: only cases whose group or name contains one of them
    #[arg(value_name = "WORD")]
    words: Vec<String>,

    /// Harder and larger variants too, which take minutes
    #[arg(long)]
    full: bool,

    /// Say of every case what law it must obey, and of every bound where it comes from
    #[arg(long)]
    laws: bool,

    /// Only list the cases
    #[arg(long)]
    list: bool,

    /// Write the table as a page
    #[arg(long, value_name = "FILE.md")]
    markdown: Option<PathBuf>,

    /// Print everything as JSON
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// Runs the cases and reports them.
    pub fn execute(self, terminal: &mut Terminal) -> Result<(), Error> {
        let cases = stability::select(&self.words);
        if cases.is_empty() {
            return Err(Error::Input(format!(
                "no case has \"{}\" in its name or its group's\n  help: `bryant stability --list` lists them",
                self.words.join("\" or \"")
            )));
        }
        if self.list {
            for case in cases {
                terminal.print(&format!("{}: {}\n", case.group.title(), case.name))?;
            }
            return terminal.flush();
        }
        let scenes = Scenes::new();
        let mut bar = terminal.progress(format!("{} hard cases", cases.len()));
        let outcomes = stability::run(&cases, &scenes, self.full, &mut |part| bar.set(part));
        bar.finish();

        if let Some(path) = &self.markdown {
            let command = match self.full {
                true => "bryant stability --full --markdown FILE.md",
                false => "bryant stability --markdown FILE.md",
            };
            let page = markdown::page(&outcomes, command);
            files::replace(path, |file| file.write_all(page.as_bytes())).map_err(Error::system)?;
        }
        if self.json {
            terminal.print_json(&json::json(&outcomes))?;
        } else {
            terminal.print(text::text(&outcomes, self.laws).trim_start())?;
            terminal.print(&format!("\n{}\n", text::summary(&outcomes)))?;
        }
        terminal.flush()?;
        if let Some(path) = &self.markdown {
            terminal.note(&format!("wrote {}", path.display()));
        }
        match outcomes.iter().all(stability::Outcome::holds) {
            true => Ok(()),
            false => Err(Error::Run(RunError {
                kind: ErrorKind::Run,
                t: None,
                coordinate: None,
                cause: String::new(),
                message: format!("hard cases: {}", text::summary(&outcomes)),
            })),
        }
    }
}
