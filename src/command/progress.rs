//! Shows the progress of a long task: a bar on a terminal, otherwise a line every ten seconds.
//!
//! Progress is counted in simulated time or in items. Bar and lines show the task, the amount that is done, the total,
//! and about how much time is left at the present rate. Commands that take less than ten seconds print no line.

use super::terminal::{Kept, Terminal};
use crate::accuracy::setting::time;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Time after which a task gets a bar.
const PATIENCE: Duration = Duration::from_millis(500);
/// Time between two lines if there is no terminal, unless `BRYANT_PROGRESS` gives another, in seconds.
const BETWEEN_LINES: Duration = Duration::from_secs(10);
/// Time after which the rate is known well enough to estimate the remaining time.
const WATCHED: Duration = Duration::from_secs(1);
/// Time between updates of the bar.
const TICK: Duration = Duration::from_millis(250);

/// The total of a task.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Whole {
    /// Simulated time, with its total \[s\].
    Time(f64),
    /// Items, with their total number: (216, "effects").
    Count(u64, &'static str),
    /// The amount is a share of the whole.
    Share,
    /// The total is not known.
    Unknown,
}

/// The progress of a task. Several threads may report to it.
pub struct Progress {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    state: Mutex<State>,
    /// Signals the end of the task.
    over: Condvar,
    /// The time when the command began.
    command: Instant,
    /// Where messages are kept for the program that the command runs in.
    messages: Option<Kept>,
}

pub struct State {
    pub what: String,
    pub whole: Whole,
    /// The time when counting began, the amount at this time, and the present amount.
    pub since: Instant,
    pub from: f64,
    pub done: f64,
    /// Estimated time of the tasks that follow \[s\].
    pub later: f64,
    pub over: bool,
    pub bar: Option<ProgressBar>,
}

impl Progress {
    /// Begins a task, such as "running occupant", with the amount 0.
    pub fn new(terminal: &Terminal, what: String, whole: Whole) -> Self {
        let shared = Arc::new(Shared {
            state: Mutex::new(State {
                what,
                whole,
                since: Instant::now(),
                from: 0.0,
                done: 0.0,
                later: 0.0,
                over: false,
                bar: None,
            }),
            over: Condvar::new(),
            command: terminal.begin(),
            messages: terminal.kept_messages().cloned(),
        });
        let of_thread = Arc::clone(&shared);
        let shown = terminal.shows_messages();
        let spawn = || {
            std::thread::Builder::new().spawn(move || match shown {
                true => of_thread.show_bar(),
                false => of_thread.print_lines(),
            })
        };
        Progress {
            // if the thread cannot be started, no progress is shown; within another program it never is
            thread: match terminal.kept_messages() {
                Some(_) => None,
                None => spawn().ok(),
            },
            shared,
        }
    }

    /// The progress of deriving the equations of a model, which takes only moments.
    pub fn deriving(terminal: &Terminal, model: &str) -> Self {
        let what = format!("deriving the equations of {model}");
        Progress::new(terminal, what, Whole::Unknown)
    }

    /// Sets the amount that is done: simulated time \[s\], items, or the share of the whole. If it decreases, the task
    /// has begun again.
    pub fn set(&self, done: f64) {
        let mut state = self.shared.lock();
        if done < state.done {
            (state.since, state.from) = (Instant::now(), done);
        }
        state.done = done;
    }

    /// Begins another task, with the amount 0.
    pub fn next(&self, what: String, whole: Whole) {
        self.next_from(what, whole, 0.0);
    }

    /// Begins another task, part of which is already done.
    pub fn next_from(&self, what: String, whole: Whole, done: f64) {
        let mut state = self.shared.lock();
        (state.what, state.whole, state.later) = (what, whole, 0.0);
        (state.since, state.from, state.done) = (Instant::now(), done, done);
    }

    /// Sets the estimated time of the tasks after this one \[s\].
    pub fn later(&self, seconds: f64) {
        self.shared.lock().later = seconds;
    }

    /// Prints a line without disturbing the bar.
    pub fn say(&self, text: &str) {
        self.shared.say(text);
    }

    /// A function that prints lines without disturbing the bar.
    pub fn teller(&self) -> impl Fn(&str) + Sync + use<> {
        let shared = Arc::clone(&self.shared);
        move |text| shared.say(text)
    }

    /// Calls `print`, which may print results without disturbing the bar.
    pub fn beside<R>(&self, print: impl FnOnce() -> R) -> R {
        let state = self.shared.lock();
        match &state.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }
}

