//! What calls of a function that like elements share leave for the next call, and for nobody else until the last of a run, which anybody may
//! read.
//!
//! In a chain each call returns what the next one starts from and what is read much later. Only the latter needs a place of its own for each
//! element. The former stands in one variable for the whole run of calls: it is overwritten in turn and stays in the first cache, where
//! the state of a hundred elements in wide registers does not.

use super::like::{Item, Like, Origins, Place, Port, read_by_lines};
use super::schedule::Schedule;
use crate::expression::NodeId;
use std::collections::BTreeSet;

/// Values that a call finds where the one before left its own: a port through which the same text reads what
/// nobody else does, but for what the last call of a run leaves.
pub(crate) struct Carried {
    pub port: usize,
    /// The values.
    pub numbers: Vec<usize>,
    /// By block: in which run of calls, each with a variable of its own, it is.
    pub runs: Vec<usize>,
    /// By block: whether it is the last of its run.
    pub last: Vec<bool>,
}

/// What calls of a text carry from one to the next, by the port that takes most.
pub(crate) fn carried(
    likes: &[Like],
    like: usize,
    schedule: &Schedule,
    items: &[Item],
    origins: &Origins,
) -> Option<Carried> {
    let ports = 0..likes[like].ports.len();
    let carried = ports.filter_map(|port| carried_by(likes, like, port, schedule, items, origins));
    carried.max_by_key(|carried| carried.numbers.len())
}

/// What they carry by one port; `None` where anybody else reads it.
fn carried_by(
    likes: &[Like],
    like: usize,
    port: usize,
    schedule: &Schedule,
    items: &[Item],
    origins: &Origins,
) -> Option<Carried> {
    let Like { blocks, ports, .. } = &likes[like];
    let Port::Returned {
        like: of,
        blocks: from,
        gathered,
    } = &ports[port]
    else {
        return None;
    };
    if *of != like {
        return None;
    }
    let mut numbers = BTreeSet::new();
    for place in &likes[like].slots {
        if let Place::Value { port: of, number } = *place
            && of == port
        {
            numbers.insert(number);
        }
    }

    // Each block is followed by one other at most.
    let mut last = vec![true; blocks.len()];
    let mut runs = Vec::new();
    let mut count = 0;
    for (from, gathered) in from.iter().zip(gathered) {
        match (from, gathered) {
            (&Some(from), None) => {
                if !std::mem::replace(&mut last[from], false) {
                    return None;
                }
                runs.push(*runs.get(from)?);
            }
            _ => {
                runs.push(count);
                count += 1;
            }
        }
    }

    // Nobody else reads what is overwritten.
    let mut read = read_by_lines(schedule, items);
    for item in items {
        let Item::Call { like: user, block } = *item else {
            continue;
        };
        let used_by = &likes[user];
        for (&id, place) in used_by.blocks[block].slots.iter().zip(&used_by.slots) {
            let mut from_before = false;
            if let Place::Value { port: by, number } = *place {
                let itself = (user, by) == (like, port);
                let shown = match &used_by.ports[by] {
                    Port::Returned { like: of, .. } => *of == like,
                    Port::Argument { .. } => false,
                };
                // others are shown what calls return
                if !itself && shown && numbers.contains(&number) {
                    return None;
                }
                from_before = itself && gathered[block].is_none();
            }
            if !from_before {
                read.insert(id);
            }
        }
    }
    let kept = |id: &NodeId| match origins.get(id) {
        Some(&(of, block, number)) if of == like && numbers.contains(&number) => last[block],
        _ => true,
    };
    if !read.iter().all(kept) {
        return None;
    }
    Some(Carried {
        port,
        numbers: numbers.into_iter().collect(),
        runs,
        last,
    })
}
