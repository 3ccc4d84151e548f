use bryant::command::run::outcome::{duration, element};
use bryant_runtime::program::{ErrorKind, RunError};

#[test]
fn durations_have_their_unit() {
    assert_eq!(duration(0.12), "120 ms");
    assert_eq!(duration(1.5e-4), "150 µs");
    assert_eq!(duration(2.0), "2 s");
    assert_eq!(duration(45.6957e-6), "45.7 µs");
    assert_eq!(duration(1234.0), "1234 s");
}

#[test]
fn the_element_at_fault_is_named() {
    let mut error = RunError {
        kind: ErrorKind::Run,
        t: Some(0.1),
        coordinate: Some("man/head.phi".into()),
        cause: "a curve".into(),
        message: "at t = 0.1 s it breaks; likely cause: a curve".into(),
    };
    assert_eq!(element(&error), Some("man/head"));
    error.coordinate = None;
    assert_eq!(element(&error), None);
}
