//! What a user function may do to the whole program, and what the program says then.
//!
//! | the function | what happens |
//! |---|---|
//! | calls `exit` | an exit handler of the system says so and ends the program with exit code 3 |
//! | aborts, overflows its stack, reads memory that is not its own | a signal handler on its own stack says so and ends the program with
//! exit code 3 |
//! | does not return | a watching thread says so after ten seconds, or one second after Ctrl-C, and ends the program with exit code 3 |
//! | prints | the output goes to standard error: standard output is moved out of its reach |
//!
//! A flag of each thread says which force it evaluates.
//!
//! On Windows a callback at the end of the thread that ends the process, and a handler of exceptions, take the place of exit and signal handlers. A
//! function that aborts cannot be caught there: the system ends the program at once, with an exit code that is not 0. On systems that are neither
//! Unix nor Windows there are only the flag and the watching thread.
#![expect(
    unsafe_code,
    reason = "handlers of exits and signals are the system's; threads read what others point to"
)]

use crate::interrupt;
use std::cell::Cell;
use std::sync::atomic::{AtomicPtr, AtomicU64, Ordering};
use std::sync::{Mutex, Once, PoisonError};
use std::time::Duration;

/// Exit code if a user function ended the program: the simulation failed on the way.
pub const EXIT_CODE: i32 = 3;

/// A description of a user function, for people: the user force "drag" (drag.rs).
#[derive(Debug)]
pub struct What(String);

impl What {
    /// The text is kept until the process ends, because signal handlers read it.
    pub fn new(text: String) -> &'static What {
        Box::leak(Box::new(What(text)))
    }
}

/// The user function that a thread evaluates, for the watching thread.
struct Calls {
    /// Number of calls that have begun.
    count: AtomicU64,
    /// The function that is being called; null between two calls.
    now: AtomicPtr<What>,
}

/// The calls of all threads that ever called a user function.
static THREADS: Mutex<Vec<&'static Calls>> = Mutex::new(Vec::new());

thread_local! {
    /// The function that is being evaluated on this thread.
    static INSIDE: Cell<Option<&'static What>> = const { Cell::new(None) };
    static CALLS: &'static Calls = {
        let calls: &'static Calls = Box::leak(Box::new(Calls {
            count: AtomicU64::new(0),
            now: AtomicPtr::new(std::ptr::null_mut()),
        }));
        THREADS.lock().unwrap_or_else(PoisonError::into_inner).push(calls);
        #[cfg(windows)]
        windows::watch_thread();
        calls
    };
}

/// While this value lives, a user function is being evaluated on this thread.
pub struct Inside(&'static Calls);

impl Inside {
    /// Begins a call.
    #[inline]
    pub fn of(what: &'static What) -> Self {
        INSIDE.set(Some(what));
        let calls = CALLS.with(|calls| *calls);
        // only this thread changes the count
        let count = calls.count.load(Ordering::Relaxed);
        calls.count.store(count + 1, Ordering::Relaxed);
        let what = std::ptr::from_ref(what).cast_mut();
        calls.now.store(what, Ordering::Relaxed);
        Inside(calls)
    }
}

impl Drop for Inside {
    #[inline]
    fn drop(&mut self) {
        INSIDE.set(None);
        self.0.now.store(std::ptr::null_mut(), Ordering::Relaxed);
    }
}

/// Time between two looks at the threads.
const LOOK: Duration = Duration::from_millis(250);
/// A call does not return if this many looks find it: ten seconds, in which a function is otherwise called a million times. Looks are
/// counted instead of time, so that a halted process is not accused.
const PATIENCE: u32 = 40;
/// The same after Ctrl-C, which cannot be handled during a call.
const PATIENCE_WHEN_INTERRUPTED: u32 = 4;

/// Starts the watching thread.
fn look_on() {
    static ONCE: Once = Once::new();
    // without this thread, an endless call goes on for ever
    ONCE.call_once(|| drop(std::thread::Builder::new().spawn(look_for_ever)));
}

fn look_for_ever() {
    let mut seen: Vec<(u64, u32)> = Vec::new();
    loop {
        std::thread::sleep(LOOK);
        let threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
        seen.resize(threads.len(), (0, 0));
        for (calls, (count, looks)) in threads.iter().zip(&mut seen) {
            let (what, now) = (
                calls.now.load(Ordering::Relaxed),
                calls.count.load(Ordering::Relaxed),
            );
            *looks = match !what.is_null() && now == *count {
                true => *looks + 1,
                false => 0,
            };
            *count = now;
            let interrupted = interrupt::asked() && *looks >= PATIENCE_WHEN_INTERRUPTED;
            if interrupted || *looks >= PATIENCE {
                // SAFETY: a pointer that is not null points to a `What`, which lives as long as the process.
                let Some(what) = (unsafe { what.as_ref() }) else {
                    continue;
                };
                let seconds = f64::from(*looks) * LOOK.as_secs_f64();
                eprintln!(
                    "error: {} does not return: one call of it has taken {seconds:.0} s\n  \
                     help: end its loops; nothing of the run is kept, for it cannot be stopped otherwise",
                    what.0
                );
                end();
            }
        }
    }
}

/// Ends the program at once.
fn end() -> ! {
    // SAFETY: it ends the program at once; exit handlers would wait for the call.
    #[cfg(unix)]
    unsafe {
        libc::_exit(EXIT_CODE)
    }
    #[cfg(windows)]
    windows::end();
    #[cfg(not(any(unix, windows)))]
    std::process::exit(EXIT_CODE)
}

/// Ensures that no user function ends the program without a message. It is to be called before the first [`Inside`]; calling it more often
/// does no harm.
pub fn watch() {
    look_on();
    #[cfg(unix)]
    unix::watch();
    #[cfg(windows)]
    windows::watch();
}

/// Standard output for results only: from now on, all other writes to standard output go to standard error. If that is not possible,
/// standard output stays as it was.
pub fn stdout_for_results() -> Box<dyn Output> {
    #[cfg(unix)]
    if let Some(file) = unix::moved_stdout() {
        return Box::new(file);
    }
    #[cfg(windows)]
    if let Some(file) = windows::moved_stdout() {
        return Box::new(file);
    }
    Box::new(std::io::stdout())
}

/// A place where results are written.
pub trait Output: std::io::Write + std::io::IsTerminal {
    /// Width of a line in characters, if it is a terminal.
    fn width(&self) -> Option<usize>;
}

impl Output for std::io::Stdout {
    fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size::terminal_size_of(std::io::stdout())?;
        Some(width.0.into())
    }
}

