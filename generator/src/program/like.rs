//! Like elements: what two elements compute in the same way, but for the names of what they start from and for numbers, is written
//! once and called for each.
//!
//! A long function outgrows the caches of the processor, and then most of its time goes into fetching it; and it takes long to compile. The
//! elements of a chain have the same text but for their numbers, so the function becomes a list of calls of a few short ones.
//!
//! A block is a run of lines that belong to one element. Its text is printed with its own values numbered in order, with
//! whatever it reads from elsewhere as a slot, and with each of its numbers as a place in a list: blocks of the same text are like each
//! other. What differs is handed over by ports: a reference to the part of an argument that is the element's own, a reference to what
//! another call returned, a list of numbers; and what fits nowhere is copied into an array. What only the next call of the same text reads is
//! not returned: it stands in one variable, which such calls overwrite in turn, and so stays in the first cache.

use super::carry::{Carried, carried};
use super::schedule::{Schedule, Statement};
use crate::expression::{Node, NodeId};
use crate::method::inputs::{Argument, Inputs};
use crate::target::rust::expression::{Printer, Words};
use crate::target::rust::library::Library;
use crate::target::rust::syntax;
use quote::quote;
use rustc_hash::FxHashMap;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;
use syn::Expr;

/// Lines below which a call costs more than it saves.
const SHORT: usize = 8;
/// Elements from which on their common text becomes a function.
const MANY: usize = 3;

/// Steps that may be left beside what is shared: they are one function, which takes rustc a fifth longer than pieces of 900 do.
const LEFT: usize = 3000;

/// A program with what its elements have in common.
pub(crate) struct Sharing {
    pub likes: Vec<Like>,
    /// What is left: lines, and calls in their places.
    pub items: Vec<Item>,
}

/// A step of the function that calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Item {
    /// A line of the program.
    Line(usize),
    /// A call for one of the blocks that are like each other.
    Call { like: usize, block: usize },
}

/// Text that several blocks have in common.
pub(crate) struct Like {
    /// In order; the first gives the text its names.
    pub blocks: Vec<Block>,
    /// Which of the values of a block others read, by their number.
    pub outputs: Vec<usize>,
    /// Where each slot is found.
    pub slots: Vec<Place>,
    /// Where each number is found: in the text, or in the list.
    pub numbers: Vec<Number>,
    pub ports: Vec<Port>,
    /// By block: what is copied, as many for each.
    pub copied: Vec<Vec<NodeId>>,
    /// By block: the list of numbers, as many for each.
    pub listed: Vec<Vec<f64>>,
    /// What a call leaves for the next.
    pub carried: Option<Carried>,
}

/// A run of lines of one element.
pub(crate) struct Block {
    pub lines: Range<usize>,
    /// What it binds.
    pub values: Vec<NodeId>,
    /// What it reads from elsewhere, by slot.
    pub slots: Vec<NodeId>,
    /// Its numbers, in the order in which they are printed.
    pub numbers: Vec<f64>,
    /// The places among the results that it puts something at, by runs of neighbours.
    pub puts: Vec<Range<usize>>,
}

/// Where a slot is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// In the mechanism, or the time: the same for all blocks.
    Common(NodeId),
    /// An element of what a port of an argument shows.
    Element { port: usize, index: usize },
    /// A value of what a port of a call shows, by its number.
    Value { port: usize, number: usize },
    /// A copy.
    Copied(usize),
}

/// Where a number is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Number {
    Same(f64),
    Listed(usize),
}

/// What blocks are handed by reference.
pub(crate) enum Port {
    /// So many elements of an argument, and by block where they begin.
    Argument {
        argument: Argument,
        starts: Vec<usize>,
        length: usize,
    },
    /// What a call of another, or the same, text returned: by block, which of its blocks it was made for, if any.
    Returned {
        like: usize,
        blocks: Vec<Option<usize>>,
        /// By block: values by the numbers under which they are read, where no one call returned them all.
        gathered: Vec<Option<Gathered>>,
    },
}

/// Values by the numbers under which they are read.
pub(crate) type Gathered = Vec<(usize, NodeId)>;

/// Where a value was made: text, block, number.
pub(crate) type Origins = FxHashMap<NodeId, (usize, usize, usize)>;

