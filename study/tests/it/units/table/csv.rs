use bryant_study::table::csv::number;

#[test]
fn numbers_read_back_to_the_last_bit() {
    for value in [0.1 + 0.2, -1.0 / 3.0, 6.02e23, 5e-324, 0.0, 1e7, f64::MAX] {
        assert_eq!(number(value).parse(), Ok(value));
    }
    assert_eq!([number(3.0), number(f64::NAN)], ["3", ""]);
}
