//! Shared subroutines: equal computations of like elements are written once and called for each element.
//!
//! Two elements are alike if they do the same operations, apart from numbers and the values from which they start. A
//! long function exceeds the caches of the processor, and then most of its time goes into fetching code; it also takes
//! long to compile. The elements of a chain are alike, so the function becomes a list of calls of a few short
//! subroutines.
//!
//! A block is a run of lines that belong to one element. It is read as a sequence of [`Token`]s: its own values are
//! numbered in order, each value that it reads from elsewhere is a slot, and each of its numbers is a place in a list.
//! Blocks with the same tokens are alike. The values that differ between them are passed by ports: a reference to the
//! element's own part of an argument, a reference to the values that another call returned, or a list of numbers;
//! values that fit no port are copied into an array. Values that only the next call of the same subroutine reads are
//! not returned (`live_through`): they are kept in one variable, which the calls overwrite in turn, and so stay in the
//! first-level cache.
//!
//! Of the models at hand only chains have such subroutines: the methods of a person in a car, of a humanoid and of
//! dummy15 are shorter than [`Options::merged`](super::Options::merged), or have less than half in common. The
//! derivative of the state of a chain, compiled by rustc 1.95 with `-C opt-level=3` (Intel family 6, model 167;
//! processor time of one compilation; the shortest of 3000 evaluations):
//!
//! | | shared | in pieces | in one |
//! |---|---:|---:|---:|
//! | chain of 100, `f64`: compiled in | 2.0 s | 6.5 s | 18.1 s |
//! | memory of the compiler | 0.27 GB | 0.37 GB | 0.36 GB |
//! | one evaluation | 4.96 µs | 6.97 µs | 8.03 µs |
//! | chain of 100, every width of registers: compiled in | 8.4 s | 52.9 s | |
//! | memory of the compiler | 0.30 GB | 1.14 GB | |
//! | four lanes, per state | 1.00 µs | 1.50 µs | |
//! | eight lanes, per state | 0.61 µs | 0.80 µs | |
//! | chain of 200, `f64`: compiled in | 4.6 s | 15.5 s | |
//! | one evaluation | 10.0 µs | 13.9 µs | |

mod live_through;

use super::formula::{Form, Formulas, Method, Operator};
use super::order::{Order, blocks_by_owner};
use super::schedule::{Schedule, Statement};
use crate::expression::passes::{Rewritten, repeat};
use crate::expression::{Function, Node, NodeId, Symbol};
use crate::method::inputs::{Argument, Inputs};
use live_through::live_through;
use rustc_hash::FxHashMap;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;

pub(crate) use live_through::LiveThrough;

/// Smallest number of lines of a block; a shorter one is not worth a call.
const SHORT: usize = 8;
/// Smallest number of like blocks that become a subroutine.
const MANY: usize = 3;

/// Largest number of steps that may be left outside of subroutines. They form one function, which takes rustc a fifth
/// longer than pieces of 900 steps.
const LEFT: usize = 3000;

/// Maps each function to one that represents all functions that are called alike.
type Callee<'a> = dyn Fn(Function) -> Function + 'a;

/// The subroutines of a schedule, and the steps that call them.
pub(crate) struct Sharing {
    pub subroutines: Vec<Subroutine>,
    /// The steps of the calling function: remaining lines, and calls in place of the others.
    pub items: Vec<Item>,
}

/// A step of the calling function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Item {
    /// A line of the schedule.
    Line(usize),
    /// A call that replaces one of the like blocks.
    Call { subroutine: usize, block: usize },
}

/// A computation that several blocks have in common.
pub(crate) struct Subroutine {
    /// The blocks, in order; the first gives the subroutine its names.
    pub blocks: Vec<Block>,
    /// Numbers of the values of a block that are read outside of it.
    pub outputs: Vec<usize>,
    /// Where each slot is read from.
    pub slots: Vec<Place>,
    /// Where each number is read from: the subroutine, or the list.
    pub numbers: Vec<Number>,
    pub ports: Vec<Port>,
    /// By block: the copied values, equally many for each.
    pub copied: Vec<Vec<NodeId>>,
    /// By block: the list of numbers, equally many for each.
    pub listed: Vec<Vec<f64>>,
    /// The values that a call leaves for the next call alone.
    pub live_through: Option<LiveThrough>,
}