impl Drop for Progress {
    /// Ends the task and removes the bar.
    fn drop(&mut self) {
        self.shared.lock().over = true;
        self.shared.over.notify_all();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn say(&self, text: &str) {
        let state = self.lock();
        let print = || {
            let _ = match &self.messages {
                Some(kept) => writeln!(kept.clone(), "{text}"),
                None => writeln!(io::stderr(), "{text}"),
            };
        };
        match &state.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }

    /// Waits for this time, or until the task is over; returns `None` if it is over.
    fn wait(&self, length: Duration) -> Option<MutexGuard<'_, State>> {
        let end = Instant::now() + length;
        let mut state = self.lock();
        loop {
            let left = end.saturating_duration_since(Instant::now());
            if state.over {
                return None;
            }
            if left.is_zero() {
                return Some(state);
            }
            let waited = self.over.wait_timeout(state, left);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
        }
    }

    /// Prints a line at regular times, counted from the beginning of the command.
    fn print_lines(&self) {
        let asked = std::env::var("BRYANT_PROGRESS").ok();
        let asked = asked.and_then(|seconds| seconds.parse().ok());
        let between = asked.filter(|seconds| (0.1..1e6).contains(seconds));
        let between = between.unwrap_or(BETWEEN_LINES.as_secs_f64());
        loop {
            let left = between - self.command.elapsed().as_secs_f64() % between;
            let Some(state) = self.wait(Duration::from_secs_f64(left)) else {
                return;
            };
            let _ = writeln!(io::stderr(), "{}", state.line());
        }
    }

    fn show_bar(&self) {
        if self.wait(PATIENCE).is_none() {
            return;
        }
        let bar = ProgressBar::new(1000);
        bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
        // the templates are valid; if one were not, the default bar would be used
        let style = |template| {
            let style = ProgressStyle::with_template(template);
            style.unwrap_or_else(|_| ProgressStyle::default_bar())
        };
        let of_known = style("[{bar:20}] {msg}").progress_chars("=> ");
        let of_unknown = style("{spinner} {msg}");
        self.lock().bar = Some(bar.clone());
        while let Some(state) = self.wait(TICK) {
            bar.set_style(match state.whole {
                Whole::Unknown => of_unknown.clone(),
                _ => of_known.clone(),
            });
            bar.set_position((1000.0 * state.part()) as u64);
            bar.set_message(state.line());
        }
        self.lock().bar = None;
        bar.finish_and_clear();
    }
}

impl State {
    /// The total amount.
    fn all(&self) -> f64 {
        match self.whole {
            Whole::Time(all) => all,
            Whole::Count(all, _) => all as f64,
            Whole::Share | Whole::Unknown => 1.0,
        }
    }

    /// The share that is done.
    fn part(&self) -> f64 {
        (self.done / self.all().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }

    /// The line about the task: "running occupant: 12 of 120 ms simulated, about 40 s left"
    pub fn line(&self) -> String {
        let amount = match self.whole {
            Whole::Time(all) => {
                format!("{} of {} simulated", time(self.done), time(all))
            }
            Whole::Unknown => format!("{} so far", span(self.since.elapsed().as_secs() as f64)),
            Whole::Count(all, things) => format!("{} of {all} {things}", self.done),
            Whole::Share => format!("{:.0} %", 100.0 * self.part()),
        };
        let left = match self.left(self.since.elapsed()) {
            Some(left) => format!(", about {} left", span(left)),
            None => String::new(),
        };
        format!("{}: {amount}{left}", self.what)
    }

    /// Estimated remaining time \[s\], at the rate of the time `watched`; `None` if the rate is not known.
    pub fn left(&self, watched: Duration) -> Option<f64> {
        let rate = (self.done - self.from) / watched.as_secs_f64();
        let known = watched >= WATCHED && rate > 0.0;
        known.then(|| (self.all() - self.done).max(0.0) / rate + self.later)
    }
}

/// A span of time in at most two units: "40 s", "1 min 5 s", "2 h 1 min".
pub fn span(seconds: f64) -> String {
    let seconds = seconds.ceil().min(1e9) as u64;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    match (hours, minutes) {
        (0, 0) => format!("{seconds} s"),
        (0, _) => format!("{minutes} min {} s", seconds % 60),
        _ => format!("{hours} h {minutes} min"),
    }
}
