//! Handles Ctrl-C: the computation ends, and the results so far are kept.
//!
//! A long command calls [`watch`] first. The first Ctrl-C then makes [`asked`] return true, and loops do not begin
//! another part of their work. The second Ctrl-C ends the program at once. On systems that are neither Unix nor
//! Windows, the first one does so.
#![cfg_attr(
    any(unix, windows),
    expect(unsafe_code, reason = "handlers of signals are the system's")
)]

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of an interrupted command: 128 plus the number of the signal, as shells define it.
pub const EXIT_CODE: u8 = 130;

static ASKED: AtomicBool = AtomicBool::new(false);

/// True if Ctrl-C was pressed after [`watch`].
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Returns `Break` if Ctrl-C was pressed.
pub fn unless_asked() -> ControlFlow<()> {
    match asked() {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}

/// True where the program that the command runs in handles Ctrl-C.
static HANDLED: AtomicBool = AtomicBool::new(false);

/// From now on, the program handles Ctrl-C itself, and says by [`stop`] that a command should end.
pub fn is_handled() {
    HANDLED.store(true, Ordering::Relaxed);
}

/// Asks the command that runs now to end, as Ctrl-C does, or takes this back before another one begins.
pub fn stop(now: bool) {
    ASKED.store(now, Ordering::Relaxed);
}

/// Begins to handle Ctrl-C. A program that was started to ignore it continues to ignore it.
pub fn watch() {
    if HANDLED.load(Ordering::Relaxed) {
        return;
    }
    #[cfg(unix)]
    unix::watch();
    #[cfg(windows)]
    windows::watch();
}

#[cfg(any(unix, windows))]
const SAID: &str = "\nstopping; Ctrl-C again ends at once\n";

#[cfg(unix)]
mod unix {
    use super::{ASKED, Ordering, SAID};
    use libc::{SA_RESETHAND, SA_RESTART, SIG_IGN, SIGINT, c_int, c_void, sigaction};

    pub fn watch() {
        // SAFETY: the handler lives as long as the program, and uses only an atomic flag and `write`. A structure of
        // zeros has no flags.
        unsafe {
            let mut action: sigaction = std::mem::zeroed();
            sigaction(SIGINT, std::ptr::null(), &mut action);
            if action.sa_sigaction == SIG_IGN {
                return;
            }
            action.sa_sigaction = interrupted as *const () as usize;
            // after its first use, the handler is removed, so that the second signal ends the program
            action.sa_flags = SA_RESETHAND | SA_RESTART;
            libc::sigemptyset(&mut action.sa_mask);
            sigaction(SIGINT, &action, std::ptr::null_mut());
        }
    }

    extern "C" fn interrupted(_: c_int) {
        ASKED.store(true, Ordering::Relaxed);
        // SAFETY: pointer and length are those of the text. A failed write is ignored.
        unsafe { libc::write(2, SAID.as_ptr().cast::<c_void>(), SAID.len()) };
    }
}

#[cfg(windows)]
mod windows {
    use super::{ASKED, Ordering, SAID};
    use std::io::Write;
    use windows_sys::Win32::System::Console::{
        CTRL_BREAK_EVENT, CTRL_C_EVENT, SetConsoleCtrlHandler,
    };
    use windows_sys::core::BOOL;

    pub fn watch() {
        // SAFETY: the handler lives as long as the program. If the system refuses it, the first Ctrl-C ends the
        // program. A program that was started to ignore Ctrl-C never gets this event.
        unsafe { SetConsoleCtrlHandler(Some(interrupted), 1) };
    }

    /// Called by the system on a thread of its own.
    unsafe extern "system" fn interrupted(event: u32) -> BOOL {
        let first = matches!(event, CTRL_C_EVENT | CTRL_BREAK_EVENT)
            && !ASKED.swap(true, Ordering::Relaxed);
        if first {
            // a failed write is ignored
            let _ = std::io::stderr().write_all(SAID.as_bytes());
        }
        // the system ends the program for events that are not handled here
        first.into()
    }
}
