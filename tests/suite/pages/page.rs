//! What a page contains: blocks of code, tables, pictures, and marks for the test.
//!
//! A block in `sh` is run line by line. A block in `text` is what a command printed: the last one of the `sh` block
//! directly before it, or the one of a mark. A line `…` stands for lines that are left out. A block in `yaml` is a
//! model, a study, or a part of a model.
//!
//! Files that stand beside a page, those in the folder of its name, and those in the folder of its name in `examples`
//! are in the folder of its commands.
//!
//! Marks are HTML comments of lines `KEY: VALUE`. They are about the next block, table or line of pictures:
//!
//! | key | means |
//! |---|---|
//! | `file` | the block is this file in the folder in which the page's commands run |
//! | `prints` | the block, also one in `yaml`, is what this command prints |
//! | `part of` | the block is some columns and rows of the table that this command prints |
//! | `exit` | the exit code of the command, by default 0 |
//! | `run` | a command that the page does not show is run first; several are separated by ` && ` |
//! | `says` | what the command of `run` prints, and the page repeats in its own words: numbers of three digits and more stand on the page, too |
//! | `replace` | before the command, `FILE: OLD -> NEW` in this file |
//! | `take` | `PAGE: FILE`: a file that another page shows is in the folder, too |
//! | `each` | a command is run for each picture, with `{}` for its name without ending |
//! | `rows`, `columns`, `with` | the table has a run in each line: [`table`](super::table) |
//! | `picture` | the file that the commands of the page drew, where it does not have the name of the picture |
//! | `within` | the block is a part of a model, which takes the place of the same keys of this bundled model, or of a `new` one |
//! | `slow` | only run if `PAGES_ALL` is set; the value is the reason |
//! | `not run` | never run; the value is the reason |
//! | `other` | the block is no output of a command, or the table no table of runs; the value says what it is, or what tests it |

/// The values of a mark, by key, in their order.
#[derive(Clone, Debug, Default)]
pub struct Mark(pub Vec<(String, String)>);

/// All keys of marks.
const KEYS: [&str; 17] = [
    "file", "prints", "part of", "exit", "run", "replace", "rows", "columns", "with", "picture",
    "within", "slow", "not run", "other", "each", "take", "says",
];

impl Mark {
    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&str> {
        let found = self.0.iter().find(|(k, _)| k == key);
        found.map(|(_, value)| value.as_str())
    }

    /// All values of a key.
    pub fn all<'a>(&'a self, key: &'a str) -> impl Iterator<Item = &'a str> {
        let here = self.0.iter().filter(move |(k, _)| k == key);
        here.map(|(_, value)| value.as_str())
    }
}

/// What a part of a page is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// a block of code: the lines between the fences
    Block,
    /// a table: its lines with heading and rule
    Table,
    /// a line with pictures
    Pictures,
    /// a mark whose commands are run although nothing follows that they are about
    Lone,
}

/// A part of a page.
#[derive(Clone, Debug)]
pub struct Part {
    pub kind: PartKind,
    /// the language of a block
    pub language: String,
    pub mark: Mark,
    /// lines from 0: the first, and the one behind the last
    pub lines: std::ops::Range<usize>,
    /// whether only blank lines are between this block and the one before
    pub follows: bool,
}

/// A mark from the text of a comment, or what is wrong with it. A comment whose first line has no key is none.
fn mark(text: &str, line: usize) -> Result<Mark, String> {
    let mut found: Vec<(String, String)> = Vec::new();
    for row in text.lines().map(str::trim).filter(|row| !row.is_empty()) {
        let key = KEYS.iter().find(|key| {
            row.strip_prefix(**key)
                .is_some_and(|rest| rest.starts_with(':'))
        });
        match (key, found.last_mut()) {
            (Some(key), _) => {
                let value = row[key.len() + 1..].trim().to_owned();
                found.push((key.to_string(), value));
            }
            (None, Some((_, value))) => {
                value.push(' ');
                value.push_str(row);
            }
            (None, None) => return Err(format!("{}: no mark begins with {row:?}", line + 1)),
        }
    }
    Ok(Mark(found))
}

/// What is read of a page so far.
struct Reader<'a> {
    lines: Vec<&'a str>,
    parts: Vec<Part>,
    /// a mark that is about what comes next
    waiting: Mark,
    /// the line up to which there was nothing but a block, marks and blank lines
    behind: usize,
}

impl Reader<'_> {
    fn push(
        &mut self,
        kind: PartKind,
        language: &str,
        lines: std::ops::Range<usize>,
        follows: bool,
    ) {
        let mark = std::mem::take(&mut self.waiting);
        let language = language.trim().to_owned();
        self.parts.push(Part {
            kind,
            language,
            mark,
            lines,
            follows,
        });
    }

    /// Reads what begins at a line; returns the line behind it.
    fn read(&mut self, begin: usize) -> Result<usize, String> {
        let (line, next) = (self.lines[begin], begin + 1);
        let until = |end: &dyn Fn(&str) -> bool| {
            let length = self.lines[next..].iter().position(|line| end(line));
            next + length.unwrap_or(self.lines.len() - next)
        };
        let follows = self.behind == begin;
        if let Some(language) = line.trim_start().strip_prefix("```") {
            let end = until(&|line| line.trim_start().starts_with("```"));
            self.push(PartKind::Block, language, next..end, follows);
            self.behind = end + 1;
            return Ok(end + 1);
        }
        if line.starts_with("<!--") {
            let end = match line.contains("-->") {
                true => next,
                false => until(&|line| line.contains("-->")) + 1,
            };
            let text = self.lines[begin..end.min(self.lines.len())].join("\n");
            let text = text
                .trim_end()
                .strip_suffix("-->")
                .map(|text| text.trim_start_matches("<!--").to_owned());
            let text = text.ok_or(format!(
                "{}: this comment does not end with its line",
                begin + 1
            ))?;
            self.lone(begin);
            self.waiting = mark(&text, begin)?;
            self.behind = if follows { end } else { self.behind };
            return Ok(end);
        }
        let rule = self
            .lines
            .get(next)
            .is_some_and(|next| next.starts_with("|---") || next.starts_with("|:"));
        if line.starts_with('|') && rule {
            let end = until(&|line| !line.starts_with('|'));
            let pictures = self.lines[begin..end]
                .iter()
                .any(|line| line.contains("!["));
            let kind = if pictures {
                PartKind::Pictures
            } else {
                PartKind::Table
            };
            self.push(kind, "", begin..end, false);
            return Ok(end);
        }
        if line.contains("![") {
            self.push(PartKind::Pictures, "", begin..next, false);
        } else if line.trim().is_empty() {
            self.behind = if follows { next } else { self.behind };
        } else {
            self.lone(begin);
        }
        Ok(next)
    }

    /// A mark that nothing follows that it is about.
    fn lone(&mut self, line: usize) {
        if !self.waiting.0.is_empty() {
            self.push(PartKind::Lone, "", line..line, false);
        }
    }
}

/// The parts of a page.
pub fn parts(text: &str) -> Result<Vec<Part>, String> {
    let mut reader = Reader {
        lines: text.lines().collect(),
        parts: Vec::new(),
        waiting: Mark::default(),
        behind: usize::MAX,
    };
    let mut i = 0;
    while i < reader.lines.len() {
        i = reader.read(i)?;
    }
    reader.lone(i);
    Ok(reader.parts)
}