/// A run of lines of one element.
pub(crate) struct Block {
    pub lines: Range<usize>,
    /// The values that it binds.
    pub values: Vec<NodeId>,
    /// The values that it reads from elsewhere, by slot.
    pub slots: Vec<NodeId>,
    /// Its numbers, in the order of writing.
    pub numbers: Vec<f64>,
    /// The indices of the results that it writes, as ranges of adjacent indices.
    pub puts: Vec<Range<usize>>,
}

/// Where a slot is read from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The mechanism, or the time: the same for all blocks.
    Common(NodeId),
    /// An entry of an argument, relative to the begin that the port gives.
    Element { port: usize, index: usize },
    /// A returned value, by its number, through a port of a call.
    Value { port: usize, number: usize },
    /// A copy, by its index.
    Copied(usize),
}

/// Where a number is read from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Number {
    Same(f64),
    Listed(usize),
}

/// A reference that a call passes to the subroutine.
pub(crate) enum Port {
    /// A part of an argument: by block the index where it starts, and its length.
    Argument {
        argument: Argument,
        starts: Vec<usize>,
        length: usize,
    },
    /// The values returned by a call of this or another subroutine: by block, the block for which that call was made,
    /// if any.
    Returned {
        subroutine: usize,
        blocks: Vec<Option<usize>>,
        /// By block: the values with their numbers, if they were not all returned by one call.
        gathered: Vec<Option<Gathered>>,
    },
}

/// Values, each with the number under which it is read.
pub(crate) type Gathered = Vec<(usize, NodeId)>;

/// By value, where it is computed: subroutine, block and number.
pub(crate) type Origins = FxHashMap<NodeId, (usize, usize, usize)>;

impl Sharing {
    /// The same values in the order of elements, with subroutines. `None` if less than half of the lines is shared, or
    /// if too many steps are left. Values that are quickly computed from inputs are recomputed instead of passed from
    /// call to call. `callee` maps each function to one that represents all that are called alike.
    pub(crate) fn in_order_of_owners(
        schedule: &Schedule,
        labels: &[String],
        inputs: &Inputs,
        puts: bool,
        callee: &Callee<'_>,
    ) -> Option<(Schedule, Self)> {
        let blocks = blocks_by_owner(&schedule.graph, &schedule.roots);
        let Rewritten { graph, roots } = repeat(&schedule.graph, &schedule.roots, &blocks);
        let schedule = Schedule::new(graph, roots, labels, inputs, Order::Owner, puts);
        let sharing = Self::of(&schedule, inputs, callee)?;
        Some((schedule, sharing))
    }

    fn of(schedule: &Schedule, inputs: &Inputs, callee: &Callee<'_>) -> Option<Self> {
        let mut subroutines = subroutines(schedule, callee);
        let blocks = subroutines.iter().flat_map(|subroutine| &subroutine.blocks);
        let shared: usize = blocks
            .map(|block| schedule.binding(block.lines.clone()))
            .sum();
        if subroutines.is_empty() || 2 * shared < schedule.binding(0..schedule.lines.len()) {
            return None;
        }
        let items = items(&subroutines, schedule.lines.len());
        if binding(&items, schedule) > LEFT {
            return None;
        }
        let origins = origins(&subroutines);
        find_outputs(&mut subroutines, schedule, &items, &origins);
        for subroutine in &mut subroutines {
            subroutine.connect(schedule, inputs, &origins);
        }
        for subroutine in 0..subroutines.len() {
            let live_through = live_through(&subroutines, subroutine, schedule, &items, &origins);
            let subroutine = &mut subroutines[subroutine];
            if let Some(LiveThrough { numbers, .. }) = &live_through {
                subroutine
                    .outputs
                    .retain(|number| !numbers.contains(number));
            }
            subroutine.live_through = live_through;
        }
        Some(Self { subroutines, items })
    }

