//! Machine code against plain evaluation of the same list, bit for bit: on the processor at hand, and on a machine in software for every other.

mod c;
mod emulated;
mod emulator;
mod evaluate;
mod native;
mod random;
