//! How far answers are apart.

use bryant_runtime::Response;
use bryant_runtime::response::Answer;

#[test]
fn what_is_next_to_nothing_is_measured_by_its_signal() {
    let answer = |response, value| Answer::new(response, value, 200.0, 0.5);
    let peak = |value| answer(Response::Peak, value);
    assert_eq!(peak(100.0).apart(&peak(90.0)), 0.1);
    // 1 % of 200 is more than both
    assert_eq!(peak(0.5).apart(&peak(-0.5)), 0.5);
    assert_eq!(peak(0.0).apart(&peak(0.0)), 0.0);
    assert!(peak(f64::NAN).apart(&peak(1.0)).is_nan());
    // times are relative to the duration: 1 ms in 1 % of 0.5 s
    let time = |value| answer(Response::TimeOfPeak, value);
    assert!((time(0.0).apart(&time(1e-3)) - 0.2).abs() < 1e-15);
    let hic = |value| answer(Response::Hic { window: 15e-3 }, value);
    assert_eq!(hic(1e-3).apart(&hic(2e-3)), 0.5);
}

#[test]
fn equal_responses_of_signals_that_differ_are_apart() {
    let smallest = |largest| Answer::new(Response::Minimum, 0.0, largest, 0.5);
    assert_eq!(smallest(200.0).apart(&smallest(200.0)), 0.0);
    assert_eq!(smallest(200.0).apart(&smallest(50.0)), 0.75);
    assert_eq!(smallest(50.0).apart(&smallest(200.0)), 0.75);
    assert_eq!(smallest(0.0).apart(&smallest(0.0)), 0.0);
    let peak = |value| Answer::new(Response::Peak, value, value, 0.5);
    assert_eq!(peak(200.0).apart(&peak(50.0)), 0.75);
    let none = Answer::new(Response::Peak, f64::NAN, 0.0, 0.5);
    assert!(none.apart(&peak(1.0)).is_nan());
}
