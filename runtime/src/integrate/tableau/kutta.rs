//! The historical methods: modified Euler (Heun 1900), the classical one of order 4 (Kutta 1901), Merson's (1957).
//!
//! They were published without interpolants. Heun's method gets Hermite's cubic through the states and derivatives at
//! both ends. The methods of order 4 get a quartic p (after Shampine, SIAM J. Numer. Anal. 22, 1985). The error of the
//! cubic H is O(h⁴) inside the step. H gives a state at θ* = (1 − 1/√3)/2, and p has at θ* the derivative of the model
//! in that state:
//!
//! p(θ) = H(θ) + θ²(1−θ)² (h f(H(θ*)) − H′(θ*)) / (2θ*(1−θ*)(1−2θ*)).
//!
//! The error of f in that state is O(h⁴), so that of h f, and that of p, is O(h⁵). The denominator is largest at this
//! θ*.

use super::{Tableau, hermite};
use crate::Real;

/// Modified Euler:
///
/// ```text
///  0 |
///  1 |  1
/// ---+-----------
///    | 1/2  1/2      2nd
///    |  1    0       1st
/// ```
pub(crate) struct Heun;

impl Tableau for Heun {
    const STAGES: usize = 2;
    const ALL: usize = 3;
    const C: &'static [f64] = &[0.0, 1.0, 1.0];
    const A: &'static [&'static [f64]] = &[&[], &[1.0], &[0.5, 0.5]];
    const B: &'static [f64] = &[0.5, 0.5];
    const E: [&'static [f64]; 2] = [&[-0.5, 0.5], &[]];
    const LAST_IS_FIRST: bool = false;
    const ESTIMATE: u32 = 2;
    #[cfg(test)]
    const INTERPOLANT: u32 = 2;
    type Stages<S: Copy> = [S; 3];

    fn splat<S: Copy>(value: S) -> [S; 3] {
        [value; 3]
    }

    #[inline(always)]
    fn weights<T: Real>(theta: T) -> [T; 3] {
        let [step, first, last] = hermite(theta);
        let half = T::from_f64(0.5) * step;
        [half + first, half, last]
    }
}

/// The classical method of order 4:
///
/// ```text
///   0  |
///  1/2 | 1/2
///  1/2 |  0   1/2
///   1  |  0    0    1
/// -----+--------------------
///      | 1/6  1/3  1/3  1/6
/// ```
pub(crate) struct Rk4;

impl Tableau for Rk4 {
    const STAGES: usize = 4;
    const ALL: usize = 6;
    const C: &'static [f64] = &[0.0, 0.5, 0.5, 1.0, 1.0, INSIDE];
    const A: &'static [&'static [f64]] = &[
        &[],
        &[0.5],
        &[0.0, 0.5],
        &[0.0, 0.0, 1.0],
        Self::B,
        &inside::<5>(Self::B),
    ];
    const B: &'static [f64] = &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];
    const E: [&'static [f64]; 2] = [&[], &[]];
    const LAST_IS_FIRST: bool = false;
    const ESTIMATE: u32 = 0;
    #[cfg(test)]
    const INTERPOLANT: u32 = 4;
    type Stages<S: Copy> = [S; 6];

    fn splat<S: Copy>(value: S) -> [S; 6] {
        [value; 6]
    }

    #[inline(always)]
    fn weights<T: Real>(theta: T) -> [T; 6] {
        quartic(theta, Self::B)
    }
}

/// Merson's method of order 4. Its estimate is of order 5 where the model is linear with constant coefficients:
///
/// ```text
///   0  |
///  1/3 | 1/3
///  1/3 | 1/6  1/6
///  1/2 | 1/8   0    3/8
///   1  | 1/2   0   −3/2   2
/// -----+---------------------------
///      | 1/6   0     0   2/3   1/6      4th
///      | 1/2   0   −3/2   2     0       3rd
/// ```
///
/// The estimate is a fifth of the difference of both.
pub(crate) struct Merson;

impl Tableau for Merson {
    const STAGES: usize = 5;
    const ALL: usize = 7;
    const C: &'static [f64] = &[0.0, 1.0 / 3.0, 1.0 / 3.0, 0.5, 1.0, 1.0, INSIDE];
    const A: &'static [&'static [f64]] = &[
        &[],
        &[1.0 / 3.0],
        &[1.0 / 6.0, 1.0 / 6.0],
        &[0.125, 0.0, 0.375],
        &[0.5, 0.0, -1.5, 2.0],
        Self::B,
        &inside::<6>(Self::B),
    ];
    const B: &'static [f64] = &[1.0 / 6.0, 0.0, 0.0, 2.0 / 3.0, 1.0 / 6.0];
    const E: [&'static [f64]; 2] = [&[-1.0 / 15.0, 0.0, 0.3, -4.0 / 15.0, 1.0 / 30.0], &[]];
    const LAST_IS_FIRST: bool = false;
    const ESTIMATE: u32 = 4;
    #[cfg(test)]
    const INTERPOLANT: u32 = 4;
    type Stages<S: Copy> = [S; 7];

    fn splat<S: Copy>(value: S) -> [S; 7] {
        [value; 7]
    }

    #[inline(always)]
    fn weights<T: Real>(theta: T) -> [T; 7] {
        quartic(theta, Self::B)
    }
}

/// θ* = (1 − 1/√3)/2.
const INSIDE: f64 = 0.211_324_865_405_187_13;

/// Weights of H(θ*), over the stages of the step and the derivative at its end.
const fn inside<const STAGES: usize>(b: &[f64]) -> [f64; STAGES] {
    let (theta, rest) = (INSIDE, 1.0 - INSIDE);
    let mut weights = [0.0; STAGES];
    let mut i = 0;
    while i < b.len() {
        weights[i] = theta * theta * (3.0 - 2.0 * theta) * b[i];
        i += 1;
    }
    weights[0] += theta * rest * rest;
    weights[b.len()] = -theta * theta * rest;
    weights
}

/// Weights of p(θ): over the stages of the step, the derivative at its end, and that at θ*.
#[inline(always)]
fn quartic<T: Real, const ALL: usize>(theta: T, b: &[f64]) -> [T; ALL] {
    let c = T::from_f64;
    let (end, middle) = (ALL - 2, ALL - 1);
    let rest = c(1.0) - theta;
    let (inner, outer) = (INSIDE, 1.0 - INSIDE);
    let lift = (theta * rest) * (theta * rest) / c(2.0 * inner * outer * (1.0 - 2.0 * inner));
    // the weight of H(θ), less what H′(θ*) subtracts
    let [step, first, last] = hermite(theta);
    let [step, first, last] = [
        step - lift * c(6.0 * inner * outer),
        first - lift * c(outer * (1.0 - 3.0 * inner)),
        last - lift * c(inner * (3.0 * inner - 2.0)),
    ];
    let mut weights = [c(0.0); ALL];
    for (weight, b) in weights.iter_mut().zip(b) {
        *weight = step * c(*b);
    }
    weights[0] += first;
    weights[end] = last;
    weights[middle] = lift;
    weights
}