    /// The values that lines, calls and results read.
    pub(crate) fn read(&self, schedule: &Schedule) -> BTreeSet<NodeId> {
        read(&self.subroutines, schedule, &self.items)
    }
}

/// Number of the steps that bind values.
fn binding(items: &[Item], schedule: &Schedule) -> usize {
    let binds = |item: &Item| match *item {
        Item::Line(line) => schedule.binding(line..line + 1),
        Item::Call { .. } => 1,
    };
    items.iter().map(binds).sum()
}

impl Subroutine {
    /// The block that gives the subroutine its names.
    pub(crate) fn first(&self) -> &Block {
        &self.blocks[0]
    }

    /// True if it writes results to an output writer.
    pub(crate) fn puts(&self) -> bool {
        !self.first().puts.is_empty()
    }

    /// Finds the source of each slot and number, and creates the ports.
    fn connect(&mut self, schedule: &Schedule, inputs: &Inputs, origins: &Origins) {
        let count = self.first().slots.len();
        for slot in 0..count {
            let sources: Vec<NodeId> = self.blocks.iter().map(|block| block.slots[slot]).collect();
            let place = self
                .common(schedule, inputs, &sources)
                .or_else(|| self.element(schedule, inputs, &sources))
                .or_else(|| self.returned(&sources, origins))
                .unwrap_or_else(|| self.copy(&sources));
            self.slots.push(place);
        }
        self.gather(origins);
        for number in 0..self.first().numbers.len() {
            let values: Vec<f64> = self.blocks.iter().map(|b| b.numbers[number]).collect();
            let place = self.place_of(&values);
            self.numbers.push(place);
        }
    }

    fn common(&self, schedule: &Schedule, inputs: &Inputs, sources: &[NodeId]) -> Option<Place> {
        let first = *sources.first()?;
        let Node::Symbol(symbol) = schedule.graph.node(first) else {
            return None;
        };
        let common =
            inputs.input(symbol).element().is_none() && sources.iter().all(|&s| s == first);
        common.then_some(Place::Common(first))
    }

    /// The entry of an argument, if it is at the same distance from the port's begin in all blocks.
    fn element(
        &mut self,
        schedule: &Schedule,
        inputs: &Inputs,
        sources: &[NodeId],
    ) -> Option<Place> {
        let element = |&id: &NodeId| match schedule.graph.node(id) {
            Node::Symbol(symbol) => inputs.input(symbol).element(),
            _ => None,
        };
        let elements: Vec<(Argument, usize)> =
            sources.iter().map(element).collect::<Option<_>>()?;
        let (argument, _) = *elements.first()?;
        if elements.iter().any(|&(other, _)| other != argument) {
            return None;
        }
        for (port, shown) in self.ports.iter_mut().enumerate() {
            let Port::Argument {
                argument: of,
                starts,
                length,
            } = shown
            else {
                continue;
            };
            let distance = elements[0].1 as isize - starts[0] as isize;
            let same = |(&(_, index), &start): (&(Argument, usize), &usize)| {
                index as isize - start as isize == distance
            };
            if *of != argument || !elements.iter().zip(&*starts).all(same) {
                continue;
            }
            // Entries far apart would better have ports of their own, but no model has elements with so many
            // coordinates.
            let before = usize::try_from(-distance).unwrap_or(0);
            for start in &mut *starts {
                *start -= before;
            }
            let index = usize::try_from(distance).unwrap_or(0);
            *length = (*length + before).max(index + 1);
            if before > 0 {
                for place in &mut self.slots {
                    if let Place::Element { port: of, index } = place
                        && *of == port
                    {
                        *index += before;
                    }
                }
            }
            return Some(Place::Element { port, index });
        }
        self.ports.push(Port::Argument {
            argument,
            starts: elements.iter().map(|&(_, index)| index).collect(),
            length: 1,
        });
        let port = self.ports.len() - 1;
        Some(Place::Element { port, index: 0 })
    }

