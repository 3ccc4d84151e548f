use bryant_generator::urdf::reader::half_unit;

#[test]
fn half_units_are_those_of_the_last_digit() {
    let cases = [
        ("0.25", 0.005),
        ("-1.50e-3", 5e-6),
        ("2e-3", 0.0),
        ("3", 0.0),
        ("0.000", 0.0),
        ("x", 0.0),
        ("1.e400", f64::INFINITY),
    ];
    for (text, half) in cases {
        let found = half_unit(text);
        assert!(
            found == half || (found / half - 1.0).abs() < 1e-12,
            "{text}: {found}"
        );
    }
}
