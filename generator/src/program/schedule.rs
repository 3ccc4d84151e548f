//! A method as statements: the values that are bound, and their order.

use super::inline::inline;
use super::order::Order;
use crate::expression::{Graph, Node, NodeId};
use crate::method::inputs::Inputs;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// The values of a method in the order in which they are computed.
pub(crate) struct Schedule {
    /// The graph of the method.
    pub graph: Graph,
    /// The results of the method.
    pub roots: Vec<NodeId>,
    /// True if each root is written by a statement of its own, false if the roots are returned.
    puts: bool,
    /// The lines, in order.
    pub lines: Vec<Line>,
    /// By node: true if a line binds it.
    binds: Vec<bool>,
    /// By call with several results: the results that are used, at their places; `None` for an unused one.
    calls: Vec<Vec<Option<NodeId>>>,
}

/// A statement, with its section.
pub(crate) struct Line {
    pub section: usize,
    pub statement: Statement,
}

impl Line {
    /// The section that begins with this line, if it is not the `current` one, which is updated. A line that writes a
    /// result begins no section.
    pub(crate) fn begins(&self, current: &mut Option<usize>) -> Option<usize> {
        let binds = !matches!(self.statement, Statement::Put(_));
        let new = binds && current.replace(self.section) != Some(self.section);
        new.then_some(self.section)
    }
}

/// The values that a statement binds.
#[derive(Clone, Copy)]
pub(crate) enum Statement {
    /// One value.
    Value(NodeId),
    /// Sine and cosine of one argument; `None` for an unused one.
    SinCos {
        argument: NodeId,
        sin: Option<NodeId>,
        cos: Option<NodeId>,
    },
    /// The results of a call with several results, by the index of the call.
    Results(usize),
    /// No value: writes a root to the output writer, by the index of the root.
    Put(usize),
}

impl Schedule {
    /// Schedules the values that the roots need. `labels` are the names of roots that have none, in the same order:
    /// their widths influence which values are bound.
    pub(crate) fn new(
        graph: Graph,
        roots: Vec<NodeId>,
        labels: &[String],
        inputs: &Inputs,
        order: Order,
        puts: bool,
    ) -> Self {
        let labels = labels_of(&graph, &roots, labels);
        let uses = uses(&graph, &roots);
        let inline = inline(&graph, &labels, &uses, inputs);
        let ordered = order.operations(&graph, &uses);
        let partners = partners(&graph, &uses);
        let calls = calls(&graph, &uses);
        let mut call_of = FxHashMap::default();
        for (call, results) in calls.iter().enumerate() {
            call_of.extend(results.iter().flatten().map(|&id| (id, call)));
        }
        let mut schedule = Schedule {
            binds: vec![false; graph.len()],
            graph,
            roots,
            puts,
            lines: Vec::new(),
            calls,
        };
        for id in ordered {
            if inline[index(id)] || schedule.binds[index(id)] {
                continue;
            }
            let statement = match schedule.graph.node(id) {
                Node::Sin(argument) | Node::Cos(argument) => {
                    let (sin, cos) = partners[index(argument)];
                    Statement::SinCos { argument, sin, cos }
                }
                Node::Call(..) => match call_of.get(&id) {
                    Some(&call) => Statement::Results(call),
                    None => Statement::Value(id),
                },
                _ => Statement::Value(id),
            };
            for bound in schedule.bound_values(statement) {
                schedule.binds[index(bound)] = true;
            }
            schedule.lines.push(Line {
                section: schedule.graph.section_of(id),
                statement,
            });
        }
        if puts {
            schedule.put_results();
        }
        schedule
    }

    /// Adds lines that write each root to the output writer as soon as it is known, so that it need not be stored:
    /// after the line that binds it. Roots that no line binds come last.
    fn put_results(&mut self) {
        let mut line_of = vec![None; self.graph.len()];
        for (number, line) in self.lines.iter().enumerate() {
            for id in self.bound_values(line.statement) {
                line_of[index(id)] = Some(number);
            }
        }
        let end = self.lines.len();
        let mut known_at: Vec<Vec<usize>> = vec![Vec::new(); end + 1];
        for (place, &root) in self.roots.iter().enumerate() {
            let mut reads = BTreeSet::new();
            self.reads(root, &mut reads);
            let line = reads.iter().filter_map(|&id| line_of[index(id)]).max();
            known_at[line.unwrap_or(end)].push(place);
        }
        let unbound = known_at.pop().unwrap_or_default();
        let mut section = 0;
        let put = |section: usize| {
            move |place| Line {
                section,
                statement: Statement::Put(place),
            }
        };
        for (line, places) in std::mem::take(&mut self.lines).into_iter().zip(known_at) {
            section = line.section;
            self.lines.push(line);
            self.lines.extend(places.into_iter().map(put(section)));
        }
        self.lines.extend(unbound.into_iter().map(put(section)));
    }