    /// The value returned by another call, if most blocks read such a value.
    fn returned(&mut self, sources: &[NodeId], origins: &Origins) -> Option<Place> {
        let found: Vec<_> = sources.iter().map(|id| origins.get(id).copied()).collect();
        let mut counts: FxHashMap<(usize, usize), usize> = FxHashMap::default();
        for &(subroutine, _, number) in found.iter().flatten() {
            *counts.entry((subroutine, number)).or_default() += 1;
        }
        let (&(subroutine, number), &most) = counts
            .iter()
            .max_by_key(|&(&place, &count)| (count, std::cmp::Reverse(place)))?;
        // More than half, so that two slots of a port cannot be the same value.
        if 2 * most <= sources.len() {
            return None;
        }
        let blocks = found.iter().map(|origin| match *origin {
            Some((l, block, n)) if (l, n) == (subroutine, number) => Some(block),
            _ => None,
        });
        let blocks: Vec<Option<usize>> = blocks.collect();
        let fits = |port: &Port| match port {
            Port::Returned {
                subroutine: of,
                blocks: shown,
                ..
            } if *of == subroutine => {
                let pairs = shown.iter().zip(&blocks);
                pairs
                    .clone()
                    .all(|(a, b)| a.is_none() || b.is_none() || a == b)
            }
            _ => false,
        };
        let port = self.ports.iter().position(fits).unwrap_or_else(|| {
            self.ports.push(Port::Returned {
                subroutine,
                blocks: blocks.clone(),
                gathered: vec![None; blocks.len()],
            });
            self.ports.len() - 1
        });
        if let Port::Returned { blocks: shown, .. } = &mut self.ports[port] {
            for (shown, block) in shown.iter_mut().zip(blocks) {
                *shown = shown.or(block);
            }
        }
        Some(Place::Value { port, number })
    }

    /// Gathers the values of a port for the blocks in which one call did not return all of them.
    fn gather(&mut self, origins: &Origins) {
        for (port, shown) in self.ports.iter_mut().enumerate() {
            let Port::Returned {
                subroutine,
                blocks,
                gathered,
            } = shown
            else {
                continue;
            };
            let slots: Vec<(usize, usize)> = (self.slots.iter().enumerate())
                .filter_map(|(slot, place)| match *place {
                    Place::Value { port: of, number } if of == port => Some((slot, number)),
                    _ => None,
                })
                .collect();
            for ((block, from), gathered) in self.blocks.iter().zip(&*blocks).zip(gathered) {
                let whole = from.is_some_and(|from| {
                    let there = |&(slot, number): &(usize, usize)| {
                        origins.get(&block.slots[slot]) == Some(&(*subroutine, from, number))
                    };
                    slots.iter().all(there)
                });
                if !whole {
                    let values = slots.iter();
                    let values = values.map(|&(slot, number)| (number, block.slots[slot]));
                    *gathered = Some(values.collect());
                }
            }
        }
    }

    fn copy(&mut self, sources: &[NodeId]) -> Place {
        self.copied.resize(sources.len(), Vec::new());
        for (copied, &source) in self.copied.iter_mut().zip(sources) {
            copied.push(source);
        }
        Place::Copied(self.copied[0].len() - 1)
    }

    fn place_of(&mut self, values: &[f64]) -> Number {
        let same = |a: &f64, b: &f64| a.to_bits() == b.to_bits();
        if values.iter().all(|value| same(value, &values[0])) {
            return Number::Same(values[0]);
        }
        self.listed.resize(values.len(), Vec::new());
        let known = (0..self.listed[0].len()).find(|&k| {
            let column = self.listed.iter().map(|list| &list[k]);
            column.zip(values).all(|(a, b)| same(a, b))
        });
        Number::Listed(known.unwrap_or_else(|| {
            for (list, &value) in self.listed.iter_mut().zip(values) {
                list.push(value);
            }
            self.listed[0].len() - 1
        }))
    }
}

