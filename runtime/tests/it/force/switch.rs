//! Choices.

use crate::scalars::Pair;
use bryant_runtime::force::switch::choose;

#[test]
fn the_side_not_chosen_leaves_no_trace() {
    assert_eq!(choose(1.0, 2.0, 3.0, f64::NAN), 3.0);
    assert_eq!(choose(2.0, 2.0, f64::NAN, 4.0), 4.0);
    let lanes = choose(
        Pair([1.0, 2.0]),
        Pair([1.5, 1.5]),
        Pair([3.0, f64::NAN]),
        Pair([f64::NAN, 4.0]),
    );
    assert_eq!(lanes, Pair([3.0, 4.0]));
}

#[test]
fn what_cannot_be_compared_shows() {
    assert!(choose(f64::NAN, 2.0, 3.0, 4.0).is_nan());
    assert!(choose(1.0, f64::NAN, 3.0, 4.0).is_nan());
}
