//! The text of a listing: decides which values get a line of their own, and how the others are written in place.
//!
//! A value gets a line of its own if it has a name, if it is used more than once and is not cheap to repeat, or if
//! another line would become too long without it. Sums are lists of signed terms and products lists of factors, in the
//! order in which they were made. So signs fold (a − (b − c) is a − b + c) and there are no superfluous parentheses.
//! The listing is for reading: it does not show the order in which a sum is rounded.

use super::Names;
use crate::expression::graph::Graph;
use crate::expression::liveness::Live;
use crate::expression::node::{Function, Node, NodeId, Symbol};
use rustc_hash::FxHashSet;
use std::mem::take;

/// Largest total length of a node's operands on one line, in characters; beyond, the longest operands get lines of
/// their own.
const LONGEST: usize = 160;

/// The notation of a language.
pub(super) trait Notation {
    /// A finite number ≥ 0, or infinity or NaN.
    fn number(&self, value: f64) -> String;
    fn input(&self, name: String) -> String;
    /// The name of a value with a line of its own.
    fn defined(&self, name: &str) -> String;
    fn parenthesised(&self, inner: &str) -> String;
    /// The sign between factors.
    fn times(&self) -> &'static str;
    /// A quotient. The operands have no parentheses yet; the result needs none in a product.
    fn quotient(&self, above: Operand, below: Operand) -> String;
    fn sqrt(&self, inner: &str) -> String;
    /// A call of sin, cos, atan2, max or min.
    fn standard(&self, name: &'static str, arguments: &[String]) -> String;
    fn call(&self, name: &str, arguments: &[String]) -> String;
}

/// The text of an operand, and its precedence.
pub(super) struct Operand {
    pub text: String,
    pub form: Binding,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Binding {
    Sum,
    Product,
    Atom,
}

/// A line of the listing.
pub(super) enum Line {
    /// The definitions of this section follow.
    Section(String),
    /// The results follow.
    Results,
    /// name = value
    Equation { name: String, value: String },
}

/// The definitions by section, then the roots under their names.
pub(super) fn listing(
    graph: &Graph,
    roots: &[(String, NodeId)],
    names: &Names<'_>,
    notation: &dyn Notation,
) -> Vec<Line> {
    let ids: Vec<NodeId> = roots.iter().map(|(_, id)| *id).collect();
    let live = Live::new(graph, &ids);
    let occurrences = occurrences(graph, &live);
    let mut taken: FxHashSet<String> = roots.iter().map(|(name, _)| name.clone()).collect();
    for &id in live.nodes() {
        if let Node::Symbol(symbol) = graph.node(id) {
            taken.insert((names.symbol)(symbol));
        }
    }
    let mut writer = Writer {
        graph,
        names,
        notation,
        pieces: vec![Piece::default(); graph.len()],
        defined: vec![false; graph.len()],
        lines: Vec::new(),
        section: String::new(),
        taken,
        unnamed: 0,
    };
    for &id in live.nodes() {
        let node = graph.node(id);
        let piece = writer.piece(id, node);
        writer.pieces[id.0 as usize] = piece;
        let trivial = matches!(
            node,
            Node::Constant(_) | Node::Symbol(_) | Node::Arguments(_)
        );
        let shared = occurrences[id.0 as usize] > 1 && !cheap(graph, node);
        if !trivial && (shared || graph.name_of(id).is_some()) {
            writer.define(id);
        }
    }
    if !writer.lines.is_empty() {
        writer.lines.push(Line::Results);
    }
    for (name, id) in roots {
        let value = writer.signed(&writer.pieces[id.0 as usize]);
        if *name != value {
            let name = name.clone();
            writer.lines.push(Line::Equation { name, value });
        }
    }
    writer.lines
}

/// True if a node is written again at each use rather than defined once.
fn cheap(graph: &Graph, node: Node) -> bool {
    match node {
        Node::Constant(_) | Node::Symbol(_) | Node::Neg(_) => true,
        Node::Sin(a) | Node::Cos(a) => matches!(graph.node(a), Node::Symbol(_)),
        _ => false,
    }
}

/// How often each node is written if every value that is not cheap gets a line of its own.
fn occurrences(graph: &Graph, live: &Live) -> Vec<u32> {
    let mut occurrences = vec![0u32; graph.len()];
    for root in live.roots() {
        occurrences[root.0 as usize] += 1;
    }
    for &id in live.nodes().iter().rev() {
        let node = graph.node(id);
        let own = if cheap(graph, node) {
            occurrences[id.0 as usize]
        } else {
            1
        };
        for operand in node.operands() {
            let count = &mut occurrences[operand.0 as usize];
            *count = count.saturating_add(own);
        }
    }
    occurrences
}

/// A value in parts, with its sign.
#[derive(Clone)]
struct Piece {
    /// True if the value is negated; always false for sums, whose terms have signs.
    negative: bool,
    form: Form,
}

#[derive(Clone)]
enum Form {
    Atom(String),
    Quotient(String),
    Product(Vec<Factor>),
    Sum(Vec<Term>),
}

#[derive(Clone)]
struct Factor {
    made: Order,
    text: String,
    /// The text of the negative, if it is not longer.
    opposite: Option<String>,
}

#[derive(Clone)]
struct Term {
    made: Order,
    negative: bool,
    text: String,
}

/// Sort key of terms and factors: numbers come first, then all others by age; in a product, quotients come last.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Order(u8, NodeId);

impl Default for Piece {
    fn default() -> Self {
        Piece::atom(String::new())
    }
}

impl Piece {
    fn atom(text: String) -> Self {
        Piece {
            negative: false,
            form: Form::Atom(text),
        }
    }

