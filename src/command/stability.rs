//! `bryant stability`: runs the hard cases, and says how far they stay from their bounds.

use super::Error;
use super::outputs::{Outputs, Replacing, is_standard};
use super::progress::{Progress, Whole};
use super::terminal::Terminal;
use crate::files;
use crate::interrupt;
use crate::signature::ContentKind;
use crate::stability::report::{json, markdown, text};
use crate::stability::{self, Scenes};
use std::path::{Path, PathBuf};

/// Run the hard cases: does this program stay numerically stable where it is difficult?
#[derive(Debug, clap::Args)]
#[command(after_long_help = "\
Examples:
  bryant stability                                   every case, a table
  bryant stability contact --laws                    those about contacts, with the law of each and the reason of each bound
  bryant stability --full --markdown stability.md    harder grids, as a page

Exit code 3 where a bound is missed. Ctrl-C ends it with the table of the cases that are done, and exit code 130.")]
pub struct Arguments {
    /// Run only cases whose group or name contains one of these words
    #[arg(value_name = "WORD")]
    words: Vec<String>,

    /// Also run harder and larger variants, which take minutes
    #[arg(long)]
    full: bool,

    /// Print the law that each case must obey, and the source of each bound
    #[arg(long)]
    laws: bool,

    /// Only list the cases
    #[arg(long)]
    list: bool,

    /// Write a page with a line for each group, and a page for each group into the folder FILE; - prints all of them
    /// instead of the table
    #[arg(long, value_name = "FILE.md")]
    markdown: Option<PathBuf>,

    /// Print everything as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    replacing: Replacing,
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
        if self.list && self.json {
            let listed = cases
                .iter()
                .map(|case| serde_json::json!({ "group": case.group.title(), "case": case.name }));
            return terminal.print_json(&listed.collect::<Vec<_>>());
        }
        if self.list {
            for case in cases {
                terminal.print(&format!("{}: {}\n", case.group.title(), case.name))?;
            }
            return terminal.flush();
        }
        let mut outputs = Outputs::of([], self.replacing);
        let mut pages = Vec::new();
        if self.json {
            outputs.take("--json", Path::new("-"), ContentKind::Table)?;
        }
        if let Some(path) = &self.markdown {
            outputs.take("--markdown", path, ContentKind::Markdown)?;
            for case in cases.iter().filter(|_| !is_standard(path)) {
                // a group has one page for all of its cases
                let page = folder_of(path).join(markdown::file(case.group));
                if !pages.contains(&page) {
                    outputs.take("--markdown", &page, ContentKind::Markdown)?;
                    pages.push(page);
                }
            }
        }
        let scenes = Scenes::new();
        let whole = Whole::Count(cases.len() as u64, "hard cases");
        let progress = Progress::new(terminal, "running".into(), whole);
        interrupt::watch();
        let outcomes = stability::run(&cases, &scenes, self.full, &mut |done| {
            progress.set(done as f64);
        });
        drop(progress);

        let missing = cases.len() - outcomes.len();
        // no pages are written if cases are missing, because they would look complete
        let page = self.markdown.as_ref().filter(|_| missing == 0);
        let command = match self.full {
            true => "bryant stability --full --markdown FILE.md",
            false => "bryant stability --markdown FILE.md",
        };
        let file = page.filter(|path| !is_standard(path));
        if let Some(path) = file {
            write_pages(path, &outcomes, command)?;
        }
        let printed = match page {
            _ if self.json => terminal.print_json(&json::json(&outcomes)),
            Some(path) if is_standard(path) => terminal.print(&markdown::whole(&outcomes, command)),
            _ => terminal.print(&format!(
                "{}\n{}\n",
                text::text(&outcomes, self.laws).trim_start(),
                text::summary(&outcomes)
            )),
        };
        let printed = printed.and_then(|()| terminal.flush());
        if let Some(path) = file {
            terminal.note(&format!("wrote {}", path.display()));
        }
        let outcome = match outcomes.iter().all(stability::Outcome::holds) {
            true if missing > 0 => Err(Error::Interrupted(format!(
                "{missing} of {} cases were not run to their end\n  help: words choose cases: `bryant stability --list` lists them",
                cases.len()
            ))),
            true => Ok(()),
            false => Err(Error::failed(format!(
                "hard cases: {}",
                text::summary(&outcomes)
            ))),
        };
        terminal.end(printed, outcome)
    }
}

/// The folder of the groups' pages: the name of the summary without its extension; with the extension `groups` if it
/// has none.
fn folder_of(path: &Path) -> PathBuf {
    path.with_extension(match path.extension() {
        Some(_) => "",
        None => "groups",
    })
}

/// Writes the summary, and the page of each group.
fn write_pages(path: &Path, outcomes: &[stability::Outcome], command: &str) -> Result<(), Error> {
    let folder = folder_of(path);
    let name = |path: &Path| {
        path.file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let links = [format!("{}/", name(&folder)), format!("../{}", name(path))];
    let (summary, pages) = markdown::pages(outcomes, command, links.each_ref().map(String::as_str));
    std::fs::create_dir_all(&folder).map_err(Error::system)?;
    let groups = pages
        .iter()
        .map(|page| (folder.join(&page.file), &page.text));
    for (path, text) in groups.chain([(path.to_owned(), &summary)]) {
        files::replace(&path, |file| file.write_all(text.as_bytes())).map_err(Error::system)?;
    }
    Ok(())
}
