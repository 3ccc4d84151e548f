//! Machine code, compared with plain evaluation of the same list to the last bit: on this processor, and on an emulated one for every other.

mod c;
mod emulated;
mod emulator;
pub(crate) mod evaluate;
mod native;
pub(crate) mod random;
