//! Memory for machine code on Apple silicon. This file is compiled, but has not been run yet.
//!
//! On Apple silicon, such memory must be mapped for this purpose (`MAP_JIT`). It is either writable or executable for a
//! thread, and each thread switches for itself.

#![expect(unsafe_code, reason = "memory becomes executable")]

use std::ffi::c_void;
use std::ptr::{NonNull, null_mut};

unsafe extern "C" {
    /// Makes written memory visible to the instruction fetch of all cores (libSystem).
    fn sys_icache_invalidate(start: *mut c_void, length: usize);
}

/// Memory with machine code, which may be executed but not written.
pub struct Executable {
    start: NonNull<u8>,
    length: usize,
}

// SAFETY: the memory is only read and executed, and belongs to this value alone.
unsafe impl Send for Executable {}
// SAFETY: the same.
unsafe impl Sync for Executable {}

impl Executable {
    /// A copy of the code, at the beginning of a page. `None` if the system does not allow executable memory.
    pub fn new(code: &[u8]) -> Option<Self> {
        let protection = libc::PROT_READ | libc::PROT_WRITE | libc::PROT_EXEC;
        let flags = libc::MAP_PRIVATE | libc::MAP_ANON | libc::MAP_JIT;
        // SAFETY: this maps new memory and touches no other.
        let start = unsafe { libc::mmap(null_mut(), code.len(), protection, flags, -1, 0) };
        if start == libc::MAP_FAILED {
            return None;
        }
        let start = NonNull::new(start.cast::<u8>())?;
        let length = code.len();
        // SAFETY: the memory is new and as long as the code. This thread may write to it until it makes it executable
        // again.
        unsafe {
            libc::pthread_jit_write_protect_np(0);
            std::ptr::copy_nonoverlapping(code.as_ptr(), start.as_ptr(), length);
            libc::pthread_jit_write_protect_np(1);
            sys_icache_invalidate(start.as_ptr().cast(), length);
        }
        Some(Executable { start, length })
    }

    /// Its first byte.
    pub fn as_ptr(&self) -> *const u8 {
        self.start.as_ptr()
    }

    /// Number of bytes.
    pub fn len(&self) -> usize {
        self.length
    }
}

impl Drop for Executable {
    fn drop(&mut self) {
        // SAFETY: this memory was mapped in `new`, and nobody has its address any more.
        unsafe { libc::munmap(self.start.as_ptr().cast(), self.length) };
    }
}