impl Sharing {
    /// What the elements of a program have in common; `None` where that is less than half of it, or too much is left.
    pub(crate) fn of(schedule: &Schedule, inputs: &Inputs, library: &Library) -> Option<Self> {
        let mut likes = likes(schedule, inputs, library);
        let blocks = likes.iter().flat_map(|like| &like.blocks);
        let shared: usize = blocks
            .map(|block| schedule.binding(block.lines.clone()))
            .sum();
        if likes.is_empty() || 2 * shared < schedule.binding(0..schedule.lines.len()) {
            return None;
        }
        let items = items(&likes, schedule.lines.len());
        if binding(&items, schedule) > LEFT {
            return None;
        }
        let origins = origins(&likes);
        find_outputs(&mut likes, schedule, &items, &origins);
        for like in &mut likes {
            like.connect(schedule, inputs, &origins);
        }
        for like in 0..likes.len() {
            let carried = carried(&likes, like, schedule, &items, &origins);
            let like = &mut likes[like];
            if let Some(Carried { numbers, .. }) = &carried {
                like.outputs.retain(|number| !numbers.contains(number));
            }
            like.carried = carried;
        }
        Some(Self { likes, items })
    }

    /// What lines, calls and the results read.
    pub(crate) fn read(&self, schedule: &Schedule) -> BTreeSet<NodeId> {
        read(&self.likes, schedule, &self.items)
    }
}

/// How many of the steps bind something.
fn binding(items: &[Item], schedule: &Schedule) -> usize {
    let binds = |item: &Item| match *item {
        Item::Line(line) => schedule.binding(line..line + 1),
        Item::Call { .. } => 1,
    };
    items.iter().map(binds).sum()
}

impl Like {
    /// The block that gives the text its names.
    pub(crate) fn first(&self) -> &Block {
        &self.blocks[0]
    }

    /// Whether it puts anything into a sink.
    pub(crate) fn puts(&self) -> bool {
        !self.first().puts.is_empty()
    }

    /// Finds the ports.
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

    /// The element of an argument, at the same distance from that of the port for all blocks.
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
            // Far apart they are better off alone, but no model has elements with so many coordinates.
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

