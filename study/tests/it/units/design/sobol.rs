use bryant_study::design::sobol::Sobol;

fn value(index: u64, dimension: usize) -> f64 {
    let sobol = Sobol::new(Sobol::DIMENSIONS).unwrap();
    f64::from(sobol.bits(index, dimension)) / Sobol::POINTS as f64
}

#[test]
fn points_are_those_of_scipy() {
    // scipy 1.17: qmc.Sobol(64, scramble=False, bits=32), dimensions 0, 1, 2, 7, 33, 63
    let dimensions = [0, 1, 2, 7, 33, 63];
    let table: [(u64, [f64; 6]); 7] = [
        (1, [0.5; 6]),
        (2, [0.75, 0.25, 0.25, 0.75, 0.75, 0.75]),
        (3, [0.25, 0.75, 0.75, 0.25, 0.25, 0.25]),
        (4, [0.375, 0.375, 0.625, 0.875, 0.875, 0.125]),
        (5, [0.875, 0.875, 0.125, 0.375, 0.375, 0.625]),
        (
            1234,
            [
                0.86474609375,
                0.41943359375,
                0.82666015625,
                0.52880859375,
                0.78173828125,
                0.76708984375,
            ],
        ),
        (
            1999,
            [
                0.07861328125,
                0.61181640625,
                0.13427734375,
                0.48486328125,
                0.75341796875,
                0.56689453125,
            ],
        ),
    ];
    for (index, expected) in table {
        assert_eq!(
            dimensions.map(|d| value(index, d)),
            expected,
            "point {index}"
        );
    }
    // qmc.Sobol(256, …).fast_forward(123456789): coordinates times 2³²
    let sobol = Sobol::new(256).unwrap();
    let far = [0, 1, 63, 255].map(|d| sobol.bits(123_456_789, d));
    assert_eq!(
        far,
        [4_191_448_864, 3_403_469_216, 1_087_637_792, 563_653_600]
    );
    assert!(Sobol::new(257).is_none());
}

#[test]
fn scrambled_points_have_one_in_each_elementary_interval() {
    // a (0, 2)-sequence: among 2^m points, each interval 2^-a × 2^-(m−a) of the first two dimensions has exactly one
    let (m, seed) = (8, 11);
    let sobol = Sobol::new(2).unwrap();
    for a in 0..=m {
        let mut seen = vec![0; 1 << m];
        for index in 0..1 << m {
            let cell = |dimension: usize, bits: u32| {
                (sobol.coordinate(seed, index, dimension) * f64::from(1 << bits)) as usize
            };
            seen[cell(0, a) << (m - a) | cell(1, m - a)] += 1;
        }
        assert!(seen.iter().all(|&count| count == 1), "2^-{a} in the first");
    }
}

#[test]
fn each_dimension_has_one_point_in_each_part() {
    let n = 512u64;
    let sobol = Sobol::new(Sobol::DIMENSIONS).unwrap();
    for dimension in 0..Sobol::DIMENSIONS {
        let mut seen = vec![false; n as usize];
        for index in 0..n {
            let u = sobol.coordinate(5, index, dimension);
            assert!(u > 0.0 && u < 1.0);
            seen[(u * n as f64) as usize] = true;
        }
        assert!(seen.iter().all(|&s| s), "dimension {dimension}");
    }
}

#[test]
fn one_scrambled_point_is_uniform_over_the_seeds() {
    // the mean of n uniform numbers is ½ with the standard deviation 1/√(12 n)
    let sobol = Sobol::new(3).unwrap();
    let n = 4096;
    for index in [0, 1, 1000] {
        let sum: f64 = (0..n).map(|seed| sobol.coordinate(seed, index, 2)).sum();
        let mean = sum / n as f64;
        assert!(
            (mean - 0.5).abs() < 5.0 / (12.0 * n as f64).sqrt(),
            "point {index}: {mean}"
        );
    }
}
