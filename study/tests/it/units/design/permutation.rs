use bryant_study::design::permutation::Permutation;

#[test]
fn every_place_is_taken_once() {
    for length in (1..200).chain([1 << 10, (1 << 10) + 1, 4097, 10_000]) {
        let permutation = Permutation::new(length, 7, 3);
        let mut seen = vec![false; length as usize];
        for index in 0..length {
            let place = permutation.of(index) as usize;
            assert!(!seen[place], "{place} of {length} comes twice");
            seen[place] = true;
        }
    }
}

#[test]
fn places_of_neighbours_are_uncorrelated() {
    // the correlation of n pairs has the standard deviation 1/√n
    let n = 10_000u64;
    for stream in 0..4 {
        let permutation = Permutation::new(n, 1, stream);
        let centred = |index: u64| permutation.of(index % n) as f64 / n as f64 - 0.5;
        for shift in [1, 2, 100] {
            let sum: f64 = (0..n).map(|i| centred(i) * centred(i + shift)).sum();
            let correlation = 12.0 * sum / n as f64;
            assert!(
                correlation.abs() < 5.0 / (n as f64).sqrt(),
                "shift {shift}: {correlation}"
            );
        }
    }
}
