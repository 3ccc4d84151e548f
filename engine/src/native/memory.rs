//! Memory for machine code.
//!
//! The memory is written before it becomes executable; it is never both at once. The instruction caches of Arm
//! processors do not see written data until the caches are flushed.

/// Memory with machine code, which may be executed but not written.
pub struct Executable(memmap2::Mmap);

impl Executable {
    /// A copy of the code, at the beginning of a page. `None` if the system does not allow executable memory.
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

/// Makes written memory visible to the instruction fetch of all cores. No core can have fetched any of it before,
/// because it is not executable yet.
///
/// The sequence is that of the Arm Architecture Reference Manual for self-written code: DC CVAU, DSB, IC IVAU, DSB,
/// ISB.
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
        // SAFETY: the line is part of our memory, and its content does not change.
        unsafe { asm!("dc cvau, {}", in(reg) address, options(nostack, preserves_flags)) };
    }
    // SAFETY: the instruction only waits.
    unsafe { asm!("dsb ish", options(nostack, preserves_flags)) };
    for address in lines(line(0)) {
        // SAFETY: as above.
        unsafe { asm!("ic ivau, {}", in(reg) address, options(nostack, preserves_flags)) };
    }
    // SAFETY: the instructions only wait, and drop instructions that were fetched before.
    unsafe { asm!("dsb ish", "isb", options(nostack, preserves_flags)) };
}
