use bryant_study::quantity::{quantity, strict, time, tolerance};

#[test]
fn units_are_those_of_a_model() {
    assert_eq!(quantity("0.1 ms", "s").unwrap(), 0.1 * 1e-3);
    assert_eq!(quantity("0.25", "s").unwrap(), 0.25);
    assert_eq!(quantity("60 kN", "N").unwrap(), 60e3);
    assert_eq!(quantity("180 deg", "rad").unwrap(), std::f64::consts::PI);
    assert_eq!(quantity("2 * 3 N + 1 N", "N").unwrap(), 7.0);
    assert_eq!(quantity("12 N*s/m", "N*s/m").unwrap(), 12.0);
    assert_eq!(quantity("5 %", "").unwrap(), 5.0 * 0.01);
}

#[test]
fn another_kind_of_unit_is_an_error_with_a_remedy() {
    let error = quantity("3 kg", "s").unwrap_err().to_string();
    assert!(
        error.contains("in kg") && error.contains("help:"),
        "{error}"
    );
    let error = strict("3 kg", "").unwrap_err().to_string();
    assert!(error.contains("pure number"), "{error}");
    assert_eq!(strict("5 %", ""), quantity("5 %", ""));
    assert!(quantity("3 parsec", "m").is_err());
    assert!(quantity("1 s + 1 m", "").is_err());
    assert!(quantity("", "s").is_err());
    assert!(
        quantity("1/0", "s")
            .unwrap_err()
            .to_string()
            .contains("finite")
    );
    assert!(time("0 s").is_err() && time("-1 ms").is_err());
}

#[test]
fn a_tolerance_is_a_share() {
    assert_eq!(tolerance("1e-6"), Ok(1e-6));
    for wrong in ["nan", "0", "-1e-6", "1", "2", "inf", "1 %"] {
        let error = tolerance(wrong).unwrap_err().to_string();
        assert!(
            error.contains("below 1") && error.contains("1e-6"),
            "{error}"
        );
    }
}
