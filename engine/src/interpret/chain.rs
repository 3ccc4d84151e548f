//! Joins the operations of a list into chains. In a chain, each operation uses the result of the one before, and this
//! result is used nowhere else.
//!
//! Example: a·b + c·d + e·f is one chain of three operations. Its intermediate results are never stored. If an operand
//! of a fused operation is a change of sign, the sign becomes part of the kind of the operation.

use bryant_generator::expression::Function;
use bryant_generator::program::{List, Operation, Value};

/// The largest number of operations in a chain.
pub const LONGEST: usize = 3;

/// The kind of an operation of the interpreter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    /// a·b + c
    MulAdd,
    /// a·b − c
    MulSub,
    /// −a·b + c
    NegMulAdd,
    /// −a·b − c
    NegMulSub,
    Sqrt,
    SinCos,
    Atan2,
    Max,
    Min,
    Call,
}

/// An operation with its operands. The operands of a call are stored in [`Call`].
#[derive(Clone, Copy, Debug)]
pub struct Link {
    pub kind: Kind,
    /// The operands, as indices of values; only as many as the kind has.
    pub operands: [u32; 3],
    /// Index of the first value that it defines.
    pub defines: u32,
}

/// A call of a function.
#[derive(Clone, Debug)]
pub struct Call {
    pub function: Function,
    /// Indices of values.
    pub arguments: Vec<u32>,
    /// The number of values that it defines.
    pub results: u32,
}

/// Operations that are executed one after the other. The third operand of each, except the first, is the result of the
/// one before.
#[derive(Clone, Copy, Debug)]
pub struct Chain {
    links: [Link; LONGEST],
    length: usize,
    /// The index of its call, if the chain is a call.
    call: usize,
}

impl Kind {
    /// Number of operands, without those of a call.
    pub fn operands(self) -> usize {
        match self {
            Kind::Call => 0,
            Kind::Neg | Kind::Sqrt | Kind::SinCos => 1,
            Kind::MulAdd | Kind::MulSub | Kind::NegMulAdd | Kind::NegMulSub => 3,
            _ => 2,
        }
    }

    fn fused(negative: bool, minus: bool) -> Kind {
        match (negative, minus) {
            (false, false) => Kind::MulAdd,
            (false, true) => Kind::MulSub,
            (true, false) => Kind::NegMulAdd,
            (true, true) => Kind::NegMulSub,
        }
    }

    /// True if a chain may begin with an operation of this kind.
    fn begins(self) -> bool {
        matches!(
            self,
            Kind::Add
                | Kind::Sub
                | Kind::Mul
                | Kind::MulAdd
                | Kind::MulSub
                | Kind::NegMulAdd
                | Kind::NegMulSub
        )
    }

    /// True if an operation of this kind may continue a chain.
    fn goes_on(self) -> bool {
        matches!(self, Kind::MulAdd | Kind::NegMulAdd | Kind::MulSub)
    }
}

impl Chain {
    pub fn links(&self) -> &[Link] {
        &self.links[..self.length]
    }

    /// The index of its call, if the chain is a call.
    pub fn call(&self) -> Option<usize> {
        (self.links[0].kind == Kind::Call).then_some(self.call)
    }

    /// The chain without its last operation, and the last operation as a chain.
    pub fn split(&self) -> [Chain; 2] {
        let last = self.links[self.length - 1];
        let first = Chain {
            length: self.length - 1,
            ..*self
        };
        let last = Chain {
            links: [last; LONGEST],
            length: 1,
            call: self.call,
        };
        [first, last]
    }

    /// Calls `of` with every value that the chain uses and does not define itself.
    pub fn needs(&self, calls: &[Call], mut of: impl FnMut(u32)) {
        for (place, link) in self.links().iter().enumerate() {
            let count = link.kind.operands() - usize::from(place > 0);
            link.operands[..count].iter().copied().for_each(&mut of);
        }
        if let Some(call) = self.call() {
            calls[call].arguments.iter().copied().for_each(of);
        }
    }

    /// The first value that the chain defines for others, and the number of these values.
    pub fn defines(&self, calls: &[Call]) -> (u32, u32) {
        let last = self.links[self.length - 1];
        let count = match last.kind {
            Kind::Call => calls[self.call].results,
            Kind::SinCos => 2,
            _ => 1,
        };
        (last.defines, count)
    }
}

