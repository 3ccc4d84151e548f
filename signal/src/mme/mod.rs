//! Recordings as ISO-MME (ISO/TS 13499): a file `TEST.mme` about the test, beside it a folder `Channel` with the list `TEST.chn` and a file for each
//! channel, `TEST.001` and so on.
//!
//! A file is lines `key :value`, the key 28 columns wide. Lines of a channel file that have no key are its samples. `NOVALUE` stands for what is not
//! known; as a sample it is not-a-number. The samples of a channel are at equal intervals from the time of the first one (`implicit`), or at the times
//! that another channel holds (`explicit`).
//!
//! Text is read as UTF-8, and as ISO 8859-1 where it is none. Numbers are written with all their digits, so that they are read back bit for bit.

/// Channels of a test at most: the extension of a file has three digits.
pub const MOST_CHANNELS: usize = 999;

mod lines;
mod read;
mod write;

pub use read::read;
pub use write::{About, write};

#[cfg(test)]
mod tests;
