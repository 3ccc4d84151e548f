//! Runs the commands of a page in an empty folder with the files that the page shows.

use super::command_call::cache;
use super::output::{self, Printed};
use super::page::{Mark, Part, PartKind, parts};
use super::{asked, picture, root, table};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What came out of a page.
#[derive(Default)]
pub struct Told {
    pub problems: Vec<String>,
    /// what was not run, with its reason
    pub left_out: Vec<String>,
}

/// A page under test.
struct Page<'a> {
    path: &'a Path,
    lines: Vec<&'a str>,
    folder: PathBuf,
    /// what the last command printed
    last: Option<Printed>,
    /// what commands of this page printed, so that none is run twice
    known: HashMap<String, Printed>,
    /// the lines of parts as they are now
    renewed: Vec<(std::ops::Range<usize>, Vec<String>)>,
    told: Told,
}

/// The test of a page; with `PAGES_UPDATE` it is written anew.
pub fn page(path: &Path) -> Told {
    let text = std::fs::read_to_string(root().join(path)).unwrap();
    let parts = match parts(&text) {
        Ok(parts) => parts,
        Err(problem) => {
            let problems = vec![format!("{}:{problem}", path.display())];
            return Told {
                problems,
                ..Told::default()
            };
        }
    };
    if path == Path::new("docs/stability.md") || path.starts_with("docs/stability") {
        let reason = "`bryant stability --markdown` writes this page; `cargo test --test hard` runs its cases";
        let left_out = vec![format!("{}: {reason}", path.display())];
        return Told {
            left_out,
            ..Told::default()
        };
    }
    let directory = tempfile::tempdir().unwrap();
    let mut page = Page {
        path,
        lines: text.lines().collect(),
        folder: directory.path().to_owned(),
        last: None,
        known: HashMap::new(),
        renewed: Vec::new(),
        told: Told::default(),
    };
    beside(path, &page.folder);
    for part in &parts {
        if let Some(name) = part.mark.get("file")
            && let Err(problem) = write_block(&page.folder.join(name), &page.lines, part)
        {
            page.problem(part.lines.start, &problem);
        }
    }
    for part in &parts {
        page.part(part);
    }
    if !page.renewed.is_empty() {
        page.write();
    }
    page.told
}

