//! Shares pairs of operands that several sums (or several products) have in common, the most frequent first. With
//! a + b + c and a + b − d, the pair a + b is computed once. In sums, pairs may differ in sign: a − b also serves
//! c + b − a.
//!
//! Taking a pair out of k lists saves k − 1 operations, so it never adds any.

use super::flatten::{Element, Signed};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The largest distance of paired operands in a list, so that time stays linear in the length of the list.
const WINDOW: usize = 16;

/// A new operand: first + second, first − second or first · second.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    pub first: Element,
    pub second: Element,
    /// True if the second operand has the opposite sign.
    pub opposite: bool,
}

/// Removes pairs that occur in at least two lists from these lists, and appends new operands, numbered from `next`,
/// that stand for them. A pair may contain older pairs. Lists must be ordered by operand, and stay so.
pub fn extract_pairs(lists: &mut [Signed], next: Element) -> Vec<Pair> {
    // what only one list has is in no common pair
    let mut occurrences = vec![0u32; next as usize];
    for (_, element) in lists.iter().flatten() {
        occurrences[*element as usize] += 1;
    }
    let may_be_common = |(_, element): (bool, Element)| {
        let count = occurrences.get(element as usize);
        count.is_none_or(|count| *count > 1)
    };
    let mut entries = Vec::new();
    for (at, list) in lists.iter().enumerate() {
        for (i, a) in list.iter().enumerate().filter(|(_, a)| may_be_common(**a)) {
            for b in list[i + 1..].iter().take(WINDOW) {
                if may_be_common(*b) {
                    entries.push(entry(key(*a, *b), at as u32));
                }
            }
        }
    }
    let mut queue = BinaryHeap::new();
    push_groups(&mut queue, entries);
    let mut pairs = Vec::new();
    while let Some((count, Reverse(key), mut occurrences)) = queue.pop() {
        let pair = pair(key);
        // Earlier pairs may already have used these operands.
        occurrences.retain(|&at| sign_of(&lists[at as usize], pair).is_some());
        if occurrences.len() < count {
            if occurrences.len() > 1 {
                queue.push((occurrences.len(), Reverse(key), occurrences));
            }
            continue;
        }
        let new = next + pairs.len() as Element;
        pairs.push(pair);
        let mut entries = Vec::new();
        for &at in &occurrences {
            let list = &mut lists[at as usize];
            if let Some(sign) = sign_of(list, pair) {
                remove(list, pair.first);
                remove(list, pair.second);
                for other in list.iter().rev().take(WINDOW) {
                    if may_be_common(*other) {
                        entries.push(entry(self::key(*other, (sign, new)), at));
                    }
                }
                list.push((sign, new));
            }
        }
        push_groups(&mut queue, entries);
    }
    pairs
}

/// The number of occurrences, the pair, and the lists that have it.
type Candidate = (usize, Reverse<Key>, Vec<u32>);

/// First element, second element, and whether they are opposite, as one number that is quick to compare.
type Key = u128;

fn key(a: (bool, Element), b: (bool, Element)) -> Key {
    u128::from(a.1) << 33 | u128::from(b.1) << 1 | u128::from(a.0 != b.0)
}

fn pair(key: Key) -> Pair {
    Pair {
        first: (key >> 33) as Element,
        second: (key >> 1) as Element,
        opposite: key & 1 == 1,
    }
}

/// A pair and a list that has it, ordered by the pair and then by the list.
fn entry(key: Key, list: u32) -> u128 {
    key << 32 | u128::from(list)
}

/// Queues the pairs that occur in more than one list.
fn push_groups(queue: &mut BinaryHeap<Candidate>, mut entries: Vec<u128>) {
    entries.sort_unstable();
    entries.dedup();
    for group in entries.chunk_by(|a, b| a >> 32 == b >> 32) {
        if group.len() > 1 {
            let lists = group.iter().map(|entry| *entry as u32).collect();
            queue.push((group.len(), Reverse(group[0] >> 32), lists));
        }
    }
}

/// The sign of the pair in the list, if the list has it.
fn sign_of(list: &Signed, pair: Pair) -> Option<bool> {
    let find = |element| {
        let start = list.partition_point(|&(_, e)| e < element);
        list.get(start).filter(|(_, e)| *e == element)
    };
    let (sign, _) = *find(pair.first)?;
    if pair.first == pair.second {
        let twice = list.iter().filter(|(_, e)| *e == pair.first).count() > 1;
        return twice.then_some(sign);
    }
    let (other, _) = *find(pair.second)?;
    ((sign != other) == pair.opposite).then_some(sign)
}

fn remove(list: &mut Signed, element: Element) {
    let at = list.partition_point(|&(_, e)| e < element);
    list.remove(at);
}