    /// The value of another call, if that is what most blocks read.
    fn returned(&mut self, sources: &[NodeId], origins: &Origins) -> Option<Place> {
        let found: Vec<_> = sources.iter().map(|id| origins.get(id).copied()).collect();
        let mut counts: FxHashMap<(usize, usize), usize> = FxHashMap::default();
        for &(like, _, number) in found.iter().flatten() {
            *counts.entry((like, number)).or_default() += 1;
        }
        let (&(like, number), &most) = counts
            .iter()
            .max_by_key(|&(&place, &count)| (count, std::cmp::Reverse(place)))?;
        // More than half, so that two slots of one port cannot be the same value.
        if 2 * most <= sources.len() {
            return None;
        }
        let blocks = found.iter().map(|origin| match *origin {
            Some((l, block, n)) if (l, n) == (like, number) => Some(block),
            _ => None,
        });
        let blocks: Vec<Option<usize>> = blocks.collect();
        let fits = |port: &Port| match port {
            Port::Returned {
                like: of,
                blocks: shown,
                ..
            } if *of == like => {
                let pairs = shown.iter().zip(&blocks);
                pairs
                    .clone()
                    .all(|(a, b)| a.is_none() || b.is_none() || a == b)
            }
            _ => false,
        };
        let port = self.ports.iter().position(fits).unwrap_or_else(|| {
            self.ports.push(Port::Returned {
                like,
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

    /// Has gathered what a port shows where not all of it is what one call returned.
    fn gather(&mut self, origins: &Origins) {
        for (port, shown) in self.ports.iter_mut().enumerate() {
            let Port::Returned {
                like,
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
                        origins.get(&block.slots[slot]) == Some(&(*like, from, number))
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

/// The texts that blocks have in common.
fn likes(schedule: &Schedule, inputs: &Inputs, library: &Library) -> Vec<Like> {
    let mut place: FxHashMap<String, usize> = FxHashMap::default();
    let mut likes: Vec<Vec<Block>> = Vec::new();
    for lines in blocks(schedule) {
        let (text, block) = Block::read(schedule, inputs, library, lines);
        let at = *place.entry(text).or_insert_with(|| {
            likes.push(Vec::new());
            likes.len() - 1
        });
        likes[at].push(block);
    }
    let many = likes.into_iter().filter(|blocks| blocks.len() >= MANY);
    let like = many.map(|blocks| Like {
        copied: vec![Vec::new(); blocks.len()],
        listed: vec![Vec::new(); blocks.len()],
        blocks,
        outputs: Vec::new(),
        slots: Vec::new(),
        numbers: Vec::new(),
        ports: Vec::new(),
        carried: None,
    });
    like.collect()
}

/// The runs of lines of one element, as far as they are long enough.
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
    /// A block and its text.
    fn read(
        schedule: &Schedule,
        inputs: &Inputs,
        library: &Library,
        lines: Range<usize>,
    ) -> (String, Block) {
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
            puts: &puts,
            values: numbers.collect(),
            slots: RefCell::default(),
            numbers: RefCell::default(),
        };
        let printer = Printer::in_words(schedule, inputs, library, &reader);
        let mut text = String::new();
        for statement in statements() {
            let formula = printer.statement(statement);
            text.push_str(&quote!(#formula;).to_string());
            // which of the values of a statement with several are used
            for id in schedule.bindings(statement) {
                text.push(if id.is_some() { '+' } else { '-' });
            }
        }
        let (slots, numbers) = (reader.slots.into_inner(), reader.numbers.into_inner());
        (
            text,
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

/// Places by runs of neighbours.
fn neighbours(places: BTreeSet<usize>) -> Vec<Range<usize>> {
    let places = Vec::from_iter(places);
    let runs = places.chunk_by(|a, b| a + 1 == *b);
    runs.map(|run| run[0]..run[0] + run.len()).collect()
}

/// In which run a place is, and how far from its begin.
pub(crate) fn place_in(runs: &[Range<usize>], place: usize) -> (usize, usize) {
    let run = runs.partition_point(|run| run.end <= place);
    (run, place - runs[run].start)
}

/// Words by which texts are compared: values by their order, everything else by the order in which it is met.
struct Reader<'a> {
    values: FxHashMap<NodeId, usize>,
    slots: RefCell<Vec<NodeId>>,
    numbers: RefCell<Vec<f64>>,
    puts: &'a [Range<usize>],
}

impl Words for Reader<'_> {
    fn value(&self, id: NodeId) -> Expr {
        if let Some(number) = self.values.get(&id) {
            return syntax::word(&format!("l{number}"));
        }
        let mut slots = self.slots.borrow_mut();
        let known = slots.iter().position(|&slot| slot == id);
        let slot = known.unwrap_or_else(|| {
            slots.push(id);
            slots.len() - 1
        });
        syntax::word(&format!("x{slot}"))
    }

    fn number(&self, value: f64) -> Expr {
        self.numbers.borrow_mut().push(value);
        syntax::word("c")
    }

    fn place(&self, place: usize) -> Expr {
        let (run, distance) = place_in(self.puts, place);
        syntax::offset(&format!("p{run}"), distance)
    }
}

/// Calls in the places of their blocks, and the lines that are left.
fn items(likes: &[Like], lines: usize) -> Vec<Item> {
    let mut call: Vec<Option<Item>> = vec![None; lines];
    let mut left = vec![true; lines];
    for (like, blocks) in likes.iter().map(|like| &like.blocks).enumerate() {
        for (block, Block { lines, .. }) in blocks.iter().enumerate() {
            left[lines.clone()].fill(false);
            call[lines.start] = Some(Item::Call { like, block });
        }
    }
    let item = |line: usize| call[line].or_else(|| left[line].then_some(Item::Line(line)));
    (0..lines).filter_map(item).collect()
}

fn origins(likes: &[Like]) -> Origins {
    let mut origins = Origins::default();
    for (like, blocks) in likes.iter().map(|like| &like.blocks).enumerate() {
        for (block, Block { values, .. }) in blocks.iter().enumerate() {
            let numbered = values.iter().enumerate();
            origins.extend(numbered.map(|(number, &id)| (id, (like, block, number))));
        }
    }
    origins
}

/// What is read of a block outside of it, for all blocks that are like it.
fn find_outputs(likes: &mut [Like], schedule: &Schedule, items: &[Item], origins: &Origins) {
    let mut outputs = vec![BTreeSet::new(); likes.len()];
    let read = read(likes, schedule, items);
    for &(like, _, number) in read.iter().filter_map(|id| origins.get(id)) {
        outputs[like].insert(number);
    }
    for (like, outputs) in likes.iter_mut().zip(outputs) {
        like.outputs = outputs.into_iter().collect();
    }
}

/// What lines, calls and the results read.
fn read(likes: &[Like], schedule: &Schedule, items: &[Item]) -> BTreeSet<NodeId> {
    let mut read = read_by_lines(schedule, items);
    for item in items {
        if let Item::Call { like, block } = *item {
            read.extend(&likes[like].blocks[block].slots);
        }
    }
    read
}

/// What lines and the results read.
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