impl Page<'_> {
    fn place(&self, line: usize) -> String {
        format!("{}:{}", self.path.display(), line + 1)
    }

    fn problem(&mut self, line: usize, what: &str) {
        let place = self.place(line);
        self.told.problems.push(format!("{place}: {what}"));
    }

    fn part(&mut self, part: &Part) {
        let at = part.lines.start;
        if let Some(problem) = strange(part) {
            return self.problem(at, &problem);
        }
        let wait = part
            .mark
            .get("not run")
            .or(part.mark.get("slow").filter(|_| !asked("PAGES_ALL")));
        if let Some(reason) = wait {
            if reason.is_empty() {
                self.problem(at, "there is no reason");
            }
            let place = self.place(at);
            self.told.left_out.push(format!("{place}: {reason}"));
            self.last = None;
            return;
        }
        for replace in part.mark.all("replace") {
            if let Err(problem) = self.replace(replace) {
                self.problem(at, &problem);
            }
        }
        for take in part.mark.all("take") {
            if let Err(problem) = self.take(take) {
                self.problem(at, &problem);
            }
        }
        for command in part.mark.all("run") {
            for command in command.split(" && ") {
                self.command(command, 0, at);
            }
        }
        for says in part.mark.all("says") {
            self.says(says, at);
        }
        match part.kind {
            PartKind::Block if part.language == "sh" => self.commands(part),
            PartKind::Block if part.language == "text" => self.text(part),
            // a file that is there, and not one that the page makes
            PartKind::Block if part.mark.get("prints").is_some() => self.text(part),
            PartKind::Block if part.language == "yaml" => self.yaml(part),
            PartKind::Table if part.mark.get("rows").is_some() => self.table(part),
            PartKind::Table => self.unmarked(part),
            PartKind::Pictures => self.pictures(part),
            _ => (),
        }
    }

    /// `FILE: OLD -> NEW` in a file of the page.
    fn replace(&mut self, rule: &str) -> Result<(), String> {
        let parsed = rule
            .split_once(": ")
            .and_then(|(file, rest)| Some((file, rest.split_once(" -> ")?)));
        let (file, (old, new)) = parsed.ok_or("`replace` is FILE: OLD -> NEW")?;
        let path = self.folder.join(file);
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{file}: {error}"))?;
        if !text.contains(old) {
            return Err(format!("{file} has no {old:?}"));
        }
        self.known.clear();
        std::fs::write(path, text.replacen(old, new, 1)).map_err(|error| error.to_string())
    }

    /// Checks that the last command printed a text, and that the page has its numbers.
    fn says(&mut self, text: &str, line: usize) {
        let printed = self.last.clone().unwrap_or_default();
        let squeezed = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        if !squeezed(&format!("{}\n{}", printed.out, printed.err)).contains(text) {
            self.problem(
                line,
                &format!("the command does not print {text:?}:\n{}", printed.end()),
            );
        }
        let own = self.lines.iter().filter(|line| !line.contains("says: "));
        let own: String = own
            .flat_map(|line| line.chars().filter(|c| *c != ' ').chain(['\n']))
            .collect();
        let numbers = text.split(|c: char| !c.is_ascii_digit() && c != '.');
        for number in numbers.filter(|number| number.len() > 2) {
            if !own.contains(number) {
                self.problem(line, &format!("the page does not have {number}"));
            }
        }
    }

    /// `PAGE: FILE` of another page.
    fn take(&mut self, rule: &str) -> Result<(), String> {
        let (page, file) = rule.split_once(": ").ok_or("`take` is PAGE: FILE")?;
        let text = std::fs::read_to_string(root().join(page))
            .map_err(|error| format!("{page}: {error}"))?;
        let parts = parts(&text)?;
        let part = parts
            .iter()
            .find(|part| part.mark.get("file") == Some(file));
        let part = part.ok_or(format!("{page} shows no {file}"))?;
        write_block(
            &self.folder.join(file),
            &text.lines().collect::<Vec<_>>(),
            part,
        )
    }

    /// Runs a command of the shell.
    fn command(&mut self, command: &str, code: i32, line: usize) -> bool {
        if let Some(printed) = self.known.get(command) {
            self.last = Some(printed.clone());
            return true;
        }
        let (status, printed) = call(&self.folder, command);
        let fits = status == Some(code);
        if !fits {
            let text = format!(
                "`{command}` ends with {status:?} instead of {code}:\n{}",
                printed.end()
            );
            self.problem(line, &text);
        }
        if fits {
            self.known.insert(command.to_owned(), printed.clone());
        }
        self.last = Some(printed);
        fits
    }

    fn commands(&mut self, part: &Part) {
        for i in part.lines.clone() {
            let line = self.lines[i].trim();
            if !line.is_empty() && !line.starts_with('#') {
                self.command(line, 0, i);
            }
        }
    }

    fn text(&mut self, part: &Part) {
        let at = part.lines.start;
        if part.mark.get("other").is_some() {
            return;
        }
        let command = part.mark.get("prints").or(part.mark.get("part of"));
        if let Some(command) = command {
            let code = part.mark.get("exit").unwrap_or("0").parse().unwrap_or(0);
            if !self.command(command, code, at) {
                return;
            }
        } else if !part.follows {
            return self.problem(
                at,
                "which command prints this? (a mark `prints`, or `other` if it is no output)",
            );
        }
        let Some(printed) = self.last.clone() else {
            if !part.follows {
                self.problem(at, "no command was run before");
            }
            return;
        };
        let lines = self.lines.clone();
        let shown = &lines[part.lines.clone()];
        if part.mark.get("part of").is_some() {
            match table::part(shown, &printed.out) {
                Ok(now) => self.compare(part, now),
                Err(problem) => self.problem(at, &problem),
            }
        } else if let Some(problem) = output::differs(shown, &printed) {
            match output::renewed(shown, &printed).filter(|_| asked("PAGES_UPDATE")) {
                Some(now) => self.renewed.push((part.lines.clone(), now)),
                None if asked("PAGES_UPDATE") => {
                    let text = format!(
                        "{problem}\nIt cannot be renewed by itself. The command ends with:\n{}",
                        printed.end()
                    );
                    self.problem(at, &text);
                }
                None => self.problem(at, &problem),
            }
        }
    }

    /// Compares lines with those that they should be.
    fn compare(&mut self, part: &Part, now: Vec<String>) {
        let lines = self.lines.clone();
        let shown = &lines[part.lines.clone()];
        let same = |(shown, now): (&&str, &String)| super::compare::same_line(shown, now);
        let differs = shown.iter().zip(&now).position(|pair| !same(pair));
        match differs {
            None if shown.len() == now.len() => (),
            _ if asked("PAGES_UPDATE") => self.renewed.push((part.lines.clone(), now)),
            _ => {
                let k = differs.unwrap_or(0);
                let text = format!(
                    "the page shows\n    {}\nand it is\n    {}",
                    shown[k], now[k]
                );
                self.problem(part.lines.start + k, &text);
            }
        }
    }

    /// A table with a run in each line.
    fn table(&mut self, part: &Part) {
        let lines = self.lines.clone();
        let shown = &lines[part.lines.clone()];
        let folder = self.folder.clone();
        let columns = part.mark.get("columns").unwrap_or_default();
        if columns.split(';').any(|column| column.trim() == "-") {
            let place = self.place(part.lines.start);
            match part.mark.get("other") {
                Some(reason) => self
                    .told
                    .left_out
                    .push(format!("{place}, some columns: {reason}")),
                None => self.problem(
                    part.lines.start,
                    "what are the columns `-`? (a mark `other`)",
                ),
            }
        }
        // each line takes a run: one in three, but all where the page is written anew
        let of = if asked("PAGES_ALL") || asked("PAGES_UPDATE") {
            1
        } else {
            3
        };
        match table::renewed(shown, &part.mark, of, |command, wanted| {
            responses(&folder, command, wanted)
        }) {
            Ok(now) => self.compare(part, now),
            Err(problem) => self.problem(part.lines.start, &problem),
        }
    }

    /// A table of numbers says by a mark how they are known.
    fn unmarked(&mut self, part: &Part) {
        let keys = self.path == Path::new("docs/reference.md");
        let known = keys
            || ["says", "other"]
                .iter()
                .any(|key| part.mark.get(key).is_some());
        if !known && table::has_numbers(&self.lines[part.lines.clone()]) {
            let text = "how are the numbers of this table known? (a mark `rows`, `says`, `not run`, or `other` with what tests them)";
            self.problem(part.lines.start, text);
        }
    }

    fn pictures(&mut self, part: &Part) {
        let at = part.lines.start;
        let page = self.path.parent().unwrap_or(Path::new(""));
        for picture in picture::pictures(&self.lines[part.lines.clone()]) {
            let shown = root().join(page).join(&picture);
            let stem = Path::new(&picture)
                .file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            for command in part.mark.all("each") {
                self.command(&command.replace("{}", &stem), 0, at);
            }
            let name = part
                .mark
                .get("picture")
                .map(Path::new)
                .or(Path::new(&picture).file_name().map(Path::new));
            let drawn = self.folder.join(name.unwrap_or(Path::new("")));
            if let Some(problem) = picture::compare(&shown, &drawn, asked("PAGES_UPDATE")) {
                self.problem(at, &format!("the picture {picture}: {problem}"));
            }
        }
    }

    /// A model passes the check, a study its plan.
    fn yaml(&mut self, part: &Part) {
        let at = part.lines.start;
        // `cargo test -p bryant-generator --test it reference` reads the examples of this page
        if part.mark.get("other").is_some() || self.path == Path::new("docs/reference.md") {
            return;
        }
        let mut text = self.lines[part.lines.clone()].join("\n") + "\n";
        if let Some(base) = part.mark.get("within") {
            match within(&self.folder, base, &text) {
                Ok(whole) => text = whole,
                Err(problem) => return self.problem(at, &problem),
            }
        }
        let name = part.mark.get("file").unwrap_or("block-of-the-page.yaml");
        std::fs::write(self.folder.join(name), &text).unwrap();
        let study = text.lines().any(|line| line.starts_with("design:"));
        let command = if study { "sweep --plan" } else { "check" };
        let kept = self.last.take();
        self.command(&format!("bryant {command} '{name}'"), 0, at);
        self.last = kept;
    }

    /// Writes the page with the renewed parts.
    fn write(&mut self) {
        let mut lines: Vec<String> = self.lines.iter().map(|line| line.to_string()).collect();
        let mut renewed = std::mem::take(&mut self.renewed);
        renewed.sort_by_key(|(at, _)| std::cmp::Reverse(at.start));
        for (at, now) in renewed {
            lines.splice(at, now);
        }
        std::fs::write(root().join(self.path), lines.join("\n") + "\n").unwrap();
    }
}

