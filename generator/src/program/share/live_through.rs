//! Live-through values: what a call of a subroutine leaves for the next call alone.
//!
//! In a chain each call returns what the next one starts from, and what is read much later. The latter needs a place of its own for each
//! element. The former stands in one variable for the whole run of calls. It is overwritten in turn, and so stays in the first cache, where
//! the state of a hundred elements in wide registers has no room. After the last call of a run anybody may read it.

use super::{Item, Origins, Place, Port, Subroutine, read_by_lines};
use crate::expression::NodeId;
use crate::program::schedule::Schedule;
use std::collections::BTreeSet;

/// The live-through values of a subroutine: what it reads by one port, and nobody else reads but behind the last call of a run.
pub(crate) struct LiveThrough {
    pub port: usize,
    /// The values.
    pub numbers: Vec<usize>,
    /// By block: in which run of calls, each with a variable of its own, it is.
    pub runs: Vec<usize>,
    /// By block: whether it is the last of its run.
    pub last: Vec<bool>,
}

/// What calls of a subroutine hand to the next call, by the port that takes most.
pub(crate) fn live_through(
    subroutines: &[Subroutine],
    subroutine: usize,
    schedule: &Schedule,
    items: &[Item],
    origins: &Origins,
) -> Option<LiveThrough> {
    let ports = 0..subroutines[subroutine].ports.len();
    let live_through = ports.filter_map(|port| {
        live_through_by(subroutines, subroutine, port, schedule, items, origins)
    });
    live_through.max_by_key(|live_through| live_through.numbers.len())
}

/// What they hand over by one port; `None` where anybody else reads it.
// Long: three conditions on the same few lists, one after the other.
fn live_through_by(
    subroutines: &[Subroutine],
    subroutine: usize,
    port: usize,
    schedule: &Schedule,
    items: &[Item],
    origins: &Origins,
) -> Option<LiveThrough> {
    let Subroutine { blocks, ports, .. } = &subroutines[subroutine];
    let Port::Returned {
        subroutine: of,
        blocks: from,
        gathered,
    } = &ports[port]
    else {
        return None;
    };
    if *of != subroutine {
        return None;
    }
    let mut numbers = BTreeSet::new();
    for place in &subroutines[subroutine].slots {
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
        let Item::Call {
            subroutine: user,
            block,
        } = *item
        else {
            continue;
        };
        let used_by = &subroutines[user];
        for (&id, place) in used_by.blocks[block].slots.iter().zip(&used_by.slots) {
            let mut from_before = false;
            if let Place::Value { port: by, number } = *place {
                let itself = (user, by) == (subroutine, port);
                let shown = match &used_by.ports[by] {
                    Port::Returned { subroutine: of, .. } => *of == subroutine,
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
        Some(&(of, block, number)) if of == subroutine && numbers.contains(&number) => last[block],
        _ => true,
    };
    if !read.iter().all(kept) {
        return None;
    }
    Some(LiveThrough {
        port,
        numbers: numbers.into_iter().collect(),
        runs,
        last,
    })
}
