//! How far something is that takes long: a bar on a terminal, elsewhere a line every ten seconds.
//!
//! What is done is counted in simulated time or in things. Both ways to show it say the same: what, how much of how much, and about how long it
//! still takes at the rate so far. Commands that take less than ten seconds print no line.

use super::terminal::Terminal;
use crate::accuracy::setting::time;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// What takes no longer than this shows no bar.
const PATIENCE: Duration = Duration::from_millis(500);
/// Between two lines where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);
/// A rate is not told before it was watched so long.
const WATCHED: Duration = Duration::from_secs(1);
/// What a bar knows of time passes this often.
const TICK: Duration = Duration::from_millis(250);

/// What is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Whole {
    /// Simulated time, so much in all \[s\].
    Time(f64),
    /// So many of these in all: (216, "effects").
    Count(u64, &'static str),
    /// Parts of something.
    Share,
    /// Nothing: how long it takes is not known.
    Unknown,
}

/// How far something is. Several threads may say so.
pub struct Progress {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    state: Mutex<State>,
    /// Told when it is over.
    over: Condvar,
    /// When the command began.
    command: Instant,
}

struct State {
    what: String,
    whole: Whole,
    /// Since when this is counted, from which amount on, and how much is done.
    since: Instant,
    from: f64,
    done: f64,
    /// What follows when it is done, about \[s\].
    later: f64,
    over: bool,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Begins, at nothing: "running occupant".
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
        });
        let of_thread = Arc::clone(&shared);
        let terminal = io::stderr().is_terminal();
        let thread = std::thread::Builder::new().spawn(move || match terminal {
            true => of_thread.show_bar(),
            false => of_thread.print_lines(),
        });
        Progress {
            shared,
            // without a thread nothing is shown
            thread: thread.ok(),
        }
    }

    /// Of the equations of a model, which takes moments.
    pub fn deriving(terminal: &Terminal, model: &str) -> Self {
        let what = format!("deriving the equations of {model}");
        Progress::new(terminal, what, Whole::Unknown)
    }

    /// So much is done: seconds of simulated time, things, or the share of the whole. Less than before: it began again.
    pub fn set(&self, done: f64) {
        let mut state = self.shared.lock();
        if done < state.done {
            (state.since, state.from) = (Instant::now(), done);
        }
        state.done = done;
    }

    /// Something else is counted from now on, from nothing.
    pub fn next(&self, what: String, whole: Whole) {
        self.next_from(what, whole, 0.0);
    }

    /// The same where so much was done already when it began.
    pub fn next_from(&self, what: String, whole: Whole, done: f64) {
        let mut state = self.shared.lock();
        (state.what, state.whole, state.later) = (what, whole, 0.0);
        (state.since, state.from, state.done) = (Instant::now(), done, done);
    }

    /// What follows this takes about so long \[s\].
    pub fn later(&self, seconds: f64) {
        self.shared.lock().later = seconds;
    }

    /// Prints a line beside it.
    pub fn say(&self, text: &str) {
        self.shared.say(text);
    }

    /// What prints lines beside it for others.
    pub fn teller(&self) -> impl Fn(&str) + Sync + use<> {
        let shared = Arc::clone(&self.shared);
        move |text| shared.say(text)
    }

    /// Prints results beside it.
    pub fn beside<R>(&self, print: impl FnOnce() -> R) -> R {
        let state = self.shared.lock();
        match &state.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }
}

impl Drop for Progress {
    /// It is over, and leaves no bar.
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
            let _ = writeln!(io::stderr(), "{text}");
        };
        match &state.bar {
            Some(bar) => bar.suspend(print),
            None => print(),
        }
    }

    /// Waits so long, or until it is over; the state, unless it is over.
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

    /// A line at every ten seconds of the command.
    fn print_lines(&self) {
        loop {
            let into = self.command.elapsed().as_secs_f64() % BETWEEN_LINES.as_secs_f64();
            let Some(state) = self.wait(BETWEEN_LINES - Duration::from_secs_f64(into)) else {
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
        // a template that cannot be read would be a mistake in this file; the usual bar then
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
    /// How much there is in all.
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

    /// "running occupant: 12 of 120 ms simulated, about 40 s left"
    fn line(&self) -> String {
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

    /// How long it still takes \[s\] at the rate since it began; `None` where that is not known.
    fn left(&self, watched: Duration) -> Option<f64> {
        let rate = (self.done - self.from) / watched.as_secs_f64();
        let known = watched >= WATCHED && rate > 0.0;
        known.then(|| (self.all() - self.done).max(0.0) / rate + self.later)
    }
}

/// A span of time in two units at most: "40 s", "1 min 5 s", "2 h 1 min".
fn span(seconds: f64) -> String {
    let seconds = seconds.ceil().min(1e9) as u64;
    let (hours, minutes) = (seconds / 3600, seconds / 60 % 60);
    match (hours, minutes) {
        (0, 0) => format!("{seconds} s"),
        (0, _) => format!("{minutes} min {} s", seconds % 60),
        _ => format!("{hours} h {minutes} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_left_is_told_in_two_units() {
        assert_eq!(span(3.2), "4 s");
        assert_eq!(span(61.0), "1 min 1 s");
        assert_eq!(span(7260.0), "2 h 1 min");
    }

    fn state(whole: Whole, from: f64, done: f64) -> State {
        State {
            what: "running seat".into(),
            whole,
            since: Instant::now(),
            from,
            done,
            later: 0.0,
            over: false,
            bar: None,
        }
    }

    #[test]
    fn what_is_done_is_said_in_its_own_unit() {
        let line = |whole, done| state(whole, 0.0, done).line();
        assert_eq!(
            line(Whole::Time(0.12), 0.012),
            "running seat: 12 ms of 120 ms simulated"
        );
        assert_eq!(
            line(Whole::Count(216, "effects"), 34.0),
            "running seat: 34 of 216 effects"
        );
        assert_eq!(line(Whole::Unknown, 0.0), "running seat: 0 s so far");
        assert_eq!(line(Whole::Share, 0.34), "running seat: 34 %");
    }

    /// What was there at the beginning says nothing of the rate.
    #[test]
    fn the_time_left_is_that_of_the_rate() {
        let of = state(Whole::Count(100, "runs"), 40.0, 60.0);
        assert_eq!(of.left(Duration::from_secs(10)), Some(20.0));
        assert_eq!(of.left(Duration::from_millis(500)), None);
        let of = State { later: 7.0, ..of };
        assert_eq!(of.left(Duration::from_secs(10)), Some(27.0));
        let of = state(Whole::Time(1.0), 0.0, 0.0);
        assert_eq!(of.left(Duration::from_secs(10)), None);
    }
}