/// The subroutines of the blocks that are alike.
fn subroutines(schedule: &Schedule, callee: &Callee<'_>) -> Vec<Subroutine> {
    let mut place: FxHashMap<Vec<Token>, usize> = FxHashMap::default();
    let mut subroutines: Vec<Vec<Block>> = Vec::new();
    for lines in blocks(schedule) {
        let (tokens, block) = Block::read(schedule, callee, lines);
        let at = *place.entry(tokens).or_insert_with(|| {
            subroutines.push(Vec::new());
            subroutines.len() - 1
        });
        subroutines[at].push(block);
    }
    let many = subroutines
        .into_iter()
        .filter(|blocks| blocks.len() >= MANY);
    let subroutine = many.map(|blocks| Subroutine {
        copied: vec![Vec::new(); blocks.len()],
        listed: vec![Vec::new(); blocks.len()],
        blocks,
        outputs: Vec::new(),
        slots: Vec::new(),
        numbers: Vec::new(),
        ports: Vec::new(),
        live_through: None,
    });
    subroutine.collect()
}

/// The runs of lines of one element that are long enough.
fn blocks(schedule: &Schedule) -> Vec<Range<usize>> {
    let mut start = 0;
    let runs = schedule
        .lines
        .chunk_by(|a, b| a.block == b.block)
        .map(|run| {
            let lines = start..start + run.len();
            start = lines.end;
            lines
        });
    runs.filter(|lines| lines.len() >= SHORT).collect()
}

impl Block {
    /// A block, and its tokens.
    fn read(schedule: &Schedule, callee: &Callee<'_>, lines: Range<usize>) -> (Vec<Token>, Block) {
        let statements = || {
            schedule.lines[lines.clone()]
                .iter()
                .map(|line| line.statement)
        };
        let values: Vec<NodeId> = statements().flat_map(|s| schedule.bound(s)).collect();
        let numbers = values.iter().enumerate().map(|(n, &id)| (id, n));
        let puts = statements().filter_map(|statement| match statement {
            Statement::Put(place) => Some(place),
            _ => None,
        });
        let puts = neighbours(puts.collect());
        let reader = Reader {
            values: numbers.collect(),
            callee,
            slots: RefCell::default(),
            numbers: RefCell::default(),
        };
        let tokens = statements().flat_map(|of| reader.statement(schedule, of, &puts));
        let tokens: Vec<Token> = tokens.collect();
        let (slots, numbers) = (reader.slots.into_inner(), reader.numbers.into_inner());
        (
            tokens,
            Block {
                lines,
                values,
                slots,
                numbers,
                puts,
            },
        )
    }
}

/// Sorted indices as ranges of adjacent indices.
fn neighbours(places: BTreeSet<usize>) -> Vec<Range<usize>> {
    let places = Vec::from_iter(places);
    let runs = places.chunk_by(|a, b| a + 1 == *b);
    runs.map(|run| run[0]..run[0] + run.len()).collect()
}

/// The range that an index belongs to, and the distance from its begin.
pub(crate) fn place_in(runs: &[Range<usize>], place: usize) -> (usize, usize) {
    let run = runs.partition_point(|run| run.end <= place);
    (run, place - runs[run].start)
}

/// An operation or operand of a block, operands first. Values are numbered in their order; slots and numbers in the
/// order in which they first occur, which is also the order in which they are passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Token {
    Value(usize),
    Slot(usize),
    Number(usize),
    Negative,
    Binary(Operator),
    Method(Method),
    HalfOfPair(u32),
    Call(Function),
    Arguments,
    /// The end of a statement that binds values.
    Binds,
    /// The end of a statement that binds a sine and a cosine.
    BindsPair,
    /// Whether a value that a statement can bind is used.
    Used(bool),
    /// The end of a statement that writes a result: the range of indices, and the distance from its begin.
    Puts(usize, usize),
}

