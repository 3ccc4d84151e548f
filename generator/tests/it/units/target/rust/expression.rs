use bryant_generator::target::rust::expression::number;

#[test]
fn numbers_read_back_exactly() {
    for value in [
        0.0,
        0.1,
        -9.81,
        1e-7,
        1e21,
        1.0 / 3.0,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
    ] {
        let text = number(value).to_string().replace(' ', "");
        assert_eq!(text.parse::<f64>().ok(), Some(value), "{text}");
    }
}

#[test]
fn what_is_no_number_has_a_name() {
    assert_eq!(number(f64::NEG_INFINITY).to_string(), "f64 :: NEG_INFINITY");
    assert_eq!(number(f64::NAN).to_string(), "f64 :: NAN");
}
