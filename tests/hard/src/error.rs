//! How wrong accelerations are: backward, as the smallest change of S and r whose exact solution they are, and forward.
//!
//! η = ‖S v̇ − r‖∞ / (‖S‖∞ ‖v̇‖∞ + ‖r‖∞)   \[Rigal & Gaches 1967; Higham 2002, theorem 7.1\]
//!
//! It is taken of S as it stands, and of S scaled to a diagonal of ones, D⁻¹ S D⁻¹ with D = √diag S: in the first, masses of a
//! ton hide whatever happens to those of a gram; in the second, nothing is hidden, and no change of units matters.

use crate::balance::Tree;
use crate::symmetric::Factors;
use bryant_runtime::{DoubleDouble, Real};

/// Backward errors of accelerations at a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backward {
    /// η
    pub plain: f64,
    /// η of the scaled system.
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

fn precise(values: &[f64]) -> Vec<DoubleDouble> {
    values.iter().map(|&value| Real::from_f64(value)).collect()
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    // a NaN stays
    values.fold(0.0, |most, value| if value.abs() <= most { most } else { value.abs() })
}

/// The backward errors of v̇, its residual taken in double-double.
pub fn backward(tree: &Tree, q: &[f64], v: &[f64], rates: &[f64]) -> Backward {
    let posture = tree.posture(&precise(q));
    let residual: Vec<f64> = posture
        .residual(&precise(v), &precise(rates))
        .into_iter()
        .map(Real::to_f64)
        .collect();
    let posture = tree.posture(q);
    let forces = posture.residual(v, &vec![0.0; rates.len()]);
    let matrix = posture.matrix();
    let scale: Vec<f64> = (matrix.iter().enumerate())
        .map(|(i, row)| row[i].sqrt())
        .collect();
    let of = |scale: &dyn Fn(usize) -> f64| {
        let norm = largest(matrix.iter().enumerate().map(|(i, row)| {
            let entries = row.iter().enumerate();
            entries.map(|(j, s)| s.abs() / (scale(i) * scale(j))).sum()
        }));
        let rate = largest(rates.iter().enumerate().map(|(i, rate)| rate * scale(i)));
        let force = largest(forces.iter().enumerate().map(|(i, force)| force / scale(i)));
        let rest = largest(residual.iter().enumerate().map(|(i, rest)| rest / scale(i)));
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

/// The forward error of v̇ against the solution of the same system in double-double; `None` where that finds the matrix not
/// positive definite.
pub fn forward(tree: &Tree, q: &[f64], v: &[f64], rates: &[f64]) -> Option<Forward> {
    let posture = tree.posture(&precise(q));
    let factors = Factors::of(&posture.matrix())?;
    let residual = posture.residual(&precise(v), &precise(rates));
    let error = factors.solve(&residual);
    let scale = factors.scale();
    let error_size = largest(error.iter().zip(scale).map(|(e, s)| e.to_f64() * s));
    let exact = rates.iter().zip(&error).map(|(rate, e)| rate - e.to_f64());
    let size = largest(exact.zip(scale).map(|(e, s)| e * s));
    Some(Forward {
        scaled: if error_size == 0.0 { 0.0 } else { error_size / size },
        condition: factors.condition(),
    })
}
