mod corridor;
mod plan;
mod plot;
mod sample;
mod view;
mod work_precision;

use bryant::picture::times;

#[test]
fn times_are_round_and_reach_the_end() {
    let between = |ends, count| -> Vec<i64> {
        let rounded = times(ends, count, 1e-3)
            .into_iter()
            .map(|t| (t * 1e3).round() as i64);
        rounded.collect()
    };
    let milliseconds = |last, count| between([0.0, last], count);
    assert_eq!(milliseconds(0.12, 7), [0, 20, 40, 60, 80, 100, 120]);
    assert_eq!(milliseconds(0.03, 7), [0, 5, 10, 15, 20, 25, 30]);
    assert_eq!(milliseconds(0.15, 7), [0, 25, 50, 75, 100, 125, 150]);
    assert_eq!(milliseconds(0.16, 7), [0, 25, 50, 75, 100, 125, 150, 160]);
    assert_eq!(milliseconds(0.13, 7), [0, 25, 50, 75, 100, 125]);
    assert_eq!(milliseconds(2.0, 2), [0, 2000]);
    // Rows every 2 ms have no sample at 25 ms.
    let sampled: Vec<i64> = times([0.0, 0.16], 7, 2e-3)
        .iter()
        .map(|t| (t * 1e3).round() as i64)
        .collect();
    assert_eq!(sampled, [0, 20, 40, 60, 80, 100, 120, 140, 160]);
    assert_eq!(milliseconds(0.0, 7), [0]);
    assert_eq!(milliseconds(f64::NAN, 7), [0]);
    assert_eq!(between([0.062, 0.16], 6), [62, 75, 100, 125, 150, 160]);
    assert_eq!(between([0.04, 0.12], 5), [40, 50, 75, 100, 120]);
    assert_eq!(between([0.119, 0.12], 1), [119]);
}
