//! Joins two loads, or two stores, of neighbouring places in memory into one instruction: LDP, STP.
//!
//! Of two such moves (loads or stores), the later one is moved up to the earlier one, or the earlier one down to the
//! later one, if no instruction between them forbids it. No move passes a branch, the target of a branch, or a call.

use super::encode::{Access, Effect, Encoder, Instruction, encode_pair};
use crate::target::machine::operation::Vector;

/// Two moves are joined only if the second is within this many instructions after the first.
const REACH: usize = 48;

/// Joins moves. `borders` is true for each instruction that a branch goes to. Returns true for each instruction that is
/// left out.
pub fn join(instructions: &mut [Instruction], borders: &[bool]) -> Vec<bool> {
    let mut gone = vec![false; instructions.len()];
    for first in 0..instructions.len() {
        let Effect::Access(access) = instructions[first].effect else {
            continue;
        };
        if gone[first] {
            continue;
        }
        let Some((second, up)) = partner(instructions, borders, &gone, first, access) else {
            continue;
        };
        let Effect::Access(other) = instructions[second].effect else {
            unreachable!("a partner is a move");
        };
        let (low, high) = match access.offset < other.offset {
            true => (access, other),
            false => (other, access),
        };
        let pair = [low.vector, high.vector];
        let word = encode_pair(low.store, low.size, low.base, low.offset, pair);
        let (kept, left_out) = if up { (first, second) } else { (second, first) };
        instructions[kept] = Instruction {
            word,
            effect: Effect::Pair([low, high]),
        };
        gone[left_out] = true;
    }
    gone
}

/// The later move that can be joined with the move at `first`, and true if it is moved up to `first`; false if the move
/// at `first` is moved down to it.
fn partner(
    instructions: &[Instruction],
    borders: &[bool],
    gone: &[bool],
    first: usize,
    access: Access,
) -> Option<(usize, bool)> {
    // the instructions between the two moves
    let mut between = Between::default();
    let end = instructions.len().min(first + 1 + REACH);
    for second in first + 1..end {
        if borders[second] {
            return None;
        }
        if gone[second] {
            continue;
        }
        let instruction = instructions[second];
        if let Effect::Access(other) = instruction.effect
            && fit(access, other)
        {
            if between.lets_pass(other) {
                return Some((second, true));
            }
            if between.lets_pass(access) {
                return Some((second, false));
            }
        }
        match instruction.effect {
            Effect::Numbers { reads, writes } => {
                between.reads |= reads;
                between.writes |= writes;
            }
            Effect::Access(other) => between.add(other),
            Effect::Pair(both) => both.into_iter().for_each(|other| between.add(other)),
            Effect::Other => return None,
        }
    }
    None
}

/// True if two moves are of neighbouring places that one instruction can reach.
fn fit(a: Access, b: Access) -> bool {
    let like = a.store == b.store && a.size == b.size && a.base == b.base;
    // an instruction must not load two numbers into one register
    let registers = a.store || a.vector != b.vector;
    like && registers
        && a.offset.abs_diff(b.offset) == 1
        && a.offset.min(b.offset) <= Encoder::FARTHEST_PAIR
}

/// The effects of the instructions between two moves.
#[derive(Default)]
struct Between {
    /// A bit for each vector register that is read, or written.
    reads: u32,
    writes: u32,
    moves: Vec<Access>,
}

impl Between {
    fn add(&mut self, access: Access) {
        let bit = bit(access.vector);
        match access.store {
            true => self.reads |= bit,
            false => self.writes |= bit,
        }
        self.moves.push(access);
    }

    /// True if a move may pass all of these instructions, in either direction.
    fn lets_pass(&self, access: Access) -> bool {
        let bit = bit(access.vector);
        let registers = match access.store {
            true => self.writes & bit == 0,
            false => (self.reads | self.writes) & bit == 0,
        };
        // two regions do not overlap if one of them is written
        let same_place = |other: &Access| {
            (other.store || access.store)
                && other.base == access.base
                && (other.size != access.size || other.offset == access.offset)
        };
        registers && !self.moves.iter().any(same_place)
    }
}

fn bit(vector: Vector) -> u32 {
    1 << vector.0
}
