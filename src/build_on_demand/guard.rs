//! Guards the program against user functions that end it, crash or hang: the program reports what happened, and ends
//! with an exit code.
//!
//! | the user function | what happens |
//! |---|---|
//! | calls `exit` | an exit handler reports it and ends the program with exit code 3 |
//! | aborts, overflows its stack, reads memory that is not its own | a signal handler, which has its own stack, reports it and ends the program with exit code 3 |
//! | does not return | a watching thread reports it after ten seconds, or one second after Ctrl-C, and ends the program with exit code 3 |
//! | prints | the output goes to standard error, because standard output is for results |
//!
//! Each thread has a flag that names the user function that it evaluates.
//!
//! On Windows, exit and signal handlers are replaced by a callback at the end of the thread that ends the process, and
//! by a handler of exceptions. Windows cannot catch a function that aborts: the system ends the program at once, with
//! an exit code that is not 0. On systems that are neither Unix nor Windows there are only the flag and the watching
//! thread.
#![expect(
    unsafe_code,
    reason = "handlers of exits and signals are the system's; threads read what others point to"
)]

use crate::interrupt;
use std::cell::Cell;
use std::sync::atomic::{AtomicPtr, AtomicU64, Ordering};
use std::sync::{Mutex, Once, PoisonError};
use std::time::Duration;

/// Exit code if a user function ended the program: that of a simulation that failed.
pub const EXIT_CODE: i32 = 3;

/// The name of a user function for people: the user force "drag" (drag.rs).
#[derive(Debug)]
pub struct What(String);

impl What {
    /// Makes a name, which is kept until the process ends, because signal handlers read it.
    pub fn new(text: String) -> &'static What {
        Box::leak(Box::new(What(text)))
    }
}

/// The calls of user functions on one thread, for the watching thread.
struct Calls {
    /// Number of calls that have begun.
    count: AtomicU64,
    /// The function that is being called; null between two calls.
    now: AtomicPtr<What>,
}

/// The calls of all threads that ever called a user function.
static THREADS: Mutex<Vec<&'static Calls>> = Mutex::new(Vec::new());

thread_local! {
    /// The function that this thread evaluates, for exit and signal handlers.
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

/// A guard that lives while a user function is evaluated on this thread.
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

/// Time between two looks of the watching thread at all calls.
const LOOK: Duration = Duration::from_millis(250);
/// Number of looks after which a call is reported as not returning: ten seconds, in which most functions return a
/// million times. Looks are counted instead of time, so that a process that was halted is not accused.
const PATIENCE: u32 = 40;
/// The same number after Ctrl-C, which cannot be handled during a call.
const PATIENCE_WHEN_INTERRUPTED: u32 = 4;

/// Starts the watching thread.
fn look_on() {
    static ONCE: Once = Once::new();
    // if the thread cannot be started, an endless call is not detected
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
    // SAFETY: it ends the program at once, without exit handlers, which would wait for the call.
    #[cfg(unix)]
    unsafe {
        libc::_exit(EXIT_CODE)
    }
    #[cfg(windows)]
    windows::end();
    #[cfg(not(any(unix, windows)))]
    std::process::exit(EXIT_CODE)
}

/// Starts watching user functions, so that none ends the program without a message. Must be called before the first
/// [`Inside`]; further calls do nothing.
pub fn watch() {
    look_on();
    #[cfg(unix)]
    unix::watch();
    #[cfg(windows)]
    windows::watch();
}

/// Returns standard output for results. From then on, all other writes to standard output go to standard error. If this
/// is not possible, standard output stays as it is.
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
pub trait Output: std::io::Write {
    /// True for a terminal.
    fn is_terminal(&self) -> bool;
    /// Width of a line in characters; `None` if the output is not a terminal.
    fn width(&self) -> Option<usize>;
}

impl Output for std::io::Stdout {
    fn is_terminal(&self) -> bool {
        std::io::IsTerminal::is_terminal(self)
    }

    fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size::terminal_size_of(std::io::stdout())?;
        Some(width.0.into())
    }
}