/// Reads a block as tokens.
struct Reader<'a> {
    values: FxHashMap<NodeId, usize>,
    callee: &'a Callee<'a>,
    slots: RefCell<Vec<NodeId>>,
    numbers: RefCell<Vec<f64>>,
}

impl Reader<'_> {
    fn statement(
        &self,
        schedule: &Schedule,
        statement: Statement,
        puts: &[Range<usize>],
    ) -> Vec<Token> {
        let formulas = Formulas {
            schedule,
            form: self,
        };
        let (mut tokens, end) = match statement {
            Statement::Value(id) => (formulas.formula(id), Token::Binds),
            Statement::SinCos { argument, .. } => (formulas.receiver(argument), Token::BindsPair),
            Statement::Results(call) => {
                let any = schedule.results(call).iter().flatten().next();
                let call = any.map_or_else(Vec::new, |&id| formulas.formula(id));
                (call, Token::Binds)
            }
            Statement::Put(place) => {
                let (run, distance) = place_in(puts, place);
                let value = formulas.value(schedule.roots[place]);
                (value, Token::Puts(run, distance))
            }
        };
        tokens.push(end);
        let bindings = schedule.bindings(statement).into_iter();
        tokens.extend(bindings.map(|id| Token::Used(id.is_some())));
        tokens
    }
}

/// The tokens of operands, followed by that of their operation.
fn of(operands: impl IntoIterator<Item = Vec<Token>>, done: Token) -> Vec<Token> {
    let mut tokens: Vec<Token> = operands.into_iter().flatten().collect();
    tokens.push(done);
    tokens
}

impl Form for Reader<'_> {
    type Term = Vec<Token>;

    fn number(&self, value: f64) -> Vec<Token> {
        let mut numbers = self.numbers.borrow_mut();
        numbers.push(value);
        vec![Token::Number(numbers.len() - 1)]
    }

    fn bound(&self, id: NodeId) -> Vec<Token> {
        if let Some(&number) = self.values.get(&id) {
            return vec![Token::Value(number)];
        }
        let mut slots = self.slots.borrow_mut();
        let known = slots.iter().position(|&slot| slot == id);
        let slot = known.unwrap_or_else(|| {
            slots.push(id);
            slots.len() - 1
        });
        vec![Token::Slot(slot)]
    }

    fn input(&self, id: NodeId, _symbol: Symbol) -> Vec<Token> {
        self.bound(id)
    }

    fn negative(&self, a: Vec<Token>) -> Vec<Token> {
        of([a], Token::Negative)
    }

    fn binary(&self, a: Vec<Token>, operator: Operator, b: Vec<Token>) -> Vec<Token> {
        of([a, b], Token::Binary(operator))
    }

    fn method<const N: usize>(
        &self,
        receiver: Vec<Token>,
        method: Method,
        others: [Vec<Token>; N],
    ) -> Vec<Token> {
        let operands = std::iter::once(receiver).chain(others);
        of(operands, Token::Method(method))
    }

    fn half_of_pair(&self, argument: Vec<Token>, half: u32) -> Vec<Token> {
        of([argument], Token::HalfOfPair(half))
    }

    fn call(&self, function: Function, arguments: Vec<Vec<Token>>) -> Vec<Token> {
        let callee = (self.callee)(function.first_part());
        of(arguments, Token::Call(callee))
    }

    fn arguments(&self) -> Vec<Token> {
        vec![Token::Arguments]
    }

    fn brackets(&self, a: Vec<Token>) -> Vec<Token> {
        a
    }
}

