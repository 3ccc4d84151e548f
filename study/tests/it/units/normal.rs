use bryant_study::normal::{between, quantile, truncated};

#[test]
fn quantiles_have_all_digits() {
    // roots of log(Φ(z)/p) with 20 digits by mpmath 1.3; p is the double closest to the written number
    let table = [
        (1e-300, -37.047_096_299_361_2),
        (1e-20, -9.262_340_089_798_408),
        (1e-5, -4.264_890_793_922_825),
        (0.01, -2.326_347_874_040_841),
        (0.02425, -1.972_961_051_311_885),
        (0.3, -0.524_400_512_708_041),
        (0.425, -0.189_118_426_272_792_5),
        (0.5, 0.0),
        (0.92, 1.405_071_560_309_632_8),
        (0.999_999, 4.753_424_308_817_088),
    ];
    for (p, z) in table {
        // p close to 1 is rounded itself: the table is for the rounded number, so this adds no error
        let error = (quantile(p) - z).abs();
        assert!(
            error <= 1e-15 * z.abs(),
            "p {p}: {} is not {z}",
            quantile(p)
        );
    }
}

#[test]
fn truncated_values_stay_between_their_ends_in_far_tails() {
    for (low, high) in [(-1.0, 0.5), (8.0, 9.0), (-9.0, -8.0), (-1.0, f64::INFINITY)] {
        let mut last = low;
        for k in 0..1000 {
            let u = (f64::from(k) + 0.5) / 1000.0;
            let z = truncated(u, low, high);
            assert!(z >= last && z <= high, "{low} to {high}: {z}");
            let share = between(low, z) / between(low, high);
            // 1 − share in a tail has the relative error ε·z²
            assert!(
                (share - u).abs() < 1e-12,
                "{low} to {high}: {share} is not {u}"
            );
            last = z;
        }
    }
}
