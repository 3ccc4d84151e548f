//! Turns ordered chains into code: values get places in the frame, and successive chains of one shape become a run.

use super::Layout;
use super::chain::{Call, Chain, chains};
use super::order::in_runs;
use super::run::{SINES, is_call, shape_of};
use bryant_generator::expression::Function;
use bryant_generator::program::List;
use std::collections::HashMap;

/// A list in the form that the interpreter runs.
#[derive(Debug, Default)]
pub struct Code {
    pub runs: Vec<Run>,
    pub groups: Vec<Group>,
    pub calls: Vec<Site>,
    /// The places of the arguments of all calls.
    pub arguments: Vec<u16>,
    /// The places of the results of the list.
    pub results: Vec<u16>,
    /// One more than the largest place in the code. It is private, so that no other module can set it.
    end: usize,
}

/// Successive chains of one shape.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub shape: u16,
    pub count: u32,
}

/// The places of one chain: the place of its result, then those of the operands of its first operation (three entries),
/// then two for each further operation, whose third operand is the result before. In a call, the first entry is the
/// index of the call.
#[derive(Clone, Copy, Debug, Default)]
pub struct Group(pub [u16; 8]);

/// A call: the range of its arguments in the list of arguments; and the first place of its results, with their number.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    pub function: Function,
    pub arguments: (u32, u32),
    pub results: (u16, u16),
}

/// Encodes a list. `constants` gives the place of each constant, by its bits. `None` if a place would exceed sixteen
/// bits.
pub fn encode(list: &List, layout: &Layout, constants: &HashMap<u64, u32>) -> Option<Code> {
    let (chains, calls) = chains(list);
    let mut supported = Vec::with_capacity(chains.len());
    for chain in &chains {
        add_supported(chain, &mut supported);
    }
    let (chains, shapes): (Vec<Chain>, Vec<usize>) = supported.into_iter().unzip();
    let order = in_runs(&chains, &calls, list.values(), &shapes);
    let mut places = Places::new(list, layout, constants);
    places.find_last_uses(&chains, &calls, &order, list);
    let mut code = Code::default();
    for (step, &number) in order.iter().enumerate() {
        let (chain, shape) = (&chains[number as usize], shapes[number as usize] as u16);
        code.add(chain, &calls, step as u32, &mut places)?;
        match code.runs.last_mut() {
            Some(run) if run.shape == shape => run.count += 1,
            _ => code.runs.push(Run { shape, count: 1 }),
        }
    }
    for result in &list.results {
        code.results.push(places.place(result.0)?);
    }
    code.find_end();
    Some(code)
}

/// Adds a chain with its shape. A chain without a loop of its shape is split.
fn add_supported(chain: &Chain, to: &mut Vec<(Chain, usize)>) {
    let kinds: Vec<_> = chain.links().iter().map(|link| link.kind).collect();
    if let Some(shape) = shape_of(&kinds) {
        to.push((*chain, shape));
        return;
    }
    let [all_but_last, last] = chain.split();
    add_supported(&all_but_last, to);
    add_supported(&last, to);
}

impl Code {
    /// One more than the largest place that the code reads or writes.
    pub fn end(&self) -> usize {
        self.end
    }

    /// Number of arguments of the longest call.
    pub fn most_arguments(&self) -> usize {
        let lengths = self
            .calls
            .iter()
            .map(|site| site.arguments.1 - site.arguments.0);
        lengths.max().unwrap_or(0) as usize
    }

    /// Computes [`Code::end`] from all places.
    fn find_end(&mut self) {
        let mut rest = &self.groups[..];
        let mut last = 0;
        for run in &self.runs {
            let (groups, after) = rest.split_at(run.count as usize);
            // the groups of calls hold no places; the cosine is one place after its sine
            if !is_call(run.shape) {
                let places = groups.iter().flat_map(|group| group.0);
                last = last.max(places.max().unwrap_or(0).into());
                last += usize::from(run.shape == SINES);
            }
            rest = after;
        }
        let results = self
            .calls
            .iter()
            .map(|site| site.results.0 + site.results.1);
        let places = [&self.arguments[..], &self.results].concat();
        let others = places.into_iter().chain(results).max();
        self.end = 1 + last.max(others.unwrap_or(0).into());
    }