    fn negated(mut self) -> Self {
        match &mut self.form {
            Form::Sum(terms) => terms.iter_mut().for_each(|t| t.negative = !t.negative),
            _ => self.negative = !self.negative,
        }
        self.settled()
    }

    /// Moves the sign of a product into one of its sums: −a (b − c) is a (c − b).
    fn settled(mut self) -> Self {
        if let Form::Product(factors) = &mut self.form
            && self.negative
            && let Some(factor) = factors.iter_mut().find(|f| f.opposite.is_some())
            && let Some(opposite) = factor.opposite.take()
        {
            factor.opposite = Some(std::mem::replace(&mut factor.text, opposite));
            self.negative = false;
        }
        self
    }

    fn length(&self) -> usize {
        match &self.form {
            Form::Atom(text) | Form::Quotient(text) => text.len(),
            Form::Product(factors) => factors.iter().map(|f| f.text.len() + 1).sum(),
            Form::Sum(terms) => terms.iter().map(|t| t.text.len() + 3).sum(),
        }
    }
}

struct Writer<'a> {
    graph: &'a Graph,
    names: &'a Names<'a>,
    notation: &'a dyn Notation,
    /// The piece of each node.
    pieces: Vec<Piece>,
    /// By node: true if the node has a line of its own.
    defined: Vec<bool>,
    lines: Vec<Line>,
    section: String,
    taken: FxHashSet<String>,
    unnamed: usize,
}

impl Writer<'_> {
    fn piece(&mut self, id: NodeId, node: Node) -> Piece {
        self.keep_short(node);
        match node {
            Node::Constant(bits) => {
                let value = f64::from_bits(bits);
                Piece {
                    negative: value < 0.0,
                    form: Form::Atom(self.notation.number(value.abs())),
                }
            }
            Node::Symbol(symbol) => self.symbol(symbol),
            Node::Neg(a) => self.get(a).negated(),
            Node::Add(a, b) => {
                let (x, y) = (self.get(a), self.get(b));
                self.sum((a, x), (b, y))
            }
            Node::Sub(a, b) => {
                let (x, y) = (self.get(a), self.get(b).negated());
                self.sum((a, x), (b, y))
            }
            Node::Mul(a, b) => self.product(a, b),
            Node::MulAdd(a, b, c) => {
                let (x, y) = (self.product(a, b), self.get(c));
                self.sum((id, x), (c, y))
            }
            Node::Div(a, b) => {
                let (x, y) = (self.get(a), self.get(b));
                let negative = x.negative != y.negative;
                let [x, y] = [x, y].map(|piece| self.unsigned(&piece));
                Piece {
                    negative,
                    form: Form::Quotient(self.notation.quotient(x, y)),
                }
            }
            Node::Sqrt(a) => {
                let a = self.text(a);
                Piece::atom(self.notation.sqrt(&a))
            }
            Node::Sin(a) => self.standard("sin", &[a]),
            Node::Cos(a) => self.standard("cos", &[a]),
            Node::Atan2(a, b) => self.standard("atan2", &[a, b]),
            Node::Max(a, b) => self.standard("max", &[a, b]),
            Node::Min(a, b) => self.standard("min", &[a, b]),
            Node::Call(function, _) => self.call(function, &self.graph.arguments(id)),
            Node::Arguments(_) => Piece::atom(String::new()),
        }
    }

    /// Gives the longest operands lines of their own until the rest fits on one line.
    fn keep_short(&mut self, node: Node) {
        loop {
            let length = |id: NodeId| self.pieces[id.0 as usize].length();
            let total: usize = node.operands().map(length).sum();
            let longest = node.operands().max_by_key(|&id| length(id));
            match longest {
                // Names can be long, too, but a further line would not shorten them.
                Some(id) if total > LONGEST && length(id) > LONGEST / 4 && !self.named(id) => {
                    self.define(id);
                }
                _ => return,
            }
        }
    }

    /// True if the value is written by its name.
    fn named(&self, id: NodeId) -> bool {
        self.defined[id.0 as usize] || matches!(self.graph.node(id), Node::Symbol(_))
    }

    fn symbol(&self, symbol: Symbol) -> Piece {
        Piece::atom(self.notation.input((self.names.symbol)(symbol)))
    }

    fn get(&self, id: NodeId) -> Piece {
        self.pieces[id.0 as usize].clone()
    }

    fn text(&self, id: NodeId) -> String {
        self.signed(&self.pieces[id.0 as usize])
    }

