//! Streams cut off, with bits turned and with numbers in the wrong places: a reader says so, whatever comes.

use super::stream::{StreamError, StreamReader};
use super::{Job, outcome, serve};
use crate::Model;
use crate::test_models::{Oscillator, Runaway};
use std::io::Read;
use std::ops::ControlFlow;

/// Counts what is asked of it: a reader that believes every length asks for more than there is.
struct Counted<'a> {
    bytes: &'a [u8],
    largest: usize,
}

impl Read for Counted<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.largest = self.largest.max(buffer.len());
        self.bytes.read(buffer)
    }
}

/// What a reader makes of bytes; at most as many samples as there are bytes.
fn read(bytes: &[u8]) -> Result<(), StreamError> {
    let mut input = Counted { bytes, largest: 0 };
    let result = StreamReader::new(&mut input).and_then(|mut reader| {
        let mut samples = 0;
        reader
            .read(&mut |_, state, outputs| {
                samples += 1 + state.len() + outputs.len();
                ControlFlow::Continue(())
            })
            .map(|_| samples)
    });
    // no string and no list is longer than a mebibyte
    assert!(input.largest <= 1 << 20, "{} bytes at once", input.largest);
    match result {
        Ok(samples) => {
            assert!(samples <= bytes.len());
            Ok(())
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            Err(error)
        }
    }
}

fn stream_of<M: Model<f64>>() -> Vec<u8> {
    let mut bytes = Vec::new();
    serve::<M>(&Job::default().to_words(), &mut bytes, outcome::<f64, M>);
    bytes
}

#[test]
fn a_stream_that_ends_anywhere_is_torn() {
    for bytes in [stream_of::<Oscillator>(), stream_of::<Runaway>()] {
        for length in 0..bytes.len() {
            assert!(
                matches!(read(&bytes[..length]), Err(StreamError::Torn)),
                "{length} of {}",
                bytes.len()
            );
        }
    }
}

#[test]
fn a_stream_with_other_bytes_is_read_or_refused() {
    let mut bits = 1u64;
    // SplitMix64
    let mut random = || {
        bits = bits.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = bits;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as usize
    };
    let (mut good, mut bad) = (0, 0);
    for bytes in [stream_of::<Oscillator>(), stream_of::<Runaway>()] {
        for _ in 0..20_000 {
            let mut other = bytes.clone();
            for _ in 0..1 + random() % 3 {
                let at = random() % other.len();
                match random() % 5 {
                    0 => other[at] ^= 1 << (random() % 8),
                    1 => other[at] = random() as u8,
                    2 => {
                        other.remove(at);
                    }
                    3 => other.insert(at, random() as u8),
                    // a length that nothing has
                    _ => {
                        let end = other.len().min(at + 4);
                        other[at..end].fill(0xff);
                    }
                }
            }
            match read(&other) {
                Ok(()) | Err(StreamError::Run(_)) => good += 1,
                Err(_) => bad += 1,
            }
        }
    }
    // both happen: the middle of a number may be any byte
    assert!(good > 1000 && bad > 1000, "{good} read, {bad} refused");
    // nothing but noise
    for length in 0..2000 {
        let noise: Vec<u8> = (0..length).map(|_| random() as u8).collect();
        assert!(read(&noise).is_err());
    }
}
