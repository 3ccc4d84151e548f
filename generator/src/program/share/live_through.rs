//! Live-through values: results of a call of a subroutine that only the next call of the same subroutine reads.
//!
//! In a chain, each call returns values from which the next call starts, and values that are read much later. The
//! latter need memory for each element. The former are kept in one variable for a whole run of calls. The calls
//! overwrite it in turn, so it stays in the first-level cache, which is too small for the state of a hundred elements
//! in wide registers. After the last call of a run, any code may read it.

use super::{Item, Origins, Place, Port, Subroutine, read_by_lines};
use crate::expression::NodeId;
use crate::program::schedule::Schedule;
use std::collections::BTreeSet;

/// The live-through values of a subroutine: those that it reads through one port, and that other code reads only after
/// the last call of a run.
pub(crate) struct LiveThrough {
    pub port: usize,
    /// The values, by their numbers in the block.
    pub numbers: Vec<usize>,
    /// By block: the run of calls that it belongs to. Each run has a variable of its own.
    pub runs: Vec<usize>,
    /// By block: true if it is the last of its run.
    pub last: Vec<bool>,
}

/// The live-through values of a subroutine, by the port with the most of them.
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

/// The live-through values of one port; `None` if other code reads them too early.
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

    // Each block may be followed by only one other.
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

    // No other code may read a value that is overwritten.
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
                // a port of another subroutine, or another port, shows the whole returned value
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
