//! Random lists, evaluated plainly; and code in C and for x86-64, compared with that to the last bit. The latter two are the same on every processor, so
//! they are tested on one.

#[cfg(target_arch = "x86_64")]
mod c;
#[cfg(target_arch = "x86_64")]
mod emulated;
#[cfg(target_arch = "x86_64")]
mod emulator;
pub(crate) mod evaluate;
pub(crate) mod random;
