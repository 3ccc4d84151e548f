//! Operation counts: the cost of one evaluation of some results, by kind of operation and by section.
//!
//! total = additions + subtractions + products + quotients + roots + maxima and minima + 2 · fused multiply-adds
//!
//! Signs are counted separately, because they mostly become part of another operation. Sines, cosines, angles and calls
//! are counted separately, because each costs many operations.

use super::graph::Graph;
use super::liveness::Live;
use super::node::{Function, Node, NodeId};
use rustc_hash::FxHashSet;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::{Add, AddAssign};

/// Operations by kind.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// a + b
    pub add: usize,
    /// a − b
    pub sub: usize,
    /// a · b
    pub mul: usize,
    /// a / b
    pub div: usize,
    /// √a
    pub sqrt: usize,
    /// a · b + c, each counted as two operations
    pub fused: usize,
    /// max(a, b), min(a, b)
    pub max_min: usize,
    /// −a, not in the total
    pub neg: usize,
    /// sin a, not in the total
    pub sin: usize,
    /// cos a, not in the total
    pub cos: usize,
    /// atan2(a, b), not in the total
    pub atan2: usize,
    /// Calls, for each function; not in the total
    pub calls: BTreeMap<Function, usize>,
}

impl Count {
    /// The operations that the roots need. Every node counts once, however often it is used.
    pub fn of(graph: &Graph, roots: &[NodeId]) -> Self {
        Self::of_nodes(graph, Live::new(graph, roots).nodes())
    }

    /// The operations of these nodes, without those of their operands.
    pub fn of_nodes(graph: &Graph, nodes: &[NodeId]) -> Self {
        let all = graph.nodes();
        let mut count = Self::default();
        let mut calls = FxHashSet::default();
        for id in nodes {
            let node = &all[id.0 as usize];
            if is_first(node, &mut calls) {
                count.record(node);
            }
        }
        count
    }

    /// Counts one node.
    pub fn record(&mut self, node: &Node) {
        match node {
            Node::Constant(_) | Node::Symbol(_) | Node::Arguments(_) => {}
            Node::Neg(_) => self.neg += 1,
            Node::Add(..) => self.add += 1,
            Node::Sub(..) => self.sub += 1,
            Node::Mul(..) => self.mul += 1,
            Node::Div(..) => self.div += 1,
            Node::MulAdd(..) => self.fused += 1,
            Node::Sqrt(_) => self.sqrt += 1,
            Node::Sin(_) => self.sin += 1,
            Node::Cos(_) => self.cos += 1,
            Node::Atan2(..) => self.atan2 += 1,
            Node::Max(..) | Node::Min(..) => self.max_min += 1,
            Node::Call(function, _) => {
                *self.calls.entry(function.first_part()).or_default() += 1;
            }
        }
    }

    /// The number of floating-point operations; a fused multiply-add counts as two.
    pub fn total(&self) -> usize {
        self.add + self.sub + self.mul + self.div + self.sqrt + self.max_min + 2 * self.fused
    }

    /// The number of sines, cosines and angles.
    pub fn trigonometric(&self) -> usize {
        self.sin + self.cos + self.atan2
    }

    /// The number of calls of all functions.
    pub fn called(&self) -> usize {
        self.calls.values().sum()
    }

    /// True if nothing is computed, not even a sign.
    pub fn is_empty(&self) -> bool {
        self.total() + self.neg + self.trigonometric() + self.called() == 0
    }
}

impl AddAssign<&Count> for Count {
    fn add_assign(&mut self, other: &Count) {
        self.add += other.add;
        self.sub += other.sub;
        self.mul += other.mul;
        self.div += other.div;
        self.sqrt += other.sqrt;
        self.fused += other.fused;
        self.max_min += other.max_min;
        self.neg += other.neg;
        self.sin += other.sin;
        self.cos += other.cos;
        self.atan2 += other.atan2;
        for (function, calls) in &other.calls {
            *self.calls.entry(*function).or_default() += calls;
        }
    }
}

impl Add<&Count> for Count {
    type Output = Count;
    fn add(mut self, other: &Count) -> Count {
        self += other;
        self
    }
}

/// One line: `37 operations (12 add, 20 mul, 5 sub), 4 signs, 2 sin, 2 cos, 1 call (1 belt_tension)`.
impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", plural(self.total(), "operation"))?;
        list(
            f,
            &[
                (self.add, "add"),
                (self.sub, "sub"),
                (self.mul, "mul"),
                (self.div, "div"),
                (self.sqrt, "sqrt"),
                (self.fused, "fused"),
                (self.max_min, "max/min"),
            ],
        )?;
        if self.neg > 0 {
            write!(f, ", {}", plural(self.neg, "sign"))?;
        }
        for (count, name) in [(self.sin, "sin"), (self.cos, "cos"), (self.atan2, "atan2")] {
            if count > 0 {
                write!(f, ", {count} {name}")?;
            }
        }
        if self.called() > 0 {
            write!(f, ", {}", plural(self.called(), "call"))?;
            let mut by_kind: BTreeMap<&str, usize> = BTreeMap::new();
            for (function, count) in &self.calls {
                *by_kind.entry(kind(*function)).or_default() += count;
            }
            let entries: Vec<_> = by_kind.into_iter().map(|(name, n)| (n, name)).collect();
            list(f, &entries)?;
        }
        Ok(())
    }
}

