use bryant_study::hash::{GAMMA, mix, open_unit, uniform};

#[test]
fn one_stream_is_split_mix() {
    // the first outputs of SplitMix64 started at 0, from the reference implementation splitmix64.c of S. Vigna
    let published = [
        0xe220_a839_7b1d_cdaf,
        0x6e78_9e6a_a1b9_65f4,
        0x06c4_5d18_8009_454f,
    ];
    for (index, &expected) in published.iter().enumerate() {
        assert_eq!(mix((index as u64 + 1).wrapping_mul(GAMMA)), expected);
    }
}

#[test]
fn the_ends_of_the_unit_interval_are_left_out() {
    assert!(open_unit(0) > 0.0 && open_unit(u64::MAX) < 1.0);
}

#[test]
fn streams_are_uniform_and_uncorrelated() {
    // χ² of 64 bins has the mean 63 and the variance 126; the correlation of n pairs has the standard deviation 1/√n
    let n = 1 << 16;
    for (stream, other) in [(0, 1), (1, 2), (7, 1 << 40)] {
        let mut bins = [0u32; 64];
        let mut product = 0.0;
        for index in 0..n {
            let u = uniform(3, stream, index);
            bins[(u * 64.0) as usize] += 1;
            product += (u - 0.5) * (uniform(3, other, index) - 0.5);
        }
        let expected = n as f64 / 64.0;
        let square = |&count: &u32| (f64::from(count) - expected).powi(2) / expected;
        let chi: f64 = bins.iter().map(square).sum();
        assert!((chi - 63.0).abs() < 5.0 * 126f64.sqrt(), "χ² {chi}");
        let correlation = 12.0 * product / n as f64;
        assert!(correlation.abs() < 5.0 / (n as f64).sqrt(), "{correlation}");
    }
}
