//! The results of a whole study, block by block. Parameters are drawn again; outcomes are read from the folder.

use crate::design::{Sampler, TooManyParameters};
use crate::engine::Outcomes;
use crate::shard::Shard;
use crate::store::folder::Found;
use crate::store::part::PartError;
use crate::store::{Folder, FolderError};
use crate::study::Study;
use std::fmt::Write as _;

/// Largest number of ranges of blocks in a message.
const RANGES: usize = 20;

/// A block of rows with all their data.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Index of the first row.
    pub first: u64,
    /// Varied parameters, row-major, SI.
    pub values: Vec<f64>,
    /// The outcomes of the rows.
    pub outcomes: Outcomes,
}

/// The results of a complete study.
#[derive(Debug)]
pub struct Results<'a> {
    /// The study.
    pub study: &'a Study,
    /// The folder with the results.
    pub folder: &'a Folder,
    /// Draws parameters.
    pub sampler: Sampler<'a>,
}

/// Why results are not available.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// Blocks are missing.
    #[error(
        "{missing} of {count} blocks are missing: {blocks}{shards}\n  help: run what is missing (the same command goes on), then merge again"
    )]
    Missing {
        /// Number of missing blocks.
        missing: usize,
        /// Number of all blocks.
        count: u64,
        /// The missing blocks.
        blocks: String,
        /// The shards of these blocks, if the number of shards is known.
        shards: String,
    },
    /// Blocks are damaged.
    #[error("{}\n  help: run the study again on this folder; damaged blocks are run anew", list(.0))]
    Damaged(
        /// The blocks, each with its error.
        Vec<(u64, PartError)>,
    ),
    /// An error of the folder.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// An error of the design.
    #[error(transparent)]
    Design(#[from] TooManyParameters),
}

/// Damaged blocks, a line each.
fn list(damaged: &[(u64, PartError)]) -> String {
    let lines = damaged
        .iter()
        .map(|(block, error)| format!("block {block} cannot be used: {error}"));
    lines.collect::<Vec<_>>().join("\n")
}

impl<'a> Results<'a> {
    /// The results, if all blocks exist. `shards` is the number of shards of the study, if it is known.
    ///
    /// # Errors
    /// Blocks are missing.
    pub fn new(
        study: &'a Study,
        folder: &'a Folder,
        shards: Option<u64>,
    ) -> Result<Self, ResultsError> {
        let count = folder.blocks().count();
        let missing: Vec<u64> = (0..count).filter(|block| !folder.has(*block)).collect();
        if !missing.is_empty() {
            let of_shards = |n: u64| {
                let has = |i: &u64| {
                    Shard::new(*i, n)
                        .is_ok_and(|shard| missing.iter().any(|block| shard.has(*block)))
                };
                format!("; they are of shards {} of {n}", ranges((0..n).filter(has)))
            };
            return Err(ResultsError::Missing {
                missing: missing.len(),
                count,
                blocks: ranges(missing.iter().copied()),
                shards: shards.map_or(String::new(), of_shards),
            });
        }
        Ok(Results {
            study,
            folder,
            sampler: Sampler::new(study)?,
        })
    }

    /// Number of blocks.
    pub fn count(&self) -> u64 {
        self.folder.blocks().count()
    }

    /// The error for a damaged block and all damaged ones after it.
    fn damaged_since(&self, block: u64, error: PartError) -> Result<ResultsError, ResultsError> {
        let mut damaged = vec![(block, error)];
        for block in block + 1..self.count() {
            if let Found::Bad(error) = self.folder.read(block)? {
                damaged.push((block, error));
            }
        }
        Ok(ResultsError::Damaged(damaged))
    }

    /// One block.
    ///
    /// # Errors
    /// The block is damaged (the error names all damaged blocks after it, too), or it is gone.
    pub fn batch(&self, block: u64) -> Result<Batch, ResultsError> {
        let rows = self.folder.blocks().rows(block);
        let outcomes = match self.folder.read(block)? {
            Found::Good(outcomes) => outcomes,
            Found::Bad(error) => return Err(self.damaged_since(block, error)?),
            Found::Missing => {
                return Err(ResultsError::Missing {
                    missing: 1,
                    count: self.count(),
                    blocks: block.to_string(),
                    shards: String::new(),
                });
            }
        };
        let d = self.study.varied.len();
        let mut values = vec![0.0; (rows.end - rows.start) as usize * d];
        for (row, values) in rows.clone().zip(values.chunks_mut(d)) {
            self.sampler.values(row, values);
        }
        Ok(Batch {
            first: rows.start,
            values,
            outcomes,
        })
    }

    /// All blocks in their order.
    pub fn batches(&self) -> impl Iterator<Item = Result<Batch, ResultsError>> {
        (0..self.count()).map(|block| self.batch(block))
    }
}

/// Increasing numbers in short form: "0–3, 7, 9–12".
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn ranges(numbers: impl Iterator<Item = u64>) -> String {
    let mut found: Vec<(u64, u64)> = Vec::new();
    for number in numbers {
        match found.last_mut() {
            Some((_, last)) if *last + 1 == number => *last = number,
            _ => found.push((number, number)),
        }
    }
    let mut text = String::new();
    for (k, (first, last)) in found.iter().take(RANGES).enumerate() {
        let comma = if k == 0 { "" } else { ", " };
        let _ = if first == last {
            write!(text, "{comma}{first}")
        } else {
            write!(text, "{comma}{first}–{last}")
        };
    }
    if found.len() > RANGES {
        text.push_str(", …");
    }
    text
}
