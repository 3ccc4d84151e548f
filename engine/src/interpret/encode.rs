//! From chains in order to code: places in the frame instead of values, runs of chains of one shape.

use super::Layout;
use super::chain::{Call, Chain, chains};
use super::order::in_runs;
use super::run::{SINES, is_call, shape_of};
use bryant_generator::expression::Function;
use bryant_generator::program::{Input, List};
use std::collections::HashMap;

/// A list in the form that is interpreted.
#[derive(Debug, Default)]
pub struct Code {
    pub runs: Vec<Run>,
    pub groups: Vec<Group>,
    pub calls: Vec<Site>,
    /// Where the arguments of calls are.
    pub arguments: Vec<u16>,
    /// Where the results are.
    pub results: Vec<u16>,
    /// The end of the places that it has: private, so that nobody else says it.
    end: usize,
}

/// So many chains of one shape.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub shape: u16,
    pub count: u32,
}

/// The places of one chain: of its result, of the operands of its first operation, three at most, and of the factors of those that follow.
/// Of a call the first is its index.
#[derive(Clone, Copy, Debug, Default)]
pub struct Group(pub [u16; 8]);

/// A call: where its arguments stand in the list of those, and where its results go.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    pub function: Function,
    pub arguments: (u32, u32),
    pub results: (u16, u16),
}

/// The code of a list; `constants` says where each constant is, by its bits. `None` where it needs more places than there are.
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

/// Adds a chain with its shape, in parts where there is no loop for it as a whole.
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
    /// The end of the places that it reads or writes.
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

    /// Looks at all places.
    fn find_end(&mut self) {
        let mut rest = &self.groups[..];
        let mut last = 0;
        for run in &self.runs {
            let (groups, after) = rest.split_at(run.count as usize);
            // Of a call the first is no place; the second value of a sine is one further.
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

    /// Adds a chain, the one of this step. `None` where a place is too far away.
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

/// Which value is where.
struct Places {
    /// By value.
    of: Vec<u32>,
    /// By value: the step that needs it last, or the one that defines it where none does; never for results.
    last_use: Vec<u32>,
    /// Values before this one have places of their own.
    leaves: u32,
    free: Vec<u32>,
    next: u32,
}

/// The last step of what is never free.
const NEVER: u32 = u32::MAX;

impl Places {
    fn new(list: &List, layout: &Layout, constants: &HashMap<u64, u32>) -> Self {
        let mut of: Vec<u32> = Vec::with_capacity(list.values());
        of.extend(list.constants.iter().map(|c| constants[&c.to_bits()]));
        of.extend(list.inputs.iter().map(|input| match *input {
            Input::Time => layout.time,
            Input::State(i) => layout.state + i,
            Input::Acceleration(i) | Input::Guard(i) => layout.before + i,
            Input::Parameter(i) => layout.parameters + i,
            Input::Derived(i) => layout.derived + i,
        }));
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
            // Once, though a step may need it twice.
            self.last_use[value as usize] = NEVER;
            self.free.push(self.of[value as usize]);
        }
    }

    /// Places for neighbouring values; those that nobody needs are free again.
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
