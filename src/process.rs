//! What the system does to a process before `main`, or without a word, told as errors.
#![cfg_attr(
    unix,
    expect(
        unsafe_code,
        reason = "what is open when a process begins, and what signals do, is the system's"
    )
)]

/// Whether standard output was closed when the process began, as by `bryant run MODEL >&-`. What is printed then is lost.
///
/// The standard library opens `/dev/null` in the place of what is closed before `main` begins, so that writing succeeds and nothing can
/// tell any more. Whoever wants to know has to look earlier: the loader of programs calls what stands in the section `.init_array`
/// before. Where the system is not Unix, nobody looks, and closed is taken for open.
pub fn stdout_was_closed() -> bool {
    #[cfg(unix)]
    return early::CLOSED.load(std::sync::atomic::Ordering::Relaxed);
    #[cfg(not(unix))]
    false
}

/// From now on a file that grows beyond the limit of the process (`ulimit -f`) is an error of whoever writes it, who removes what is
/// unfinished. Otherwise a signal would end the program, and leave it.
pub fn outlive_limits_of_files() {
    // SAFETY: no handler is called.
    #[cfg(unix)]
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

#[cfg(unix)]
mod early {
    use std::sync::atomic::{AtomicBool, Ordering};

    /// Whether descriptor 1 was closed before anything else ran.
    pub static CLOSED: AtomicBool = AtomicBool::new(false);

    // SAFETY: the section has addresses of functions without result, which are called with arguments that this one does not look at. It
    // makes a single call of the system's and needs nothing of the standard library that is set up later.
    #[used]
    #[cfg_attr(
        target_vendor = "apple",
        unsafe(link_section = "__DATA,__mod_init_func")
    )]
    #[cfg_attr(not(target_vendor = "apple"), unsafe(link_section = ".init_array"))]
    static LOOK: extern "C" fn() = look;

    extern "C" fn look() {
        // SAFETY: it asks for the flags of a descriptor, and fails only where there is none.
        let closed = unsafe { libc::fcntl(1, libc::F_GETFD) } < 0;
        CLOSED.store(closed, Ordering::Relaxed);
    }
}
