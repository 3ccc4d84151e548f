use bryant_generator::rotation::{Matrix, Vector, dot, of_roll_pitch_yaw, turned};
use bryant_generator::urdf::inertia::{nearest, norm, wrong_tensor};
use proptest::prelude::*;

fn apart(a: &Matrix, b: &Matrix) -> f64 {
    norm(&std::array::from_fn(|i| {
        std::array::from_fn(|j| a[i][j] - b[i][j])
    }))
}

/// The tensor of points of mass: of a body by its definition.
fn of_points(points: &[Vector]) -> Matrix {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let entry = |p: &Vector| if i == j { dot(*p, *p) } else { 0.0 } - p[i] * p[j];
            points.iter().map(entry).sum()
        })
    })
}

proptest! {
    #[test]
    fn no_body_is_nearer_than_the_nearest(
        moments in prop::array::uniform3(-1.0..1.0_f64),
        angles in prop::array::uniform3(-3.0..3.0_f64),
        points in prop::collection::vec(prop::array::uniform3(-0.7..0.7_f64), 1..4),
    ) {
        let [a, b, c] = moments;
        let tensor = turned(&of_roll_pitch_yaw(angles), &[[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]]);
        let found = nearest(&tensor);
        prop_assert!(wrong_tensor(&found).is_none() || norm(&found) < 1e-15);
        let distance = apart(&tensor, &found);
        // the nearest point of a convex set: towards any other body, and between both, it is no nearer
        let body = of_points(&points);
        for share in [1.0, 0.1, 1e-3] {
            let between = std::array::from_fn(|i| std::array::from_fn(|j| found[i][j] + share * (body[i][j] - found[i][j])));
            prop_assert!(apart(&tensor, &between) >= distance - 1e-12);
        }
    }

    #[test]
    fn a_body_is_its_own_nearest(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..5)) {
        let body = of_points(&points);
        prop_assert!(wrong_tensor(&body).is_none());
        prop_assert!(apart(&nearest(&body), &body) < 1e-14 * norm(&body));
    }
}
