use bryant_study::summary::text::number;

#[test]
fn numbers_have_four_digits() {
    let found = [0.0, 1.0, -12.3456, 123456.7, 1.5e9, 2e-7, f64::NAN].map(number);
    assert_eq!(
        found,
        [
            "0.000", "1.000", "-12.35", "123457", "1.500e9", "2.000e-7", "–"
        ]
    );
}
