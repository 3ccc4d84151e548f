//! A block of results as bytes.
//!
//! ```text
//! magic 8 | identity 64 | first row u64 | rows u32 | responses u32
//! status u8 × rows | steps u32 × rows | reached f64 × rows | error f64 × rows | f64 × rows, per response
//! SHA-256 of all that 32
//! ```
//!
//! Numbers are little-endian; all NaN are the same.

use crate::engine::{Outcome, Outcomes, Status};
use sha2::{Digest, Sha256};

/// Name and version of the format.
pub const MAGIC: &str = "BRYPART1";
/// Bytes before the columns.
const HEADER: usize = 8 + 64 + 8 + 4 + 4;
/// Bytes of the digest.
const DIGEST: usize = 32;

/// Why bytes are not the block that is wanted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PartError {
    /// Cut off, changed, or never such a file.
    #[error("it is damaged")]
    Damaged,
    /// Sound, but of another study or other rows.
    #[error("it holds results of something else")]
    Other,
}

/// The block as bytes. `identity` has 64 characters.
pub fn encode(identity: &str, first: u64, outcomes: &Outcomes) -> Vec<u8> {
    let rows = outcomes.runs.len();
    let mut bytes = Vec::with_capacity(HEADER + rows * (21 + 8 * outcomes.width) + DIGEST);
    bytes.extend(header(identity, first, rows, outcomes.width));
    bytes.extend(outcomes.runs.iter().map(|run| run.status as u8));
    bytes.extend(outcomes.runs.iter().flat_map(|run| run.steps.to_le_bytes()));
    bytes.extend(outcomes.runs.iter().flat_map(|run| number(run.reached)));
    bytes.extend(outcomes.runs.iter().flat_map(|run| number(run.error)));
    for response in 0..outcomes.width {
        bytes.extend((0..rows).flat_map(|row| number(outcomes.of(row)[response])));
    }
    let digest = Sha256::digest(&bytes);
    bytes.extend(digest);
    bytes
}

/// The block of these rows, if the bytes are that.
///
/// # Errors
/// They are not.
pub fn decode(
    bytes: &[u8],
    identity: &str,
    first: u64,
    rows: usize,
    width: usize,
) -> Result<Outcomes, PartError> {
    let content = bytes.len().checked_sub(DIGEST).ok_or(PartError::Damaged)?;
    let (content, digest) = bytes.split_at(content);
    if Sha256::digest(content).as_slice() != digest {
        return Err(PartError::Damaged);
    }
    let columns = content
        .strip_prefix(header(identity, first, rows, width).as_slice())
        .ok_or(PartError::Other)?;
    if columns.len() != rows * (21 + 8 * width) {
        return Err(PartError::Damaged);
    }
    let (statuses, rest) = columns.split_at(rows);
    let (steps, floats) = rest.split_at(4 * rows);
    let (steps, _) = steps.as_chunks::<4>();
    let (floats, _) = floats.as_chunks::<8>();
    let float = |column: usize, row: usize| f64::from_le_bytes(floats[column * rows + row]);
    let mut outcomes = Outcomes::new(width);
    let mut responses = vec![0.0; width];
    for row in 0..rows {
        for (response, value) in responses.iter_mut().enumerate() {
            *value = float(2 + response, row);
        }
        let outcome = Outcome {
            status: Status::of(statuses[row]).ok_or(PartError::Damaged)?,
            reached: float(0, row),
            steps: u32::from_le_bytes(steps[row]),
            error: float(1, row),
        };
        outcomes.push(outcome, &responses);
    }
    Ok(outcomes)
}

fn header(identity: &str, first: u64, rows: usize, width: usize) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER);
    bytes.extend(MAGIC.as_bytes());
    bytes.extend(identity.as_bytes());
    bytes.extend(first.to_le_bytes());
    bytes.extend((rows as u32).to_le_bytes());
    bytes.extend((width as u32).to_le_bytes());
    bytes
}

fn number(value: f64) -> [u8; 8] {
    let value = if value.is_nan() { f64::NAN } else { value };
    value.to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcomes() -> Outcomes {
        let mut outcomes = Outcomes::new(2);
        for (k, status) in Status::ALL.into_iter().enumerate() {
            let outcome = Outcome {
                status,
                reached: 0.1 * k as f64,
                steps: k as u32,
                error: 1e-3,
            };
            outcomes.push(outcome, &[k as f64, -1.0 / (k as f64 + 1.0)]);
        }
        outcomes
    }

    #[test]
    fn a_block_comes_back() {
        let identity = "0".repeat(64);
        let bytes = encode(&identity, 12, &outcomes());
        assert_eq!(decode(&bytes, &identity, 12, 6, 2), Ok(outcomes()));
        let other = "1".repeat(64);
        assert_eq!(decode(&bytes, &other, 12, 6, 2), Err(PartError::Other));
        assert_eq!(decode(&bytes, &identity, 18, 6, 2), Err(PartError::Other));
    }

    #[test]
    fn any_bit_and_any_byte_too_few_is_seen() {
        let identity = "0".repeat(64);
        let bytes = encode(&identity, 0, &outcomes());
        for length in 0..bytes.len() {
            assert!(
                decode(&bytes[..length], &identity, 0, 6, 2).is_err(),
                "{length} bytes"
            );
        }
        for bit in 0..8 * bytes.len() {
            let mut changed = bytes.clone();
            changed[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(
                decode(&changed, &identity, 0, 6, 2),
                Err(PartError::Damaged),
                "bit {bit}"
            );
        }
    }
}
