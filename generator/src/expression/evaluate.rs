//! Evaluates expressions at given inputs, over any scalar type: interprets the graph, operands before their users.
//!
//! It is the reference of hard cases and tests, which need no schedule, no list and no engine for it: over numbers that
//! know their rounding errors, double-doubles and dual numbers. The force laws belong to the runtime, so the caller
//! provides the functions that calls need. Programs that run a model use the engine.

use super::graph::{Graph, flatten};
use super::liveness::Live;
use super::node::{Function, Node, NodeId, Symbol};
use std::ops::{Add, Div, Mul, Neg, Range, Sub};

/// A scalar over which expressions are evaluated.
pub trait Scalar:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The nearest scalar to a number.
    fn from_f64(value: f64) -> Self;
    /// √a
    fn sqrt(self) -> Self;
    /// sin a
    fn sin(self) -> Self;
    /// cos a
    fn cos(self) -> Self;
    /// Angle of the point (`x`, `self`) \[rad\], in \[−π, π\].
    fn atan2(self, x: Self) -> Self;
    /// The larger of the two; the first if either is NaN.
    fn max(self, other: Self) -> Self;
    /// The smaller of the two; the first if either is NaN.
    fn min(self, other: Self) -> Self;
    /// `self · a + b`, with one rounding if the scalar type supports that.
    fn mul_add(self, a: Self, b: Self) -> Self {
        self * a + b
    }
}

macro_rules! scalar {
    ($($real:ident: $sin:ident, $cos:ident, $atan2:ident;)*) => {$(
        impl Scalar for $real {
            fn from_f64(value: f64) -> Self {
                value as $real
            }
            fn sqrt(self) -> Self {
                $real::sqrt(self)
            }
            fn sin(self) -> Self {
                libm::$sin(self)
            }
            fn cos(self) -> Self {
                libm::$cos(self)
            }
            fn atan2(self, x: Self) -> Self {
                libm::$atan2(self, x)
            }
            fn max(self, other: Self) -> Self {
                if self < other { other } else { self }
            }
            fn min(self, other: Self) -> Self {
                if other < self { other } else { self }
            }
            #[allow(clippy::disallowed_methods, reason = "rounded once is meant")]
            fn mul_add(self, a: Self, b: Self) -> Self {
                $real::mul_add(self, a, b)
            }
        }
    )*};
}
scalar! {
    f32: sinf, cosf, atan2f;
    f64: sin, cos, atan2;
}

/// Evaluates calls of functions that are not algebra. Closures over (function, arguments) implement it.
pub trait Functions<S> {
    /// The value of a function at [`Function::arity`] arguments.
    fn call(&self, function: Function, arguments: &[S]) -> S;
}

impl<S, F: Fn(Function, &[S]) -> S> Functions<S> for F {
    fn call(&self, function: Function, arguments: &[S]) -> S {
        self(function, arguments)
    }
}

/// The functions for expressions without calls: every call gives NaN.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFunctions;

impl<S: Scalar> Functions<S> for NoFunctions {
    fn call(&self, _: Function, _: &[S]) -> S {
        S::from_f64(f64::NAN)
    }
}

/// Values of the inputs.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a, S> {
    /// t \[s\]
    pub time: S,
    /// q
    pub coordinates: &'a [S],
    /// v
    pub velocities: &'a [S],
    /// Parameters of the model, in their order.
    pub parameters: &'a [S],
    /// z, the continuous states of force laws.
    pub auxiliaries: &'a [S],
    /// m, the discrete states of force laws.
    pub memory: &'a [S],
    /// a, the given accelerations.
    pub accelerations: &'a [S],
}

impl<S: Copy> Inputs<'_, S> {
    /// The value of one input.
    ///
    /// # Panics
    /// If the index is beyond the given inputs.
    pub fn get(&self, symbol: Symbol) -> S {
        match symbol {
            Symbol::Time => self.time,
            Symbol::Coordinate(i) => self.coordinates[i as usize],
            Symbol::Velocity(i) => self.velocities[i as usize],
            Symbol::Parameter(i) => self.parameters[i as usize],
            Symbol::Auxiliary(i) => self.auxiliaries[i as usize],
            Symbol::Memory(i) => self.memory[i as usize],
            Symbol::Acceleration(i) => self.accelerations[i as usize],
        }
    }
}

/// The values of `roots`, in their order, at one state. For many states, keep an [`Evaluator`].
///
/// # Panics
/// If the roots need an input beyond the given ones.
pub fn evaluate<S: Scalar>(
    graph: &Graph,
    roots: &[NodeId],
    inputs: &Inputs<'_, S>,
    functions: &impl Functions<S>,
) -> Vec<S> {
    Evaluator::new(graph, roots)
        .evaluate(inputs, functions)
        .to_vec()
}

