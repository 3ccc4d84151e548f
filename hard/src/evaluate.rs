//! Evaluates the accelerations of a model from its graph without compilation: the operations of the generated source in
//! the same order, in `f64`, or in double-double to see which part of an error is rounding.

use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::{Equations, Route};
use bryant_generator::expression::Function;
use bryant_generator::expression::evaluate::{Evaluator, Inputs, Scalar};
use bryant_generator::expression::passes::{Rewritten, factor, fuse};
use bryant_generator::model::Model;
use bryant_runtime::{DoubleDouble, Real};
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Computes v̇ for given q and v. The forces of the model must be algebraic, and must not depend on time or memory.
/// Bryant angles are in their first chart, in which A = Rx(φ₁) Ry(φ₂) Rz(φ₃).
#[derive(Debug)]
pub struct Accelerations<S> {
    evaluator: Evaluator<S>,
    charts: Vec<S>,
}

impl<S: Scalar + PartialOrd> Accelerations<S> {
    /// Solves by elimination, with the passes of the generated source.
    pub fn by_elimination(model: &Model) -> Accelerations<S> {
        Self::by(model, Route::Elimination)
    }

    /// Solves by the given route.
    pub fn by(model: &Model, route: Route) -> Accelerations<S> {
        let options = Options {
            matrices: false,
            route: Some(route),
        };
        let Equations {
            graph,
            accelerations,
            memory,
            ..
        } = derive_with(model, options);
        let Rewritten { graph, roots } = factor(&graph, &accelerations);
        let Rewritten { graph, roots } = fuse(&graph, &roots);
        Accelerations {
            evaluator: Evaluator::new(&graph, &roots),
            charts: vec![S::from_f64(0.0); memory.len()],
        }
    }

    /// v̇; q, v and v̇ are in the model's order.
    pub fn at(&mut self, q: &[S], v: &[S]) -> Vec<S> {
        let inputs = Inputs {
            time: S::from_f64(0.0),
            coordinates: q,
            velocities: v,
            parameters: &[],
            auxiliaries: &[],
            memory: &self.charts,
            accelerations: &[],
        };
        // the only function is the choice of a chart: the third argument if the first is less than the second, else the
        // fourth
        let choose = |function: Function, given: &[S]| match (function, given) {
            (Function::Choose, &[a, b, then, _]) if a < b => then,
            (Function::Choose, &[_, _, _, otherwise]) => otherwise,
            _ => S::from_f64(f64::NAN),
        };
        self.evaluator.evaluate(&inputs, &choose).to_vec()
    }
}

/// Double-double numbers for the interpreter: the runtime's type with the generator's trait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precise(pub DoubleDouble);

impl PartialOrd for Precise {
    fn partial_cmp(&self, other: &Precise) -> Option<Ordering> {
        let [[a, low_a], [b, low_b]] = [self.0.parts(), other.0.parts()];
        Some(a.partial_cmp(&b)?.then(low_a.partial_cmp(&low_b)?))
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {$(
        impl $trait for Precise {
            type Output = Precise;
            fn $method(self, other: Precise) -> Precise {
                Precise($trait::$method(self.0, other.0))
            }
        }
    )*};
}
operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Precise {
    type Output = Precise;
    fn neg(self) -> Precise {
        Precise(-self.0)
    }
}

impl Scalar for Precise {
    fn from_f64(value: f64) -> Self {
        Precise(Real::from_f64(value))
    }
    fn sqrt(self) -> Self {
        Precise(self.0.sqrt())
    }
    fn sin(self) -> Self {
        Precise(self.0.sin_cos().0)
    }
    fn cos(self) -> Self {
        Precise(self.0.sin_cos().1)
    }
    fn atan2(self, x: Self) -> Self {
        Precise(self.0.atan2(x.0))
    }
    fn max(self, other: Self) -> Self {
        Precise(Real::max(self.0, other.0))
    }
    fn min(self, other: Self) -> Self {
        Precise(Real::min(self.0, other.0))
    }
}
