//! Standard output and standard error: width, colours, and writing without a panic when nobody reads.

use super::Error;
use crate::build_on_demand::guard::{self, Output};
use crate::process;
use bryant_picture::text::wrap;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Least width of lines in characters; narrower terminals break the lines themselves.
const NARROWEST: usize = 40;
/// Number of characters by which the continuation of a broken line is indented.
const HANGING: usize = 2;

/// Prints results and messages.
pub struct Terminal {
    output: BufWriter<Box<dyn Output>>,
    /// Where messages go; `None` is standard error.
    messages: Option<Kept>,
    /// True if standard output is closed, so that printed text is lost.
    closed: bool,
    /// True once the user has been told that something could not be printed.
    told: bool,
    begin: Instant,
}

impl Terminal {
    /// The terminal of this process. From now on, output of user functions goes to standard error, because standard
    /// output is for results.
    pub(super) fn new() -> Self {
        // must be asked before standard output is moved
        let closed = process::stdout_was_closed();
        Self::over(guard::stdout_for_results(), closed)
    }

    fn over(output: Box<dyn guard::Output>, closed: bool) -> Self {
        Self {
            output: BufWriter::new(output),
            messages: None,
            closed,
            told: false,
            begin: Instant::now(),
        }
    }

    /// One that keeps what is printed and all messages, for a command inside of another program.
    pub fn keeping(output: Kept, messages: Kept) -> Self {
        Self {
            messages: Some(messages),
            ..Self::over(Box::new(output), false)
        }
    }

    /// Prints a result.
    pub fn print(&mut self, text: &str) -> Result<(), Error> {
        self.write(|out| out.write_all(text.as_bytes()))
    }

    /// Prints a JSON value, indented on a terminal.
    pub fn print_json(&mut self, value: &impl serde::Serialize) -> Result<(), Error> {
        let text = if self.output.get_ref().is_terminal() {
            serde_json::to_string_pretty(value)
        } else {
            serde_json::to_string(value)
        };
        self.print(&text.map_err(Error::system)?)?;
        self.print("\n")
    }

    /// Calls a function that writes to standard output.
    pub fn write(
        &mut self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Error> {
        let written = match self.closed {
            true => Err(not_written("it is closed")),
            false => content(&mut self.output).map_err(unwritten),
        };
        self.told |= written.is_err();
        written
    }

    /// Flushes the printed text. A failure is reported only once.
    pub fn flush(&mut self) -> Result<(), Error> {
        if self.told {
            return Ok(());
        }
        let sent = self.output.flush().map_err(unwritten);
        self.told |= sent.is_err();
        sent
    }

    /// The result of a command, from whether its results could be printed and from its outcome. The outcome has
    /// precedence: a user who stops reading, as in `bryant run MODEL | head -1`, is still told that a run cannot be
    /// trusted.
    pub fn end(&self, printed: Result<(), Error>, outcome: Result<(), Error>) -> Result<(), Error> {
        if let (Err(lost), Err(_)) = (&printed, &outcome) {
            lost.report(self);
        }
        outcome.and(printed)
    }

    /// Prints a line of information on standard error.
    pub fn note(&mut self, text: &str) {
        // keeps the order of texts if both outputs go to one terminal
        let _ = self.output.flush();
        let text = match message_width().filter(|_| self.messages.is_none()) {
            Some(width) => fitted(text, width),
            None => text.to_owned(),
        };
        self.message(&text);
    }

    /// Prints an error with its remedy.
    pub fn error(&self, message: &str) {
        let (red, cyan, reset) = if self.colour() {
            ("\x1b[1;31m", "\x1b[1;36m", "\x1b[0m")
        } else {
            ("", "", "")
        };
        let message = message.replace("\n  help:", &format!("\n  {cyan}help:{reset}"));
        self.message(&format!("{red}error:{reset} {message}"));
    }

    /// Prints an error that is already formatted.
    pub fn error_text(&self, text: &str) {
        self.message(text);
    }

    /// Prints a message.
    fn message(&self, text: &str) {
        let _ = match &self.messages {
            Some(kept) => writeln!(kept.clone(), "{text}"),
            None => writeln!(io::stderr(), "{text}"),
        };
    }

    /// True if messages go to a terminal, where they can be replaced.
    pub fn shows_messages(&self) -> bool {
        self.messages.is_none() && io::stderr().is_terminal()
    }

    /// Where messages are kept for the program that the command runs in; `None` if they go to standard error.
    pub fn kept_messages(&self) -> Option<&Kept> {
        self.messages.as_ref()
    }

    /// True if messages are coloured.
    pub fn colour(&self) -> bool {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|t| t == "dumb");
        self.shows_messages() && !refused && !dumb && process::shows_colours()
    }

    /// Width of standard output in characters; `None` if it is not a terminal.
    pub fn width(&self) -> Option<usize> {
        let output = self.output.get_ref();
        if !output.is_terminal() {
            return None;
        }
        output.width().map(|width| width.max(NARROWEST))
    }

    /// The time when the command began.
    pub fn begin(&self) -> Instant {
        self.begin
    }
}

/// Text that a command prints, kept for the program that it runs in.
#[derive(Clone, Debug, Default)]
pub struct Kept(Arc<Mutex<Vec<u8>>>);

impl Kept {
    /// What was printed.
    pub fn text(&self) -> String {
        let bytes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

impl Write for Kept {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Output for Kept {
    fn is_terminal(&self) -> bool {
        false
    }

    fn width(&self) -> Option<usize> {
        None
    }
}

/// Width of standard error in characters; `None` if it is not a terminal.
fn message_width() -> Option<usize> {
    if !io::stderr().is_terminal() {
        return None;
    }
    let (width, _) = terminal_size::terminal_size_of(io::stderr())?;
    Some(usize::from(width.0).max(NARROWEST))
}

/// The text with lines of at most `width` characters. A line that is too long is broken between words; what follows
/// hangs below its beginning, two characters further in. Lines that fit stay as they are.
pub fn fitted(text: &str, width: usize) -> String {
    let mut lines = Vec::new();
    for line in text.lines() {
        if line.chars().count() <= width {
            lines.push(line.to_owned());
            continue;
        }
        let own = line.len() - line.trim_start().len();
        for (index, part) in wrap(line, width - (own + HANGING).min(width / 2))
            .iter()
            .enumerate()
        {
            let indent = if index == 0 { own } else { own + HANGING };
            lines.push(format!("{:indent$}{part}", ""));
        }
    }
    lines.join("\n")
}

/// The error for output that could not be printed. A reader that is gone is not an error for the user.
pub fn unwritten(error: io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::BrokenPipe => Error::Closed,
        _ => not_written(error),
    }
}

fn not_written(reason: impl std::fmt::Display) -> Error {
    Error::System(format!("cannot write to standard output: {reason}"))
}
