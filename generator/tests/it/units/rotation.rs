use bryant_generator::rotation::{
    IDENTITY, Matrix, Vector, apply, bryant_angles, cross, dot, of_roll_pitch_yaw, principal,
    product, transpose, turned,
};
use proptest::prelude::*;

fn bryant([a, b, c]: Vector) -> Matrix {
    let [(sa, ca), (sb, cb), (sc, cc)] = [a, b, c].map(libm::sincos);
    let x = [[1.0, 0.0, 0.0], [0.0, ca, -sa], [0.0, sa, ca]];
    let y = [[cb, 0.0, sb], [0.0, 1.0, 0.0], [-sb, 0.0, cb]];
    let z = [[cc, -sc, 0.0], [sc, cc, 0.0], [0.0, 0.0, 1.0]];
    product(&product(&x, &y), &z)
}

fn far(a: &Matrix, b: &Matrix) -> f64 {
    let differences = a.iter().flatten().zip(b.iter().flatten());
    differences.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

proptest! {
    #[test]
    fn angles_give_their_rotation(angles in prop::array::uniform3(-7.0..7.0_f64)) {
        let rotation = bryant(angles);
        prop_assert!(far(&bryant(bryant_angles(&rotation)), &rotation) < 1e-14);
    }

    #[test]
    fn a_tensor_is_its_principal_values_in_their_axes(
        angles in prop::array::uniform3(-3.0..3.0_f64),
        moments in prop::array::uniform3(1e-6..10.0_f64),
    ) {
        let diagonal: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { moments[i] } else { 0.0 }));
        let tensor = turned(&bryant(angles), &diagonal);
        let (values, axes) = principal(&tensor);
        let again: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { values[i] } else { 0.0 }));
        prop_assert!(far(&turned(&axes, &again), &tensor) < 1e-13);
        prop_assert!(far(&product(&axes, &transpose(&axes)), &IDENTITY) < 1e-14);
        // a rotation, not a reflection
        prop_assert!(dot(cross(axes[0], axes[1]), axes[2]) > 0.0);
    }
}

#[test]
fn bryant_angles_at_a_right_angle_are_finite_and_right() {
    for middle in [-1.0, 1.0] {
        let rotation = bryant([0.4, middle * std::f64::consts::FRAC_PI_2, -0.9]);
        assert!(far(&bryant(bryant_angles(&rotation)), &rotation) < 1e-12);
    }
}

#[test]
fn right_angles_are_exact() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned = of_roll_pitch_yaw([quarter, 0.0, -2.0 * quarter]);
    assert_eq!(
        turned,
        [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]].map(|r| r.map(|c: f64| c))
    );
    // roll first, about fixed axes
    let z = apply(&of_roll_pitch_yaw([quarter, quarter, 0.0]), [0.0, 0.0, 1.0]);
    assert_eq!(z, [0.0, -1.0, 0.0]);
}
