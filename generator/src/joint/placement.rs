//! The position of an element for given coordinates of its joint, and how the velocities move it, in plain numbers: for proofs about a model and
//! for pictures.
//!
//! d ← d + R a h θ,   R ← R (1 + sin θ â + (1 − cos θ) â â),   H = (h e + e × (p_end − p), e)     (hinge: h = 0; slider: no turn, h = 1)
//!
//! `twist` gives the same for the equations, as expressions.

use super::Freedom;
use crate::model::resolve::kinematics::{cross, plus, sum, times, values};
use crate::rotation::{IDENTITY, Matrix, Vector, apply, product};

/// A column of H: the velocity of the origin, then the angular velocity.
pub(crate) type Column = [f64; 6];

/// Rotation and origin of an element whose degrees of freedom have the coordinates `q` \[rad, m\], given those of its joint on the carrier. The
/// parameters are in SI, in the order of the model.
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

/// The columns H of the degrees of freedom at the origin `end` of their element; `from` and `q` are as in [`placed`].
pub(crate) fn columns(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::read_str;
    use crate::rotation::transpose;

    /// The degrees of freedom of an element on a joint as written.
    fn freedoms(joint: &str) -> Vec<Freedom> {
        let text = format!(
            "model: one\ndimension: 3\nsystems:\n  - name: s\n    reference: fixed\n    elements:\n      \
             - {{ name: body, joint: {joint}, mass: 1, cg: [0.1, 0.2, 0.3], inertia: [1, 1.1, 1.2] }}\n"
        );
        let no_files = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
        let (model, _) = read_str("one.yaml", &text, &no_files).unwrap();
        model.systems[0].elements[0].joint.freedoms().to_vec()
    }

    #[test]
    fn columns_are_the_rates_of_the_place() {
        let from = (
            crate::rotation::of_roll_pitch_yaw([0.3, -0.8, 1.9]),
            [0.4, -0.2, 0.7],
        );
        for joint in [
            "{ hinge: [1, -2, 0.5], zero: 0.4 }",
            "{ slider: [0.3, 1, -1], zero: -0.2 }",
            "{ screw: [1, 1, 0.2], pitch: 3, zero: 0.1 }",
            "{ universal: [x, [0, 1, 1]] }",
            "{ cylinder: y }",
            "{ planar: z }",
            "translation",
            "[{ screw: x, pitch: -2 }, { slider: [0, 1, 1] }, { hinge: z }, { slider: x }]",
        ] {
            let freedoms = freedoms(joint);
            let q: Vec<f64> = (0..freedoms.len()).map(|j| 0.9 - 0.6 * j as f64).collect();
            let (rotation, end) = placed(from, &freedoms, &q, &[]);
            let columns = columns(from, &freedoms, &q, end, &[]);
            // the error of a central difference is h²/6 times a third derivative, which is below 10 here, plus rounding over h
            let (h, tolerance) = (1e-5, 1e-9);
            for (j, column) in columns.iter().enumerate() {
                let at = |step: f64| {
                    let mut q = q.clone();
                    q[j] += step;
                    placed(from, &freedoms, &q, &[])
                };
                let ((r1, x1), (r0, x0)) = (at(h), at(-h));
                let rate = |a: f64, b: f64| (a - b) / (2.0 * h);
                // Ṙ Rᵀ is the matrix of the cross product e ×
                let turning = [0, 1, 2].map(|i| [0, 1, 2].map(|k| rate(r1[i][k], r0[i][k])));
                let spin = product(&turning, &transpose(&rotation));
                let found = [
                    rate(x1[0], x0[0]),
                    rate(x1[1], x0[1]),
                    rate(x1[2], x0[2]),
                    spin[2][1],
                    spin[0][2],
                    spin[1][0],
                ];
                for (found, column) in found.iter().zip(column) {
                    assert!(
                        (found - column).abs() < tolerance,
                        "{joint}, freedom {j}: {found} instead of {column}"
                    );
                }
            }
        }
    }
}
