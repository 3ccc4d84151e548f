//! Filters of signals.

use bryant_runtime::Dual;
use bryant_runtime::response::filter::{Class, Standard, filtered};

/// A filter is linear: the derivative of the filtered signal is the filtered derivative.
#[test]
fn derivatives_are_filtered_as_values_are() {
    let samples = |i: usize| (0.37 * i as f64).sin() + 0.01 * i as f64;
    let slopes = |i: usize| (0.11 * i as f64).cos();
    let both: Vec<Dual<f64>> = (0..300)
        .map(|i| Dual {
            value: samples(i),
            slope: slopes(i),
        })
        .collect();
    let alone = |of: &dyn Fn(usize) -> f64| {
        let values: Vec<f64> = (0..300).map(of).collect();
        filtered(&values, 1e-4, Class::Cfc180, Standard::Iso6487).unwrap()
    };
    let [values, derivatives] = [alone(&samples), alone(&slopes)];
    let found = filtered(&both, 1e-4, Class::Cfc180, Standard::Iso6487).unwrap();
    for (i, found) in found.iter().enumerate() {
        assert_eq!(found.value, values[i]);
        assert_eq!(found.slope, derivatives[i]);
    }
}

#[test]
fn what_cannot_be_filtered_is_not() {
    let samples = vec![1.0; 20];
    let of = |interval, class| filtered(&samples, interval, class, Standard::Iso6487);
    assert!(of(1e-4, Class::Cfc1000).is_some());
    assert!(of(1.1e-4, Class::Cfc1000).is_none());
    assert!(of(1e-3, Class::Cfc60).is_some());
    assert!(of(f64::NAN, Class::Cfc60).is_none());
    assert!(filtered(&samples[..9], 1e-4, Class::Cfc60, Standard::Iso6487).is_none());
}
