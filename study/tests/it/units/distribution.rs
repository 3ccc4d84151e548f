use bryant_study::distribution::Distribution;

/// Mean and variance of a distribution from its quantiles at the midpoints of n parts: the midpoint rule.
fn moments(of: &Distribution) -> [f64; 2] {
    let n = 200_000;
    let values = || (0..n).map(|k| of.quantile((f64::from(k) + 0.5) / f64::from(n)));
    let mean = values().sum::<f64>() / f64::from(n);
    let square = |x: f64| (x - mean) * (x - mean);
    [mean, values().map(square).sum::<f64>() / f64::from(n)]
}

fn assert_moments(of: Distribution, mean: f64, variance: f64) {
    let found = moments(&of);
    // the midpoint rule neglects the part of a Gaussian tail beyond u = 1/2n: less than 1e-3 of a variance
    assert!(
        (found[0] - mean).abs() < 1e-4 * (1.0 + mean.abs()),
        "{of:?}: mean {found:?}"
    );
    assert!(
        (found[1] - variance).abs() < 1e-3 * variance,
        "{of:?}: variance {found:?}"
    );
}

#[test]
fn means_and_variances_are_those_of_the_books() {
    let (a, b, c) = (0.5, 2.0, 1.0);
    assert_moments(
        Distribution::Uniform { from: a, to: b },
        1.25,
        1.5 * 1.5 / 12.0,
    );
    let variance = (a * a + b * b + c * c - a * b - a * c - b * c) / 18.0;
    assert_moments(
        Distribution::Triangular {
            from: a,
            mode: c,
            to: b,
        },
        (a + b + c) / 3.0,
        variance,
    );
    let (mean, deviation) = (0.3, 0.05);
    let normal = Distribution::Normal {
        mean,
        deviation,
        min: None,
        max: None,
    };
    assert_moments(normal, mean, deviation * deviation);
    let (median, s): (f64, f64) = (1.5, 0.3);
    let lognormal = Distribution::Lognormal {
        median,
        deviation: s,
        min: None,
        max: None,
    };
    let w = (s * s).exp();
    assert_moments(
        lognormal,
        median * w.sqrt(),
        median * median * w * (w - 1.0),
    );
    let discrete = Distribution::Discrete {
        values: vec![1.0, 3.0],
        weights: vec![0.25, 0.75],
    };
    assert_moments(discrete, 2.5, 0.75);
}

#[test]
fn a_half_normal_has_its_closed_moments() {
    // truncated at the mean: mean √(2/π), variance 1 − 2/π
    let half = Distribution::Normal {
        mean: 0.0,
        deviation: 1.0,
        min: Some(0.0),
        max: None,
    };
    let pi = std::f64::consts::PI;
    assert_moments(half, (2.0 / pi).sqrt(), 1.0 - 2.0 / pi);
}

#[test]
fn values_keep_to_their_support() {
    let all = [
        Distribution::Uniform { from: 0.1, to: 0.3 },
        Distribution::Triangular {
            from: 0.1,
            mode: 0.1,
            to: 0.3,
        },
        Distribution::Normal {
            mean: 0.2,
            deviation: 1.0,
            min: Some(0.1),
            max: Some(0.3),
        },
        Distribution::Lognormal {
            median: 5.0,
            deviation: 0.5,
            min: Some(0.1),
            max: Some(0.3),
        },
    ];
    for distribution in &all {
        let [low, high] = distribution.support();
        assert_eq!([low, high], [0.1, 0.3]);
        for u in [1e-17, 1e-9, 0.3, 0.5, 0.7, 1.0 - 1e-9, 1.0 - 1e-16] {
            let x = distribution.quantile(u);
            assert!((low..=high).contains(&x), "{distribution:?} at {u}: {x}");
        }
    }
}
