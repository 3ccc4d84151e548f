//! Turns limits and effects of the system on a process into errors: some act before `main`, some without a message.
#![cfg_attr(
    any(unix, windows),
    expect(
        unsafe_code,
        reason = "what is open when a process begins, what signals do and what a terminal shows is the system's"
    )
)]

use std::cell::RefCell;

/// True if standard output was closed when the process began, as by `bryant run MODEL >&-`. Printed text is then lost.
///
/// Before `main` begins, the standard library opens `/dev/null` in place of closed descriptors. Writing then succeeds,
/// and the loss cannot be detected. So the descriptor is checked earlier, in a function that the program loader calls
/// because it is in the section `.init_array`. On Windows a process without an output has no handle for it, and writing
/// succeeds, too. On other systems a closed output counts as open.
pub fn stdout_was_closed() -> bool {
    #[cfg(unix)]
    return early::CLOSED.load(std::sync::atomic::Ordering::Relaxed);
    #[cfg(windows)]
    return std::os::windows::io::AsRawHandle::as_raw_handle(&std::io::stdout()).is_null();
    #[cfg(not(any(unix, windows)))]
    false
}

thread_local! {
    /// The command line of the command that runs on this thread inside of another program.
    static LINE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// The command line of this command, quoted for a shell.
pub fn command_line() -> String {
    LINE.with_borrow(Option::clone).unwrap_or_else(|| {
        let words = std::env::args_os().skip(1);
        joined(words.map(|word| word.to_string_lossy().into_owned()))
    })
}

/// Calls `command`, whose command line is this one (without the name of the program).
pub fn with_command_line<R>(line: &[String], command: impl FnOnce() -> R) -> R {
    LINE.set(Some(joined(line.iter().cloned())));
    let result = command();
    LINE.set(None);
    result
}

fn joined(words: impl Iterator<Item = String>) -> String {
    let words = words.map(|word| quoted(&word));
    let words: Vec<String> = std::iter::once("bryant".to_owned()).chain(words).collect();
    words.join(" ")
}

/// A word quoted for a shell.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:%+@,".contains(c);
    match !word.is_empty() && word.chars().all(plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

/// True if the terminal of standard error shows colours. On Windows this asks the terminal to do so.
pub fn shows_colours() -> bool {
    #[cfg(windows)]
    {
        use std::os::windows::io::AsRawHandle;
        use windows_sys::Win32::System::Console::{
            ENABLE_VIRTUAL_TERMINAL_PROCESSING, GetConsoleMode, SetConsoleMode,
        };
        let terminal = std::io::stderr().as_raw_handle();
        let mut mode = 0;
        // SAFETY: the handle stays open, and `mode` has room for the result.
        return unsafe {
            GetConsoleMode(terminal, &raw mut mode) != 0
                && SetConsoleMode(terminal, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0
        };
    }
    #[cfg(not(windows))]
    true
}

/// Makes writing beyond the size limit of files of the process (`ulimit -f`) an error of the writing code, which then
/// removes the unfinished file. Otherwise a signal would end the program and leave the file. Systems without this
/// signal need nothing.
pub fn outlive_limits_of_files() {
    // SAFETY: the signal is ignored, so no handler is called.
    #[cfg(unix)]
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

#[cfg(unix)]
mod early {
    use std::sync::atomic::{AtomicBool, Ordering};

    /// True if descriptor 1 was closed before any other code ran.
    pub static CLOSED: AtomicBool = AtomicBool::new(false);

    // SAFETY: the section holds addresses of functions without a result; this one ignores its arguments. It makes a
    // single system call and needs nothing that the standard library sets up later.
    #[used]
    #[cfg_attr(
        target_vendor = "apple",
        unsafe(link_section = "__DATA,__mod_init_func")
    )]
    #[cfg_attr(not(target_vendor = "apple"), unsafe(link_section = ".init_array"))]
    static LOOK: extern "C" fn() = look;

    extern "C" fn look() {
        // SAFETY: the call reads the flags of a descriptor, and fails only if the descriptor is closed.
        let closed = unsafe { libc::fcntl(1, libc::F_GETFD) } < 0;
        CLOSED.store(closed, Ordering::Relaxed);
    }
}
