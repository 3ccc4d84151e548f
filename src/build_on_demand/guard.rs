//! What a function of the user's may do to the whole program, and what is said of it then.
//!
//! | the function | what happens |
//! |---|---|
//! | calls `exit` | a handler of the system's, called on the way out, says so and ends the program with 3 |
//! | aborts, overflows its stack, reads where nothing is | a handler of signals says so, and the signal ends the program as ever |
//! | prints | it goes to standard error: standard output is moved out of its reach |
//!
//! A flag of each thread says which force is being evaluated there. Where the system is not Unix there is only the flag.
#![cfg_attr(
    unix,
    expect(unsafe_code, reason = "handlers of exits and signals are the system's")
)]

use std::cell::Cell;

/// Exit code of a program that a function ended: the simulation failed on the way.
pub const EXIT_CODE: i32 = 3;

thread_local! {
    /// What is being evaluated on this thread, for people.
    static INSIDE: Cell<Option<&'static str>> = const { Cell::new(None) };
}

/// While it lives, something of the user's is evaluated on this thread.
pub struct Inside(());

impl Inside {
    /// Begins; `what` is for people, as in: the user force "drag" (drag.rs).
    #[inline]
    pub fn of(what: &'static str) -> Self {
        INSIDE.set(Some(what));
        Inside(())
    }
}

impl Drop for Inside {
    #[inline]
    fn drop(&mut self) {
        INSIDE.set(None);
    }
}

/// Sees to it that nothing that is evaluated ends the program without a word. To be called before the first [`Inside`]; more often does no
/// harm.
pub fn watch() {
    #[cfg(unix)]
    unix::watch();
}

/// Standard output for results alone: from now on whatever else is written to standard output goes to standard error. Where that cannot be, it
/// is standard output as it was.
pub fn stdout_for_results() -> Box<dyn Output> {
    #[cfg(unix)]
    if let Some(file) = unix::moved_stdout() {
        return Box::new(file);
    }
    Box::new(std::io::stdout())
}

/// Where results are written.
pub trait Output: std::io::Write + std::io::IsTerminal {
    /// Characters of a line, of a terminal.
    fn width(&self) -> Option<usize>;
}

impl Output for std::io::Stdout {
    fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size::terminal_size_of(std::io::stdout())?;
        Some(width.0.into())
    }
}

#[cfg(unix)]
impl Output for std::fs::File {
    fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size::terminal_size_of(self)?;
        Some(width.0.into())
    }
}

#[cfg(unix)]
mod unix {
    use super::{EXIT_CODE, INSIDE};
    use libc::{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, c_int, c_void, sigaction, siginfo_t};
    use std::fs::File;
    use std::os::fd::FromRawFd;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::{Once, OnceLock};

    /// Signals that a fault raises, and what is said of each.
    const SIGNALS: [(c_int, &str); 5] = [
        (SIGABRT, " aborted the program"),
        (
            SIGSEGV,
            " ended the program: it calls itself without end, or reads where nothing is",
        ),
        (SIGBUS, " ended the program: it reads where nothing is"),
        (SIGILL, " ended the program by an instruction that is none"),
        (SIGFPE, " ended the program by a division of whole numbers"),
    ];
    const HELP: &str = "\n  help: mend the function\n";
    const EXITED: &str = " ended the program: it calls `exit`\n  help: return from the function instead; it can end nothing\n";

    /// What was to be done with these signals before.
    static BEFORE: OnceLock<[sigaction; 5]> = OnceLock::new();
    /// Of two signals for one fault the first is told.
    static TOLD: AtomicBool = AtomicBool::new(false);

    pub fn watch() {
        static ONCE: Once = Once::new();
        ONCE.call_once(|| {
            // SAFETY: the handlers live as long as the program, and use nothing that must not be used in one: a constant flag of the thread,
            // `write`, `_exit`, `sigaction` and `raise`. A structure of zeros is one of no flags.
            unsafe {
                libc::atexit(exiting);
                let none: sigaction = std::mem::zeroed();
                let mut before = [none; 5];
                for ((signal, _), before) in SIGNALS.iter().zip(&mut before) {
                    sigaction(*signal, std::ptr::null(), before);
                }
                let _ = BEFORE.set(before);
                let mut new = none;
                new.sa_sigaction = signalled as *const () as usize;
                new.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK;
                libc::sigemptyset(&mut new.sa_mask);
                for (signal, _) in SIGNALS {
                    sigaction(signal, &new, std::ptr::null_mut());
                }
            }
        });
    }

    /// Says what happened to what is being evaluated on this thread; false where nothing is.
    fn tell(what: &str) -> bool {
        let Some(inside) = INSIDE.get() else {
            return false;
        };
        if TOLD.swap(true, Ordering::Relaxed) {
            return true;
        }
        for text in ["error: ", inside, what] {
            // SAFETY: the text is as long as it says. What cannot be written is lost.
            unsafe { libc::write(2, text.as_ptr().cast::<c_void>(), text.len()) };
        }
        true
    }

    extern "C" fn exiting() {
        if tell(EXITED) {
            // SAFETY: it ends the program at once.
            unsafe { libc::_exit(EXIT_CODE) };
        }
    }

    extern "C" fn signalled(signal: c_int, about: *mut siginfo_t, _: *mut c_void) {
        let index = SIGNALS.iter().position(|(of, _)| *of == signal);
        let (Some(index), Some(before)) = (index, BEFORE.get()) else {
            return;
        };
        if tell(SIGNALS[index].1) {
            tell_help();
        }
        // SAFETY: what was to be done before was told by the system. The fault happens once more when this returns, and a signal that was
        // sent is sent again.
        unsafe {
            sigaction(signal, &before[index], std::ptr::null_mut());
            if (*about).si_code <= 0 {
                libc::raise(signal);
            }
        }
    }

    /// The remedy, once.
    fn tell_help() {
        static ONCE: AtomicBool = AtomicBool::new(false);
        if !ONCE.swap(true, Ordering::Relaxed) {
            // SAFETY: as above.
            unsafe { libc::write(2, HELP.as_ptr().cast::<c_void>(), HELP.len()) };
        }
    }

    pub fn moved_stdout() -> Option<File> {
        // SAFETY: the descriptor is new, and nobody else's.
        unsafe {
            let kept = libc::fcntl(1, libc::F_DUPFD_CLOEXEC, 3);
            if kept < 0 {
                return None;
            }
            let kept = File::from_raw_fd(kept);
            (libc::dup2(2, 1) >= 0).then_some(kept)
        }
    }
}
