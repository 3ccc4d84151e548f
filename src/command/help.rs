//! Fits help texts to the width of the terminal. The source breaks them at the width of code; here the lines of each
//! paragraph and of each entry of a list are joined, and broken again.

use bryant_picture::text::wrap;

/// Longest line of help, also on wider terminals; clap has the same limit.
const WIDEST: usize = 100;
/// Least width of the text in an entry of a list.
const NARROW: usize = 20;

/// The command line, with the texts below the options fitted to the terminal.
pub fn fitted(command: clap::Command) -> clap::Command {
    let width = terminal_size::terminal_size().map_or(WIDEST, |(width, _)| width.0.into());
    of_width(command, width.min(WIDEST))
}

pub fn of_width(command: clap::Command, width: usize) -> clap::Command {
    let text = command
        .get_after_long_help()
        .map(|text| fit(&text.to_string(), width));
    let command = match text {
        Some(text) => command.after_long_help(text),
        None => command,
    };
    command.mut_subcommands(|subcommand| of_width(subcommand, width))
}

/// A piece of a help text.
enum Piece<'t> {
    /// Text that begins at the margin.
    Paragraph(String),
    /// The first column of an entry, and the text of its second column.
    Entry(&'t str, String),
    /// A line that is not changed: an example, or an empty line.
    Line(&'t str),
}

/// Breaks a text into lines of at most `width` characters; lines of examples may be longer.
pub fn fit(text: &str, width: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for piece in pieces(text) {
        match piece {
            Piece::Paragraph(words) => lines.extend(wrap(&words, width)),
            Piece::Entry(before, words) => {
                let column = before.chars().count();
                for (index, part) in wrap(&words, width.saturating_sub(column).max(NARROW))
                    .iter()
                    .enumerate()
                {
                    let before = if index == 0 { before } else { "" };
                    lines.push(format!("{before:column$}{part}"));
                }
            }
            Piece::Line(line) => lines.push(line.to_owned()),
        }
    }
    lines.join("\n")
}

fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut pieces = Vec::new();
    for line in text.lines() {
        let indent = line.len() - line.trim_start().len();
        match (indent, pieces.last_mut()) {
            (0, Some(Piece::Paragraph(words))) if !line.is_empty() => {
                *words = format!("{words} {line}");
                continue;
            }
            (1.., Some(Piece::Entry(before, words))) if indent == before.chars().count() => {
                *words = format!("{words} {}", line.trim_start());
                continue;
            }
            _ => {}
        }
        pieces.push(match (indent, second_column(line)) {
            (0, _) if line.is_empty() => Piece::Line(line),
            (0, _) => Piece::Paragraph(line.to_owned()),
            // a short remark beside an example, which does not continue in the next line
            (_, Some(at)) => Piece::Entry(&line[..at], line[at..].to_owned()),
            (_, None) => Piece::Line(line),
        });
    }
    pieces
}

/// The byte at which the second column of an indented line begins: after the first run of spaces within the line.
fn second_column(line: &str) -> Option<usize> {
    let begin = line.len() - line.trim_start().len();
    let gap = begin + line[begin..].find("  ")?;
    Some(line.len() - line[gap..].trim_start().len())
}