    /// The roots that are returned.
    pub(crate) fn returned(&self) -> &[NodeId] {
        match self.puts {
            true => &[],
            false => &self.roots,
        }
    }

    /// The values that a statement binds.
    pub(crate) fn bound_values(&self, statement: Statement) -> Vec<NodeId> {
        let results = self.results_by_place(statement);
        results.into_iter().flatten().collect()
    }

    /// The results of a statement, at their places; `None` for one that is unused and so is not bound.
    pub(crate) fn results_by_place(&self, statement: Statement) -> Vec<Option<NodeId>> {
        match statement {
            Statement::Value(id) => vec![Some(id)],
            Statement::SinCos { sin, cos, .. } => vec![sin, cos],
            Statement::Results(call) => self.calls[call].clone(),
            Statement::Put(_) => Vec::new(),
        }
    }

    /// The nodes whose expressions a statement evaluates.
    pub(crate) fn needs(&self, statement: Statement) -> Vec<NodeId> {
        match statement {
            Statement::Value(id) => self.graph.node(id).operands().collect(),
            Statement::SinCos { argument, .. } => vec![argument],
            Statement::Results(call) => {
                let any = self.calls[call].iter().flatten().next();
                any.map_or_else(Vec::new, |&id| self.graph.node(id).operands().collect())
            }
            Statement::Put(place) => vec![self.roots[place]],
        }
    }

    /// The results of a call with several results: those that are used, at their places.
    pub(crate) fn results(&self, call: usize) -> &[Option<NodeId>] {
        &self.calls[call]
    }

    /// True if a line binds the value.
    pub(crate) fn is_bound(&self, id: NodeId) -> bool {
        self.binds[index(id)]
    }

    /// Bound values and inputs that an expression reads.
    pub(crate) fn reads(&self, expression: NodeId, found: &mut BTreeSet<NodeId>) {
        if self.is_bound(expression) || matches!(self.graph.node(expression), Node::Symbol(_)) {
            found.insert(expression);
        } else {
            for operand in self.graph.node(expression).operands() {
                self.reads(operand, found);
            }
        }
    }
}

/// The index of a node in lists by node.
pub(crate) fn index(id: NodeId) -> usize {
    id.0 as usize
}

/// By node: the number of its uses; 0 if the roots do not need it.
pub fn uses(graph: &Graph, roots: &[NodeId]) -> Vec<u32> {
    let mut uses = vec![0; graph.len()];
    for &root in roots {
        uses[index(root)] += 1;
    }
    for (position, node) in graph.nodes().iter().enumerate().rev() {
        if uses[position] > 0 {
            for operand in node.operands() {
                uses[index(operand)] += 1;
            }
        }
    }
    uses
}

/// The label of each root that is an operation.
pub(crate) fn labels_of(
    graph: &Graph,
    roots: &[NodeId],
    labels: &[String],
) -> FxHashMap<NodeId, String> {
    let mut found = FxHashMap::default();
    for (&root, label) in roots.iter().zip(labels) {
        if !graph.node(root).is_leaf() {
            found.entry(root).or_insert_with(|| label.clone());
        }
    }
    found
}

/// Sine and cosine of each argument, as far as they are used.
fn partners(graph: &Graph, uses: &[u32]) -> Vec<(Option<NodeId>, Option<NodeId>)> {
    let mut partners = vec![(None, None); graph.len()];
    for (position, node) in graph.nodes().iter().enumerate() {
        let id = NodeId(position as u32);
        match node {
            Node::Sin(a) if uses[position] > 0 => partners[index(*a)].0 = Some(id),
            Node::Cos(a) if uses[position] > 0 => partners[index(*a)].1 = Some(id),
            _ => {}
        }
    }
    partners
}

/// The calls with several results, each once, with the results that are used.
fn calls(graph: &Graph, uses: &[u32]) -> Vec<Vec<Option<NodeId>>> {
    let mut calls: Vec<Vec<Option<NodeId>>> = Vec::new();
    let mut place: FxHashMap<Node, usize> = FxHashMap::default();
    for (position, node) in graph.nodes().iter().enumerate() {
        if uses[position] > 0
            && let Node::Call(function, arguments) = *node
            && let Some((part, parts)) = function.part()
        {
            let call = Node::Call(function.first_part(), arguments);
            let at = *place.entry(call).or_insert_with(|| {
                calls.push(vec![None; parts]);
                calls.len() - 1
            });
            calls[at][part] = Some(NodeId(position as u32));
        }
    }
    calls
}
