//! Coefficients of explicit Runge–Kutta methods. Tests check them by the order conditions of rooted trees
//! (`order.rs`).
//!
//! | file | methods |
//! |---|---|
//! | [`kutta`] | the historical ones: Heun, Runge–Kutta 4, Merson |
//! | [`dormand_prince`] | Dormand & Prince's pairs 5(4) and 8(5,3) |
//! | [`tsitouras`] | Tsitouras's pair 5(4) |

pub(crate) mod dormand_prince;
pub(crate) mod kutta;
pub(crate) mod tsitouras;

use crate::Real;

/// A method: nodes, coefficients, weights, error estimate, interpolant.
pub(crate) trait Tableau {
    /// Number of stages of a step, including the first.
    const STAGES: usize;
    /// Number of stages of a step plus those that only its interpolant needs.
    const ALL: usize;
    /// Nodes of all stages.
    const C: &'static [f64];
    /// Row i: a_ij for j < i.
    const A: &'static [&'static [f64]];
    /// Weights of the result.
    const B: &'static [f64];
    /// Weights of the error estimate, and optionally of a second estimate to compare with: see
    /// [`Explicit::estimate`](super::explicit::Explicit).
    const E: [&'static [f64]; 2];
    /// Whether the last stage is the derivative at the end, and so the first stage of the next step.
    const LAST_IS_FIRST: bool;
    /// The error estimate falls like this power of the step; 0 where there is none.
    const ESTIMATE: u32;
    /// Order of the interpolant: between the ends its error falls like this power of the step plus one.
    #[cfg(test)]
    const INTERPOLANT: u32;
    /// `[S; ALL]`
    type Stages<S: Copy>: AsRef<[S]> + AsMut<[S]>;

    /// The same value in every stage.
    fn splat<S: Copy>(value: S) -> Self::Stages<S>;
    /// Weights b(θ) of the interpolant: y(t + θh) = y + h Σ b_i(θ) k_i over all stages, for θ in 0..=1.
    fn weights<T: Real>(theta: T) -> Self::Stages<T>;
    /// Whether the interpolant uses a stage; otherwise its b_i(θ) is 0.
    #[inline(always)]
    fn counts(_stage: usize) -> bool {
        true
    }
}

/// Hermite's cubic through both ends, as weights of (Σ b k, the first rate, the last rate).
#[inline(always)]
pub(crate) fn hermite<T: Real>(theta: T) -> [T; 3] {
    let c = T::from_f64;
    let rest = c(1.0) - theta;
    [
        theta * theta * (c(3.0) - c(2.0) * theta),
        theta * rest * rest,
        -theta * theta * rest,
    ]
}
