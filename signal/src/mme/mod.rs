//! Recordings as ISO-MME (ISO/TS 13499): a file `TEST.mme` describes the test. Beside it, a folder `Channel` has the
//! list `TEST.chn` and a file for each channel, `TEST.001` and so on.
//!
//! A file has lines `key :value`; the key is 28 columns wide. In a channel file, the lines without a key are the
//! samples. `NOVALUE` stands for an unknown value; as a sample it is NaN. The samples of a channel are at equal
//! intervals from the time of the first one (`implicit`), or at the times that another channel lists (`explicit`).
//!
//! Text is read as UTF-8, or as ISO 8859-1 if it is not valid UTF-8. Numbers are written with all digits, so that they
//! are read back exactly.

/// Largest number of channels of a test, because the extension of a channel file has three digits.
pub const MOST_CHANNELS: usize = 999;

mod lines;
mod read;
mod write;

pub use read::read;
pub use write::{About, is_code, write};

#[cfg(test)]
mod tests;
