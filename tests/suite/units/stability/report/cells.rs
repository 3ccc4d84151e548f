use bryant::stability::report::cells::number;

#[test]
fn numbers_are_short() {
    let pairs = [
        (0.0, "0"),
        (1e-10, "1e-10"),
        (2.7654, "2.77"),
        (310.0, "310"),
        (31.0, "31"),
        (1234.5, "1234"),
        (12345.0, "1.23e4"),
        (0.0123, "0.0123"),
        (f64::NAN, "NaN"),
    ];
    for (value, text) in pairs {
        assert_eq!(number(value), text);
    }
}
