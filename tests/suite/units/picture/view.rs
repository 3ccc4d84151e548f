use bryant::picture::View;
use bryant::pose::dot;

#[test]
fn axes_are_right_handed_with_the_direction_to_the_eye() {
    let eyes = [
        [0.0, -1.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        // 20° above the horizon, 30° from the right to the front
        [
            20f64.to_radians().cos() * 0.5,
            -20f64.to_radians().cos() * 30f64.to_radians().cos(),
            20f64.to_radians().sin(),
        ],
    ];
    for (view, eye) in View::ALL.into_iter().zip(eyes) {
        let [a, b] = view.axes();
        assert!(dot(a, b).abs() < 1e-15);
        let cross = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        for (found, expected) in cross.iter().zip(eye) {
            assert!((found - expected).abs() < 1e-15, "{view:?}: {cross:?}");
        }
        assert_eq!(View::named(view.name()), Some(view));
    }
}
