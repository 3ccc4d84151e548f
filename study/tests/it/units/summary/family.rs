use bryant_study::distribution::Distribution;
use bryant_study::summary::family::{Family, HIGHEST, functions};

#[test]
fn polynomials_are_orthonormal() {
    // the midpoint rule over u; it neglects tails of Hermite polynomials beyond u = 1/2n
    let n = 1_000_000;
    for (family, tolerance) in [(Family::Legendre, 1e-9), (Family::Hermite, 2e-3)] {
        let mut products = [[0.0; 5]; 5];
        for k in 0..n {
            let values = family.evaluate((f64::from(k) + 0.5) / f64::from(n), 4);
            for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
                products[i][j] += values[i] * values[j] / f64::from(n);
            }
        }
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
            let expected = f64::from(u8::from(i == j));
            // higher degrees extend further into the tails
            let allowed = tolerance * 8f64.powi(i.max(j) as i32 - 1).max(1.0);
            assert!(
                (products[i][j] - expected).abs() < allowed,
                "{family:?} {i} {j}: {}",
                products[i][j]
            );
        }
    }
}

/// Values and weights, and the number of distinct levels.
fn cases() -> Vec<(Vec<f64>, Vec<f64>, usize)> {
    vec![
        (vec![1.0, 2.0, 3.0], vec![1.0 / 3.0; 3], 3),
        (vec![5.0, 0.0], vec![0.1, 0.9], 2),
        (vec![7.0], vec![1.0], 1),
        (vec![7.0, 7.0], vec![0.5, 0.5], 1),
        (vec![2.0, 1.0, 2.0, 4.0], vec![0.1, 0.2, 0.3, 0.4], 3),
        (vec![1.0, 2.0, 3.0], vec![0.5, 0.5, 0.0], 2),
        (vec![0.0, 1e9 - 1.0, 1e9, 1e9 + 1.0], vec![0.25; 4], 4),
        (vec![-1e308, 0.0, 1e308], vec![0.25, 0.5, 0.25], 3),
        (
            (-6..4).map(|k| 10f64.powi(k)).collect(),
            (0..10).map(|k| f64::from(2 * k + 1) / 100.0).collect(),
            10,
        ),
        (vec![1.0, 2.0, 3.0], vec![1.0 - 2e-9, 1e-9, 1e-9], 3),
        ((0..40).map(f64::from).collect(), vec![0.025; 40], 40),
        (vec![0.0, 5e-324], vec![0.5, 0.5], 2),
    ]
}

#[test]
fn functions_of_levels_are_orthonormal_under_their_weights() {
    for (values, weights, levels) in cases() {
        let found = functions(&values, &weights);
        let count = levels.min(HIGHEST + 1);
        assert!(found.iter().all(|f| f.len() == count), "{values:?}");
        for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
            let product: f64 = found
                .iter()
                .zip(&weights)
                .map(|(f, w)| w * f[i] * f[j])
                .sum();
            // sums of 40 terms of at most 1, made orthogonal twice to 12 others
            let allowed = 40.0 * 13.0 * f64::EPSILON;
            let expected = f64::from(u8::from(i == j));
            assert!(
                (product - expected).abs() < allowed,
                "{values:?} {i} {j}: {product}"
            );
        }
    }
}

#[test]
fn the_first_function_is_the_value_in_deviations() {
    let (values, weights) = ([2.0, 1.0, 5.0], [0.3, 0.5, 0.2]);
    let mean: f64 = values.iter().zip(weights).map(|(x, w)| w * x).sum();
    let square: f64 = values.iter().zip(weights).map(|(x, w)| w * x * x).sum();
    let deviation = (square - mean * mean).sqrt();
    for (x, f) in values.iter().zip(functions(&values, &weights)) {
        let expected = (x - mean) / deviation;
        assert!(
            (f[1] - expected).abs() < 1e-14,
            "{} is not {expected}",
            f[1]
        );
    }
}

#[test]
fn u_finds_the_level_of_its_value() {
    for (values, weights, _) in cases() {
        let distribution = Distribution::Discrete {
            values: values.clone(),
            weights: weights.clone(),
        };
        let family = Family::of(&distribution);
        let known = functions(&values, &weights);
        for k in 0..1000 {
            let u = (f64::from(k) + 0.5) / 1000.0;
            let value = distribution.quantile(u);
            let written = values.iter().position(|v| *v == value).unwrap();
            assert_eq!(family.evaluate(u, HIGHEST), known[written]);
        }
    }
}
