//! The order in which values are computed.
//!
//! Statements are ordered by section: the values of a section that can be computed follow one another, in the order of
//! their creation. In methods that integrators evaluate, a section comes right before the first section that needs it:
//! there are more values than registers, and values that wait long for their use are written to memory and read again.

use super::schedule::index;
use crate::expression::{Graph, NodeId};
use crate::method::results::Results;
use rustc_hash::FxHashMap;
use std::cmp::Reverse;
use std::collections::BTreeSet;

/// The rule that selects the next statement among those that can be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    /// As many values as possible of a section follow one another, in the order of their creation.
    Section,
    /// The same, but each section comes right before the first section that needs it.
    Need,
}

impl Order {
    /// The order for a method with these results. If results are written one by one, each is computed right before it
    /// is needed.
    pub(crate) fn of(results: Results) -> Self {
        match results.one_by_one() {
            true => Order::Need,
            false => Order::Section,
        }
    }

    /// All operations in use, operands first.
    pub(crate) fn operations(self, graph: &Graph, uses: &[u32]) -> Vec<NodeId> {
        match self {
            Order::Section => by_section(graph, uses),
            Order::Need => by_need(graph, uses),
        }
    }
}

/// All operations in use, operands first, section by section.
fn by_section(graph: &Graph, uses: &[u32]) -> Vec<NodeId> {
    let nodes = graph.nodes();
    let operation = |id: NodeId| uses[index(id)] > 0 && !nodes[index(id)].is_leaf();
    let mut waiting_for = vec![0_u32; nodes.len()];
    let mut users: Vec<Vec<NodeId>> = vec![Vec::new(); nodes.len()];
    let mut ready: Vec<BTreeSet<NodeId>> = vec![BTreeSet::new(); graph.sections().len()];
    for id in (0..nodes.len() as u32)
        .map(NodeId)
        .filter(|&id| operation(id))
    {
        for operand in nodes[index(id)]
            .operands()
            .filter(|&operand| operation(operand))
        {
            waiting_for[index(id)] += 1;
            users[index(operand)].push(id);
        }
        if waiting_for[index(id)] == 0 {
            ready[graph.section_of(id)].insert(id);
        }
    }
    let mut order = Vec::new();
    // takes the section of the oldest ready value, until none of its values is ready any more
    while let Some(current) = (0..ready.len())
        .filter(|&section| !ready[section].is_empty())
        .min_by_key(|&section| ready[section].first().copied())
    {
        while let Some(id) = ready[current].pop_first() {
            order.push(id);
            for &user in &users[index(id)] {
                waiting_for[index(user)] -= 1;
                if waiting_for[index(user)] == 0 {
                    ready[graph.section_of(user)].insert(user);
                }
            }
        }
    }
    order
}

/// All operations in use, operands first, each run of a section right before the first one that needs it. A run that no
/// other needs, such as a rate of orientation, is placed next to the other runs of its owner, while their values are
/// still in registers.
pub fn by_need(graph: &Graph, uses: &[u32]) -> Vec<NodeId> {
    let order = by_section(graph, uses);
    let section = |id: NodeId| graph.section_of(id);
    let runs: Vec<&[NodeId]> = order.chunk_by(|&a, &b| section(a) == section(b)).collect();
    let mut run_of = vec![None; graph.len()];
    let mut depth = vec![0_u32; graph.len()];
    let mut deepest = vec![0_u32; runs.len()];
    for (number, run) in runs.iter().enumerate() {
        for &id in *run {
            let operands = graph.node(id).operands();
            let before = operands.map(|operand| depth[index(operand)]).max();
            depth[index(id)] = 1 + before.unwrap_or(0);
            deepest[number] = deepest[number].max(depth[index(id)]);
            run_of[index(id)] = Some(number);
        }
    }
    // By run: the other runs whose values it needs. Those with the longest chain of operands come first, so that short
    // ones wait least for their use.
    let needs: Vec<Vec<usize>> = (runs.iter().enumerate())
        .map(|(number, run)| {
            let operands = run.iter().flat_map(|&id| graph.node(id).operands());
            let made_in = operands.filter_map(|operand| run_of[index(operand)]);
            let others: BTreeSet<usize> = made_in.filter(|&run| run != number).collect();
            let mut others: Vec<usize> = others.into_iter().collect();
            others.sort_by_key(|&run| Reverse(deepest[run]));
            others
        })
        .collect();
    let mut needed = vec![false; runs.len()];
    for &run in needs.iter().flatten() {
        needed[run] = true;
    }
    let owner_of = graph.owners();
    let owner = |run: usize| runs[run].first().map(|&id| owner_of[section(id)]);
    let own = |run: usize| needs[run].iter().all(|&need| owner(need) == owner(run));
    let (beside, last): (Vec<usize>, Vec<usize>) = (0..runs.len())
        .filter(|&run| !needed[run])
        .partition(|&run| own(run));
    let mut beside_of: FxHashMap<_, Vec<usize>> = FxHashMap::default();
    for &run in &beside {
        beside_of.entry(owner(run)).or_default().push(run);
    }

    let mut placed = vec![false; runs.len()];
    let mut found = Vec::with_capacity(order.len());
    let mut place = |run: usize| {
        let beside = || beside_of.get(&owner(run)).into_iter().flatten().copied();
        for run in beside().chain([run]).chain(beside()) {
            if !placed[run] && needs[run].iter().all(|&need| placed[need]) {
                placed[run] = true;
                found.extend(runs[run]);
            }
        }
    };
    let mut seen = vec![false; runs.len()];
    // Runs, each with the number of its needs already visited. An explicit stack, because chains may be deeper than the
    // call stack.
    let mut stack: Vec<(usize, usize)> = Vec::new();
    for run in last.into_iter().chain(beside) {
        stack.push((run, 0));
        while let Some((run, looked_at)) = stack.last_mut() {
            match needs[*run].get(*looked_at) {
                Some(&need) => {
                    *looked_at += 1;
                    if !std::mem::replace(&mut seen[need], true) {
                        stack.push((need, 0));
                    }
                }
                None => {
                    place(*run);
                    stack.pop();
                }
            }
        }
    }
    debug_assert_eq!(found.len(), order.len(), "every run is placed once");
    found
}
