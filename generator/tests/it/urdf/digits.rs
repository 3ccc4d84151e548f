//! Tensors that are those of no body by their last digits.

use super::{Options, acceleration, between, imported, link, refused, robot};

#[test]
fn thin_rods_in_any_direction_are_bodies() {
    let mut seed = 7u64;
    let mut random = || {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    };
    let mut rods = 0;
    for case in 0..400 {
        // 6 is what C++ writes, 17 all digits
        let digits = 6 + case % 12;
        let n = [random(), random(), random()];
        let length = n.iter().map(|c| c * c).sum::<f64>().sqrt();
        let n = n.map(|c| c / length);
        let size = 10f64.powf(4.0 * random() - 4.0);
        // the tensor of a rod along n: m l² / 12 (1 − n nᵀ)
        let entry = |i: usize, j: usize| {
            let one = if i == j { 1.0 } else { 0.0 };
            format!("{:.*e}", digits - 1, size * (one - n[i] * n[j]))
        };
        let inertia = format!(
            "<inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>",
            entry(0, 0),
            entry(0, 1),
            entry(0, 2),
            entry(1, 1),
            entry(1, 2),
            entry(2, 2)
        );
        let origin = "<origin xyz=\"0.1 0 0.1\"/><mass value=\"0.5\"/>";
        let text = robot(&[
            link("base", ""),
            link("rod", &format!("<inertial>{origin}{inertia}</inertial>")),
            between("j", "continuous", "base", "rod", "<axis xyz=\"0 1 0\"/>"),
        ]);
        let found = acceleration(&imported(&text, &Options::default()).yaml);
        // J_yy + m (x² + z²), and m g x about y
        let expected = 0.5 * 9.81 * 0.1 / (size * (1.0 - n[1] * n[1]) + 0.5 * 0.02);
        // half a unit of the last digit in each of nine entries, and the nearest body is no further away than the rod
        let tolerance = 1e-13 + 2.0 * 9.0 * 0.5 * 10f64.powi(1 - digits as i32);
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{case}: {found} {expected}\n{text}"
        );
        rods += 1;
    }
    assert_eq!(rods, 400);
}

#[test]
fn a_tensor_that_is_wrong_by_more_than_its_digits_is_refused() {
    let flat = |izz: &str| {
        let inertia = format!(
            "<inertia ixx=\"0.0100\" ixy=\"0\" ixz=\"0\" iyy=\"0.0200\" iyz=\"0\" izz=\"{izz}\"/>"
        );
        robot(&[
            link("base", ""),
            link(
                "plate",
                &format!(
                    "<inertial><origin xyz=\"0.1 0 0\"/><mass value=\"2\"/>{inertia}</inertial>"
                ),
            ),
            between("j", "continuous", "base", "plate", "<axis xyz=\"0 1 0\"/>"),
        ])
    };
    // a plate has izz = ixx + iyy; 1e-4 of the tensor at most is taken for rounding, and said
    let found = imported(&flat("0.0300005"), &Options::default());
    assert!(
        found
            .notes
            .iter()
            .any(|n| n.contains("last digits") && n.contains("line 4")),
        "{:?}",
        found.notes
    );
    assert!(
        refused(&flat("0.0301"))
            .to_string()
            .contains("above the sum")
    );
}
