//! Random lists. The interpreter, code in C and machine code give the bits of a plain evaluation.

// The same on every processor, so they are tested on one.
#[cfg(target_arch = "x86_64")]
mod c;
#[cfg(target_arch = "x86_64")]
mod emulated_code;
#[cfg(target_arch = "x86_64")]
mod emulator;
mod evaluate;
mod interpret;
mod native_code;
mod random;
