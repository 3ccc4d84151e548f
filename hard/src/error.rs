//! Errors of accelerations v̇: the backward error η, which is the smallest relative change of S and r for which v̇ is
//! exact; and the forward error.
//!
//! η = ‖S v̇ − r‖∞ / (‖S‖∞ ‖v̇‖∞ + ‖r‖∞)   \[Rigal & Gaches 1967; Higham 2002, theorem 7.1\]
//!
//! η is computed for S itself, and for S scaled to a unit diagonal, D⁻¹ S D⁻¹ with D = √diag S. In the first, masses of
//! a ton hide all errors of masses of a gram; in the second, nothing is hidden, and units do not matter.

use crate::balance::{Posture, Tree};
use crate::symmetric_matrix::Factors;
use bryant_runtime::{DoubleDouble, Real};

/// Backward errors of accelerations at a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backward {
    /// η of S itself.
    pub plain: f64,
    /// η of the scaled S.
    pub scaled: f64,
}

/// Forward error of accelerations at a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forward {
    /// ‖D (v̇ − exact)‖∞ / ‖D exact‖∞
    pub scaled: f64,
    /// κ∞ of D⁻¹ S D⁻¹
    pub condition: f64,
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    // NaN is kept, too
    values.fold(0.0, |most, value| {
        if value.abs() <= most {
            most
        } else {
            value.abs()
        }
    })
}

/// A tree at a state, with its velocities and accelerations. Rates of Bryant angles are converted to angular
/// velocities, for which the equations are solved; the accelerations of angles follow from them by φ̈ = W⁻¹ (α − ε).
fn state<'t, S: Real>(tree: &'t Tree, numbers: [&[f64]; 3]) -> (Posture<'t, S>, Vec<S>, Vec<S>) {
    let [q, mut v, mut rates] = numbers
        .map(|numbers| -> Vec<S> { numbers.iter().map(|&value| S::from_f64(value)).collect() });
    let mut posture = tree.posture(&q);
    posture.in_angular_velocities(&mut v, &mut rates);
    (posture, v, rates)
}

/// The backward errors of v̇, with the residual computed in double-double.
pub fn backward(tree: &Tree, q: &[f64], v: &[f64], rates: &[f64]) -> Backward {
    let (posture, exact_v, exact_rates) = state::<DoubleDouble>(tree, [q, v, rates]);
    let residual = posture.residual(&exact_v, &exact_rates);
    let residual: Vec<f64> = residual.into_iter().map(Real::to_f64).collect();
    let (posture, v, rates) = state::<f64>(tree, [q, v, rates]);
    let forces = posture.residual(&v, &vec![0.0; rates.len()]);
    let matrix = posture.matrix();
    let scale: Vec<f64> = (matrix.iter().enumerate())
        .map(|(i, row)| row[i].sqrt())
        .collect();
    let of = |scale: &dyn Fn(usize) -> f64| {
        let norm = largest(matrix.iter().enumerate().map(|(i, row)| {
            let entries = row.iter().enumerate();
            entries.map(|(j, s)| s.abs() / (scale(i) * scale(j))).sum()
        }));
        let scaled = |(i, value): (usize, &f64)| value / scale(i);
        let rate = largest(rates.iter().enumerate().map(|(i, rate)| rate * scale(i)));
        let force = largest(forces.iter().enumerate().map(scaled));
        let rest = largest(residual.iter().enumerate().map(scaled));
        if rest == 0.0 {
            0.0
        } else {
            rest / (norm * rate + force)
        }
    };
    Backward {
        plain: of(&|_| 1.0),
        scaled: of(&|i| scale[i]),
    }
}

/// The forward error of v̇ against the solution of the same equations in double-double; `None` if S is not positive
/// definite at this state.
pub fn forward(tree: &Tree, q: &[f64], v: &[f64], rates: &[f64]) -> Option<Forward> {
    let (posture, v, rates) = state::<DoubleDouble>(tree, [q, v, rates]);
    let factors = Factors::of(&posture.matrix())?;
    let error = factors.solve(&posture.residual(&v, &rates));
    let scaled = |values: &[DoubleDouble]| {
        let pairs = values.iter().zip(factors.scale());
        largest(pairs.map(|(value, scale)| value.to_f64() * scale))
    };
    let exact: Vec<DoubleDouble> = rates.iter().zip(&error).map(|(a, e)| *a - *e).collect();
    let (error, size) = (scaled(&error), scaled(&exact));
    Some(Forward {
        scaled: if error == 0.0 { 0.0 } else { error / size },
        condition: factors.condition(),
    })
}

/// The smallest pivot of S scaled to a unit diagonal, at a position: a measure of the distance from singularity. 0 if S
/// is not positive definite in double-double.
pub fn smallest_pivot(tree: &Tree, q: &[f64]) -> f64 {
    let q: Vec<DoubleDouble> = q.iter().map(|&value| Real::from_f64(value)).collect();
    Factors::of(&tree.posture(&q).matrix()).map_or(0.0, |factors| factors.smallest_pivot())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{ChainKind, Setting, general, random_state, scene};
    use crate::evaluate::Accelerations;
    use crate::random::Random;

    /// An acceleration with the error δ has the residual S δ: the measured error is δ, and no more.
    #[test]
    fn a_disturbance_is_found_at_its_size() {
        for kind in ChainKind::ALL {
            let mut random = Random::new(3);
            let links: Vec<_> = (0..4).map(|_| general(&mut random, 2.0)).collect();
            let setting = Setting {
                kind,
                free: true,
                loaded: true,
            };
            let model = scene(setting, &links).model().expect("a model");
            let tree = Tree::of(&model).expect("a tree");
            let (q, v) = random_state(&mut random, &model);
            let mut rates = Accelerations::<f64>::by_elimination(&model).at(&q, &v);
            let largest = rates.iter().fold(0.0f64, |m, a| m.max(a.abs()));
            let at = rates.iter().position(|a| a.abs() == largest).unwrap_or(0);
            rates[at] *= 1.0 + 1e-9;
            let (back, fore) = (
                backward(&tree, &q, &v, &rates),
                forward(&tree, &q, &v, &rates).expect("positive definite"),
            );
            for error in [back.plain, back.scaled] {
                assert!((1e-12..=1e-9).contains(&error), "{kind:?}: {back:?}");
            }
            assert!((1e-10..=1e-8).contains(&fore.scaled), "{kind:?}: {fore:?}");
            assert!(fore.scaled <= 2.0 * back.scaled * fore.condition);
        }
    }
}
