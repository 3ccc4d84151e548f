use bryant_generator::model::resolve::kinematics::rotation;
use bryant_generator::model::resolve::regularity::eigen;
use bryant_generator::rotation::{apply, product, transpose};

#[test]
fn eigenvalues_of_a_rotated_diagonal_are_its_entries() {
    let r = rotation([0.4, -1.1, 2.0]);
    let diagonal = [[1.0, 0.0, 0.0], [0.0, 5.0, 0.0], [0.0, 0.0, 0.25]];
    let a = product(&product(&r, &diagonal), &transpose(&r));
    let (mut found, vectors) = eigen(&a);
    for (value, v) in found.iter().zip(vectors) {
        let av = apply(&a, v);
        for i in 0..3 {
            assert!((av[i] - value * v[i]).abs() < 1e-14);
        }
    }
    found.sort_by(f64::total_cmp);
    for (value, expected) in found.iter().zip([0.25, 1.0, 5.0]) {
        assert!((value - expected).abs() < 1e-14, "{found:?}");
    }
}
