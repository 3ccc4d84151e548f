//! A block of text beside what a command printed.

use super::compare::{alike, as_shown, same_line};

/// Whether a shown line stands for lines that are left out.
fn elides(line: &str) -> bool {
    matches!(line.trim(), "…" | "...")
}

/// What a command printed, as a page may show it: both streams, or one of them.
#[derive(Clone, Debug, Default)]
pub struct Printed {
    pub out: String,
    pub err: String,
}

impl Printed {
    /// The last lines, for a message.
    pub fn end(&self) -> String {
        let [both, ..] = self.versions();
        both[both.len().saturating_sub(30)..].join("\n")
    }

    fn versions(&self) -> [Vec<&str>; 3] {
        let [out, err] =
            [&self.out, &self.err].map(|text| text.trim_end().lines().collect::<Vec<&str>>());
        let both = out.iter().chain(&err).copied().collect();
        [both, out, err]
    }
}

/// Lines that stand together, without any left out between them.
struct Chunk<'a> {
    lines: Vec<&'a str>,
    /// how the line that stands for others before is written
    before: Option<&'a str>,
}

fn chunks<'a>(shown: &[&'a str]) -> (Vec<Chunk<'a>>, Option<&'a str>) {
    let mut found: Vec<Chunk> = vec![Chunk {
        lines: Vec::new(),
        before: None,
    }];
    let mut open = None;
    for line in shown {
        if elides(line) {
            open = Some(*line);
        } else if let Some(before) = open.take() {
            match found.last_mut() {
                Some(first) if first.lines.is_empty() => {
                    *first = Chunk {
                        lines: vec![line],
                        before: Some(before),
                    }
                }
                _ => found.push(Chunk {
                    lines: vec![line],
                    before: Some(before),
                }),
            }
        } else if let Some(chunk) = found.last_mut() {
            chunk.lines.push(line);
        }
    }
    (found, open)
}

/// Where a chunk may begin.
fn places(
    chunk: &Chunk,
    last: bool,
    open: bool,
    from: usize,
    length: usize,
) -> std::ops::Range<usize> {
    let latest = match length.checked_sub(chunk.lines.len()) {
        Some(latest) if latest >= from => latest,
        _ => return 0..0,
    };
    match (chunk.before, last && !open) {
        (None, true) if latest != from => 0..0,
        (None, _) => from..from + 1,
        (Some(_), true) => latest..latest + 1,
        (Some(_), false) => from..latest + 1,
    }
}

/// The first of the places where a chunk is most alike what was printed, and how much: the sum over its lines.
fn nearest(chunk: &Chunk, is: &[&str], places: std::ops::Range<usize>) -> Option<(usize, f64)> {
    let score = |at: usize| -> f64 {
        let pairs = chunk.lines.iter().zip(&is[at..]);
        pairs.map(|(a, b)| alike(a, b)).sum()
    };
    let scored = places.map(|at| (at, score(at)));
    scored.rev().max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The first shown line that is not printed, if there is one.
fn missing<'a>(shown: &[&'a str], is: &[&str]) -> Option<(&'a str, String)> {
    let (chunks, open) = chunks(shown);
    let mut from = 0;
    for (k, chunk) in chunks.iter().enumerate() {
        let places = places(chunk, k + 1 == chunks.len(), open.is_some(), from, is.len());
        let fits = |at: &usize| {
            chunk
                .lines
                .iter()
                .zip(&is[*at..])
                .all(|(a, b)| same_line(a, b))
        };
        match places.clone().find(fits) {
            Some(at) => from = at + chunk.lines.len(),
            None => {
                let best = nearest(chunk, is, places);
                let pairs = best.map(|(at, _)| chunk.lines.iter().zip(&is[at..]));
                let differs = pairs.and_then(|mut pairs| pairs.find(|(a, b)| !same_line(a, b)));
                return Some(match differs {
                    Some((shown, is)) => (shown, is.to_string()),
                    None => (chunk.lines[0], format!("{} lines", is.len())),
                });
            }
        }
    }
    None
}

/// What differs between a block and what was printed: nothing, or a line of each.
pub fn differs(shown: &[&str], printed: &Printed) -> Option<String> {
    let versions = printed.versions();
    let found: Option<Vec<_>> = versions.iter().map(|is| missing(shown, is)).collect();
    let (shown, is) = found?.into_iter().next()?;
    Some(format!(
        "the page shows\n    {shown}\nand the command prints\n    {is}"
    ))
}

/// The lines of a block as they are now, with as much left out as before; nothing if the block cannot be recognised in
/// what was printed.
pub fn renewed(shown: &[&str], printed: &Printed) -> Option<Vec<String>> {
    let (chunks, open) = chunks(shown);
    let whole = chunks.len() == 1 && chunks[0].before.is_none() && open.is_none();
    // among versions that show as much, the shortest
    let shows = |is: &[&str]| {
        let lines = shown.iter().filter(|line| !elides(line));
        let known = lines.filter(|line| is.iter().any(|is| alike(line, is) > 0.5));
        (known.count(), usize::MAX - is.len())
    };
    let versions = printed.versions();
    let is = versions.iter().max_by_key(|is| shows(is))?;
    if whole {
        // the most alike of the shown lines says how times are shown
        let like = |is: &&str| {
            shown
                .iter()
                .max_by(|a, b| alike(a, is).total_cmp(&alike(b, is)))
        };
        return Some(
            is.iter()
                .map(|is| like(is).map_or(is.to_string(), |shown| as_shown(shown, is)))
                .collect(),
        );
    }
    let (mut from, mut lines) = (0, Vec::new());
    for (k, chunk) in chunks.iter().enumerate() {
        lines.extend(chunk.before.map(str::to_owned));
        let places = places(chunk, k + 1 == chunks.len(), open.is_some(), from, is.len());
        let (at, score) = nearest(chunk, is, places)?;
        if score < 0.5 * chunk.lines.len() as f64 {
            return None;
        }
        from = at + chunk.lines.len();
        let pairs = chunk.lines.iter().zip(&is[at..from]);
        lines.extend(pairs.map(|(shown, is)| as_shown(shown, is)));
    }
    lines.extend(open.map(str::to_owned));
    Some(lines)
}

/// The rules themselves, which the test of all pages begins with.
pub fn rules_hold() -> Result<(), String> {
    let printed = Printed {
        out: "a 1\nb 2\nc 3\nd 4\n".to_owned(),
        err: "wrote x\n".to_owned(),
    };
    for (shown, expected) in [
        ("a 1\nb 2\nc 3\nd 4\nwrote x", true),
        ("a 1\nb 2\nc 3\nd 4", true),
        ("wrote x", true),
        ("a 1\n…\nd 4\nwrote x", true),
        ("…\nb 2\n…", true),
        ("…\nc 3\n…\nwrote x", true),
        ("b 2\n…", false),
        ("…\nb 2", false),
        ("…\nc 3\n…\nb 2\n…", false),
        ("a 1\n…\nd 7\n…", false),
        ("a 1\nc 3\n…", false),
    ] {
        let lines: Vec<&str> = shown.lines().collect();
        if differs(&lines, &printed).is_none() != expected {
            return Err(format!("{shown:?}: the same should be {expected}"));
        }
    }
    let now = renewed(&["…", "b 7", "…", "d 8", "…"], &printed).ok_or("not renewed")?;
    match now.join("\n") == "…\nb 2\n…\nd 4\n…" && renewed(&["…", "e 7", "…"], &printed).is_none()
    {
        true => Ok(()),
        false => Err(format!("renewed as {now:?}")),
    }
}
