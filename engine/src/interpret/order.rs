//! The order of chains: chains of the same shape form runs, so that one loop executes each run.

use super::chain::{Call, Chain};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Number of chains by which the order may be ahead of the first chain that is not done. A larger window makes longer
/// runs, but values that are computed too early have to wait in memory.
const WINDOW: usize = 400;

/// The numbers of the chains in an order of long runs; operands still come before their uses. `shapes` gives the shape
/// of each chain, a small number.
pub fn in_runs(chains: &[Chain], calls: &[Call], values: usize, shapes: &[usize]) -> Vec<u32> {
    let users = Users::of(chains, calls, values);
    let mut waits_for = users.waits_for.clone();
    let count = shapes.iter().max().map_or(0, |most| most + 1);
    let mut queue = Queue {
        ready: vec![BinaryHeap::new(); count],
        later: BinaryHeap::new(),
        limit: WINDOW,
    };
    for number in 0..chains.len() {
        if waits_for[number] == 0 {
            queue.add(number as u32, shapes[number]);
        }
    }
    let mut done = vec![false; chains.len()];
    let (mut first, mut order) = (0, Vec::with_capacity(chains.len()));
    while order.len() < chains.len() {
        while done[first] {
            first += 1;
        }
        queue.advance(first + WINDOW, shapes);
        let fullest = (0..count).max_by_key(|&shape| queue.ready[shape].len());
        let shape = fullest.unwrap_or(0);
        debug_assert!(!queue.ready[shape].is_empty(), "the first chain is ready");
        while let Some(Reverse(number)) = queue.ready[shape].pop() {
            done[number as usize] = true;
            order.push(number);
            for &user in users.of_chain(number as usize) {
                waits_for[user as usize] -= 1;
                if waits_for[user as usize] == 0 {
                    queue.add(user, shapes[user as usize]);
                }
            }
        }
    }
    order
}

/// For each chain, the chains that use it.
struct Users {
    /// For each chain, the index of its first user in `users`; with one more entry at the end.
    starts: Vec<u32>,
    /// The users of all chains. A chain that uses a value twice is listed twice.
    users: Vec<u32>,
    /// For each chain, the number of its entries in `users`: operands that have to be computed before it.
    waits_for: Vec<u32>,
}

impl Users {
    fn of(chains: &[Chain], calls: &[Call], values: usize) -> Self {
        let mut maker = vec![u32::MAX; values];
        for (number, chain) in chains.iter().enumerate() {
            let (first, count) = chain.defines(calls);
            maker[first as usize..(first + count) as usize].fill(number as u32);
        }
        let mut needs: Vec<(u32, u32)> = Vec::with_capacity(3 * chains.len());
        for (number, chain) in chains.iter().enumerate() {
            chain.needs(calls, |value| {
                let by = maker[value as usize];
                if by != u32::MAX {
                    needs.push((by, number as u32));
                }
            });
        }
        let mut starts = vec![0; chains.len() + 1];
        let mut waits_for = vec![0; chains.len()];
        for &(by, user) in &needs {
            starts[by as usize + 1] += 1;
            waits_for[user as usize] += 1;
        }
        for i in 0..chains.len() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut users = vec![0; needs.len()];
        for (by, user) in needs {
            let place = &mut next[by as usize];
            users[*place as usize] = user;
            *place += 1;
        }
        Users {
            starts,
            users,
            waits_for,
        }
    }

    fn of_chain(&self, number: usize) -> &[u32] {
        &self.users[self.starts[number] as usize..self.starts[number + 1] as usize]
    }
}

/// Chains whose operands are computed, and which are not yet in the order.
struct Queue {
    /// For each shape, chains within the window.
    ready: Vec<BinaryHeap<Reverse<u32>>>,
    /// Chains beyond the window.
    later: BinaryHeap<Reverse<u32>>,
    limit: usize,
}

impl Queue {
    fn add(&mut self, number: u32, shape: usize) {
        match (number as usize) < self.limit {
            true => self.ready[shape].push(Reverse(number)),
            false => self.later.push(Reverse(number)),
        }
    }

    /// Moves the end of the window to `limit`.
    fn advance(&mut self, limit: usize, shapes: &[usize]) {
        self.limit = limit;
        while let Some(&Reverse(number)) = self.later.peek()
            && (number as usize) < limit
        {
            self.later.pop();
            self.ready[shapes[number as usize]].push(Reverse(number));
        }
    }
}