/// Counts by section of the graph. Each node counts in the section in which it was created.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// Each section with its operations, in the order of the sections. Sections without operations are left out.
    pub rows: Vec<(String, Count)>,
    /// The sum of all sections.
    pub total: Count,
}

impl Table {
    /// The operations that the roots need, by section.
    pub fn of(graph: &Graph, roots: &[NodeId]) -> Self {
        let live = Live::new(graph, roots);
        let sections = graph.sections();
        let mut counts = vec![Count::default(); sections.len()];
        let mut calls = FxHashSet::default();
        for &id in live.nodes() {
            let node = graph.node(id);
            if is_first(&node, &mut calls) {
                counts[graph.section_of(id)].record(&node);
            }
        }
        let total = counts.iter().fold(Count::default(), |sum, c| sum + c);
        let rows = sections.iter().cloned().zip(counts);
        Table {
            rows: rows.filter(|(_, count)| !count.is_empty()).collect(),
            total,
        }
    }
}

/// A row for each section and one for the total. Columns of zeros are left out.
impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        type Column = (&'static str, fn(&Count) -> usize);
        let columns: [Column; 13] = [
            ("total", |c| c.total()),
            ("add", |c| c.add),
            ("sub", |c| c.sub),
            ("mul", |c| c.mul),
            ("div", |c| c.div),
            ("sqrt", |c| c.sqrt),
            ("fused", |c| c.fused),
            ("max/min", |c| c.max_min),
            ("signs", |c| c.neg),
            ("sin", |c| c.sin),
            ("cos", |c| c.cos),
            ("atan2", |c| c.atan2),
            ("calls", |c| c.called()),
        ];
        let shown: Vec<&Column> = columns
            .iter()
            .filter(|(name, value)| *name == "total" || value(&self.total) > 0)
            .collect();
        let all = || {
            let rows = self.rows.iter().map(|(name, count)| (section(name), count));
            rows.chain([("total", &self.total)])
        };
        let first = all().map(|(name, _)| name.chars().count()).max();
        let first = first.unwrap_or(0).max("section".len());
        // No entry is wider than that of the total.
        let width = |(name, value): &Column| value(&self.total).to_string().len().max(name.len());

        write!(f, "{:first$}", "section")?;
        for column in &shown {
            write!(f, "  {:>1$}", column.0, width(column))?;
        }
        for (name, count) in all() {
            write!(f, "\n{name:first$}")?;
            for column in &shown {
                write!(f, "  {:>1$}", column.1(count), width(column))?;
            }
        }
        Ok(())
    }
}

fn section(name: &str) -> &str {
    if name.is_empty() { "other" } else { name }
}

fn plural(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// ` (3 add, 2 mul)`, without zero entries; empty if all are zero.
fn list(f: &mut fmt::Formatter<'_>, entries: &[(usize, &str)]) -> fmt::Result {
    let mut separator = " (";
    for (count, name) in entries.iter().filter(|(count, _)| *count > 0) {
        write!(f, "{separator}{count} {name}")?;
        separator = ", ";
    }
    f.write_str(if separator == ", " { ")" } else { "" })
}

/// False for a node that is a further result of a call that was already met.
fn is_first(node: &Node, calls: &mut FxHashSet<Node>) -> bool {
    match *node {
        Node::Call(function, operands) if function.part().is_some() => {
            calls.insert(Node::Call(function.first_part(), operands))
        }
        _ => true,
    }
}

fn kind(function: Function) -> &'static str {
    match function {
        Function::Curve(_) => "curve",
        Function::CurveSlope(_) => "curve slope",
        Function::CurveSecondDerivative(_) => "curve second derivative",
        Function::CurveInverse(_) => "curve inverse",
        Function::CurveIntegral(_) => "curve integral",
        Function::CurveDoubleIntegral(_) => "curve double integral",
        Function::CurveBreakpoints(_) => "curve breakpoint indicator",
        Function::CurveStop(_) => "curve stop",
        Function::Choose => "choose",
        Function::Power => "power",
        Function::User(_) => "user",
        Function::Support(_) => "ellipsoid support",
        Function::Approach(call) if call.early => "ellipsoid touch",
        Function::Approach(_) => "ellipsoid approach",
    }
}
