//! Cuts long functions. rustc crashes on functions of more than about 2 500 `let`s with full debug information (each
//! nests a scope, rust-lang/rust#93908), so no function gets more than a limit.
//!
//! A cut is placed where the section changes, if there is such a place in the second half of the allowed length. Among
//! these places, the one that the fewest values cross is taken.

use super::schedule::{Schedule, Statement};
use crate::expression::NodeId;
use std::collections::BTreeSet;
use std::ops::Range;

/// One piece of a function.
pub(crate) struct Piece {
    /// The lines.
    pub lines: Range<usize>,
    /// The values that the piece reads but does not bind: inputs and values of earlier pieces. The last piece also
    /// reads the results.
    pub reads: BTreeSet<NodeId>,
    /// The values that the piece binds and later pieces read, in the order of binding.
    pub passes_on: Vec<NodeId>,
}

/// The method in pieces of at most `limit` lines; one piece if it is no longer than that.
pub(crate) fn pieces(schedule: &Schedule, limit: usize) -> Vec<Piece> {
    let reads: Vec<BTreeSet<NodeId>> = schedule
        .lines
        .iter()
        .map(|line| reads_of(schedule, line.statement))
        .collect();
    let mut results = BTreeSet::new();
    for &root in schedule.returned() {
        schedule.reads(root, &mut results);
    }

    let line_of = lines_of(schedule);
    let crossing = crossing(schedule, &reads, &results, &line_of);
    let ranges = ranges(schedule, &crossing, limit.max(2));
    let last = ranges.len() - 1;
    ranges
        .iter()
        .enumerate()
        .map(|(i, range)| {
            let mut needs: BTreeSet<NodeId> =
                reads[range.clone()].iter().flatten().copied().collect();
            if i == last {
                needs.extend(&results);
            }
            let inside =
                |id: NodeId| line_of[id.0 as usize].is_some_and(|line| range.contains(&line));
            let later: BTreeSet<NodeId> = reads[range.end..]
                .iter()
                .flatten()
                .chain(&results)
                .copied()
                .collect();
            let bound = schedule.lines[range.clone()]
                .iter()
                .flat_map(|line| schedule.bound_values(line.statement));
            Piece {
                passes_on: if i == last {
                    Vec::new()
                } else {
                    bound.filter(|id| later.contains(id)).collect()
                },
                reads: needs.into_iter().filter(|&id| !inside(id)).collect(),
                lines: range.clone(),
            }
        })
        .collect()
}

fn reads_of(schedule: &Schedule, statement: Statement) -> BTreeSet<NodeId> {
    let mut found = BTreeSet::new();
    for id in schedule.needs(statement) {
        schedule.reads(id, &mut found);
    }
    found
}

/// The line that binds each value, by node.
fn lines_of(schedule: &Schedule) -> Vec<Option<usize>> {
    let mut lines = vec![None; schedule.graph.len()];
    for (number, line) in schedule.lines.iter().enumerate() {
        for id in schedule.bound_values(line.statement) {
            lines[id.0 as usize] = Some(number);
        }
    }
    lines
}

/// By line: the number of values that are bound before the line and read there or later.
fn crossing(
    schedule: &Schedule,
    reads: &[BTreeSet<NodeId>],
    results: &BTreeSet<NodeId>,
    line_of: &[Option<usize>],
) -> Vec<usize> {
    let mut last_use = vec![0; schedule.graph.len()];
    for (number, reads) in reads.iter().chain([results]).enumerate() {
        for id in reads {
            last_use[id.0 as usize] = number;
        }
    }
    let mut change = vec![0_isize; schedule.lines.len() + 2];
    for (id, bound) in line_of.iter().enumerate() {
        if let Some(bound) = bound {
            change[bound + 1] += 1;
            change[last_use[id].max(*bound) + 1] -= 1;
        }
    }
    let sums = change.iter().scan(0, |sum, change| {
        *sum += change;
        Some(*sum)
    });
    sums.map(|sum| usize::try_from(sum).unwrap_or(0)).collect()
}

fn ranges(schedule: &Schedule, crossing: &[usize], limit: usize) -> Vec<Range<usize>> {
    let section = |line: usize| schedule.lines[line].section;
    let mut ranges = Vec::new();
    let (mut start, end) = (0, schedule.lines.len());
    while end - start > limit {
        let window = start + limit / 2..=start + limit;
        let boundary = |&line: &usize| section(line) != section(line - 1);
        let cut = window
            .clone()
            .filter(boundary)
            .min_by_key(|&line| crossing[line])
            .or_else(|| window.min_by_key(|&line| crossing[line]));
        let cut = cut.unwrap_or(start + limit);
        ranges.push(start..cut);
        start = cut;
    }
    ranges.push(start..end);
    ranges
}
