use bryant_generator::dynamics::augmented_body::smallest_eigenvalue;

#[test]
fn smallest_eigenvalue_of_a_known_matrix() {
    // Eigenvalues 1, 2, 4: R diag Rᵀ with R = (1/3)[[2,-2,1],[1,2,2],[2,1,-2]].
    let r = [[2.0, -2.0, 1.0], [1.0, 2.0, 2.0], [2.0, 1.0, -2.0]];
    let d = [4.0, 1.0, 2.0];
    let mut a = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            a[i][j] = (0..3).map(|k| r[i][k] * d[k] * r[j][k] / 9.0).sum();
        }
    }
    assert!((smallest_eigenvalue(a) - 1.0).abs() <= 16.0 * f64::EPSILON);
    assert_eq!(
        smallest_eigenvalue([[3.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 5.0]]),
        2.0
    );
}