#[cfg(any(unix, windows))]
impl Output for std::fs::File {
    fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size::terminal_size_of(self)?;
        Some(width.0.into())
    }
}

/// What is said when a function ends the program.
#[cfg(any(unix, windows))]
mod words {
    pub const HELP: &str = "\n  help: correct the function\n";
    pub const EXITED: &str = " ended the program: it calls `exit`\n  help: return from the function instead; it must not end the program\n";
    pub const MEMORY: &str =
        " ended the program: it calls itself without end, or reads memory that is not its own";
    pub const INSTRUCTION: &str = " ended the program by an invalid instruction";
    pub const DIVISION: &str = " ended the program by an invalid division of integers";
}

#[cfg(unix)]
mod unix {
    use super::words::{DIVISION, EXITED, HELP, INSTRUCTION, MEMORY};
    use super::{INSIDE, end};
    use libc::{SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, c_int, c_void, sigaction, siginfo_t};
    use std::fs::File;
    use std::os::fd::FromRawFd;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::{Once, OnceLock};

    /// The signals of faults, and the message for each.
    const SIGNALS: [(c_int, &str); 5] = [
        (SIGABRT, " aborted the program"),
        (SIGSEGV, MEMORY),
        (
            SIGBUS,
            " ended the program: it reads memory that is not its own",
        ),
        (SIGILL, INSTRUCTION),
        (SIGFPE, DIVISION),
    ];

    /// The handlers of these signals before: they are called if the fault is not in a user function.
    static BEFORE: OnceLock<[sigaction; 5]> = OnceLock::new();
    /// If two threads fail at once, only the first one reports.
    static TOLD: AtomicBool = AtomicBool::new(false);