/// The chains of a list, in the order of its operations, and the calls of the list.
pub fn chains(list: &List) -> (Vec<Chain>, Vec<Call>) {
    let (links, calls) = links(list);
    let values = list.values();
    let mut uses = vec![0_u32; values];
    let mut defined_by = vec![usize::MAX; values];
    for (at, (link, call)) in links.iter().enumerate() {
        defined_by[link.defines as usize] = at;
        for &operand in &link.operands[..link.kind.operands()] {
            uses[operand as usize] += 1;
        }
        if link.kind == Kind::Call {
            for &argument in &calls[*call].arguments {
                uses[argument as usize] += 1;
            }
        }
    }
    for result in &list.results {
        uses[result.0 as usize] += 1;
    }
    let mut taken = vec![false; links.len()];
    let mut found = Vec::with_capacity(links.len());
    for at in (0..links.len()).rev() {
        let (last, call) = links[at];
        // the sign became part of the operations that use it
        let unused = last.kind == Kind::Neg && uses[last.defines as usize] == 0;
        if taken[at] || unused {
            continue;
        }
        let mut backwards = vec![last];
        while let Some(link) = backwards.last()
            && backwards.len() < LONGEST
            && link.kind.goes_on()
        {
            let addend = link.operands[2] as usize;
            let before = defined_by[addend];
            if uses[addend] != 1 || before == usize::MAX || taken[before] {
                break;
            }
            let first = links[before].0;
            if !first.kind.begins() {
                break;
            }
            taken[before] = true;
            backwards.push(first);
        }
        let length = backwards.len();
        let links = std::array::from_fn(|i| match i < length {
            true => backwards[length - 1 - i],
            false => last,
        });
        found.push(Chain {
            links,
            length,
            call,
        });
    }
    found.reverse();
    (found, calls)
}

/// The operations, each with the index of its call if it is a call, and all calls. Fused operations include the signs
/// of their operands.
fn links(list: &List) -> (Vec<(Link, usize)>, Vec<Call>) {
    let leaves = list.constants.len() + list.inputs.len();
    let mut negative_of: Vec<Option<u32>> = vec![None; leaves];
    let mut calls = Vec::new();
    let mut links = Vec::with_capacity(list.operations.len());
    for &operation in &list.operations {
        let defines = negative_of.len() as u32;
        let link = |kind, operands: [Value; 3]| Link {
            kind,
            operands: operands.map(|value| value.0),
            defines,
        };
        let (mut call, mut negative) = (usize::MAX, None);
        let made = match operation {
            Operation::Neg(a) => {
                negative = Some(a.0);
                link(Kind::Neg, [a; 3])
            }
            Operation::Add(a, b) => link(Kind::Add, [a, b, b]),
            Operation::Sub(a, b) => link(Kind::Sub, [a, b, b]),
            Operation::Mul(a, b) => link(Kind::Mul, [a, b, b]),
            Operation::Div(a, b) => link(Kind::Div, [a, b, b]),
            Operation::MulAdd(a, b, c) => {
                let plain = |value: Value| negative_of[value.0 as usize].map_or(value, Value);
                let signed = |value: Value| negative_of[value.0 as usize].is_some();
                let kind = Kind::fused(signed(a) != signed(b), signed(c));
                link(kind, [plain(a), plain(b), plain(c)])
            }
            Operation::Sqrt(a) => link(Kind::Sqrt, [a; 3]),
            Operation::SinCos(a) => link(Kind::SinCos, [a; 3]),
            Operation::Atan2(a, b) => link(Kind::Atan2, [a, b, b]),
            Operation::Max(a, b) => link(Kind::Max, [a, b, b]),
            Operation::Min(a, b) => link(Kind::Min, [a, b, b]),
            Operation::Call { function, .. } => {
                call = calls.len();
                calls.push(Call {
                    function,
                    arguments: list.operands(operation).map(|value| value.0).collect(),
                    results: operation.defines() as u32,
                });
                link(Kind::Call, [Value(0); 3])
            }
        };
        negative_of.push(negative);
        negative_of.resize(defines as usize + operation.defines(), None);
        links.push((made, call));
    }
    (links, calls)
}
