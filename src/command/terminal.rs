//! Standard output and standard error: what is a terminal, how wide, in colour or not; no panic when nobody reads.

use super::Error;
use crate::build_on_demand::guard::{self, Output};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, BufWriter, IsTerminal, Write};
use std::time::{Duration, Instant};

/// Where results and messages go.
pub struct Terminal {
    output: BufWriter<Box<dyn Output>>,
}

impl Terminal {
    /// Of this process. What a function of the user's prints goes to standard error from now on, so that it stands in no result.
    pub fn new() -> Self {
        Self {
            output: BufWriter::new(guard::stdout_for_results()),
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

    /// Something of unknown length that goes on; invisible unless messages go to a terminal.
    pub fn spinner(&self) -> ProgressBar {
        let bar = hidden_unless_terminal(ProgressBar::new_spinner());
        bar.enable_steady_tick(Duration::from_millis(100));
        bar
    }

    /// Something of known length; shows itself only after a moment, so that what is fast is not slowed down by it.
    pub fn progress(&self, what: String) -> Progress {
        Progress {
            what,
            start: Instant::now(),
            bar: None,
        }
    }
}

/// How far something has come.
pub struct Progress {
    what: String,
    start: Instant,
    bar: Option<ProgressBar>,
}

/// What takes no longer than this shows no progress.
const PATIENCE: Duration = Duration::from_millis(500);

impl Progress {
    /// Tells which part of the whole is done.
    pub fn set(&mut self, part: f64) {
        if self.bar.is_none() && self.start.elapsed() > PATIENCE {
            let bar = hidden_unless_terminal(ProgressBar::new(1000));
            let style = ProgressStyle::with_template("{msg} [{bar:30}] {percent} %  {eta} left");
            if let Ok(style) = style {
                bar.set_style(style.progress_chars("=> "));
            }
            self.bar = Some(bar.with_message(self.what.clone()));
        }
        if let Some(bar) = &self.bar {
            bar.set_position((1000.0 * part) as u64);
        }
    }

    /// Leaves no trace.
    pub fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

fn hidden_unless_terminal(bar: ProgressBar) -> ProgressBar {
    let target = if io::stderr().is_terminal() {
        ProgressDrawTarget::stderr_with_hz(10)
    } else {
        ProgressDrawTarget::hidden()
    };
    bar.set_draw_target(target);
    bar
}

fn closed(error: io::Error) -> Error {
    match error.kind() {
        io::ErrorKind::BrokenPipe => Error::Closed,
        _ => Error::System(format!("cannot write to standard output: {error}")),
    }
}