    /// Adds a chain as the step with this number. `None` if a place exceeds sixteen bits.
    fn add(&mut self, chain: &Chain, calls: &[Call], step: u32, places: &mut Places) -> Option<()> {
        let mut group = Group::default();
        let call = chain.call().map(|call| &calls[call]);
        let first_argument = self.arguments.len() as u32;
        let mut slots = [1, 2, 3, 4, 5, 6, 7].into_iter();
        for (number, link) in chain.links().iter().enumerate() {
            let count = link.kind.operands() - usize::from(number > 0);
            let given = match number {
                0 => 3,
                _ => 2,
            };
            for operand in 0..given {
                let slot = slots.next()?;
                if operand < count {
                    group.0[slot] = places.place(link.operands[operand])?;
                }
            }
        }
        for &argument in call.iter().flat_map(|call| &call.arguments) {
            self.arguments.push(places.place(argument)?);
        }
        chain.needs(calls, |value| places.free_after(value, step));
        let (first, count) = chain.defines(calls);
        let to = places.define(first, count, step)?;
        group.0[0] = to;
        if let Some(call) = call {
            group.0[0] = u16::try_from(self.calls.len()).ok()?;
            self.calls.push(Site {
                function: call.function,
                arguments: (first_argument, self.arguments.len() as u32),
                results: (to, count as u16),
            });
        }
        self.groups.push(group);
        Some(())
    }
}

/// Assigns places in the frame to values.
struct Places {
    /// The place of each value.
    of: Vec<u32>,
    /// For each value, the last step that uses it, or the step that defines it if no step uses it; [`NEVER`] for
    /// results.
    last_use: Vec<u32>,
    /// Number of constants and inputs; these are the first values and have fixed places.
    leaves: u32,
    free: Vec<u32>,
    next: u32,
}

/// Marks a value whose place is not freed (again).
const NEVER: u32 = u32::MAX;

impl Places {
    fn new(list: &List, layout: &Layout, constants: &HashMap<u64, u32>) -> Self {
        let mut of: Vec<u32> = Vec::with_capacity(list.values());
        of.extend(list.constants.iter().map(|c| constants[&c.to_bits()]));
        of.extend(list.inputs.iter().map(|input| layout.place(*input)));
        let leaves = of.len() as u32;
        of.resize(list.values(), u32::MAX);
        Places {
            of,
            last_use: vec![0; list.values()],
            leaves,
            free: Vec::new(),
            next: layout.rest,
        }
    }

    fn find_last_uses(&mut self, chains: &[Chain], calls: &[Call], order: &[u32], list: &List) {
        for (step, &number) in order.iter().enumerate() {
            let chain = &chains[number as usize];
            chain.needs(calls, |value| self.last_use[value as usize] = step as u32);
            let (first, count) = chain.defines(calls);
            self.last_use[first as usize..(first + count) as usize].fill(step as u32);
        }
        for result in &list.results {
            self.last_use[result.0 as usize] = NEVER;
        }
    }

    fn place(&self, value: u32) -> Option<u16> {
        u16::try_from(self.of[value as usize]).ok()
    }

    /// Frees the place of a value if this is the last step that needs it.
    fn free_after(&mut self, value: u32, step: u32) {
        if value >= self.leaves && self.last_use[value as usize] == step {
            // only once, even if a step uses the value twice
            self.last_use[value as usize] = NEVER;
            self.free.push(self.of[value as usize]);
        }
    }

    /// Assigns neighbouring places to values, and frees the places of values that are never used.
    fn define(&mut self, first: u32, count: u32, step: u32) -> Option<u16> {
        let reused = (count == 1).then(|| self.free.pop()).flatten();
        let to = reused.unwrap_or_else(|| {
            self.next += count;
            self.next - count
        });
        for part in 0..count {
            self.of[(first + part) as usize] = to + part;
            self.free_after(first + part, step);
        }
        u16::try_from(to + count - 1).ok()?;
        u16::try_from(to).ok()
    }
}
