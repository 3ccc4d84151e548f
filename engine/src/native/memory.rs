//! Memory that holds machine code.
//!
//! It is written before it becomes executable; no thread can write and execute it at the same time. Arm processors do not see in their caches of
//! instructions what was written as data, so there it is flushed.

/// Memory with code, which may be executed but not written.
pub struct Executable(memmap2::Mmap);

impl Executable {
    /// A copy of the code, at the beginning of a page. `None` where memory cannot be made executable.
    pub fn new(code: &[u8]) -> Option<Self> {
        let mut memory = memmap2::MmapMut::map_anon(code.len()).ok()?;
        memory.copy_from_slice(code);
        #[cfg(target_arch = "aarch64")]
        flush(&memory);
        memory.make_exec().ok().map(Executable)
    }

    /// Its first byte.
    pub fn as_ptr(&self) -> *const u8 {
        self.0.as_ptr()
    }

    /// Number of bytes.
    pub fn len(&self) -> usize {
        self.0.len()
    }
}

/// Makes written memory visible to the fetching of instructions, in all cores. No core can have fetched any of it before, because it is not executable yet.
///
/// This is the sequence of the Arm Architecture Reference Manual for code that a program writes: DC CVAU, DSB, IC IVAU, DSB, ISB.
#[cfg(target_arch = "aarch64")]
#[expect(unsafe_code, reason = "instructions for caches")]
fn flush(memory: &[u8]) {
    use std::arch::asm;
    let kind: u64;
    // SAFETY: the register tells the lengths of cache lines, and may be read by every program.
    unsafe { asm!("mrs {}, ctr_el0", out(reg) kind, options(nomem, nostack, preserves_flags)) };
    let line = |first_bit: u32| 4_usize << (kind >> first_bit & 15);
    let range = memory.as_ptr_range();
    let (start, end) = (range.start as usize, range.end as usize);
    let lines = |length: usize| (start / length * length..end).step_by(length);
    for address in lines(line(16)) {
        // SAFETY: the line is memory of ours; its content stays as it is.
        unsafe { asm!("dc cvau, {}", in(reg) address, options(nostack, preserves_flags)) };
    }
    // SAFETY: this waits.
    unsafe { asm!("dsb ish", options(nostack, preserves_flags)) };
    for address in lines(line(0)) {
        // SAFETY: as above.
        unsafe { asm!("ic ivau, {}", in(reg) address, options(nostack, preserves_flags)) };
    }
    // SAFETY: this waits, and drops instructions that were already fetched.
    unsafe { asm!("dsb ish", "isb", options(nostack, preserves_flags)) };
}
