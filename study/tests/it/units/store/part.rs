use bryant_study::engine::{Outcome, Outcomes, Status};
use bryant_study::store::part::{PartError, decode, encode};

fn outcomes() -> Outcomes {
    let mut outcomes = Outcomes::new(2);
    for (k, status) in Status::ALL.into_iter().enumerate() {
        let outcome = Outcome {
            status,
            reached: 0.1 * k as f64,
            steps: k as u32,
            error: 1e-3,
        };
        let reason = ["", "the slack is below 0", "", "", "bent", "bent", ""][k];
        let reason = Some(reason).filter(|reason| !reason.is_empty());
        let responses = [k as f64, -1.0 / (k as f64 + 1.0)];
        outcomes.push_because(outcome, &responses, reason.map(Into::into));
    }
    outcomes
}

#[test]
fn a_block_comes_back() {
    let identity = "0".repeat(64);
    let bytes = encode(&identity, 12, &outcomes());
    assert_eq!(decode(&bytes, &identity, 12, 7, 2), Ok(outcomes()));
    let other = "1".repeat(64);
    assert_eq!(decode(&bytes, &other, 12, 7, 2), Err(PartError::Other));
    assert_eq!(decode(&bytes, &identity, 18, 7, 2), Err(PartError::Other));
}

#[test]
fn any_bit_and_any_byte_too_few_is_seen() {
    let identity = "0".repeat(64);
    let bytes = encode(&identity, 0, &outcomes());
    for length in 0..bytes.len() {
        assert!(
            decode(&bytes[..length], &identity, 0, 7, 2).is_err(),
            "{length} bytes"
        );
    }
    for bit in 0..8 * bytes.len() {
        let mut changed = bytes.clone();
        changed[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(
            decode(&changed, &identity, 0, 7, 2),
            Err(PartError::Damaged),
            "bit {bit}"
        );
    }
}