/// Roots prepared for many evaluations: the live nodes are stored without gaps, with the constants filled in. An
/// evaluation allocates nothing.
#[derive(Clone, Debug)]
pub struct Evaluator<S> {
    /// The value of each live node.
    values: Vec<S>,
    /// The operations in order. Their operands are indices into `values`; a call has the range of its arguments in
    /// `arguments`.
    steps: Vec<(u32, Step)>,
    /// Arguments of calls, as indices into `values`.
    arguments: Vec<u32>,
    /// Buffer for the arguments of one call.
    given: Vec<S>,
    roots: Vec<u32>,
    results: Vec<S>,
}

/// One operation.
#[derive(Clone, Debug)]
enum Step {
    /// Any operation except a call.
    Algebra(Node),
    /// A call, with the range of its arguments.
    Call(Function, Range<usize>),
}

impl<S: Scalar> Evaluator<S> {
    /// Prepares the evaluation of `roots`.
    pub fn new(graph: &Graph, roots: &[NodeId]) -> Self {
        let live = Live::new(graph, roots);
        let nodes = graph.nodes();
        let mut place = vec![NodeId(0); nodes.len()];
        let mut values = vec![S::from_f64(0.0); live.nodes().len()];
        let mut steps = Vec::with_capacity(values.len());
        let (mut arguments, mut most) = (Vec::new(), 0);
        for (at, &id) in live.nodes().iter().enumerate() {
            place[id.0 as usize] = NodeId(at as u32);
            match nodes[id.0 as usize] {
                Node::Constant(bits) => values[at] = S::from_f64(f64::from_bits(bits)),
                Node::Arguments(_) => {}
                Node::Call(function, operands) => {
                    let (start, mut found) = (arguments.len(), Vec::new());
                    flatten(
                        function.arity(),
                        operands,
                        &|id| nodes[id.0 as usize],
                        &mut found,
                    );
                    most = most.max(found.len());
                    arguments.extend(found.iter().map(|id| place[id.0 as usize].0));
                    steps.push((at as u32, Step::Call(function, start..arguments.len())));
                }
                node => steps.push((
                    at as u32,
                    Step::Algebra(node.map_operands(|operand| place[operand.0 as usize])),
                )),
            }
        }
        Evaluator {
            values,
            steps,
            arguments,
            given: Vec::with_capacity(most),
            roots: roots.iter().map(|r| place[r.0 as usize].0).collect(),
            results: vec![S::from_f64(0.0); roots.len()],
        }
    }

    /// The values of the roots at these inputs, in their order.
    ///
    /// # Panics
    /// If the roots need an input beyond the given ones.
    pub fn evaluate(&mut self, inputs: &Inputs<'_, S>, functions: &impl Functions<S>) -> &[S] {
        for (target, step) in &self.steps {
            self.values[*target as usize] = match step {
                Step::Algebra(node) => algebra(&self.values, *node, inputs),
                Step::Call(function, range) => {
                    let values = &self.values;
                    let arguments = &self.arguments[range.clone()];
                    self.given.clear();
                    self.given
                        .extend(arguments.iter().map(|&i| values[i as usize]));
                    functions.call(*function, &self.given)
                }
            };
        }
        for (result, &root) in self.results.iter_mut().zip(&self.roots) {
            *result = self.values[root as usize];
        }
        &self.results
    }
}

fn algebra<S: Scalar>(values: &[S], node: Node, inputs: &Inputs<'_, S>) -> S {
    let v = |id: NodeId| values[id.0 as usize];
    match node {
        Node::Constant(bits) => S::from_f64(f64::from_bits(bits)),
        Node::Symbol(symbol) => inputs.get(symbol),
        Node::Neg(a) => -v(a),
        Node::Add(a, b) => v(a) + v(b),
        Node::Sub(a, b) => v(a) - v(b),
        Node::Mul(a, b) => v(a) * v(b),
        Node::Div(a, b) => v(a) / v(b),
        Node::MulAdd(a, b, c) => v(a).mul_add(v(b), v(c)),
        Node::Sqrt(a) => v(a).sqrt(),
        Node::Sin(a) => v(a).sin(),
        Node::Cos(a) => v(a).cos(),
        Node::Atan2(a, b) => v(a).atan2(v(b)),
        Node::Max(a, b) => v(a).max(v(b)),
        Node::Min(a, b) => v(a).min(v(b)),
        // Calls are evaluated by the caller; a list of arguments has no value.
        Node::Call(..) | Node::Arguments(_) => S::from_f64(f64::NAN),
    }
}
