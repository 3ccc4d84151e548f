//! Explicit Runge–Kutta methods for ẏ = f(t, y):  k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),  y⁺ = y + h Σ b_i k_i.
//!
//! Fixed sizes, no allocation, generic over scalar and model. Time and step are `f64`, shared by all lanes; where lanes
//! differ in what they need, the most demanding one decides.
//!
//! | file | what |
//! |---|---|
//! | [`tableau`] | the coefficients |
//! | [`fixed`] | one step of the classical method of order 4 |
//! | [`embedded`] | one step of the pair 5(4), its error, its interpolant |
//! | [`control`] | tolerances, first step, next step |

pub mod control;
pub mod embedded;
pub mod fixed;
pub mod tableau;

use crate::{Model, Real, Vector};

/// Evaluates f for a step that must not look beyond its end, and counts.
pub(crate) struct Evaluator<'a, M> {
    model: &'a M,
    /// Number of evaluations so far.
    pub count: u64,
    /// Latest time that f is evaluated at.
    ///
    /// A step that ends on a kink of a curve sees the curve as it is before the kink: the time of its last stages is the
    /// floating-point number just before.
    pub latest: f64,
}

impl<'a, M> Evaluator<'a, M> {
    pub fn new(model: &'a M) -> Self {
        Evaluator {
            model,
            count: 0,
            latest: f64::INFINITY,
        }
    }

    #[inline(always)]
    pub fn at<T: Real>(&mut self, t: f64, y: &M::State) -> M::State
    where
        M: Model<T>,
    {
        self.count += 1;
        self.model.derivative(T::from_f64(t.min(self.latest)), y)
    }
}

/// A stage of a step at which something is not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NotFinite<S> {
    /// Time of the stage.
    pub t: f64,
    /// State at which the stage was evaluated.
    pub y: S,
    /// Index of the first entry that is not finite.
    pub index: usize,
    /// Of the derivative there, or of the state itself.
    pub in_derivative: bool,
}

/// y + h Σ a_j k_j.
#[inline(always)]
pub(crate) fn combine<T: Real, S: Vector<T>, const STAGES: usize>(
    y: &S,
    h: f64,
    a: [f64; STAGES],
    k: [&S; STAGES],
) -> S {
    let weights = a.map(|a| T::from_f64(h * a));
    let mut sum = *y;
    for i in 0..S::LEN {
        for (weight, k) in weights.iter().zip(k) {
            sum[i] = weight.mul_add(k[i], sum[i]);
        }
    }
    sum
}

/// Index of the first entry that is not finite.
#[inline(always)]
pub(crate) fn first_non_finite<T: Real, S: Vector<T>>(y: &S) -> Option<usize> {
    (0..S::LEN).find(|&i| !y[i].is_finite())
}
