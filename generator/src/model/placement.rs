//! The position of an element for given coordinates of its joint, and its motion per velocity, in plain numbers: for
//! checks of a model and for pictures.
//!
//! d ← d + R a h θ, R ← R (1 + sin θ â + (1 − cos θ) â â), H = (h e + e × (p_end − p), e) (hinge: h = 0; slider: no
//! turn, h = 1)
//!
//! `twist` gives the same for the equations, as expressions.

use super::joint::Freedom;
use super::number::Number;
use crate::rotation::{IDENTITY, Matrix, Vector, apply, product};

/// A column of H: the velocity of the origin, then the angular velocity.
#[doc(hidden)]
pub type Column = [f64; 6];

/// Rotation and origin of an element whose freedoms have the coordinates `q` \[rad, m\], given those of its joint on
/// the carrier. The parameters are in SI, in the order of the model.
pub fn placed(
    (mut turned, mut origin): (Matrix, Vector),
    freedoms: &[Freedom],
    q: &[f64],
    parameters: &[f64],
) -> (Matrix, Vector) {
    for (freedom, q) in freedoms.iter().zip(q) {
        let axis = values(&freedom.axis, parameters);
        let position = q + freedom.zero.value(parameters);
        if let Some(advance) = freedom.kind.advance() {
            let slide = advance.value(parameters) * position;
            origin = sum(origin, apply(&turned, axis.map(|a| a * slide)));
        }
        if freedom.kind.turns() {
            let across = cross(axis);
            let twice = times(&product(&across, &across), 1.0 - libm::cos(position));
            let turn = plus(
                &plus(&IDENTITY, &times(&across, libm::sin(position))),
                &twice,
            );
            turned = product(&turned, &turn);
        }
    }
    (turned, origin)
}

/// The columns H of the freedoms at the origin `end` of their element; `from` and `q` are as in [`placed`].
#[doc(hidden)]
pub fn columns(
    from: (Matrix, Vector),
    freedoms: &[Freedom],
    q: &[f64],
    end: Vector,
    parameters: &[f64],
) -> Vec<Column> {
    let mut columns = Vec::new();
    for (j, freedom) in freedoms.iter().enumerate() {
        let (turned, _) = placed(from, &freedoms[..j], q, parameters);
        let (_, center) = placed(from, &freedoms[..=j], q, parameters);
        let e = apply(&turned, values(&freedom.axis, parameters));
        let arm = sum(end, center.map(|c| -c));
        let (mut slide, mut axis) = ([0.0; 3], [0.0; 3]);
        if freedom.kind.turns() {
            (slide, axis) = (apply(&cross(e), arm), e);
        }
        if let Some(advance) = freedom.kind.advance() {
            let advance = advance.value(parameters);
            slide = sum(slide, e.map(|e| advance * e));
        }
        columns.push([slide[0], slide[1], slide[2], axis[0], axis[1], axis[2]]);
    }
    columns
}

pub(crate) fn values(numbers: &[Number; 3], parameters: &[f64]) -> Vector {
    [0, 1, 2].map(|i| numbers[i].value(parameters))
}

pub(crate) fn plus(a: &Matrix, b: &Matrix) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a[i][j] + b[i][j]))
}

pub(crate) fn times(a: &Matrix, factor: f64) -> Matrix {
    a.map(|row| row.map(|entry| factor * entry))
}

/// The matrix of the cross product v × ….
pub(crate) fn cross(v: Vector) -> Matrix {
    [[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]]
}

pub(crate) fn sum(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + b[i])
}
