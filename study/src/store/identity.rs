//! What results are of: SHA-256 of the study as checked, of the model, of the program, of the arithmetic, and of what responses mean.
//! Results of another identity never mix.

use super::part;
use crate::digest::hexadecimal;
use crate::response;
use crate::study::Study;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

/// Rows in a block at most.
const LARGEST_BLOCK: u64 = 4096;
/// Rows in a block at least, where there are so many.
const SMALLEST_BLOCK: u64 = 16;
/// Blocks that a small study has, so that there is work for every thread.
const BLOCKS: u64 = 256;

/// What computes the results, beside the study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Program {
    /// Digest of the model.
    pub model: String,
    /// Version of the program.
    pub version: String,
    /// What numbers are computed with, where that may change their last digits: "f64", "f64 avx512", ….
    pub arithmetic: String,
}

/// What a folder's results are of, as `study.json` says it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// SHA-256, hexadecimal.
    pub identity: String,
    /// Digest of the model.
    pub model: String,
    /// Version of the program.
    pub version: String,
    /// What numbers are computed with.
    pub arithmetic: String,
    /// Rows of the study.
    pub rows: u64,
    /// Rows of a block.
    pub block: u64,
    /// The study as checked.
    pub study: serde_json::Value,
}

impl Identity {
    /// Of a study that a program runs.
    ///
    /// # Errors
    /// A number of the study that JSON cannot hold, which a study that was read does not have.
    pub fn of(study: &Study, program: &Program) -> Result<Identity, serde_json::Error> {
        // The keys of both in their order of declaration: the text is the same wherever it is written.
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

/// Rows of a block: a power of two that depends on the number of rows alone.
fn block(rows: u64) -> u64 {
    let wanted = rows.div_ceil(BLOCKS).next_power_of_two();
    wanted.clamp(SMALLEST_BLOCK, LARGEST_BLOCK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_many_but_not_small() {
        assert_eq!([1, 1000, 4096].map(block), [16; 3]);
        assert_eq!(block(100_000), 512);
        assert_eq!([1_000_000, 1_000_000_000].map(block), [4096; 2]);
    }
}