    pub fn watch() {
        static ONCE: Once = Once::new();
        ONCE.call_once(|| {
            // SAFETY: the handlers live as long as the program and use only what a signal handler may use: a constant flag of the thread,
            // `write`, `_exit`, `sigaction` and `raise`. A structure of zeros has no flags.
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

    /// Reports what happened to the user function on this thread, and ends the program. It returns if there is none.
    fn tell(what: &str, help: &str) {
        let Some(inside) = INSIDE.get() else {
            return;
        };
        if TOLD.swap(true, Ordering::Relaxed) {
            // another thread is reporting, and ends the program
            loop {
                // SAFETY: it only waits for a signal.
                unsafe { libc::pause() };
            }
        }
        for text in ["error: ", &inside.0, what, help] {
            // SAFETY: pointer and length are those of the text. A failed write is ignored.
            unsafe { libc::write(2, text.as_ptr().cast::<c_void>(), text.len()) };
        }
        end();
    }

    extern "C" fn exiting() {
        tell(EXITED, "");
    }

    extern "C" fn signalled(signal: c_int, about: *mut siginfo_t, _: *mut c_void) {
        let index = SIGNALS.iter().position(|(of, _)| *of == signal);
        let (Some(index), Some(before)) = (index, BEFORE.get()) else {
            return;
        };
        tell(SIGNALS[index].1, HELP);
        // SAFETY: the system returned the handler before. After this function returns, the fault happens again, and a signal that was sent
        // is sent again.
        unsafe {
            sigaction(signal, &before[index], std::ptr::null_mut());
            if (*about).si_code <= 0 {
                libc::raise(signal);
            }
        }
    }

    pub fn moved_stdout() -> Option<File> {
        // SAFETY: the descriptor is new and has no other owner.
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

#[cfg(windows)]
mod windows {
    use super::words::{DIVISION, EXITED, HELP, INSTRUCTION, MEMORY};
    use super::{EXIT_CODE, INSIDE};
    use std::cell::Cell;
    use std::ffi::c_void;
    use std::fs::File;
    use std::io::{IsTerminal, Write};
    use std::os::windows::io::{AsHandle, AsRawHandle};
    use std::sync::Once;
    use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
    use windows_sys::Win32::Foundation::{
        EXCEPTION_ACCESS_VIOLATION, EXCEPTION_ILLEGAL_INSTRUCTION, EXCEPTION_IN_PAGE_ERROR,
        EXCEPTION_INT_DIVIDE_BY_ZERO, EXCEPTION_INT_OVERFLOW, EXCEPTION_STACK_OVERFLOW, NTSTATUS,
    };
    use windows_sys::Win32::System::Console::{STD_OUTPUT_HANDLE, SetStdHandle};
    use windows_sys::Win32::System::Diagnostics::Debug::{
        AddVectoredExceptionHandler, EXCEPTION_POINTERS,
    };
    use windows_sys::Win32::System::Threading::{
        FLS_OUT_OF_INDEXES, FlsAlloc, FlsSetValue, GetCurrentProcess, TerminateProcess,
    };

    /// The exceptions of faults, and the message for each.
    const EXCEPTIONS: [(NTSTATUS, &str); 6] = [
        (EXCEPTION_ACCESS_VIOLATION, MEMORY),
        (EXCEPTION_IN_PAGE_ERROR, MEMORY),
        (EXCEPTION_STACK_OVERFLOW, MEMORY),
        (EXCEPTION_ILLEGAL_INSTRUCTION, INSTRUCTION),
        (EXCEPTION_INT_DIVIDE_BY_ZERO, DIVISION),
        (EXCEPTION_INT_OVERFLOW, DIVISION),
    ];
    /// What a handler returns so that the system goes on looking for handlers.
    const CONTINUE_SEARCH: i32 = 0;

    /// If two threads fail at once, only the first one reports.
    static TOLD: AtomicBool = AtomicBool::new(false);

    /// The place of each thread whose callback the system calls when the thread ends, or the process by it; none before [`watch`].
    static PLACE: AtomicU32 = AtomicU32::new(FLS_OUT_OF_INDEXES);

    pub fn watch() {
        static ONCE: Once = Once::new();
        // SAFETY: handler and callback live as long as the program.
        ONCE.call_once(|| unsafe {
            // the first of all handlers: that of the standard library leaves little of a stack that is full
            AddVectoredExceptionHandler(1, Some(failed));
            PLACE.store(FlsAlloc(Some(ending)), Ordering::Relaxed);
        });
    }

    /// The same for `exit` on this thread.
    pub fn watch_thread() {
        let place = PLACE.load(Ordering::Relaxed);
        if place != FLS_OUT_OF_INDEXES {
            let any = std::ptr::from_ref(&PLACE).cast();
            // SAFETY: the callback is called where there is any value, and does not use it.
            unsafe { FlsSetValue(place, any) };
        }
    }

    /// Ends the program at once.
    pub fn end() -> ! {
        // SAFETY: it ends this process, without calling what waits for its end.
        unsafe { TerminateProcess(GetCurrentProcess(), EXIT_CODE as u32) };
        std::process::abort()
    }

    /// Reports what happened to the user function on this thread, and ends the program. It returns if there is none.
    fn tell(what: &str, help: &str) {
        let Some(inside) = INSIDE.try_with(Cell::get).ok().flatten() else {
            return;
        };
        if TOLD.swap(true, Ordering::Relaxed) {
            // another thread is reporting, and ends the program
            loop {
                std::thread::park();
            }
        }
        for text in ["error: ", &inside.0, what, help] {
            // a failed write is ignored
            let _ = std::io::stderr().write_all(text.as_bytes());
        }
        end();
    }

    unsafe extern "system" fn failed(about: *mut EXCEPTION_POINTERS) -> i32 {
        // SAFETY: the system passes a record that lives during the call.
        let code = unsafe { (*(*about).ExceptionRecord).ExceptionCode };
        if let Some((_, what)) = EXCEPTIONS.iter().find(|(of, _)| *of == code) {
            tell(what, HELP);
        }
        CONTINUE_SEARCH
    }

    unsafe extern "system" fn ending(_: *const c_void) {
        tell(EXITED, "");
    }

    /// A terminal stays as it is: the library writes characters to it, and a file would write bytes in another encoding.
    pub fn moved_stdout() -> Option<File> {
        let stdout = std::io::stdout();
        if stdout.is_terminal() || crate::process::stdout_was_closed() {
            return None;
        }
        let kept = stdout.as_handle().try_clone_to_owned().ok()?;
        let other = std::io::stderr().as_raw_handle();
        // SAFETY: it only sets which handle the process takes for standard output; that of standard error stays open.
        (unsafe { SetStdHandle(STD_OUTPUT_HANDLE, other) } != 0).then(|| File::from(kept))
    }
}
