//! Shards of a study: shard i of n has the blocks b ≡ i (mod n). It does not matter where and when a shard runs.

use std::fmt;
use std::str::FromStr;

/// One shard of n.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    index: u64,
    count: u64,
}

/// The index is not less than the count.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0} is not a shard\n  help: write INDEX/COUNT with an index from 0 and less than the count, such as 0/4"
)]
pub struct ShardError(String);

impl Shard {
    /// The whole study as one shard.
    pub const WHOLE: Shard = Shard { index: 0, count: 1 };

    /// Shard `index` of `count`, counted from 0.
    ///
    /// # Errors
    /// The index is not less than the count.
    pub fn new(index: u64, count: u64) -> Result<Shard, ShardError> {
        let shard = Shard { index, count };
        if index < count {
            Ok(shard)
        } else {
            Err(ShardError(shard.to_string()))
        }
    }

    /// The blocks of this shard; the study has `count` blocks in all.
    pub fn blocks(self, count: u64) -> impl Iterator<Item = u64> {
        let step = usize::try_from(self.count).unwrap_or(usize::MAX);
        (self.index..count).step_by(step)
    }

    /// True if a block belongs to this shard.
    pub fn has(self, block: u64) -> bool {
        block % self.count == self.index
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Shard, ShardError> {
        let numbers = text
            .split_once('/')
            .and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
        let (index, count) = numbers.ok_or_else(|| ShardError(format!("\"{text}\"")))?;
        Shard::new(index, count)
    }
}