/// Writes a block of a page as a file.
fn write_block(path: &Path, lines: &[&str], part: &Part) -> Result<(), String> {
    let text = lines[part.lines.clone()].join("\n") + "\n";
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

/// Copies the files beside a page, those in the folder of its name, and the examples of its name, but no pages and no
/// pictures: these are made by commands.
fn beside(page: &Path, folder: &Path) {
    let here = root().join(page);
    let mut places = vec![here.with_extension("")];
    places.extend(
        page.file_stem()
            .map(|name| root().join("examples").join(name)),
    );
    places.extend(
        here.parent()
            .filter(|parent| *parent != root())
            .map(Path::to_owned),
    );
    let entries = places
        .iter()
        .filter_map(|place| std::fs::read_dir(place).ok())
        .flatten();
    for path in entries.map(|entry| entry.unwrap().path()) {
        let made = path
            .extension()
            .is_none_or(|e| e == "md" || e == "svg" || e == "png");
        if !made {
            std::fs::copy(&path, folder.join(path.file_name().unwrap())).unwrap();
        }
    }
}

/// Runs a line of the shell in a folder: its exit code and what it printed. `$ROOT` is the root of the repository.
pub fn call(folder: &Path, line: &str) -> (Option<i32>, Printed) {
    let programs = Path::new(env!("CARGO_BIN_EXE_bryant"))
        .parent()
        .unwrap()
        .to_owned();
    let mut path = vec![programs];
    path.extend(std::env::split_paths(
        &std::env::var_os("PATH").unwrap_or_default(),
    ));
    let mut command = Command::new("sh");
    command
        .args(["-c", line])
        .current_dir(folder)
        .stdin(Stdio::null());
    command
        .env("PATH", std::env::join_paths(path).unwrap())
        .env("BRYANT_CACHE", cache())
        .env("ROOT", root());
    let output = command.output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let printed = Printed {
        out: text(&output.stdout),
        err: text(&output.stderr),
    };
    (output.status.code(), printed)
}

/// The responses of a run, in SI.
fn responses(folder: &Path, command: &str, wanted: &[String]) -> Result<Vec<Option<f64>>, String> {
    let asked: String = wanted
        .iter()
        .map(|response| format!(" -r '{response}'"))
        .collect();
    let line = format!("{command} --no-files --json{asked}");
    let (status, printed) = call(folder, &line);
    if status != Some(0) {
        return Err(format!("`{line}` ends with {status:?}:\n{}", printed.err));
    }
    let run: serde_json::Value =
        serde_json::from_str(&printed.out).map_err(|error| error.to_string())?;
    let values = run["responses"]
        .as_array()
        .ok_or("there are no responses")?;
    Ok(values
        .iter()
        .map(|response| response["value"].as_f64())
        .collect())
}

/// A part of a model within a bundled model, whose files are written into the folder, or within a new one.
fn within(folder: &Path, base: &str, part: &str) -> Result<String, String> {
    let key = |line: &str| {
        let key = line.split_once(':').map(|(key, _)| key.to_owned());
        key.filter(|key| !key.starts_with([' ', '#', '-', '}', ']']))
    };
    let base = match base {
        "new" => "model: new\ndimension: 3\nrun: { duration: 1 s, every: 0.1 s }\n".to_owned(),
        name => {
            let (status, printed) = call(folder, &format!("bryant models {name} --copy ."));
            let text = std::fs::read_to_string(folder.join(format!("{name}.yaml")));
            text.map_err(|_| format!("no model {name:?}: {status:?} {}", printed.err))?
        }
    };
    let taken: Vec<String> = part.lines().filter_map(key).collect();
    let mut whole = String::new();
    let mut keep = true;
    for line in base.lines() {
        if let Some(key) = key(line) {
            keep = !taken.contains(&key);
        }
        if keep {
            whole = format!("{whole}{line}\n");
        }
    }
    Ok(whole + part)
}

/// A mark that is not about a part of this kind.
pub fn strange(part: &Part) -> Option<String> {
    let fits = |key: &str| match key {
        "not run" | "slow" | "run" | "says" | "replace" | "take" => true,
        "file" => part.kind == PartKind::Block,
        "other" => {
            part.kind == PartKind::Table || matches!(part.language.as_str(), "text" | "yaml")
        }
        "prints" => {
            part.kind == PartKind::Block && matches!(part.language.as_str(), "text" | "yaml")
        }
        "part of" | "exit" => part.kind == PartKind::Block && part.language == "text",
        "within" => part.kind == PartKind::Block && part.language == "yaml",
        "rows" | "columns" | "with" => part.kind == PartKind::Table,
        "picture" | "each" => part.kind == PartKind::Pictures,
        _ => false,
    };
    let Mark(rows) = &part.mark;
    let wrong = rows.iter().find(|(key, _)| !fits(key))?;
    Some(format!(
        "the mark `{}` is not about a {:?} of {:?}",
        wrong.0, part.kind, part.language
    ))
}
