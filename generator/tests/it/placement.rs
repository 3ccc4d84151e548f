//! Place and columns of joints in numbers.

use bryant_generator::model::Freedom;
use bryant_generator::model::placement::{columns, placed};
use bryant_generator::read_str;

use bryant_generator::rotation::{of_roll_pitch_yaw, product, transpose};

/// The freedoms of an element on a joint as written.
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
    let from = (of_roll_pitch_yaw([0.3, -0.8, 1.9]), [0.4, -0.2, 0.7]);
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
        // the error of a central difference is h²/6 times a third derivative, which is below 10 here, plus rounding
        // over h
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
