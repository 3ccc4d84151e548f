//! The effect of rounding on a value: expressions are evaluated with random relative errors in every operation.
//!
//! x ∘ y → (x ∘ y)(1 + ρ),   ρ uniform in \[−unit, unit\]
//!
//! The scatter of a few such evaluations measures κ·ε with the condition κ of this very expression: inputs and
//! constants are disturbed as well as results of operations (Monte Carlo arithmetic, Parker 1997).

use bryant_generator::expression::evaluate::{Evaluator, Functions, Inputs, Scalar};
use bryant_generator::expression::{Function, Graph, NodeId};
use std::cell::Cell;
use std::ops::{Add, Div, Mul, Neg, Sub};

thread_local! {
    /// Size of the disturbances, and state of their random generator.
    static DISTURBANCE: Cell<(f64, u64)> = const { Cell::new((0.0, 0)) };
}

/// A number whose operations have random errors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rough(pub f64);

impl Rough {
    /// The value with a random relative error of at most the current size.
    pub fn of(value: f64) -> Self {
        let factor = DISTURBANCE.with(|cell| {
            let (unit, mut x) = cell.get();
            x ^= x << 13;
            x ^= x >> 7;
            x ^= x << 17;
            cell.set((unit, x));
            1.0 + unit * ((x >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
        });
        Rough(value * factor)
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident $operator:tt),*) => {$(
        impl $trait for Rough {
            type Output = Rough;
            fn $method(self, other: Rough) -> Rough {
                Rough::of(self.0 $operator other.0)
            }
        }
    )*};
}
operators!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Rough {
    type Output = Rough;
    fn neg(self) -> Rough {
        Rough(-self.0)
    }
}

impl Scalar for Rough {
    fn from_f64(value: f64) -> Self {
        Rough::of(value)
    }
    fn sqrt(self) -> Self {
        Rough::of(self.0.sqrt())
    }
    fn sin(self) -> Self {
        Rough::of(self.0.sin())
    }
    fn cos(self) -> Self {
        Rough::of(self.0.cos())
    }
    fn atan2(self, x: Self) -> Self {
        Rough::of(self.0.atan2(x.0))
    }
    fn max(self, other: Self) -> Self {
        Rough(self.0.max(other.0))
    }
    fn min(self, other: Self) -> Self {
        Rough(self.0.min(other.0))
    }
}

/// Expressions that can be evaluated to values with their scatter.
pub struct Rounded {
    exact: Evaluator<f64>,
    rough: Evaluator<Rough>,
}

/// Number of disturbed evaluations for a scatter.
const SAMPLES: usize = 8;

impl Rounded {
    /// Prepares the evaluation of `roots`.
    pub fn new(graph: &Graph, roots: &[NodeId]) -> Self {
        Rounded {
            exact: Evaluator::new(graph, roots),
            rough: Evaluator::new(graph, roots),
        }
    }

    /// The values, and their largest deviations if every operation has a relative error of up to `unit`.
    pub fn evaluate(
        &mut self,
        inputs: &Inputs<'_, f64>,
        functions: &impl Functions<f64>,
        unit: f64,
    ) -> (Vec<f64>, Vec<f64>) {
        let values = self.exact.evaluate(inputs, functions).to_vec();
        let mut scatter = vec![0.0f64; values.len()];
        for sample in 0..SAMPLES {
            DISTURBANCE.set((unit, 0x9e37_79b9_7f4a_7c15 ^ (sample as u64 + 1)));
            let rough =
                |values: &[f64]| -> Vec<Rough> { values.iter().map(|&x| Rough::of(x)).collect() };
            let (q, v, p) = (
                rough(inputs.coordinates),
                rough(inputs.velocities),
                rough(inputs.parameters),
            );
            let (z, m) = (rough(inputs.auxiliaries), rough(inputs.memory));
            let inputs = Inputs {
                time: Rough::of(inputs.time),
                coordinates: &q,
                velocities: &v,
                parameters: &p,
                auxiliaries: &z,
                memory: &m,
                accelerations: &[],
            };
            let functions = |function: Function, arguments: &[Rough]| {
                let plain: Vec<f64> = arguments.iter().map(|rough| rough.0).collect();
                Rough::of(functions.call(function, &plain))
            };
            for ((scatter, rough), value) in scatter
                .iter_mut()
                .zip(self.rough.evaluate(&inputs, &functions))
                .zip(&values)
            {
                *scatter = scatter.max((rough.0 - value).abs());
            }
        }
        (values, scatter)
    }
}