    fn sum(&self, (a, x): (NodeId, Piece), (b, y): (NodeId, Piece)) -> Piece {
        let mut terms = self.terms(a, x);
        terms.extend(self.terms(b, y));
        terms.sort_by_key(|t| t.made);
        Piece {
            negative: false,
            form: Form::Sum(terms),
        }
    }

    fn terms(&self, id: NodeId, piece: Piece) -> Vec<Term> {
        match piece.form {
            Form::Sum(terms) => terms,
            _ => vec![Term {
                made: Order(0, self.age(id)),
                negative: piece.negative,
                text: self.unsigned(&piece).text,
            }],
        }
    }

    fn product(&self, a: NodeId, b: NodeId) -> Piece {
        let (x, y) = (self.get(a), self.get(b));
        let negative = x.negative != y.negative;
        let mut factors = self.factors(a, x);
        factors.extend(self.factors(b, y));
        factors.sort_by_key(|f| f.made);
        let product = Piece {
            negative,
            form: Form::Product(factors),
        };
        product.settled()
    }

    fn factors(&self, id: NodeId, piece: Piece) -> Vec<Factor> {
        let rank = match (&piece.form, self.graph.node(id)) {
            (_, Node::Constant(_)) => 0,
            (Form::Quotient(_), _) => 2,
            _ => 1,
        };
        let made = Order(rank, self.age(id));
        match piece.form {
            Form::Product(factors) => factors,
            Form::Sum(mut terms) => {
                let text = self.notation.parenthesised(&sum_text(&terms));
                terms.iter_mut().for_each(|t| t.negative = !t.negative);
                // A longer negative, such as that of a + b, would be no improvement.
                let opposite = Some(self.notation.parenthesised(&sum_text(&terms)))
                    .filter(|opposite| opposite.len() <= text.len());
                vec![Factor {
                    made,
                    text,
                    opposite,
                }]
            }
            _ => vec![Factor {
                made,
                text: self.unsigned(&piece).text,
                opposite: None,
            }],
        }
    }

    /// The age of a value, without regard to its sign.
    fn age(&self, id: NodeId) -> NodeId {
        match self.graph.node(id) {
            Node::Neg(a) => a,
            _ => id,
        }
    }

    fn standard(&self, name: &'static str, arguments: &[NodeId]) -> Piece {
        let texts: Vec<String> = arguments.iter().map(|&a| self.text(a)).collect();
        Piece::atom(self.notation.standard(name, &texts))
    }

    fn call(&self, function: Function, arguments: &[NodeId]) -> Piece {
        let texts: Vec<String> = arguments.iter().map(|&a| self.text(a)).collect();
        let name = (self.names.function)(function);
        Piece::atom(self.notation.call(&name, &texts))
    }

    /// The operand without its sign.
    fn unsigned(&self, piece: &Piece) -> Operand {
        let (text, form) = match &piece.form {
            Form::Atom(text) => (text.clone(), Binding::Atom),
            Form::Quotient(text) => (text.clone(), Binding::Product),
            Form::Product(factors) => {
                let texts: Vec<&str> = factors.iter().map(|f| f.text.as_str()).collect();
                (texts.join(self.notation.times()), Binding::Product)
            }
            Form::Sum(terms) => (sum_text(terms), Binding::Sum),
        };
        Operand { text, form }
    }

    fn signed(&self, piece: &Piece) -> String {
        let operand = self.unsigned(piece);
        match piece.negative {
            true => format!("-{}", operand.text),
            false => operand.text,
        }
    }

    /// Gives a node a line of its own. From here on it is written by its name.
    fn define(&mut self, id: NodeId) {
        let piece = take(&mut self.pieces[id.0 as usize]);
        let value = self.signed(&piece);
        let name = match self.graph.name_of(id) {
            Some(name) => self.unused(name),
            None => self.next_unnamed(),
        };
        let section = self.graph.sections()[self.graph.section_of(id)].clone();
        if section != self.section {
            self.lines.push(Line::Section(section.clone()));
            self.section = section;
        }
        let name = self.notation.defined(&name);
        self.pieces[id.0 as usize] = Piece::atom(name.clone());
        self.defined[id.0 as usize] = true;
        self.lines.push(Line::Equation { name, value });
    }

    fn unused(&mut self, name: String) -> String {
        let mut candidate = name.clone();
        let mut number = 2;
        while !self.taken.insert(candidate.clone()) {
            candidate = format!("{name}_{number}");
            number += 1;
        }
        candidate
    }

    fn next_unnamed(&mut self) -> String {
        loop {
            self.unnamed += 1;
            let name = format!("t{}", self.unnamed);
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }
}

/// The terms with their signs. A positive one comes first, if there is one.
fn sum_text(terms: &[Term]) -> String {
    let first = terms.iter().position(|t| !t.negative).unwrap_or(0);
    let mut text = String::new();
    let rest = terms.iter().enumerate().filter(|(i, _)| *i != first);
    for (at, term) in [(first, &terms[first])].into_iter().chain(rest) {
        text.push_str(match (at == first, term.negative) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        });
        text.push_str(&term.text);
    }
    text
}
