//! A block of results as bytes.
//!
//! ```text
//! magic 8 | identity 64 | first row u64 | rows u32 | responses u32
//! status u8 × rows | steps u32 × rows | reached f64 × rows | error f64 × rows | f64 × rows, per response
//! reason u16 × rows, 0 for none, 1 for the first of: (length u32 | UTF-8) …
//! SHA-256 of all bytes above 32
//! ```
//!
//! Numbers are little-endian; all NaN have the same bytes.

use crate::engine::{Outcome, Outcomes, Status};
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// Name and version of the format.
pub const MAGIC: &str = "BRYPART2";
/// Bytes before the columns.
const HEADER: usize = 8 + 64 + 8 + 4 + 4;
/// Bytes of the digest.
const DIGEST: usize = 32;
/// Bytes of a row without its responses: status, steps, time and error before them; the number of its reason after
/// them.
const ROW: usize = 21;
const REASON: usize = 2;

/// Why bytes are not the requested block.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PartError {
    /// The bytes are cut off, changed, or were never such a file.
    #[error("it is damaged")]
    Damaged,
    /// The bytes are valid, but belong to another study or other rows.
    #[error("it holds results of something else")]
    Other,
}

/// The block as bytes. `identity` has 64 characters.
pub fn encode(identity: &str, first: u64, outcomes: &Outcomes) -> Vec<u8> {
    let rows = outcomes.runs.len();
    let columns = rows * (ROW + 8 * outcomes.width + REASON);
    let mut bytes = Vec::with_capacity(HEADER + columns + DIGEST);
    bytes.extend(header(identity, first, rows, outcomes.width));
    bytes.extend(outcomes.runs.iter().map(|run| run.status as u8));
    bytes.extend(outcomes.runs.iter().flat_map(|run| run.steps.to_le_bytes()));
    bytes.extend(outcomes.runs.iter().flat_map(|run| number(run.reached)));
    bytes.extend(outcomes.runs.iter().flat_map(|run| number(run.error)));
    for response in 0..outcomes.width {
        bytes.extend((0..rows).flat_map(|row| number(outcomes.of(row)[response])));
    }
    // reasons are numbered in the order of the rows that have them first
    let mut reasons: Vec<&str> = Vec::new();
    for reason in &outcomes.reasons {
        let number = reason.as_deref().map_or(0, |reason| {
            let known = reasons.iter().position(|known| *known == reason);
            1 + known.unwrap_or_else(|| {
                reasons.push(reason);
                reasons.len() - 1
            })
        });
        // a block has at most 4096 rows, so the number fits
        bytes.extend((number as u16).to_le_bytes());
    }
    for reason in reasons {
        bytes.extend((reason.len() as u32).to_le_bytes());
        bytes.extend(reason.as_bytes());
    }
    let digest = Sha256::digest(&bytes);
    bytes.extend(digest);
    bytes
}

/// Reads a block.
///
/// # Errors
/// The bytes are damaged, or are another block.
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
    let (columns, reasons) = columns
        .split_at_checked(rows * (ROW + 8 * width))
        .ok_or(PartError::Damaged)?;
    let reasons = decode_reasons(reasons, rows).ok_or(PartError::Damaged)?;
    let (statuses, rest) = columns.split_at(rows);
    let (steps, floats) = rest.split_at(4 * rows);
    let (steps, _) = steps.as_chunks::<4>();
    let (floats, _) = floats.as_chunks::<8>();
    let float = |column: usize, row: usize| f64::from_le_bytes(floats[column * rows + row]);
    let mut outcomes = Outcomes::new(width);
    let mut responses = vec![0.0; width];
    for (row, reason) in reasons.into_iter().enumerate() {
        for (response, value) in responses.iter_mut().enumerate() {
            *value = float(2 + response, row);
        }
        let outcome = Outcome {
            status: Status::of(statuses[row]).ok_or(PartError::Damaged)?,
            reached: float(0, row),
            steps: u32::from_le_bytes(steps[row]),
            error: float(1, row),
        };
        outcomes.push_because(outcome, &responses, reason);
    }
    Ok(outcomes)
}

/// The reason of each row, if the bytes are valid.
fn decode_reasons(bytes: &[u8], rows: usize) -> Option<Vec<Option<Arc<str>>>> {
    let (numbers, mut rest) = bytes.split_at_checked(rows * REASON)?;
    let mut reasons: Vec<Arc<str>> = Vec::new();
    while let Some((length, text)) = rest.split_first_chunk::<4>() {
        let (text, behind) = text.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        reasons.push(std::str::from_utf8(text).ok()?.into());
        rest = behind;
    }
    let reason = |number: &[u8; REASON]| match u16::from_le_bytes(*number) {
        0 => Some(None),
        number => reasons.get(usize::from(number) - 1).cloned().map(Some),
    };
    let (numbers, _) = numbers.as_chunks::<REASON>();
    rest.is_empty()
        .then(|| numbers.iter().map(reason).collect())?
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
