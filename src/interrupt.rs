//! Ctrl-C: what is being computed comes to an end, and what was computed is kept.
//!
//! A command that computes for long calls [`watch`] when it begins. From then on the first Ctrl-C makes [`asked`] true, and whatever works on
//! parts of a whole begins no further part; the second one ends the program at once, as ever. Where the system is not Unix, the first does.
#![cfg_attr(
    unix,
    expect(unsafe_code, reason = "handlers of signals are the system's")
)]

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a command that was interrupted: 128 and the number of the signal, as shells have it.
pub const EXIT_CODE: u8 = 130;

static ASKED: AtomicBool = AtomicBool::new(false);

/// Whether somebody pressed Ctrl-C since [`watch`].
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Breaks off where [`asked`].
pub fn unless_asked() -> ControlFlow<()> {
    match asked() {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    }
}

/// Waits for Ctrl-C. A program that was started to ignore it goes on to.
pub fn watch() {
    #[cfg(unix)]
    unix::watch();
}

#[cfg(unix)]
mod unix {
    use super::{ASKED, Ordering};
    use libc::{SA_RESETHAND, SA_RESTART, SIG_IGN, SIGINT, c_int, c_void, sigaction};

    const SAID: &str = "\nstopping; Ctrl-C again ends at once\n";

    pub fn watch() {
        // SAFETY: the handler lives as long as the program, and uses an atomic flag and `write` alone. A structure of zeros is one of no flags.
        unsafe {
            let mut action: sigaction = std::mem::zeroed();
            sigaction(SIGINT, std::ptr::null(), &mut action);
            if action.sa_sigaction == SIG_IGN {
                return;
            }
            action.sa_sigaction = interrupted as *const () as usize;
            // after the first the signal does what it did before
            action.sa_flags = SA_RESETHAND | SA_RESTART;
            libc::sigemptyset(&mut action.sa_mask);
            sigaction(SIGINT, &action, std::ptr::null_mut());
        }
    }

    extern "C" fn interrupted(_: c_int) {
        ASKED.store(true, Ordering::Relaxed);
        // SAFETY: the text is as long as it says. What cannot be written is lost.
        unsafe { libc::write(2, SAID.as_ptr().cast::<c_void>(), SAID.len()) };
    }
}
