//! The identity of results: SHA-256 of the checked study, of the model, of the program, of the arithmetic, and of the
//! definition of responses. Results with different identities are never mixed.

use super::part;
use crate::digest::hexadecimal;
use crate::response;
use crate::study::Study;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Largest number of rows in a block.
const LARGEST_BLOCK: u64 = 4096;
/// Least number of rows in a block, if the study has that many.
const SMALLEST_BLOCK: u64 = 16;
/// Number of blocks of a study if the sizes of blocks allow it: enough to give every thread work.
const BLOCKS: u64 = 256;

/// The program that computes the results, without the study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Program {
    /// Digest of the model.
    pub model: String,
    /// Version of the program.
    pub version: String,
    /// The arithmetic, if it may change the last digits of numbers: "f64", "f64 avx512", ….
    pub arithmetic: String,
}

/// The identity of a folder's results, as stored in `study.json`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// SHA-256, hexadecimal.
    pub identity: String,
    /// Digest of the model.
    pub model: String,
    /// Version of the program.
    pub version: String,
    /// The arithmetic.
    pub arithmetic: String,
    /// Number of rows of the study.
    pub rows: u64,
    /// Number of rows of a block.
    pub block: u64,
    /// The checked study.
    pub study: serde_json::Value,
}

impl Identity {
    /// The identity of a study that a program runs.
    ///
    /// # Errors
    /// The study has a number that JSON cannot hold; a study that was read from a file does not have one.
    pub fn of(study: &Study, program: &Program) -> Result<Identity, serde_json::Error> {
        // Fields are stored in the order of their declaration, so the text is the same on every machine.
        let meaning = (part::MAGIC, response::REVISION);
        let text = serde_json::to_string(&(meaning, study, program))?;
        Ok(Identity {
            identity: hexadecimal(&Sha256::digest(text.as_bytes())),
            model: program.model.clone(),
            version: program.version.clone(),
            arithmetic: program.arithmetic.clone(),
            rows: study.rows,
            block: block(study.rows),
            study: serde_json::to_value(study)?,
        })
    }
}

/// Rows of a block: a power of two that depends only on the number of rows.
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn block(rows: u64) -> u64 {
    let wanted = rows.div_ceil(BLOCKS).next_power_of_two();
    wanted.clamp(SMALLEST_BLOCK, LARGEST_BLOCK)
}
