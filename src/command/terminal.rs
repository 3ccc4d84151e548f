//! Standard output and standard error: what is a terminal, how wide, in colour or not; no panic when nobody reads.

use super::Error;
use crate::build_on_demand::guard::{self, Output};
use std::io::{self, BufWriter, IsTerminal, Write};
use std::time::Instant;

/// Where results and messages go.
pub struct Terminal {
    output: BufWriter<Box<dyn Output>>,
    begin: Instant,
}

impl Terminal {
    /// Of this process. What a function of the user's prints goes to standard error from now on, so that it stands in no result.
    pub fn new() -> Self {
        Self {
            output: BufWriter::new(guard::stdout_for_results()),
            begin: Instant::now(),
        }
    }

    /// Prints a result.
    pub fn print(&mut self, text: &str) -> Result<(), Error> {
        self.output.write_all(text.as_bytes()).map_err(closed)
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

    /// Lets something write to standard output.
    pub fn write(
        &mut self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), Error> {
        content(&mut self.output).map_err(closed)
    }

    /// Sends off what was printed.
    pub fn flush(&mut self) -> Result<(), Error> {
        self.output.flush().map_err(closed)
    }

    /// A line about what was done, beside the results.
    pub fn note(&mut self, text: &str) {
        // Where both go to one terminal, the order is that of the calls.
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

    /// An error that is drawn already.
    pub fn error_text(&self, text: &str) {
        let _ = writeln!(io::stderr(), "{text}");
    }

    /// Whether messages are coloured.
    pub fn colour(&self) -> bool {
        let refused = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let dumb = std::env::var_os("TERM").is_some_and(|t| t == "dumb");
        io::stderr().is_terminal() && !refused && !dumb
    }

    /// Characters per line of standard output; `None` where it is no terminal.
    pub fn width(&self) -> Option<usize> {
        let output = self.output.get_ref();
        if !output.is_terminal() {
            return None;
        }
        output.width().map(|width| width.max(40))
    }

    /// When the command began.
    pub fn begin(&self) -> Instant {
        self.begin
    }
}

fn closed(error: io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::BrokenPipe => Error::Closed,
        _ => Error::System(format!("cannot write to standard output: {error}")),
    }
}
