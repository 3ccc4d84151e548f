//! Standard output and standard error: whether they are terminals, their width, their colours. There is no panic when nobody reads.

use super::Error;
use crate::build_on_demand::guard::{self, Output};
use crate::process;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::time::Instant;

/// Where results and messages go.
pub struct Terminal {
    output: BufWriter<Box<dyn Output>>,
    /// Whether standard output is closed: printed text is then lost.
    closed: bool,
    /// Whether the user has been told that something could not be printed.
    told: bool,
    begin: Instant,
}

impl Terminal {
    /// The terminal of this process. From now on, output of user functions goes to standard error, so that it does not mix with results.
    pub fn new() -> Self {
        // asked before standard output is moved
        let closed = process::stdout_was_closed();
        Self {
            output: BufWriter::new(guard::stdout_for_results()),
            closed,
            told: false,
            begin: Instant::now(),
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

    /// Lets a function write to standard output.
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

    /// Sends the printed text off. A failure is reported only once.
    pub fn flush(&mut self) -> Result<(), Error> {
        if self.told {
            return Ok(());
        }
        let sent = self.output.flush().map_err(unwritten);
        self.told |= sent.is_err();
        sent
    }

    /// The end of a command: `printed` tells whether its results could be printed, `outcome` how it ended. The outcome counts more: a user
    /// who stops reading, as in `bryant run MODEL | head -1`, is told as well that a run cannot be trusted.
    pub fn end(&self, printed: Result<(), Error>, outcome: Result<(), Error>) -> Result<(), Error> {
        if let (Err(lost), Err(_)) = (&printed, &outcome) {
            lost.report(self);
        }
        outcome.and(printed)
    }

    /// Prints a line beside the results about what was done.
    pub fn note(&mut self, text: &str) {
        // if both go to one terminal, the text appears in the order of the calls
        let _ = self.output.flush();
        let _ = writeln!(io::stderr(), "{text}");
    }

    /// An error with its remedy.
    pub fn error(&self, message: &str) {
        let (red, cyan, reset) = if self.colour() {
            ("\x1b[1;31m", "\x1b[1;36m", "\x1b[0m")
        } else {
            ("", "", "")
        };
        let message = message.replace("\n  help:", &format!("\n  {cyan}help:{reset}"));
        let _ = writeln!(io::stderr(), "{red}error:{reset} {message}");
    }

    /// Prints an error that is already formatted.
    pub fn error_text(&self, text: &str) {
        let _ = writeln!(io::stderr(), "{text}");
    }

    /// Whether messages are coloured.
    pub fn colour(&self) -> bool {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|t| t == "dumb");
        io::stderr().is_terminal() && !refused && !dumb && process::shows_colours()
    }

    /// Characters per line of standard output; `None` where it is no terminal.
    pub fn width(&self) -> Option<usize> {
        let output = self.output.get_ref();
        if !output.is_terminal() {
            return None;
        }
        output.width().map(|width| width.max(40))
    }

    /// The time when the command began.
    pub fn begin(&self) -> Instant {
        self.begin
    }
}

/// The error of output that could not be printed; no error if nobody reads any more.
pub fn unwritten(error: io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::BrokenPipe => Error::Closed,
        _ => not_written(error),
    }
}

fn not_written(reason: impl std::fmt::Display) -> Error {
    Error::System(format!("cannot write to standard output: {reason}"))
}