/// The steps of the calling function: a call in place of each block, and the remaining lines.
fn items(subroutines: &[Subroutine], lines: usize) -> Vec<Item> {
    let mut call: Vec<Option<Item>> = vec![None; lines];
    let mut left = vec![true; lines];
    for (subroutine, blocks) in subroutines
        .iter()
        .map(|subroutine| &subroutine.blocks)
        .enumerate()
    {
        for (block, Block { lines, .. }) in blocks.iter().enumerate() {
            left[lines.clone()].fill(false);
            call[lines.start] = Some(Item::Call { subroutine, block });
        }
    }
    let item = |line: usize| call[line].or_else(|| left[line].then_some(Item::Line(line)));
    (0..lines).filter_map(item).collect()
}

fn origins(subroutines: &[Subroutine]) -> Origins {
    let mut origins = Origins::default();
    for (subroutine, blocks) in subroutines
        .iter()
        .map(|subroutine| &subroutine.blocks)
        .enumerate()
    {
        for (block, Block { values, .. }) in blocks.iter().enumerate() {
            let numbered = values.iter().enumerate();
            origins.extend(numbered.map(|(number, &id)| (id, (subroutine, block, number))));
        }
    }
    origins
}

/// Finds the values of each subroutine's blocks that are read outside of their block.
fn find_outputs(
    subroutines: &mut [Subroutine],
    schedule: &Schedule,
    items: &[Item],
    origins: &Origins,
) {
    let mut outputs = vec![BTreeSet::new(); subroutines.len()];
    let read = read(subroutines, schedule, items);
    for &(subroutine, _, number) in read.iter().filter_map(|id| origins.get(id)) {
        outputs[subroutine].insert(number);
    }
    for (subroutine, outputs) in subroutines.iter_mut().zip(outputs) {
        subroutine.outputs = outputs.into_iter().collect();
    }
}

/// The values that lines, calls and results read.
fn read(subroutines: &[Subroutine], schedule: &Schedule, items: &[Item]) -> BTreeSet<NodeId> {
    let mut read = read_by_lines(schedule, items);
    for item in items {
        if let Item::Call { subroutine, block } = *item {
            read.extend(&subroutines[subroutine].blocks[block].slots);
        }
    }
    read
}

/// The values that lines and results read.
pub(crate) fn read_by_lines(schedule: &Schedule, items: &[Item]) -> BTreeSet<NodeId> {
    let mut read = BTreeSet::new();
    for item in items {
        if let Item::Line(line) = *item {
            for id in schedule.needs(schedule.lines[line].statement) {
                schedule.reads(id, &mut read);
            }
        }
    }
    for &root in schedule.returned() {
        schedule.reads(root, &mut read);
    }
    read
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expression::Graph;

    /// The tokens and the numbers of one value.
    fn read(value: impl FnOnce(&Graph) -> NodeId) -> (Vec<Token>, Vec<f64>) {
        let inputs = Inputs {
            coordinates: vec!["angle".to_owned()],
            ..Inputs::default()
        };
        let graph = Graph::new();
        let root = value(&graph);
        let labels = ["result".to_owned()];
        let schedule = Schedule::new(graph, vec![root], &labels, &inputs, Order::Owner, false);
        let lines = 0..schedule.lines.len();
        let (tokens, block) = Block::read(&schedule, &|function| function, lines);
        (tokens, block.numbers)
    }

    #[test]
    fn formulas_are_like_each_other_but_for_their_numbers() {
        let formula = |[a, b]: [f64; 2], slope: bool| {
            read(move |graph| {
                let x = graph.symbol(Symbol::Coordinate(0));
                let other = if slope { x.sqrt() } else { x.sin() };
                (a * x + (b * x + other)).id()
            })
        };
        let (first, numbers) = formula([2.0, 3.0], true);
        let (like, others) = formula([5.0, 7.0], true);
        assert_eq!(like, first);
        let pairs: Vec<_> = numbers.iter().zip(&others).collect();
        assert_eq!(pairs.len(), 2);
        assert!(
            pairs
                .iter()
                .all(|pair| [(&2.0, &5.0), (&3.0, &7.0)].contains(pair))
        );
        assert_ne!(formula([2.0, 3.0], false).0, first);
    }
}
