//! Evaluates expressions at given inputs, over any scalar type: interprets the graph, operands before their users.
//!
//! It is the reference of hard cases and tests, which need no schedule, no list and no engine for it: over numbers that
//! know their rounding errors, double-doubles and dual numbers. The force laws belong to the runtime, so the caller
//! provides the functions that calls need. Programs that run a model use the engine.

use super::graph::{Graph, flatten};
use super::live::Live;
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

#[cfg(test)]
mod tests {
    use super::*;

    const INPUTS: Inputs<'static, f64> = Inputs {
        time: 0.25,
        coordinates: &[3.0, 4.0],
        velocities: &[-2.0],
        parameters: &[10.0],
        auxiliaries: &[0.5],
        memory: &[-6.0],
        accelerations: &[],
    };

    #[test]
    fn every_kind_of_node_has_its_value() {
        let graph = Graph::new();
        let [t, x, y, v, p] = [
            Symbol::Time,
            Symbol::Coordinate(0),
            Symbol::Coordinate(1),
            Symbol::Velocity(0),
            Symbol::Parameter(0),
        ]
        .map(|s| graph.symbol(s));
        let fused = graph.intern(Node::MulAdd(x.id(), y.id(), v.id()));
        let call = graph.call(Function::Power, &[x, y]);
        let cases = [
            (t, 0.25),
            (-t, -0.25),
            (x + v, 1.0),
            (y - p, -6.0),
            (x * p, 30.0),
            (x / y, 0.75),
            ((x * x + y * y).sqrt(), 5.0),
            (x.sin(), 3f64.sin()),
            (y.cos(), 4f64.cos()),
            (y.atan2(x), 4f64.atan2(3.0)),
            (v.atan2(v), -0.75 * std::f64::consts::PI),
            (x.max(y), 4.0),
            (x.min(v), -2.0),
            (fused, 10.0),
            (call, 3.0 + 40.0),
            (graph.call(Function::Choose, &[x, y, p, v]), 10.0),
            (graph.call(Function::Choose, &[y, x, p, v]), -2.0),
            (graph.symbol(Symbol::Auxiliary(0)), 0.5),
            (graph.symbol(Symbol::Memory(0)), -6.0),
            (graph.constant(7.0), 7.0),
        ];
        let roots = cases.map(|(e, _)| e.id());
        let functions = |function, a: &[f64]| match function {
            Function::Power => a[0] + 10.0 * a[1],
            Function::Choose if a[0] < a[1] => a[2],
            Function::Choose => a[3],
            _ => f64::NAN,
        };
        let values = evaluate(&graph, &roots, &INPUTS, &functions);
        assert_eq!(values, cases.map(|(_, value)| value));
    }

    #[test]
    fn an_evaluator_forgets_the_state_before() {
        let graph = Graph::new();
        let [x, y] = [0, 1].map(|i| graph.symbol(Symbol::Coordinate(i)));
        let mut evaluator = Evaluator::<f32>::new(&graph, &[(2.0 * x * y).id(), x.id()]);
        for state in [[3.0, 4.0], [5.0, -1.0]] {
            let inputs = Inputs {
                time: 0.0,
                coordinates: &state,
                velocities: &[],
                parameters: &[],
                auxiliaries: &[],
                memory: &[],
                accelerations: &[],
            };
            let [x, y] = state;
            assert_eq!(
                evaluator.evaluate(&inputs, &NoFunctions),
                [2.0 * x * y, x].as_slice()
            );
        }
    }

    #[test]
    fn a_call_that_nobody_answers_is_not_a_number() {
        let graph = Graph::new();
        let call = graph.call(Function::Curve(0), &[graph.symbol(Symbol::Time)]);
        assert!(evaluate(&graph, &[call.id()], &INPUTS, &NoFunctions)[0].is_nan());
    }
}