#[cfg(any(unix, windows))]
impl Output for std::fs::File {
    fn is_terminal(&self) -> bool {
        std::io::IsTerminal::is_terminal(self)
    }

    fn width(&self) -> Option<usize> {
        let (width, _) = terminal_size::terminal_size_of(self)?;
        Some(width.0.into())
    }
}

/// The messages when a function ends the program.
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

    /// The earlier handlers of these signals, which are called if a fault is not in a user function.
    static BEFORE: OnceLock<[sigaction; 5]> = OnceLock::new();
    /// True once a thread reports; if two threads fail at once, only the first one reports.
    static TOLD: AtomicBool = AtomicBool::new(false);

    pub fn watch() {
        static ONCE: Once = Once::new();
        ONCE.call_once(|| {
            // SAFETY: the handlers live as long as the program and use only what is allowed in a signal handler: a
            // constant flag of the thread, `write`, `_exit`, `sigaction` and `raise`. A structure of zeros has no
            // flags.
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

    /// Reports what the user function on this thread did, and ends the program. Returns if the thread is not in a user
    /// function.
    fn tell(what: &str, help: &str) {
        let Some(inside) = INSIDE.get() else {
            return;
        };
        if TOLD.swap(true, Ordering::Relaxed) {
            // another thread is reporting, and ends the program
            loop {
                // SAFETY: the call only waits for a signal.
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
        // SAFETY: `before` is the handler that the system returned earlier. It handles the fault, which happens again
        // when this function returns; a signal that was sent by a process is raised again here.
        unsafe {
            sigaction(signal, &before[index], std::ptr::null_mut());
            if (*about).si_code <= 0 {
                libc::raise(signal);
            }
        }
    }

    pub fn moved_stdout() -> Option<File> {
        // SAFETY: the new descriptor has no other owner.
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
    /// Result of an exception handler: the system shall try the next handler.
    const CONTINUE_SEARCH: i32 = 0;

    /// True once a thread reports; if two threads fail at once, only the first one reports.
    static TOLD: AtomicBool = AtomicBool::new(false);

    /// Index of the local storage whose callback the system calls when a thread, or the process in it, ends; none
    /// before [`watch`].
    static PLACE: AtomicU32 = AtomicU32::new(FLS_OUT_OF_INDEXES);

    pub fn watch() {
        static ONCE: Once = Once::new();
        // SAFETY: handler and callback live as long as the program.
        ONCE.call_once(|| unsafe {
            // called first of all handlers, because that of the standard library leaves too little of a full stack
            AddVectoredExceptionHandler(1, Some(failed));
            PLACE.store(FlsAlloc(Some(ending)), Ordering::Relaxed);
        });
    }

    /// Makes the system call the callback when this thread calls `exit`.
    pub fn watch_thread() {
        let place = PLACE.load(Ordering::Relaxed);
        if place != FLS_OUT_OF_INDEXES {
            let any = std::ptr::from_ref(&PLACE).cast();
            // SAFETY: any value that is not null makes the system call the callback, which does not use it.
            unsafe { FlsSetValue(place, any) };
        }
    }

    /// Ends the program at once.
    pub fn end() -> ! {
        // SAFETY: it ends this process at once, without exit handlers.
        unsafe { TerminateProcess(GetCurrentProcess(), EXIT_CODE as u32) };
        std::process::abort()
    }

    /// Reports what the user function on this thread did, and ends the program. Returns if the thread is not in a user
    /// function.
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

    /// Moves standard output as on Unix, but not if it is a terminal: the library writes characters to terminals, and a
    /// file would write bytes in another encoding.
    pub fn moved_stdout() -> Option<File> {
        let stdout = std::io::stdout();
        if stdout.is_terminal() || crate::process::stdout_was_closed() {
            return None;
        }
        let kept = stdout.as_handle().try_clone_to_owned().ok()?;
        let other = std::io::stderr().as_raw_handle();
        // SAFETY: it only sets the process's handle of standard output; that of standard error stays open.
        (unsafe { SetStdHandle(STD_OUTPUT_HANDLE, other) } != 0).then(|| File::from(kept))
    }
}
