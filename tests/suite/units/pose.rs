use bryant::pose::{Frame, Vec3, bryant_rotation, quaternion, rotation};

#[test]
fn a_quaternion_is_the_rotation_it_is_made_of() {
    for a in [-3.0, -1.6, -0.4, 0.0, 0.9, 2.8] {
        for b in [-1.5, 0.0, 0.7, 1.5] {
            for c in [-3.1, 0.0, 1.2, 3.0] {
                let rows = bryant_rotation([a, b, c]);
                let back = rotation(&quaternion(rows));
                for (x, y) in rows.iter().flatten().zip(back.iter().flatten()) {
                    // a dozen products of numbers up to 1
                    assert!((x - y).abs() <= 32.0 * f64::EPSILON, "{rows:?} {back:?}");
                }
            }
        }
    }
}

#[test]
fn one_angle_turns_x_downwards() {
    // x = cos φ, z = −sin φ: the convention of the plane.
    let (sine, cosine) = 0.3f64.sin_cos();
    let turned = Frame {
        rotation: rotation(&[0.3]),
        origin: [1.0, 0.0, 2.0],
    }
    .point([1.0, 0.0, 0.0]);
    for (a, b) in turned.iter().zip([1.0 + cosine, 0.0, 2.0 - sine]) {
        assert!((a - b).abs() < 1e-15, "{turned:?}");
    }
}

#[test]
fn quaternion_and_bryant_angles_agree() {
    // The quaternion of Rx(φ₁) Ry(φ₂) Rz(φ₃) is the product of the quaternions of the three rotations.
    let angles: Vec3 = [0.4, -0.7, 1.1];
    let half = angles.map(|a| (a / 2.0).sin_cos());
    let product = |a: [f64; 4], b: [f64; 4]| {
        [
            a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
        ]
    };
    let turns = [
        [half[0].1, half[0].0, 0.0, 0.0],
        [half[1].1, 0.0, half[1].0, 0.0],
        [half[2].1, 0.0, 0.0, half[2].0],
    ];
    let quaternion = product(product(turns[0], turns[1]), turns[2]);
    let (a, b) = (rotation(&quaternion), bryant_rotation(angles));
    for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
        assert!((a - b).abs() < 8.0 * f64::EPSILON);
    }
}
